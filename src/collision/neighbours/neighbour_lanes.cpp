// The search for neighbours in sixteen SIMD lanes, compiled per instruction set level under the rules of solver/lanes.cpp.
//
// Slots that lie together share their candidates: the points near the box around them, packed one behind another. Each slot is then
// compared with sixteen candidates at a time.
#include "collision/neighbours/neighbour_kernels.h"
#include "math/lane_bits.h"
#include "math/vector.h"
#include "math/wide.h"

namespace pliant {
inline namespace PLIANT_ISA {
namespace {

struct Sides {
  float low, high;
};

PLIANT_HD Sides sides(const float* x, std::int32_t first, std::int32_t last) {
  Sides s{x[first], x[first]};
  for (std::int32_t i = first + 1; i < last; ++i) s = {x[i] < s.low ? x[i] : s.low, x[i] > s.high ? x[i] : s.high};
  return s;
}

/// How far places are from an interval, along one axis.
PLIANT_HD Wide beyond(const Wide& x, const Sides& s) { return max(max(Wide(s.low) - x, x - Wide(s.high)), Wide(0.f)); }

/// Packs the points near the box around the query's slots. Returns their number. The box is a little larger than the reach, so that
/// rounding loses none.
PLIANT_HD int pack_candidates(const NeighbourQuery& q, NeighbourScratch& s) {
  const Sides x = sides(q.x, q.first, q.last), y = sides(q.y, q.first, q.last), z = sides(q.z, q.first, q.last);
  const Wide reach2(q.reach * q.reach * 1.0001f);
  int count = 0;
  for (int r = 0; r < q.range_count; ++r) {
    for (std::int32_t i = q.ranges[r].first; i < q.ranges[r].last; i += wide_width) {
      const Wide dx = beyond(load_wide(q.x + i), x), dy = beyond(load_wide(q.y + i), y), dz = beyond(load_wide(q.z + i), z);
      std::uint32_t bits = lane_bits(dx * dx + dy * dy + dz * dz <= reach2);
      if (q.ranges[r].last - i < wide_width) bits &= (1u << (q.ranges[r].last - i)) - 1;
      for (; bits != 0 && count < most_candidates; bits &= bits - 1) {
        const std::int32_t slot = i + __builtin_ctz(bits);
        s.candidate[count] = slot;
        s.x[count] = q.x[slot];
        s.y[count] = q.y[slot];
        s.z[count++] = q.z[slot];
      }
    }
  }
  return count;
}

void find(const NeighbourQuery& q, int lane, NeighbourScratch& s) {
  const int candidates = pack_candidates(q, s);
  const Wide reach2(q.reach * q.reach);
  for (std::int32_t slot = q.first; slot < q.last; ++slot, ++lane) {
    const Wide x(q.x[slot]), y(q.y[slot]), z(q.z[slot]);
    std::int32_t* found = s.found[lane];
    int count = 0;
    bool fits = candidates < most_candidates;
    for (int i = 0; i < candidates; i += wide_width) {
      const Wide dx = x - load_wide(s.x + i), dy = y - load_wide(s.y + i), dz = z - load_wide(s.z + i);
      std::uint32_t bits = lane_bits(dx * dx + dy * dy + dz * dz <= reach2);
      if (candidates - i < wide_width) bits &= (1u << (candidates - i)) - 1;
      for (; bits != 0; bits &= bits - 1) {
        const std::int32_t other = s.candidate[i + __builtin_ctz(bits)];
        if (other == slot) continue;
        if (count < most_neighbours)
          found[count++] = other;
        else
          fits = false;
      }
    }
    s.count[lane] = count;
    s.left_out += fits ? 0 : 1;
  }
}

}  // namespace
}  // namespace PLIANT_ISA

const NeighbourKernels& PLIANT_OF_LEVEL(neighbour_kernels)() {
  static const NeighbourKernels table{find};
  return table;
}

}  // namespace pliant
