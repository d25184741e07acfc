#include "solver/fluids/vorticity.h"

#include <algorithm>

#include "core/at.h"
#include "solver/bodies/body_math.h"
#include "solver/fluids/fluid_solver.h"
#include "solver/fluids/for_groups.h"
#include "solver/fluids/vorticity_formulas.h"
#include "solver/substep.h"
#include "solver/substep_law.h"

namespace pliant {

namespace {

/// Substeps after which it acts.
constexpr int substeps_of_vorticity = 4;

/// Calls body(neighbour, vector from it, gradient_factor) for the neighbours of a slot, in ascending order.
template <class Body>
void for_neighbours(const FluidPool& pool, const Records& places, int slot, const Body& body) {
  constexpr int lanes = NeighbourLists::lanes;
  const NeighbourGroup& group = pool.neighbours.group(slot / lanes);
  const Vec3f own = xyz(places[at(slot)]);
  for (int k = 0; k < group.rows; ++k) {
    const std::int32_t other = group.slots[k * lanes + slot % lanes];
    if (other == pool.neighbours.nobody()) return;
    const Vec3f d = own - xyz(places[at(other)]);
    body(at(other), d, vorticity_formulas::gradient_factor(pool.law, d));
  }
}

}  // namespace

void FluidVorticity::add(float coefficient, int particles) {
  has_any_ = has_any_ || coefficient > 0;
  of_point_.resize(of_point_.size() + at(particles), coefficient);
}

void FluidVorticity::clear() {
  has_any_ = false;
  of_point_.clear();
}

void FluidVorticity::begin_frame() {
  substeps_ = 0;
  seconds_ = 0;
}

void FluidVorticity::load(Substep& s, const FluidPool& pool, FunctionRef<Vec3f(int)> gravity) {
  const std::size_t slots = at(pool.neighbours.slots());
  for (Records* records : {&places_, &velocities_, &vorticities_, &gains_}) records->resize(slots);
  parts_.resize(at(pool.neighbours.groups()));
  for_groups(s.context.executor, "respond: vorticity", pool.neighbours, [&](int, int first, int last) {
    for (std::size_t slot = at(first); slot < at(last); ++slot) {
      const std::size_t particle = at(pool.of_slot[slot]);
      places_[slot] = s.state.positions[particle];
      velocities_[slot] = plus(s.state.velocities[particle], gravity(s.model.object_of(pool.of_slot[slot])));
    }
  });
}

void FluidVorticity::measure(const FluidPool& pool, int slot) {
  const Vec3f own = xyz(velocities_[at(slot)]);
  Vec3f sum{};
  for_neighbours(pool, places_, slot, [&](std::size_t other, const Vec3f& d, float factor) {
    sum += cross(xyz(velocities_[other]) - own, d) * factor;
  });
  sum = sum * (1 / pool.law.passed_on);
  vorticities_[at(slot)] = {sum.x, sum.y, sum.z, length(sum)};
}

Vec3f FluidVorticity::gain(const FluidPool& pool, int slot) const {
  const float coefficient = of_point_[at(pool.neighbours.order().points()[at(slot)])];
  if (!(coefficient > 0)) return {};
  const Record& own = vorticities_[at(slot)];
  Vec3f slope{};
  for_neighbours(pool, places_, slot, [&](std::size_t other, const Vec3f& d, float factor) {
    slope += d * (factor * (own.w - vorticities_[other].w));
  });
  return vorticity_formulas::confinement(pool.law, slope, xyz(own), own.w) * (coefficient * seconds_);
}

/// The momentum that all gain, over the sum of its magnitudes.
Vec3f FluidVorticity::surplus() const {
  Part all;
  for (const Part& part : parts_) {
    all.momentum += part.momentum;
    all.magnitude += part.magnitude;
  }
  return all.magnitude > 0 ? convert<float>(all.momentum * (1 / all.magnitude)) : Vec3f{};
}

/// The gain of each particle, and the momentum of each group.
void FluidVorticity::find_gains(Substep& s, const FluidPool& pool) {
  for_groups(s.context.executor, "respond: vorticity", pool.neighbours, [&](int group, int first, int last) {
    Part part;
    for (int slot = first; slot < last; ++slot) {
      const float inverse = s.state.positions[at(pool.of_slot[at(slot)])].w;
      const Vec3f by = inverse > 0 ? gain(pool, slot) : Vec3f{};
      const float size = length(by);
      gains_[at(slot)] = {by.x, by.y, by.z, size};
      if (!(size > 0)) continue;
      const double mass = 1 / static_cast<double>(inverse);
      part.momentum += convert<double>(by) * mass;
      part.magnitude += static_cast<double>(size) * mass;
    }
    parts_[at(group)] = part;
  });
}

void FluidVorticity::respond(Substep& s, const FluidPool& pool, FunctionRef<Vec3f(int)> gravity) {
  if (!has_any_) return;
  seconds_ += s.h;
  if (++substeps_ < substeps_of_vorticity && !s.is_last() && !ends_quarter(s))
    return;  // a frame may stop where a quarter ends
  load(s, pool, gravity);
  for_groups(s.context.executor, "respond: vorticity", pool.neighbours, [&](int, int first, int last) {
    for (int slot = first; slot < last; ++slot) measure(pool, slot);
  });
  find_gains(s, pool);
  const Vec3f back = surplus();
  for_groups(s.context.executor, "respond: vorticity", pool.neighbours, [&](int, int first, int last) {
    for (std::size_t slot = at(first); slot < at(last); ++slot) {
      Record& v = s.state.velocities[at(pool.of_slot[slot])];
      v = plus(v, xyz(gains_[slot]) - back * gains_[slot].w);
    }
  });
  begin_frame();
}

}  // namespace pliant
