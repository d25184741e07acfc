// The readable form of neighbour_lanes.cpp, which does the same for sixteen at a time.
#include "collision/neighbours/neighbour_kernels.h"

namespace pliant {

namespace {

void find(const NeighbourQuery& q, int lane, NeighbourScratch& s) {
  for (std::int32_t slot = q.first; slot < q.last; ++slot, ++lane) {
    std::int32_t& count = s.count[lane];
    count = 0;
    bool fits = true;
    for (int r = 0; r < q.range_count; ++r)
      for (std::int32_t other = q.ranges[r].first; other < q.ranges[r].last; ++other) {
        const float dx = q.x[slot] - q.x[other], dy = q.y[slot] - q.y[other], dz = q.z[slot] - q.z[other];
        const bool is_near = dx * dx + dy * dy + dz * dz <= q.reach * q.reach;
        if (!is_near || other == slot) continue;
        fits = count < most_neighbours;
        if (fits) s.found[lane][count++] = other;
      }
    s.left_out += fits ? 0 : 1;
  }
}

}  // namespace

const NeighbourKernels& neighbour_kernels_sequential() {
  static const NeighbourKernels table{find};
  return table;
}

}  // namespace pliant
