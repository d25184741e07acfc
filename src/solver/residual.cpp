#include "solver/residual.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/project.h"
#include "solver/substep.h"

namespace pliant {

namespace {

struct Lanes {
  float at[batch_width];
};

int count_valid(const Segment& segment) {
  int count = 0;
  for (int batch = 0; batch < segment.batches; ++batch)
    for (int lane = 0; lane < batch_width; ++lane) count += lane_is_valid(segment, batch, lane) ? 1 : 0;
  return count;
}

/// Computes the vectors between the two ends of a batch's distance constraints.
void load_across(const SweepArguments& a, const Segment& segment, const std::int32_t* index, Lanes (&across)[3]) {
  for (int lane = 0; lane < batch_width; ++lane) {
    const int from = particle_of(segment, index, 0, lane), to = particle_of(segment, index, 1, lane);
    const Record &p = a.positions[from], &q = a.positions[to], &d = a.displacements[from], &e = a.displacements[to];
    across[0].at[lane] = (q.x - p.x) + (e.x - d.x);
    across[1].at[lane] = (q.y - p.y) + (e.y - d.y);
    across[2].at[lane] = (q.z - p.z) + (e.z - d.z);
  }
}

/// Computes the squares of C + alpha~ lambda for one batch; lanes without a constraint are included.
void add_batch(const SweepArguments& a, const Pool& pool, std::int64_t batch, const float* multipliers,
               const Lanes (&across)[3], Lanes& squares) {
  const float *rest = pool.row(0, batch), *response = pool.row(1, batch);
  const float* multiplier = multipliers != nullptr ? multipliers + batch * batch_width : nullptr;
  for (int lane = 0; lane < batch_width; ++lane) {
    const float x = across[0].at[lane], y = across[1].at[lane], z = across[2].at[lane];
    float error = pliant::sqrt(x * x + y * y + z * z) - rest[lane];
    if (multiplier != nullptr) error += min(response[lane] * a.inverse_h2, largest_compliance) * multiplier[lane];
    squares.at[lane] = error * error;
  }
}

double sum_of(const SweepArguments& a, const Pool& pool, const Segment& segment) {
  const bool has = a.multipliers != nullptr && pool.law != Law::pbd;
  const float* multipliers = has ? a.multipliers[segment.pool] : nullptr;  // pools of rigid constraints may store none
  const std::int32_t* index = pool.indices.data() + segment.index_offset;
  double sums[batch_width] = {};
  for (int batch = 0; batch < segment.batches; ++batch, index += indices_per_batch(pool, segment)) {
    Lanes across[3], squares;
    load_across(a, segment, index, across);
    add_batch(a, pool, segment.first_batch + batch, multipliers, across, squares);
    for (int lane = 0; lane < batch_width; ++lane)
      sums[lane] += lane_is_valid(segment, batch, lane) ? static_cast<double>(squares.at[lane]) : 0;
  }
  double sum = 0;
  for (double lane : sums) sum += lane;
  return sum;
}

}  // namespace

void prepare_residual(const Model& model, ResidualScratch& scratch) {
  scratch = {};
  for (int o = 0; o < static_cast<int>(model.objects.size()); ++o) {
    const CompiledObject& object = model.objects[o];
    for (int i = 0; i < static_cast<int>(object.lengths.size()); ++i) scratch.tasks.push_back({o, i});
    for (const Segment& segment : object.segments)
      scratch.constraints += object.pools[segment.pool].is_length ? count_valid(segment) : 0;
  }
  scratch.squares.assign(scratch.tasks.size(), 0);
}

double distance_residual(Substep& s) {
  ResidualScratch& scratch = s.work.residual;
  if (scratch.constraints == 0) return std::numeric_limits<double>::infinity();
  for_tasks(s, "solve: residual", static_cast<int>(scratch.tasks.size()), [&](int task) {
    const int number = scratch.tasks[task].object;
    const CompiledObject& object = s.model.objects[number];
    const LengthRange& range = object.lengths[scratch.tasks[task].item];
    double sum = 0;
    for (int i = range.first; i < range.last; ++i) {
      const Segment& segment = object.segments[i];
      const Pool& pool = object.pools[segment.pool];
      if (pool.is_length) sum += sum_of(arguments(s, number, false), pool, segment);
    }
    scratch.squares[task] = sum;
  });
  double sum = 0;
  for (double squares : scratch.squares) sum += squares;  // summed in task order, independent of threads
  return std::sqrt(sum / static_cast<double>(scratch.constraints));
}

}  // namespace pliant
