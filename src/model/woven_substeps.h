// The substeps of woven cloth: how many one pass over its triangles needs for their stretch and shear.
#pragma once

#include "pliant/scene.h"

namespace pliant {

/// True if triangles resist shear or stretch, which chains, tethers and multigrid do not solve.
bool is_woven(const Object& object);

/// The substeps of a frame [s] with which one pass holds the triangles of woven cloth within 3 % of their stiffness; no
/// upper bound. Stiff ones, which strain by less than 0.05 % under the object's weight, may strain by 0.05 % more. 0 if
/// the object is not woven. `is_led`: false where a substep has several passes or another method (solver/project.h),
/// which leave 10 %.
double needed_substeps_of_woven(const Object& object, double frame_time, bool is_led = true);

/// The same, rounded up, at most 160.
int substeps_of_woven(const Object& object, double frame_time);

/// How far the triangles of woven cloth yield, of those constraints that need the most substeps.
struct WovenYield {
  double ratio = 1;   ///< over what their stiffness says [-]; 1: as it says, or of stiff ones within 0.05 % of strain
  double strain = 0;  ///< too much, under the object's weight [-]
  bool is_of_yarns = false;  ///< true: of yarns that no edge lies along; false: of shear
};

/// How often the constraints of an object are projected in a frame [s].
struct Passes {
  double substeps = 20;
  int iterations = 1;
  bool is_led = true;  ///< each is projected once in a substep, in Gauss-Seidel's way
};
WovenYield yield_of_woven(const Object& object, double frame_time, const Passes& passes);

}  // namespace pliant
