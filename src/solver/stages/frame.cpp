// Starts and ends a frame.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "solver/diagnose.h"
#include "solver/pair_words.h"
#include "solver/sheets/sheet_solver.h"
#include "solver/stages/stages.h"
#include "solver/substep_law.h"

namespace pliant {

namespace {

bool may_sweep_on_entry(const Substep& s) {
  const StepContext& context = s.context;
  const bool untangles = s.has_pairs() && s.pairs->untangles();
  return !context.record_residuals && context.options.acceleration == SweepOptions::Acceleration::none && !untangles;
}

Substep begin_group(const StepContext& context, const GroupFrame& of, double dt) {
  Substep s{context,           context.model,   context.state,
            context.workspace, context.kernels, context.workspace.of_thread.data()};
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
  if (of.group != nullptr) {
    s.systems = &of.group->systems;
    s.bodies = of.group->systems.bodies();
    s.own_lengths = &of.group->lengths;
  }
  for_objects(s, [&](int o) {
    s.work.gravity[o] = {0, static_cast<double>(s.h), 0, velocity_kept(s.h, s.model.objects[o].damping)};
    s.work.last_h[o] = s.h;
  });
  forget_substeps(s);
  begin_quarter(s);
  if (s.has_pairs()) s.pairs->begin_frame(s.state.positions.data(), s.work.look_for_tangles);
  for_systems(s, [&](System& system) { system.begin_frame(s); });
  s.sweeps_on_entry = may_sweep_on_entry(s) && !has_sheets(s);
  return s;
}

}  // namespace

std::vector<Substep> begin_frame(const StepContext& context, double dt) {
  Workspace& work = context.workspace;
  const auto threads = static_cast<std::size_t>(context.executor.threads());
  work.of_thread.resize(threads);
  for (SubstepScratch& scratch : work.of_thread) scratch.chains.resize(threads);
  for (TileScratch& tile : work.tiles) tile.finite = true;
  std::vector<Substep> groups;
  groups.reserve(std::max<std::size_t>(1, context.groups.size()));
  for (const GroupFrame& group : context.groups) groups.push_back(begin_group(context, group, dt));
  if (groups.empty()) groups.push_back(begin_group(context, {nullptr, context.substeps}, dt));
  if (std::any_of(groups.begin(), groups.end(), [](const Substep& s) { return s.has_pairs(); }))
    work.look_for_tangles = false;
  if (work.contact_log != nullptr) work.contact_log->clear();
  if (work.sums_joint_loads) {
    work.joint_loads.resize(context.model.objects.size());
    for (JointLoadSums& sums : work.joint_loads) sums.is_complete = true;
  }
  return groups;
}

bool may_run_side_by_side(const std::vector<Substep>& groups) {
  const StepContext& context = groups.front().context;
  const auto has_own_memory = [](const auto& sweep) {
    return sweep.second.scratch == nullptr && !sweep.second.acceleration;
  };
  const bool are_sweeps_apart =
      std::all_of(context.workspace.sweeps.begin(), context.workspace.sweeps.end(), has_own_memory);
  const bool are_fields_apart = std::all_of(context.model.forces.begin(), context.model.forces.end(),
                                            [](const ForceField& field) { return field.on_all_threads; });
  const bool may_stop = context.stop == nullptr ||
                        std::all_of(groups.begin(), groups.end(), [](const Substep& s) { return s.follows_state(); });
  return groups.size() > 1 && are_sweeps_apart && are_fields_apart && may_stop && !context.record_residuals &&
         !(context.tolerance > 0) && context.workspace.contact_log == nullptr;
}

void count_contacts(Substep& s) {
  if (!s.is_last() && !ends_quarter(s)) return;
  s.report.contacts = 0;
  const auto count = [&](const std::vector<Contact>& contacts) {
    s.report.contacts += std::count_if(contacts.begin(), contacts.end(), [](const Contact& c) { return c.push > 0; });
  };
  for_each_tile(s, [&](int task) { count(s.work.tiles[task].contacts); });
  count(s.own->shape_contacts);
  for_systems(s, [&](const System& system) { system.count_contacts(s.report); });
}

namespace {

void add(const std::vector<Substep>& groups, IterationCount& sum) {
  std::int64_t iterations = 0, substeps = 0;
  for (const Substep& s : groups) {
    if (s.made == 0) continue;
    const IterationCount& count = s.report.iterations;
    sum.smallest = substeps == 0 ? count.smallest : std::min(sum.smallest, count.smallest);
    sum.largest = std::max(sum.largest, count.largest);
    iterations += s.iterations_made;
    substeps += s.made;
  }
  if (substeps > 0) sum.mean = static_cast<double>(iterations) / static_cast<double>(substeps);
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

void add(Substep& s, Report& sum) {
  Report& own = s.report;
  sum.substeps = std::max(sum.substeps, s.made);
  sum.contacts += own.contacts;
  std::move(own.convergence.begin(), own.convergence.end(), std::back_inserter(sum.convergence));
  sum.lost_momentum += own.lost_momentum;
  sum.sleeping_bodies += own.sleeping_bodies;
  std::move(own.broken_joints.begin(), own.broken_joints.end(), std::back_inserter(sum.broken_joints));
  std::move(own.warnings.begin(), own.warnings.end(), std::back_inserter(sum.warnings));
  for_systems(s, [&](const System& system) { system.report(sum); });
  sum.pairs.contacts += own.pairs.contacts;
  if (!s.has_pairs()) return;
  add(s.pairs->counts(), sum.pairs);
  warn_of_pairs(s.model, *s.pairs, sum.warnings);
}

/// Puts what lasts of the systems of all groups into the State.
void end_systems(std::vector<Substep>& groups) {
  State& state = groups.front().state;
  state.body_contacts.clear();
  state.grain_contacts.clear();
  for (Substep& s : groups) for_systems(s, [&](System& system) { system.end_frame(s); });
  for (const Substep& s : groups) for_systems(s, [&](const System& system) { system.order(state); });
}

/// Puts the broken joints of all objects into the State, and orders those that the Report names.
void keep_broken_joints(const Substep& s, Report& report) {
  s.state.broken_joints.clear();
  for (std::size_t o = 0; o < s.work.joints.size(); ++o)
    for (const int joint : s.work.joints[o].broken) s.state.broken_joints.push_back({static_cast<int>(o), joint});
  std::sort(report.broken_joints.begin(), report.broken_joints.end(), [](const JointBreak& a, const JointBreak& b) {
    return std::pair{a.object, a.joint} < std::pair{b.object, b.joint};
  });
}

}  // namespace

bool end_frame(std::vector<Substep>& groups, Report& report) {
  end_systems(groups);
  add(groups, report.iterations);
  for (Substep& s : groups) add(s, report);
  keep_broken_joints(groups.front(), report);
  for (const Substep& s : groups) {
    if (s.failed_in < 0) continue;
    report.nonfinite = diagnose(s);
    s.state.body_contacts.clear();  // impulses may not be finite either
    s.state.grain_contacts.clear();
    report.nonfinite->frame = s.state.frame;
    report.nonfinite->substep = s.failed_in;
    report.substeps = std::max(report.substeps, s.failed_in + 1);
    return false;
  }
  const Substep& s = groups.front();  // all groups have reached the same time
  report.stopped = s.substeps < s.planned;
  if (report.stopped)
    for (Substep& group : groups) leave_quarter(group);
  s.state.time = report.stopped ? time_of(s, s.substeps) : s.frame_start + s.dt;
  return true;
}

}  // namespace pliant
