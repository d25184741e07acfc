// Views of particle data, as plain pointers, that the stages of a substep pass to one another.
//
// Within a substep a particle is at position + displacement. The position stays that of the substep's start;
// prediction, constraints and contacts change the displacement. Displacements are small, so they have full float
// precision at any distance from the origin and for any substep length. At the substep's end, what the new position
// cannot represent is the rounding residue (`remainders`), with which the next displacement starts (compensated
// summation). Otherwise many small substeps would round corrections away.
#pragma once

#include "geometry/shapes.h"
#include "pliant/state.h"

namespace pliant {

/// The data of one object that a sweep needs. Pointers are to the object's first particle.
struct SweepArguments {
  const Record* positions = nullptr;    ///< positions at the substep's start; w is the inverse mass
  Record* displacements = nullptr;      ///< displacements since the substep's start; w is zero
  const Record* remainders = nullptr;   ///< rounding residues, with which displacements started
  float* const* multipliers = nullptr;  ///< multipliers of each pool; null if none are stored
  /// For each pool, by lane: 1 if the stencil driver leaves a constraint out; null: none.
  const char* const* skipped = nullptr;
  const Record* velocities = nullptr;  ///< at the substep's start, without `gravity`
  Vec3f gravity{};                     ///< this frame's gravity that the velocities of finite masses lack [m/s]
  float h = 0, inverse_h = 0, inverse_h2 = 0;
  bool keeps_energy = false;  ///< Settings::Integrator::energy
  bool first_pass = true;     ///< true in the first pass of a substep, in which multipliers start at zero
  float lead = 0;  ///< share of its own inverse mass that lowers a compliance, where is_led (solver/project.h)

  // For sweep_general only:
  float relaxation = 1;                  ///< factor omega of every multiplier change
  Record* const* corrections = nullptr;  ///< one array per pool, size x 16 records per batch: replaces displacements
  /// For each pool: the share of a change that is added to the multiplier; null: the whole change.
  const float* const* shares = nullptr;
};

/// The displacement of a particle in a substep at the velocity of its start [m].
PLIANT_HD Vec3f coast_of(const SweepArguments& a, std::int32_t particle) {
  const Record& v = a.velocities[particle];
  const Vec3f gravity = a.positions[particle].w > 0 ? a.gravity : Vec3f{0, 0, 0};
  return {(v.x + gravity.x) * a.h, (v.y + gravity.y) * a.h, (v.z + gravity.z) * a.h};
}

/// The data of one object's frames in the current substep. Pointers are to its first frame.
struct FrameArguments {
  Record* orientations = nullptr;
  const Record* inverse_inertias = nullptr;
  const Record* starts = nullptr;     ///< orientations at the substep's start
  const Record* predicted = nullptr;  ///< rotation vectors of the prediction in world axes [rad]
  Record* corrections = nullptr;      ///< rotation vectors: sums of constraint corrections since the prediction [rad]
};

/// The data that prediction and update of a range of particles need.
///
/// Velocities exclude the gravity of the current frame: adding h g in every substep would round it many times. It is
/// added where needed, and permanently at the frame's end.
struct AdvanceArguments {
  Record* positions = nullptr;
  Record* displacements = nullptr;
  Record* remainders = nullptr;
  Record* velocities = nullptr;
  int first = 0, last = 0;  ///< range of particles, half-open
  float h = 0, inverse_h = 0;
  float velocity_kept = 1;   ///< factor by which damping reduces the velocity in a substep
  Vec3f gravity_step{};      ///< h times gravity [m/s]
  Vec3f gravity_finished{};  ///< this frame's gravity that velocities lack in the substep that ends [m/s]
  Vec3f gravity_begun{};     ///< this frame's gravity that velocities lack in the substep that starts [m/s]
  Vec3f gravity_settled{};   ///< gravity that the update adds permanently to velocities [m/s]
};

/// A query for the particles that a solid could touch in the current substep.
struct NearQuery {
  const Record* positions = nullptr;
  const Record* displacements = nullptr;
  int first = 0, last = 0;  ///< range of particles, half-open
  LocalShape shape;
  Pose<float> pose;  ///< pose of the solid at the substep's end
  float margin = 0;  ///< a particle is near if its distance is within this plus its displacement [m]
};

/// A bounding box of points, initially empty.
struct PointBounds {
  Record low{3e38f, 3e38f, 3e38f, 0}, high{-3e38f, -3e38f, -3e38f, 0};
};

}  // namespace pliant
