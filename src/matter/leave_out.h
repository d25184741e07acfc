// Which places lie in what is solid in a scene.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "collision/broad/bounds.h"
#include "pliant/liquid.h"

namespace pliant {

/// Whether mesh colliders and closed surfaces are asked, which takes time to prepare, or primitive colliders and bodies
/// alone.
enum class MeshesToo { yes, no };

/// Something solid, where it is at the start.
struct PlacedSolid {
  const std::string* name = nullptr;  ///< of the object or collider
  std::optional<BoxBounds> box;       ///< around all that it holds; none: a half-space or terrain
  std::function<bool(const Vec3f&)> overlaps;
};

/// Appends the solids of a body of an object, `reach` thicker [m].
void add_solids_of_body(const Object& object, const ObjectBody& body, float reach, std::vector<PlacedSolid>& solids);

/// What leave_out_solids would leave out of the places.
std::vector<PlacesInSolid> find_in_solids(const std::vector<Vec3f>& places, const Scene& scene,
                                          const LeaveOutOptions& options, MeshesToo meshes);

}  // namespace pliant
