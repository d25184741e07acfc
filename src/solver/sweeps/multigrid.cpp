#include "solver/sweeps/multigrid.h"

#include <algorithm>

#include "solver/passes.h"
#include "solver/sweeps/multigrid_solve.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

namespace {

void move(Substep& s, int o, bool first) {
  const SweepArguments a = arguments(s, o, first);
  MultigridObject& work = s.work.sweep.multigrid[o];
  // What is not sound is left to the sweeps, which may cope with it or name what does not.
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

void prepare_multigrid(const Model& model, std::vector<MultigridObject>& objects) {
  for (int o = 0; o < static_cast<int>(model.objects.size()); ++o) prepare_multigrid(model, o, objects);
}

void prepare_multigrid(const Model& model, int o, std::vector<MultigridObject>& objects) {
  objects.resize(model.objects.size());
  objects[o] = {};
  const std::vector<MultigridLevel>& levels = model.objects[o].multigrid.levels;
  if (levels.empty()) return;
  MultigridObject& to = objects[o];
  const auto blocks = static_cast<std::size_t>(levels[0].batches());
  for (std::size_t l = 0; l < levels.size(); ++l) {
    MultigridValues& values = to.levels.emplace_back();
    const auto batches = static_cast<std::size_t>(levels[l].batches());
    values.blocks.resize(static_cast<std::size_t>(levels[l].slots()) * (l == 0 ? spring_floats : block_floats));
    values.diagonal.resize(batches * block_floats);
    values.inverse.resize(batches * block_floats);
    for (Records* records : {&values.right, &values.x, &values.y}) records->resize(batches * batch_width + 1);
  }
  for (Records* records : {&to.direction, &to.image, &to.change}) records->resize(blocks * batch_width + 1);
  to.extra.resize(blocks * 9 * batch_width);
  to.has_extra.resize(blocks);
  to.sums.resize(blocks / batches_per_task + 1);
  to.pieces.resize(static_cast<std::size_t>(model.objects[o].multigrid.pieces));
}

void correct_multigrid(Substep& s, bool first) {
  if (first) {
    clear_multigrid_multipliers(s);
    add_multigrid_contacts(s);
    make_multigrid_groups(s);
  }
  const MultigridGroups& groups = s.work.sweep.multigrid_groups;
  for (int g = 0; g < groups.count; ++g) {
    for (const int o : groups.all[g].objects)
      if (first) MultigridSolve(s, o).linearise(arguments(s, o, true));
    solve_multigrid_group(s, groups.all[g], s.context.options.multigrid_cycles);
  }
  for (std::size_t o = 0; o < s.model.objects.size(); ++o)
    if (!s.model.objects[o].multigrid.levels.empty()) move(s, static_cast<int>(o), first);
  if (!first) return;
  keep_multigrid_pushes(s);
}

void iterate_multigrid(Substep& s, bool first) {
  correct_multigrid(s, first);
  if (first) find_more_contacts(s);
  // There and back: distances, first of all types, have the last word, and what bending pulls apart is put right again.
  iterate_tiled(s, false);
  if (s.has_pairs()) sweep_pairs(s);
  sweep_contacts(s);
  sweep_inter_tile(s, false, Order::backward);
  sweep_tiles(s, false, Order::backward);
}

}  // namespace pliant
