// Distributes PBD stiffness over the projections of a step.
#pragma once

namespace pliant {

/// k' = 1 - (1 - k)^(1/n): n projections with k' leave the same error of an isolated constraint as one with k (Mueller
/// et al. 2007, section 3.3). k in [0, 1], n >= 1.
double stiffness_per_projection(double k, int projections);

}  // namespace pliant
