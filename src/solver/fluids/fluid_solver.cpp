#include "solver/fluids/fluid_solver.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/at.h"
#include "parallel/launch.h"
#include "solver/fluids/fluid_kernels.h"
#include "solver/fluids/fluid_log.h"
#include "solver/fluids/for_groups.h"
#include "solver/substep.h"

namespace pliant {

namespace {

/// Neighbours are found again after so many substeps. Finding them in each changes neither the density nor the energy
/// of a dam break.
constexpr int oldest_neighbours = 5;
/// Share of a correction that is made, because neighbours correct the same error: without it particles overshoot.
constexpr float relaxation = 0.4f;

/// Liquids mix if these are equal.
auto kind_of(const CompiledObject& object) {
  return std::tuple{object.fluid->spacing, object.fluid->speed_of_sound, object.groups, object.mask};
}

/// Calls body(i) for each i in [0, count) on all threads.
template <class Body>
void for_all(Substep& s, const char* name, int count, const Body& body) {
  s.context.executor.parallel_for(name, launch_blocks(count), [&](int block) {
    const int first = block * launch_block, last = std::min(first + launch_block, count);
    for (int i = first; i < last; ++i) body(i);
  });
}

}  // namespace

FluidSolver::FluidSolver(const Model& model, const std::vector<int>* objects, const std::vector<int>* sets) {
  const auto set_of = [&](int o) { return sets != nullptr ? (*sets)[at(o)] : 0; };
  const auto add = [&](int o) {
    const CompiledObject& object = model.objects[at(o)];
    if (!object.fluid) return;
    auto pool = std::find_if(pools_.begin(), pools_.end(), [&](const auto& one) {
      const int first = one->objects.front();
      return set_of(first) == set_of(o) && kind_of(model.objects[at(first)]) == kind_of(object);
    });
    if (pool == pools_.end()) pool = pools_.insert(pool, std::make_unique<FluidPool>());
    FluidPool& p = **pool;
    p.objects.push_back(o);
    p.law = fluid_law(object.fluid->spacing);
    p.softness = fluid_compliance(object.fluid->speed_of_sound);
  };
  const int count = static_cast<int>(objects != nullptr ? objects->size() : model.objects.size());
  for (int i = 0; i < count; ++i) add(objects != nullptr ? (*objects)[at(i)] : i);
  for (auto& pool : pools_) list_points(model, {}, *pool);
}

FluidSolver::~FluidSolver() = default;

/// Lists the particles of a pool that are there, and what each has where that differs or is used at all.
void FluidSolver::list_points(const Model& model, const State& state, FluidPool& p) {
  const auto fluid_of = [&](int o) -> const Fluid& { return *model.objects[at(o)].fluid; };
  const auto any = [&](float Fluid::*of) {
    return std::any_of(p.objects.begin(), p.objects.end(), [&](int o) { return fluid_of(o).*of > 0; });
  };
  const bool is_viscous = any(&Fluid::viscosity), has_tension = any(&Fluid::surface_tension),
             swirls = any(&Fluid::vorticity);
  const auto [lightest, heaviest] = std::minmax_element(
      p.objects.begin(), p.objects.end(), [&](int a, int b) { return fluid_of(a).density < fluid_of(b).density; });
  const float least = fluid_of(*lightest).density, most = fluid_of(*heaviest).density;
  int most_points = 0;
  for (const int o : p.objects) most_points += model.end_of(o) - model.first[at(o)];
  p.points.clear();
  p.points.reserve(at(most_points));  // what grows by itself takes twice that
  p.ends.clear();
  p.lightness_of_point.clear();
  p.viscosity.clear();
  p.tension.clear();
  p.vorticity.clear();
  for (const int o : p.objects) {
    const std::size_t before = p.points.size();
    for (int i = model.first[at(o)]; i < model.end_of(o); ++i)
      if (is_there(state, at(i))) p.points.push_back(i);
    const int added = static_cast<int>(p.points.size() - before);
    if (least < most) p.lightness_of_point.resize(p.points.size(), least / fluid_of(o).density);
    if (is_viscous) p.viscosity.add(fluid_of(o).viscosity, added);
    if (has_tension) p.tension.add(fluid_of(o), added);
    if (swirls) p.vorticity.add(fluid_of(o).vorticity, added);
    p.ends.push_back(static_cast<std::int32_t>(p.points.size()));
  }
}

void FluidSolver::begin_frame(Substep& s) {
  for (auto& pool : pools_) {
    pool->age = -1;
    pool->viscosity.begin_frame();
    pool->tension.begin_frame();
    pool->vorticity.begin_frame();
    if (!s.state.births.empty()) list_points(s.model, s.state, *pool);
    pool->overlaps.begin_frame(s.state, pool->points);
  }
}

void FluidSolver::find_neighbours(Substep& s, FluidPool& pool) {
  Records& by_point = pool.weighted;  // scratch
  by_point.resize(pool.points.size());
  for_all(s, "neighbours: order", static_cast<int>(by_point.size()),
          [&](int i) { by_point[at(i)] = predicted_position(s, pool.points[at(i)]); });
  pool.neighbours.find(s.context.executor, s.kernels.neighbours, by_point, pool.law.reach, pool.viscosity.has_any());
  pool.tension.find_neighbours(s, pool, by_point);
  const std::vector<std::int32_t>& order = pool.neighbours.order().points();
  const std::size_t padded = at(pool.neighbours.nobody()) + NeighbourLists::lanes;
  pool.of_slot.resize(order.size());
  pool.places.resize(padded);
  for_all(s, "neighbours: order", pool.neighbours.slots(), [&](int slot) {
    pool.of_slot[at(slot)] = pool.points[at(order[at(slot)])];
    pool.places[at(slot)] = by_point[at(order[at(slot)])];
  });
  pool.weighted.resize(padded);
  for (Records* records : {&pool.places, &pool.weighted})
    std::fill(records->begin() + pool.neighbours.slots(), records->end(), Record{nowhere, nowhere, nowhere, 0});
  find_lightness(s.state, pool);
  pool.multipliers.assign(padded, 0);
  pool.densities.assign(padded, 0);
  pool.walls.find(s.context.executor, s.model.objects[at(pool.objects.front())], pool.neighbours, pool.places,
                  FluidBodies::bounds(s, pool.objects.front()), pool.law.reach, pool.law.reach / 2);
  pool.squares.assign(pool.walls.near_solids().empty() ? 0 : padded, 0);
  pool.overlaps.find(s, pool);
}

/// Particles that are fixed do not move, but push others.
void FluidSolver::find_lightness(const State& state, FluidPool& pool) const {
  const auto is_fixed = [&](std::int32_t particle) { return state.positions[at(particle)].w == 0; };
  const bool are_alike =
      pool.lightness_of_point.empty() && std::none_of(pool.points.begin(), pool.points.end(), is_fixed);
  pool.lightness.assign(are_alike ? 0 : pool.places.size(), 1);
  const auto moving = std::find_if_not(pool.points.begin(), pool.points.end(), is_fixed);
  pool.mass = moving == pool.points.end() ? 0 : 1 / state.positions[at(*moving)].w;
  if (are_alike) return;
  if (!pool.lightness_of_point.empty() && moving != pool.points.end())
    pool.mass *= pool.lightness_of_point[at(moving - pool.points.begin())];
  const std::vector<std::int32_t>& order = pool.neighbours.order().points();
  for (std::size_t slot = 0; slot < order.size(); ++slot) {
    if (!pool.lightness_of_point.empty()) pool.lightness[slot] = pool.lightness_of_point[at(order[slot])];
    if (is_fixed(pool.of_slot[slot])) pool.lightness[slot] = 0;
  }
}

void FluidSolver::collide(Substep& s) {
  for (auto& pool : pools_) {
    if (pool->age < 0 || ++pool->age >= oldest_neighbours) {
      find_neighbours(s, *pool);
      pool->age = 0;
    }
    pool->tension.act(s, *pool);
  }
}

void FluidSolver::project_pool(Substep& s, FluidPool& pool, bool is_first) {
  if (is_first) std::fill(pool.multipliers.begin(), pool.multipliers.end(), 0.f);
  if (is_first) pool.overlaps.begin_substep(s, pool);
  const NeighbourLists& lists = pool.neighbours;
  const FluidBounds bounds = FluidBodies::bounds(s, pool.objects.front());
  for_groups(s.context.executor, "solve: places of liquids", lists, [&](int group, int first, int last) {
    for (int slot = first; slot < last; ++slot) pool.places[at(slot)] = predicted_position(s, pool.of_slot[at(slot)]);
    pool.walls.measure(s.kernels.fluids, pool.law, bounds, pool.places, group);
  });
  pool.bodies.count(s, pool.walls);
  FluidArrays a{pool.law, relaxation, pool.softness / (s.h * s.h)};
  a.places = pool.places.data();
  a.weighted = pool.weighted.data();
  a.multipliers = pool.multipliers.data();
  a.walls = pool.walls.shares().data();
  a.has_walls = pool.walls.has_any().data();
  a.densities = pool.densities.data();
  a.lightness = pool.lightness.empty() ? nullptr : pool.lightness.data();
  a.points = pool.of_slot.data();
  a.displacements = s.work.displacements.data();
  a.squares = pool.squares.empty() ? nullptr : pool.squares.data();
  a.slots = lists.slots();
  const FluidKernels& kernels = s.kernels.fluids;
  for_groups(s.context.executor, "solve: density", lists, [&](int g, int, int) {
    if (a.squares != nullptr) pool.bodies.add_squares(s, pool.walls, pool.places, pool.mass, g, pool.squares);
    kernels.find_multipliers(a, lists.group(g), g);
  });
  for_groups(s.context.executor, "solve: density", lists, [&](int g, int, int) { kernels.move(a, lists.group(g), g); });
  pool.overlaps.limit(s, pool, pool.weighted);
  if (s.work.contact_log != nullptr) log_pressure(s, pool, bounds, *s.work.contact_log);
  if (a.squares != nullptr) pool.bodies.push(s, pool.walls, pool.weighted, pool.lightness, pool.mass);
}

void FluidSolver::project_neighbours(Substep& s, bool is_first) {
  for (auto& pool : pools_) {
    project_pool(s, *pool, is_first);
    pool->viscosity.solve(s, *pool, is_first);
  }
}

void FluidSolver::respond(Substep& s, FunctionRef<Vec3f(int)> gravity) {
  for (auto& pool : pools_) {
    pool->vorticity.respond(s, *pool, gravity);
    pool->overlaps.end_substep(s.state, *pool);
  }
}

namespace {

/// Liquids of several groups: the mean of the worst.
void add_compression(const Compression& c, Compression& sum) {
  sum.mean = std::max(sum.mean, c.mean);
  sum.largest = std::max(sum.largest, c.largest);
  sum.crowded += c.crowded;
}

void add_viscosity(const ViscositySolves& solves, Report& sum) {
  sum.viscosity += solves;
  if (solves.unfinished == 0) return;
  sum.warnings.push_back("the viscosity of liquids was not solved to the end in " + std::to_string(solves.unfinished) +
                         " solves, at worst to " + std::to_string(100 * solves.residual) +
                         " % of its residual; use more substeps, a larger spacing, or a lower viscosity");
}

void add_tension(const TensionActs& acts, Report& sum) {
  sum.tension += acts;
  if (acts.share == 1) return;
  sum.warnings.push_back("substeps are too long for the surface tension of a liquid, so " +
                         std::to_string(100 * acts.share) + " % of it acts; use " +
                         std::to_string(std::sqrt(1 / acts.share)) + " times as many substeps, or a larger spacing");
}

}  // namespace

ViscositySolves FluidSolver::viscosity() const {
  ViscositySolves all;
  for (const auto& pool : pools_) all += pool->viscosity.solves();
  return all;
}

TensionActs FluidSolver::tension() const {
  TensionActs all;
  for (const auto& pool : pools_) all += pool->tension.acts();
  return all;
}

Compression FluidSolver::compression() const {
  Compression all;
  double count = 0;
  for (const auto& pool : pools_) {
    all.crowded += pool->neighbours.left_out();
    for (int slot = 0; slot < pool->neighbours.slots(); ++slot) {
      const double over = static_cast<double>(pool->densities[at(slot)]) - 1;
      all.mean += std::max(over, 0.0);
      all.largest = std::max(all.largest, over);
      ++count;
    }
  }
  if (count > 0) all.mean /= count;
  return all;
}

void FluidSolver::report(Report& report) const {
  add_compression(compression(), report.compression);
  add_viscosity(viscosity(), report);
  add_tension(tension(), report);
}

}  // namespace pliant
