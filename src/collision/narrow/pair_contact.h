// Contacts between dynamic objects: vertex-triangle and edge-edge.
//
// Both kinds are four particles with weights that sum to zero: sum weight_i x_i is the vector between the closest
// points. The closest points and the normal are those of the substep's start, when the two primitives are apart, and
// stay constant in the substep: an iterate may already have crossed, and its normal would point the wrong way.
#pragma once

#include "collision/proxies/pair_stencil.h"
#include "constraints/contact.h"

namespace pliant {

/// Limit of the speed at which a contact of two surfaces resolves an initial overlap [m/s].
inline constexpr float largest_pair_separation_speed = 1;

/// Makes the contact of pair number `lane` of a batch of sixteen; the caller sets its approach speed.
Contact make_contact(const PairStencil& pair, const PairBatch& at, int lane, const PairMaterial& material, float h);

/// The approach speed along the contact's normal, from predicted displacements [m/s].
float approach_of(const Contact& contact, const Record* displacements, float h);

/// Parameters of the velocity corrections for restitution.
struct PairResponse {
  Vec3f missing{};  ///< part of the relative velocity that velocities do not include yet [m/s]
  float slow = 0;   ///< slower approaches count as rest [m/s]
};

/// True if an active contact did not touch at the substep's start, and came closer than half its thickness.
inline bool is_impact(const Contact& contact) {
  return contact.push > 0 && contact.gap > 0 && contact.gap + contact.push > 0.5f * contact.thickness;
}

/// Removes an impact's remaining approach speed and returns it [m/s]. `missing`: gravity not yet in the velocities
/// [m/s].
float end_impact(const Contact& contact, Record* velocities, const Vec3f& missing);

/// Sets the relative normal velocity of an active contact according to restitution (separation_after).
void respond_to_contact(const Contact& contact, Record* velocities, const PairResponse& response = {});

}  // namespace pliant
