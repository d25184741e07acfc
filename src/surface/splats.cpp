// Covariances of neighbours, and the kernels that follow from them.
#include "surface/splats.h"

#include <algorithm>
#include <cmath>

#include "parallel/ranges.h"

namespace pliant::surface {

namespace {

constexpr float search_radius = 2;    ///< of neighbours, as a share of the spacing
constexpr float lone_squared = 1.1f;  ///< squared radius of the kernel of a particle alone, in spacings^2
constexpr float full_squared = 4;     ///< the same for one with neighbours on all sides
/// The variance along each axis of neighbours on all sides: their weights are 1 - r^2 / R^2, so it is R^2 / 7.
constexpr float full_variance = search_radius * search_radius / 7;
constexpr float stretch = (full_squared - lone_squared) / full_variance;
/// A particle alone weighs so much more that its ball has the volume spacing^3.
constexpr float lone_gain = 0.45f;
constexpr float most_variance = 4.2f * full_variance;  ///< bound of the sum along three axes; it is 3 at rest

/// A symmetric 3 x 3 matrix.
struct Symmetric {
  float xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
};

/// The weighted covariance of the neighbours of a particle about their mean, in spacings^2.
Symmetric covariance(const ParticleCells& cells, const std::array<int, 27>& around, const Vec3f& at, float spacing) {
  const float per_squared = 1 / (search_radius * search_radius * spacing * spacing);
  float sum = 0;
  Vec3f mean{};
  Symmetric c;
  for (const int cell : around) {
    if (cell < 0) continue;
    for (const Vec3f& other : cells.particles(cell)) {
      const Vec3f d = other - at;
      const float w = 1 - length_squared(d) * per_squared;
      if (!(w > 0)) continue;
      const Vec3f wd = d * w;
      sum += w;
      mean += wd;
      c.xx += wd.x * d.x, c.yy += wd.y * d.y, c.zz += wd.z * d.z;
      c.xy += wd.x * d.y, c.xz += wd.x * d.z, c.yz += wd.y * d.z;
    }
  }
  const float per_sum = 1 / sum, scale = 1 / (spacing * spacing);  // the particle itself has weight 1, so sum >= 1
  mean = mean * per_sum;
  const auto about_mean = [&](float moment, float product) { return (moment * per_sum - product) * scale; };
  return {about_mean(c.xx, mean.x * mean.x), about_mean(c.yy, mean.y * mean.y), about_mean(c.zz, mean.z * mean.z),
          about_mean(c.xy, mean.x * mean.y), about_mean(c.xz, mean.x * mean.z), about_mean(c.yz, mean.y * mean.z)};
}

float trace_of(const Symmetric& c) { return std::max(c.xx, 0.f) + std::max(c.yy, 0.f) + std::max(c.zz, 0.f); }

/// The kernel's weight: 1 with neighbours on all sides, 1.02 at a flat surface.
float gain_of(const Symmetric& c) {
  const float missing = std::max(0.f, 1 - trace_of(c) * (1 / (3 * full_variance)));
  return 1 + lone_gain * (missing * missing);
}

/// The squared radii of the kernel as a matrix, in spacings^2.
Symmetric squared_radii(const Symmetric& c, bool anisotropic) {
  const float trace = trace_of(c);
  const float a = trace > most_variance ? stretch * (most_variance / trace) : stretch;
  if (!anisotropic) {
    const float same = a * trace / 3 + lone_squared;
    return {same, same, same, 0, 0, 0};
  }
  return {a * std::max(c.xx, 0.f) + lone_squared,
          a * std::max(c.yy, 0.f) + lone_squared,
          a * std::max(c.zz, 0.f) + lone_squared,
          a * c.xy,
          a * c.xz,
          a * c.yz};
}

/// The kernel with the inverse of these squared radii. Its normalised integral is 315 / (64 pi) sqrt(det A) (1 - q)^3.
Splat make_splat(const Vec3f& centre, const Symmetric& r, float gain, float spacing) {
  constexpr float unit_weight = 1.56668147f;
  const float xx = r.yy * r.zz - r.yz * r.yz, xy = r.xz * r.yz - r.xy * r.zz, xz = r.xy * r.yz - r.xz * r.yy;
  const float determinant = r.xx * xx + r.xy * xy + r.xz * xz;
  const float scale = 1 / (determinant * spacing * spacing);
  return {.centre = centre,
          .xx = xx * scale,
          .yy = (r.xx * r.zz - r.xz * r.xz) * scale,
          .zz = (r.xx * r.yy - r.xy * r.xy) * scale,
          .xy = xy * scale,
          .xz = xz * scale,
          .yz = (r.xy * r.xz - r.xx * r.yz) * scale,
          .weight = gain * unit_weight / std::sqrt(determinant),
          .reach = Vec3f{std::sqrt(r.xx), std::sqrt(r.yy), std::sqrt(r.zz)} * spacing};
}

void add_to(Box& box, const Splat& splat) {
  box.low = min(box.low, splat.centre - splat.reach);
  box.high = max(box.high, splat.centre + splat.reach);
}

/// The kernels of one cell's particles. Those of enclosed cells have no surface near, and their covariance is known.
void make_cell(const ParticleCells& cells, int cell, float spacing, bool anisotropic, Splats& splats) {
  const std::size_t c = static_cast<std::size_t>(cell);
  const bool is_enclosed = cells.fills[c] == Fill::enclosed;
  const std::array<int, 27> around = is_enclosed ? std::array<int, 27>{} : cells_around(cells, cell);
  Box box{.low = {INFINITY, INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY, -INFINITY}};
  for (std::size_t i = static_cast<std::size_t>(cells.first[c]); i < static_cast<std::size_t>(cells.first[c + 1]); ++i) {
    const Vec3f& at = cells.positions[i];
    const Symmetric spread = is_enclosed ? Symmetric{full_variance, full_variance, full_variance, 0, 0, 0}
                                         : covariance(cells, around, at, spacing);
    splats.all[i] = make_splat(at, squared_radii(spread, anisotropic), gain_of(spread), spacing);
    add_to(box, splats.all[i]);
  }
  splats.bounds[c] = box;
}

}  // namespace

Splats make_splats(const ParticleCells& cells, float spacing, bool anisotropic, Executor& executor) {
  Splats splats{.all = std::vector<Splat>(cells.positions.size()), .bounds = std::vector<Box>(cells.keys.size())};
  for_items(executor, "surface: kernels", cells.size(), 128,
            [&](int cell) { make_cell(cells, cell, spacing, anisotropic, splats); });
  for (const Splat& splat : splats.all) splats.reach = std::max(splats.reach, largest(splat.reach));
  return splats;
}

}  // namespace pliant::surface
