// Contacts of triangles with solids that pass them within a substep.
//
// Contacts of edges and triangles are found where a solid ends. A solid that moves by more than its size ends beyond a
// coarse cloth without ever overlapping it. So the path of its centre is tested against the triangles that move
// meanwhile. A contact at the first hit keeps the whole solid on the side from which it came.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "collision/narrow/contact.h"
#include "parallel/executor.h"
#include "solver/bodies/surface_tiles.h"

namespace pliant {

struct Substep;

class SweptContacts {
 public:
  /// Adds a contact for each triangle that a solid's centre hits first; `meets(contact)` tells which may touch. Of
  /// solids that have one, the contacts of edges and triangles among `contacts` are removed, because they may be those
  /// of the far side.
  void detect(const Substep& s, const SurfaceTiles& surfaces, const std::vector<MovingCollider>& solids,
              FunctionRef<bool(const Contact&)> meets, std::vector<Contact>& contacts);

  /// True if the last detect found a solid that may pass triangles in a substep.
  bool has_fast() const { return has_fast_; }

 private:
  struct Hit {
    int object = 0;
    std::array<int, 3> triangle{};  ///< vertices in the State
    float time = 0;
    Vec3f weights{};  ///< barycentric, at the hit
    Vec3f normal{};   ///< from the solid to the triangle
  };
  /// Of one solid.
  struct Found {
    std::vector<std::int32_t> points;
    std::vector<Hit> hits;
    std::vector<Contact> contacts;
    bool is_fast = false;
  };

  static Contact contact_of(const Substep& s, const Hit& hit, const MovingCollider& solid, int number);
  static void find_hits(const Substep& s, const SurfaceTile& tile, const MovingCollider& solid, Found& found);
  void detect_solid(const Substep& s, const SurfaceTiles& surfaces, const MovingCollider& solid, int number,
                    const FunctionRef<bool(const Contact&)>& meets);

  bool has_fast_ = false;
  std::vector<Found> found_;  ///< [solid]
};

}  // namespace pliant
