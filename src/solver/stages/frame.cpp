// Starts and ends a frame.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "solver/bodies/body_solver.h"
#include "solver/diagnose.h"
#include "solver/fluids/fluid_solver.h"
#include "solver/gases/gas_solver.h"
#include "solver/grains/grain_solver.h"
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
  if (of.group != nullptr) s.bodies = of.group->bodies.get();
  if (of.group != nullptr) s.fluids = of.group->fluids.get();
  if (of.group != nullptr) s.grains = of.group->grains.get();
  if (of.group != nullptr) s.gases = of.group->gases.get();
  if (of.group != nullptr) s.own_lengths = &of.group->lengths;
  for_objects(s, [&](int o) {
    s.work.gravity[o] = {0, static_cast<double>(s.h), 0, velocity_kept(s.h, s.model.objects[o].damping)};
    s.work.last_h[o] = s.h;
  });
  forget_substeps(s);
  begin_quarter(s);
  if (s.has_pairs()) s.pairs->begin_frame(s.state.positions.data(), s.work.look_for_tangles);
  if (s.bodies != nullptr) s.bodies->begin_frame(s);
  if (s.fluids != nullptr) s.fluids->begin_frame(s);
  if (s.grains != nullptr) s.grains->begin_frame(s);
  if (s.gases != nullptr) s.gases->begin_frame();
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
  if (s.bodies == nullptr) return;
  s.report.contacts += s.bodies->contacts_that_press();
  s.report.pairs.contacts = s.bodies->points_that_press();
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

/// Liquids of several groups: the mean of the worst.
void add(const Compression& c, Compression& sum) {
  sum.mean = std::max(sum.mean, c.mean);
  sum.largest = std::max(sum.largest, c.largest);
  sum.crowded += c.crowded;
}

void add(const ViscositySolves& solves, Report& sum) {
  sum.viscosity += solves;
  if (solves.unfinished == 0) return;
  sum.warnings.push_back("the viscosity of liquids was not solved to the end in " + std::to_string(solves.unfinished) +
                         " solves, at worst to " + std::to_string(100 * solves.residual) +
                         " % of its residual; use more substeps, a larger spacing, or a lower viscosity");
}

void add(const TensionActs& acts, Report& sum) {
  sum.tension += acts;
  if (acts.share == 1) return;
  sum.warnings.push_back("substeps are too long for the surface tension of a liquid, so " +
                         std::to_string(100 * acts.share) + " % of it acts; use " +
                         std::to_string(std::sqrt(1 / acts.share)) + " times as many substeps, or a larger spacing");
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
  if (s.fluids != nullptr) add(s.fluids->compression(), sum.compression);
  if (s.fluids != nullptr) add(s.fluids->viscosity(), sum);
  if (s.fluids != nullptr) add(s.fluids->tension(), sum);
  sum.pairs.contacts += own.pairs.contacts;
  if (!s.has_pairs()) return;
  add(s.pairs->counts(), sum.pairs);
  warn_of_pairs(s.model, *s.pairs, sum.warnings);
}

/// Puts the contacts of rigid bodies of all groups into the State.
void keep_body_contacts(std::vector<Substep>& groups) {
  std::vector<BodyContact>& all = groups.front().state.body_contacts;
  bool is_first = true;
  for (Substep& s : groups) {
    if (s.bodies == nullptr) continue;
    s.bodies->end_frame(s);
    std::vector<BodyContact>& own = s.bodies->contacts();
    if (is_first) {
      all.swap(own);  // usually the only group
    } else {
      all.insert(all.end(), own.begin(), own.end());
    }
    is_first = false;
  }
  if (is_first) all.clear();
  if (groups.size() == 1) return;  // its contacts are in order
  if (!std::is_sorted(all.begin(), all.end(), in_order)) std::sort(all.begin(), all.end(), in_order);
}

/// Puts the contacts of grains of all groups into the State.
void keep_grain_contacts(std::vector<Substep>& groups) {
  State& state = groups.front().state;
  state.grain_contacts.clear();
  for (Substep& s : groups)
    if (s.grains != nullptr) s.grains->append_contacts(state, state.grain_contacts);
  std::sort(state.grain_contacts.begin(), state.grain_contacts.end(), in_order_of_particles);
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
  keep_body_contacts(groups);
  keep_grain_contacts(groups);
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
