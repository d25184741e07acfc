// Rejects harmful multigrid corrections. A correction is one Newton step from the prediction, and valid while springs
// rotate little. With extreme mass ratios, or other forces that bend the mesh by more than an edge per substep (a long
// step with rigid bending), it need not converge, and repeated corrections can diverge.
#include <algorithm>
#include <cmath>

#include "solver/substep.h"
#include "solver/sweeps/multigrid_solve.h"

namespace pliant {

namespace {

/// The largest squared displacement of any particle [m^2].
float farthest(const Records& change, int particles) {
  float most = 0;
  for (int i = 0; i < particles; ++i) {
    const Record& c = change[i];
    most = max(most, c.x * c.x + c.y * c.y + c.z * c.z);
  }
  return most;
}

/// Twice the stretching energy of batches [first, last) after `scale` times the correction; each spring is counted at
/// both ends.
double stretching(const MultigridLevel& level, const SweepArguments& a, const Records& change, float scale, int first,
                  int last) {
  double total = 0;
  for (int slot = level.first_slot[first], b = first; b < last; ++b) {
    for (; slot < level.first_slot[b + 1]; ++slot) {
      for (int lane = 0; lane < batch_width; ++lane) {
        const int at = slot * batch_width + lane, i = row_of(b, lane), j = level.column[at];
        if (!(level.stiffness[at] > 0)) continue;
        const Record &p = a.positions[i], &q = a.positions[j], &d = a.displacements[i], &e = a.displacements[j];
        const Record &c = change[i], &f = change[j];
        const Vec3f u{(q.x - p.x) + (e.x - d.x) + scale * (f.x - c.x), (q.y - p.y) + (e.y - d.y) + scale * (f.y - c.y),
                      (q.z - p.z) + (e.z - d.z) + scale * (f.z - c.z)};
        const auto error = static_cast<double>(length(u) - level.rest_length[at]);
        total += static_cast<double>(level.stiffness[at]) * error * error;
      }
    }
  }
  return total;
}

double stretching(Substep& s, int o, float scale) {
  const MultigridLevel& level = s.model.objects[o].multigrid.levels[0];
  MultigridObject& work = multigrid_of(s).objects[o];
  const SweepArguments a = arguments(s, o, false);
  const int batches = level.batches(), tasks = (batches + batches_per_task - 1) / batches_per_task;
  for_tasks(s, nullptr, tasks, [&](int task) {
    const int first = task * batches_per_task, last = std::min(first + batches_per_task, batches);
    work.sums[task] = stretching(level, a, work.change, scale, first, last);
  });
  double total = 0;
  for (int task = 0; task < tasks; ++task) total += work.sums[task];
  return total;
}

}  // namespace

bool is_multigrid_change_sound(Substep& s, int o) {
  const Multigrid& model = s.model.objects[o].multigrid;
  const Records& change = multigrid_of(s).objects[o].change;
  if (!s.kernels.all_finite(change.data(), 0, model.levels[0].batches() * batch_width)) return false;
  const float most = farthest(change, s.model.objects[o].particles);
  if (most <= model.edge_length * model.edge_length) return true;
  return stretching(s, o, 1) <= stretching(s, o, 0);
}

}  // namespace pliant
