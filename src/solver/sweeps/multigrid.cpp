#include "solver/sweeps/multigrid.h"

#include <algorithm>

#include "solver/drivers/contacts.h"
#include "solver/drivers/driver.h"
#include "solver/sweeps/multigrid_solve.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

namespace {

void move(Substep& s, int o, bool first) {
  const SweepArguments a = arguments(s, o, first);
  MultigridObject& work = multigrid_of(s).objects[o];
  // If a correction is rejected, the sweeps alone solve the substep. If they diverge as well, that is diagnosed as
  // usual.
  work.is_made = is_multigrid_change_sound(s, o);
  if (!work.is_made) return std::fill(work.change.begin(), work.change.end(), Record{});
  for (int i = 0; i < s.model.objects[o].particles; ++i) {
    Record& d = a.displacements[i];
    const Record& c = work.change[i];
    d = {d.x + c.x, d.y + c.y, d.z + c.z, 0};
  }
  keep_multigrid_multipliers(s, o, first);
}

}  // namespace

MultigridScratch& multigrid_of(const Substep& s) { return static_cast<MultigridScratch&>(*s.group->scratch); }

void MultigridScratch::prepare(const SweepSetup& setup, int o) {
  const Multigrid& model = setup.model.objects[o].multigrid;
  objects.resize(setup.model.objects.size());
  MultigridObject& to = objects[o];
  to = {};
  if (model.levels.empty()) return;
  const auto blocks = static_cast<std::size_t>(model.levels[0].batches());
  for (std::size_t l = 0; l < model.levels.size(); ++l) {
    MultigridValues& values = to.levels.emplace_back();
    const auto batches = static_cast<std::size_t>(model.levels[l].batches());
    values.blocks.resize(static_cast<std::size_t>(model.levels[l].slots()) * (l == 0 ? spring_floats : block_floats));
    if (l + 1 < model.levels.size())
      values.terms.resize((static_cast<std::size_t>(model.levels[l].no_block()) + batch_width) * (l == 0 ? 1 : 2));
    values.diagonal.resize(batches * block_floats);
    values.inverse.resize(batches * block_floats);
    for (Records* records : {&values.right, &values.x, &values.y}) records->resize(batches * batch_width + 1);
  }
  for (Records* records : {&to.direction, &to.change}) records->resize(blocks * batch_width + 1);
  to.has_extra.resize(blocks);
  to.sums.resize(blocks / batches_per_task + 1);
  to.pieces.resize(static_cast<std::size_t>(model.pieces));
}

void correct_multigrid(Substep& s, bool first) {
  const Stopwatch watch(s.context.executor.timings(), "solve: multigrid");
  if (first) {
    clear_multigrid_multipliers(s);
    add_multigrid_contacts(s);
    make_multigrid_groups(s);
  }
  const MultigridGroups& groups = multigrid_of(s).groups;
  for (int g = 0; g < groups.count; ++g) {
    for (const int o : groups.all[g].objects)
      if (first) MultigridSolve(s, o).linearise(arguments(s, o, true));
    solve_multigrid_group(s, groups.all[g], s.context.options.multigrid_cycles);
    if (first) shorten_fed_motion(s, groups.all[g]);
  }
  for_objects(s, [&](int o) {
    if (!s.model.objects[o].multigrid.levels.empty()) move(s, o, first);
  });
  if (!first) return;
  keep_multigrid_pushes(s);
}

void iterate_multigrid(Substep& s, bool first) {
  correct_multigrid(s, first);
  if (first) find_more_contacts(s);
  // A forward pass, then a backward pass: the backward pass ends with distances, the first type, and so undoes the
  // stretch that bending causes.
  walk(s, Turn::sweep, {});
  sweep_pairs(s);
  sweep_contacts(s);
  walk(s, Turn::sweep, {false, Order::backward});
}

}  // namespace pliant
