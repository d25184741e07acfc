// Sets the multipliers of compliant distances after the multigrid correction, so that the sweeps continue from it.
#include "constraints/registry.h"
#include "solver/substep.h"
#include "solver/sweeps/multigrid.h"

namespace pliant {

namespace {

/// Sets lambda = -K C h^2 after the first correction of a substep, and adds -K h^2 times the change of C after later
/// ones. C is linearised, because lengthening by rotation is no force; sweeps correct it. Rigid constraints need no
/// multiplier.
void add_multipliers(const CompiledObject& object, const Segment& segment, const SweepArguments& a,
                     const Record* change) {
  const Pool& pool = object.pools[segment.pool];
  float* multipliers = a.multipliers != nullptr ? a.multipliers[segment.pool] : nullptr;
  if (multipliers == nullptr || pool.law == Law::pbd || !is_length(pool.type)) return;
  const std::int32_t* index = pool.indices.data() + segment.index_offset;
  for (int b = 0; b < segment.batches; ++b, index += indices_per_batch(pool, segment)) {
    const std::int64_t batch = segment.first_batch + b;
    for (int lane = 0; lane < batch_width; ++lane) {
      if (!lane_is_valid(segment, b, lane)) continue;
      const int i = particle_of(segment, index, 0, lane), j = particle_of(segment, index, 1, lane);
      const Record &p = a.positions[i], &q = a.positions[j], &d = a.displacements[i], &e = a.displacements[j];
      const Vec3f u{(q.x - p.x) + (e.x - d.x), (q.y - p.y) + (e.y - d.y), (q.z - p.z) + (e.z - d.z)};
      const Record &from = change[i], &to = change[j];
      const Vec3f moved{to.x - from.x, to.y - from.y, to.z - from.z}, before = u - moved;
      const std::vector<float>& limits = object.multigrid.stiffness_limit;
      const float stiffness = spring_stiffness(pool.row(1, batch)[lane], max(limits[i], limits[j]));
      const float was = length(before), error = a.first_pass ? was - pool.row(0, batch)[lane] : 0;
      const float linearised = error + dot(before, moved) / max(was, 1e-30f);
      multipliers[batch * batch_width + lane] -= stiffness * linearised / a.inverse_h2;
    }
  }
}

bool keeps_distance_multipliers(const CompiledObject& object, const SweepArguments& a) {
  if (a.multipliers == nullptr) return false;
  for (std::size_t p = 0; p < object.pools.size(); ++p)
    if (a.multipliers[p] != nullptr && is_length(object.pools[p].type)) return true;
  return false;
}

}  // namespace

void keep_multigrid_multipliers(Substep& s, int o, bool first) {
  const CompiledObject& object = s.model.objects[o];
  const SweepArguments a = arguments(s, o, first);
  if (!keeps_distance_multipliers(object, a)) return;
  const Record* change = multigrid_of(s).objects[o].change.data();
  for_tasks(s, nullptr, static_cast<int>(object.segments.size()),
            [&](int i) { add_multipliers(object, object.segments[i], a, change); });
}

void clear_multigrid_multipliers(Substep& s) {
  for (std::size_t o = 0; o < s.model.objects.size(); ++o) {
    if (!is_swept(s, static_cast<int>(o))) continue;
    for (auto& values : s.work.multipliers[o]) std::fill(values.begin(), values.end(), 0.f);
    s.work.volume_multipliers[o] = 0;
  }
}

}  // namespace pliant
