#include "tetra_parts.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <tuple>
#include <vector>

#include "core/at.h"
#include "math/disjoint_sets.h"

namespace pliant {

namespace {

/// For each node, the first node of its part.
std::vector<std::size_t> parts_of(const TetrahedralMesh& mesh) {
  DisjointSets parts(mesh.positions.size());
  for (const auto& corners : mesh.tetrahedra)
    for (const int corner : corners) parts.join(at(corners[0]), at(corner));
  std::vector<std::size_t> first(mesh.positions.size());
  for (std::size_t i = 0; i < first.size(); ++i) first[i] = parts.root(i);
  return first;
}

/// How many nodes are at the position of another one that belongs to another part.
std::size_t count_touching(const std::vector<Vec3f>& positions, const std::vector<std::size_t>& parts) {
  std::vector<int> order(positions.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int i) {
    const Vec3f& p = positions[at(i)];
    return std::make_tuple(p.x, p.y, p.z, parts[at(i)]);
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
  std::size_t count = 0;
  for (std::size_t i = 1; i < order.size(); ++i) {
    const int a = order[i - 1], b = order[i];
    if (positions[at(a)] == positions[at(b)] && parts[at(a)] != parts[at(b)]) ++count;
  }
  return count;
}

}  // namespace

std::string note_of_touching_parts(const TetrahedralMesh& mesh) {
  const std::vector<std::size_t> parts = parts_of(mesh);
  if (std::count(parts.begin(), parts.end(), std::size_t{0}) == static_cast<std::ptrdiff_t>(parts.size())) return {};
  const std::size_t count = count_touching(mesh.positions, parts);
  if (count == 0) return {};
  const std::string nodes =
      count == 1 ? "1 node is at the position of a node" : std::to_string(count) + " nodes are at positions of nodes";
  return nodes +
         " of another part, but not connected to it: the parts come apart; merge equal nodes if they are one body";
}

}  // namespace pliant
