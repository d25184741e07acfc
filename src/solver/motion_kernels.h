// How frames turn, and how the motions of bodies are gathered for their contacts and scattered after them, for sixteen
// at a time, one table for each instruction set level as in solver/kernels.h. All tables give the same bits.
#pragma once

#include <cstdint>

#include "math/levels.h"
#include "math/vector.h"
#include "pliant/state.h"
#include "solver/bodies/manifold_passes.h"

namespace pliant {

/// The arrays of all frames (FrameRecords, and those of a substep).
struct FrameArrays {
  Record *orientations, *angular_velocities;
  const Record* inverse_inertias;
  Record *starts, *predicted, *corrections;  ///< w of corrections: what damping leaves of the velocity
  const Record* round;                       ///< 1 for each axis about which the frame's body is round, else 0
};

/// The arrays of bodies. Those with one entry for each body begin with its body 0.
struct BodyArrays {
  BodyMotion* motions = nullptr;
  const std::int32_t *particles = nullptr, *frames = nullptr;            ///< of each body: indices in the State
  const Record *start_positions = nullptr, *start_remainders = nullptr;  ///< of each body, at the frame's start [m]
  const Record* start_orientations = nullptr;                            ///< of each body, at the frame's start
  Record *pushed = nullptr,
         *pushed_spin = nullptr;  ///< of each body: what contacts did to its velocities in the last substep; spin
                                  ///< in its axes at the frame's start
  const Record *positions = nullptr, *remainders = nullptr;
  Record *displacements = nullptr, *velocities = nullptr;
  FrameArrays of_frames{};
};

struct MotionKernels {
  /// Starts a substep of h seconds: orientations follow angular velocities, which follow the gyroscopic torque.
  void (*predict_frames)(const FrameArrays& arrays, int first, int last, float h);
  /// Ends a substep of h seconds: angular velocities change by `share` of the corrections over h. Returns true if all
  /// are finite.
  bool (*update_frames)(const FrameArrays& arrays, int first, int last, float h, float share);

  /// Gathers the masses and inertia of bodies [first, last).
  void (*load_inertia)(const BodyArrays& arrays, int first, int last);
  /// Gathers their predicted motions, and keeps them in BodyMotion. If `is_first` in the substep, they start with what
  /// contacts did in the last one, times `share`.
  void (*load_predicted)(const BodyArrays& arrays, int first, int last, float h, bool is_first, float share);
  /// Adds to the predicted motion of bodies what contacts changed since load_predicted.
  void (*store_predicted)(const BodyArrays& arrays, int first, int last, float h);
  /// Gathers the velocities of bodies, plus `gravity` [m/s] of those that are not fixed, and how far they have moved in
  /// the frame.
  void (*load_velocities)(const BodyArrays& arrays, int first, int last, const Vec3f& gravity);
  /// Adds to the velocities of bodies what contacts changed since load_velocities.
  void (*store_velocities)(const BodyArrays& arrays, int first, int last);
};

PLIANT_DECLARE_LEVELS(MotionKernels, motion_kernels)
const MotionKernels& motion_kernels_sequential();

}  // namespace pliant
