// The search for neighbours in sixteen SIMD lanes, compiled per instruction set level under the rules of
// solver/lanes.cpp.
//
// Slots that lie together share their candidates: the points near the box around them, packed one behind another. Each
// slot is then compared with a register of candidates at a time, and those that are near are packed onto its list.
#include "collision/neighbours/neighbour_kernels.h"
#include "math/pack_lanes.h"
#include "math/vector.h"
#include "math/wide.h"

namespace pliant {
inline namespace PLIANT_ISA {
namespace {

/// Appends the candidates that are near to the lists of the query's slots.
PLIANT_HD void compare(const NeighbourQuery& q, int candidates, int lane, NeighbourScratch& s) {
  const Part nowhere = all_lanes(__builtin_nanf(""));
  std::memcpy(s.x + candidates, &nowhere,
              sizeof nowhere);  // the last register is filled with places that are near to none
  const Part reach2 = all_lanes(q.reach * q.reach);
  for (std::int32_t slot = q.first; slot < q.last; ++slot, ++lane) {
    const Part x = all_lanes(q.x[slot]), y = all_lanes(q.y[slot]), z = all_lanes(q.z[slot]);
    std::int32_t* const found = s.found[lane];
    int count = s.count[lane], all = count;
    for (int i = 0; i < candidates; i += part_width) {
      const Part dx = x - load_part(s.x + i), dy = y - load_part(s.y + i), dz = z - load_part(s.z + i);
      const PartMask others = load_part(s.candidate + i);
      const std::uint32_t bits = bits_at_most(dx * dx + dy * dy + dz * dz, reach2) & bits_other_than(others, slot);
      Packing(bits).store(found + count, others);
      all += count_bits(bits);
      count = all < most_neighbours ? all : most_neighbours;
    }
    s.count[lane] = count;
    s.has_more[lane] |= all > most_neighbours ? 1 : 0;
  }
}

/// The box of candidates is a little larger than the reach, so that rounding loses none.
void find(const NeighbourQuery& q, int lane, NeighbourScratch& s) {
  const Part low_x = all_lanes(q.low.x), low_y = all_lanes(q.low.y), low_z = all_lanes(q.low.z);
  const Part high_x = all_lanes(q.high.x), high_y = all_lanes(q.high.y), high_z = all_lanes(q.high.z);
  const Part reach2 = all_lanes(q.reach * q.reach * 1.0001f);
  int count = 0;
  for (int r = 0; r < q.range_count; ++r) {
    const std::int32_t last = q.ranges[r].last;
    for (std::int32_t i = q.ranges[r].first; i < last; i += part_width) {
      const Part x = load_part(q.x + i), y = load_part(q.y + i), z = load_part(q.z + i);
      const Part dx = beyond(x, low_x, high_x), dy = beyond(y, low_y, high_y), dz = beyond(z, low_z, high_z);
      const std::uint32_t bits = bits_at_most(dx * dx + dy * dy + dz * dz, reach2) & first_bits(last - i);
      const Packing packing(bits);
      packing.store(s.x + count, (PartMask)x);
      packing.store(s.y + count, (PartMask)y);
      packing.store(s.z + count, (PartMask)z);
      packing.store(s.candidate + count, lane_numbers() + i);
      count += count_bits(bits);
      if (count <= most_candidates - part_width) continue;
      compare(q, count, lane, s);
      count = 0;
    }
  }
  compare(q, count, lane, s);
}

/// Four neighbours of each of sixteen lanes at a time, as a transpose of records.
void write_rows(NeighbourScratch& s, std::int32_t nobody, int rows, std::int32_t* to) {
  constexpr int records = neighbour_stride / 4;
  constexpr std::int32_t first[wide_width] = {
      0 * records, 1 * records, 2 * records,  3 * records,  4 * records,  5 * records,  6 * records,  7 * records,
      8 * records, 9 * records, 10 * records, 11 * records, 12 * records, 13 * records, 14 * records, 15 * records};
  const PartMask nobodies = nobody - PartMask{};
  for (int lane = 0; lane < wide_width; ++lane)
    for (int k = s.count[lane]; k < rows; k += part_width) std::memcpy(s.found[lane] + k, &nobodies, sizeof nobodies);
  for (int k = 0; k < rows; k += 4) {
    const WideRecords four =
        from_registers(load_indexed(reinterpret_cast<const Record*>(&s.found[0][0]) + k / 4, first));
    std::int32_t* const row = to + k * wide_width;
    std::memcpy(row, &four.position.x, sizeof(Wide));
    std::memcpy(row + wide_width, &four.position.y, sizeof(Wide));
    std::memcpy(row + 2 * wide_width, &four.position.z, sizeof(Wide));
    std::memcpy(row + 3 * wide_width, &four.w, sizeof(Wide));
  }
}

}  // namespace
}  // namespace PLIANT_ISA

const NeighbourKernels& PLIANT_OF_LEVEL(neighbour_kernels)() {
  static const NeighbourKernels table{find, write_rows};
  return table;
}

}  // namespace pliant
