// Jacobi: all constraints are projected from the same positions.
//
// A particle with n constraints cannot apply the sum of n corrections, which would overshoot. Split: each constraint acts
// on an n-th of the particle's mass (n times its w), and the particle follows the mean. Corrections obey Newton's third
// law, so momentum is conserved (Tonge et al. 2012). Average: each acts on the whole mass and corrections are averaged,
// which loses momentum where neighbours differ in n (Macklin et al. 2014, section 4.2).
#pragma once

#include <vector>

#include "model/model.h"
#include "solver/sweeps/incidence.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

/// The Jacobi sweep of one object.
struct JacobiObject {
  Incidence incidence;
  Records corrections;                       ///< corrections of all slots of all constraints, by pool
  std::vector<Record*> correction_pointers;  ///< one per pool
  std::vector<AlignedVector<float>> shares;  ///< one per lane, from averaging_shares; empty if masses are split
  std::vector<const float*> share_pointers;
  Records positions;  ///< positions with w times the number of constraints; empty if corrections are averaged
};

struct JacobiScratch : SweepScratch {
  std::vector<JacobiObject> objects;  ///< by object; empty for objects of other groups

  void prepare(const SweepSetup& setup, int object) override;
};

}  // namespace pliant
