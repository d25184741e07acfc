// Plain views of particle data that the stages of a substep exchange.
//
// Within a substep a particle is at position + displacement. The position stays that of the substep's
// start; prediction, constraints and contacts change the displacement. As a small number, it has full
// float precision at any distance from the origin and for any substep length. The part of their sum that
// the new position cannot hold is the rounding residue (`remainders`), with which the next displacement
// starts (compensated summation). Otherwise many small substeps would round their own corrections away.
#pragma once

#include "geometry/shapes.h"
#include "pliant/state.h"

namespace pliant {

/// The data that a sweep needs of the current substep. Pointers are to the object's first particle.
struct SweepArguments {
  const Record* positions = nullptr;    ///< positions at the substep's start, w is the inverse mass
  Record* displacements = nullptr;      ///< displacements since the substep's start, w is zero
  const Record* remainders = nullptr;   ///< the initial displacements of the substep
  float* const* multipliers = nullptr;  ///< one array per pool, or null if none are stored
  float h = 0, inverse_h = 0, inverse_h2 = 0;
  bool first_pass = true;  ///< true in the first pass of a substep, in which multipliers start at zero

  // For sweep_general only:
  float relaxation = 1;                  ///< omega, factor of every multiplier change
  Record* const* corrections = nullptr;  ///< one array per pool, size x 16 records per batch: replaces displacements
  const float* const* shares =
      nullptr;  ///< one array per pool: the share of a change that reaches the multiplier; null: the whole change
};

/// The frames of one object in the current substep. Pointers are to its first frame.
struct FrameArguments {
  Record* orientations = nullptr;
  const Record* inverse_inertias = nullptr;
  const Record* predicted = nullptr;  ///< rotation vectors of the prediction, in world axes [rad]
  Record* corrections = nullptr;      ///< rotation vectors: sums of the constraints' corrections since the prediction [rad]
};

/// The data needed to advance particles from one substep to the next.
///
/// Velocities exclude the gravity of the current frame: adding h g in every substep would round it a thousand times. It is
/// added where needed, and permanently at the frame's end.
struct AdvanceArguments {
  Record* positions = nullptr;
  Record* displacements = nullptr;
  Record* remainders = nullptr;
  Record* velocities = nullptr;
  int first = 0, last = 0;  ///< particles, half-open
  float h = 0, inverse_h = 0;
  float velocity_kept = 1;   ///< factor of the velocity after damping in a substep
  Vec3f gravity_step{};      ///< h times gravity [m/s]
  Vec3f gravity_finished{};  ///< this frame's gravity in the velocity of the ending substep [m/s]
  Vec3f gravity_begun{};     ///< the same for the starting substep
  Vec3f gravity_settled{};   ///< gravity that update adds permanently to velocities [m/s]
};

/// A query for particles that a solid could touch in the current substep.
struct NearQuery {
  const Record* positions = nullptr;
  const Record* displacements = nullptr;
  int first = 0, last = 0;  ///< particles, half-open
  LocalShape shape;
  Pose<float> pose;  ///< of the solid at the substep's end
  float margin = 0;  ///< a particle is near within this plus its own displacement [m]
};

/// A bounding box of points, initially empty.
struct PointBounds {
  Record low{3e38f, 3e38f, 3e38f, 0}, high{-3e38f, -3e38f, -3e38f, 0};
};

}  // namespace pliant
