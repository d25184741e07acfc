// Lists of the neighbours of points within a distance: for sixteen consecutive slots the k-th neighbours of all of them
// side by side, so that sixteen points are summed over in SIMD lanes. Each lane adds its neighbours in ascending order,
// as plain code would.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "collision/neighbours/cell_order.h"
#include "collision/neighbours/neighbour_kernels.h"
#include "parallel/executor.h"

namespace pliant {

class NeighbourLists {
 public:
  static constexpr int lanes = neighbour_lanes;
  static constexpr int groups_in_a_task = 32;

  /// Finds the neighbours of points within `reach` [m]. `keeps_factors` makes room for NeighbourGroup::factors.
  void find(Executor& executor, const NeighbourKernels& kernels, std::span<const Record> points, float reach,
            bool keeps_factors = false);

  const CellOrder& order() const { return order_; }
  int slots() const { return static_cast<int>(order_.points().size()); }
  int groups() const { return (slots() + lanes - 1) / lanes; }
  int tasks() const { return (groups() + groups_in_a_task - 1) / groups_in_a_task; }
  /// A slot behind all others, for a point that is nobody's neighbour.
  std::int32_t nobody() const { return groups() * lanes; }
  const NeighbourGroup& group(int number) const { return groups_[static_cast<std::size_t>(number)]; }
  /// How many points have more neighbours than most_neighbours.
  int left_out() const { return left_out_; }
  std::int64_t bytes() const;

 private:
  struct Task {
    std::vector<std::int32_t> slots;  ///< the first `used` of them
    std::vector<float> factors;
    std::size_t used = 0;
    std::vector<SlotRange> ranges;
    int left_out = 0;
  };

  void find_in_task(const NeighbourKernels& kernels, int number, NeighbourScratch& scratch);
  void find_together(const NeighbourKernels& kernels, std::int32_t first, std::int32_t last, int lane, Task& task,
                     NeighbourScratch& scratch) const;
  int append(const NeighbourKernels& kernels, NeighbourScratch& scratch, Task& task) const;

  float reach_ = 0;
  bool keeps_factors_ = false;
  CellOrder order_;
  std::vector<float> x_, y_, z_;  ///< by slot
  std::vector<NeighbourGroup> groups_;
  std::vector<Task> tasks_;
  int left_out_ = 0;
};

}  // namespace pliant
