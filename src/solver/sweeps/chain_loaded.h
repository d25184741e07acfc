// Chains whose particles carry bodies, one path at a time.
//
// A chain is solved before contacts and ties. Where a particle of a gram holds up a body of ten kilograms, the chain
// would lift the particle alone, the contact would push it down again, and the body would rise by a ten-thousandth of
// what is missing. So such a particle has the inertia of both in the chain's system, with W a tensor: along the contact
// normal that of particle and body, across it that of the particle.
//   W = across (1 - a a^T) + along a a^T,   R = W^(1/2),   u = R n_{k-1},   v = R n_k at the particle between links k-1 and k
//   p_k = q_k + |R' n_k|^2 + s_k,   q_k = (|v|^2 (q_{k-1} + s_{k-1}) + |u x v|^2) / p_{k-1}      R' at the link's second particle
// This is the elimination of chain_link.h, which has W = w 1, and likewise without differences.
//
// A contact only pushes. Where the solution would pull a particle off its body, the path is solved again with the
// inertia of the particle alone.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "math/vector.h"
#include "model/compiled_object.h"
#include "model/substep.h"

namespace pliant {

/// The inertia of a particle together with the body that it carries.
struct LoadedInertia {
  Vec3f axis{};           ///< unit vector a
  float root_along = 0;   ///< square root of the inverse mass along the axis [kg^-1/2]
  float root_across = 0;  ///< and across it
  float farthest = 0;     ///< largest displacement along the axis with the body [m]
};

/// Which particles of an object carry bodies.
struct ChainLoads {
  const std::int32_t* of_particle = nullptr;  ///< for each particle of the object an index in `inertias`, or -1
  const LoadedInertia* inertias = nullptr;
  char* is_released = nullptr;  ///< for each of `inertias`: set to 1 where the particle moved without its body
};

/// Sixteen chains as their driver has them.
struct ChainTask {
  const Pool& pool;
  const Segment* links;  ///< the segments of a ChainBatch
  int steps;
  const float* softness;
  float* multipliers;  ///< the pool's array or null
};

/// Solves the paths `lanes` exactly with the inertias of `loads`. `scratch` as for ChainKernels::solve_chain.
void solve_loaded_chains(const ChainTask& task, std::uint32_t lanes, const SweepArguments& arguments,
                         const ChainLoads& loads, float* scratch);

/// What the solve of all sixteen paths changes of some, so that it can be undone.
class KeptLanes {
 public:
  KeptLanes(const ChainTask& task, std::uint32_t lanes, const SweepArguments& arguments);
  void restore() const;

 private:
  const ChainTask& task_;
  const SweepArguments& arguments_;
  std::vector<std::pair<int, Record>> displacements_;
  std::vector<std::pair<std::int64_t, float>> multipliers_;
};

}  // namespace pliant
