// The driver of shape matching, in colours over the clusters of each object (solver/clusters.h).
#include "solver/clusters.h"

#include "solver/drivers/driver.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

namespace {

/// Colours with less work run on one thread, because waking others takes longer.
constexpr int least_work_to_share = 64;

}  // namespace

void project_clusters(Substep& s, const Phase& phase, const Pass& pass) {
  for_tasks(s, phase, "solve: clusters", least_work_to_share, [&](const Task& task) {
    const CompiledObject& object = s.model.objects[task.object];
    if (pass.number >= sweep_method(object.sweep).passes) return;
    std::vector<Vec3f>& multipliers = s.work.cluster_multipliers[task.object];
    project_cluster(object.clusters, task.item, arguments(s, task.object, pass.first),
                    multipliers.empty() ? nullptr : multipliers.data());
  });
}

}  // namespace pliant
