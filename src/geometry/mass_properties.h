// Mass, centre of mass and inertia of solids. Moments of volume are added over the parts of a body, in any frames, and
// converted to principal axes at the end. Host only; in double precision with no function of libm but sqrt, so all
// machines agree.
#pragma once

#include <array>
#include <vector>

#include "math/quat.h"

namespace pliant {

/// Integrals over a solid of density rho in some frame.
struct Moments {
  double mass = 0;                 ///< integral of rho [kg]
  Vec3d first{};                   ///< integral of rho x [kg m]
  std::array<double, 6> second{};  ///< integral of rho x x^T: xx, yy, zz, yz, zx, xy [kg m^2]

  Moments& operator+=(const Moments& other);
};

/// Those of a solid in the frame in which its own frame has this pose.
Moments moved(const Moments& moments, const Posed& pose);
/// Those of a solid with `factor` times the density.
Moments times(const Moments& moments, double factor);

// Solids of density 1 in their own frames, which are those of scene.h. Sizes are not negative [m].
Moments moments_of_sphere(double radius);
Moments moments_of_box(const Vec3d& half_extents);
Moments moments_of_capsule(double radius, double half_length);   ///< along y; half_length excludes the caps
Moments moments_of_cylinder(double radius, double half_length);  ///< along y, about its middle
Moments moments_of_cone(double radius, double half_length);      ///< base at y = -half_length, apex at +half_length
/// The solid that a closed mesh encloses, its triangles facing outward (Mirtich 1996 has the integrals; here they are
/// summed over the tetrahedra of triangles and the mesh's first vertex). A mesh that faces inward has negative mass.
Moments moments_of_mesh(const std::vector<Vec3d>& vertices, const std::vector<std::array<int, 3>>& triangles);

/// A rigid body's inertia in principal axes.
struct MassProperties {
  double mass = 0;  ///< [kg]
  Vec3d centre{};   ///< centre of mass in the frame of the moments [m]
  Quatd axes{};     ///< from principal axes to that frame; the identity if these are principal already
  Vec3d inertia{};  ///< moments of inertia about the principal axes through the centre [kg m^2]
};

/// Diagonalises the inertia by Jacobi's rotations. Zero mass gives zeros.
MassProperties mass_properties(const Moments& moments);

}  // namespace pliant
