// All constraints at once from the same positions.
//
// A particle with n constraints can't take all n corrections whole: they would overshoot. Split: each constraint sees an
// n-th of the particle's mass, n times its w, and the particle follows the mean of its parts: corrections keep obeying Newton's
// third law, so momentum is kept (Tonge et al. 2012). Average: each sees the whole mass and the corrections are averaged, which
// loses momentum wherever neighbours have different n (Macklin et al. 2014, section 4.2).
#pragma once

#include <vector>

#include "model/model.h"
#include "solver/sweeps/incidence.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

/// The Jacobi sweep of one object.
struct JacobiObject {
  Incidence incidence;
  Records corrections;                       ///< of every constraint's particles, pool after pool
  std::vector<Record*> correction_pointers;  ///< one a pool
  std::vector<AlignedVector<float>> shares;  ///< one a lane: see Incidence::shares; where corrections are averaged
  std::vector<const float*> share_pointers;
  Records positions;  ///< with w times the particle's constraints; where masses are split
};

struct JacobiScratch : SweepScratch {
  std::vector<JacobiObject> objects;  ///< by object; empty where it is not of the group

  void prepare(const SweepSetup& setup, int object) override;
};

}  // namespace pliant
