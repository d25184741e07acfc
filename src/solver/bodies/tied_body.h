// Projects all ties of particles to one rigid body together.
//
// One after another, many ties to a body that is lighter than what is tied to it pull it to and fro. A sweep over them
// in one direction is no symmetric operator, so errors from substep to substep do not only decay: they also grow into
// spin, the faster the smaller the substeps are. Together they are a small system in the body's motion (d, theta),
// since each tie has a particle of its own:
//
//   tie i:   (w_i + a_i) l_i = r_i + d + theta x arm_i        r_i: right-hand side of stencil.h, w_i: inverse mass, a_i: compliance / h^2
//   body:    d = -w sum l_i,   theta = -I^-1 sum arm_i x l_i
//
// With l_i eliminated and d = sqrt(w) y, theta = sqrt(I^-1) z this is symmetric and positive definite, with unit matrix
// for a free body.
#pragma once

#include "solver/substep.h"

namespace pliant {

/// Projects the ties of a segment, which hold one body and a particle each.
void project_tied_body(const CompiledObject& object, const Segment& segment, const SweepArguments& points,
                       const FrameArguments& frames);

}  // namespace pliant
