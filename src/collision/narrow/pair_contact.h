// Contacts between dynamic objects: vertex-triangle and edge-edge.
//
// Both kinds are four particles with weights that sum to zero; sum weight x is the vector between the closest points. Point
// and normal are those of the substep's start, when separate pairs are apart, and are constant in the substep: an iterate
// may already have crossed, and would give the wrong side.
#pragma once

#include "collision/proxies/pair_stencil.h"
#include "constraints/contact.h"

namespace pliant {

/// Limit of the depenetration speed [m/s].
inline constexpr float largest_pair_separation_speed = 1;

/// The contact of lane `lane` of sixteen measured pairs; its approach speed is set later.
Contact make_contact(const PairStencil& pair, const PairBatch& at, int lane, const PairMaterial& material, float h);

/// The approach speed along the contact's normal, from predicted displacements [m/s].
float approach_of(const Contact& contact, const Record* displacements, float h);

/// Corrections of velocities for restitution.
struct PairResponse {
  Vec3f missing{};  ///< missing part of the relative velocity [m/s]
  float slow = 0;   ///< slower approaches count as rest [m/s]
};

/// Whether a contact that did not touch when the substep began came closer by more than half its thickness, and pushed.
inline bool is_impact(const Contact& contact) {
  return contact.push > 0 && contact.gap > 0 && contact.gap + contact.push > 0.5f * contact.thickness;
}

/// Removes what is left of an impact's approach and returns it [m/s]. `missing`: what the relative velocity lacks [m/s].
float end_impact(const Contact& contact, Record* velocities, const Vec3f& missing);

/// Sets the relative normal velocity of an active contact according to restitution (separation_after).
void respond_to_contact(const Contact& contact, Record* velocities, const PairResponse& response = {});

}  // namespace pliant
