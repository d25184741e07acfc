// Which edges and triangles of an object meet primitive colliders by more than their vertices.
#pragma once

#include <array>
#include <vector>

#include "collision/narrow/contact.h"
#include "topology/edges.h"

namespace pliant {

/// What an edge or a triangle may come nearer to a solid between its vertices than at the closest of them before it has a contact of its
/// own; up to twice that, the contact keeps less than the thickness, so that none begins at a jump. `radius` is that of a circle around
/// the element [m].
inline float least_dip(float radius, float thickness) { return max(0.5f * thickness, 0.03125f * radius); }

/// Some thirty vertices that lie together, the elements whose lowest vertex is one of them, and the other vertices of these.
struct ElementCluster {
  std::vector<int> vertices;              ///< in the object's numbering, ascending
  std::vector<std::array<int, 2>> edges;  ///< places in `vertices`
  std::vector<Triangle> triangles;
};

/// The clusters of a tile: those of its own vertices.
struct TileElements {
  std::vector<int> neighbours;  ///< other tiles that clusters have vertices of, ascending
  std::vector<ElementCluster> clusters;
};

/// Edges and triangles of one object, tile by tile. Nothing where vertices alone are met.
struct ShapeElements {
  float radius = 0;  ///< the largest of the least circles around a triangle or an edge as it was made [m]
  std::vector<TileElements> tiles;
};

ShapeElements make_shape_elements(const CompiledObject& object);

/// Whether elements of this radius can come nearer to a collider than their vertices by more than least_dip: those of fine cloth on a large
/// ball cannot. `thickness` is the sum of both [m].
bool may_dip(float radius, const LocalShape& shape, float thickness);

}  // namespace pliant
