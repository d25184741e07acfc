#include "tetra_parts.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <tuple>
#include <vector>

namespace pliant {

namespace {

std::size_t index(int i) { return static_cast<std::size_t>(i); }

/// For each node, the first node of its part.
std::vector<int> parts_of(const TetrahedralMesh& mesh) {
  std::vector<int> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int i) {
    while (parent[index(i)] != i) i = parent[index(i)] = parent[index(parent[index(i)])];
    return i;
  };
  for (const auto& corners : mesh.tetrahedra)
    for (const int corner : corners) {
      const auto [first, second] = std::minmax({root(corners[0]), root(corner)});
      parent[index(second)] = first;
    }
  for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = root(static_cast<int>(i));
  return parent;
}

/// How many nodes are at the position of another one that belongs to another part.
std::size_t count_touching(const std::vector<Vec3f>& positions, const std::vector<int>& parts) {
  std::vector<int> order(positions.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int i) {
    const Vec3f& p = positions[index(i)];
    return std::make_tuple(p.x, p.y, p.z, parts[index(i)]);
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  std::size_t count = 0;
  for (std::size_t i = 1; i < order.size(); ++i) {
    const int a = order[i - 1], b = order[i];
    if (positions[index(a)] == positions[index(b)] && parts[index(a)] != parts[index(b)]) ++count;
  }
  return count;
}

}  // namespace

std::string note_of_touching_parts(const TetrahedralMesh& mesh) {
  const std::vector<int> parts = parts_of(mesh);
  if (std::count(parts.begin(), parts.end(), 0) == static_cast<std::ptrdiff_t>(parts.size())) return {};
  const std::size_t count = count_touching(mesh.positions, parts);
  if (count == 0) return {};
  const std::string nodes =
      count == 1 ? "1 node is at the position of a node" : std::to_string(count) + " nodes are at positions of nodes";
  return nodes + " of another part, but not connected to it: the parts come apart; merge equal nodes if they are one body";
}

}  // namespace pliant
