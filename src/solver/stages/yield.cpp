// Plastic flow: the rest data of constraints and clusters follow the shape at the substep's end.
#include <span>

#include "constraints/registry.h"
#include "math/functions.h"
#include "model/changing_rest.h"
#include "solver/clusters.h"
#include "solver/stages/stages.h"
#include "solver/visit.h"

namespace pliant {

namespace {

/// A pool whose constraints flow, in one substep.
class PoolFlow {
 public:
  PoolFlow(const Substep& s, CompiledObject& object, int number, const PlasticPool& plastic)
      : object_(object),
        plastic_(plastic),
        pool_(object.pools[static_cast<std::size_t>(plastic.pool)]),
        type_(constraint_type(pool_.type)),
        particles_(arguments(s, number, false)),
        frames_(frame_arguments(s, number)) {
    const std::vector<std::vector<char>>& broken = s.work.joints[static_cast<std::size_t>(number)].is_broken;
    if (!broken.empty()) broken_ = broken[static_cast<std::size_t>(plastic.pool)];
    for (const Plasticity& kind : plastic.kinds)
      laws_.push_back(
          {kind.yield, kind.rate > 0 ? static_cast<float>(-expm1(-double(kind.rate) * double(s.h))) : 1.f, kind.most});
  }

  void run(const Segment& segment) {
    for_segment(object_, segment, [&](const ConstraintPlace& at, const std::int32_t* number) { let_flow(at, number); });
  }

 private:
  void let_flow(const ConstraintPlace& at, const std::int32_t* number) {
    const auto lane = static_cast<std::size_t>(at.batch * batch_width + at.lane);
    if (plastic_.kind[lane] < 0 || (!broken_.empty() && broken_[lane] != 0)) return;
    StencilArrays<float> arrays;
    arrays.load_rest(at);
    load_slots(number, arrays);
    const float* start = &plastic_.start[lane * static_cast<std::size_t>(pool_.fields)];
    if (!type_.flow(arrays.slots, arrays.rest, start, laws_[static_cast<std::size_t>(plastic_.kind[lane])])) return;
    for (int field = 0; field < pool_.fields; ++field) pool_.change(field, at.batch)[at.lane] = arrays.rest[field];
  }

  /// The present values of a constraint's slots: of its points relative to the first.
  void load_slots(const std::int32_t* number, StencilArrays<float>& arrays) const {
    int origin = -1;
    for (int slot = 0; slot < pool_.stencil; ++slot) {
      const std::int32_t n = number[slot];
      if (n >= object_.particles) {
        const Record& q = frames_.orientations[n - object_.particles];
        arrays.set_slot(slot, q.x, q.y, q.z, q.w);
        continue;
      }
      if (origin < 0) origin = n;
      const Record &p = particles_.positions[n], &d = particles_.displacements[n];
      const Record &o = particles_.positions[origin], &first = particles_.displacements[origin];
      arrays.set_slot(slot, ((p.x - o.x) + d.x) - first.x, ((p.y - o.y) + d.y) - first.y, ((p.z - o.z) + d.z) - first.z,
                      0);
    }
  }

  const CompiledObject& object_;
  const PlasticPool& plastic_;
  Pool& pool_;
  const ConstraintDefinition& type_;
  SweepArguments particles_;
  FrameArguments frames_;
  std::span<const char> broken_;  ///< [lane] not zero: part of a broken joint; empty: none is
  std::vector<PlasticFlow> laws_;
};

void let_flow(const Substep& s, CompiledObject& object, int number) {
  for (const PlasticPool& plastic : object.changing.plastic) {
    PoolFlow flow(s, object, number, plastic);
    s.context.executor.parallel_for("yield", static_cast<int>(object.segments.size()), [&](int i) {
      const Segment& segment = object.segments[static_cast<std::size_t>(i)];
      if (segment.pool == plastic.pool) flow.run(segment);
    });
  }
  CompiledClusters& clusters = object.clusters;
  if (clusters.plastic.empty()) return;
  const SweepArguments particles = arguments(s, number, false);
  s.context.executor.parallel_for("yield", static_cast<int>(clusters.plastic.size()), [&](int i) {
    let_cluster_flow(clusters, clusters.plastic[static_cast<std::size_t>(i)], particles, static_cast<double>(s.h));
  });
}

}  // namespace

void yield(Substep& s) {
  if (s.context.changing == nullptr) return;
  for_objects(s, [&](int o) { let_flow(s, (*s.context.changing)[static_cast<std::size_t>(o)], o); });
}

}  // namespace pliant
