// The rows of a particle that stays at a weighted mean of others: C_k = e_k . (sum of weights x), e_k the world's axes,
// where the particle has the weight 1 and the others their own, negative.
#pragma once

#include "pliant/formula.h"

namespace pliant {

template <int count, class S, class R>
PLIANT_HD void evaluate_weighted_place(const SlotValues<S, R>& at, const R (&weights)[count], Rows<S, 3, R>& out) {
  const Vec3<R> axes[3] = {{R(1), R(0), R(0)}, {R(0), R(1), R(0)}, {R(0), R(0), R(1)}};
  Vec3<R> away = at.point[0];
  for (int slot = 1; slot < count; ++slot) away = away + at.point[slot] * weights[slot];
  for (int row = 0; row < 3; ++row) {
    out.c[row] = dot(axes[row], away);
    for (int slot = 0; slot < count; ++slot) out.gradient[row][slot] = axes[row] * weights[slot];
  }
}

}  // namespace pliant
