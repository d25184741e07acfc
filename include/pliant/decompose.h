// Concave rigid bodies: a closed mesh is divided into convex pieces, which are the solids of a body.
#pragma once

#include <vector>

#include "pliant/body.h"
#include "pliant/mesh.h"

namespace pliant {

/// Options of decompose.
struct DecomposeOptions {
  /// By how much pieces may fill hollows of the mesh, >= 0 [m]; 0: 2 % of the mesh's longest side.
  float tolerance = 0;
  int most_pieces = 32;   ///< 1 to 1024; where more would be needed, hollows are filled further
  int most_corners = 64;  ///< of each piece, 8 to 1024
  float density = 1000;   ///< > 0 [kg/m^3]
};

/// A mesh as convex pieces.
struct Decomposition {
  std::vector<Solid> solids;  ///< hulls, whose mass together is that of the mesh
  BodyInertia inertia;        ///< of what the mesh encloses, for BodyOptions::inertia
  float filled = 0;           ///< how deep the pieces fill hollows of the mesh, at most, up to a cell of the grid [m]
};

/// Divides what a closed mesh encloses by planes along the axes, until no piece's convex hull fills a hollow by more
/// than the tolerance. Hollows are measured on a grid of distances of 56 cells along the mesh's longest side, so finer
/// ones are filled. It takes about a second. Throws an Error if the mesh is not closed, encloses no volume, or an
/// option is out of range.
Decomposition decompose(const TriangleMesh& mesh, const DecomposeOptions& options = {});

}  // namespace pliant
