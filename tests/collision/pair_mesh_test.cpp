// Pairs of meshes that are no grids.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "collision/pairs.h"

namespace pliant {
namespace {

constexpr int spokes = 30;

/// A wheel of triangles about vertex 0, flat, 0.1 m in radius; the last vertex, at which nothing begins, is a cluster of its own.
PairModel wheel() {
  PairModel model;
  model.rest.push_back({0, 0, 0, 1});
  std::vector<Triangle> triangles;
  for (int i = 0; i < spokes; ++i) {
    const double angle = i * 6.283185307179586 / spokes;
    model.rest.push_back({float(0.1 * std::cos(angle)), 0, float(0.1 * std::sin(angle)), 1});
    triangles.push_back({0, 1 + i, 1 + (i + 1) % spokes});
  }
  model.bodies = 1;
  model.clusters = 2;
  model.vertex_body.assign(model.rest.size(), 0);
  model.vertex_cluster.assign(model.rest.size(), 0);
  model.vertex_cluster[spokes] = 1;
  model.cluster_body = {0, 0};
  model.meets = {1};
  model.immovable = {0};
  model.materials = {{0.002f, 0, 0, 0}};
  model.largest_thickness = 0.002f;
  model.radius = 0.02f;
  model.elements = make_contact_elements(triangles, {}, {}, static_cast<int>(model.rest.size()));
  model.elements.body = model.vertex_body;
  model.elements.bodies = 1;
  model.elements.meets = model.meets;
  model.edge_cluster.assign(model.elements.edges.size(), 0);
  model.triangle_cluster.assign(triangles.size(), 0);
  return model;
}

/// The hub has more neighbours than surroundings are made of: what it has to do with them is looked for like anything else, and what
/// says that nothing is near may not leave it aside. The rim is folded over, to 1 cm beyond the hub.
TEST(Pairs, OfAVertexOfManyNeighboursAreFound) {
  const PairModel model = wheel();
  std::vector<Record> positions = model.rest, remainders(positions.size()), displacements(positions.size());
  const double angle = 174 * 6.283185307179586 / 360;
  positions[spokes] = {float(0.01 * std::cos(angle)), 0.001f, float(0.01 * std::sin(angle)), 1};
  PairSystem system(model);
  Executor executor(1);
  system.begin_frame(positions.data(), true);
  system.detect(executor, {positions.data(), remainders.data(), displacements.data(), 1e-3f});
  const std::array<std::int32_t, 4> wanted{spokes, 0, 15, 16};
  const auto is_wanted = [&](const PairContact& contact) { return contact.vertex == wanted; };
  EXPECT_EQ(std::count_if(system.contacts().begin(), system.contacts().end(), is_wanted), 1);
}

}  // namespace
}  // namespace pliant
