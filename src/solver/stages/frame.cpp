// The start and the end of a frame.
#include <algorithm>

#include "solver/pair_words.h"
#include "solver/stages/stages.h"

namespace pliant {

namespace {

bool may_sweep_on_entry(const StepContext& context) {
  const bool untangles = context.workspace.pairs != nullptr && context.workspace.pairs->untangles();
  return !context.record_residuals && !context.separate_phases &&
         context.options.acceleration == SweepOptions::Acceleration::none && !untangles;
}

void begin_pairs(const StepContext& context) {
  Workspace& work = context.workspace;
  if (work.pairs == nullptr) return;
  work.pairs->begin_frame(context.state.positions.data(), work.look_for_tangles);
  work.look_for_tangles = false;
}

}  // namespace

Substep begin_frame(const StepContext& context, double dt, Report& report) {
  Substep s{context, context.model, context.state, context.workspace, context.kernels, report, context.state.time};
  s.dt = dt;
  s.h = static_cast<float>(dt / context.substeps);
  s.substeps = context.substeps;
  for (TileScratch& tile : s.work.tiles) tile.finite = true;
  s.work.frames.finite = true;
  for (std::size_t o = 0; o < s.work.gravity.size(); ++o)
    s.work.gravity[o] = {0, static_cast<double>(s.h), 0, 1 / (1 + s.h * s.model.objects[o].damping)};
  begin_pairs(context);
  if (s.work.contact_log != nullptr) s.work.contact_log->clear();
  s.sweeps_on_entry = may_sweep_on_entry(context);
  return s;
}

void end_frame(Substep& s) {
  const auto count = [&](const std::vector<Contact>& contacts) {
    s.report.contacts += std::count_if(contacts.begin(), contacts.end(), [](const Contact& c) { return c.push > 0; });
  };
  for (const TileScratch& tile : s.work.tiles) count(tile.contacts);
  count(s.work.shape_contacts.contacts());
  if (s.has_pairs()) {
    const PairCounts c = s.work.pairs->counts();
    s.report.pairs = {c.candidates,   c.contacts, c.truncated, c.unresolvable,
                      c.intersecting, c.rebuilds, c.inside,    c.deepest};
    warn_of_pairs(s.model, *s.work.pairs, s.report.warnings);
  }
  s.report.stopped = s.substeps < s.context.substeps;
  s.state.time = s.report.stopped ? time_of(s, s.substeps) : s.frame_start + s.dt;
}

}  // namespace pliant
