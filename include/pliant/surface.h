// The surface of a liquid as a triangle mesh, from the positions of its particles.
#pragma once

#include <span>

#include "pliant/mesh.h"

namespace pliant {

/// Options of liquid_surface.
struct SurfaceOptions {
  float spacing = 0;        ///< distance of neighbouring particles at rest, > 0 [m]; must be given
  float cell = 0;           ///< side of a grid cell, an eighth of the spacing to the spacing [m]; 0: half the spacing
  bool anisotropic = true;  ///< true: kernels follow edges and thin sheets of liquid; false: they are balls
  int smoothing = 2;        ///< passes over the mesh that remove bumps shorter than a few cells, 0 to 100
  int threads = 0;          ///< number of threads; 0: all hardware threads. It changes no bit.
};

/// The surface of the liquid that these particles represent, one spacing^3 of volume each.
///
/// The mesh is closed and two-manifold: each edge has two triangles, and the triangles at a vertex form one fan.
/// Triangles are counter-clockwise seen from outside. Without particles it is empty. Time and memory grow with the
/// number of particles, not with the space between them; a particle far from the others becomes a small ball. Throws an
/// Error if an option is out of range, or a position is not finite or farther from the origin than a million spacings.
TriangleMesh liquid_surface(std::span<const Vec3f> positions, const SurfaceOptions& options);

}  // namespace pliant
