// The readable form of neighbour_lanes.cpp, which does the same for sixteen at a time.
#include "collision/neighbours/neighbour_kernels.h"

namespace pliant {

namespace {

void find(const NeighbourQuery& q, int lane, NeighbourScratch& s) {
  for (std::int32_t slot = q.first; slot < q.last; ++slot, ++lane) {
    std::int32_t& count = s.count[lane];
    for (int r = 0; r < q.range_count; ++r)
      for (std::int32_t other = q.ranges[r].first; other < q.ranges[r].last; ++other) {
        const float dx = q.x[slot] - q.x[other], dy = q.y[slot] - q.y[other], dz = q.z[slot] - q.z[other];
        const bool is_near = dx * dx + dy * dy + dz * dz <= q.reach * q.reach;
        if (!is_near || other == slot) continue;
        if (count < most_neighbours)
          s.found[lane][count++] = other;
        else
          s.has_more[lane] = 1;
      }
  }
}

void write_rows(NeighbourScratch& s, std::int32_t nobody, int rows, std::int32_t* to) {
  for (int lane = 0; lane < neighbour_lanes; ++lane)
    for (int k = 0; k < rows; ++k) to[k * neighbour_lanes + lane] = k < s.count[lane] ? s.found[lane][k] : nobody;
}

}  // namespace

const NeighbourKernels& neighbour_kernels_sequential() {
  static const NeighbourKernels table{find, write_rows};
  return table;
}

}  // namespace pliant
