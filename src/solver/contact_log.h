// Sums contact impulses between bodies over a frame, for contact events.
#pragma once

#include <map>
#include <utility>

#include "math/vector.h"

namespace pliant {

/// A body in contacts: an object or mesh collider by its number in the model, a primitive collider as -1 - its index.
inline constexpr int body_of_collider(int collider) { return -1 - collider; }

/// The contacts between two bodies in a frame.
struct ContactSum {
  int contacts = 0, in_substep = 0;  ///< active contacts: maximum over substeps, and of the current one
  double impulse = 0;                ///< sum of the magnitudes of normal impulses [N s]
  Vec3d push{};                      ///< sum of normal impulses on the first body [N s]
  Vec3d moment{};                    ///< sum of impulse x position [N s m]
};

/// Sums by pair of bodies, the lower one first.
using ContactLog = std::map<std::pair<int, int>, ContactSum>;

struct Substep;

/// Adds a substep's active contacts in a fixed order: of tiles, of edges and triangles with colliders, among surfaces.
void log_contacts(const Substep& s, ContactLog& log);

}  // namespace pliant
