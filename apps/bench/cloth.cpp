// The workload derives from Pliant's own object, so that every engine has the same constraints.
#include "apps/bench/cloth.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "pliant/mesh.h"

namespace pliant::bench {
namespace {

const ConstraintGroup* find(const Object& object, const std::string& type) {
  for (const ConstraintGroup& group : object.constraints)
    if (group.type == type) return &group;
  return nullptr;
}

float distance(const Vec3f& a, const Vec3f& b) { return std::sqrt(length_squared(b - a)); }

std::pair<int, int> key(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

// For each edge, when triangles use it first. A Gauss-Seidel pass over sorted edges, away from the pins, would diverge.
std::map<std::pair<int, int>, int> mesh_order(const Object& object) {
  std::map<std::pair<int, int>, int> rank;
  for (const std::array<int, 3>& t : object.triangles)
    for (int corner = 0; corner < 3; ++corner)
      rank.emplace(key(t[corner], t[(corner + 1) % 3]), static_cast<int>(rank.size()));
  return rank;
}

// Sorts items by the position of their edges in mesh_order.
template <class Item, class EdgeOf>
void sort_by_mesh(std::vector<Item>& items, const std::map<std::pair<int, int>, int>& rank, const EdgeOf& edge_of) {
  std::vector<std::pair<int, int>> order;
  for (std::size_t i = 0; i < items.size(); ++i) order.push_back({rank.at(edge_of(items[i])), static_cast<int>(i)});
  std::sort(order.begin(), order.end());
  std::vector<Item> sorted;
  for (const auto& [place, index] : order) sorted.push_back(items[index]);
  items = std::move(sorted);
}

}  // namespace

namespace {

/// The grid of W1. Each cell is two triangles; with alternating diagonals, every second cell gets the other diagonal.
TriangleMesh w1_mesh(int size, Diagonals diagonals) {
  TriangleMesh mesh = grid_mesh(size, size, 1, 1);
  if (diagonals == Diagonals::uniform) return mesh;
  mesh.triangles.clear();
  for (int row = 0; row + 1 < size; ++row) {
    for (int column = 0; column + 1 < size; ++column) {
      const int a = row * size + column, b = a + 1, c = a + size, d = c + 1;
      const bool falls = (row + column) % 2 != 0;
      mesh.triangles.push_back({a, c, falls ? b : d});
      mesh.triangles.push_back({falls ? b : a, falls ? c : d, falls ? d : b});
    }
  }
  return mesh;
}

}  // namespace

Object make_w1_object(int size, bool with_bending, Diagonals diagonals) {
  ClothOptions options;
  options.material = fabric("cotton");
  options.stretch = Stiffness::rigid();
  options.bending_model = with_bending ? ClothOptions::Bending::dihedral : ClothOptions::Bending::none;
  Object object = make_cloth(w1_mesh(size, diagonals), options);
  for (int corner : {0, size - 1}) object.pins.push_back({corner, {}});
  return object;
}

TriangleMesh make_irregular_mesh(int size) {
  std::mt19937 random(7);
  const auto uniform = [&] { return static_cast<float>(random() % 65536) / 32768 - 1; };
  TriangleMesh mesh = grid_mesh(size, size, 1, 1);
  const float most = 0.3f / static_cast<float>(size - 1);
  for (int row = 1; row + 1 < size; ++row) {
    for (int column = 1; column + 1 < size; ++column) {
      const float x = most * uniform(), z = most * uniform();
      mesh.positions[row * size + column] += Vec3f{x, 0, z};
    }
  }
  mesh.triangles.clear();
  for (int row = 0; row + 1 < size; ++row) {
    for (int column = 0; column + 1 < size; ++column) {
      const int a = row * size + column, b = a + 1, c = a + size, d = c + 1;
      const bool falls = uniform() > 0;
      mesh.triangles.push_back({a, c, falls ? b : d});
      mesh.triangles.push_back({falls ? b : a, falls ? c : d, falls ? d : b});
    }
  }
  return mesh;
}

std::vector<Edge> edges_of(const Object& object) {
  std::vector<Edge> edges;
  if (const ConstraintGroup* group = find(object, "distance"))
    for (std::size_t i = 0; i + 1 < group->particles.size(); i += 2) {
      const int a = group->particles[i], b = group->particles[i + 1];
      edges.push_back({a, b, distance(object.positions[a], object.positions[b])});
    }
  sort_by_mesh(edges, mesh_order(object), [](const Edge& edge) { return key(edge.a, edge.b); });
  return edges;
}

Cloth make_w1(int size, bool with_bending, Diagonals diagonals) {
  Cloth cloth;
  cloth.object = make_w1_object(size, with_bending, diagonals);
  cloth.pins = {0, size - 1};
  cloth.edges = edges_of(cloth.object);
  if (const ConstraintGroup* group = find(cloth.object, "dihedral_bending"))
    for (std::size_t i = 0; i + 3 < group->particles.size(); i += 4) {
      const int* v = &group->particles[i];
      const float compliance = group->compliances.empty() ? group->stiffness.value : group->compliances[i / 4];
      cloth.hinges.push_back({v[0], v[1], v[2], v[3], compliance});
    }
  sort_by_mesh(cloth.hinges, mesh_order(cloth.object), [](const Hinge& hinge) { return key(hinge.v0, hinge.v1); });
  return cloth;
}

}  // namespace pliant::bench
