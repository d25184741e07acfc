// Moments of neighbours, and the kernels that follow from them.
#include "surface/splats.h"

#include <algorithm>
#include <cmath>

#include "core/at.h"
#include "parallel/ranges.h"
#include "surface/splat_formula.h"

namespace pliant::surface {

namespace {

/// The ranges of particles in the cells around one.
struct Surroundings {
  std::array<ParticleRange, 9> ranges;
  int count = 0;
};

Surroundings particles_of(const ParticleCells& cells, const std::array<CellRow, 9>& rows) {
  Surroundings found;
  for (const CellRow& row : rows) {
    if (row.first == row.last) continue;
    found.ranges[at(found.count++)] = {cells.first[at(row.first)], cells.first[at(row.last)]};
  }
  return found;
}

/// What neighbours on all sides have.
Moments full_moments(float spacing) {
  const float each = full_variance * spacing * spacing;
  return {.first = {0, 0, 0, 1}, .second = {each, each, each, 0}, .third = {0, 0, 0, 0}};
}

/// The moments of the particles of some cells. Those of enclosed cells have no surface near, and theirs are known.
std::vector<Moments> moments_of(const ParticleCells& cells, int first_cell, int last_cell, float spacing,
                                const SurfaceKernels& kernels) {
  const int before = cells.first[at(first_cell)];
  std::vector<Moments> moments(at(cells.first[at(last_cell)] - before));
  CellsAround around(cells, first_cell);
  MomentScratch scratch;
  for (int cell = first_cell; cell < last_cell; ++cell) {
    const int first = cells.first[at(cell)], last = cells.first[at(cell) + 1];
    if (cells.fills[at(cell)] == Fill::enclosed) {
      std::fill(moments.begin() + (first - before), moments.begin() + (last - before), full_moments(spacing));
      continue;
    }
    const Surroundings near = particles_of(cells, around.of(cell));
    for (int i = first; i < last; i += group_size)
      kernels.find_moments({.at = cells.places(),
                            .around = near.ranges.data(),
                            .range_count = near.count,
                            .first = i,
                            .last = std::min(i + group_size, last),
                            .radius = search_radius * spacing},
                           scratch, &moments[at(i - before)]);
  }
  return moments;
}

Box bounds_of(const Splats& splats, int first, int last) {
  Box box{.low = {INFINITY, INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY, -INFINITY}};
  for (int i = first; i < last; ++i) {
    const Splat& splat = splats.all[at(i)];
    box.low = min(box.low, splat.centre - splat.reach);
    box.high = max(box.high, splat.centre + splat.reach);
  }
  return box;
}

}  // namespace

SplatRows<const float> rows_of(const ParticleCells& cells, const Splats& splats) {
  return {cells.places(), {splats.per_x.data(), splats.per_y.data(), splats.per_z.data(), splats.widest.data()}};
}

Splats make_splats(const ParticleCells& cells, float spacing, bool anisotropic, Executor& executor,
                   const SurfaceKernels& kernels) {
  constexpr int cells_at_a_time = 128;
  Splats splats;
  splats.all.resize(cells.positions.size());
  splats.bounds.resize(cells.keys.size());
  for (std::vector<float>* const row : {&splats.per_x, &splats.per_y, &splats.per_z, &splats.widest})
    row->resize(cells.positions.size() + 16);
  for_ranges(executor, "surface: kernels", cells.size(), cells_at_a_time, [&](int first_cell, int last_cell) {
    const std::vector<Moments> moments = moments_of(cells, first_cell, last_cell, spacing, kernels);
    const std::size_t first = at(cells.first[at(first_cell)]);
    kernels.make_splats({spacing, anisotropic}, moments.data(), static_cast<int>(moments.size()),
                        {&cells.x[first], &cells.y[first], &cells.z[first]},
                        {&splats.per_x[first], &splats.per_y[first], &splats.per_z[first], &splats.widest[first]},
                        &splats.all[first]);
    for (int cell = first_cell; cell < last_cell; ++cell)
      splats.bounds[at(cell)] = bounds_of(splats, cells.first[at(cell)], cells.first[at(cell) + 1]);
  });
  return splats;
}

}  // namespace pliant::surface
