#include "collision/bodies/inner_ball.h"

#include <algorithm>
#include <cmath>

#include "math/vector.h"

namespace pliant {

namespace {

/// How far a point is inside of a core, in its frame; negative outside [m].
double depth_in(const ConvexShape& shape, const Vec3d& point) {
  const double r = static_cast<double>(shape.core_radius), h = static_cast<double>(shape.half_length),
               across = std::sqrt(point.x * point.x + point.z * point.z);
  switch (shape.kind) {
    case ConvexShape::Kind::point:
      return -length(point);
    case ConvexShape::Kind::segment:
      return -length(point - Vec3d{0, std::clamp(point.y, -h, h), 0});
    case ConvexShape::Kind::cylinder:
      return std::min(r - across, h - std::fabs(point.y));
    case ConvexShape::Kind::cone:
      return std::min(point.y + h, (r * (h - point.y) - 2 * h * across) / std::sqrt(4 * h * h + r * r));
    case ConvexShape::Kind::polyhedron:
      break;
  }
  const Polyhedron& p = *shape.polyhedron;
  double least = 1e300;
  for (std::size_t f = 0; f < p.normals.size(); ++f) {
    const auto corner = static_cast<std::size_t>(p.face_corners[static_cast<std::size_t>(p.first_of_face[f])]);
    least = std::min(least, dot(convert<double>(p.normals[f]), convert<double>(p.corners[corner]) - point));
  }
  return least;
}

}  // namespace

float inner_radius(const BodyPart& part) {
  if (!part.is_convex()) return 0;
  const Vec3d centre = to_local(part.pose, Vec3d{});
  const double radius = static_cast<double>(part.shape.radius) + depth_in(part.shape, centre);
  const bool is_ball = part.shape.kind == ConvexShape::Kind::point && length(centre) <= 1e-3 * radius;
  return is_ball ? 0 : static_cast<float>(std::max(radius, 0.));
}

BodyPart inner_ball(const BodyPart& part, float radius) {
  return {part.id, part.body, {ConvexShape::Kind::point, radius}, false, {}};
}

}  // namespace pliant
