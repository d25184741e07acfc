// A frame of boxes for tests of contact between bodies: pairs by boxes, manifolds kept while a pair hardly moves.
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "geometry/convex_contact.h"
#include "geometry/mass_properties.h"
#include "geometry/polyhedron_contact.h"
#include "math/quat.h"
#include "solver/bodies/manifold.h"

namespace pliant {
namespace testing_support {

struct BoxBody {
  Vec3f half{0.5f, 0.5f, 0.5f};
  float radius = 0;  ///< of a ball; 0: a box
  Posed pose{};
  Vec3f velocity{}, spin{};
  float mass = 1;  ///< 0: fixed
};

/// Where a pair of bodies was when its manifold was born.
struct KeptManifold {
  Manifold manifold;
  std::array<Vec3d, 4> anchor_a{}, anchor_b{};  ///< in the bodies' frames
  std::array<std::uint32_t, 4> feature{};
  Posed born{};  ///< of b in the frame of a
};

class Boxes {
 public:
  std::vector<BoxBody> bodies;
  int substeps = 8;
  float dt = 1.f / 60, friction = 0.6f, restitution = 0, margin = 0.02f;
  Vec3f gravity{0, -9.81f, 0};

  void add(const Vec3f& half, const Vec3d& place, float mass = 1, const Quatd& turned = {}) {
    bodies.push_back({half, 0, {place, turned}, {}, {}, mass});
  }
  void add_ball(float radius, const Vec3d& place, float mass = 1) {
    bodies.push_back({{radius, radius, radius}, radius, {place, {}}, {}, {}, mass});
  }

  void frame() {
    find_contacts();
    load();
    const float h = dt / static_cast<float>(substeps), slow = 2 * h * std::fabs(gravity.y);
    for (auto& [pair, kept] : manifolds_) prepare(kept.manifold, motions_[pair.first], motions_[pair.second]);
    for (int substep = 0; substep < substeps; ++substep) {
      for (BodyMotion& m : motions_)
        if (m.inverse_mass > 0) m.velocity += gravity * h;
      for_manifolds([&](Manifold& m, BodyMotion& a, BodyMotion& b) { warm_start(m, a, b); });
      bool bounced = restitution > 0;
      for (int round = 0; bounced && round < most_rounds; ++round) {
        bounced = false;
        for_manifolds([&](Manifold& m, BodyMotion& a, BodyMotion& b) { bounced = bounce(m, a, b, h, slow) || bounced; });
      }
      for_manifolds([&](Manifold& m, BodyMotion& a, BodyMotion& b) { position_pass(m, a, b, h, {}); });
      for (BodyMotion& m : motions_) {
        m.displacement += m.velocity * h;
        m.rotation += m.spin * h;
      }
      for_manifolds([&](Manifold& m, BodyMotion& a, BodyMotion& b) { velocity_pass(m, a, b, h); });
    }
    store();
  }

  const std::map<std::pair<int, int>, KeptManifold>& manifolds() const { return manifolds_; }

 private:
  static constexpr int most_rounds = 32;
  static constexpr double still = 0.02, straight = 0.9999;  ///< a manifold stays while its pair has moved and turned less

  template <class Body>
  void for_manifolds(const Body& body) {
    for (auto& [pair, kept] : manifolds_) body(kept.manifold, motions_[pair.first], motions_[pair.second]);
  }

  void find_contacts() {
    std::map<std::pair<int, int>, KeptManifold> next;
    for (int a = 0; a < static_cast<int>(bodies.size()); ++a)
      for (int b = a + 1; b < static_cast<int>(bodies.size()); ++b) {
        const BoxBody &one = bodies[a], &other = bodies[b];
        if (one.mass == 0 && other.mass == 0) continue;
        const double reach = length(convert<double>(one.half)) + length(convert<double>(other.half)) + 0.2;
        const bool is_slab = one.half.x > 10;
        if (!is_slab && length_squared(other.pose.position - one.pose.position) > reach * reach) continue;
        if (is_slab && other.pose.position.y - one.pose.position.y > reach) continue;
        contact(a, b, next);
      }
    manifolds_ = std::move(next);
  }

  void contact(int a, int b, std::map<std::pair<int, int>, KeptManifold>& next) {
    const BoxBody &one = bodies[a], &other = bodies[b];
    const Posed back{to_local(one.pose, Vec3d{}), conjugate(one.pose.rotation)};
    const Posed relative{to_local(one.pose, other.pose.position), normalise(multiply(back.rotation, other.pose.rotation))};
    const auto before = manifolds_.find({a, b});
    if (before != manifolds_.end()) {
      const Vec3d moved = relative.position - before->second.born.position;
      const bool hardly =
          length(moved) < still && std::fabs(dot(relative.rotation, before->second.born.rotation)) > straight;
      if (hardly) {
        KeptManifold kept = before->second;
        renew(kept, one, other);
        next.emplace(std::pair{a, b}, kept);
        return;
      }
    }
    const float reach = margin + dt * length(other.velocity - one.velocity);  // of what may meet within the frame
    const Polyhedron first = polyhedron_of_box(one.half), second = polyhedron_of_box(other.half);
    const bool are_boxes = one.radius == 0 && other.radius == 0;
    const Touch found = are_boxes ? touch(first, moved(second, convert<float>(relative)), reach)
                                  : touch(shape_of(one, first), shape_of(other, second), relative, double(reach));
    if (found.count == 0) return;
    next.emplace(std::pair{a, b}, born(a, b, found, relative, before == manifolds_.end() ? nullptr : &before->second));
  }

  static ConvexShape shape_of(const BoxBody& body, const Polyhedron& box) {
    if (body.radius > 0) return {ConvexShape::Kind::point, body.radius, 0, 0, nullptr};
    return {ConvexShape::Kind::polyhedron, 0, 0, 0, &box};
  }

  static void renew(KeptManifold& kept, const BoxBody& one, const BoxBody& other) {
    for (int i = 0; i < kept.manifold.count; ++i) {
      const Vec3d apart = to_world(other.pose, kept.anchor_b[i]) - to_world(one.pose, kept.anchor_a[i]);
      kept.manifold.gap[i] = static_cast<float>(dot(convert<double>(kept.manifold.normal), apart));
    }
  }

  KeptManifold born(int a, int b, const Touch& found, const Posed& relative, const KeptManifold* before) const {
    const BoxBody &one = bodies[a], &other = bodies[b];
    KeptManifold kept;
    kept.born = relative;
    Manifold& m = kept.manifold;
    m.a = a;
    m.b = b;
    m.count = found.count;
    m.friction = friction;
    m.restitution = restitution;
    const Vec3d normal = rotate(one.pose.rotation, found.normal);
    const Vec3d axis = std::fabs(normal.x) < 0.7 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
    const Vec3d first = unit_or(cross(normal, axis), axis), second = cross(normal, first);
    m.normal = convert<float>(normal);
    m.tangent1 = convert<float>(first);
    m.tangent2 = convert<float>(second);
    Vec3d centre{};
    for (int i = 0; i < found.count; ++i)
      centre += to_world(one.pose, (found.points[i].on_a + found.points[i].on_b) * 0.5) * (1. / found.count);
    m.arm_a = convert<float>(centre - one.pose.position);
    m.arm_b = convert<float>(centre - other.pose.position);
    for (int i = 0; i < found.count; ++i) {
      const TouchPoint& p = found.points[i];
      const Vec3d place = to_world(one.pose, (p.on_a + p.on_b) * 0.5) - centre;
      m.x[i] = static_cast<float>(dot(place, first));
      m.y[i] = static_cast<float>(dot(place, second));
      m.gap[i] = static_cast<float>(p.separation);
      kept.anchor_a[i] = p.on_a;
      kept.anchor_b[i] = to_local(other.pose, to_world(one.pose, p.on_b));
      kept.feature[i] = p.feature;
      for (int j = 0; before != nullptr && j < before->manifold.count; ++j)
        if (before->feature[j] == p.feature) m.impulse[i] = before->manifold.impulse[j];
    }
    if (before != nullptr) {
      const Vec3f rub = before->manifold.tangent1 * before->manifold.friction_impulse[0] +
                        before->manifold.tangent2 * before->manifold.friction_impulse[1];
      m.friction_impulse = {dot(rub, m.tangent1), dot(rub, m.tangent2)};
      m.twist_impulse = before->manifold.twist_impulse;
    }
    return kept;
  }

  void load() {
    motions_.assign(bodies.size(), {});
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const BoxBody& body = bodies[i];
      BodyMotion& m = motions_[i];
      m.velocity = body.velocity;
      m.spin = body.spin;
      if (body.mass == 0) continue;
      m.inverse_mass = 1 / body.mass;
      const Vec3d half = convert<double>(body.half);
      const Moments solid = body.radius > 0 ? moments_of_sphere(double(body.radius)) : moments_of_box(half);
      const Vec3d inertia = mass_properties(times(solid, static_cast<double>(body.mass) / solid.mass)).inertia;
      const Vec3d inverse{1 / inertia.x, 1 / inertia.y, 1 / inertia.z};
      const Quatd& q = body.pose.rotation;
      const Vec3d x = rotate(q, Vec3d{1, 0, 0}), y = rotate(q, Vec3d{0, 1, 0}), z = rotate(q, Vec3d{0, 0, 1});
      const auto element = [&](double Vec3d::*i_th, double Vec3d::*j_th) {
        return static_cast<float>(inverse.x * x.*i_th * x.*j_th + inverse.y * y.*i_th * y.*j_th +
                                  inverse.z * z.*i_th * z.*j_th);
      };
      m.inverse_inertia = {element(&Vec3d::x, &Vec3d::x), element(&Vec3d::y, &Vec3d::y), element(&Vec3d::z, &Vec3d::z),
                           element(&Vec3d::y, &Vec3d::z), element(&Vec3d::z, &Vec3d::x), element(&Vec3d::x, &Vec3d::y)};
    }
  }

  void store() {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      BoxBody& body = bodies[i];
      const BodyMotion& m = motions_[i];
      body.velocity = m.velocity;
      body.spin = m.spin;
      body.pose.position += convert<double>(m.displacement);
      const Vec3d turn = convert<double>(m.rotation);
      const double angle = length(turn);
      if (angle < 1e-12) continue;
      const double s = std::sin(angle / 2) / angle;
      body.pose.rotation =
          normalise(multiply(Quatd{turn.x * s, turn.y * s, turn.z * s, std::cos(angle / 2)}, body.pose.rotation));
    }
  }

  std::vector<BodyMotion> motions_;
  std::map<std::pair<int, int>, KeptManifold> manifolds_;
};

}  // namespace testing_support
}  // namespace pliant
