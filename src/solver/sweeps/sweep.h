// The sweep methods: in which order constraints are visited, one file for each method. Methods do not depend on
// constraint types: they use the pools and the schedule of the compiled model through the kernels.
//
// Each object is solved by the method that it was compiled for (CompiledObject::sweep). Objects with the same method
// form a sweep group, and an iteration visits the groups in turn. A sweep includes volumes. Tethers and contacts follow
// after all groups (stages/solve.cpp), so that constraints do not pull particles into a collider.
#pragma once

#include <map>
#include <memory>

#include "pliant/scene.h"

namespace pliant {

struct Model;
struct Substep;
struct Workspace;

/// The input for making the scratch data of a method.
struct SweepSetup {
  const Model& model;
  const Workspace& workspace;  ///< has the stored multipliers
  const SweepOptions& options;
  Sweep sweep = Sweep::tiled;  ///< sweep of the group
  int threads = 1;

  /// True if an object belongs to the group.
  bool has(int object) const;
};

/// Data of a method within a substep. None is kept for the next one, so a restored State gives the same bits.
class SweepScratch {
 public:
  virtual ~SweepScratch() = default;
  /// Call it after an object was added, removed or recompiled. Clears the data of that object, and allocates new data
  /// if the object belongs to the sweep group.
  virtual void prepare(const SweepSetup& setup, int object) = 0;
};

struct SweepMethod {
  /// True if the first pass over a tile may run when the tile is entered, while it is in the cache.
  bool begins_on_entry;
  /// Number of projections of each constraint per iteration.
  int passes;
  /// Makes the scratch data; null if the method needs none.
  std::unique_ptr<SweepScratch> (*make_scratch)();
  /// Runs one iteration: projects every constraint of the objects in `s.group` `passes` times. `first` is true in the
  /// first iteration of a substep, in which multipliers start at zero.
  void (*iterate)(Substep& s, bool first);
};

/// The objects of one method, with the scratch data of the method and of its acceleration.
struct SweepGroup {
  Sweep sweep = Sweep::tiled;
  const SweepMethod* method = nullptr;
  std::unique_ptr<SweepScratch> scratch, acceleration;
};

/// All sweep groups, in the order of the enumeration, which does not depend on the objects.
using SweepGroups = std::map<Sweep, SweepGroup>;

/// Returns the method of a Sweep; for `automatic` that of `tiled`.
const SweepMethod& sweep_method(Sweep sweep);

void iterate_tiled(Substep& s, bool first);      // tiled.cpp; also for `chains`, which add phases
void iterate_symmetric(Substep& s, bool first);  // defined in symmetric.cpp
void iterate_jacobi(Substep& s, bool first);     // defined in jacobi.cpp
void iterate_multigrid(Substep& s, bool first);  // defined in multigrid.cpp

}  // namespace pliant
