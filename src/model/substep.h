// What the parts of a substep hand one another: plain views of particle data.
#pragma once

#include "geometry/shapes.h"
#include "pliant/world.h"

namespace pliant {

/// What a sweep over constraints needs of the substep under way. Pointers are to the object's first particle.
struct SweepArguments {
  Record* positions = nullptr;
  const Record* predicted = nullptr;
  const Record* velocities = nullptr;    ///< those that led to `predicted`
  float* const* multipliers = nullptr;   ///< one array a pool, or null where none are kept
  float h = 0, inverse_h = 0, inverse_h2 = 0;
  bool first_pass = true;  ///< of the substep: multipliers start at zero
};

/// What carrying particles from one substep to the next needs.
struct AdvanceArguments {
  Record* positions = nullptr;
  Record* predicted = nullptr;
  Record* remainders = nullptr;
  Record* velocities = nullptr;
  int first = 0, last = 0;  ///< particles, half open
  float h = 0, inverse_h = 0;
  Vec3f gravity_step{};      ///< h times gravity [m/s]
  float velocity_kept = 1;   ///< share of velocity that damping leaves
};

/// Which particles a solid could touch in the substep that led to their positions.
struct NearQuery {
  const Record* positions = nullptr;
  const Record* velocities = nullptr;
  int first = 0, last = 0;  ///< particles, half open
  float h = 0;
  LocalShape shape;
  Pose<float> pose;  ///< of the solid at the substep's end
  float margin = 0;  ///< a particle is near within this and its own motion [m]
};

/// A box around points, empty until something is added.
struct Bounds {
  Record low{3e38f, 3e38f, 3e38f, 0}, high{-3e38f, -3e38f, -3e38f, 0};
};

}  // namespace pliant
