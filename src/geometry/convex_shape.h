// Convex solids for contact between bodies: a core and a radius around it. What a kind of solid brings is its support,
// which is the core's farthest point in a direction, and its features, which are the flat parts of its surface.
#pragma once

#include <array>

#include "geometry/polyhedron.h"

namespace pliant {

/// A convex solid in its own frame, which is that of scene.h [m].
struct ConvexShape {
  enum class Kind { point, segment, cylinder, cone, polyhedron };
  Kind kind = Kind::point;
  float radius = 0;       ///< thickness around the core: a sphere's, a capsule's; a margin of others
  float core_radius = 0;  ///< of cylinder and cone
  float half_length = 0;  ///< along y: of segment, cylinder and cone, whose apex is above
  const Polyhedron* polyhedron = nullptr;
};

/// The point of the core that is farthest in a direction, which need not be a unit vector. Of equally far points the
/// same one is chosen each time.
Vec3d support(const ConvexShape& shape, const Vec3d& direction);

/// A flat part of a core's surface: a point, a segment, or a polygon, counter-clockwise from outside.
struct Feature {
  static constexpr int most = 32;
  int count = 0;
  std::array<Vec3d, most> points{};
  Vec3d normal{};  ///< of polygons: outward unit normal
};

/// The largest part of the core's surface whose points are all within `slack` [m] of the farthest in a direction (a
/// unit vector). Round faces count as polygons of eight corners.
Feature feature_towards(const ConvexShape& shape, const Vec3d& direction, double slack);

/// A face of a polyhedron; of one with more corners than a feature holds, some are left out.
Feature face_of(const Polyhedron& polyhedron, int face);

}  // namespace pliant
