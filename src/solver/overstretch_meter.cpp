#include "solver/overstretch_meter.h"

#include <algorithm>
#include <functional>

namespace pliant {

namespace {

/// The threshold of the next frame leaves up to this many times the constraints that the percentile needs. If it left fewer
/// than one and a half times as many, it decreases.
constexpr std::size_t listed = 3;
constexpr float decrease = 0.8f;
/// How often the threshold is halved before everything that is too long is listed.
constexpr int halvings = 4;
/// A threshold is a little less than the value that it was taken from, so that it finds that value again.
constexpr float a_little_less = 0.999f;

/// The number of constraints from the 99th percentile up.
std::size_t number_beyond(std::int64_t constraints) {
  const auto below = static_cast<std::int64_t>(0.99 * static_cast<double>(constraints - 1));
  return static_cast<std::size_t>(constraints - below);
}

}  // namespace

Overstretch OverstretchMeter::measure(const MeasuredFrame& frame, Executor* executor) {
  Overstretch measured;
  list_tasks(frame.model);
  for (const Task& task : tasks_) measured.constraints += frame.model.objects[task.object].lengths[task.item].constraints;
  if (measured.constraints == 0) return measured;
  const std::size_t beyond = number_beyond(measured.constraints);
  for (int halved = 0; find(frame, executor) < beyond && above_ > 0; ++halved) above_ = halved < halvings ? above_ / 2 : 0;
  find_largest(frame, measured);
  measured.p99 = take_p99(beyond);
  return measured;
}

void OverstretchMeter::list_tasks(const Model& model) {
  tasks_.clear();
  for (int o = 0; o < static_cast<int>(model.objects.size()); ++o)
    for (int i = 0; i < static_cast<int>(model.objects[o].lengths.size()); ++i)
      tasks_.push_back({o, i, model.objects[o].lengths[i].batches});
  if (found_.size() < tasks_.size()) found_.resize(tasks_.size());
}

std::size_t OverstretchMeter::find(const MeasuredFrame& frame, Executor* executor) {
  const int tasks = static_cast<int>(tasks_.size());
  if (executor != nullptr)
    executor->parallel_for("measure overstretch", tasks, [&](int task) { find_in(frame, task); });
  else
    for (int task = 0; task < tasks; ++task) find_in(frame, task);
  std::size_t count = 0;
  for (int task = 0; task < tasks; ++task) count += found_[task].size();
  return count;
}

void OverstretchMeter::find_in(const MeasuredFrame& frame, int task) {
  const int number = tasks_[task].object;
  const CompiledObject& object = frame.model.objects[number];
  const int first = frame.model.first[number];
  const std::vector<float*>& multipliers = frame.workspace.multiplier_pointers[number];
  const float h = frame.workspace.last_h[number], inverse_h = h > 0 ? 1 / h : 1;
  found_[task].clear();
  find_long(object, object.lengths[tasks_[task].item], frame.kernels,
            {frame.state.positions.data() + first, nullptr, multipliers.empty() ? nullptr : multipliers.data(),
             inverse_h * inverse_h, above_, frame.state.velocities.data() + first},
            found_[task]);
}

void OverstretchMeter::find_largest(const MeasuredFrame& frame, Overstretch& into) const {
  const FoundLength* largest = nullptr;
  for (std::size_t task = 0; task < tasks_.size(); ++task)
    for (const FoundLength& one : found_[task]) {
      if (largest != nullptr && !(one.value > largest->value)) continue;
      largest = &one;
      into.object = tasks_[task].object;
    }
  if (largest == nullptr) return;
  const CompiledObject& object = frame.model.objects[into.object];
  const auto [from, to] = ends_of(object, *largest);
  into.largest = static_cast<double>(largest->value);
  into.particles = {object.order[from], object.order[to]};
}

/// Also chooses the threshold of the next frame.
double OverstretchMeter::take_p99(std::size_t beyond) {
  values_.clear();
  for (std::size_t task = 0; task < tasks_.size(); ++task)
    for (const FoundLength& one : found_[task]) values_.push_back(one.value);
  const auto take = [&](std::size_t rank) {  // 1: the largest
    const auto at = values_.begin() + static_cast<std::ptrdiff_t>(rank - 1);
    std::nth_element(values_.begin(), at, values_.end(), std::greater<>());
    return *at;
  };
  const float p99 = values_.size() < beyond ? 0 : take(beyond);
  const bool has_enough = 2 * values_.size() > 3 * beyond;
  above_ = has_enough ? a_little_less * take(std::min(listed * beyond, values_.size())) : decrease * above_;
  return static_cast<double>(p99);
}

}  // namespace pliant
