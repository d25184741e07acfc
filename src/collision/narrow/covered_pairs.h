// Covered pairs: another pair of the same two surfaces has the same closest points, or closer ones.
//
// Where the closest point lies on a triangle's border, the neighbouring triangle may be closer. Where it is the end of
// an edge, the pair of that vertex and a triangle is as close. The normal of a covered pair is oblique to both
// surfaces. A contact made of it before the surfaces touch pushes them sideways.
//
// Of a mesh collider nothing but the closest features count, touched or not: the direction of a contact with an edge or
// a vertex lies within the normals of the triangles around it. On a flat mesh any other direction is a ramp.
#pragma once

#include <array>

#include "collision/narrow/pair_contact.h"
#include "collision/proxies/triangles_around.h"
#include "model/substep.h"
#include "parallel/executor.h"

namespace pliant {

class CoveredPairs {
 public:
  CoveredPairs(const ContactElements& elements, const TrianglesAround& around) : elements_(elements), around_(around) {}

  /// True if another pair of the same two surfaces has closer or equal closest points, so that pair `lane` needs no
  /// contact.
  bool covers(const PairStencil& pair, const PairBatch& at, int lane, const Record* positions) const;
  /// True if the mesh on side `side` (0 or 1) of pair `lane` comes closer to the other side beside its closest point.
  /// Triangles do not count that are exempt with a vertex of the other side.
  bool is_closer_on_mesh(const PairStencil& pair, int side, const PairBatch& at, int lane, const Record* positions,
                         const FunctionRef<bool(const PairStencil&)>& is_exempt) const;

 private:
  /// The closest points of a pair, as weights of its four particles, and the unit vector between them.
  struct Closest {
    float weight[4];
    Vec3f normal;
  };
  bool covers(const PairStencil& pair, const Closest& at, const Record* positions) const;
  bool is_closer_beside(const PairStencil& pair, const Closest& at, const Record* positions) const;
  /// The feature of one side that has the closest point: a corner, an edge, or all of a triangle.
  struct Feature {
    std::array<int, 3> holds{};
    int held = 0;
    Vec3f point{};  ///< the closest point, relative to the pair's first vertex [m]
  };
  static Feature feature_of(const PairStencil& pair, const Closest& at, int first, int last, const Record* positions);
  /// True if a triangle at an edge or corner that `counts` rises from the closest point along `towards`.
  template <class Counts>
  bool rises_beside(const Feature& feature, const Vec3f& towards, int origin, const Record* positions,
                    Counts counts) const;
  bool is_closer_on_mesh(const PairStencil& pair, int side, const Closest& at, const Record* positions,
                         const FunctionRef<bool(const PairStencil&)>& is_exempt) const;
  bool has_triangle_without(int a, int b, int vertex) const;

  const ContactElements& elements_;
  const TrianglesAround& around_;
};

}  // namespace pliant
