#include "solver/bodies/depenetration.h"

#include <algorithm>
#include <cstddef>

#include "solver/bodies/body_math.h"

namespace pliant {

namespace {

constexpr float fastest_depenetration = 0.25f;  ///< [m/s]
constexpr float few_overlaps = 6;               ///< overlaps of a body that do not share the speed
constexpr float sizes_a_second = 2.5f;          ///< of small bodies

/// What a unit impulse along the normal at a point does to its velocity [1/kg].
float inverse_mass_at(const Vec3f& arm, const Vec3f& normal, const BodyMotion& body) {
  const Vec3f turn = cross(arm, normal);
  return body.inverse_mass + dot(turn, times(body.inverse_inertia, turn));
}

}  // namespace

float depenetration_speed(float size) { return std::min(fastest_depenetration, sizes_a_second * size); }

bool limit_depths(const BodyMotion& a, const BodyMotion& b, float size, int others, PressedBy by, float h,
                  Manifold& m) {
  constexpr ContactSoftness softness;
  const float share = std::min(few_overlaps / static_cast<float>(std::max(others, 1)), 1.f);
  const float margin = share * depenetration_speed(size) * h / softness.beta;
  const float depth_an_approach =
      by == PressedBy::bodies ? softness.epsilon * h / ((1 - softness.epsilon) * softness.beta) : h / softness.beta;
  bool is_limited = false;
  float deepest = 0;
  for (std::size_t i = 0; i < at(m.count); ++i) {
    if (!(m.gap[i] < -margin)) continue;
    const Vec3f along = m.tangent1 * m.x[i] + m.tangent2 * m.y[i];
    const float inverse_mass =
        inverse_mass_at(m.arm_a + along, m.normal, a) + inverse_mass_at(m.arm_b + along, m.normal, b);
    const float limit = margin + depth_an_approach * m.impulse[i] * inverse_mass;
    if (m.gap[i] < deepest) is_limited = m.gap[i] < -limit;
    deepest = std::min(deepest, m.gap[i]);
    m.gap[i] = std::max(m.gap[i], -limit);
  }
  return is_limited;
}

}  // namespace pliant
