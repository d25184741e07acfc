#include "collision/near/neighbourhood.h"

namespace pliant {

void NearList::clear(const Odometer& odometer) {
  pairs = 0;
  blocks.clear();
  value.clear();
  least = {out_of_reach, odometer.total};
}

float activation_distance(const Neighbourhood& near, const ClusterSides& sides) {
  const float extent = max(near.motions.extent(sides.first), near.motions.extent(sides.second));
  return max(cull_slack * near.pair_of(sides).material.thickness,
             2 * max(filter_margin(near, sides), least_margin_roundings * one_rounding * extent));
}

void find_paths(const Neighbourhood& near, const ClusterSides& sides, const PairParticles& particles,
                PairLanes& lanes) {
  unsigned swapped = 0;
  if (sides.first != sides.second)
    for (int lane = 0; lane < 16; ++lane)
      swapped |= (near.model.shared->vertex_cluster[lanes.stencils.vertex[0][lane]] != sides.first ? 1U : 0U) << lane;
  near.kernels.paths(lanes.stencils, sides.of_vertices ? 1 : 2, particles,
                     {&near.motions[sides.first], &near.motions[sides.second], swapped, near.motions.mean(sides.first)},
                     lanes.paths);
  const float rigid = near.pair_of(sides).rigid;
  for (float& falls : lanes.paths.falls) falls += rigid;
}

}  // namespace pliant
