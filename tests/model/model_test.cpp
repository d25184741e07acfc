// Tests Model: objects end to end, and the phases of all of them.
#include "model/model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "support/compiled_grids.h"

namespace pliant {
namespace {

TEST(Model, JoinsObjectsEndToEnd) {
  Model model;
  model.add(compile(rumpled_grid(6, 6), {10, 9}));
  model.add(compile(rumpled_grid(3, 3), {10, 9}));
  ASSERT_EQ(model.first, (std::vector<int>{0, 37}));
  EXPECT_EQ(model.particles(), 47);
  const State state = initial_state(model);
  EXPECT_EQ(state.positions.size(), 47u);
  EXPECT_EQ(state.velocities.size(), 47u);
  EXPECT_EQ(state.remainders.size(), 47u);
  // A phase contains all objects, whose particles differ anyway.
  std::size_t tasks = 0, segments = 0;
  for (const Phase& phase : model.phases) tasks += phase.driver == Driver::inter_tile ? phase.tasks.size() : 0;
  for (const CompiledObject& object : model.objects) {
    for (const ObjectPhase& colour : phases_of(object, Driver::inter_tile))
      segments += static_cast<std::size_t>(colour.last - colour.first);
  }
  EXPECT_GT(tasks, 0u);
  EXPECT_EQ(tasks, segments);
}

/// What a phase visits, as numbers that can be compared.
std::vector<std::vector<int>> visits_of(const Model& model) {
  std::vector<std::vector<int>> visits;
  for (const Phase& phase : model.phases) {
    visits.push_back({static_cast<int>(phase.driver), phase.colour, phase.work});
    for (const Task& task : phase.tasks) visits.back().insert(visits.back().end(), {task.object, task.item, task.work});
  }
  return visits;
}

CompileOptions by(Sweep sweep) {
  CompileOptions options{10, 9};
  options.sweep = sweep;
  options.tethers = sweep == Sweep::chains;
  return options;
}

TEST(Model, WalksPhasesByDriversThenColours) {
  Model model;
  model.add(compile(rumpled_grid(6, 6), by(Sweep::chains)));
  model.add(compile(rumpled_grid(5, 4), by(Sweep::tiled)));
  std::set<Driver> met;
  for (std::size_t i = 0; i < model.phases.size(); ++i) {
    const Phase& phase = model.phases[i];
    met.insert(phase.driver);
    const bool is_next_colour = i > 0 && phase.driver == model.phases[i - 1].driver;
    EXPECT_EQ(phase.colour, is_next_colour ? model.phases[i - 1].colour + 1 : 0);
    EXPECT_TRUE(i == 0 || phase.driver >= model.phases[i - 1].driver);
    EXPECT_TRUE(std::is_sorted(phase.tasks.begin(), phase.tasks.end(),
                               [](const Task& a, const Task& b) { return a.object < b.object; }));
  }
  EXPECT_EQ(model.phases.front().driver, Driver::tile);
  EXPECT_EQ(model.phases.front().tasks.size(), model.objects[0].tiles.size() + model.objects[1].tiles.size());
  EXPECT_EQ(met.count(Driver::chain) + met.count(Driver::inter_tile) + met.count(Driver::collider_contact), 3u);
}

TEST(Model, LosesAnObjectsPhasesWithTheObject) {
  Model model;
  model.add(compile(rumpled_grid(5, 4), by(Sweep::tiled)));
  const auto before = visits_of(model);
  const int added = model.add(compile(rumpled_grid(6, 6), by(Sweep::chains)));
  EXPECT_NE(visits_of(model), before);
  const auto both = visits_of(model);
  model.remove(added);
  EXPECT_EQ(visits_of(model), before);
  EXPECT_EQ(model.add(compile(rumpled_grid(6, 6), by(Sweep::chains))), added);
  EXPECT_EQ(visits_of(model), both);
  model.remove(0);
  model.remove(added);
  ASSERT_EQ(model.phases.size(), 3u);  // tiles and contacts
  for (const Phase& phase : model.phases) EXPECT_TRUE(phase.tasks.empty() && phase.work == 0);
}

}  // namespace
}  // namespace pliant
