// The Jacobi sweep: all constraints are projected from the same positions.
//
// If a particle applied the sum of the corrections of its n constraints, it would overshoot. There are two remedies.
// Split: each constraint acts on an n-th of the particle's mass (n times its w), and the particle moves by the mean.
// Corrections obey Newton's third law, so momentum is conserved (Tonge et al. 2012). Average: each acts on the whole
// mass and corrections are averaged, which loses momentum where neighbours differ in n (Macklin et al. 2014, section
// 4.2).
#pragma once

#include <vector>

#include "model/model.h"
#include "solver/sweeps/incidence.h"
#include "solver/sweeps/sweep.h"

namespace pliant {

/// The data of one object in a Jacobi sweep.
struct JacobiObject {
  Incidence incidence;
  Records corrections;                       ///< corrections of all slots of all constraints, in the order of pools
  std::vector<Record*> correction_pointers;  ///< start of each pool's corrections
  std::vector<AlignedVector<float>> shares;  ///< averaging_shares of each pool; empty if masses are split
  std::vector<const float*> share_pointers;
  Records positions;  ///< positions with w multiplied by the number of constraints; empty if corrections are averaged
};

struct JacobiScratch : SweepScratch {
  std::vector<JacobiObject> objects;  ///< data of each object; empty for objects of other groups

  void prepare(const SweepSetup& setup, int object) override;
};

}  // namespace pliant
