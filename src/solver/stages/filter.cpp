#include "solver/drivers/contacts.h"
#include "solver/stages/stages.h"

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
  for (int round = 0; round < most_rounds_of_contacts && pairs.is_overrun(all_particles(s)); ++round) {
    sweep_pairs(s);
    sweep_contacts(s);
  }
  pairs.filter(s.context.executor, all_particles(s));
  if (s.is_last()) pairs.measure_overlaps(all_particles(s));
}

}  // namespace pliant
