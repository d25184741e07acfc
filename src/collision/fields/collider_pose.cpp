// Conversion of colliders; no other .cpp file of the collision folders reads the types of a Scene.
#include "collision/fields/collider_pose.h"

#include <variant>

#include "math/motion.h"

namespace pliant {
namespace {

struct ToLocal {
  static float size(float given) { return max(given, 0.f); }
  LocalShape operator()(const Plane&) const { return {ShapeKind::plane, 0, 0, 0}; }
  LocalShape operator()(const Sphere& s) const { return {ShapeKind::sphere, size(s.radius), 0, 0}; }
  LocalShape operator()(const Capsule& s) const { return {ShapeKind::capsule, size(s.radius), size(s.half_length), 0}; }
  LocalShape operator()(const Box& s) const {
    return {ShapeKind::box, size(s.half_extents.x), size(s.half_extents.y), size(s.half_extents.z)};
  }
};

}  // namespace

LocalShape local_shape(const Shape& shape) { return std::visit(ToLocal{}, shape); }

Posed collider_pose(const Collider& collider, double time) {
  const Posed placed{convert<double>(collider.position), normalise(convert<double>(collider.rotation))};
  return compose(pose_at(collider.motion, time), placed);
}

}  // namespace pliant
