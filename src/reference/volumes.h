// Bounding volumes for comparison with the engine's boxes: sphere, oriented box, k-DOP.
//
// Gottschalk, Lin and Manocha 1996 (oriented boxes); Klosowski et al. 1998 (k-DOPs).
#pragma once

#include "collision/broad/bounds.h"

namespace pliant {

/// A bounding sphere: cheap to test, but loose around flat objects.
struct SphereBounds {
  Vec3f centre{};
  float radius = 0;

  static SphereBounds of(const Vec3f* points, int count);
  static SphereBounds merged(const SphereBounds* spheres, int count);
  SphereBounds grown(float margin) const;
  float distance_bound(const Vec3f& p) const;
  Vec3f middle() const { return centre; }
};
bool overlap(const SphereBounds& a, const SphereBounds& b);

/// A box aligned with its first triangle: tight around slanted objects, costly to test (fifteen axes) and to merge.
struct OrientedBoxBounds {
  Vec3f centre{};
  Vec3f axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  ///< orthonormal up to rounding, which the extents cover
  Vec3f extents{};                                    ///< half sizes along the axes

  static OrientedBoxBounds of(const Vec3f* points, int count);
  static OrientedBoxBounds merged(const OrientedBoxBounds* boxes, int count);
  OrientedBoxBounds grown(float margin) const;
  float distance_bound(const Vec3f& p) const;
  Vec3f middle() const { return centre; }
};
bool overlap(const OrientedBoxBounds& a, const OrientedBoxBounds& b);

/// A k-DOP: bounds along K / 2 fixed directions: the axes with the diagonals of a cube (K = 14) or of its faces (K =
/// 18).
template <int K>
struct KDopBounds {
  static_assert(K == 14 || K == 18, "the directions are those of a cube");
  static constexpr int slabs = K / 2;
  float low[slabs]{}, high[slabs]{};  ///< bounds along directions that are not normalised

  static KDopBounds of(const Vec3f* points, int count);
  static KDopBounds merged(const KDopBounds* volumes, int count);
  KDopBounds grown(float margin) const;
  float distance_bound(const Vec3f& p) const;
  Vec3f middle() const {
    return {0.5f * low[0] + 0.5f * high[0], 0.5f * low[1] + 0.5f * high[1], 0.5f * low[2] + 0.5f * high[2]};
  }
};

template <int K>
bool overlap(const KDopBounds<K>& a, const KDopBounds<K>& b) {
  bool all = true;
  for (int i = 0; i < KDopBounds<K>::slabs; ++i) all &= (a.low[i] <= b.high[i]) & (b.low[i] <= a.high[i]);
  return all;
}

static_assert(Bounds<SphereBounds> && Bounds<OrientedBoxBounds> && Bounds<KDopBounds<14>> && Bounds<KDopBounds<18>>);

}  // namespace pliant
