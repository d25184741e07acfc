// Compares exact signs with integer arithmetic. Coordinates are small integers, so that points often coincide or lie on
// one line or plane; then they are scaled by powers of two, which changes no sign.
#include "geometry/exact.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace pliant {
namespace {

__extension__ using Integer = __int128;
using IntegerPoint = std::array<Integer, 3>;

int sign(Integer x) { return x > 0 ? 1 : x < 0 ? -1 : 0; }
IntegerPoint minus(const IntegerPoint& a, const IntegerPoint& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Integer dot(const IntegerPoint& a, const IntegerPoint& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
IntegerPoint cross(const IntegerPoint& a, const IntegerPoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Integer volume(const IntegerPoint& a, const IntegerPoint& b, const IntegerPoint& c, const IntegerPoint& d) {
  return dot(cross(minus(b, a), minus(c, a)), minus(d, a));
}
Vec3f as_floats(const IntegerPoint& p, float scale = 1) {
  return {static_cast<float>(p[0]) * scale, static_cast<float>(p[1]) * scale, static_cast<float>(p[2]) * scale};
}

bool fits(const IntegerPoint& p) {
  for (const Integer x : p)
    if (x > (1 << 24) || x < -(1 << 24)) return false;
  return true;
}

IntegerPoint random_integer_point(std::mt19937_64& random, int range) {
  std::uniform_int_distribution<int> uniform(-range, range);
  const int x = uniform(random), y = uniform(random), z = uniform(random);
  return {x, y, z};
}

/// True if 0 is in the convex hull: in that of one to four of the points that are affinely independent (Caratheodory).
bool holds_origin(const std::vector<IntegerPoint>& p) {
  const IntegerPoint o{0, 0, 0};
  const auto n = p.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (p[i] == o) return true;
    for (std::size_t j = i + 1; j < n; ++j) {
      const IntegerPoint ij = cross(p[i], p[j]);
      if (ij == o && dot(p[i], p[j]) < 0) return true;
      for (std::size_t k = j + 1; k < n; ++k) {
        const IntegerPoint normal = cross(minus(p[j], p[i]), minus(p[k], p[i]));
        if (normal != o && dot(normal, p[i]) == 0 && dot(ij, normal) >= 0 && dot(cross(p[j], p[k]), normal) >= 0 &&
            dot(cross(p[k], p[i]), normal) >= 0)
          return true;
        for (std::size_t l = k + 1; l < n; ++l) {
          const int whole = sign(volume(p[i], p[j], p[k], p[l]));
          if (whole != 0 && sign(volume(o, p[j], p[k], p[l])) * whole >= 0 &&
              sign(volume(p[i], o, p[k], p[l])) * whole >= 0 && sign(volume(p[i], p[j], o, p[l])) * whole >= 0 &&
              sign(volume(p[i], p[j], p[k], o)) * whole >= 0)
            return true;
        }
      }
    }
  }
  return false;
}

EdgeTriangle expected(const std::array<IntegerPoint, 2>& e, const std::array<IntegerPoint, 3>& t) {
  std::vector<IntegerPoint> differences;
  for (const IntegerPoint& end : e)
    for (const IntegerPoint& corner : t) differences.push_back(minus(end, corner));
  if (!holds_origin(differences)) return EdgeTriangle::apart;
  const int sides = sign(volume(t[0], t[1], t[2], e[0])) * sign(volume(t[0], t[1], t[2], e[1]));
  const int a = sign(volume(e[0], e[1], t[0], t[1])), b = sign(volume(e[0], e[1], t[1], t[2])),
            c = sign(volume(e[0], e[1], t[2], t[0]));
  return sides < 0 && a * b > 0 && b * c > 0 ? EdgeTriangle::crossing : EdgeTriangle::touching;
}

TEST(VolumeSign, IsThatOfIntegers) {
  std::mt19937_64 random(11);
  int flat = 0;
  for (int i = 0; i < 40000; ++i) {
    const int range = i % 4 == 0 ? 2 : i % 4 == 1 ? 5 : i % 4 == 2 ? 4000 : 16000000;
    const IntegerPoint a = random_integer_point(random, range), b = random_integer_point(random, range),
                       c = random_integer_point(random, range);
    IntegerPoint d = random_integer_point(random, range);
    if (i % 3 == 0) d = {b[0] + c[0] - a[0], b[1] + c[1] - a[1], b[2] + c[2] - a[2]};  // in the plane
    if (i % 9 == 0) ++d[i % 2];                                                        // or just beside it
    const float scale = std::ldexp(1.f, i % 5 == 0 ? -120 : i % 5 == 1 ? 90 : 0);
    const Vec3f p[4] = {as_floats(a, scale), as_floats(b, scale), as_floats(c, scale), as_floats(d, scale)};
    if (!fits(d)) continue;
    const int exact = sign(volume(a, b, c, d));
    flat += exact == 0;
    ASSERT_EQ(volume_sign(p[0], p[1], p[2], p[3]), exact) << i;
    ASSERT_EQ(volume_sign(p[1], p[0], p[2], p[3]), -exact) << i;
    ASSERT_EQ(volume_sign(p[2], p[3], p[0], p[1]), exact) << i;
  }
  EXPECT_GT(flat, 4000);
}

TEST(VolumeSign, TellsNeighbouringFloatsApart) {
  // A plane through points whose coordinates use all bits, and a fourth point one unit in the last place off it.
  const Vec3f a{0.1f, 0.1f, 0.1f}, b{1e6f + 0.1f, 1e6f + 0.1f, 1e-3f}, c{-3.3f, -3.3f, 7e7f}, d{77.7f, 77.7f, 77.7f};
  EXPECT_EQ(volume_sign(a, b, c, d), 0);  // all in x = y
  const float infinity = std::numeric_limits<float>::infinity();
  const Vec3f above{std::nextafter(d.x, infinity), d.y, d.z}, below{std::nextafter(d.x, -infinity), d.y, d.z};
  EXPECT_EQ(volume_sign(a, b, c, above) * volume_sign(a, b, c, below), -1);
  const float tiny = std::numeric_limits<float>::denorm_min();
  EXPECT_EQ(volume_sign({0, 0, 0}, {tiny, 0, 0}, {0, tiny, 0}, {0, 0, tiny}), 1);
  const float huge = std::numeric_limits<float>::max();
  EXPECT_EQ(volume_sign({-huge, -huge, -huge}, {huge, 0, 0}, {0, huge, 0}, {0, 0, huge}), 1);
}

TEST(EdgeMeetsTriangle, AsIntegersSay) {
  std::mt19937_64 random(12);
  std::array<int, 3> seen{};
  for (int i = 0; i < 60000; ++i) {
    const int range = i % 3 + 1;
    std::array<IntegerPoint, 2> e{random_integer_point(random, range), random_integer_point(random, range)};
    std::array<IntegerPoint, 3> t{random_integer_point(random, range), random_integer_point(random, range),
                                  random_integer_point(random, range)};
    if (i % 4 == 0) {  // all in one plane, often on one line
      for (IntegerPoint& p : e) p[i % 3] = 1;
      for (IntegerPoint& p : t) p[i % 3] = 1;
    }
    const EdgeTriangle exact = expected(e, t);
    ++seen[static_cast<std::size_t>(exact)];
    const float scale = i % 2 == 0 ? 1 : std::ldexp(1.f, i % 200 - 100);
    const Vec3f edge[2] = {as_floats(e[0], scale), as_floats(e[1], scale)};
    const Vec3f triangle[3] = {as_floats(t[0], scale), as_floats(t[1], scale), as_floats(t[2], scale)};
    ASSERT_EQ(how_edge_meets_triangle(edge, triangle), exact) << i;
  }
  for (const int count : seen) EXPECT_GT(count, 1000);
}

TEST(EdgeMeetsTriangle, KnowsCrossingTouchingAndMissing) {
  const Vec3f a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
  EXPECT_TRUE(edge_crosses_triangle({0.2f, 0.2f, -1}, {0.2f, 0.2f, 1}, a, b, c));
  EXPECT_FALSE(edge_crosses_triangle({0.2f, 0.2f, 0.1f}, {0.2f, 0.2f, 1}, a, b, c));
  EXPECT_FALSE(edge_crosses_triangle({0.9f, 0.9f, -1}, {0.9f, 0.9f, 1}, a, b, c));
  EXPECT_EQ(how_edge_meets_triangle({{0.5f, 0.5f, -1}, {0.5f, 0.5f, 1}}, {a, b, c}), EdgeTriangle::touching);
  EXPECT_EQ(how_edge_meets_triangle({{0.2f, 0.2f, 0}, {0.2f, 0.2f, 1}}, {a, b, c}), EdgeTriangle::touching);
  EXPECT_EQ(how_edge_meets_triangle({{0.2f, 0.2f, 0}, {0.3f, 0.2f, 0}}, {a, b, c}), EdgeTriangle::touching);
  EXPECT_EQ(how_edge_meets_triangle({{2, 2, 0}, {3, 2, 0}}, {a, b, c}), EdgeTriangle::apart);
}

}  // namespace
}  // namespace pliant
