#include "math/vector.h"
#include "solver/drivers/contacts.h"
#include "solver/free_objects.h"
#include "solver/group_lag.h"
#include "solver/stages/stages.h"
#include "solver/substep_law.h"

namespace pliant {

namespace {

/// Upper limit of additional contact passes. Each pass propagates a push by one layer.
constexpr int most_rounds_of_contacts = 16;

}  // namespace

void filter(Substep& s) {
  hold_at_surfaces(s);
  if (!s.has_pairs()) return;
  SurfaceContact& pairs = *s.pairs;
  // The filter cannot limit kinematic colliders, so contacts must first move whatever they meet out of their way.
  // Objects that touch none of these keep the bits that they have alone.
  std::vector<char> is_overrun;
  for (int round = 0; round < most_rounds_of_contacts && pairs.find_overrun(all_particles(s), is_overrun); ++round)
    project_contacts_of(s, "solve: contacts among surfaces", is_overrun, 0);
  pairs.filter(s.context.executor, all_particles(s), [&]() -> const FreeBodies& { return free_objects(s); });
  s.report.lost_momentum.filter += length(pairs.lost_momentum());
  s.own->without_velocity.insert(s.own->without_velocity.end(), pairs.without_velocity().begin(),
                                 pairs.without_velocity().end());
  if (s.is_last() || ends_quarter(s)) pairs.measure_overlaps(all_particles(s));
}

void end_filter(Substep& s) {
  for_systems(s, [&](System& system) { system.end_filter(s); });
  const bool has_moved = move_by_lag(s);
  take_from_velocities(s);
  if (s.has_pairs()) s.pairs->end_substep(s.context.executor, all_particles(s), has_moved);
}

}  // namespace pliant
