// The ways to visit constraints, one file each. None is known to a constraint, and none knows a constraint's type: all work
// on the pools and the schedule of the compiled model, through the kernels.
//
// Each object is solved by the method that it was compiled for (CompiledObject::sweep). Objects of one method are a group: an
// iteration visits group after group. Volumes are part of a sweep; tethers and contacts come after all of them
// (stages/solve.cpp), so that constraints pull no particle into a collider.
#pragma once

#include <map>
#include <memory>

#include "pliant/scene.h"

namespace pliant {

struct Model;
struct Substep;
struct Workspace;

/// What the scratch of a method is made from.
struct SweepSetup {
  const Model& model;
  const Workspace& workspace;  ///< with the multipliers that are kept
  const SweepOptions& options;
  Sweep sweep = Sweep::tiled;  ///< of the group
  int threads = 1;

  /// Whether an object is of the group.
  bool has(int object) const;
};

/// What a method keeps between the passes of a substep. Nothing of it outlives a substep: a State put back gives the same bits.
class SweepScratch {
 public:
  virtual ~SweepScratch() = default;
  /// Makes room after an object was added, removed or recompiled. One that is not of the group takes none of its own, and what
  /// was kept under its number goes.
  virtual void prepare(const SweepSetup& setup, int object) = 0;
};

struct SweepMethod {
  /// Its first pass over the constraints of a tile may be made when the tile is entered, while it is in the cache.
  bool begins_on_entry;
  /// Projections of a constraint in one iteration.
  int passes;
  /// Null where it keeps nothing.
  std::unique_ptr<SweepScratch> (*make_scratch)();
  /// One iteration: every constraint of the objects in `s.group` `passes` times. In the first of a substep the multipliers
  /// start at zero.
  void (*iterate)(Substep& s, bool first);
};

/// Objects of one method, and what the method and its acceleration keep of them.
struct SweepGroup {
  Sweep sweep = Sweep::tiled;
  const SweepMethod* method = nullptr;
  std::unique_ptr<SweepScratch> scratch, acceleration;
};

/// In the order of the enumeration, whatever objects came first.
using SweepGroups = std::map<Sweep, SweepGroup>;

/// What stands behind a Sweep; `automatic` is `tiled` here.
const SweepMethod& sweep_method(Sweep sweep);

void iterate_tiled(Substep& s, bool first);      // tiled.cpp; chains too, which are phases of their own
void iterate_symmetric(Substep& s, bool first);  // symmetric.cpp
void iterate_jacobi(Substep& s, bool first);     // jacobi.cpp
void iterate_multigrid(Substep& s, bool first);  // multigrid.cpp

}  // namespace pliant
