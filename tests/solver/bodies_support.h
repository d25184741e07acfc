// A frame of boxes and balls for tests of contact between bodies.
#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <vector>

#include "collision/bodies/body_contacts.h"
#include "geometry/mass_properties.h"
#include "math/quat.h"
#include "solver/bodies/manifold_passes.h"
#include "solver/bodies/manifolds.h"

namespace pliant {
namespace testing_support {

struct TestBody {
  Posed pose{};
  Vec3f velocity{}, spin{};
  float mass = 1;  ///< 0: fixed
  Vec3d inertia{1, 1, 1};
};

class Bodies {
 public:
  std::vector<TestBody> bodies;
  int substeps = 8;
  float dt = 1.f / 60, friction = 0.6f, restitution = 0;
  Vec3f gravity{0, -9.81f, 0};

  void add(const Vec3f& half, const Vec3d& place, float mass = 1, const Quatd& turned = {}) {
    polyhedra_.push_back(polyhedron_of_box(half));
    add({ConvexShape::Kind::polyhedron, 0, 0, 0, &polyhedra_.back()}, moments_of_box(convert<double>(half)), place,
        mass, turned);
  }
  /// Along y; the frame of a cone is in the middle of its height, not at its centre of mass.
  void add_round(ConvexShape::Kind kind, float radius, float half_length, const Vec3d& place,
                 const Quatd& turned = {}) {
    const double r = static_cast<double>(radius), l = static_cast<double>(half_length);
    const bool is_capsule = kind == ConvexShape::Kind::segment;
    const Moments solid = is_capsule                        ? moments_of_capsule(r, l)
                          : kind == ConvexShape::Kind::cone ? moments_of_cone(r, l)
                                                            : moments_of_cylinder(r, l);
    add({kind, is_capsule ? radius : 0, is_capsule ? 0 : radius, half_length, nullptr}, solid, place, 1, turned);
  }
  void add_ball(float radius, const Vec3d& place, float mass = 1) {
    add({ConvexShape::Kind::point, radius, 0, 0, nullptr}, moments_of_sphere(static_cast<double>(radius)), place, mass,
        {});
  }

  void frame() {
    if (finder_.parts().size() != parts_.size()) finder_ = BodyContacts(parts_);
    std::vector<BodyState> states;
    for (const TestBody& body : bodies) states.push_back({body.pose, body.velocity, body.spin, body.mass == 0});
    const std::vector<BodyContact> before = contacts_;
    finder_.update(
        executor_, states, dt, dt * length(gravity), [](int, int) { return true; }, before, contacts_);
    load();
    const float h = dt / static_cast<float>(substeps);
    manifolds_.clear();
    for (const BodyContact& c : contacts_)
      manifolds_.push_back(manifold_of(c, c.a.owner, c.b.owner, {friction, friction, restitution}, h));
    for_manifolds([](Manifold& m, BodyMotion& a, BodyMotion& b) { prepare(m, a, b); });
    for (int substep = 0; substep < substeps; ++substep) {
      for (BodyMotion& m : motions_)
        if (m.inverse_mass > 0) m.velocity += gravity * h;
      for_manifolds([](Manifold& m, BodyMotion& a, BodyMotion& b) { warm_start(m, a, b); });
      bool bounced = restitution > 0;
      for (int round = 0; bounced && round < most_rounds; ++round) {
        bounced = false;
        for_manifolds(
            [&](Manifold& m, BodyMotion& a, BodyMotion& b) { bounced = bounce(m, a, b, h, gravity * h) || bounced; });
      }
      for_manifolds([&](Manifold& m, BodyMotion& a, BodyMotion& b) { position_pass(m, a, b, h, {}); });
      for (BodyMotion& m : motions_) {
        m.displacement += m.velocity * h;
        m.rotation += m.spin * h;
      }
      for_manifolds([&](Manifold& m, BodyMotion& a, BodyMotion& b) { velocity_pass(m, a, b, h); });
    }
    for (std::size_t i = 0; i < contacts_.size(); ++i) keep_impulses(manifolds_[i], h, contacts_[i]);
    store();
  }

  const std::vector<Manifold>& manifolds() const { return manifolds_; }

 private:
  static constexpr int most_rounds = 32;

  void add(const ConvexShape& shape, const Moments& solid, const Vec3d& place, float mass, const Quatd& turned) {
    const int number = static_cast<int>(bodies.size());
    const MassProperties own = mass_properties(times(solid, static_cast<double>(mass) / solid.mass));
    bodies.push_back({{place + rotate(turned, own.centre), turned}, {}, {}, mass, own.inertia});
    parts_.push_back({{number, 0, 0}, number, shape, false, {-own.centre, {}}});
  }

  template <class Body>
  void for_manifolds(const Body& body) {
    for (Manifold& m : manifolds_) body(m, motions_[std::size_t(m.a)], motions_[std::size_t(m.b)]);
  }

  void load() {
    motions_.assign(bodies.size(), {});
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      const TestBody& body = bodies[i];
      BodyMotion& m = motions_[i];
      m.velocity = body.velocity;
      m.spin = body.spin;
      if (body.mass == 0) continue;
      m.inverse_mass = 1 / body.mass;
      const Vec3d inverse{1 / body.inertia.x, 1 / body.inertia.y, 1 / body.inertia.z};
      const Quatd& q = body.pose.rotation;
      const Vec3d x = rotate(q, Vec3d{1, 0, 0}), y = rotate(q, Vec3d{0, 1, 0}), z = rotate(q, Vec3d{0, 0, 1});
      const auto element = [&](double Vec3d::*r, double Vec3d::*c) {
        return static_cast<float>(inverse.x * x.*r * x.*c + inverse.y * y.*r * y.*c + inverse.z * z.*r * z.*c);
      };
      m.inverse_inertia = {element(&Vec3d::x, &Vec3d::x), element(&Vec3d::y, &Vec3d::y), element(&Vec3d::z, &Vec3d::z),
                           element(&Vec3d::y, &Vec3d::z), element(&Vec3d::z, &Vec3d::x), element(&Vec3d::x, &Vec3d::y)};
    }
  }

  void store() {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      TestBody& body = bodies[i];
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

  std::deque<Polyhedron> polyhedra_;  ///< stay where they are
  std::vector<BodyPart> parts_;
  Executor executor_{1};
  BodyContacts finder_;
  std::vector<BodyContact> contacts_;
  std::vector<Manifold> manifolds_;
  std::vector<BodyMotion> motions_;
};

}  // namespace testing_support
}  // namespace pliant
