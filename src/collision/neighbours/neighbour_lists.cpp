#include "collision/neighbours/neighbour_lists.h"

#include <algorithm>
#include <memory>
#include <numeric>

#include "core/at.h"

namespace pliant {

namespace {

/// Slots farther apart than this many reaches do not share candidates: they would have those between them too.
constexpr float largest_box = 3;
/// Rows that NeighbourKernels::write_rows may write behind those wanted.
constexpr int most_rows_beyond = 3;

/// Resizes without the reserve of vectors that grow by themselves.
template <class T>
void resize_to(std::vector<T>& vector, std::size_t size) {
  vector.reserve(size);
  vector.resize(size);
}

}  // namespace

/// Finds the neighbours of slots that lie together; of others, of each half.
void NeighbourLists::find_together(const NeighbourKernels& kernels, std::int32_t first, std::int32_t last, int lane,
                                   Task& task, NeighbourScratch& scratch) const {
  Vec3f low{x_[at(first)], y_[at(first)], z_[at(first)]}, high = low;
  for (std::int32_t i = first + 1; i < last; ++i) {
    const Vec3f p{x_[at(i)], y_[at(i)], z_[at(i)]};
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  const Vec3f size = high - low;
  if (last - first > 1 && !(std::max({size.x, size.y, size.z}) <= largest_box * reach_)) {
    const std::int32_t middle = first + (last - first) / 2;
    find_together(kernels, first, middle, lane, task, scratch);
    return find_together(kernels, middle, last, lane + middle - first, task, scratch);
  }
  const Vec3f reach{reach_, reach_, reach_};
  order_.find(low - reach, high + reach, task.ranges);
  kernels.find({x_.data(), y_.data(), z_.data(), reach_, low, high, task.ranges.data(),
                static_cast<int>(task.ranges.size()), first, last},
               lane, scratch);
}

/// Appends the lists of sixteen slots side by side. Returns their number of rows.
int NeighbourLists::append(const NeighbourKernels& kernels, NeighbourScratch& scratch, Task& task) const {
  const int rows = *std::max_element(scratch.count, scratch.count + lanes);
  const std::size_t needed = task.used + at(rows + most_rows_beyond) * lanes;
  if (task.slots.size() < needed) resize_to(task.slots, needed + needed / 8);
  kernels.write_rows(scratch, nobody(), rows, task.slots.data() + task.used);
  task.used += at(rows) * lanes;
  return rows;
}

void NeighbourLists::find_in_task(const NeighbourKernels& kernels, int number, NeighbourScratch& scratch) {
  Task& task = tasks_[at(number)];
  task.used = 0;
  task.left_out = 0;
  const int first = number * groups_in_a_task, last = std::min(first + groups_in_a_task, groups());
  for (int g = first; g < last; ++g) {
    std::fill_n(scratch.count, lanes, 0);
    std::fill_n(scratch.has_more, lanes, 0);
    find_together(kernels, g * lanes, std::min((g + 1) * lanes, slots()), 0, task, scratch);
    groups_[at(g)].rows = append(kernels, scratch, task);
    task.left_out += std::accumulate(scratch.has_more, scratch.has_more + lanes, 0);
  }
  if (keeps_factors_ && task.factors.size() < task.used) resize_to(task.factors, task.used + task.used / 16);
  std::size_t from = 0;
  for (int g = first; g < last; ++g) {
    groups_[at(g)].slots = task.slots.data() + from;
    groups_[at(g)].factors = keeps_factors_ ? task.factors.data() + from : nullptr;
    from += at(groups_[at(g)].rows) * lanes;
  }
}

void NeighbourLists::find(Executor& executor, const NeighbourKernels& kernels, std::span<const Record> points,
                          float reach, bool keeps_factors) {
  reach_ = reach;
  keeps_factors_ = keeps_factors;
  {
    const Stopwatch watch(executor.timings(), "neighbours: order");
    order_.sort(executor, points, reach);
    const std::size_t padded = at(nobody()) + lanes;
    for (std::vector<float>* axis : {&x_, &y_, &z_}) axis->resize(padded);
    executor.parallel_for(nullptr, tasks(), [&](int task) {
      const int first = task * groups_in_a_task * lanes, last = std::min(first + groups_in_a_task * lanes, slots());
      for (int slot = first; slot < last; ++slot) {
        const Record& p = points[at(order_.points()[at(slot)])];
        x_[at(slot)] = p.x;
        y_[at(slot)] = p.y;
        z_[at(slot)] = p.z;
      }
    });
    groups_.resize(at(groups()));
    tasks_.resize(at(tasks()));
  }
  executor.parallel_for("neighbours: lists", tasks(), [&](int task) {
    thread_local std::unique_ptr<NeighbourScratch> scratch = std::make_unique<NeighbourScratch>();
    find_in_task(kernels, task, *scratch);
  });
  left_out_ = 0;
  for (const Task& task : tasks_) left_out_ += task.left_out;
}

std::int64_t NeighbourLists::bytes() const {
  std::size_t bytes = 0;
  for (const Task& task : tasks_) bytes += 4 * (task.slots.capacity() + task.factors.capacity());
  return static_cast<std::int64_t>(bytes);
}

}  // namespace pliant
