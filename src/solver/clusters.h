// Shape matching: the particles of a cluster are pulled to a rest shape that has been moved, turned and perhaps deformed to fit them.
//
//   c = sum w x          A = sum w (x - c) q^T          R = the rotation nearest to A
//   rigid                g = c + R q
//   linear, quadratic    g = c + (share F + (1 - share) (R 0)) q,  F = sum w (x - c) q^T (sum w q q^T)^-1, over cbrt(det F) for its volume
//
// with w the shares of mass, and q the rest place, for `quadratic` with its products (Mueller, Heidelberger, Teschner, Gross 2005).
// Corrections are g - x, or a share of it by compliance, with C = x - g at each particle and masses cancelled. Linear momentum
// stays, as their sum vanishes; so does their torque about the predicted places, as R^T A and F A^T are symmetric. Goals are turned a little
// more, so that the torque about the places at the substep's start vanishes instead: angular momentum stays.
#pragma once

#include "model/compiled_clusters.h"
#include "model/substep.h"

namespace pliant {

/// Projects one cluster once. `multipliers` are of all members of the object's clusters, null if none is stored.
void project_cluster(const CompiledClusters& clusters, int cluster, const SweepArguments& a, Vec3<float>* multipliers);

/// Lets the rest shape of a plastic cluster flow by its strain at the end of a substep of `h` seconds. Strains are von Mises' equivalent ones
/// at constant volume, as those of tetrahedra (constraints/tetrahedron_shear.h).
void let_cluster_flow(CompiledClusters& clusters, PlasticCluster& plastic, const SweepArguments& a, double h);

}  // namespace pliant
