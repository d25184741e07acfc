#include "solver/bodies/manifold_passes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace pliant {

namespace {

constexpr float tiny = 1e-30f;
/// Passes over the points of a manifold that bounces: with one, a box dropped flat rises 7 to 9 % less high than it should.
constexpr int passes_of_impact = 4;

Vec3f times(const std::array<float, 6>& m, const Vec3f& v) {
  return {m[0] * v.x + m[5] * v.y + m[4] * v.z, m[5] * v.x + m[1] * v.y + m[3] * v.z, m[4] * v.x + m[3] * v.y + m[2] * v.z};
}

/// The relative motion of two bodies at the centre of their points.
struct Relative {
  Vec3f velocity{}, spin{};
};

Relative relative(const Manifold& m, const BodyMotion& a, const BodyMotion& b) {
  return {(b.velocity + cross(b.spin, m.arm_b)) - (a.velocity + cross(a.spin, m.arm_a)), b.spin - a.spin};
}

Vec3f relative_displacement(const Manifold& m, const BodyMotion& a, const BodyMotion& b) {
  return (b.displacement + cross(b.rotation, m.arm_b)) - (a.displacement + cross(a.rotation, m.arm_a));
}

/// Adds an impulse at the centre and a moment to b, and the opposite to a.
void add(const Manifold& m, const Vec3f& impulse, const Vec3f& moment, BodyMotion& a, BodyMotion& b) {
  a.velocity -= impulse * a.inverse_mass;
  a.spin -= times(a.inverse_inertia, cross(m.arm_a, impulse) + moment);
  b.velocity += impulse * b.inverse_mass;
  b.spin += times(b.inverse_inertia, cross(m.arm_b, impulse) + moment);
}

/// Relative motion along the normal and about both tangents, in which all points of a manifold move.
struct Wrench {
  float n = 0, one = 0, two = 0;
};

Wrench along(const Manifold& m, const Vec3f& motion, const Vec3f& turn) {
  return {dot(motion, m.normal), dot(turn, m.tangent1), dot(turn, m.tangent2)};
}

float at_point(const Manifold& m, std::size_t i, const Wrench& motion) {
  return motion.n + m.y[i] * motion.one - m.x[i] * motion.two;
}

/// What an impulse at a point does to the wrench's motion.
void push(const Manifold& m, std::size_t i, float impulse, Wrench& motion) {
  const float gn = 1, g1 = m.y[i], g2 = -m.x[i];
  motion.n += impulse * (m.mobility[0] * gn + m.mobility[5] * g1 + m.mobility[4] * g2);
  motion.one += impulse * (m.mobility[5] * gn + m.mobility[1] * g1 + m.mobility[3] * g2);
  motion.two += impulse * (m.mobility[4] * gn + m.mobility[3] * g1 + m.mobility[2] * g2);
}

float sum_of_impulses(const Manifold& m) { return (m.impulse[0] + m.impulse[1]) + (m.impulse[2] + m.impulse[3]); }

void apply_wrench(const Manifold& m, const std::array<float, 4>& change, BodyMotion& a, BodyMotion& b) {
  float n = 0, one = 0, two = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    n += change[i];
    one += m.y[i] * change[i];
    two -= m.x[i] * change[i];
  }
  add(m, m.normal * n, m.tangent1 * one + m.tangent2 * two, a, b);
}

/// Friction at the centre: inside of a disc of the normal impulse times mu, and a twist within that times the mean radius.
void rub(Manifold& m, BodyMotion& a, BodyMotion& b) {
  const Relative now = relative(m, a, b);
  const float u = dot(now.velocity, m.tangent1), v = dot(now.velocity, m.tangent2);
  const float determinant = std::max(m.slide[0] * m.slide[1] - m.slide[2] * m.slide[2], tiny);
  const std::array<float, 2> before = m.friction_impulse;
  std::array<float, 2> wanted{before[0] - (m.slide[1] * u - m.slide[2] * v) / determinant,
                              before[1] - (m.slide[0] * v - m.slide[2] * u) / determinant};
  const float limit = m.friction * sum_of_impulses(m);
  const float size = std::sqrt(wanted[0] * wanted[0] + wanted[1] * wanted[1]);
  const float scale = size <= limit ? 1.f : m.sliding * limit / std::max(size, tiny);
  m.friction_impulse = {wanted[0] * scale, wanted[1] * scale};
  const float twist_limit = limit * m.radius, old_twist = m.twist_impulse;
  const float twist = old_twist - dot(now.spin, m.normal) / std::max(m.twist_mobility, tiny);
  m.twist_impulse = std::min(std::max(twist, -twist_limit), twist_limit);
  add(m, m.tangent1 * (m.friction_impulse[0] - before[0]) + m.tangent2 * (m.friction_impulse[1] - before[1]),
      m.normal * (m.twist_impulse - old_twist), a, b);
}

/// What a point goes for: the velocity -bias, while a share of its impulse leaks.
struct Aim {
  float bias, leak;
};

/// One pass over the points, one after another.
template <class AimOf>
void press(Manifold& m, BodyMotion& a, BodyMotion& b, const AimOf& aim) {
  const Relative now = relative(m, a, b);
  Wrench motion = along(m, now.velocity, now.spin);
  std::array<float, 4> change{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(m.count); ++i) {
    const auto [bias, leak] = aim(i);
    const float wanted =
        -(1 - leak) * (at_point(m, i, motion) + bias) / std::max(m.inverse_mass[i], tiny) - leak * m.impulse[i];
    const float next = std::max(m.impulse[i] + wanted, 0.f);
    change[i] = next - m.impulse[i];
    m.impulse[i] = next;
    push(m, i, change[i], motion);
  }
  apply_wrench(m, change, a, b);
}

std::array<float, 4> gaps_now(const Manifold& m, const BodyMotion& a, const BodyMotion& b) {
  const Wrench moved = along(m, relative_displacement(m, a, b), b.rotation - a.rotation);
  std::array<float, 4> gaps{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(m.count); ++i) gaps[i] = m.gap[i] + at_point(m, i, moved);
  return gaps;
}

}  // namespace

void prepare(Manifold& m, const BodyMotion& a, const BodyMotion& b) {
  const auto turned = [](const BodyMotion& body, const Vec3f& moment) { return times(body.inverse_inertia, moment); };
  const Vec3f na = cross(m.arm_a, m.normal), nb = cross(m.arm_b, m.normal);
  const float mass = a.inverse_mass + b.inverse_mass;
  const auto both = [&](const Vec3f& pa, const Vec3f& qa, const Vec3f& pb, const Vec3f& qb) {
    return dot(pa, turned(a, qa)) + dot(pb, turned(b, qb));
  };
  m.mobility = {mass + both(na, na, nb, nb),
                both(m.tangent1, m.tangent1, m.tangent1, m.tangent1),
                both(m.tangent2, m.tangent2, m.tangent2, m.tangent2),
                both(m.tangent1, m.tangent2, m.tangent1, m.tangent2),
                both(m.tangent2, na, m.tangent2, nb),
                both(m.tangent1, na, m.tangent1, nb)};
  for (std::size_t i = 0; i < static_cast<std::size_t>(m.count); ++i) {
    Wrench motion;
    push(m, i, 1, motion);
    m.inverse_mass[i] = at_point(m, i, motion);
  }
  const Vec3f ua = cross(m.arm_a, m.tangent1), ub = cross(m.arm_b, m.tangent1), va = cross(m.arm_a, m.tangent2),
              vb = cross(m.arm_b, m.tangent2);
  m.slide = {mass + both(ua, ua, ub, ub), mass + both(va, va, vb, vb), both(ua, va, ub, vb)};
  m.twist_mobility = both(m.normal, m.normal, m.normal, m.normal);
  m.radius = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(m.count); ++i)
    m.radius += std::sqrt(m.x[i] * m.x[i] + m.y[i] * m.y[i]) / static_cast<float>(m.count);
}

void warm_start(const Manifold& m, BodyMotion& a, BodyMotion& b) {
  apply_wrench(m, m.impulse, a, b);
  add(m, m.tangent1 * m.friction_impulse[0] + m.tangent2 * m.friction_impulse[1], m.normal * m.twist_impulse, a, b);
}

bool bounce(Manifold& m, BodyMotion& a, BodyMotion& b, float h, float slow) {
  if (m.restitution == 0) return false;
  const Relative now = relative(m, a, b);
  Wrench motion = along(m, now.velocity, now.spin);
  const std::array<float, 4> gaps = gaps_now(m, a, b);
  std::array<float, 4> wanted{}, impulse{};
  bool closes = false;
  for (std::size_t i = 0; i < static_cast<std::size_t>(m.count); ++i) {
    const float speed = at_point(m, i, motion);
    if (gaps[i] + h * speed >= 0 || speed > -slow) continue;
    wanted[i] = -m.restitution * speed;
    closes = true;
  }
  if (!closes) return false;
  for (int turn = 0; turn < passes_of_impact * m.count; ++turn) {
    const auto i = static_cast<std::size_t>(turn % m.count);
    if (wanted[i] == 0) continue;
    const float change = (wanted[i] - at_point(m, i, motion)) / std::max(m.inverse_mass[i], tiny);
    const float next = std::max(impulse[i] + change, 0.f);
    push(m, i, next - impulse[i], motion);
    impulse[i] = next;
  }
  apply_wrench(m, impulse, a, b);
  return true;
}

void position_pass(Manifold& m, BodyMotion& a, BodyMotion& b, float h, const ContactSoftness& soft) {
  rub(m, a, b);
  m.gap_now = gaps_now(m, a, b);
  press(m, a, b, [&](std::size_t i) -> Aim {
    if (m.gap_now[i] > 0) return {m.gap_now[i] / h, 0};
    return {std::max(soft.beta * m.gap_now[i] / h, -soft.fastest), soft.epsilon};
  });
}

void velocity_pass(Manifold& m, BodyMotion& a, BodyMotion& b, float h) {
  rub(m, a, b);
  press(m, a, b, [&](std::size_t i) -> Aim { return {m.gap_now[i] > 0 ? m.gap_now[i] / h : 0, 0}; });
}

}  // namespace pliant
