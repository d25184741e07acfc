// The air's forces on sixteen triangles at a time, compiled per instruction set level under the rules of lanes.cpp.
#include "math/unroll.h"
#include "math/wide.h"
#include "solver/air.h"

namespace pliant {
inline namespace PLIANT_ISA {
namespace {

/// The vertices of triangles t .. t + 15, one in each lane, those beyond the last repeated. Lane 4 L + j has triangle
/// t + 4 j + L, so that the forces are stored as four contiguous groups.
struct TriangleLanes {
  std::int32_t vertex[3][air_batch];

  PLIANT_HD TriangleLanes(const AirArguments& a, int t, int last) {
    PLIANT_UNROLL
    for (int lane = 0; lane < air_batch; ++lane) {
      const int number = t + 4 * (lane % 4) + lane / 4;
      const int* from = a.triangles + static_cast<std::ptrdiff_t>(3) * (number < last ? number : last - 1);
      for (int i = 0; i < 3; ++i) vertex[i][lane] = from[i];
    }
  }
};

// Not a register at a time (math/isa.h): three roots and four divisions in turn then wait for one another.
void find_forces(const AirArguments& a, int first, int last) {
  static_assert(air_batch == wide_width);
  for (int t = first; t < last; t += air_batch) {
    const TriangleLanes lanes(a, t, last);
    AirCorner<Wide> corner[3];
    PLIANT_UNROLL
    for (int i = 0; i < 3; ++i) {
      const WideRecords p = from_registers(load_indexed(a.positions, lanes.vertex[i]));
      corner[i] = {p.position, from_registers(load_indexed(a.velocities, lanes.vertex[i])).position, p.w};
    }
    const std::int32_t run[4] = {t, t + 4, t + 8, t + 12};
    store_runs(a.forces, run, to_registers({air_force(corner, a), Wide(0.f)}), 4);
  }
}

void apply(const AirArguments& a, int first, int last) {
  for (int i = first; i < last; ++i) {
    Quad sum{};
    for (int c = a.corner_begin[i]; c < a.corner_begin[i + 1]; ++c) sum += load_quad(a.forces + (a.corners[c] >> 2));
    const float share = a.h * a.positions[i].w * (1.f / 3);
    const Quad changed = load_quad(a.velocities + i) + sum * (share - Quad{});
    a.velocities[i] = {changed[0], changed[1], changed[2], 0};
  }
}

}  // namespace
}  // namespace PLIANT_ISA

const AirKernels& PLIANT_OF_LEVEL(air_kernels)() {
  static constexpr AirKernels table{&find_forces, &apply};
  return table;
}

}  // namespace pliant
