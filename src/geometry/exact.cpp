// Exact signs by floating-point expansions. A product of two floats is exact in a double, and one of three is the sum
// of two doubles. A sum of doubles is stored with the rounding error of each addition.
#include "geometry/exact.h"

#include <algorithm>
#include <array>

#include "math/vector.h"

namespace pliant {

namespace {

/// An exact sum of doubles, as parts of ascending magnitude whose bits do not overlap (Shewchuk 1997, grow-expansion).
class ExactSum {
 public:
  void add(double value) {
    int kept = 0;
    for (int i = 0; i < count_; ++i) {
      const double sum = value + parts_[i], virtual_part = sum - value;  // Knuth's two-sum
      const double error = (value - (sum - virtual_part)) + (parts_[i] - virtual_part);
      if (error != 0) parts_[kept++] = error;
      value = sum;
    }
    if (value != 0) parts_[kept++] = value;
    count_ = kept;
  }

  /// Adds the product a b c exactly. The 48 bits of a b are split into two halves of at most 26 bits.
  void add_product(double a, double b, double c) {
    constexpr double splitter = 134217729;  // 2^27 + 1 divides a double into two halves of its bits
    const double ab = a * b, scaled = splitter * ab, high = scaled - (scaled - ab);
    add(high * c);
    add((ab - high) * c);
  }

  int sign() const { return count_ == 0 ? 0 : parts_[count_ - 1] > 0 ? 1 : -1; }

 private:
  double parts_[48];
  int count_ = 0;
};

/// Adds sign (u . (v x w)) exactly.
void add_triple(ExactSum& sum, double sign, const Vec3d& u, const Vec3d& v, const Vec3d& w) {
  sum.add_product(sign * u.x, v.y, w.z);
  sum.add_product(-sign * u.x, v.z, w.y);
  sum.add_product(sign * u.y, v.z, w.x);
  sum.add_product(-sign * u.y, v.x, w.z);
  sum.add_product(sign * u.z, v.x, w.y);
  sum.add_product(-sign * u.z, v.y, w.x);
}

int exact_volume_sign(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  ExactSum sum;
  add_triple(sum, 1, b, c, d);
  add_triple(sum, -1, a, c, d);
  add_triple(sum, 1, a, b, d);
  add_triple(sum, -1, a, b, c);
  return sum.sign();
}

/// True if four points have a coordinate in common, as in flat cloth along an axis: exact sums of many zeros are slow.
bool in_plane_across_axis(const Vec3d (&p)[4]) {
  bool x = true, y = true, z = true;
  for (const Vec3d& q : p) {
    x = x && q.x == p[0].x;
    y = y && q.y == p[0].y;
    z = z && q.z == p[0].z;
  }
  return x || y || z;
}

/// A point projected onto a coordinate plane.
struct Point2 {
  double x, y;
};

Point2 project(const Vec3f& p, int axis) {
  if (axis == 0) return {p.y, p.z};
  return axis == 1 ? Point2{p.z, p.x} : Point2{p.x, p.y};
}

/// The exact sign of the area of a, b, c: positive if counter-clockwise.
int area_sign(const Point2& a, const Point2& b, const Point2& c) {
  const double left = (b.x - a.x) * (c.y - a.y), right = (b.y - a.y) * (c.x - a.x), area = left - right,
               bound = 4e-16 * (abs(left) + abs(right));  // (3 + 16 e) e of the magnitudes, e = 2^-53 (Shewchuk 1997)
  if (area > bound || -area > bound) return area > 0 ? 1 : -1;
  ExactSum sum;
  for (const double product : {b.x * c.y, -b.x * a.y, -a.x * c.y, -b.y * c.x, b.y * a.x, a.y * c.x}) sum.add(product);
  return sum.sign();
}

bool intervals_meet(float a, float b, float c, float d) {
  return std::min(a, b) <= std::max(c, d) && std::min(c, d) <= std::max(a, b);
}

bool boxes_meet(const Vec3f (&p)[2], const Vec3f (&q)[2]) {
  return intervals_meet(p[0].x, p[1].x, q[0].x, q[1].x) && intervals_meet(p[0].y, p[1].y, q[0].y, q[1].y) &&
         intervals_meet(p[0].z, p[1].z, q[0].z, q[1].z);
}

/// True if two closed segments in one plane meet: tested in a projection with area; for collinear segments by their
/// boxes.
bool segments_meet(const Vec3f (&p)[2], const Vec3f (&q)[2]) {
  if (!boxes_meet(p, q)) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const Point2 a = project(p[0], axis), b = project(p[1], axis), c = project(q[0], axis), d = project(q[1], axis);
    const int abc = area_sign(a, b, c), abd = area_sign(a, b, d), cda = area_sign(c, d, a), cdb = area_sign(c, d, b);
    if (abc == 0 && abd == 0 && cda == 0 && cdb == 0) continue;
    return abc * abd <= 0 && cda * cdb <= 0;
  }
  return true;
}

bool inside_in_plane(const Vec3f& p, const Vec3f (&t)[3]) {
  for (int axis = 0; axis < 3; ++axis) {
    const Point2 a = project(t[0], axis), b = project(t[1], axis), c = project(t[2], axis), x = project(p, axis);
    const int turn = area_sign(a, b, c);
    if (turn == 0) continue;
    return area_sign(a, b, x) * turn >= 0 && area_sign(b, c, x) * turn >= 0 && area_sign(c, a, x) * turn >= 0;
  }
  return false;  // a triangle without area has no interior; its edges are tested separately
}

bool coplanar(const Vec3f (&p)[2], const Vec3f (&q)[2]) { return volume_sign(p[0], p[1], q[0], q[1]) == 0; }

/// How an edge meets a triangle in whose plane it lies, or a degenerate triangle.
EdgeTriangle meet_in_plane(const Vec3f (&edge)[2], const Vec3f (&t)[3]) {
  if (inside_in_plane(edge[0], t)) return EdgeTriangle::touching;
  for (int k = 0; k < 3; ++k) {
    const Vec3f side[2] = {t[k], t[(k + 1) % 3]};
    if (coplanar(edge, side) && segments_meet(edge, side)) return EdgeTriangle::touching;
  }
  return EdgeTriangle::apart;
}

}  // namespace

int volume_sign(const Vec3f& a, const Vec3f& b, const Vec3f& c, const Vec3f& d) {
  const Vec3d p[4] = {convert<double>(a), convert<double>(b), convert<double>(c), convert<double>(d)};
  const Vec3d u = p[1] - p[0], v = p[2] - p[0], w = p[3] - p[0], m = cross(u, v);
  const Vec3d sizes{abs(u.y * v.z) + abs(u.z * v.y), abs(u.z * v.x) + abs(u.x * v.z), abs(u.x * v.y) + abs(u.y * v.x)};
  const double volume = dot(m, w),
               bound = 1e-15 * dot(sizes, abs(w));  // (7 + 56 e) e of the sum of magnitudes, e = 2^-53
  if (volume > bound || -volume > bound) return volume > 0 ? 1 : -1;
  if (in_plane_across_axis(p)) return 0;
  return exact_volume_sign(p[0], p[1], p[2], p[3]);
}

EdgeTriangle how_edge_meets_triangle(const Vec3f (&edge)[2], const Vec3f (&t)[3]) {
  const int first = volume_sign(t[0], t[1], t[2], edge[0]), second = volume_sign(t[0], t[1], t[2], edge[1]);
  if (first * second > 0) return EdgeTriangle::apart;
  if (first == 0 && second == 0) return meet_in_plane(edge, t);
  const std::array<int, 3> turns{volume_sign(edge[0], edge[1], t[0], t[1]), volume_sign(edge[0], edge[1], t[1], t[2]),
                                 volume_sign(edge[0], edge[1], t[2], t[0])};
  const auto [least, most] = std::minmax_element(turns.begin(), turns.end());
  if (*least < 0 && *most > 0) return EdgeTriangle::apart;
  const bool proper = first * second < 0 && (*least > 0 || *most < 0);
  return proper ? EdgeTriangle::crossing : EdgeTriangle::touching;
}

}  // namespace pliant
