// Particles to make surfaces of, and what is measured of the surfaces.
#pragma once

#include <array>
#include <map>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "math/vector.h"
#include "pliant/surface.h"

namespace pliant {

inline constexpr float spacing = 0.05f;
inline constexpr Vec3f offset{0.013f, 0.007f, 0.021f};  ///< so that particles and nodes of the grid do not coincide

/// n^3 particles of a cubic lattice from `offset`, each moved by up to `jitter` spacings along each axis.
inline std::vector<Vec3f> lattice(int n, float jitter = 0) {
  std::mt19937 random(7);
  const auto shift = [&] { return static_cast<float>(random() % 20001) / 10000 - 1; };
  std::vector<Vec3f> positions;
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const Vec3f cell{static_cast<float>(i) + 0.5f, static_cast<float>(j) + 0.5f, static_cast<float>(k) + 0.5f};
        const Vec3f moved{shift(), shift(), shift()};
        positions.push_back((cell + moved * jitter) * spacing + offset);
      }
  return positions;
}

/// The particles of a lattice within a ball of `radius` spacings.
inline std::vector<Vec3f> ball(float radius) {
  const int n = 2 * static_cast<int>(radius) + 2;
  const float middle = static_cast<float>(n) / 2 * spacing;
  std::vector<Vec3f> inside;
  for (const Vec3f& p : lattice(n))
    if (length(p - offset - Vec3f{middle, middle, middle}) < radius * spacing) inside.push_back(p);
  return inside;
}

/// Particles at random in a cube of `side` spacings: drops, threads, sheets and holes of all shapes.
inline std::vector<Vec3f> spray(int count, float side, unsigned seed) {
  std::mt19937 random(seed);
  const auto place = [&] { return static_cast<float>(random() % 100001) / 100000 * side * spacing; };
  std::vector<Vec3f> positions;
  for (int i = 0; i < count; ++i) {
    const float x = place(), y = place(), z = place();
    positions.push_back({x, y, z});
  }
  return positions;
}

inline Vec3d at(const TriangleMesh& mesh, int vertex) {
  return convert<double>(mesh.positions[static_cast<std::size_t>(vertex)]);
}

/// What the mesh encloses, by the divergence theorem [m^3]; negative if its triangles face inwards.
inline double volume(const TriangleMesh& mesh) {
  double six = 0;
  for (const auto& t : mesh.triangles) six += dot(at(mesh, t[0]), cross(at(mesh, t[1]), at(mesh, t[2])));
  return six / 6;
}

/// What is wrong with the mesh's topology; empty if it is closed, consistently oriented and two-manifold at edges and
/// vertices.
inline std::string topology_fault(const TriangleMesh& mesh) {
  std::set<std::pair<int, int>> directed;
  std::map<int, std::map<int, int>> fans;  // for each vertex, the vertex after each of its neighbours
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
      if (a == b) return "a triangle has vertex " + std::to_string(a) + " twice";
      if (!directed.insert({a, b}).second)
        return "two triangles have the edge " + std::to_string(a) + ", " + std::to_string(b);
      fans[a][b] = c;
    }
  for (const auto& [a, b] : directed)
    if (directed.count({b, a}) == 0)
      return "one triangle alone has the edge " + std::to_string(a) + ", " + std::to_string(b);
  if (fans.size() != mesh.positions.size()) return "a vertex has no triangle";
  for (const auto& [vertex, next] : fans) {
    std::size_t steps = 1;
    for (int b = next.begin()->second; b != next.begin()->first && steps <= next.size(); b = next.at(b)) ++steps;
    if (steps != next.size()) return "the triangles of vertex " + std::to_string(vertex) + " form several fans";
  }
  return {};
}

/// The number of connected components.
inline int components(const TriangleMesh& mesh) {
  std::vector<int> parent(mesh.positions.size());
  for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = static_cast<int>(i);
  const auto root = [&](int i) {
    while (parent[static_cast<std::size_t>(i)] != i) i = parent[static_cast<std::size_t>(i)];
    return i;
  };
  int count = static_cast<int>(parent.size());
  for (const auto& t : mesh.triangles)
    for (const auto& [a, b] : {std::pair{t[0], t[1]}, {t[1], t[2]}}) {
      const int from = root(a), to = root(b);
      if (from == to) continue;
      parent[static_cast<std::size_t>(std::max(from, to))] = std::min(from, to);
      --count;
    }
  return count;
}

/// The share of the particles' volume, spacing^3 each, that the surface encloses.
inline double volume_share(const std::vector<Vec3f>& particles, const TriangleMesh& mesh) {
  const double each = static_cast<double>(spacing) * static_cast<double>(spacing) * static_cast<double>(spacing);
  return volume(mesh) / (static_cast<double>(particles.size()) * each);
}

}  // namespace pliant
