// Tests pairs on meshes that are no grids.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "collision/surfaces/surface_contact.h"

namespace pliant {
namespace {

constexpr int spokes = 30;

/// A flat wheel of triangles about vertex 0, of radius 0.1 m. The last vertex, at which no primitive begins, is a
/// cluster of its own.
PairModel wheel() {
  PairModel model;
  model.shared->rest.push_back({0, 0, 0, 1});
  std::vector<Triangle> triangles;
  for (int i = 0; i < spokes; ++i) {
    const double angle = i * 6.283185307179586 / spokes;
    model.shared->rest.push_back({float(0.1 * std::cos(angle)), 0, float(0.1 * std::sin(angle)), 1});
    triangles.push_back({0, 1 + i, 1 + (i + 1) % spokes});
  }
  model.clusters = 2;
  model.shared->vertex_body.assign(model.shared->rest.size(), 0);
  model.shared->vertex_cluster.assign(model.shared->rest.size(), 0);
  model.shared->vertex_cluster[spokes] = 1;
  model.cluster_body = {0, 0};
  ContactBody body;
  body.meets_itself = true;
  body.thickness = 0.001f;
  model.shared->rules.add(body);
  model.largest_thickness = 0.002f;
  model.radius = 0.02f;
  model.elements = make_contact_elements(triangles, {}, {}, static_cast<int>(model.shared->rest.size()));
  model.edge_cluster.assign(model.elements.edges.size(), 0);
  model.triangle_cluster.assign(triangles.size(), 0);
  index_bodies(model);
  return model;
}

/// The hub has too many neighbours for static pairs, so its pairs are found by search, and the lower bound of distances
/// must include them. The rim is folded over, to 1 cm beyond the hub.
TEST(Pairs, OfAVertexOfManyNeighboursAreFound) {
  const PairModel model = wheel();
  std::vector<Record> positions = model.shared->rest, remainders(positions.size()), displacements(positions.size());
  const double angle = 174 * 6.283185307179586 / 360;
  positions[spokes] = {float(0.01 * std::cos(angle)), 0.001f, float(0.01 * std::sin(angle)), 1};
  SurfaceContact system(model);
  Executor executor(1);
  system.begin_frame(positions.data(), true);
  system.detect(executor, {positions.data(), remainders.data(), displacements.data(), 1e-3f});
  const std::array<std::int32_t, 4> wanted{spokes, 0, 15, 16};
  const auto is_wanted = [&](const Contact& contact) { return contact.point == wanted; };
  EXPECT_EQ(std::count_if(system.contacts().begin(), system.contacts().end(), is_wanted), 1);
}

/// A sheet of 3 x 10 vertices, 2 cm apart, in two clusters of five rows each. Lists last for a third of its thickness.
PairModel strip() {
  PairModel model;
  std::vector<Triangle> triangles;
  for (int v = 0; v < 30; ++v) {
    const int row = v / 3, column = v % 3;
    model.shared->rest.push_back({0.02f * static_cast<float>(row), 0, 0.02f * static_cast<float>(column), 1});
    model.shared->vertex_cluster.push_back(v / 15);
    if (v % 3 == 2 || v >= 27) continue;
    triangles.push_back({v, v + 1, v + 3});
    triangles.push_back({v + 1, v + 4, v + 3});
  }
  model.clusters = 2;
  model.shared->vertex_body.assign(model.shared->rest.size(), 0);
  model.cluster_body = {0, 0};
  ContactBody body;
  body.meets_itself = true;
  body.thickness = 0.006f;
  model.shared->rules.add(body);
  model.largest_thickness = 0.012f;
  model.radius = 0.014f;
  model.filter = false;
  model.elements = make_contact_elements(triangles, {}, {}, 30);
  for (const auto& edge : model.elements.edges) model.edge_cluster.push_back(model.shared->vertex_cluster[edge[0]]);
  for (const Triangle& t : triangles) model.triangle_cluster.push_back(model.shared->vertex_cluster[t[0]]);
  index_bodies(model);
  return model;
}

/// One half is folded over the other by 0.4 degrees a substep. Pairs that are clear at first must be found in time.
/// `share`: that of the motion of a substep which the filter is told of.
void expect_folded_in_time(float share) {
  const PairModel model = strip();
  std::vector<Record> positions = model.shared->rest, remainders(positions.size()), displacements(positions.size());
  const PairParticles particles{positions.data(), remainders.data(), displacements.data(), 1e-3f};
  SurfaceContact system(model);
  Executor executor(1);
  system.begin_frame(positions.data(), true);
  std::size_t most = 0;
  for (int substep = 1; substep <= 425; ++substep) {
    const double angle = substep * 0.4 * 3.141592653589793 / 180, c = std::cos(angle), s = std::sin(angle);
    for (std::size_t i = 15; i < positions.size(); ++i) {
      const double arm = double(model.shared->rest[i].x) - 0.09;
      displacements[i] = {float(0.09 + c * arm) - positions[i].x, float(s * arm) - positions[i].y, 0, 0};
    }
    SurfaceContact fresh(model);
    fresh.begin_frame(positions.data(), true);
    fresh.detect(executor, particles);
    system.detect(executor, particles);
    ASSERT_EQ(system.contacts().size(), fresh.contacts().size()) << "substep " << substep;
    for (std::size_t i = 0; i < fresh.contacts().size(); ++i)
      ASSERT_EQ(system.contacts()[i].point, fresh.contacts()[i].point) << "substep " << substep;
    most = std::max(most, fresh.contacts().size());
    const std::vector<Record> whole = displacements;
    for (Record& d : displacements) d = {share * d.x, share * d.y, 0, 0};
    system.filter(executor, particles, []() -> const FreeBodies& {
      static const FreeBodies none;
      return none;
    });
    displacements = whole;
    system.end_substep(executor, particles, share < 1);
    for (std::size_t i = 0; i < positions.size(); ++i) {
      positions[i].x += displacements[i].x;
      positions[i].y += displacements[i].y;
    }
  }
  EXPECT_GT(most, 100u);
}

TEST(Pairs, OfASheetThatFoldsAreFoundInTime) { expect_folded_in_time(1); }

TEST(Pairs, AreFoundInTimeWhereMotionIsAddedAfterTheFilter) { expect_folded_in_time(0.1f); }

}  // namespace
}  // namespace pliant
