#include "model/stiffness.h"

#include "math/functions.h"

namespace pliant {

double stiffness_per_projection(double k, int projections) {
  if (k >= 1) return 1;
  if (k <= 0) return 0;
  return -expm1(log1p(-k) / projections);  // keeps precision for small k and many projections
}

}  // namespace pliant
