// Compares the levels of the multigrid correction with the graph from which they were made: every spring is in both its
// rows, every dynamic particle in one group, and every block of a coarser level is the sum of exactly the finer blocks
// that it represents.
#include "model/multigrid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <string>

#include "pliant/mesh.h"
#include "topology/edges.h"

namespace pliant {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

Object with_edges(const std::vector<Vec3f>& positions, const std::vector<std::array<int, 2>>& edges) {
  Object object;
  object.positions = positions;
  object.masses.assign(positions.size(), 0.01f);
  ConstraintGroup group{"distance", {}, {}, Stiffness::rigid(), {}};
  for (const auto& edge : edges) group.particles.insert(group.particles.end(), edge.begin(), edge.end());
  object.constraints = {group};
  return object;
}

Object sheet(int columns, int rows) {
  const TriangleMesh mesh = grid_mesh(columns, rows, 1, 1);
  std::vector<std::array<int, 2>> edges;
  for (const Edge& edge : find_edges(mesh.triangles, columns * rows)) edges.push_back({edge.a, edge.b});
  Object object = with_edges(mesh.positions, edges);
  object.masses[0] = object.masses[static_cast<std::size_t>(columns) - 1] = infinity;
  return object;
}

/// Random points, each connected to some earlier ones: no order, not planar, degrees from 1 up.
Object tangle(int points, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Vec3f> positions;
  std::vector<std::array<int, 2>> edges;
  const auto coordinate = [&] { return static_cast<float>(random() % 1000) * 1e-3f; };
  for (int i = 0; i < points; ++i) {
    positions.push_back({coordinate(), coordinate(), coordinate()});
    for (unsigned k = 0; i > 0 && k <= random() % 4; ++k)
      edges.push_back({static_cast<int>(random() % unsigned(i)), i});
  }
  Object object = with_edges(positions, edges);
  for (int i = 0; i < points; i += 17) object.masses[static_cast<std::size_t>(i)] = infinity;
  return object;
}

Object line(int points, int from = 0) {
  std::vector<Vec3f> positions;
  std::vector<std::array<int, 2>> edges;
  for (int i = 0; i < points; ++i) {
    positions.push_back({0.1f * static_cast<float>(i), 0, 0});
    if (i > from) edges.push_back({i - 1, i});
  }
  return with_edges(positions, edges);
}

Object two_pieces() {
  Object object = line(120);
  std::vector<int>& particles = object.constraints[0].particles;
  const auto cut = particles.begin() + 2 * 49;  // between the 49th and the 50th
  particles.erase(cut, cut + 2);
  return object;
}

/// One particle to which all others are connected.
Object hub(int others) {
  std::vector<Vec3f> positions(1);
  std::vector<std::array<int, 2>> edges;
  for (int i = 1; i <= others; ++i) {
    positions.push_back({1, static_cast<float>(i) * 0.01f, 0});
    edges.push_back({0, i});
  }
  return with_edges(positions, edges);
}

/// An object in which every link occurs twice.
Object doubled() {
  Object object = sheet(8, 9);
  std::vector<int>& particles = object.constraints[0].particles;
  const std::vector<int> once = particles;
  particles.insert(particles.end(), once.begin(), once.end());
  return object;
}

struct Built {
  std::vector<Record> positions;
  std::vector<std::array<int, 2>> springs;
  Multigrid multigrid;
};

Built build(const Object& object, float gravity = 9.81f) {
  Built built;
  for (std::size_t i = 0; i < object.positions.size(); ++i) {
    const Vec3f& p = object.positions[i];
    built.positions.push_back({p.x, p.y, p.z, 1 / object.masses[i]});
  }
  const std::vector<ConstraintList> lists = gather_constraints(object, 1);
  for (const ConstraintList& list : lists)
    for (std::size_t i = 0; i < list.stencils.size(); i += 2)
      built.springs.push_back({list.stencils[i], list.stencils[i + 1]});
  built.multigrid = build_multigrid(lists, built.positions, gravity);
  return built;
}

/// The blocks of the finer level that a slot's lane of a coarser level sums, as 16 x slot + lane.
std::vector<int> sources_of(const MultigridLevel& fine, const MultigridLevel& coarse, int at) {
  std::vector<int> sources;
  for (int round = coarse.first_round[at / batch_width]; round < coarse.first_round[at / batch_width + 1]; ++round) {
    const int block = coarse.sources[round * batch_width + at % batch_width];
    if (block != fine.no_block()) sources.push_back(lane_place(block));
  }
  return sources;
}

/// The slots of a row that have a neighbour: 16 x slot + lane, and the neighbour. On the finest level these have a
/// stiffness; on coarser levels expect_sums checks that they have sources and others none.
std::vector<std::array<int, 2>> links_of(const MultigridLevel& level, int row) {
  std::vector<std::array<int, 2>> links;
  const int place = lane_place(row), batch = place / batch_width, lane = place % batch_width;
  for (int slot = level.first_slot[batch]; slot < level.first_slot[batch + 1]; ++slot) {
    const int at = slot * batch_width + lane;
    const bool is_link = level.first_round.empty() ? level.stiffness[at] > 0 : level.column[at] != row;
    if (is_link)
      links.push_back({at, level.column[at]});
    else
      EXPECT_EQ(level.column[at], row) << "a slot without a neighbour names its own row";
  }
  return links;
}

int parent_of(const MultigridLevel& fine, int row) { return fine.parent[lane_place(row)]; }

void expect_every_spring_twice(const Built& built) {
  const MultigridLevel& finest = built.multigrid.levels[0];
  ASSERT_EQ(finest.rows, static_cast<int>(built.positions.size()));
  std::map<std::array<int, 2>, int> expected, found;
  for (const auto& spring : built.springs) {
    ++expected[{spring[0], spring[1]}];
    ++expected[{spring[1], spring[0]}];
  }
  for (int row = 0; row < finest.rows; ++row)
    for (const auto& link : links_of(finest, row)) ++found[{row, link[1]}];
  EXPECT_EQ(found, expected);
}

/// True if links among the members of a group connect all of them.
bool hangs_together(const MultigridLevel& fine, const std::vector<int>& members) {
  std::set<int> reached{members[0]};
  for (std::size_t pass = 0; pass < members.size(); ++pass)
    for (int row : members)
      for (const auto& link : links_of(fine, row))
        if (reached.count(row) + reached.count(link[1]) == 1 && std::count(members.begin(), members.end(), link[1]) > 0)
          reached.insert({row, link[1]});
  return reached.size() == members.size();
}

void expect_families(const Built& built, const MultigridLevel& fine, const MultigridLevel& coarse, bool is_finest) {
  std::vector<std::vector<int>> members(coarse.rows);
  for (int row = 0; row < fine.rows; ++row) {
    const bool moves = !is_finest || built.positions[row].w > 0;
    const int parent = parent_of(fine, row);
    ASSERT_EQ(parent != coarse.nothing(), moves) << "row " << row;
    if (!moves) continue;
    ASSERT_LT(parent, coarse.rows);
    members[parent].push_back(row);
  }
  for (int row = 0; row < coarse.rows; ++row) {
    ASSERT_GE(members[row].size(), 1U);
    ASSERT_LE(members[row].size(), static_cast<std::size_t>(largest_group));
    EXPECT_TRUE(hangs_together(fine, members[row])) << "group " << row;
    std::vector<int> children;
    const int place = lane_place(row), batch = place / batch_width, lane = place % batch_width;
    for (int i = 0; i < largest_group; ++i)
      children.push_back(coarse.children[(batch * largest_group + i) * batch_width + lane]);
    members[row].resize(largest_group, fine.nothing());
    std::sort(children.begin(), children.end());
    std::sort(members[row].begin(), members[row].end());
    EXPECT_EQ(children, members[row]);
  }
}

/// Each link of the finer level is in one sum: of the block between its groups, or of its group's anchors; links inside
/// a group are in none.
void expect_sums(const MultigridLevel& fine, const MultigridLevel& coarse) {
  std::map<std::array<int, 2>, std::vector<int>> blocks, found_blocks;
  std::map<int, std::vector<int>> anchors, found_anchors;
  for (int row = 0; row < fine.rows; ++row) {
    const int from = parent_of(fine, row);
    if (from == coarse.nothing()) continue;
    for (const auto& link : links_of(fine, row)) {
      const int to = parent_of(fine, link[1]);
      if (to == coarse.nothing()) anchors[from].push_back(link[0]);
      if (to != coarse.nothing() && to != from) blocks[{from, to}].push_back(link[0]);
    }
  }
  for (int row = 0; row < coarse.rows; ++row) {
    for (const auto& link : links_of(coarse, row)) {
      std::vector<int>& sum = found_blocks[{row, link[1]}];
      EXPECT_TRUE(sum.empty()) << "two blocks for one pair of rows";
      sum = sources_of(fine, coarse, link[0]);
    }
    const int key = lane_place(row);
    for (int i = coarse.anchor_begin[key]; i < coarse.anchor_begin[key + 1]; ++i)
      found_anchors[row].push_back(coarse.anchors[i]);
  }
  for (auto* sums : {&blocks, &found_blocks})
    for (auto& [pair, sum] : *sums) std::sort(sum.begin(), sum.end());
  for (auto* sums : {&anchors, &found_anchors})
    for (auto& [row, sum] : *sums) std::sort(sum.begin(), sum.end());
  EXPECT_EQ(found_blocks, blocks);
  std::size_t summed = 0;
  for (const auto& [pair, sum] : found_blocks) summed += sum.size();
  const auto no_block = std::count(coarse.sources.begin(), coarse.sources.end(), fine.no_block());
  EXPECT_EQ(coarse.sources.size() - static_cast<std::size_t>(no_block), summed)
      << "slots without a neighbour sum nothing";
  EXPECT_EQ(found_anchors, anchors);
}

struct Case {
  std::string name;
  Object object;
  int most_levels, coarsest;  ///< largest number of rows of the last level
};

void PrintTo(const Case& from, std::ostream* out) { *out << from.name; }

class Hierarchy : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Of, Hierarchy,
                         testing::Values(Case{"grid", sheet(33, 30), 5, 16}, Case{"tangle", tangle(500, 3), 9, 64},
                                         Case{"dense_tangle", tangle(90, 8), 6, 32}, Case{"line", line(1000), 5, 16},
                                         Case{"two_pieces", two_pieces(), 4, 16}, Case{"doubled", doubled(), 3, 16},
                                         Case{"hub", hub(400), 1, 401}, Case{"two_particles", line(2), 1, 2},
                                         Case{"loose_ends", line(60, 30), 3, 60}),
                         [](const auto& of) { return of.param.name; });

TEST_P(Hierarchy, HasEverySpringInBothItsRows) { expect_every_spring_twice(build(GetParam().object)); }

TEST_P(Hierarchy, GathersWhateverMovesIntoSmallConnectedGroups) {
  const Built built = build(GetParam().object);
  const std::vector<MultigridLevel>& levels = built.multigrid.levels;
  for (std::size_t l = 1; l < levels.size(); ++l) {
    expect_families(built, levels[l - 1], levels[l], l == 1);
    EXPECT_LT(levels[l].rows, levels[l - 1].rows);
  }
}

TEST_P(Hierarchy, SumsEveryLinkOnce) {
  const Built built = build(GetParam().object);
  const std::vector<MultigridLevel>& levels = built.multigrid.levels;
  for (std::size_t l = 1; l < levels.size(); ++l) expect_sums(levels[l - 1], levels[l]);
}

TEST_P(Hierarchy, EndsSoon) {
  const Built built = build(GetParam().object);
  EXPECT_LE(static_cast<int>(built.multigrid.levels.size()), GetParam().most_levels);
  EXPECT_LE(built.multigrid.levels.back().rows, GetParam().coarsest);
}

TEST_P(Hierarchy, ListsTheBatchesWhereComponentsEnd) {
  const Built built = build(GetParam().object);
  const std::vector<std::int32_t>& piece = built.multigrid.piece;
  std::set<std::int32_t> expected;
  for (const auto& [from, to] : built.springs)
    if (piece[from] != piece[to]) expected.insert({from / batch_width, to / batch_width});
  const std::vector<std::int32_t>& found = built.multigrid.border_batches;
  EXPECT_EQ(std::set<std::int32_t>(found.begin(), found.end()), expected);
  EXPECT_EQ(found.size(), expected.size());
}

TEST(HierarchyOf, PiecesThatAreNotJoinedNeverMeet) {
  const Built built = build(two_pieces());
  std::vector<int> row(built.positions.size());
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t l = 1; l < built.multigrid.levels.size(); ++l)
    for (int& r : row) r = parent_of(built.multigrid.levels[l - 1], r);
  const std::set<int> first(row.begin(), row.begin() + 50), second(row.begin() + 50, row.end());
  for (int r : first) EXPECT_EQ(second.count(r), 0U);
  EXPECT_LE(first.size() + second.size(), 16U);
}

TEST(HierarchyOf, NothingThatStretchesOrMovesIsNone) {
  Object pinned = sheet(5, 5);
  pinned.masses.assign(pinned.masses.size(), infinity);
  EXPECT_TRUE(build(pinned).multigrid.levels.empty());
  EXPECT_TRUE(build(with_edges({{0, 0, 0}}, {})).multigrid.levels.empty());
  EXPECT_TRUE(build(with_edges({{0, 0, 0}, {1, 0, 0}}, {})).multigrid.levels.empty());
  EXPECT_TRUE(build(Object{}).multigrid.levels.empty());
}

TEST(HierarchyOf, TheSameObjectIsTheSame) {
  const Built a = build(tangle(300, 5)), b = build(tangle(300, 5));
  for (std::size_t l = 0; l < a.multigrid.levels.size(); ++l) {
    EXPECT_EQ(a.multigrid.levels[l].column, b.multigrid.levels[l].column);
    EXPECT_EQ(a.multigrid.levels[l].parent, b.multigrid.levels[l].parent);
    EXPECT_EQ(a.multigrid.levels[l].sources, b.multigrid.levels[l].sources);
  }
}

// ---------------------------------------------------------------- stiffness

TEST(SpringStiffness, IsOneOverComplianceUpToTheLimit) {
  EXPECT_EQ(spring_stiffness(0.01f, 1000), 100.f);
  EXPECT_EQ(spring_stiffness(0, 1000), 1000.f);
  EXPECT_EQ(spring_stiffness(1e-6f, 1000), 1000.f);
}

/// A line held at one end carries its weight through every cross-section, which is one link: K = 1700 W / L, over the
/// 41 / 40 links per length that its particles have.
TEST(StiffnessLimit, StretchesWhatHangsByAboutAThousandth) {
  Object object = line(41);
  object.masses[0] = infinity;
  const Built built = build(object);
  const double weight = 40 * 0.01 * 9.81, expected = 1700 * weight / (0.1 * 41 / 40);
  EXPECT_NEAR(double(built.multigrid.stiffness_limit[40]), expected, 1e-3 * expected);
  EXPECT_NEAR(double(build(object, 2 * 9.81f).multigrid.stiffness_limit[40]), 2 * expected, 2e-3 * expected);
  EXPECT_NEAR(double(build(object, 0).multigrid.stiffness_limit[40]), expected, 1e-3 * expected) << "without gravity";
}

/// Near few pins an edge carries more: in a sheet of 40 edges across, hung by two corners, 40 / (8 x 2) times as much.
TEST(StiffnessLimit, IsLargerBesideAPin) {
  const Built built = build(sheet(40, 40));
  const std::vector<float>& limit = built.multigrid.stiffness_limit;
  EXPECT_GT(limit[0], 2 * limit[20 * 40 + 20]);
  EXPECT_GT(limit[0], limit[41]);
  EXPECT_EQ(limit[20 * 40 + 20], limit[21 * 40 + 20]) << "far from pins all are alike";
}

}  // namespace
}  // namespace pliant
