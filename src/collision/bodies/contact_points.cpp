#include "collision/bodies/contact_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "collision/bodies/manifold.h"
#include "core/at.h"
#include "math/vector.h"

namespace pliant {

namespace {

void set_directions(BodyContact& c, const Vec3d& normal) {
  const Vec3d size = abs(normal);
  const Vec3d axis = size.x <= size.y && size.x <= size.z ? Vec3d{1, 0, 0}
                     : size.y <= size.z                   ? Vec3d{0, 1, 0}
                                                          : Vec3d{0, 0, 1};
  const Vec3d first = unit_or(cross(normal, axis), axis);
  c.normal = convert<float>(normal);
  c.tangent1 = convert<float>(first);
  c.tangent2 = convert<float>(cross(normal, first));
}

/// Moves the centre of a contact to that of its touching points.
void move_centre(const std::array<Vec3f, 4>& places, BodyContact& c) {
  const std::array<bool, 4> touches = touching_points({c.count, c.x, c.y, c.gap});
  const auto count = std::count(touches.begin(), touches.end(), true);
  if (count == c.count) return;
  Vec3f centre{};
  for (std::size_t i = 0; i < 4; ++i)
    if (touches[i]) centre += places[i] * (1 / static_cast<float>(count));
  c.arm_a += centre;
  c.arm_b += centre;
  for (std::size_t i = 0; i < at(c.count); ++i) {
    c.x[i] -= dot(centre, c.tangent1);
    c.y[i] -= dot(centre, c.tangent2);
  }
}

/// True if a body and the pair have turned by less than a tenth of a radian between two contacts (cosine of half the
/// angle).
bool turned_little(const BodyContact& old, const BodyContact& now) {
  constexpr float straight_enough = 0.99875f;
  return std::fabs(dot(old.rotation, now.rotation)) > straight_enough &&
         std::fabs(dot(old.turned, now.turned)) > straight_enough;
}

}  // namespace

void set_points(const Touch& found, const Vec3d& moved, const Posed& a, const Posed& b, BodyContact& c) {
  c.count = found.count;
  set_directions(c, rotate(a.rotation, found.normal));
  const Posed there{b.position + rotate(a.rotation, moved), b.rotation};
  const double ahead = dot(found.normal, moved);
  Vec3d centre{};
  for (int i = 0; i < found.count; ++i) {
    const TouchPoint& point = found.points[at(i)];
    centre += to_world(a, (point.on_a + point.on_b) * 0.5) * (1. / found.count);
  }
  c.arm_a = convert<float>(centre - a.position);
  c.arm_b = convert<float>(centre - there.position);
  std::array<Vec3f, 4> places{};
  for (std::size_t i = 0; i < at(found.count); ++i) {
    const TouchPoint& point = found.points[i];
    const Vec3f& place = places[i] = convert<float>(to_world(a, (point.on_a + point.on_b) * 0.5) - centre);
    c.x[i] = dot(place, c.tangent1);
    c.y[i] = dot(place, c.tangent2);
    c.gap[i] = static_cast<float>(point.separation - ahead);
    c.anchor_a[i] = convert<float>(point.on_a);
    c.anchor_b[i] = convert<float>(to_local(there, to_world(a, point.on_b)));
    c.feature[i] = point.feature;
  }
  move_centre(places, c);
}

/// The normal is turned into the axes of both bodies once for all points.
void renew_gaps(const Posed& a, const Posed& b, BodyContact& c) {
  const Vec3d normal = convert<double>(c.normal);
  const Vec3d in_a = rotate(conjugate(a.rotation), normal), in_b = rotate(conjugate(b.rotation), normal);
  const double between = dot(normal, b.position - a.position);
  for (std::size_t i = 0; i < at(c.count); ++i)
    c.gap[i] = static_cast<float>(
        between + (dot(in_b, convert<double>(c.anchor_b[i])) - dot(in_a, convert<double>(c.anchor_a[i]))));
}

void take_impulses(const BodyContact& old, BodyContact& c) {
  for (std::size_t i = 0; i < at(c.count); ++i)
    for (std::size_t j = 0; j < at(old.count); ++j)
      if (c.feature[i] == old.feature[j]) c.impulse[i] = old.impulse[j];
  c.substep = old.substep;
  if (!turned_little(old, c)) return;
  const Vec3f friction = old.tangent1 * old.friction_impulse[0] + old.tangent2 * old.friction_impulse[1];
  c.friction_impulse = {dot(friction, c.tangent1), dot(friction, c.tangent2)};
  c.twist_impulse = old.twist_impulse;
  const Vec3f rolling = old.tangent1 * old.rolling_impulse[0] + old.tangent2 * old.rolling_impulse[1];
  c.rolling_impulse = {dot(rolling, c.tangent1), dot(rolling, c.tangent2)};
}

}  // namespace pliant
