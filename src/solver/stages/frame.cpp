// Starts and ends a frame.
#include <algorithm>

#include "solver/pair_words.h"
#include "solver/stages/stages.h"
#include "solver/substep_law.h"

namespace pliant {

namespace {

bool may_sweep_on_entry(const Substep& s) {
  const StepContext& context = s.context;
  const bool untangles = s.has_pairs() && s.pairs->untangles();
  return !context.record_residuals && context.options.acceleration == SweepOptions::Acceleration::none && !untangles;
}

Substep begin_group(const StepContext& context, const GroupFrame& of, double dt, Report& report) {
  Substep s{context, context.model, context.state, context.workspace, context.kernels, report};
  const bool has_all = of.group == nullptr || of.group->has_all;
  s.part = has_all ? nullptr : of.group;
  s.pairs = has_all ? s.work.pairs.get() : of.group->pairs.get();
  s.frame_start = s.state.time;
  s.dt = dt;
  s.h = static_cast<float>(dt / of.substeps);
  s.planned = s.substeps = of.substeps;
  s.least = of.substeps;
  s.most = of.most_substeps;
  s.least_hanging = of.least_hanging;
  if (of.group != nullptr) s.own_lengths = &of.group->lengths;
  for_objects(s, [&](int o) {
    s.work.gravity[o] = {0, static_cast<double>(s.h), 0, 1 / (1 + s.h * s.model.objects[o].damping)};
    s.work.last_h[o] = s.h;
  });
  forget_substeps(s);
  begin_quarter(s);
  if (s.has_pairs()) s.pairs->begin_frame(s.state.positions.data(), s.work.look_for_tangles);
  s.sweeps_on_entry = may_sweep_on_entry(s);
  return s;
}

void add(const PairCounts& c, PairReport& sum) {
  sum.candidates += c.candidates;
  sum.contacts += c.contacts;
  sum.truncated += c.truncated;
  sum.unresolvable += c.unresolvable;
  sum.initially_intersecting += c.intersecting;
  sum.rebuilds += c.rebuilds;
  sum.inside += c.inside;
  sum.deepest = std::max(sum.deepest, c.deepest);
}

}  // namespace

std::vector<Substep> begin_frame(const StepContext& context, double dt, Report& report) {
  Workspace& work = context.workspace;
  for (TileScratch& tile : work.tiles) tile.finite = true;
  std::vector<Substep> groups;
  groups.reserve(std::max<std::size_t>(1, context.groups.size()));
  for (const GroupFrame& group : context.groups) groups.push_back(begin_group(context, group, dt, report));
  if (groups.empty()) groups.push_back(begin_group(context, {nullptr, context.substeps}, dt, report));
  if (std::any_of(groups.begin(), groups.end(), [](const Substep& s) { return s.has_pairs(); }))
    work.look_for_tangles = false;
  if (work.contact_log != nullptr) work.contact_log->clear();
  return groups;
}

void end_group(Substep& s) {
  s.report.substeps = std::max(s.report.substeps, s.made + 1);
  const auto count = [&](const std::vector<Contact>& contacts) {
    s.report.contacts += std::count_if(contacts.begin(), contacts.end(), [](const Contact& c) { return c.push > 0; });
  };
  for_each_tile(s, [&](int task) { count(s.work.tiles[task].contacts); });
  count(s.work.shape_contacts.contacts());
  if (!s.has_pairs()) return;
  add(s.pairs->counts(), s.report.pairs);
  warn_of_pairs(s.model, *s.pairs, s.report.warnings);
}

void end_frame(std::vector<Substep>& groups) {
  const Substep& s = groups.front();  // at a frame's end all groups have reached the same time
  s.report.stopped = s.substeps < s.planned;
  s.state.time = s.report.stopped ? time_of(s, s.substeps) : s.frame_start + s.dt;
}

}  // namespace pliant
