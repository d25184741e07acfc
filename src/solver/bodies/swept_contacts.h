// Contacts of triangles with solids that pass them within a substep.
//
// Contacts of edges and triangles are found where a solid ends. A solid that moves by more than its size ends beyond a coarse
// cloth without ever overlapping it. So the path of its centre is tested against the triangles that move meanwhile. A contact at
// the first hit keeps the whole solid on the side from which it came.
#pragma once

#include <vector>

#include "collision/broad/bounds.h"
#include "collision/narrow/contact.h"
#include "model/model.h"
#include "parallel/executor.h"

namespace pliant {

struct Substep;

class SweptContacts {
 public:
  /// Adds a contact for each triangle that a solid's centre hits first; `meets(object, solid)` tells which may touch. Of solids
  /// that have one, the contacts of edges and triangles among `contacts` are removed, because they may be those of the far side.
  void detect(const Substep& s, const std::vector<int>& objects, const std::vector<MovingCollider>& solids,
              FunctionRef<bool(int object, int solid)> meets, std::vector<Contact>& contacts);

  /// True if the last detect found a solid that may pass triangles in a substep.
  bool has_fast() const { return has_fast_; }

 private:
  struct Hit {
    int object = 0, triangle = 0;
    float time = 0;
    Vec3f weights{};  ///< barycentric, at the hit
    Vec3f normal{};   ///< from the solid to the triangle
  };

  static Contact contact_of(const Substep& s, const Hit& hit, const MovingCollider& solid, int number);
  void find_hits(const Substep& s, int object, const MovingCollider& solid);

  bool has_fast_ = false;
  std::vector<Hit> hits_;         ///< of one solid
  std::vector<char> is_swept_;    ///< [solid]
  std::vector<BoxBounds> boxes_;  ///< [object] of its particles on their way
  std::vector<float> fastest_;    ///< [object] largest displacement [m]
};

}  // namespace pliant
