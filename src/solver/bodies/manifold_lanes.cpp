// Contacts of bodies in sixteen SIMD lanes, compiled per instruction set level under the rules of solver/lanes.cpp.
#include "math/lane_bits.h"
#include "math/wide_rows.h"
#include "solver/bodies/manifold_formulas.h"
#include "solver/bodies/manifold_kernels.h"

namespace pliant {
inline namespace PLIANT_ISA {

namespace {

using namespace manifold_formulas;

/// The records of BodyMotion in order.
enum BodyRecord : int { velocity_and_mass, spin, inertia_diagonal, inertia_rest, displacement, rotation };

PLIANT_HD WideRecords load_record(const BodyMotion* motions, BodyRecord record, const std::int32_t* index) {
  return from_registers(load_indexed(reinterpret_cast<const Record*>(motions) + record, index));
}

PLIANT_HD Motion<Wide> load_motion(const BodyMotion* motions, const std::int32_t* index) {
  const WideRecords linear = load_record(motions, velocity_and_mass, index),
                    diagonal = load_record(motions, inertia_diagonal, index),
                    rest = load_record(motions, inertia_rest, index);
  return {
      linear.position,
      load_record(motions, spin, index).position,
      linear.w,
      {diagonal.position.x, diagonal.position.y, diagonal.position.z, diagonal.w, rest.position.x, rest.position.y}};
}

PLIANT_HD Moved<Wide> load_moved(const BodyMotion* motions, const std::int32_t* index) {
  return {load_record(motions, displacement, index).position, load_record(motions, rotation, index).position};
}

constexpr std::uint32_t all_lanes = 0xffff;

PLIANT_HD void store_record(BodyMotion* motions, BodyRecord record, const std::int32_t* index,
                            const WideRecords& values, std::uint32_t moves) {
  Record* const base = reinterpret_cast<Record*>(motions) + record;
  const Registers registers = to_registers(values);
  if (moves == all_lanes) return store_indexed(base, index, registers);
  Record records[4][4];
  static_assert(sizeof records == sizeof registers);
  std::memcpy(static_cast<void*>(records), &registers, sizeof registers);
  for (std::uint32_t left = moves; left != 0; left &= left - 1) {
    const int lane = __builtin_ctz(left);
    base[index[lane]] = records[lane % 4][lane / 4];
  }
}

PLIANT_HD void store_motion(BodyMotion* motions, const std::int32_t* index, const Motion<Wide>& motion,
                            std::uint32_t moves) {
  store_record(motions, velocity_and_mass, index, {motion.velocity, motion.inverse_mass}, moves);
  store_record(motions, spin, index, {motion.spin, Wide(0.f)}, moves);
}

/// Calls pass(block, a, b) for each block, and stores the motions that it leaves.
template <class Pass>
PLIANT_HD void for_blocks(const BlockRange& range, const Pass& pass) {
  for (ManifoldBlock* block = range.first; block != range.last; ++block) {
    Motion<Wide> a = load_motion(range.motions, block->a), b = load_motion(range.motions, block->b);
    pass(*block, a, b);
    store_motion(range.motions, block->a, a, block->moves_a);
    store_motion(range.motions, block->b, b, block->moves_b);
  }
}

void prepare_blocks(const BlockRange& range) {
  for (ManifoldBlock* block = range.first; block != range.last; ++block)
    prepare(block->rows, load_motion(range.motions, block->a), load_motion(range.motions, block->b));
}

void warm_start_blocks(const BlockRange& range) {
  for_blocks(
      range, [](ManifoldBlock & block, Motion<Wide> & a, Motion<Wide> & b) __attribute__((always_inline)) {
        warm_start(block.rows, a, b);
        if (block.rolls != 0) warm_start_rolling(block.rows, a, b);
      });
}

bool bounce_blocks(const BlockRange& range, float h, const Vec3f& fall) {
  std::uint32_t bounced = 0;
  for_blocks(
      range, [&](ManifoldBlock & block, Motion<Wide> & a, Motion<Wide> & b) __attribute__((always_inline)) {
        bounced |= lane_bits(
            bounce(block.rows, a, b, load_moved(range.motions, block.a), load_moved(range.motions, block.b), h, fall));
      });
  return bounced != 0;
}

void position_pass_blocks(const BlockRange& range, const PassNumbers& numbers) {
  for_blocks(
      range, [&](ManifoldBlock & block, Motion<Wide> & a, Motion<Wide> & b) __attribute__((always_inline)) {
        if (block.rolls != 0) resist_rolling(block.rows, a, b);
        position_pass(block.rows, a, b, load_moved(range.motions, block.a), load_moved(range.motions, block.b),
                      numbers);
      });
}

void velocity_pass_blocks(const BlockRange& range, const PassNumbers& numbers) {
  for_blocks(
      range, [&](ManifoldBlock & block, Motion<Wide> & a, Motion<Wide> & b) __attribute__((always_inline)) {
        if (block.rolls != 0) resist_rolling(block.rows, a, b);
        velocity_pass(block.rows, a, b, numbers);
        if (block.settles != 0) settle(block.rows, a, b, numbers);
      });
}

}  // namespace
}  // namespace PLIANT_ISA

const ManifoldKernels& PLIANT_OF_LEVEL(manifold_kernels)() {
  static constexpr ManifoldKernels table{&prepare_blocks, &warm_start_blocks, &bounce_blocks, &position_pass_blocks,
                                         &velocity_pass_blocks};
  return table;
}

}  // namespace pliant
