// Shape matching: the particles of a cluster are pulled to a rest shape that has been moved, turned and perhaps
// deformed to fit them.
//
//   c = sum w x          A = sum w (x - c) q^T          R = the rotation nearest to A
//   rigid                g = c + R q
//   linear, quadratic    g = c + (share F + (1 - share) (R 0)) q,  F q = V u + W p,  V = the closest matrix of the rest volume to sum w (x - c) u^T
//
// with w the shares of mass, and q the rest place, for `quadratic` with its products (Mueller, Heidelberger, Teschner,
// Gross 2005). u are the coordinates of q, and p what products do not share with them, made orthonormal: sum w u u^T =
// 1. W = sum w (x - c) p^T. So c + V u + W p is the closest of all shapes of its kind, and likewise c + R q, and the
// pull x - g is the gradient of
//
//   (1 - share) / 2 sum w |x - c - R q|^2 + share / 2 sum w |x - c - V u - W p|^2,
//
// which has curvatures of at most 1. Mueller's F / cbrt(det F) instead of V has no potential and makes energy.
// Corrections are g - x, or a share of it by compliance, with C = x - g at each particle and masses cancelled. Linear
// momentum stays, as their sum vanishes; so does their torque about the predicted places, as the energy does not change
// in a rotation. Goals are turned a little more, so that the torque about the places at the substep's start vanishes
// instead: angular momentum stays.
#pragma once

#include "model/compiled_clusters.h"
#include "model/substep.h"

namespace pliant {

/// Projects one cluster once. `multipliers` are of all members of the object's clusters, null if none is stored.
void project_cluster(const CompiledClusters& clusters, int cluster, const SweepArguments& a, Vec3<float>* multipliers);

/// Lets the rest shape of a plastic cluster flow by its strain at the end of a substep of `h` seconds. Strains are von
/// Mises' equivalent ones at constant volume, as those of tetrahedra (constraints/tetrahedron_shear.h).
void let_cluster_flow(CompiledClusters& clusters, PlasticCluster& plastic, const SweepArguments& a, double h);

}  // namespace pliant
