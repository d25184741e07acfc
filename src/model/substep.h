// What the parts of a substep hand one another: plain views of particle data.
//
// Within a substep a particle is at position + displacement. The position is where the substep began and stays; prediction,
// constraints and contacts change the displacement, a small number that a float holds to a part in ten million however far
// from the origin the particle is and however short the substep. What the new position can't hold of their sum is the
// remainder, with which the next displacement begins. Without this, a thousand substeps a frame would round away their own
// corrections.
#pragma once

#include "geometry/shapes.h"
#include "pliant/state.h"

namespace pliant {

/// What a sweep over constraints needs of the substep under way. Pointers are to the object's first particle.
struct SweepArguments {
  const Record* positions = nullptr;    ///< at the substep's start, w the inverse mass
  Record* displacements = nullptr;      ///< since then, w zero
  const Record* remainders = nullptr;   ///< the displacement with which the substep began
  float* const* multipliers = nullptr;  ///< one array a pool, or null where none are kept
  float h = 0, inverse_h = 0, inverse_h2 = 0;
  bool first_pass = true;  ///< of the substep: multipliers start at zero

  // For sweep_general alone:
  float relaxation = 1;                  ///< omega, on every change of a multiplier
  Record* const* corrections = nullptr;  ///< one array a pool, size x 16 records a batch: written instead of displacements
  const float* const* shares =
      nullptr;  ///< one array a pool: what part of a change reaches the multiplier; null: all of it
};

/// Frames of one object in the substep under way. Pointers are to its first frame.
struct FrameArguments {
  Record* orientations = nullptr;
  const Record* inverse_inertias = nullptr;
  const Record* predicted = nullptr;  ///< rotation vectors of the prediction, world axes [rad]
  Record* corrections = nullptr;      ///< and of what constraints have added since [rad]
};

/// What carrying particles from one substep to the next needs.
///
/// Velocities do not hold the gravity of the frame under way: adding h g in every substep would round it a thousand times.
/// It is added to them where it is needed, and for good at the frame's end.
struct AdvanceArguments {
  Record* positions = nullptr;
  Record* displacements = nullptr;
  Record* remainders = nullptr;
  Record* velocities = nullptr;
  int first = 0, last = 0;  ///< particles, half open
  float h = 0, inverse_h = 0;
  float velocity_kept = 1;   ///< share of velocity that damping leaves after a substep
  Vec3f gravity_step{};      ///< h times gravity [m/s]
  Vec3f gravity_finished{};  ///< this frame's gravity in the velocity of the substep that ends [m/s]
  Vec3f gravity_begun{};     ///< and of the one that begins
  Vec3f gravity_settled{};   ///< added to velocities for good by update
};

/// Which particles a solid could touch in the substep under way.
struct NearQuery {
  const Record* positions = nullptr;
  const Record* displacements = nullptr;
  int first = 0, last = 0;  ///< particles, half open
  LocalShape shape;
  Pose<float> pose;  ///< of the solid at the substep's end
  float margin = 0;  ///< a particle is near within this and its own motion [m]
};

/// A box around points, empty until something is added.
struct PointBounds {
  Record low{3e38f, 3e38f, 3e38f, 0}, high{-3e38f, -3e38f, -3e38f, 0};
};

}  // namespace pliant
