// Wetting: drops take the shape of a spherical cap with the contact angle of Young's law, and pull bodies as these pull
// them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "fluids/fluid_support.h"
#include "pliant/body.h"
#include "pliant/error.h"
#include "pliant/liquid.h"
#include "pliant/world.h"
#include "support/same_bits.h"

namespace pliant {
namespace {

using std::numbers::pi;
using testing_support::in_double;
using testing_support::weightless;

constexpr float water_density = 1000, drop_spacing = 0.005f, tension = 0.0728f;

/// The time of capillary waves of the spacing [s].
float capillary_time() { return std::sqrt(water_density * drop_spacing * drop_spacing * drop_spacing / tension); }

Object liquid_of(const std::vector<Vec3f>& places, float angle) {
  return make_liquid(
      places,
      {.fluid = {
           .spacing = drop_spacing, .density = water_density, .surface_tension = tension, .contact_angle = angle}});
}

/// Places in a half ball on the ground.
std::vector<Vec3f> half_ball(float radius) {
  std::vector<Vec3f> inside;
  for (const Vec3f& p : fill_box({-radius, 0, -radius}, {radius, radius, radius}, drop_spacing))
    if (length_squared(p) < radius * radius) inside.push_back(p);
  return inside;
}

/// The height of the centre of mass of a spherical cap, over the cube root of its volume.
double height_of_cap(double angle) {
  const double cosine = std::cos(angle * pi / 180), h = 1 - cosine;  // of a ball of radius 1
  const double volume = pi * h * h * (3 - h) / 3;
  return h * (4 - h) / (4 * (3 - h)) / std::cbrt(volume);
}

/// The contact angle of a cap by its centre of mass [degrees].
double angle_of_cap(double height) {
  double low = 1, high = 179;
  for (int i = 0; i < 40; ++i) {
    const double middle = (low + high) / 2;
    (height_of_cap(middle) < height ? low : high) = middle;
  }
  return low;
}

double angle_of(const World& world) {
  const std::vector<Vec3f> x = world.object(0).positions();
  double height = 0;
  for (const Vec3f& p : x) height += static_cast<double>(p.y) / static_cast<double>(x.size());
  const double side = static_cast<double>(drop_spacing) * std::cbrt(static_cast<double>(x.size()));
  return angle_of_cap(height / side);
}

/// The contact angle at which a drop on a plate comes to rest, without gravity [degrees]. It starts as half a ball of a
/// radius in spacings.
double angle_at_rest(float wanted, float radius) {
  Scene scene = weightless(liquid_of(half_ball(radius * drop_spacing), wanted), 1);
  scene.add(Collider{});
  World world(scene);
  const float h = 0.05f * capillary_time();
  double sum = 0;
  constexpr int steps = 6000, measured = 1000;
  for (int i = 0; i < steps; ++i) {
    world.step(h);
    if (i >= steps - measured) sum += angle_of(world) / measured;
  }
  return sum;
}

TEST(Wetting, HoldsTheContactAngle) {
  for (const float angle : {60.f, 90.f, 120.f})
    for (const float radius : {7.3f, 8.3f})
      EXPECT_NEAR(angle_at_rest(angle, radius), static_cast<double>(angle), 4) << radius;
}

/// Of a liquid and a body behind it.
Vec3d linear_momentum(const Scene& scene, const World& world) {
  Vec3d sum{};
  for (int o = 0; o < 2; ++o) {
    const std::vector<Vec3f> v = world.object(ObjectId{o}).velocities();
    for (std::size_t i = 0; i < v.size(); ++i)
      sum += in_double(v[i]) * static_cast<double>(scene.objects[static_cast<std::size_t>(o)].masses[i]);
  }
  return sum;
}

/// A drop beside a free plate.
Scene drop_and_plate(float angle) {
  std::vector<Vec3f> places = half_ball(5.3f * drop_spacing);
  for (Vec3f& p : places) p.y += 0.2f * drop_spacing;
  Scene scene = weightless(liquid_of(places, angle), 1);
  Solid plate;
  plate.shape = Box{{0.06f, 0.005f, 0.06f}};
  plate.density = 500;
  scene.add(make_body({plate}, {.name = "plate", .position = {0, -0.005f, 0}}));
  return scene;
}

TEST(Wetting, KeepsTheMomentumOfADropAndABody) {
  const Scene scene = drop_and_plate(60);
  World world(scene);
  double fastest = 0;
  for (int i = 0; i < 400; ++i) {
    ASSERT_TRUE(world.step(0.05f * capillary_time()).ok());
    fastest = std::max(fastest, static_cast<double>(world.object(ObjectId{1}).velocities()[0].y));
  }
  const double mass = static_cast<double>(scene.objects[1].masses[0]);
  EXPECT_GT(fastest, 1e-4) << "the plate is not pulled";
  EXPECT_LT(std::sqrt(length_squared(linear_momentum(scene, world))), 1e-4 * mass * fastest);
}

// At 180 degrees there is no work of adhesion (Young and Dupre).
TEST(Wetting, HoldsADropUnderACeiling) {
  const auto lowest = [](float angle) {
    std::vector<Vec3f> places = half_ball(5.3f * drop_spacing);
    for (Vec3f& p : places) p.y = -p.y;
    Scene scene = weightless(liquid_of(places, angle), 1);
    scene.gravity = {0, -0.1f, 0};
    Collider ceiling;
    ceiling.rotation = {1, 0, 0, 0};
    scene.add(ceiling);
    World world(scene);
    for (int i = 0; i < 1500; ++i) world.step(0.05f * capillary_time());
    float low = 0;
    for (const Vec3f& p : world.object(0).positions()) low = std::min(low, p.y);
    return low;
  };
  EXPECT_GT(lowest(60), -8 * drop_spacing);
  EXPECT_LT(lowest(180), -20 * drop_spacing);
}

/// Drops of two angles that mix, on a ground and a body.
Scene two_angles() {
  Scene scene = drop_and_plate(60);
  Object other = liquid_of(half_ball(6 * drop_spacing), 120);
  other.name = "other";
  for (Vec3f& p : other.positions) p.x += 0.055f;
  scene.add(other);
  Collider wall;
  wall.shape = Sphere{0.03f};
  wall.position = {-0.06f, 0.02f, 0};
  scene.add(wall);
  return scene;
}

TEST(Wetting, HasTheSameBitsOnAnyThreadsAndLevels) {
  const Scene scene = two_angles();
  testing_support::expect_same_bits_on_any_threads_and_levels(scene, {20, 0.05f * capillary_time()});
}

TEST(Wetting, GoesOnFromARestoredStateWithTheSameBits) {
  const Scene scene = two_angles();
  testing_support::expect_same_bits_after_a_restore(scene, {4, 0.01f});
}

TEST(Wetting, IsSaidToHaveNoEffectWithoutTension) {
  Scene scene = weightless(make_liquid({{}}, {.fluid = {.contact_angle = 60}}), 1);
  const std::vector<Finding> findings = inspect(scene);
  EXPECT_TRUE(std::any_of(findings.begin(), findings.end(), [](const Finding& finding) {
    return finding.message.find("no effect without surface tension") != std::string::npos;
  }));
}

TEST(Wetting, OutOfRangeIsNamed) {
  for (const float angle : {-1.f, 181.f, NAN}) {
    try {
      make_liquid({{}}, {.fluid = {.contact_angle = angle}});
      FAIL();
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("contact_angle"), std::string::npos);
    }
  }
  Scene scene = weightless(make_liquid({{}}, {.name = "dew"}), 1);
  scene.objects[0].fluid->contact_angle = 200;
  try {
    const World world(scene);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("dew"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("contact_angle"), std::string::npos);
  }
}

}  // namespace
}  // namespace pliant
