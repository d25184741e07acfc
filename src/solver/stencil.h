// The stencil driver projects all constraint types that have no SIMD lanes: types with frame slots, with several rows,
// or registered by users. Constraints are projected one at a time, but ties of one body together
// (bodies/tied_body.h), in colours that all threads share. The code is
// scalar, so every machine gives the same bits.
//
//   A = sum over slots of G W G^T             G: gradients by row, W: inverse mass, or inverse inertia in world axes
//   PBD:   A dlambda = -k' C
//   XPBD:  ((1 + g) A + a) dlambda = -C - a lambda - g G (motion since the substep's start)       a, g as in project.h
//   bounded rows: dlambda is clamped so that low h^2 <= lambda <= high h^2
//   rows that act on motion: (A + a / h) dlambda = h speed - G (motion since the substep's start) - (a / h) lambda
//   point: x += w G^T dlambda      frame: theta = W G^T dlambda,  q += theta q / 2, normalised
#pragma once

#include "solver/substep.h"
#include "solver/visit.h"

namespace pliant {

/// What a constraint yields by in a substep: its compliance over h^2, and its damping.
struct Yielding {
  float compliance = 0;  ///< a of the laws above
  float damping = 0;     ///< g of the laws above
};
Yielding yielding_of(const ConstraintPlace& at, const SweepArguments& a);

/// True if a row of these bounds acts both ways. With Integrator::energy others, as stops, have the force of the end:
/// before they are reached, C is no strain.
inline bool acts_both_ways(float low, float high) { return low < -1e15f && high > 1e15f; }

/// Rotates a frame by a small rotation vector in world axes [rad], and adds it to the frame's corrections.
void rotate_frame(const Vec3f& theta, Record& orientation, Record& corrections);

/// Projects the constraints of one segment.
void project_segment(const CompiledObject& object, const Segment& segment, const SweepArguments& points,
                     const FrameArguments& frames);

}  // namespace pliant
