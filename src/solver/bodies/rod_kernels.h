// The solution of up to sixteen rods of equal shape side by side, one table for each instruction set level as in
// solver/kernels.h. All tables give the bits of JointForest, which solves one after another.
#pragma once

#include <cstdint>

#include "constraints/rod_joint.h"
#include "math/levels.h"
#include "model/substep.h"

namespace pliant {

inline constexpr int most_rods = 16;                 ///< rods that are solved side by side
inline constexpr int rod_rows = RodJointRows::rows;  ///< of a joint
inline constexpr int rod_fields = static_cast<int>(RodJointRows::fields.size());
inline constexpr int rod_block = (2 * rod_rows + 1) * rod_rows;  ///< numbers of a block and of its right-hand side

/// Sixteen numbers, one for each rod. Lanes without a rod repeat those of the last rod.
using RodLanes = float[most_rods];
using RodIndices = std::int32_t[most_rods];

/// A joint of all rods. Joints are in the order of their blocks, so children come before their parents.
struct RodNode {
  std::int32_t parent = -1;     ///< joint; -1: a root
  std::int32_t ends[2] = {};    ///< bodies a and b; -1: the ground
  std::int32_t through = -1;    ///< the end that is shared with the parent, 0 or 1
  std::int32_t of_parent = -1;  ///< which end of the parent that is
  std::int32_t pool = 0;        ///< of the object
  bool is_damped = false;       ///< of Law::damped
};

/// What is kept of a joint.
struct alignas(64) RodJoint {
  RodIndices slots[4];  ///< point and frame of a, then of b; frames count from the object's first one
  RodIndices places;    ///< 16 batch + lane in its pool
  /// The force on bodies a and b, times h^2 [kg m], of the last substep or of this one's passes so far.
  RodLanes pull[2][3];
};

struct alignas(64) RodBody {
  RodIndices point, frame;
};

/// Scratch data of a joint.
struct alignas(64) RodJointScratch {
  RodLanes rest[rod_fields + 2];      ///< rest data, compliance, damping
  RodLanes before[rod_rows];          ///< multipliers before this pass
  RodLanes gradient[rod_rows][4][3];  ///< [row][slot]
  RodLanes value[rod_rows], compliance[rod_rows];
  RodLanes change[rod_rows];  ///< multipliers of the tree, of the opposite sign
  RodLanes pull[2][3];        ///< of this pass
};

/// Scratch data of a body: mass [kg], inertia in world axes and its inverse, geometric stiffness times h^2, sum of |f|
/// h^2 |r| of its joints [kg m^2], and by how much it is displaced and turned.
struct alignas(64) RodBodyScratch {
  RodLanes mass, inertia[6], inverse[6], stiffness[6], size, move[6];
};

/// Rods of one object, and scratch memory.
struct RodBundleView {
  int rods = 0, joints = 0, bodies = 0;
  const RodNode* nodes = nullptr;
  RodJoint* kept = nullptr;
  const RodBody* places = nullptr;
  RodJointScratch* of_joints = nullptr;
  RodBodyScratch* of_bodies = nullptr;
  void* blocks = nullptr;  ///< room for rod_block numbers a joint and 6 a body, each eight doubles, on a cache line
  SweepArguments points{};
  FrameArguments frames{};
};

/// A bit for each lane; lanes without a rod have that of the last rod.
using RodBits = std::uint32_t;

struct RodKernels {
  /// Sets masses and inertias by the present orientations.
  void (*fill_masses)(const RodBundleView& rods);
  /// Sets rows: C at present, gradients of the substep's start for the rods in `at_start`, else of the present.
  void (*fill_rows)(const RodBundleView& rods, RodBits at_start);
  /// Solves, and keeps what the rods in `which` get: multipliers, moves, pulls of this pass.
  void (*solve)(const RodBundleView& rods, RodBits which);
  /// Sets the geometric stiffness by the kept pulls, those of this pass, or their sum. Returns the rods of which a body
  /// has more than `most` times its inertia, no other lanes.
  RodBits (*find_stiffness)(const RodBundleView& rods, bool kept, bool of_pass, float most);
  /// Moves the bodies of the rods in `which`.
  void (*apply)(const RodBundleView& rods, RodBits which);
  /// Returns the rods of which a joint is open, as is_open says of a forest.
  RodBits (*find_open)(const RodBundleView& rods, float share);
};

PLIANT_DECLARE_LEVELS(RodKernels, rod_kernels)
const RodKernels& rod_kernels_sequential();

}  // namespace pliant
