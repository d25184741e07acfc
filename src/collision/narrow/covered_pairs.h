// Covered pairs: another pair of the same two surfaces has the same closest points, or closer ones.
//
// Where the closest point lies on a triangle's border, the neighbouring triangle may be closer. Where it is the end of an
// edge, the pair of that vertex and a triangle is as close. The normal of a covered pair is oblique to both surfaces. A
// contact made of it before the surfaces touch pushes them sideways.
#pragma once

#include "collision/narrow/pair_contact.h"
#include "collision/proxies/triangles_around.h"
#include "model/substep.h"

namespace pliant {

class CoveredPairs {
 public:
  CoveredPairs(const ContactElements& elements, const TrianglesAround& around) : elements_(elements), around_(around) {}

  /// True if another pair of the same two surfaces has closer or equal closest points, so that pair `lane` needs no contact.
  bool covers(const PairStencil& pair, const PairBatch& at, int lane, const Record* positions) const;

 private:
  /// The closest points of a pair, as weights of its four particles, and the unit vector between them.
  struct Closest {
    float weight[4];
    Vec3f normal;
  };
  bool covers(const PairStencil& pair, const Closest& at, const Record* positions) const;
  bool is_closer_beside(const PairStencil& pair, const Closest& at, const Record* positions) const;
  bool has_triangle_without(int a, int b, int vertex) const;

  const ContactElements& elements_;
  const TrianglesAround& around_;
};

}  // namespace pliant
