#include "solver/fluids/tension.h"

#include <algorithm>

#include "core/at.h"
#include "solver/fluids/fluid_solver.h"
#include "solver/fluids/for_groups.h"
#include "solver/substep.h"

namespace pliant {

void FluidTension::add(const Fluid& fluid, int particles) {
  has_any_ = has_any_ || fluid.surface_tension > 0;
  of_point_.resize(of_point_.size() + at(particles), fluid.surface_tension);
  masses_.resize(masses_.size() + at(particles), fluid.density * fluid.spacing * fluid.spacing * fluid.spacing);
  wetting_.add(fluid, particles);
}

void FluidTension::clear() {
  has_any_ = false;
  of_point_.clear();
  masses_.clear();
  wetting_.clear();
}

void FluidTension::find_neighbours(Substep& s, const FluidPool& pool, const Records& by_point) {
  if (!has_any_) return;
  if (law_.reach == 0) law_ = tension_law(pool.law.reach / 2);
  neighbours_.find(s.context.executor, s.kernels.neighbours, by_point, law_.reach);
  const std::size_t padded = at(neighbours_.nobody()) + NeighbourLists::lanes;
  places_.assign(padded, {nowhere, nowhere, nowhere, 0});
  lacking_.assign(padded, {nowhere, nowhere, nowhere, 0});
  forces_.resize(padded);
  tensions_.assign(padded, 0);
  if (wetting_.has_any()) wetting_.find(s, pool.objects.front(), neighbours_, by_point, law_.reach);
}

/// Predicted places, and the tension that acts on each: as much as is stable.
void FluidTension::gather(Substep& s, const FluidPool& pool) {
  const float stiffness = law_.stiffness / (s.h * s.h);
  const std::vector<std::int32_t>& order = neighbours_.order().points();
  for_groups(s.context.executor, "surface tension", neighbours_, [&](int, int first, int last) {
    for (std::size_t slot = at(first); slot < at(last); ++slot) {
      const std::size_t point = at(order[slot]);
      const std::size_t particle = at(pool.points[point]);
      const Record &x = s.state.positions[particle], &d = s.work.displacements[particle];
      places_[slot] = {x.x + d.x, x.y + d.y, x.z + d.z, 0};
      tensions_[slot] = std::min(of_point_[point], stiffness * masses_[point]);
    }
  });
  for (std::size_t point = 0; point < of_point_.size(); ++point)
    if (of_point_[point] > 0) acts_.share = std::min(acts_.share, stiffness * masses_[point] / of_point_[point]);
}

void FluidTension::act(Substep& s, const FluidPool& pool) {
  if (!has_any_) return;
  gather(s, pool);
  if (wetting_.has_any()) wetting_.measure(s, neighbours_, places_);
  TensionArrays a{law_};
  a.places = places_.data();
  a.tensions = tensions_.data();
  a.walls = wetting_.has_any() ? wetting_.counts().data() : nullptr;
  a.lacking = lacking_.data();
  a.forces = forces_.data();
  for_groups(s.context.executor, "surface tension", neighbours_,
             [&](int g, int, int) { s.kernels.tension.count(a, neighbours_.group(g), g); });
  for_groups(s.context.executor, "surface tension", neighbours_,
             [&](int g, int, int) { s.kernels.tension.pull(a, neighbours_.group(g), g); });
  if (wetting_.has_any()) wetting_.pull(s, neighbours_, lacking_, tensions_, forces_);
  move(s, pool);
}

/// Moves particles by the forces of a substep.
void FluidTension::move(Substep& s, const FluidPool& pool) {
  const std::vector<std::int32_t>& order = neighbours_.order().points();
  for_groups(s.context.executor, "surface tension", neighbours_, [&](int, int first, int last) {
    for (std::size_t slot = at(first); slot < at(last); ++slot) {
      const std::size_t particle = at(pool.points[at(order[slot])]);
      const float by = s.h * s.h * s.state.positions[particle].w;
      Record& d = s.work.displacements[particle];
      const Record& f = forces_[slot];
      d = {d.x + f.x * by, d.y + f.y * by, d.z + f.z * by, d.w};
    }
  });
}

}  // namespace pliant
