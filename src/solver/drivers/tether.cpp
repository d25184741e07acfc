// The driver of tethers: upper bounds of each particle's distance to its pins. Pins do not move in response, so
// particles are independent.
#include <algorithm>

#include "solver/drivers/driver.h"
#include "solver/sweeps/chain_kernels.h"
#include "solver/tethers.h"

namespace pliant {

namespace {

/// Particles per task of the tether loop.
constexpr int particles_per_task = 4096;

void hold_tethers_of(Substep& s, int o) {
  const CompiledObject& object = s.model.objects[o];
  const SweepArguments a = arguments(s, o, false);
  if (!tethers_hold(object, a.positions)) return;
  // A copy of the anchors, because another thread may write their records meanwhile.
  Records& anchors = s.work.anchors[o];
  for (std::size_t i = 0; i < object.tethers.anchors.size(); ++i) {
    anchors[2 * i] = a.positions[object.tethers.anchors[i]];
    anchors[2 * i + 1] = a.displacements[object.tethers.anchors[i]];
  }
  const int tasks = (object.particles + particles_per_task - 1) / particles_per_task;
  for_tasks(s, "solve: tethers", tasks, [&](int task) {
    const int first = task * particles_per_task, last = std::min(first + particles_per_task, object.particles);
    s.kernels.chains.hold_tethers(object.tethers, anchors.data(), first, last, a);
  });
}

}  // namespace

bool tethers_hold(const CompiledObject& object, const Record* positions) {
  if (object.sweep != Sweep::tethered_chains) return true;
  const auto apart = [](const Record& p, const Record& q) {
    return length_squared(Vec3f{q.x - p.x, q.y - p.y, q.z - p.z});
  };
  const std::vector<int>& anchors = object.tethers.anchors;
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    const int from = anchors[i], to = anchors[(i + 1) % anchors.size()];
    if (apart(positions[from], positions[to]) > 1.02f * apart(object.positions[from], object.positions[to]))
      return false;
  }
  return true;
}

void hold_tethers(Substep& s, const Phase& phase, const Pass& /*pass*/) {
  for (const Task& task : phase.tasks) hold_tethers_of(s, task.object);
}

}  // namespace pliant
