// Surface tension: drops become round, oscillate as Rayleigh says, merge, and keep their momentum.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "fluids/fluid_support.h"
#include "pliant/error.h"
#include "pliant/liquid.h"
#include "pliant/world.h"
#include "support/same_bits.h"

namespace pliant {
namespace {

using std::numbers::pi;
using testing_support::in_double;
using testing_support::weightless;

constexpr float density = 1000;

struct Liquid {
  float spacing = 0.005f, tension = 0.0728f;

  /// The time of capillary waves of the spacing [s].
  float time() const { return std::sqrt(density * spacing * spacing * spacing / tension); }
  Object of(const std::vector<Vec3f>& places) const {
    return make_liquid(places, {.fluid = {.spacing = spacing, .density = density, .surface_tension = tension}});
  }
};

std::vector<Vec3f> ball(float radius, float spacing, const Vec3f& centre = {}) {
  std::vector<Vec3f> inside;
  for (const Vec3f& p : fill_box({-radius, -radius, -radius}, {radius, radius, radius}, spacing))
    if (length_squared(p) < radius * radius) inside.push_back(p + centre);
  return inside;
}

struct Sums {
  Vec3d centre{}, momentum{}, angular{};
  double kinetic = 0;
  Vec3d squares{};  ///< mean squared distances from the centre
};

Sums sums_of(const World& world) {
  Sums sums;
  const std::vector<Vec3f> x = world.object(0).positions(), v = world.object(0).velocities();
  const double share = 1 / static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    sums.centre += in_double(x[i]) * share;
    sums.momentum += in_double(v[i]) * share;
    sums.angular += cross(in_double(x[i]), in_double(v[i])) * share;
    sums.kinetic += length_squared(in_double(v[i])) * share / 2;
  }
  for (const Vec3f& p : x) {
    const Vec3d d = in_double(p) - sums.centre;
    sums.squares += Vec3d{d.x * d.x, d.y * d.y, d.z * d.z} * share;
  }
  return sums;
}

/// The least and the largest extent of a drop in many directions, over their mean.
std::pair<double, double> roundness(const World& world) {
  const std::vector<Vec3f> x = world.object(0).positions();
  const Vec3d centre = sums_of(world).centre;
  double least = 1e9, most = 0, sum = 0;
  constexpr int directions = 200;
  for (int k = 0; k < directions; ++k) {
    const double z = 1 - 2 * (k + 0.5) / directions, turn = 2.399963 * k, r = std::sqrt(1 - z * z);
    double extent = 0;
    for (const Vec3f& p : x)
      extent = std::max(extent, dot(in_double(p) - centre, Vec3d{r * std::cos(turn), r * std::sin(turn), z}));
    least = std::min(least, extent);
    most = std::max(most, extent);
    sum += extent / directions;
  }
  return {least / sum, most / sum};
}

/// Rayleigh: omega^2 = 8 sigma / (rho R^3).
double period(const Liquid& of, std::size_t particles) {
  const double s = static_cast<double>(of.spacing), volume = static_cast<double>(particles) * s * s * s;
  const double omega2 = 8 * static_cast<double>(of.tension) / (static_cast<double>(density) * volume * 3 / (4 * pi));
  return 2 * pi / std::sqrt(omega2);
}

TEST(Tension, MakesASphereOfACube) {
  const Liquid liquid;
  const float side = 10 * liquid.spacing, h = 0.05f * liquid.time();
  Object cube = liquid.of(fill_box({}, {side, side, side}, liquid.spacing));
  cube.velocities.assign(cube.positions.size(), {0.01f, 0, 0});
  World world(weightless(cube, 1));
  const int steps = static_cast<int>(4 * period(liquid, 1000) / static_cast<double>(h));
  double at_most = 0, later = 0;
  for (int i = 0; i < steps; ++i) {
    const Report report = world.step(h);
    ASSERT_TRUE(report.ok()) << report.explain();
    ASSERT_EQ(report.tension.share, 1);
    const double kinetic = sums_of(world).kinetic - 0.5e-4;
    (i < steps / 2 ? at_most : later) = std::max(i < steps / 2 ? at_most : later, kinetic);
  }
  const Sums sums = sums_of(world);
  EXPECT_NEAR(sums.squares.y / sums.squares.x, 1, 0.04);
  EXPECT_NEAR(sums.squares.z / sums.squares.x, 1, 0.04);
  const auto [least, most] = roundness(world);
  EXPECT_GT(least, 0.96);
  EXPECT_LT(most, 1.04);
  EXPECT_LT(later, 0.2 * at_most);
  EXPECT_NEAR(sums.momentum.x, 0.01, 1e-7);
  EXPECT_NEAR(sums.momentum.y, 0, 1e-7);
  EXPECT_NEAR(sums.momentum.z, 0, 1e-7);
}

/// What fits best to a - b exp(-c t) cos(omega t + d), with t over the period that Rayleigh says: omega / 2 pi.
double frequency(const std::vector<double>& t, const std::vector<double>& q) {
  double best = 1e99, found = 0;
  for (double w = 0.3; w < 3; w += 0.01) {
    for (double decay = 0.1; decay < 4; decay += 0.1) {
      double m[3][4] = {}, c[3], error = 0;
      const auto basis = [&](std::size_t i, double* b) {
        const double e = std::exp(-decay * t[i]);
        b[0] = e * std::sin(2 * pi * w * t[i]), b[1] = e * std::cos(2 * pi * w * t[i]), b[2] = 1;
      };
      double b[3];
      for (std::size_t i = 0; i < t.size(); ++i) {
        basis(i, b);
        for (int r = 0; r < 3; ++r) {
          for (int k = 0; k < 3; ++k) m[r][k] += b[r] * b[k];
          m[r][3] += b[r] * q[i];
        }
      }
      for (int k = 0; k < 3; ++k)
        for (int r = k + 1; r < 3; ++r)
          for (int j = 3; j >= k; --j) m[r][j] -= m[r][k] / m[k][k] * m[k][j];
      for (int k = 2; k >= 0; --k) {
        c[k] = m[k][3];
        for (int j = k + 1; j < 3; ++j) c[k] -= m[k][j] * c[j];
        c[k] /= m[k][k];
      }
      for (std::size_t i = 0; i < t.size(); ++i) {
        basis(i, b);
        const double off = c[0] * b[0] + c[1] * b[1] + c[2] - q[i];
        error += off * off;
      }
      if (error < best) best = error, found = w;
    }
  }
  return found;
}

/// The frequency of a drop's oscillation over Rayleigh's. `step` is over Liquid::time().
double oscillation(const Liquid& liquid, int radius, float step) {
  const float h = step * liquid.time();
  World calm(weightless(liquid.of(ball(static_cast<float>(radius) * liquid.spacing, liquid.spacing)), 1));
  const double whole = period(liquid, static_cast<std::size_t>(calm.object(0).positions().size()));
  const int steps = static_cast<int>(whole / static_cast<double>(h));
  for (int i = 0; i < 3 * steps; ++i) calm.step(h);
  Object drop = liquid.of(calm.object(0).positions());
  const double rate = 0.15 * 2 * pi / whole;
  for (const Vec3f& p : drop.positions)
    drop.velocities.push_back(Vec3f{p.x, -p.y / 2, -p.z / 2} * static_cast<float>(rate));
  World world(weightless(drop, 1));
  std::vector<double> t, q;
  for (int i = 0; i < 2 * steps; ++i) {
    world.step(h);
    if (i % 32 != 0) continue;
    const Vec3d squares = sums_of(world).squares;
    t.push_back((i + 1) * static_cast<double>(h) / whole);
    q.push_back(squares.x / (squares.y + squares.z));
  }
  return frequency(t, q);
}

// Drops settle into shapes that are not quite round: one of 8 spacings, at half the substep, is 21 % too fast. One of
// 10 is within 15 % there too, which takes minutes.
TEST(Tension, LetsDropsOscillateAsRayleighSays) {
  const Liquid water, mercury{0.002f, 0.485f};
  EXPECT_NEAR(oscillation(water, 8, 0.05f), 1, 0.15);
  EXPECT_NEAR(oscillation(water, 10, 0.05f), 1, 0.15);
  EXPECT_NEAR(oscillation(water, 8, 0.025f), 1, 0.25);
  EXPECT_NEAR(oscillation(mercury, 8, 0.05f), 1, 0.15);
}

/// The height of a puddle over that of a wide one that the floor repels: 2 sqrt(sigma / (rho g)).
double puddle(float height_in_spacings, float side_in_spacings) {
  Liquid liquid;
  const float g = 9.81f, s = liquid.spacing, height = height_in_spacings * s;
  liquid.tension = density * g * height * height / 4;
  const float half = side_in_spacings * s / 2, h = 0.05f * liquid.time();
  Scene scene = weightless(liquid.of(fill_box({-half, 0, -half}, {half, height, half}, s)), 1);
  scene.gravity = {0, -g, 0};
  scene.add(Collider{});
  World world(scene);
  const int steps = static_cast<int>(1.5f / h);
  double sum = 0, count = 0;
  for (int i = 0; i < steps; ++i) {
    world.step(h);
    if (i < 2 * steps / 3 || i % 16 != 0) continue;
    const Vec3d centre = sums_of(world).centre;
    double top = 0;
    for (const Vec3f& p : world.object(0).positions()) {
      const double x = static_cast<double>(p.x) - centre.x, z = static_cast<double>(p.z) - centre.z;
      if (x * x + z * z < static_cast<double>(9 * s * s)) top = std::max(top, static_cast<double>(p.y));
    }
    sum += top + static_cast<double>(s) / 2;
    ++count;
  }
  return sum / count / static_cast<double>(height);
}

TEST(Tension, HoldsPuddlesAsHighAsItSays) { EXPECT_NEAR(puddle(8, 24), 1, 0.08); }

// With forces at the places where a substep starts, this drop took up energy and burst after a second.
TEST(Tension, LetsADropOnAFloorComeToRest) {
  const Liquid water{0.001f};
  Scene scene = weightless(water.of(fill_box({-0.004f, 0, -0.004f}, {0.004f, 0.004f, 0.004f}, water.spacing)), 1);
  scene.gravity = {0, -9.81f, 0};
  scene.settings.substeps = 90;
  scene.add(Collider{});
  World world(scene);
  for (int i = 0; i < 150; ++i) world.step(1 / 60.f);
  EXPECT_LT(std::sqrt(2 * sums_of(world).kinetic), 0.02);
  for (const Vec3f& p : world.object(0).positions()) EXPECT_LT(std::hypot(p.x, p.z), 0.006f);
}

TEST(Tension, MergesDropsThatTouch) {
  const Liquid liquid;
  const float r = 5 * liquid.spacing, h = 0.05f * liquid.time();
  std::vector<Vec3f> places = ball(r, liquid.spacing, {-r, 0, 0});
  for (const Vec3f& p : ball(r, liquid.spacing, {r, 0, 0})) places.push_back(p);
  World world(weightless(liquid.of(places), 1));
  const int steps = static_cast<int>(4 * period(liquid, places.size()) / static_cast<double>(h));
  for (int i = 0; i < steps; ++i) world.step(h);
  const auto [least, most] = roundness(world);
  EXPECT_GT(least, 0.93);
  EXPECT_LT(most, 1.07);
  EXPECT_LT(std::sqrt(length_squared(sums_of(world).momentum)), 1e-7);
  // Forces are along pairs, but the density is projected at predicted places, which turns the drop a little: by less
  // than 0.5 rad/s.
  EXPECT_LT(std::sqrt(length_squared(sums_of(world).angular)),
            0.5 * 2 / 3 * (sums_of(world).squares.x + sums_of(world).squares.y + sums_of(world).squares.z));
}

Scene two_liquids() {
  const Liquid water, other{0.005f, 0.03f};
  Scene scene = weightless(water.of(ball(0.03f, 0.005f)), 1);
  scene.add(other.of(ball(0.02f, 0.005f, {0.045f, 0, 0})));
  scene.settings.substeps = 6;
  return scene;
}

TEST(Tension, HasTheSameBitsOnAnyThreadsAndLevels) {
  const Scene scene = two_liquids();
  testing_support::expect_same_bits_on_any_threads_and_levels(scene, {8, 0.01f});
}

TEST(Tension, GoesOnFromARestoredStateWithTheSameBits) {
  const Scene scene = two_liquids();
  testing_support::expect_same_bits_after_a_restore(scene, {4, 0.01f});
}

TEST(Tension, IsBoundedAndSaysSoWhereSubstepsAreTooLong) {
  const Liquid liquid;
  World world(weightless(liquid.of(ball(0.03f, 0.005f)), 1));
  const float h = 0.5f * liquid.time();
  for (int i = 0; i < 50; ++i) {
    const Report report = world.step(h);
    EXPECT_NEAR(report.tension.share, 0.0144, 0.0002);
    ASSERT_NE(report.explain().find("surface tension"), std::string::npos);
    ASSERT_TRUE(report.ok());
  }
  for (const Vec3f& p : world.object(0).positions()) EXPECT_LT(length_squared(p), 0.04f * 0.04f);
}

TEST(Tension, ChoosesSubstepsThatLetItAct) {
  Scene scene = weightless(Liquid{0.002f}.of(ball(0.01f, 0.002f)), 1);
  scene.settings.substeps = 0;
  World world(scene);
  EXPECT_EQ(world.step(1 / 60.f).tension.share, 1);
}

TEST(Tension, OutOfRangeIsNamed) {
  try {
    make_liquid({{}}, {.fluid = {.surface_tension = -1}});
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("surface_tension"), std::string::npos);
  }
}

}  // namespace
}  // namespace pliant
