// The multigrid correction: one Newton step on the stretching energy of all springs of an object at once, solved by conjugate
// gradients with a multigrid cycle as preconditioner, before plain sweeps over everything.
//
// A sweep carries a pull one edge at a time, so the finer a mesh the more it stretches. Here what is wrong on a large scale is
// put right on coarse levels, whose rows are groups of particles: stretch then hardly depends on the resolution. The energy
// is |x - x~|^2_M / 2 h^2 + sum K C^2 / 2 + contacts; its Hessian keeps the geometric stiffness of taut springs (model/
// multigrid.h, multigrid_lanes.cpp).
#pragma once

#include "model/model.h"
#include "model/multigrid.h"
#include "pliant/scene.h"
#include "solver/sweeps/multigrid_kernels.h"

namespace pliant {

/// Of one object.
struct MultigridObject {
  std::vector<MultigridValues> levels;
  Records direction, image, change;  ///< of conjugate gradients: p, A p, x
  AlignedVector<float> extra;        ///< of contacts: nine rows of sixteen a batch
  std::vector<char> has_extra;       ///< by batch
  std::vector<float> sums;           ///< by task
};

/// Makes room for every object that has levels.
void prepare_multigrid(const Model& model, std::vector<MultigridObject>& objects);

}  // namespace pliant
