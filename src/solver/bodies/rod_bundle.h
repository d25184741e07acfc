// Rods of equal shape, as of hair, fur and grass, solved sixteen side by side in SIMD lanes with the bits of
// JointForest.
#pragma once

#include <vector>

#include "solver/bodies/joint_forest.h"
#include "solver/bodies/rod_kernels.h"

namespace pliant {

/// Rods whose joints connect their bodies in the same way.
struct RodBundle {
  int rods = 0;  ///< lanes in use
  std::vector<RodNode> nodes;
  std::vector<RodJoint> joints;  ///< [node]
  std::vector<RodBody> bodies;
  float inverse_h2_of_pulls = 0;  ///< of the substep in which the pulls of joints were found [1/s^2]; 0: none yet
};

/// Fewer rods than these are solved one after another: lanes without a rod cost as much as others. With AVX2 four rods
/// of 64 links are as fast either way, with SSE six.
constexpr std::size_t least_rods_of_bundle = 6;

/// Gathers the forests of an object that are rods, and marks them.
std::vector<RodBundle> bundle_rods(const CompiledObject& object, std::vector<JointForest>& forests);

/// Solves the bundles of all objects that take part.
void solve_rod_bundles(Substep& s, bool first_pass);
/// Solves those rods again of which contact has opened joints since.
void close_rod_bundles(Substep& s);

}  // namespace pliant
