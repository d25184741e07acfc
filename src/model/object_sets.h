// Sets of objects that can meet. Substeps are those of a set: objects that cannot meet do not change the substeps of one another.
//
// Objects form a set if groups, masks and `collides` let their surfaces touch, directly or through others. Mesh
// colliders count as triangles: their vertices move in the substeps of a set, so they join the sets that they touch.
// Primitive colliders, distance grids and heightfields have a pose at any time, so they join no set.
#pragma once

#include <cstdint>
#include <vector>

#include "pliant/scene.h"

namespace pliant {

/// Substeps per frame of `multigrid`, and of all other sweeps, where the settings leave them open (docs/internals/convergence.md).
inline constexpr int substeps_of_multigrid = 10, substeps_of_others = 20;

/// The largest number of substeps of any object, if chosen_settings(scene) leaves them open because objects differ.
inline int most_substeps_of(const Settings& chosen) { return chosen.substeps > 0 ? chosen.substeps : substeps_of_others; }

/// The substeps that an object needs by itself. PBD stiffness between 0 and 1 is left to the sweeps, and is converted for a
/// fixed number of projections: such an object has the number of the other sweeps, which no set that it joins exceeds.
int own_substeps(const Object& object, Sweep sweep);

/// The data that determine the set of an object or mesh collider.
struct SetMember {
  std::uint32_t groups = 0, mask = 0;
  bool collides = false;     ///< true if it collides with other objects
  bool is_collider = false;  ///< a mesh collider: it touches objects whether they collide or not, and no other collider
  int substeps = 0;          ///< substeps that it needs alone; 0: none
};

SetMember member_of(const Object& object, int substeps);
SetMember member_of(const MeshCollider& collider);

/// The set of each member, named by its first member.
std::vector<int> find_sets(const std::vector<SetMember>& members);

/// The substeps of each member's set: the most that any of its members needs.
std::vector<int> substeps_of_sets(const std::vector<SetMember>& members);

}  // namespace pliant
