#include "model/surface_velocity.h"

#include <algorithm>
#include <cstddef>

#include "math/motion.h"

namespace pliant {

namespace {

template <class Key>
const Vec3f& set_or(const std::map<Key, Vec3f>& all, const Key& key, const Vec3f& described) {
  const auto at = all.empty() ? all.end() : all.find(key);
  return at == all.end() ? described : at->second;
}

}  // namespace

Vec3f surface_velocity_of_collider(const Model& model, const Control& control, int collider) {
  return set_or(control.surfaces.colliders, collider,
                model.colliders[static_cast<std::size_t>(collider)].surface_velocity);
}

Vec3f surface_velocity_of_mesh(const Model& model, const Control& control, int object, double time) {
  const CompiledObject& of = model.objects[static_cast<std::size_t>(object)];
  const Vec3f own = set_or(control.surfaces.meshes, object, of.surface_velocity);
  if (own == Vec3f{}) return {};
  const PoseDrive* const drive = control.mesh(object);
  const Posed pose = drive != nullptr ? drive->at(time) : pose_at(of.carrier.motion, time);
  return rotate(convert<float>(pose.rotation), own);
}

Vec3f surface_velocity_of_body(const Model& model, const Control& control, int object, int body) {
  const std::vector<Vec3f>& described = model.objects[static_cast<std::size_t>(object)].bodies.surface_velocities;
  return set_or(control.surfaces.bodies, {object, body},
                described.empty() ? Vec3f{} : described[static_cast<std::size_t>(body)]);
}

bool some_meshes_slide(const Model& model, const Control& control) {
  return !control.surfaces.meshes.empty() ||
         std::any_of(model.objects.begin(), model.objects.end(),
                     [](const CompiledObject& object) { return object.surface_velocity != Vec3f{}; });
}

}  // namespace pliant
