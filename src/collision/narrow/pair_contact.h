// Contacts among things that move: a vertex and a triangle, or two edges.
//
// Both kinds are four particles with weights that add up to nothing: the relative place of the closest points is sum weight x.
// Point and normal are those of the substep's start, where every clean pair is apart, and stay for the substep: an iterate
// may have crossed already and would name the wrong side.
#pragma once

#include <array>
#include <cstdint>

#include "collision/proxies/pair_stencil.h"

namespace pliant {

struct PairContact {
  std::array<std::int32_t, 4> vertex{};
  std::array<float, 4> weight{};
  Vec3f normal{};
  float gap = 0;        ///< distance at the substep's start [m]
  float thickness = 0;  ///< distance to be kept [m]
  float static_friction = 0, kinetic_friction = 0, restitution = 0;
  float approach = 0;  ///< speed along the normal with which the substep began; below 0 where they come closer [m/s]
  float push = 0;      ///< sum of normal corrections of the relative place [m]
  Vec3f friction{};    ///< sum of tangential ones [m]
};

/// What overlaps separates at this speed at most [m/s].
inline constexpr float largest_pair_separation_speed = 1;

PairContact make_contact(const PairStencil& pair, const PairBatch& at, int lane, const PairMaterial& material, float h);

/// The speed along the contact's normal, from displacements as predicted [m/s].
float approach_of(const PairContact& contact, const Record* displacements, const Record* remainders, float h);

/// Projects one contact: n . (relative place) >= thickness, then friction within the cone of the pushes so far (contact.h has
/// the same for one particle). Arrays are of all particles of the model; w of `positions` the inverse mass.
void project_contact(PairContact& contact, const Record* positions, const Record* remainders, Record* displacements);

/// By how much the contact's thickness is not kept after `displacements` [m]; below 0 where it is.
float overlap_of(const PairContact& contact, const Record* displacements);

/// What velocities lack, and what is no impact.
struct PairResponse {
  Vec3f missing{};  ///< of the relative velocity [m/s]
  float slow = 0;   ///< approach no faster than this is rest [m/s]
};

/// Takes away the speed at which a contact that pushed now separates: a push is no throw. Where it came closer faster than is
/// slow, its restitution times that speed is what it separates at.
void respond_to_contact(const PairContact& contact, const Record* positions, Record* velocities,
                        const PairResponse& response = {});

}  // namespace pliant
