#include "solver/bodies/manifold_blocks.h"

#include <algorithm>
#include <atomic>
#include <cstddef>

#include "core/at.h"
#include "parallel/ranges.h"

namespace pliant {

namespace {

constexpr int block_width = 16;
/// Blocks per task. A colour with fewer is done before other threads wake up.
constexpr int blocks_a_task = 32;
/// Blocks per task where they are filled.
constexpr int blocks_a_fill = 16;

/// True if a manifold has a normal impulse.
bool presses(const ManifoldBlock& block, int lane) {
  float sum = 0;
  for (const auto& impulse : block.rows.impulse) sum += impulse[lane];
  return sum > 0;
}

}  // namespace

/// Prefetches what the next block needs, and if it is the first one of a task, what this one needs.
void ManifoldBlocks::prefetch_block(int number, const ManifoldColours& colours, FunctionRef<void(int)> prefetch) const {
  const int last = std::min(number + 2, static_cast<int>(first_.size()) - 1);
  const int from = number % blocks_a_fill == 0 ? number : number + 1;
  for (int i = first_[at(std::min(from, last))]; i < first_[at(last)]; ++i) prefetch(colours.order()[at(i)]);
}

void ManifoldBlocks::fill_block(int number, const ManifoldColours& colours, std::span<const char> is_fixed,
                                FunctionRef<Manifold(int)> manifold) {
  ManifoldBlock& block = blocks_[at(number)];
  block = {};
  const int first = first_[at(number)];
  block.lanes = first_[at(number + 1)] - first;
  for (int lane = 0; lane < block_width; ++lane) {
    if (lane >= block.lanes) {
      block.a[lane] = block.a[0];
      block.b[lane] = block.b[0];
      for (auto& gap : block.rows.gap) gap[lane] = no_point;
      for (auto& gap : block.rows.gap_now) gap[lane] = no_point;
      continue;
    }
    const Manifold m = manifold(colours.order()[at(first + lane)]);
    block.a[lane] = records_a_motion * m.a;
    block.b[lane] = records_a_motion * m.b;
    put_manifold(m, block.rows, lane);
    if (is_fixed[at(m.a)] == 0) block.moves_a |= 1u << lane;
    if (is_fixed[at(m.b)] == 0) block.moves_b |= 1u << lane;
    if (m.restitution > 0) block.bounces = 1;
    if (m.rolling > 0) block.rolls = 1;
    if (m.settles > 0) block.settles = 1;
  }
}

void ManifoldBlocks::fill(Executor& executor, const ManifoldColours& colours, std::span<const char> is_fixed,
                          FunctionRef<void(int)> prefetch, FunctionRef<Manifold(int)> manifold) {
  first_.clear();
  for (int c = 0; c <= manifold_colours; ++c) {
    start_[at(c)] = static_cast<int>(first_.size());
    for (int i = colours.start()[at(c)]; i < colours.start()[at(c + 1)]; i += block_width) first_.push_back(i);
  }
  const int count = start_.back() = static_cast<int>(first_.size());
  first_.push_back(colours.start().back());
  blocks_.resize(at(count));
  for_items(executor, nullptr, count, blocks_a_fill, [&](int i) {
    prefetch_block(i, colours, prefetch);
    fill_block(i, colours, is_fixed, manifold);
  });
}

void ManifoldBlocks::take(Executor& executor, const ManifoldColours& colours, FunctionRef<void(int)> prefetch,
                          FunctionRef<void(int, const Manifold&)> keep) const {
  for_items(executor, nullptr, static_cast<int>(blocks_.size()), blocks_a_fill, [&](int i) {
    prefetch_block(i, colours, prefetch);
    const ManifoldBlock& block = blocks_[at(i)];
    for (int lane = 0; lane < block.lanes; ++lane) {
      Manifold m;
      m.count = 4;
      take_impulses(block.rows, lane, m);
      keep(colours.order()[at(first_[at(i)] + lane)], m);
    }
  });
}

void ManifoldBlocks::scale_impulses(Executor& executor, float factor) {
  for_items(executor, nullptr, static_cast<int>(blocks_.size()), blocks_a_task, [&](int i) {
    ManifoldRows<16>& rows = blocks_[at(i)].rows;
    for (int lane = 0; lane < block_width; ++lane) {
      for (auto& impulse : rows.impulse) impulse[lane] *= factor;
      for (auto& impulse : rows.friction_impulse) impulse[lane] *= factor;
      rows.twist_impulse[lane] *= factor;
      for (auto& impulse : rows.rolling_impulse) impulse[lane] *= factor;
    }
  });
}

void ManifoldBlocks::set_arms(int number, const Vec3f& arm_a, const Vec3f& arm_b) {
  const auto block = std::upper_bound(first_.begin(), first_.end(), number) - first_.begin() - 1;
  const int lane = number - first_[at(block)];
  ManifoldRows<16>& rows = blocks_[at(block)].rows;
  set_row(arm_a, rows.arm_a, lane);
  set_row(arm_b, rows.arm_b, lane);
}

bool ManifoldBlocks::bounces() const {
  return std::any_of(blocks_.begin(), blocks_.end(), [](const ManifoldBlock& block) { return block.bounces != 0; });
}

void ManifoldBlocks::clear_bounced() {
  for (ManifoldBlock& block : blocks_)
    if (block.bounces != 0) std::fill_n(block.rows.bounced, block_width, 0.f);
}

void ManifoldBlocks::for_bounced(const ManifoldColours& colours, FunctionRef<void(int, float)> visit) const {
  for (std::size_t i = 0; i < blocks_.size(); ++i)
    for (int lane = 0; blocks_[i].bounces != 0 && lane < blocks_[i].lanes; ++lane) {
      const float impulse = blocks_[i].rows.bounced[lane];
      if (impulse > 0) visit(colours.order()[at(first_[i] + lane)], impulse);
    }
}

int ManifoldBlocks::pressing() const {
  int count = 0;
  for (const ManifoldBlock& block : blocks_)
    for (int lane = 0; lane < block.lanes; ++lane) count += presses(block, lane) ? 1 : 0;
  return count;
}

void ManifoldBlocks::for_pressing(const ManifoldColours& colours, FunctionRef<void(int)> visit) const {
  for (std::size_t i = 0; i < blocks_.size(); ++i)
    for (int lane = 0; lane < blocks_[i].lanes; ++lane)
      if (presses(blocks_[i], lane)) visit(colours.order()[at(first_[i] + lane)]);
}

void ManifoldBlocks::run(Executor& executor, const ManifoldKernels& kernels, std::span<BodyMotion> motions,
                         const Pass& pass) {
  const auto range = [&](int first, int last) -> BlockRange {
    return {blocks_.data() + first, blocks_.data() + last, motions.data()};
  };
  for (int c = 0; c < manifold_colours && start_[at(c)] < start_.back(); ++c) {
    const int first = start_[at(c)], last = start_[at(c + 1)];
    for_ranges(executor, nullptr, last - first, blocks_a_task,
               [&](int from, int to) { pass(kernels, range(first + from, first + to)); });
  }
  const int tail = start_[manifold_colours];
  if (tail < start_.back()) pass(manifold_kernels_sequential(), range(tail, start_.back()));
}

void ManifoldBlocks::prepare(Executor& executor, const ManifoldKernels& kernels, std::span<BodyMotion> motions) {
  run(executor, kernels, motions, [](const ManifoldKernels& k, const BlockRange& range) { k.prepare(range); });
}

void ManifoldBlocks::warm_start(Executor& executor, const ManifoldKernels& kernels, std::span<BodyMotion> motions) {
  run(executor, kernels, motions, [](const ManifoldKernels& k, const BlockRange& range) { k.warm_start(range); });
}

bool ManifoldBlocks::bounce(Executor& executor, const ManifoldKernels& kernels, std::span<BodyMotion> motions, float h,
                            const Vec3f& fall) {
  std::atomic<bool> bounced{false};
  run(executor, kernels, motions, [&](const ManifoldKernels& k, const BlockRange& range) {
    if (k.bounce(range, h, fall)) bounced.store(true, std::memory_order_relaxed);
  });
  return bounced.load();
}

void ManifoldBlocks::position_pass(Executor& executor, const ManifoldKernels& kernels, std::span<BodyMotion> motions,
                                   float h, const ContactSoftness& softness) {
  const PassNumbers numbers = pass_numbers(h, softness);
  run(executor, kernels, motions,
      [&](const ManifoldKernels& k, const BlockRange& range) { k.position_pass(range, numbers); });
}

void ManifoldBlocks::velocity_pass(Executor& executor, const ManifoldKernels& kernels, std::span<BodyMotion> motions,
                                   float h) {
  const PassNumbers numbers = pass_numbers(h, {});
  run(executor, kernels, motions,
      [&](const ManifoldKernels& k, const BlockRange& range) { k.velocity_pass(range, numbers); });
}

}  // namespace pliant
