// The k-DOP: bounds along k / 2 fixed directions, a generalised axis-aligned box.
#include "reference/volumes.h"

namespace pliant {

namespace {

struct Direction {
  double x, y, z, length;
};

constexpr double root2 = 1.4142135623730951, root3 = 1.7320508075688772;
constexpr Direction cube_diagonals[7] = {{1, 0, 0, 1},      {0, 1, 0, 1},      {0, 0, 1, 1},     {1, 1, 1, root3},
                                         {1, 1, -1, root3}, {1, -1, 1, root3}, {-1, 1, 1, root3}};
constexpr Direction face_diagonals[9] = {{1, 0, 0, 1},      {0, 1, 0, 1},      {0, 0, 1, 1},
                                         {1, 1, 0, root2},  {1, 0, 1, root2},  {0, 1, 1, root2},
                                         {1, -1, 0, root2}, {1, 0, -1, root2}, {0, 1, -1, root2}};

template <int K>
const Direction& direction(int i) {
  if constexpr (K == 14) return cube_diagonals[i];
  return face_diagonals[i];
}

double along(const Direction& d, const Vec3f& p) {
  return d.x * static_cast<double>(p.x) + d.y * static_cast<double>(p.y) + d.z * static_cast<double>(p.z);
}

}  // namespace

template <int K>
KDopBounds<K> KDopBounds<K>::of(const Vec3f* points, int count) {
  KDopBounds bounds;
  for (int i = 0; i < slabs; ++i) {
    double least = along(direction<K>(i), points[0]), most = least;
    for (int k = 1; k < count; ++k) {
      const double s = along(direction<K>(i), points[k]);
      least = min(least, s);
      most = max(most, s);
    }
    // Along the coordinate axes the bounds are coordinates, which are floats already.
    bounds.low[i] = i < 3 ? static_cast<float>(least) : detail::float_below(least);
    bounds.high[i] = i < 3 ? static_cast<float>(most) : detail::float_above(most);
  }
  return bounds;
}

template <int K>
KDopBounds<K> KDopBounds<K>::merged(const KDopBounds* volumes, int count) {
  KDopBounds all = volumes[0];
  for (int k = 1; k < count; ++k)
    for (int i = 0; i < slabs; ++i) {
      all.low[i] = min(all.low[i], volumes[k].low[i]);
      all.high[i] = max(all.high[i], volumes[k].high[i]);
    }
  return all;
}

template <int K>
KDopBounds<K> KDopBounds<K>::grown(float margin) const {
  KDopBounds bounds;
  for (int i = 0; i < slabs; ++i) {
    const double step = static_cast<double>(margin) * direction<K>(i).length;
    bounds.low[i] = detail::float_below(static_cast<double>(low[i]) - step);
    bounds.high[i] = detail::float_above(static_cast<double>(high[i]) + step);
  }
  return bounds;
}

template <int K>
float KDopBounds<K>::distance_bound(const Vec3f& p) const {
  double farthest = 0;
  for (int i = 0; i < slabs; ++i) {
    const double s = along(direction<K>(i), p);
    const double outside = max(static_cast<double>(low[i]) - s, s - static_cast<double>(high[i]));
    farthest = max(farthest, outside / direction<K>(i).length);
  }
  return detail::float_below(farthest);
}

template struct KDopBounds<14>;
template struct KDopBounds<18>;

}  // namespace pliant
