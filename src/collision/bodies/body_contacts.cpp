#include "collision/bodies/body_contacts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>

#include "geometry/convex_contact.h"
#include "geometry/polyhedron_contact.h"

namespace pliant {

namespace {

/// A manifold stays while its bodies have moved less against each other since its birth [m], and turned by less than 1.6 degrees
/// (cosine of half the angle).
constexpr double still = 0.02, straight = 0.9999;

Posed relative_pose(const Posed& a, const Posed& b) {
  return {to_local(a, b.position), normalise(multiply(conjugate(a.rotation), b.rotation))};
}

/// The box of a part in the world. Supports are exact up to rounding.
BoxBounds box_of(const BodyPart& part, const Posed& body) {
  const Posed pose = compose(body, part.pose);
  const auto farthest = [&](const Vec3d& direction) {
    const Vec3d local = rotate(conjugate(pose.rotation), direction);
    return dot(direction, to_world(pose, support(part.shape, local))) + static_cast<double>(part.shape.radius);
  };
  const Vec3d high{farthest({1, 0, 0}), farthest({0, 1, 0}), farthest({0, 0, 1})};
  const Vec3d low{-farthest({-1, 0, 0}), -farthest({0, -1, 0}), -farthest({0, 0, -1})};
  return {{detail::float_below(low.x), detail::float_below(low.y), detail::float_below(low.z)},
          {detail::float_above(high.x), detail::float_above(high.y), detail::float_above(high.z)}};
}

/// An upper bound of the speed of a part's points: what a box of it can move in a second.
float speed_of(const BodyState& body, const BoxBounds& box) {
  const Vec3f centre = convert<float>(body.pose.position);
  const Vec3f reach = max(abs(box.high - centre), abs(box.low - centre));
  return length(body.velocity) + length(body.spin) * length(reach);
}

bool hardly_moved(const Posed& now, const Posed& born) {
  return length(now.position - born.position) < still && std::fabs(dot(now.rotation, born.rotation)) > straight;
}

void renew_gaps(KeptManifold& kept, const Posed& a, const Posed& b) {
  Manifold& m = kept.manifold;
  for (std::size_t i = 0; i < static_cast<std::size_t>(m.count); ++i)
    m.gap[i] =
        static_cast<float>(dot(convert<double>(m.normal), to_world(b, kept.anchor_b[i]) - to_world(a, kept.anchor_a[i])));
}

/// Contact points of two parts in the frame of body a.
Touch touch_of(const BodyPart& a, const BodyPart& b, const Posed& b_in_a, double reach) {
  const Posed pose = relative_pose(a.pose, compose(b_in_a, b.pose));
  Touch found = touch(a.shape, b.shape, pose, reach);
  found.normal = rotate(a.pose.rotation, found.normal);
  for (int i = 0; i < found.count; ++i) {
    TouchPoint& point = found.points[static_cast<std::size_t>(i)];
    point.on_a = to_world(a.pose, point.on_a);
    point.on_b = to_world(a.pose, point.on_b);
  }
  return found;
}

void set_directions(Manifold& m, const Vec3d& normal) {
  const Vec3d size = abs(normal);
  const Vec3d axis = size.x <= size.y && size.x <= size.z ? Vec3d{1, 0, 0}
                     : size.y <= size.z                   ? Vec3d{0, 1, 0}
                                                          : Vec3d{0, 0, 1};
  const Vec3d first = unit_or(cross(normal, axis), axis);
  m.normal = convert<float>(normal);
  m.tangent1 = convert<float>(first);
  m.tangent2 = convert<float>(cross(normal, first));
}

/// Places the points of a new manifold.
void set_points(KeptManifold& kept, const Touch& found, const Posed& a, const Posed& b) {
  Manifold& m = kept.manifold;
  m.count = found.count;
  set_directions(m, rotate(a.rotation, found.normal));
  Vec3d centre{};
  for (int i = 0; i < found.count; ++i) {
    const TouchPoint& point = found.points[static_cast<std::size_t>(i)];
    centre += to_world(a, (point.on_a + point.on_b) * 0.5) * (1. / found.count);
  }
  m.arm_a = convert<float>(centre - a.position);
  m.arm_b = convert<float>(centre - b.position);
  for (std::size_t i = 0; i < static_cast<std::size_t>(found.count); ++i) {
    const TouchPoint& point = found.points[i];
    const Vec3f place = convert<float>(to_world(a, (point.on_a + point.on_b) * 0.5) - centre);
    m.x[i] = dot(place, m.tangent1);
    m.y[i] = dot(place, m.tangent2);
    m.gap[i] = static_cast<float>(point.separation);
    kept.anchor_a[i] = point.on_a;
    kept.anchor_b[i] = to_local(b, to_world(a, point.on_b));
    kept.feature[i] = point.feature;
  }
}

/// Hands the impulses of an earlier manifold of the same parts to the points that are the same.
void take_impulses(const KeptManifold& from, KeptManifold& kept) {
  Manifold& m = kept.manifold;
  const Manifold& old = from.manifold;
  for (std::size_t i = 0; i < static_cast<std::size_t>(m.count); ++i)
    for (std::size_t j = 0; j < static_cast<std::size_t>(old.count); ++j)
      if (kept.feature[i] == from.feature[j]) m.impulse[i] = old.impulse[j];
  const Vec3f friction = old.tangent1 * old.friction_impulse[0] + old.tangent2 * old.friction_impulse[1];
  m.friction_impulse = {dot(friction, m.tangent1), dot(friction, m.tangent2)};
  m.twist_impulse = old.twist_impulse;
}

}  // namespace

BodyContacts::BodyContacts(std::vector<BodyPart> parts) : parts_(std::move(parts)) {}

void BodyContacts::find_pairs(const std::vector<BodyState>& bodies, float dt, float margin) {
  boxes_.clear();
  boxes_.reserve(parts_.size());
  for (const BodyPart& part : parts_) {
    const BodyState& body = bodies[static_cast<std::size_t>(part.body)];
    const BoxBounds box = box_of(part, body.pose);
    boxes_.push_back(box.grown(0.5f * margin + dt * speed_of(body, box)));
  }
  tree_.build(boxes_);
  pairs_.clear();
  tree_.self_pairs([&](int i, int j) {
    const int a = parts_[static_cast<std::size_t>(i)].body, b = parts_[static_cast<std::size_t>(j)].body;
    const bool are_fixed = bodies[static_cast<std::size_t>(a)].is_fixed && bodies[static_cast<std::size_t>(b)].is_fixed;
    if (a != b && !are_fixed) pairs_.emplace_back(std::min(i, j), std::max(i, j));
  });
  std::sort(pairs_.begin(), pairs_.end());
}

const KeptManifold* BodyContacts::before(int part_a, int part_b) const {
  const auto place = std::lower_bound(manifolds_.begin(), manifolds_.end(), std::pair{part_a, part_b},
                                      [](const KeptManifold& kept, const std::pair<int, int>& parts) {
                                        return std::pair{kept.part_a, kept.part_b} < parts;
                                      });
  const bool is_there = place != manifolds_.end() && place->part_a == part_a && place->part_b == part_b;
  return is_there ? &*place : nullptr;
}

void BodyContacts::update(const std::vector<BodyState>& bodies, float dt, float margin) {
  find_pairs(bodies, dt, margin);
  next_.clear();
  for (const auto& [i, j] : pairs_) {
    const BodyPart &one = parts_[static_cast<std::size_t>(i)], &other = parts_[static_cast<std::size_t>(j)];
    const BodyState &a = bodies[static_cast<std::size_t>(one.body)], &b = bodies[static_cast<std::size_t>(other.body)];
    const Posed relative = relative_pose(a.pose, b.pose);
    const KeptManifold* old = before(i, j);
    if (old != nullptr && hardly_moved(relative, old->born)) {
      next_.push_back(*old);
      renew_gaps(next_.back(), a.pose, b.pose);
      continue;
    }
    const float fast = speed_of(a, boxes_[static_cast<std::size_t>(i)]) + speed_of(b, boxes_[static_cast<std::size_t>(j)]);
    const Touch found = touch_of(one, other, relative, static_cast<double>(margin + dt * fast));
    if (found.count == 0) continue;
    KeptManifold kept;
    kept.part_a = i;
    kept.part_b = j;
    kept.born = relative;
    kept.manifold.a = one.body;
    kept.manifold.b = other.body;
    kept.manifold.friction = std::sqrt(one.friction * other.friction);
    kept.manifold.restitution = std::max(one.restitution, other.restitution);
    set_points(kept, found, a.pose, b.pose);
    if (old != nullptr) take_impulses(*old, kept);
    next_.push_back(kept);
  }
  std::swap(manifolds_, next_);
}

}  // namespace pliant
