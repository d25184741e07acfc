// Changes of an object of a World: cutting, removing triangles, and changes of your own. World::edit makes them.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pliant/scene.h"

namespace pliant {

/// A change of an object: its new description, and where its particles come from. remove_triangles and cut make one. To
/// change masses, stiffness, pins and the like, change `object` yourself.
struct Edit {
  Object object;
  /// For each particle of `object`: the old particle whose position and velocity it takes, or -1 for a new one, which
  /// starts at its position in `object`. Several particles may have the same origin.
  std::vector<int> from;
  // The frame of a body follows the body's particle. Other frames are matched by index. Those that exist before and
  // after keep orientation and angular velocity.
};

/// An Edit that changes nothing, as a start for changes of your own.
Edit unchanged(const Object& object);

/// Removes triangles, and the constraints that only they supported: pairs of particles that no triangle contains any
/// more, and larger stencils with a missing triangle. Particles keep their indices. Throws an Error if a triangle does
/// not exist, or the object is a soft body.
Edit remove_triangles(const Object& object, std::span<const int> triangles);

/// Cuts a surface along a path of particles, each joined to the next by a triangle's edge. A particle is split where
/// the cut separates its triangles: inside the path, and at an end on the border. Copies follow all other particles;
/// masses are divided by triangle area, so mass and momentum are conserved. Constraints across the cut are removed. An
/// edge on the cut stays on both sides, its stiffness divided by area. Throws an Error if two neighbours of the path
/// share no edge, or the object is a soft body.
Edit cut(const Object& object, std::span<const int> path);

/// Removes tetrahedra of a soft body (tetrahedra_of), with their share of mass; the hole has a surface. Particles that
/// no tetrahedron uses any more are left over, apart from all others. Throws an Error if a tetrahedron does not exist,
/// or the object has none.
Edit remove_tetrahedra(const Object& object, std::span<const int> tetrahedra);

/// Parts a soft body along faces of its tetrahedra: those of different `part` come apart, one number for each of
/// tetrahedra_of. A particle is split into one for each fan of tetrahedra of one part around it; copies follow all
/// other particles. Masses are divided by volume, so mass and momentum are conserved. Throws an Error if the sizes
/// differ, or the object has no tetrahedra.
Edit part_tetrahedra(const Object& object, std::span<const int> part);

/// Parts a surface along edges of its triangles: those of different `part` come apart, one number for each of
/// Object::triangles. Otherwise as `cut`. Throws an Error if the sizes differ, or the object is a soft body.
Edit part_triangles(const Object& object, std::span<const int> part);

/// True if a World changes the description of an object itself: it tears or is cut, or constraints of it can break.
/// ObjectView::description() is the present one.
bool comes_apart(const Object& object);

/// The Edit by which an object tears at these positions of its particles, as Object::tearing says; nothing if it holds.
/// World::step calls it. Of edges and tetrahedra that are too long the longest come first; what lies around a tear
/// holds until the next call, because the tear relieves it. Of a chain of links without triangles, as a rope, one is
/// removed. Held particles stay whole. Throws an Error if sizes differ.
std::optional<Edit> tear(const Object& object, std::span<const Vec3f> positions);

/// The Edit that makes what is due of Object::cuts at a time [s]; nothing if all of that is made. World::step calls it.
std::optional<Edit> make_cuts(const Object& object, double time);

}  // namespace pliant
