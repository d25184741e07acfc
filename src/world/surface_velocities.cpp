#include "world/surface_velocities.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "math/quat.h"
#include "math/vector.h"
#include "pliant/error.h"
#include "world/control.h"
#include "world/resting_grains.h"

namespace pliant {

namespace {

constexpr float fastest_surface = 1e6f;  // [m/s]

bool precedes(const SurfaceVelocity& a, const SurfaceVelocity& b) {
  return std::tuple{a.of, a.slot, a.body} < std::tuple{b.of, b.slot, b.body};
}

bool is_velocity(const Vec3f& v) { return length(v) <= fastest_surface; }  // false if it is not finite

void require_velocity(const Vec3f& velocity, const std::string& object, const std::string& element) {
  if (!is_velocity(velocity))
    throw Error({.object = object, .element = element}, "its surface velocity is not finite, or above 1e6 m/s",
                "give finite numbers in m/s");
}

void set_in_state(const SurfaceVelocity& given, State& state) {
  std::vector<SurfaceVelocity>& all = state.surface_velocities;
  const auto at = std::lower_bound(all.begin(), all.end(), given, precedes);
  if (at != all.end() && !precedes(given, *at))
    *at = given;
  else
    all.insert(at, given);
}

/// True if a surface velocity is that of something in this World.
bool is_of_world(const WorldData& world, const SurfaceVelocity& one) {
  if (one.of == SurfaceVelocity::Of::collider) return world.ids.colliders.has({one.slot, one.generation});
  if (one.of == SurfaceVelocity::Of::mesh_collider) return world.ids.mesh_colliders.has({one.slot, one.generation});
  return one.of == SurfaceVelocity::Of::body && one.generation == 0 && one.slot >= 0 && one.body >= 0 &&
         static_cast<std::size_t>(one.slot) < world.model.objects.size() &&
         static_cast<std::size_t>(one.body) <
             world.model.objects[static_cast<std::size_t>(one.slot)].bodies.bodies.size();
}

}  // namespace

void begin_surface_velocities(WorldData& world) {
  SurfaceVelocities& surfaces = world.workspace.control.surfaces;
  for (const SurfaceVelocity& one : world.state.surface_velocities) {
    if (one.of == SurfaceVelocity::Of::collider) {
      surfaces.colliders[world.ids.colliders.number({one.slot, one.generation})] = one.velocity;
    } else if (one.of == SurfaceVelocity::Of::mesh_collider) {
      surfaces.meshes[world.ids.mesh_colliders.number({one.slot, one.generation})] = one.velocity;
    } else {
      const CompiledBodies& bodies = world.model.objects[static_cast<std::size_t>(one.slot)].bodies;
      const Quatd& axes = bodies.labels[static_cast<std::size_t>(one.body)].described.rotation;
      surfaces.bodies[{one.slot, one.body}] = convert<float>(rotate(axes, convert<double>(one.velocity)));
    }
  }
}

void require_surface_velocities(const WorldData& world, const State& given) {
  const SurfaceVelocity* before = nullptr;
  for (const SurfaceVelocity& one : given.surface_velocities) {
    if (!is_of_world(world, one) || !is_velocity(one.velocity) || (before != nullptr && !precedes(*before, one)))
      throw Error({.element = "surface velocity " + std::to_string(&one - given.surface_velocities.data())},
                  "is of nothing in this World, not in ascending order, or no finite velocity",
                  "restore a state of this world, or clear its surface_velocities");
    before = &one;
  }
}

void forget_surface_velocities(WorldData& world, SurfaceVelocity::Of of, int slot) {
  std::erase_if(world.state.surface_velocities,
                [&](const SurfaceVelocity& one) { return one.of == of && one.slot == slot; });
}

void ObjectHandle::set_surface_velocity(int body, const Vec3f& velocity) {
  const int number = world_->number(id());
  const CompiledObject& of = world_->model.objects[static_cast<std::size_t>(number)];
  (void)body_of(of, body);
  require_velocity(velocity, of.name, "body " + std::to_string(body));
  wake_bodies(*world_, number);
  world_->state.rest_times.clear();  // wakes what may sleep on it
  wake_all_grains(*world_);
  set_in_state({SurfaceVelocity::Of::body, number, 0, body, velocity}, world_->state);
}

void ObjectHandle::set_surface_velocity(const std::string& body, const Vec3f& velocity) {
  set_surface_velocity(body_of_name(world_->model.objects[static_cast<std::size_t>(world_->number(id()))], body),
                       velocity);
}

void ColliderHandle::set_surface_velocity(const Vec3f& velocity) {
  (void)world_->ids.colliders.number(id());
  require_velocity(velocity, "", "collider " + std::to_string(id().slot));
  set_in_state({SurfaceVelocity::Of::collider, id().slot, id().generation, 0, velocity}, world_->state);
}

void MeshColliderHandle::set_surface_velocity(const Vec3f& velocity) {
  (void)world_->ids.mesh_colliders.number(id());
  require_velocity(velocity, "", "mesh collider " + std::to_string(id().slot));
  set_in_state({SurfaceVelocity::Of::mesh_collider, id().slot, id().generation, 0, velocity}, world_->state);
}

}  // namespace pliant
