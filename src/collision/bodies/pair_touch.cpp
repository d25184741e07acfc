#include "collision/bodies/pair_touch.h"

#include <algorithm>

#include "collision/bodies/kept_side.h"
#include "core/at.h"
#include "geometry/convex_contact.h"
#include "geometry/convex_distance.h"

namespace pliant {

namespace {

/// Normals that differ by less are one [1 - cosine]: at 20 m/s a slope of that angle lifts by 0.05 mm in a frame.
constexpr double same_normal = 1e-8;

/// True for equal directions. Normals of hulls have lengths in single precision, so the dot product does not tell.
bool are_one(const Vec3d& a, const Vec3d& b) {
  return 0.5 * length_squared(a * (1 / length(a)) - b * (1 / length(b))) < same_normal;
}

Posed relative_pose(const Posed& a, const Posed& b) {
  Posed relative = relative_to(a, b);
  relative.rotation = normalise(relative.rotation);
  return relative;
}

/// By how much the plane of a contact separates two parts: of its points, some may be cut off [m].
double separation_along(const BodyPart& a, const BodyPart& b, const Posed& b_in_a, const Vec3d& normal) {
  const Posed of_b = compose(b_in_a, b.pose);
  const Vec3d on_a = to_world(a.pose, support(a.shape, rotate(conjugate(a.pose.rotation), normal))),
              on_b = to_world(of_b, support(b.shape, rotate(conjugate(of_b.rotation), -normal)));
  return dot(normal, on_b - on_a) - static_cast<double>(a.shape.radius) - static_cast<double>(b.shape.radius);
}

double least_gap(const Touch& now) {
  double least = 1e300;
  for (int i = 0; i < now.count; ++i) least = std::min(least, now.points[at(i)].separation);
  return least;
}

}  // namespace

Posed relative_to(const Posed& a, const Posed& b) {
  return {to_local(a, b.position), multiply(conjugate(a.rotation), b.rotation)};
}

Touch touch_of(const BodyPart& a, const BodyPart& b, const Posed& b_in_a, const Reach& reach) {
  const Posed pose = relative_pose(a.pose, compose(b_in_a, b.pose));
  Touch found = a.is_half_space ? touch_half_space(b.shape, pose, reach.margin, reach.turning)
                                : touch(a.shape, b.shape, pose, reach.margin, reach.turning);
  if (!a.is_half_space) found = with_corners(a.shape, b.shape, pose, found, reach.rocking);
  found.normal = rotate(a.pose.rotation, found.normal);
  for (int i = 0; i < found.count; ++i) {
    TouchPoint& point = found.points[at(i)];
    point.on_a = to_world(a.pose, point.on_a);
    point.on_b = to_world(a.pose, point.on_b);
  }
  return found;
}

PairTouch touch_on_path(const BodyPart& a, const BodyPart& b, const Posed& b_in_a, const Reach& reach, const Touch& now,
                        const SolidPath& on) {
  if (now.count == 0 || !(on.path.least_along(now.normal) < 0)) return {now, {}, {}, false};
  const double gap = separation_along(a, b, b_in_a, now.normal);
  if (!on.is_stopped(now.normal, gap)) return {now, {}, {}, false};
  const auto gap_at = [&](const Vec3d& displacement) -> PathGap {
    Posed moved = b_in_a;
    moved.position += displacement;
    const ConvexDistance nearest = convex_distance(a.shape, b.shape, relative_pose(a.pose, compose(moved, b.pose)));
    return {nearest.separation, rotate(a.pose.rotation, nearest.normal)};
  };
  const PathContact found = PathSearch(on.path, on.slop, gap_at, on.least).find({gap, now.normal});
  if (are_one(found.normal, now.normal)) return {now, {}, found.touches ? found : PathContact{}, true};
  Posed moved = b_in_a;
  moved.position += found.displacement;
  Touch there = touch_of(a, b, moved, reach);
  // Of polyhedra that are apart the axis that separates them most may be another one, and where edges of flush ones
  // meet several separate them as well.
  if (there.count == 0 || !are_one(there.normal, found.normal))
    there = touch_along(a, b, moved, found.normal, reach.margin, reach.turning);
  if (there.count == 0) return {now, {}, {}, true};
  return {there, found.displacement, found.touches ? found : PathContact{}, true};
}

PathContact first_on_plane(const Touch& now, const SolidPath& on) {
  const ContactPath::Leg& leg = on.path.leg(0);
  const double along = dot(now.normal, leg.speed);
  const double gap = least_gap(now);
  if (!(along < 0) || !(gap + along < -on.slop)) return {};
  const double time = std::max(gap, 0.) / -along;
  return {true, time, leg.speed * time, now.normal};
}

}  // namespace pliant
