// The inner loops of a step: a table of functions for each instruction set level. To add a kernel, add a line to its
// struct and to each table; to add a level, see cmake/PliantLanes.cmake.
//
// All tables give the same bits and differ only in speed. The sequential table is the readable reference: plain floats,
// one constraint after another, in the same order.
#pragma once

#include <string>

#include "math/levels.h"
#include "model/pool.h"
#include "model/substep.h"

namespace pliant {

/// The position of a lane's correction among the sixteen of its batch, in register order (math/wide.h).
inline constexpr int correction_place(int lane) { return 4 * (lane % 4) + lane / 4; }

struct AirKernels;        // solver/air_kernels.h
struct ChainKernels;      // solver/sweeps/chain_kernels.h
struct MultigridKernels;  // solver/sweeps/multigrid_kernels.h
struct ContactKernels;    // solver/contact_kernels.h
struct LengthKernels;     // solver/length_kernels.h
struct ManifoldKernels;   // solver/bodies/manifold_kernels.h
struct RodKernels;        // solver/bodies/rod_kernels.h
struct MotionKernels;     // solver/motion_kernels.h
struct FluidKernels;      // solver/fluids/fluid_kernels.h
struct NeighbourKernels;  // collision/neighbours/neighbour_kernels.h
struct TensionKernels;    // solver/fluids/tension_kernels.h
struct ViscosityKernels;  // solver/fluids/viscosity_kernels.h
struct PairKernels;       // collision/proxies/pair_kernels.h

/// What projects constraints.
struct SweepKernels {
  /// Projects every constraint of the segments, segment by segment.
  void (*sweep)(const Pool* pools, const Segment* first, const Segment* last, const SweepArguments& arguments);
};

/// What moves particles between the sweeps.
struct StepKernels {
  /// True if every record is finite.
  bool (*all_finite)(const Record* records, int first, int last);

  /// Ends a substep: v = (v + (d - d predicted) / h) kept, x += d. This is v = (x - x_start) / h with damping `kept`,
  /// but divides only the solver's correction. The part of d that x cannot represent goes to the rounding residue.
  void (*update)(const AdvanceArguments& arguments);

  /// Starts a substep: d = residue + h (v + gravity). Extends `bounds`, unless null, by the positions before and after.
  void (*predict)(const AdvanceArguments& arguments, PointBounds* bounds);

  /// Does update, then predict, in one pass over memory, for substeps without a stage between them.
  void (*advance)(const AdvanceArguments& arguments, PointBounds* bounds);

  /// Writes the ascending indices of particles near a solid to `near`, which must have room for all. Returns their
  /// number.
  int (*find_near)(const NearQuery& query, std::int32_t* near);
};

PLIANT_DECLARE_LEVELS(SweepKernels, sweep_kernels)
PLIANT_DECLARE_LEVELS(StepKernels, step_kernels)
const SweepKernels& sweep_kernels_sequential();

/// Like SweepKernels::sweep, with relaxation. If arguments.corrections is set, stores corrections there instead of
/// applying them: that of a batch's `slot` and `lane` at record 16 (size batch + slot) + correction_place(lane) of its
/// pool's array. One constraint after another on every level: no default uses it (Jacobi sweeps, relaxation).
void sweep_general(const Pool* pools, const Segment* first, const Segment* last, const SweepArguments& arguments);

const StepKernels& step_kernels_sequential();

/// All kernels of one instruction set level. A World picks one table when it is made.
struct Kernels : SweepKernels, StepKernels {
  const char* isa;  ///< name of the instruction set level
  const ChainKernels& chains;
  const MultigridKernels& multigrid;
  const ContactKernels& contacts;
  const LengthKernels& lengths;
  const PairKernels& pairs;
  const ManifoldKernels& manifolds;
  const RodKernels& rods;
  const MotionKernels& motions;
  const NeighbourKernels& neighbours;
  const FluidKernels& fluids;
  const ViscosityKernels& viscosity;
  const TensionKernels& tension;
  const AirKernels& air;
};

/// The readable reference in plain floats. Kernels without a scalar version (multigrid, pairs) are those of the
/// narrowest level of the build.
const Kernels& kernels_sequential();

/// Returns the widest kernels that this machine runs, or those that `isa` names: a level of math/levels.h, or
/// "sequential". Throws an Error if the build does not hold them or if this machine cannot run them.
const Kernels& pick_kernels(const std::string& isa);

}  // namespace pliant
