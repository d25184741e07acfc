// The substeps of woven cloth: how many one pass over its triangles needs for their stretch and shear.
#pragma once

#include "pliant/scene.h"

namespace pliant {

/// True if triangles resist shear or stretch, which chains, tethers and multigrid do not solve.
bool is_woven(const Object& object);

/// True if triangles resist stretch: no edge of theirs lies along a yarn.
bool has_oblique_yarns(const Object& object);

/// The substeps of a frame [s] with which one pass holds the triangles of woven cloth within a tenth of their
/// stiffness, or within 0.2 % of strain under its own weight; no upper bound. 0 if the object is not woven.
double needed_substeps_of_woven(const Object& object, double frame_time);

/// How far the triangles of woven cloth yield, of those constraints that need the most substeps.
struct WovenYield {
  double ratio = 1;   ///< over what their stiffness says [-]; 1: as it says, or within 0.2 % of strain
  double strain = 0;  ///< too much, under the object's weight [-]
};
WovenYield yield_of_woven(const Object& object, double frame_time, double substeps);

}  // namespace pliant
