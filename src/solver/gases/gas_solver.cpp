#include "solver/gases/gas_solver.h"

#include <algorithm>

#include "core/at.h"
#include "math/record.h"
#include "solver/forces.h"
#include "solver/gases/balloon.h"
#include "solver/gases/gas_formulas.h"
#include "solver/gases/tracers.h"
#include "solver/substep.h"
#include "solver/substep_law.h"

namespace pliant {

namespace {

/// Substeps after which all but buoyancy acts.
constexpr int substeps_of_gas = 4;
/// The largest share of a temperature that diffusion may exchange in a pass, at twice the density of rest.
constexpr float largest_exchange = 0.5f;

bool has_gas(const Model& model, const FluidPool& pool) {
  return std::any_of(pool.objects.begin(), pool.objects.end(),
                     [&](int o) { return model.objects[at(o)].gas.has_value(); });
}

/// Calls body(object, particle, slot) for all slots of a pool.
template <class Body>
void for_slots(Substep& s, const char* name, const FluidPool& pool, const Body& body) {
  const std::vector<std::int32_t>& order = pool.neighbours.order().points();
  s.context.executor.parallel_for(name, pool.neighbours.tasks(), [&](int task) {
    constexpr int slots = NeighbourLists::groups_in_a_task * NeighbourLists::lanes;
    const int first = task * slots, last = std::min(first + slots, pool.neighbours.slots());
    for (int slot = first; slot < last; ++slot) {
      const auto which = std::upper_bound(pool.ends.begin(), pool.ends.end(), order[at(slot)]) - pool.ends.begin();
      body(pool.objects[at(which)], pool.of_slot[at(slot)], slot);
    }
  });
}

/// Calls body(neighbour) for the neighbours of a slot that are of a gas, in ascending order.
template <class Body>
void for_neighbours(const GasPass& pass, int slot, const Body& body) {
  const NeighbourLists& lists = pass.pool->neighbours;
  constexpr int lanes = NeighbourLists::lanes;
  const NeighbourGroup& group = lists.group(slot / lanes);
  for (int k = 0; k < group.rows; ++k) {
    const std::int32_t other = group.slots[k * lanes + slot % lanes];
    if (other == lists.nobody()) return;
    if (pass.points[at(other)].gas != nullptr) body(other);
  }
}

GasChange measure(const GasPass& pass, int slot) {
  const FluidLaw& law = pass.pool->law;
  const float scale = 1 / law.passed_on;
  const GasPoint& own = pass.points[at(slot)];
  GasChange sum;
  for_neighbours(pass, slot, [&](std::int32_t other) {
    const GasPoint& of = pass.points[at(other)];
    const Vec3f d = own.place - of.place;
    const float factor = gas_formulas::gradient_factor(law, d);
    sum.vorticity += cross(of.velocity - own.velocity, d) * factor;
    sum.heat += factor * (of.temperature - own.temperature);
  });
  sum.vorticity = sum.vorticity * scale;
  sum.vorticity_size = length(sum.vorticity);
  sum.heat *= 2 * scale;
  return sum;
}

/// The acceleration by vorticity confinement, for a coefficient of 1 m/s.
Vec3f confinement(const GasPass& pass, int slot) {
  const FluidLaw& law = pass.pool->law;
  const GasPoint& own = pass.points[at(slot)];
  const GasChange& change = pass.changes[at(slot)];
  Vec3f slope{};
  for_neighbours(pass, slot, [&](std::int32_t other) {
    const Vec3f d = own.place - pass.points[at(other)].place;
    slope +=
        d * (gas_formulas::gradient_factor(law, d) * (change.vorticity_size - pass.changes[at(other)].vorticity_size));
  });
  return vorticity_formulas::confinement(law, slope, change.vorticity, change.vorticity_size);
}

}  // namespace

std::vector<float>& channel_of(State& state, std::string_view name) {
  return std::find_if(state.channels.begin(), state.channels.end(),
                      [&](const Channel& one) { return one.name == name; })
      ->values;
}

GasSolver::GasSolver(const Model& model, const std::vector<int>* objects, const FluidSolver* fluids) : fluids_(fluids) {
  const int count = static_cast<int>(objects != nullptr ? objects->size() : model.objects.size());
  for (int i = 0; i < count; ++i) {
    const int o = objects != nullptr ? (*objects)[at(i)] : i;
    if (model.objects[at(o)].gas) gases_.push_back(o);
    if (model.objects[at(o)].tracers) tracers_.push_back(o);
    if (model.objects[at(o)].has_volume && model.objects[at(o)].volume.lift != 0) balloons_.push_back(o);
  }
}

GasSolver::~GasSolver() = default;

void GasSolver::begin_frame(Substep& /*s*/) {
  begin_pass();
  last_pass_ = -1;
}

void GasSolver::begin_pass() {
  substeps_ = 0;
  seconds_ = 0;
}

void GasSolver::apply_forces(Substep& s) {
  const Vec3f gravity = s.model.gravity * s.h;
  const auto accelerate = [&](int particle, float by) {
    Record& v = s.state.velocities[at(particle)];
    if (s.state.positions[at(particle)].w > 0)
      v = {v.x - by * gravity.x, v.y - by * gravity.y, v.z - by * gravity.z, 0};
  };
  for (const int o : gases_) {
    const CompiledObject& object = s.model.objects[at(o)];
    const std::vector<float>& temperatures = channel_of(s.state, temperature_channel);
    for (int i = s.model.first[at(o)]; i < s.model.end_of(o); ++i)
      accelerate(i, gas_formulas::lift(*object.gas, object.fluid->density, temperatures[at(i)]));
  }
  for (const int o : balloons_) lift_balloon(s, o);
  for (const int o : tracers_)
    for (int i = s.model.first[at(o)]; i < s.model.end_of(o); ++i) accelerate(i, 1);
}

void GasSolver::load(Substep& s, GasPass& pass, FunctionRef<Vec3f(int)> gravity) const {
  const std::vector<float>& temperatures = channel_of(s.state, temperature_channel);
  pass.points.resize(at(pass.pool->neighbours.slots()));
  pass.changes.resize(pass.points.size());
  for_slots(s, "respond: gases", *pass.pool, [&](int o, std::int32_t i, int slot) {
    const CompiledObject& object = s.model.objects[at(o)];
    pass.points[at(slot)] = {xyz(s.state.positions[at(i)]), xyz(s.state.velocities[at(i)]) + gravity(o),
                             temperatures[at(i)], object.gas ? &*object.gas : nullptr};
  });
}

void GasSolver::change(Substep& s, GasPass& pass, float seconds) const {
  const FluidPool& pool = *pass.pool;
  const Vec3f air = s.model.wind.air_density > 0 ? wind_at(s.model.wind, s.time_after) : Vec3f{};
  for_slots(s, "respond: gases", pool, [&](int /*object*/, std::int32_t /*particle*/, int slot) {
    if (pass.points[at(slot)].gas != nullptr) pass.changes[at(slot)] = measure(pass, slot);
  });
  std::vector<GasPoint> after = pass.points;
  for_slots(s, "respond: gases", pool, [&](int /*object*/, std::int32_t /*particle*/, int slot) {
    GasPoint& point = after[at(slot)];
    if (point.gas == nullptr) return;
    const Gas& gas = *point.gas;
    const float rate = min(gas.diffusivity * seconds, pass.largest_rate);
    point.temperature =
        gas_formulas::exchanged(gas, point.place, point.temperature + rate * pass.changes[at(slot)].heat, seconds);
    if (gas.vorticity > 0) point.velocity += confinement(pass, slot) * (gas.vorticity * seconds);
    point.velocity = gas_formulas::braked(gas, point.velocity, air, pool.densities[at(slot)], seconds);
  });
  pass.points.swap(after);
}

void GasSolver::store(Substep& s, const GasPass& pass, FunctionRef<Vec3f(int)> gravity) const {
  std::vector<float>& temperatures = channel_of(s.state, temperature_channel);
  for_slots(s, "respond: gases", *pass.pool, [&](int o, std::int32_t i, int slot) {
    const GasPoint& point = pass.points[at(slot)];
    if (point.gas == nullptr || s.state.positions[at(i)].w == 0) return;
    const Vec3f v = point.velocity - gravity(o);
    s.state.velocities[at(i)] = {v.x, v.y, v.z, 0};
    temperatures[at(i)] = point.temperature;
  });
}

void GasSolver::respond(Substep& s, FunctionRef<Vec3f(int)> gravity) {
  seconds_ += s.h;
  if (++substeps_ < substeps_of_gas && !s.is_last() && !ends_quarter(s))
    return;  // a frame may stop where a quarter ends
  std::size_t used = 0;
  if (fluids_ != nullptr)
    for (const auto& pool : fluids_->pools()) {
      if (!has_gas(s.model, *pool)) continue;
      if (passes_.size() == used) passes_.emplace_back();
      GasPass& pass = passes_[used++];
      pass.pool = pool.get();
      pass.largest_rate = largest_exchange / pool->law.laplacian;
      load(s, pass, gravity);
      change(s, pass, seconds_);
      store(s, pass, gravity);
    }
  passes_.resize(used);
  for (const int o : tracers_)
    advance_tracers(s, passes_, {o, last_pass_ < 0 ? s.frame_start : last_pass_, seconds_, gravity(o)});
  begin_pass();
  last_pass_ = time_of(s, s.number + 1);
}

}  // namespace pliant
