// Cohesion of grains: the pull that a contact bears, and the substeps that it needs.
#pragma once

#include "pliant/scene.h"

namespace pliant {

/// A contact of grains with cohesion is a spring that pulls over a gap of up to this share of the mean diameter. It
/// must be short, because grains do not see farther; where substeps are so long that the spring would be longer, the
/// contact bears less.
inline constexpr float longest_bond = 0.1f;

/// The pull [N] that a contact of two grains of a diameter [m] bears if the bulk parts at a tensile stress [Pa]: pi /
/// (k n) d^2 stress, where grains have k = 6 contacts and fill n = 0.6 of the volume (Rumpf, The strength of granules
/// and agglomerates, 1962).
inline float pull_of_contact(float diameter, float stress) {
  constexpr float share = 0.872664626f;
  return share * (diameter * diameter) * stress;
}

/// The substeps with which the contacts of an object's grains stretch by 3 % of the diameter before they part; 1
/// without cohesion.
int substeps_of_cohesion(const Object& object, double frame_time);

/// The share of the cohesion that acts in `substeps` of a frame: the bond is then no longer than `longest_bond`.
double acting_cohesion(const Object& object, double frame_time, int substeps);

}  // namespace pliant
