#include "solver/systems/systems.h"

#include <algorithm>
#include <utility>

#include "solver/bodies/body_solver.h"
#include "solver/fluids/fluid_solver.h"
#include "solver/gases/gas_solver.h"
#include "solver/grains/grain_solver.h"

namespace pliant {

Systems::Systems(Systems&&) noexcept = default;
Systems& Systems::operator=(Systems&&) noexcept = default;
Systems::~Systems() = default;

template <class Solver>
Solver* Systems::add_if_any(std::unique_ptr<Solver> solver) {
  if (!solver->has_any()) return nullptr;
  all_.push_back(std::move(solver));
  return static_cast<Solver*>(all_.back().get());
}

void Systems::make(const SystemsFor& of) {
  all_.clear();
  bodies_ = nullptr;
  // Without a body the meshes of colliders need not be prepared for bodies.
  if (std::any_of(of.model.objects.begin(), of.model.objects.end(),
                  [](const CompiledObject& object) { return !object.bodies.empty(); }))
    bodies_ = add_if_any(std::make_unique<BodySolver>(of.model, of.objects, *of.meshes));
  add_others(of);
}

void Systems::follow_sets(const SystemsFor& of) {
  if (fluids_ == nullptr) return;
  all_.resize(bodies_ == nullptr ? 0 : 1);  // bodies are the first
  add_others(of);
}

void Systems::add_others(const SystemsFor& of) {
  fluids_ = add_if_any(std::make_unique<FluidSolver>(of.model, of.objects, of.sets));
  add_if_any(std::make_unique<GrainSolver>(of.model, of.objects));
  add_if_any(std::make_unique<GasSolver>(of.model, of.objects, fluids_));
}

}  // namespace pliant
