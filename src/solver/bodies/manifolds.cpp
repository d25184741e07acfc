#include "solver/bodies/manifolds.h"

#include <utility>

#include "solver/bodies/manifold_rows.h"

namespace pliant {

namespace {

/// Puts the second of two points into the third place, so that both orders of a pass (manifold_formulas.h) differ for
/// them, too.
void spread_two_points(Manifold& m) {
  if (m.count != 2) return;
  m.count = 3;
  std::swap(m.x[1], m.x[2]);
  std::swap(m.y[1], m.y[2]);
  std::swap(m.gap[1], m.gap[2]);
  std::swap(m.impulse[1], m.impulse[2]);
  m.gap[1] = no_point;
}

}  // namespace

void scale_impulses(float factor, Manifold& m) {
  for (float& impulse : m.impulse) impulse *= factor;
  for (float& impulse : m.friction_impulse) impulse *= factor;
  m.twist_impulse *= factor;
  for (float& impulse : m.rolling_impulse) impulse *= factor;
}

Manifold manifold_of(const BodyContact& contact, int a, int b, const BodyMaterial& material, float h) {
  Manifold m;
  m.a = a;
  m.b = b;
  m.count = contact.count;
  m.normal = contact.normal;
  m.tangent1 = contact.tangent1;
  m.tangent2 = contact.tangent2;
  m.arm_a = contact.arm_a;
  m.arm_b = contact.arm_b;
  m.x = contact.x;
  m.y = contact.y;
  m.gap = contact.gap;
  m.friction = material.static_friction;
  m.sliding = material.static_friction > 0 ? material.kinetic_friction / material.static_friction : 0;
  m.restitution = material.restitution;
  m.rolling = material.rolling_friction;
  m.spinning = material.spinning_friction;
  m.impulse = contact.impulse;
  m.friction_impulse = contact.friction_impulse;
  m.twist_impulse = contact.twist_impulse;
  m.rolling_impulse = contact.rolling_impulse;
  if (contact.substep > 0 && contact.substep != h) scale_impulses(h / contact.substep, m);
  spread_two_points(m);
  return m;
}

void keep_impulses(const Manifold& manifold, float h, BodyContact& contact) {
  contact.impulse = manifold.impulse;
  if (contact.count == 2) std::swap(contact.impulse[1], contact.impulse[2]);
  contact.friction_impulse = manifold.friction_impulse;
  contact.twist_impulse = manifold.twist_impulse;
  contact.rolling_impulse = manifold.rolling_impulse;
  contact.substep = h;
}

}  // namespace pliant
