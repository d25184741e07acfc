// Small sets of triangles that are hard for broad phases: distant, on cell boundaries, flat, degenerate, coincident, of
// any size.
#pragma once

#include <array>
#include <random>
#include <vector>

#include "math/vector.h"

namespace pliant::testing_support {

using Corners3 = std::array<Vec3f, 3>;

inline Vec3f random_vector(std::mt19937_64& random, float range) {
  std::uniform_real_distribution<float> uniform(-range, range);
  const float x = uniform(random), y = uniform(random), z = uniform(random);
  return {x, y, z};
}

inline Corners3 random_triangle(std::mt19937_64& random, float place, float size) {
  const Vec3f at = random_vector(random, place);
  return {at + random_vector(random, size), at + random_vector(random, size), at + random_vector(random, size)};
}

/// Makes up to about twenty triangles. `kind`, from 0 to nasty_kinds - 1, selects what is hard about them.
constexpr int nasty_kinds = 9;
inline std::vector<Corners3> nasty_triangles(std::mt19937_64& random, int kind) {
  std::vector<Corners3> all(std::uniform_int_distribution<std::size_t>(0, 22)(random));
  const Vec3f far{-4096.25f, 8191, 1e5f};
  float size = 1;
  for (Corners3& t : all) {
    t = random_triangle(random, 1, 0.4f);
    for (Vec3f& p : t) {
      if (kind == 1) p = p - Vec3f{7, 7, 7};  // all coordinates negative
      if (kind == 2) p = p + far;             // far from the origin
      if (kind == 3)
        p = {static_cast<float>(static_cast<int>(p.x * 4)), static_cast<float>(static_cast<int>(p.y * 4)),
             static_cast<float>(static_cast<int>(p.z * 4))};  // on cell boundaries, many degenerate
      if (kind == 4) p.y = 0;                                 // in one plane
      if (kind == 5) p = {p.x, p.x, p.x};                     // on one line
      if (kind == 6) p = t[0];                                // each triangle is a point
      if (kind == 7) p = p * size;                            // of all sizes
      if (kind == 8) p = p * 1e-20f;                          // tiny
    }
    size = size * 0.5f;
  }
  if (kind == 6 && all.size() > 3) all[1] = all[0], all[2] = all[0];  // coincident ones
  return all;
}

}  // namespace pliant::testing_support
