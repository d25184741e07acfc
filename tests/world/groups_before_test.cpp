// Tests that substep groups that take over what earlier groups had are those that are made anew.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "model/compiled_object.h"
#include "pliant/mesh.h"
#include "pliant/scene.h"
#include "solver/substep_group.h"

namespace pliant {
namespace {

/// A sheet that meets those of its group; 0: none.
CompiledObject compiled_sheet(std::uint32_t group, int n, Sweep sweep) {
  ClothOptions cloth;
  cloth.stretch = Stiffness::compliance(1e-7f);
  Object object = make_cloth(grid_mesh(n, n, 1, 1), cloth);
  object.pins = {{0, {}}};
  object.collides = group != 0;
  object.groups = object.mask = group;
  CompileOptions options;
  options.sweep = sweep;
  options.tethers = sweep == Sweep::tethered_chains;
  options.gravity = 9.81f;
  return compile(object, options);
}

bool are_equal(const std::vector<Task>& a, const std::vector<Task>& b) {
  const auto same = [](const Task& x, const Task& y) {
    return x.object == y.object && x.item == y.item && x.work == y.work;
  };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

void expect_equal(const std::vector<SubstepGroup>& found, const std::vector<SubstepGroup>& wanted) {
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t g = 0; g < found.size(); ++g) {
    const SubstepGroup &a = found[g], &b = wanted[g];
    EXPECT_EQ(a.objects, b.objects);
    EXPECT_EQ(a.tiles, b.tiles);
    EXPECT_EQ(a.sweeps, b.sweeps);
    EXPECT_EQ(a.hangs, b.hangs);
    EXPECT_EQ(a.least_hanging, b.least_hanging);
    EXPECT_EQ(a.has_sheets, b.has_sheets);
    EXPECT_TRUE(are_equal(a.lengths, b.lengths));
    ASSERT_EQ(a.phases.size(), b.phases.size());
    for (std::size_t p = 0; p < a.phases.size(); ++p) {
      EXPECT_EQ(a.phases[p].driver, b.phases[p].driver);
      EXPECT_EQ(a.phases[p].colour, b.phases[p].colour);
      EXPECT_EQ(a.phases[p].work, b.phases[p].work);
      EXPECT_TRUE(are_equal(a.phases[p].tasks, b.phases[p].tasks));
    }
  }
}

TEST(GroupsBefore, GiveWhatIsMadeAnew) {
  std::mt19937 random(11);
  const auto below = [&](unsigned n) { return static_cast<int>(random() % n); };
  const auto some_sheet = [&] {
    const Sweep sweeps[] = {Sweep::chains, Sweep::tethered_chains, Sweep::tiled};
    return compiled_sheet(static_cast<std::uint32_t>(below(6)), 20 + below(3), sweeps[below(3)]);
  };
  Model model;
  for (int i = 0; i < 8; ++i) model.add(some_sheet());
  std::vector<SubstepGroup> groups = make_substep_groups(model);
  std::size_t most = 0;
  for (int round = 0; round < 60; ++round) {
    const int o = below(static_cast<unsigned>(model.objects.size()));
    std::vector<int> changed{o};
    if (model.objects[o].particles == 0)
      changed = {model.add(some_sheet())};
    else if (round % 3 == 0)
      model.replace(o, some_sheet());
    else if (round % 3 == 1)
      model.remove(o);
    else
      changed = {model.add(some_sheet())};
    const GroupsBefore before{groups, changed};
    std::vector<SubstepGroup> next = make_substep_groups(model, &before);
    SCOPED_TRACE(round);
    expect_equal(next, make_substep_groups(model));
    groups = std::move(next);
    most = std::max(most, groups.size());
  }
  EXPECT_GT(most, 3U) << "groups are taken over";
}

}  // namespace
}  // namespace pliant
