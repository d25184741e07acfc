// Generates meshes: grids and spheres for scenes, tests and benchmarks. Values are computed in double precision and
// rounded once; the only function of libm is the square root, which is exact. So meshes have the same bits on every
// machine.
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "pliant/error.h"
#include "pliant/mesh.h"
#include "topology/edges.h"

namespace pliant {

namespace {

void require_grid(int columns, int rows, float width, float depth) {
  if (columns < 2 || rows < 2)
    throw Error({},
                "a grid of " + std::to_string(columns) + " x " + std::to_string(rows) + " vertices has no triangles",
                "give at least 2 columns and 2 rows");
  if (static_cast<std::int64_t>(columns) * rows > std::numeric_limits<std::int32_t>::max() / 6)
    throw Error({}, "a grid of " + std::to_string(columns) + " x " + std::to_string(rows) + " vertices is too large");
  if (!(width > 0) || !(depth > 0) || !std::isfinite(width) || !std::isfinite(depth))
    throw Error(
        {}, "a grid's sizes must be positive and finite, not " + std::to_string(width) + " x " + std::to_string(depth));
}

Vec3f rounded(const Vec3d& p) { return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)}; }

Vec3d normalised(const Vec3d& p) { return p * (1 / std::sqrt(length_squared(p))); }

struct SphereInDouble {
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;
};

/// The regular icosahedron; its vertices are the corners of three golden rectangles.
SphereInDouble icosahedron() {
  const double golden = (1 + std::sqrt(5.0)) / 2;
  SphereInDouble sphere;
  sphere.positions = {{-1, golden, 0}, {1, golden, 0}, {-1, -golden, 0}, {1, -golden, 0},
                      {0, -1, golden}, {0, 1, golden}, {0, -1, -golden}, {0, 1, -golden},
                      {golden, 0, -1}, {golden, 0, 1}, {-golden, 0, -1}, {-golden, 0, 1}};
  for (Vec3d& p : sphere.positions) p = normalised(p);
  sphere.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  return sphere;
}

/// Splits every triangle into four. New vertices are midpoints of edges, in the order of edges, projected onto the
/// sphere.
SphereInDouble subdivided(const SphereInDouble& coarse) {
  SphereInDouble fine;
  fine.positions = coarse.positions;
  const int old_count = static_cast<int>(coarse.positions.size());
  const std::vector<Edge> edges = find_edges(coarse.triangles, old_count);
  std::vector<Triangle> middles(coarse.triangles.size());  // new vertex at the middle of the side opposite each corner
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const Edge& edge = edges[e];
    fine.positions.push_back(normalised(coarse.positions[static_cast<std::size_t>(edge.a)] +
                                        coarse.positions[static_cast<std::size_t>(edge.b)]));
    for (std::size_t side = 0; side < 2; ++side) {
      const auto t = static_cast<std::size_t>(edge.triangles[side]);
      for (std::size_t corner = 0; corner < 3; ++corner)
        if (coarse.triangles[t][corner] == edge.opposites[side]) middles[t][corner] = old_count + static_cast<int>(e);
    }
  }
  for (std::size_t t = 0; t < coarse.triangles.size(); ++t) {
    const auto [a, b, c] = coarse.triangles[t];
    const auto [bc, ca, ab] = middles[t];
    fine.triangles.insert(fine.triangles.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
  }
  return fine;
}

}  // namespace

TriangleMesh grid_mesh(int columns, int rows, float width, float depth) {
  require_grid(columns, rows, width, depth);
  TriangleMesh mesh;
  mesh.positions.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c)
      mesh.positions.push_back(rounded({(static_cast<double>(c) / (columns - 1) - 0.5) * width, 0,
                                        (static_cast<double>(r) / (rows - 1) - 0.5) * depth}));
  mesh.triangles.reserve(2 * static_cast<std::size_t>(columns - 1) * static_cast<std::size_t>(rows - 1));
  for (int r = 0; r + 1 < rows; ++r)
    for (int c = 0; c + 1 < columns; ++c) {
      const int corner = r * columns + c, across = corner + columns + 1;
      mesh.triangles.push_back({corner, corner + columns, across});
      mesh.triangles.push_back({corner, across, corner + 1});
    }
  return mesh;
}

TriangleMesh sphere_mesh(int subdivisions) {
  if (subdivisions < 0 || subdivisions > 7)
    throw Error({}, "a sphere cannot be subdivided " + std::to_string(subdivisions) + " times",
                "give 0 to 7 subdivisions");
  SphereInDouble sphere = icosahedron();
  for (int i = 0; i < subdivisions; ++i) sphere = subdivided(sphere);
  TriangleMesh mesh;
  mesh.positions.reserve(sphere.positions.size());
  for (const Vec3d& p : sphere.positions) mesh.positions.push_back(rounded(p));
  mesh.triangles = std::move(sphere.triangles);
  return mesh;
}

}  // namespace pliant
