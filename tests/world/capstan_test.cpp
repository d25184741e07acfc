// Tests friction under tension: a strip over a round bar holds, or slides, as the capstan equation with the strip's own
// weight says. Friction must follow the force with which the strip presses on the bar, which is mostly its tension.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "pliant/world.h"
#include "support/scenes.h"

namespace pliant {
namespace {

using namespace testing_support;

constexpr double standard_gravity = 9.81, strip_friction = 0.3;
constexpr double bar = 0.1, strip_thickness = 0.004, strip_radius = bar + strip_thickness;
constexpr double edge = 0.0125, sliding_seconds = 0.4;
constexpr int across = 5, middle_of_strip = 2;

/// By how much tension at the right end exceeds what hangs there if the strip accelerates by `a` at speed `v` [N m /
/// kg]. T' = mu (T + g r sin t - v^2) + g r cos t + a r around the bar, per mass and length; T starts as the left end's
/// pull.
double excess(double left, double right, double v, double a) {
  constexpr int steps = 200;
  const double h = std::numbers::pi / steps;
  const auto slope = [&](double t, double tension) {
    return strip_friction * (tension + standard_gravity * strip_radius * std::sin(t) - v * v) +
           standard_gravity * strip_radius * std::cos(t) + a * strip_radius;
  };
  double tension = left * (standard_gravity + a);
  for (int i = 0; i < steps; ++i) tension += h * slope((i + 0.5) * h, tension + h / 2 * slope(i * h, tension));
  return tension - right * (standard_gravity - a);
}

/// By how much a strip with these free ends has slid to the right after `sliding_seconds` [m].
double expected_way(double left, double right) {
  constexpr int steps = 400;
  constexpr double step_time = sliding_seconds / steps;
  double way = 0, v = 0;
  for (int i = 0; i < steps; ++i) {
    const double at_rest = excess(left - way, right + way, v, 0),
                 slope = excess(left - way, right + way, v, 1) - at_rest;
    const double a = -at_rest / slope;  // the excess is linear in a
    if (!(a > 0) && !(v > 0)) return 0;
    v += a * step_time;
    way += v * step_time;
  }
  return way;
}

/// A strip of cotton with irregular diagonals whose ends hang down by `left` and `right` from a bar along z.
Scene strip(double left, double right) {
  const double whole = left + std::numbers::pi * strip_radius + right;
  const int rows = static_cast<int>(std::lround(whole / edge));
  TriangleMesh mesh;
  for (int i = 0; i <= rows; ++i) {
    const double s = whole * i / rows, t = (s - left) / strip_radius;
    const Vec3d at = t < 0                  ? Vec3d{-strip_radius, s - left, 0}
                     : t < std::numbers::pi ? Vec3d{-strip_radius * std::cos(t), strip_radius * std::sin(t), 0}
                                            : Vec3d{strip_radius, left + std::numbers::pi * strip_radius - s, 0};
    for (int k = 0; k < across; ++k)
      mesh.positions.push_back({float(at.x), float(at.y), static_cast<float>((k - middle_of_strip) * edge)});
  }
  for (int i = 0; i < rows; ++i) {
    for (int k = 0; k + 1 < across; ++k) {
      const int a = i * across + k, b = a + 1, c = a + across, d = c + 1;
      const bool falls = (i * 7 + k * 3) % 5 < 2;
      mesh.triangles.push_back({a, c, falls ? b : d});
      mesh.triangles.push_back({falls ? b : a, falls ? c : d, falls ? d : b});
    }
  }
  ClothOptions options;
  options.material = fabric("cotton");
  options.stretch = Stiffness::rigid();
  Object object = make_cloth(mesh, options);
  object.thickness = static_cast<float>(strip_thickness);
  object.static_friction = object.kinetic_friction = static_cast<float>(strip_friction);
  Collider collider;
  collider.shape = Capsule{static_cast<float>(bar), 0.3f};
  collider.rotation = {std::sqrt(0.5f), 0, 0, std::sqrt(0.5f)};
  collider.static_friction = collider.kinetic_friction = static_cast<float>(strip_friction);
  Scene scene;
  scene.add(object);
  scene.add(collider);
  scene.settings.threads = 1;
  scene.settings.substeps = 40;
  return scene;
}

double found_way(double left, double right) {
  World world(strip(left, right));
  const std::vector<Vec3f> before = world.object(0).positions();
  const int frames = static_cast<int>(std::lround(sliding_seconds * 60));
  for (int frame = 0; frame < frames; ++frame) EXPECT_TRUE(world.step(1.f / 60).ok());
  return static_cast<double>(world.object(0).positions()[2].y - before[2].y);
}

TEST(Capstan, HoldsAStripThatItsFrictionCarries) {
  for (const auto& [left, right] : {std::pair{0.3, 0.45}, std::pair{0.15, 0.525}}) {
    ASSERT_EQ(expected_way(left, right), 0);
    EXPECT_NEAR(found_way(left, right), 0, 5e-4) << left << ", " << right;
  }
}

TEST(Capstan, LetsAHeavierEndSlide) {
  const double way = expected_way(0.1, 0.6);
  ASSERT_GT(way, 0.1);
  EXPECT_NEAR(found_way(0.1, 0.6), way, 0.08 * way);
}

}  // namespace
}  // namespace pliant
