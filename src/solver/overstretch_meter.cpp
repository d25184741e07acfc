#include "solver/overstretch_meter.h"

#include <algorithm>
#include <functional>

#include "constraints/registry.h"
#include "math/scalar.h"
#include "solver/visit.h"

namespace pliant {

namespace {

/// The threshold of the next frame leaves up to this many times the constraints that the percentile needs. If it left
/// fewer than one and a quarter as many, it decreases.
constexpr std::size_t listed = 2;
constexpr float decrease = 0.8f;
/// A threshold that is taken from a value is a little less, so that it finds that value again.
constexpr float a_little_less = 0.999f;
/// How often the threshold is halved before everything that is too long is listed.
constexpr int threshold_halvings = 4;
/// Bins begin at the threshold. Each is as wide as these bits of a float count: 64 bins from a value to its double.
constexpr int bits_per_bin = 17;

/// The bits of floats without sign have the same order as their values.
int bin_of(float value, float above, int bins) {
  const std::uint32_t beyond = bits_as<std::uint32_t>(value) - bits_as<std::uint32_t>(above);
  return std::min(static_cast<int>(beyond >> bits_per_bin), bins - 1);
}

float start_of(int bin, float above) {
  return bits_as<float>(bits_as<std::uint32_t>(above) + (static_cast<std::uint32_t>(bin) << bits_per_bin));
}

/// The number of constraints from the 99th percentile up.
std::size_t number_beyond(std::int64_t constraints) {
  const auto below = static_cast<std::int64_t>(0.99 * static_cast<double>(constraints - 1));
  return static_cast<std::size_t>(constraints - below);
}

/// The user's number of a particle; for the target of an attachment, at which chains may end, that of the attached
/// particle.
int user_particle(const CompiledObject& object, int storage) {
  int user = object.order[static_cast<std::size_t>(storage)];
  if (user < object.user_particles) return user;
  for (int type = 0; type < constraint_type_count(); ++type) {
    if (!is_length(type)) continue;
    for_constraints(object, type, [&](const ConstraintPlace& at, const std::int32_t* particle) {
      if (at.value(0) == 0 && particle[0] == storage) user = object.order[static_cast<std::size_t>(particle[1])];
      if (at.value(0) == 0 && particle[1] == storage) user = object.order[static_cast<std::size_t>(particle[0])];
    });
  }
  return user;
}

}  // namespace

Overstretch OverstretchMeter::measure(const MeasuredFrame& frame, Executor* executor) {
  Overstretch measured;
  list_tasks(frame.model);
  for (const Task& task : tasks_)
    measured.constraints += frame.model.objects[task.object].lengths[task.item].constraints;
  if (measured.constraints == 0) return measured;
  const std::size_t beyond = number_beyond(measured.constraints);
  std::size_t found = find(frame, executor);
  for (int halved = 0; found < beyond && above_ > 0; ++halved) {
    above_ = halved < threshold_halvings ? above_ / 2 : 0;
    found = find(frame, executor);
  }
  count(frame, measured);
  measured.p99 = found < beyond ? 0 : static_cast<double>(value_of_rank(beyond));
  above_ = next_threshold(beyond, found);
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

void OverstretchMeter::count(const MeasuredFrame& frame, Overstretch& into) {
  counts_.fill(0);
  const FoundLength* largest = nullptr;
  for (std::size_t task = 0; task < tasks_.size(); ++task)
    for (const FoundLength& one : found_[task]) {
      ++counts_[static_cast<std::size_t>(bin_of(one.value, above_, bins))];
      if (largest != nullptr && !(one.value > largest->value)) continue;
      largest = &one;
      into.object = tasks_[task].object;
    }
  if (largest == nullptr) return;
  const CompiledObject& object = frame.model.objects[into.object];
  const auto [from, to] = ends_of(object, *largest);
  into.largest = static_cast<double>(largest->value);
  into.particles = {user_particle(object, from), user_particle(object, to)};
}

int OverstretchMeter::bin_of_rank(std::size_t& rank) const {
  int bin = bins - 1;
  for (; bin > 0 && rank > static_cast<std::size_t>(counts_[static_cast<std::size_t>(bin)]); --bin)
    rank -= static_cast<std::size_t>(counts_[static_cast<std::size_t>(bin)]);
  return bin;
}

float OverstretchMeter::value_of_rank(std::size_t rank) const {
  const int bin = bin_of_rank(rank);
  std::vector<float> values;
  for (std::size_t task = 0; task < tasks_.size(); ++task)
    for (const FoundLength& one : found_[task])
      if (bin_of(one.value, above_, bins) == bin) values.push_back(one.value);
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank - 1);
  std::nth_element(values.begin(), at, values.end(), std::greater<>());
  return *at;
}

/// The last bin has no upper end: where the threshold is much too low, it begins far below the values in it.
float OverstretchMeter::next_threshold(std::size_t beyond, std::size_t found) const {
  if (4 * found <= 5 * beyond) return decrease * above_;
  const std::size_t wanted = std::min(listed * beyond, found);
  std::size_t rank = wanted;
  const int bin = bin_of_rank(rank);
  return bin < bins - 1 ? start_of(bin, above_) : a_little_less * value_of_rank(wanted);
}

}  // namespace pliant
