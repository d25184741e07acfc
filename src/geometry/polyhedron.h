// Convex polyhedra as flat arrays, and the polyhedra of boxes and hulls.
#pragma once

#include <vector>

#include "geometry/convex_hull.h"
#include "math/quat.h"

namespace pliant {

/// An edge of a convex polyhedron and its two faces. `left` is the face that has the edge from a to b in its direction.
struct PolyhedronEdge {
  int a = 0, b = 0;
  int left = 0, right = 0;
};

/// A convex polyhedron in its own frame [m].
struct Polyhedron {
  std::vector<Vec3f> corners;
  std::vector<Vec3f> normals;         ///< outward unit normal of each face
  std::vector<int> first_of_face;     ///< those of face f are face_corners[first_of_face[f]] to [first_of_face[f + 1]]
  std::vector<int> face_corners;      ///< counter-clockwise from outside
  std::vector<PolyhedronEdge> edges;  ///< each once, in the order of faces
  Vec3f centre{};                     ///< mean of the corners, which is inside

  int faces() const { return static_cast<int>(normals.size()); }
  int corners_of(int face) const { return first_of_face[face + 1] - first_of_face[face]; }
};

Polyhedron polyhedron_of(const ConvexHull& hull);
/// A box about the origin; half extents are positive.
Polyhedron polyhedron_of_box(const Vec3f& half_extents);
/// Sets `out` to the same solid in the frame in which its own frame has this pose. What `out` has room for is not
/// allocated.
void move(const Polyhedron& polyhedron, const Posef& pose, Polyhedron& out);
Polyhedron moved(const Polyhedron& polyhedron, const Posef& pose);

}  // namespace pliant
