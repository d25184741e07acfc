#include "collision/bodies/part_gap.h"

#include <algorithm>
#include <cmath>

#include "core/at.h"
#include "math/vector.h"

namespace pliant {

namespace {

/// What axes of polyhedra are preferred by, and rounding to floats, are less than these shares of the ball and of the
/// distance.
constexpr double preferred = 2e-3, rounded = 1e-5;

}  // namespace

PartBall ball_around(const BodyPart& part) {
  const ConvexShape& shape = part.shape;
  PartBall ball;
  if (shape.kind == ConvexShape::Kind::polyhedron) {
    const Vec3f centre = shape.polyhedron->centre;
    for (const Vec3f& corner : shape.polyhedron->corners)
      ball.radius = std::max(ball.radius, static_cast<double>(length(corner - centre)));
    ball.centre = convert<double>(centre);
  } else {
    const double across = static_cast<double>(shape.core_radius), along = static_cast<double>(shape.half_length);
    ball.radius = std::sqrt(across * across + along * along);
  }
  ball.centre = to_world(part.pose, ball.centre);
  ball.radius = (ball.radius + static_cast<double>(shape.radius)) * (1 + rounded);
  return ball;
}

bool is_beyond(const BodyPart& a, const Vec3d& centre, double radius, double reach) {
  const Vec3d at_a = to_local(a.pose, centre);
  const double enough = static_cast<double>(a.shape.radius) + reach + radius * (1 + preferred) + rounded * length(at_a);
  const double across = std::sqrt(at_a.x * at_a.x + at_a.z * at_a.z), along = std::fabs(at_a.y);
  switch (a.shape.kind) {
    case ConvexShape::Kind::point:
      return length(at_a) > enough;
    case ConvexShape::Kind::segment:
    case ConvexShape::Kind::cylinder:
    case ConvexShape::Kind::cone:
      return std::max(across - static_cast<double>(a.shape.core_radius),
                      along - static_cast<double>(a.shape.half_length)) > enough;
    case ConvexShape::Kind::polyhedron:
      break;
  }
  const Polyhedron& p = *a.shape.polyhedron;
  for (int f = 0; f < p.faces(); ++f) {
    const Vec3d normal = convert<double>(p.normals[at(f)]),
                on = convert<double>(p.corners[at(p.face_corners[at(p.first_of_face[at(f)])])]);
    if (dot(normal, at_a - on) > enough) return true;
  }
  return false;
}

}  // namespace pliant
