// What the tests of steps and sweeps share: the constraints of a grid, a balloon, and bitwise comparison of States.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "pliant/world.h"

namespace pliant::testing_support {

/// Stencils of a grid of n x n particles, row after row; the diagonal of a cell runs from (r, c) to (r + 1, c + 1).
struct GridStencils {
  std::vector<int> across, along, diagonals, hinges;
  std::vector<std::array<int, 3>> triangles;
};

inline GridStencils grid_stencils(int n) {
  GridStencils grid;
  const auto at = [&](int r, int c) { return r * n + c; };
  for (int r = 0; r < n; ++r) {
    for (int c = 0; c < n; ++c) {
      if (c + 1 < n) grid.across.insert(grid.across.end(), {at(r, c), at(r, c + 1)});
      if (r + 1 < n) grid.along.insert(grid.along.end(), {at(r, c), at(r + 1, c)});
      if (r + 1 == n || c + 1 == n) continue;
      grid.diagonals.insert(grid.diagonals.end(), {at(r, c), at(r + 1, c + 1)});
      grid.hinges.insert(grid.hinges.end(), {at(r, c), at(r + 1, c + 1), at(r + 1, c), at(r, c + 1)});
      grid.triangles.push_back({at(r, c), at(r + 1, c), at(r + 1, c + 1)});
      grid.triangles.push_back({at(r, c), at(r + 1, c + 1), at(r, c + 1)});
    }
  }
  return grid;
}

/// A closed ball of radius 0.2 m with 1 g per particle, and a skin of compliant edges.
inline Object balloon(int subdivisions, float pressure, const Stiffness& stiffness,
                      const Vec3f& centre = {0, 1.5f, 0.4f}) {
  const TriangleMesh mesh = sphere_mesh(subdivisions);
  Object object;
  object.name = "balloon";
  for (const Vec3f& p : mesh.positions)
    object.positions.push_back({centre.x + p.x * 0.2f, centre.y + p.y * 0.2f, centre.z + p.z * 0.2f});
  object.masses.assign(object.positions.size(), 0.001f);
  object.triangles = mesh.triangles;
  ConstraintGroup edges{"distance", {}, {}, Stiffness::compliance(1e-4f), {}};
  for (const auto& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (t[i] < t[(i + 1) % 3]) edges.particles.insert(edges.particles.end(), {t[i], t[(i + 1) % 3]});
    }
  }
  object.constraints = {edges};
  object.volume = Volume{pressure, stiffness};
  return object;
}

inline bool equal_bits(const Records& a, const Records& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Record)) == 0;
}

inline void expect_equal(const State& a, const State& b, const std::string& what) {
  EXPECT_TRUE(equal_bits(a.positions, b.positions)) << what << ": positions";
  EXPECT_TRUE(equal_bits(a.velocities, b.velocities)) << what << ": velocities";
  EXPECT_TRUE(equal_bits(a.remainders, b.remainders)) << what << ": remainders";
}

}  // namespace pliant::testing_support
