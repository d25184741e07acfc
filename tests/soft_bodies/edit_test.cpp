// Soft bodies that are cut: what tetrahedra keep, and how the parts go on.
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "pliant/body.h"
#include "pliant/edit.h"
#include "pliant/error.h"
#include "soft_bodies/soft_body_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// The number of the side of x = `at` on which each tetrahedron has its centre.
std::vector<int> sides(const Object& object, float at) {
  std::vector<int> out;
  for (const auto& t : tetrahedra_of(object)) {
    float x = 0;
    for (const int corner : t) x += object.positions[static_cast<std::size_t>(corner)].x / 4;
    out.push_back(x > at ? 1 : 0);
  }
  return out;
}

double sum(const std::vector<float>& numbers) { return std::accumulate(numbers.begin(), numbers.end(), 0.0); }

/// Sets of particles that constraints join.
int bodies_in(const Object& object) {
  std::vector<int> root(object.positions.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int i) {
    while (root[static_cast<std::size_t>(i)] != i) i = root[static_cast<std::size_t>(i)];
    return i;
  };
  for (const auto& t : tetrahedra_of(object))
    for (const int corner : t) root[static_cast<std::size_t>(find(corner))] = find(t[0]);
  std::set<int> roots;
  for (int i = 0; i < static_cast<int>(root.size()); ++i) roots.insert(find(i));
  return static_cast<int>(roots.size());
}

/// Every edge of the surface has two triangles, in opposite directions.
bool is_closed(const Object& object) {
  std::map<std::pair<int, int>, int> edges;
  for (const auto& [a, b, c] : object.triangles) ++edges[{a, b}], ++edges[{b, c}], ++edges[{c, a}];
  for (const auto& [edge, count] : edges)
    if (count != 1 || edges.count({edge.second, edge.first}) == 0) return false;
  return !edges.empty();
}

TEST(PartTetrahedra, CutsABlockInTwo) {
  const Object whole = block();
  const Edit cut = part_tetrahedra(whole, sides(whole, 0));
  EXPECT_EQ(bodies_in(whole), 1);
  EXPECT_EQ(bodies_in(cut.object), 2);
  EXPECT_EQ(cut.object.positions.size(), whole.positions.size() + 9);  // the middle has 3 x 3 nodes
  EXPECT_EQ(cut.from.size(), cut.object.positions.size());
  EXPECT_NEAR(sum(cut.object.masses) / sum(whole.masses), 1, 1e-6);
  EXPECT_EQ(tetrahedra_of(cut.object).size(), tetrahedra_of(whole).size());
  EXPECT_EQ(cut.object.triangles.size(), whole.triangles.size() + 2 * 8);
  EXPECT_TRUE(is_closed(cut.object));
}

TEST(PartTetrahedra, OnePartChangesNothing) {
  const Object whole = block();
  const Edit same = part_tetrahedra(whole, std::vector<int>(tetrahedra_of(whole).size(), 3));
  EXPECT_EQ(same.object.positions, whole.positions);
  EXPECT_EQ(same.object.masses, whole.masses);
  EXPECT_EQ(same.object.triangles.size(), whole.triangles.size());
  for (std::size_t g = 0; g < whole.constraints.size(); ++g)
    EXPECT_EQ(same.object.constraints[g].particles, whole.constraints[g].particles);
}

TEST(PartTetrahedra, ACutThatEndsInsideLeavesOneBody) {
  const Object whole = block();
  std::vector<int> part = sides(whole, 0);
  const std::vector<std::array<int, 4>> tetrahedra = tetrahedra_of(whole);
  for (std::size_t t = 0; t < part.size(); ++t) {  // only the upper half is cut
    float y = 0;
    for (const int corner : tetrahedra[t]) y += whole.positions[static_cast<std::size_t>(corner)].y / 4;
    part[t] = y > 0 ? part[t] + 1 : 1;
  }
  Object notched = part_tetrahedra(whole, part).object;
  // Parts 1 and 2 above, 1 below: the upper half with number 2 comes off the lower one too, so they are two bodies.
  EXPECT_EQ(bodies_in(notched), 2);
  EXPECT_TRUE(is_closed(notched));
}

TEST(PartTetrahedra, TheHalvesKeepMomentumAndFlyApart) {
  Object whole = block();
  for (std::size_t i = 0; i < whole.positions.size(); ++i)
    whole.velocities.push_back({whole.positions[i].x > 0 ? 1.f : -1.f, 0.5f, 0});
  Scene scene = scene_of(whole, 20);
  scene.gravity = {};
  World world(scene);
  const Edit cut = part_tetrahedra(whole, sides(whole, 0));
  world.edit(0, cut);
  const Momentum before = momentum_of(world, cut.object.masses);
  run(world, 60);
  const Momentum after = momentum_of(world, cut.object.masses);
  EXPECT_LT(length(after.linear - before.linear), 1e-4 * length(before.linear));
  double least = 1e9;  // the gap between the halves
  const std::vector<Vec3f> now = positions_of(world);
  for (std::size_t i = 0; i < now.size(); ++i)
    if (cut.object.positions[i].x > 0.01f) least = std::min(least, static_cast<double>(now[i].x));
  EXPECT_GT(least, 0.4);
}

TEST(PartTetrahedra, PinsAndFibresFollow) {
  SoftBodyOptions options;
  options.fibres.emplace();
  Object whole = make_soft_body(box_tetrahedra({0.4f, 0.2f, 0.2f}, {4, 2, 2}), options);
  int middle = -1;
  for (int i = 0; i < static_cast<int>(whole.positions.size()); ++i)
    if (length(whole.positions[static_cast<std::size_t>(i)]) < 1e-4f) middle = i;
  ASSERT_GE(middle, 0);
  whole.pins.push_back({middle, {}});
  const Edit cut = part_tetrahedra(whole, sides(whole, 0));
  ASSERT_EQ(cut.object.pins.size(), 2u);
  EXPECT_EQ(cut.from[static_cast<std::size_t>(cut.object.pins[1].particle)], middle);
  EXPECT_EQ(cut.object.constraints.back().rest, whole.constraints.back().rest);
  EXPECT_EQ(cut.object.constraints.back().keyframes.size(), 1u);
}

TEST(RemoveTetrahedra, TakesTheirMassAndLeavesAClosedSurface) {
  const Object whole = block();
  std::vector<int> some;
  const std::vector<int> right = sides(whole, 0.1f);
  for (int t = 0; t < static_cast<int>(right.size()); ++t)
    if (right[static_cast<std::size_t>(t)] != 0) some.push_back(t);
  const Edit edit = remove_tetrahedra(whole, some);
  EXPECT_EQ(tetrahedra_of(edit.object).size(), tetrahedra_of(whole).size() * 3 / 4);
  EXPECT_TRUE(is_closed(edit.object));
  double mass = 0;
  int left_over = 0;
  for (const float one : edit.object.masses) std::isinf(one) ? ++left_over : mass += static_cast<double>(one);
  EXPECT_NEAR(mass / sum(whole.masses), 0.75, 1e-6);
  EXPECT_EQ(left_over, 9);  // the nodes of the end
  World world(scene_of(whole, 10));
  world.edit(0, edit);
  run(world, 10);
}

TEST(RemoveTetrahedra, LetsGoOfWhatTheyHeld) {
  Object whole = block();
  int corner = 0;
  for (int i = 0; i < static_cast<int>(whole.positions.size()); ++i)
    if (whole.positions[static_cast<std::size_t>(i)].x > whole.positions[static_cast<std::size_t>(corner)].x)
      corner = i;
  whole.positions.push_back({1, 0, 0});
  whole.masses.push_back(1);
  ConstraintGroup link;
  link.type = "distance";
  link.particles = {corner, static_cast<int>(whole.positions.size()) - 1};
  whole.constraints.push_back(link);
  std::vector<int> some;
  const std::vector<int> right = sides(whole, 0.1f);
  for (int t = 0; t < static_cast<int>(right.size()); ++t)
    if (right[static_cast<std::size_t>(t)] != 0) some.push_back(t);
  EXPECT_TRUE(remove_tetrahedra(whole, some).object.constraints.back().particles.empty());
}

/// The numbers of the particles at the place of a block's cut x = 0 that have this height.
std::vector<int> at_height(const Object& object, float y, int end) {
  std::vector<int> found;
  for (int i = 0; i < end; ++i)
    if (const Vec3f& p = object.positions[static_cast<std::size_t>(i)];
        std::fabs(p.x) < 1e-4f && std::fabs(p.y - y) < 1e-4f)
      found.push_back(i);
  return found;
}

/// A block, and another one `up` metres above it as its later particles.
Object two_blocks(float up) {
  Object both = block();
  Object other = block();
  for (Vec3f& p : other.positions) p.y += up;
  append(both, other);
  return both;
}

TEST(RemoveTetrahedra, LetsGoOfWhatIsTiedToAParticleThatIsLeftOver) {
  Object both = two_blocks(-0.2f);
  const auto below = static_cast<int>(both.positions.size()) / 2;
  attach_to_surface(both, at_height(both, -0.1f, below));
  std::vector<int> first;
  for (int t = 0; t < static_cast<int>(tetrahedra_of(both).size()) / 2; ++t) first.push_back(t);
  const Edit edit = remove_tetrahedra(both, first);
  EXPECT_TRUE(edit.object.constraints.back().particles.empty());
  World world(scene_of(both, 10));
  world.edit(0, edit);
  run(world, 30);
  EXPECT_LT(world.object(0).positions()[static_cast<std::size_t>(below)].y, -0.9f) << "falls freely";
}

TEST(PartTetrahedra, BothHalvesStayTied) {
  Object both = two_blocks(0.2f);
  const auto below = static_cast<int>(both.positions.size()) / 2;
  for (int i = below; i < 2 * below; ++i) both.pins.push_back({i});
  attach_to_surface(both, at_height(both, 0.1f, below));
  std::vector<int> part = sides(both, 0);
  std::fill(part.begin() + static_cast<std::ptrdiff_t>(part.size() / 2), part.end(), 0);
  const Edit edit = part_tetrahedra(both, part);
  EXPECT_EQ(both.constraints.back().particles.size(), 3u * 4);
  EXPECT_EQ(edit.object.constraints.back().particles.size(), 6u * 4);
  World world(scene_of(both, 10));
  world.edit(0, edit);
  run(world, 60);
  for (const Vec3f& p : world.object(0).positions()) EXPECT_GT(p.y, -0.3f);
}

TEST(MakeCuts, BothHalvesOfClothStayTiedToABodyThatIsCutToo) {
  for (const bool inside : {false, true}) {
    Object both = block();
    const int first = append(both, make_cloth(grid_mesh(5, 5, 0.2f, 0.2f)));
    std::vector<int> middle;
    for (int row = 0; row < 5; ++row) middle.push_back(first + 5 * row + 2);
    if (inside)
      attach_inside(both, middle);
    else
      attach_to_surface(both, middle);
    both.cuts.push_back({0, 0, {0, 1, 0}, {1, 0, 0}, {0, -1, 0}});
    const std::optional<Edit> edit = make_cuts(both, 0);
    ASSERT_TRUE(edit.has_value());
    EXPECT_EQ(edit->object.positions.size(), both.positions.size() + 9 + 5);
    EXPECT_EQ(edit->object.constraints.back().particles.size(), 2 * both.constraints.back().particles.size());
  }
}

TEST(EditTetrahedra, WhatCannotBeIsRefused) {
  const Object whole = block();
  const std::vector<int> beyond{100000}, all = [&] {
    std::vector<int> every(tetrahedra_of(whole).size());
    std::iota(every.begin(), every.end(), 0);
    return every;
  }();
  EXPECT_THROW((void)remove_tetrahedra(whole, beyond), Error);
  EXPECT_THROW((void)remove_tetrahedra(whole, all), Error);
  EXPECT_THROW((void)part_tetrahedra(whole, beyond), Error);
  const Object rope = make_rope({{0, 0, 0}, {1, 0, 0}});
  EXPECT_THROW((void)part_tetrahedra(rope, {}), Error);
}

}  // namespace
}  // namespace pliant
