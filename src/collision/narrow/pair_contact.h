// Contacts among things that move: a vertex and a triangle, or two edges.
//
// Both kinds are four particles with weights that add up to nothing: the relative place of the closest points is sum weight x.
// Point and normal are those of the substep's start, where every clean pair is apart, and stay for the substep: an iterate
// may have crossed already and would name the wrong side.
#pragma once

#include "collision/proxies/pair_stencil.h"
#include "constraints/contact.h"

namespace pliant {

/// What overlaps separates at this speed at most [m/s].
inline constexpr float largest_pair_separation_speed = 1;

/// The contact of pair `lane` of sixteen that were measured; its approach is not known yet.
Contact make_contact(const PairStencil& pair, const PairBatch& at, int lane, const PairMaterial& material, float h);

/// The speed along the contact's normal, from displacements as predicted [m/s].
float approach_of(const Contact& contact, const Record* displacements, float h);

/// What velocities lack, and what is no impact.
struct PairResponse {
  Vec3f missing{};  ///< of the relative velocity [m/s]
  float slow = 0;   ///< approach no faster than this is rest [m/s]
};

/// Whether a contact that did not touch when the substep began came closer by more than half its thickness, and pushed.
inline bool is_impact(const Contact& contact) {
  return contact.push > 0 && contact.gap > 0 && contact.gap + contact.push > 0.5f * contact.thickness;
}

/// Removes what is left of an impact's approach and returns it [m/s]. `missing`: what the relative velocity lacks [m/s].
float end_impact(const Contact& contact, Record* velocities, const Vec3f& missing);

/// Gives a contact that pushed the relative velocity along its normal that restitution leaves (separation_after).
void respond_to_contact(const Contact& contact, Record* velocities, const PairResponse& response = {});

}  // namespace pliant
