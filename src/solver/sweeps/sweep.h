// The sweep methods: the orders in which constraints are visited, one file each. Methods are independent of constraint
// types: they work on the pools and the schedule of the compiled model, through the kernels.
//
// Each object is solved by the method that it was compiled for (CompiledObject::sweep). Objects of one method form a
// group, and an iteration visits the groups in turn. Volumes are part of a sweep. Tethers and contacts follow after all
// groups (stages/solve.cpp), so that constraints pull no particle into a collider.
#pragma once

#include <map>
#include <memory>

#include "pliant/scene.h"

namespace pliant {

struct Model;
struct Substep;
struct Workspace;

/// The input from which a method makes its scratch.
struct SweepSetup {
  const Model& model;
  const Workspace& workspace;  ///< provides the stored multipliers
  const SweepOptions& options;
  Sweep sweep = Sweep::tiled;  ///< sweep of the group
  int threads = 1;

  /// True if an object belongs to the group.
  bool has(int object) const;
};

/// Data of a method within one substep. None persists to the next, so a restored State gives the same bits.
class SweepScratch {
 public:
  virtual ~SweepScratch() = default;
  /// Call after an object was added, removed or recompiled: clears the data under its number, and allocates new data if
  /// the object belongs to the group.
  virtual void prepare(const SweepSetup& setup, int object) = 0;
};

struct SweepMethod {
  /// True if the first pass over a tile may run when the tile is entered, while it is in the cache.
  bool begins_on_entry;
  /// Number of projections of each constraint per iteration.
  int passes;
  /// Null if the method needs no scratch.
  std::unique_ptr<SweepScratch> (*make_scratch)();
  /// Runs one iteration: projects every constraint of the objects in `s.group` `passes` times. `first`: the first
  /// iteration of a substep, in which multipliers start at zero.
  void (*iterate)(Substep& s, bool first);
};

/// The objects of one method, with the scratch of the method and of its acceleration.
struct SweepGroup {
  Sweep sweep = Sweep::tiled;
  const SweepMethod* method = nullptr;
  std::unique_ptr<SweepScratch> scratch, acceleration;
};

/// Ordered by the enumeration, independent of the order of objects.
using SweepGroups = std::map<Sweep, SweepGroup>;

/// The method of a Sweep. `automatic` gives that of `tiled`.
const SweepMethod& sweep_method(Sweep sweep);

void iterate_tiled(Substep& s, bool first);      // tiled.cpp; also for `chains`, which are phases of their own
void iterate_symmetric(Substep& s, bool first);  // symmetric.cpp
void iterate_jacobi(Substep& s, bool first);     // jacobi.cpp
void iterate_multigrid(Substep& s, bool first);  // multigrid.cpp

}  // namespace pliant
