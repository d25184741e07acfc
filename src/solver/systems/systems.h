// The systems of a substep group, and how they are made.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "model/model.h"
#include "solver/systems/system.h"

namespace pliant {

class BodySolver;
class FluidSolver;
struct BodyMeshes;

/// What systems are made from.
struct SystemsFor {
  const Model& model;
  const std::vector<int>* objects = nullptr;  ///< of the group, ascending; null: all
  const std::vector<int>* sets = nullptr;     ///< the set of each object (solver/near_sets.h); null: all are of one
  BodyMeshes* meshes = nullptr;
};

/// In the order in which stages call them. Kinds of which the group has nothing have none.
class Systems {
 public:
  Systems() = default;
  Systems(Systems&&) noexcept;
  Systems& operator=(Systems&&) noexcept;
  ~Systems();

  /// Makes all. What lasts of them is in the State.
  void make(const SystemsFor& of);
  /// Makes those again that depend on sets of objects.
  void follow_sets(const SystemsFor& of);

  /// Adds one of a kind that is not made here, behind all others, until they are made again.
  void add(std::unique_ptr<System> system) { all_.push_back(std::move(system)); }

  bool empty() const { return all_.empty(); }
  std::vector<std::unique_ptr<System>>::const_iterator begin() const { return all_.begin(); }
  std::vector<std::unique_ptr<System>>::const_iterator end() const { return all_.end(); }

  /// Contact of cloth, ropes and particles with rigid bodies; null without rigid bodies.
  BodySolver* bodies() const { return bodies_; }
  /// Null without liquids and gases.
  const FluidSolver* fluids() const { return fluids_; }

 private:
  void add_others(const SystemsFor& of);
  template <class Solver>
  Solver* add_if_any(std::unique_ptr<Solver> solver);

  std::vector<std::unique_ptr<System>> all_;
  BodySolver* bodies_ = nullptr;
  FluidSolver* fluids_ = nullptr;
};

}  // namespace pliant
