// Tests how a PairModel numbers the sets of bodies that can meet.
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "collision/proxies/pair_model.h"
#include "model/compiled_object.h"
#include "pliant/scene.h"

namespace pliant {
namespace {

/// A triangle that collides with those of its group.
Object triangle(std::uint32_t group) {
  Object object;
  object.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
  object.masses = {1, 1, 1};
  object.triangles = {{0, 1, 2}};
  object.collides = true;
  object.groups = object.mask = group;
  return object;
}

/// Triangles of these groups; group 0 meets none.
Model triangles(const std::vector<std::uint32_t>& groups) {
  Model model;
  for (const std::uint32_t group : groups) model.add(compile(triangle(group), {}));
  return model;
}

TEST(PairSets, AreNumberedDenselyInTheOrderOfTheirFirstBodies) {
  const auto pairs = make_pair_model(triangles({0, 2, 4, 2, 0, 4}));
  ASSERT_NE(pairs, nullptr);
  EXPECT_EQ(pairs->sets, 2);
  EXPECT_EQ(pairs->shared->body_set, (std::vector<int>{-1, 0, 1, 0, -1, 1}));
}

/// Thousands of groups of a frame have a PairModel each: what they keep of sets must not grow with the scene.
TEST(PairSets, AreOnlyThoseOfBodiesThatThePairModelHas) {
  const Model model = triangles({2, 4, 8, 2, 4, 8});
  const auto tables = std::make_shared<ContactTables>();
  update_tables(model, {}, *tables);
  const std::vector<int> members{2, 5};
  const auto pairs = make_pair_model(model, tables, &members);
  ASSERT_NE(pairs, nullptr);
  EXPECT_EQ(pairs->sets, 1);
  EXPECT_EQ(pairs->shared->body_set, (std::vector<int>{-1, -1, 0, -1, -1, 0}));
  for (const int cluster : pairs->cluster_order) EXPECT_EQ(pairs->set_of_cluster(cluster), 0);
}

}  // namespace
}  // namespace pliant
