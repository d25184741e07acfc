// The edges and triangles of an object that can come nearer to primitive colliders than their vertices.
#pragma once

#include <array>
#include <vector>

#include "collision/narrow/contact.h"
#include "topology/edges.h"

namespace pliant {

/// The least amount by which the interior of an element must come nearer to a solid than its vertices to get a contact
/// [m]. Up to twice this amount the contact keeps less than the thickness, so that contacts start without a jump.
/// `radius` is that of a circle around the element [m].
inline float least_dip(float radius, float thickness) { return max(0.5f * thickness, 0.03125f * radius); }

/// About thirty neighbouring vertices, the elements whose lowest vertex is one of them, and those elements' other
/// vertices.
struct ElementCluster {
  std::vector<int> vertices;              ///< indices of vertices in the object, ascending
  std::vector<std::array<int, 2>> edges;  ///< edges as indices into `vertices`
  std::vector<Triangle> triangles;
};

/// The clusters of one tile; each vertex of the tile belongs to exactly one.
struct TileElements {
  std::vector<int> neighbours;  ///< indices of other tiles that own vertices of these clusters, ascending
  std::vector<ElementCluster> clusters;
};

/// The edges and triangles of one object, by tile. Empty if vertex contacts suffice.
struct ShapeElements {
  float radius = 0;  ///< largest radius of the smallest circles around initial triangles and edges [m]
  std::vector<TileElements> tiles;
};

ShapeElements make_shape_elements(const CompiledObject& object);

/// True if elements of this radius can come nearer to a collider than their vertices by more than least_dip; elements
/// of fine cloth on a large ball cannot. `thickness` is the sum of both thicknesses [m].
bool may_dip(float radius, const LocalShape& shape, float thickness);

}  // namespace pliant
