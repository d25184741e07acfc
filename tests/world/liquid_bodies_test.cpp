// Rigid bodies in liquids: Archimedes' principle, how floating bodies turn, and what both sides keep.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "pliant/body.h"
#include "pliant/liquid.h"
#include "pliant/mesh.h"
#include "pliant/world.h"
#include "support/same_bits.h"
#include "world/liquid_support.h"

namespace pliant {
namespace {

using testing_support::add_tank;
using testing_support::liquid_spacing;
using testing_support::wall;

constexpr float cube_side = 0.3f, pool_width = 0.9f, pool_depth = 0.6f;

Object cube(float relative_density, float tilt, const Vec3f& at) {
  Solid solid;
  solid.shape = Box{{cube_side / 2, cube_side / 2, cube_side / 2}};
  solid.density = 1000 * relative_density;
  BodyOptions options;
  options.position = at;
  options.rotation = {0, 0, std::sin(tilt / 2), std::cos(tilt / 2)};
  return make_body({solid}, options);
}

/// A cube let go just above a pool.
Scene pool(float relative_density, float tilt = 0) {
  Scene scene;
  scene.add(make_liquid(fill_box({0, 0, 0}, {pool_width, pool_depth, pool_width}, liquid_spacing),
                        {.fluid = {.spacing = liquid_spacing}}));
  add_tank(scene, {pool_width, pool_depth, pool_width});
  scene.add(cube(relative_density, tilt, {pool_width / 2, pool_depth + cube_side / 2 + 0.02f, pool_width / 2}));
  scene.settings.threads = 1;
  return scene;
}

struct Floating {
  double draft = 0;    ///< of an upright cube at this height [m]
  double upright = 0;  ///< cosine of the angle between the cube's own y and the world's
};

/// The mean of a last second, in which a cube bobs a little.
Floating floating_after(World& world, int frames, double relative_density) {
  const double volume = static_cast<double>(cube_side) * cube_side * cube_side,
               area = static_cast<double>(pool_width) * pool_width;
  const double level = pool_depth + relative_density * volume / area;
  Floating of;
  for (int i = 0; i < frames; ++i) {
    const Report report = world.step(1.f / 60);
    EXPECT_TRUE(report.ok()) << report.explain();
    if (i < frames - 60) continue;
    of.draft += (level - (static_cast<double>(world.state().positions.back().y) - cube_side / 2)) / 60;
    const Record& q = world.state().frames.orientations.front();
    of.upright += (1 - 2 * static_cast<double>(q.x * q.x + q.z * q.z)) / 60;
  }
  return of;
}

// A floating body displaces its own weight. The bound is a quarter of a spacing.
TEST(LiquidBodies, FloatWithTheDraftOfTheirDensity) {
  for (const float density : {0.25f, 0.9f}) {
    World world(pool(density));
    const Floating of = floating_after(world, 360, density);
    EXPECT_NEAR(of.draft, density * cube_side, liquid_spacing / 4) << "density " << density;
  }
}

// The centre of a cube of half the liquid's density is at the waterline, however it is turned.
TEST(LiquidBodies, OfHalfTheDensityFloatWithTheirCentreAtTheWaterline) {
  World world(pool(0.5f, 0.3f));
  EXPECT_NEAR(floating_after(world, 360, 0.5).draft, cube_side / 2, liquid_spacing / 4);
}

/// The share of a ball's volume that lies deeper than `height` above its centre.
double share_below(double height, double radius) {
  const double h = std::clamp(height / radius, -1., 1.);
  return (2 + 3 * h - h * h * h) / 4;
}

// Archimedes: a ball of density r has the share r / 1000 of its volume under water. A quarter of a spacing, the bound
// of drafts, is a share of 0.07 at a half and of 0.05 at nine tenths.
TEST(LiquidBodies, ThatAreBallsDiveByTheShareOfTheirDensity) {
  constexpr double radius = 0.13, volume = 4. / 3 * std::numbers::pi * radius * radius * radius, tolerance = 0.04;
  constexpr float shallow_depth = 0.4f, shares[] = {0.25f, 0.5f, 0.9f};
  Scene scene = pool(0.5f);
  scene.objects.clear();
  scene.add(make_liquid(fill_box({0, 0, 0}, {pool_width, shallow_depth, pool_width}, liquid_spacing),
                        {.fluid = {.spacing = liquid_spacing}}));
  double level = static_cast<double>(shallow_depth);
  for (int i = 0; i < 3; ++i) {
    Solid ball{.shape = Sphere{static_cast<float>(radius)}};
    ball.density = 1000 * shares[i];
    scene.add(make_body(
        {ball}, {.position = {0.2f + 0.25f * static_cast<float>(i), shallow_depth + 0.15f, i == 1 ? 0.7f : 0.25f}}));
    level += static_cast<double>(shares[i]) * volume / static_cast<double>(pool_width * pool_width);
  }
  World world(scene);
  constexpr int frames = 360, averaged = 60;
  double below[3] = {};
  for (int frame = 0; frame < frames; ++frame) {
    ASSERT_TRUE(world.step(1.f / 60).ok());
    for (std::size_t i = 0; frame >= frames - averaged && i < 3; ++i) {
      const auto height = static_cast<double>(world.object(static_cast<int>(i) + 1).positions()[0].y);
      below[i] += share_below(level - height, radius) / averaged;
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    RecordProperty("per_mille_" + std::to_string(i), static_cast<int>(std::lround(1000 * below[i])));
    EXPECT_NEAR(below[i], static_cast<double>(shares[i]), tolerance) << "ball " << i;
  }
}

// A cube of relative density below (3 - sqrt(3)) / 6 = 0.21 or above 0.79 floats upright (Gilbert 1991); 0.9 is far
// above.
TEST(LiquidBodies, ThatAreTiltedTurnUpright) {
  World world(pool(0.9f, 0.3f));
  EXPECT_GT(floating_after(world, 480, 0.9).upright, std::cos(0.12));
}

// Of half the density it floats neither flat nor upright: from a tilt of 0.1 about a horizontal axis it turns on.
TEST(LiquidBodies, OfHalfTheDensityDoNotFloatFlat) {
  World world(pool(0.5f, 0.1f));
  EXPECT_LT(floating_after(world, 480, 0.5).upright, std::cos(0.5));
}

TEST(LiquidBodies, ThatAreHeavierSink) {
  World world(pool(2.5f));
  floating_after(world, 240, 2.5);
  EXPECT_LT(world.state().positions.back().y, cube_side / 2 + 1.5f * liquid_spacing)
      << "one layer of particles may stay below";
}

// What floats at rest is borne by the liquid: its pressure on each body, over the frame, is the body's weight.
TEST(LiquidBodies, AreBorneByThePressureThatTheirTouchesTell) {
  constexpr float width = 0.9f, depth = 0.4f, side = 0.2f, density[] = {0.3f, 0.6f};
  Scene scene;
  scene.add(
      make_liquid(fill_box({0, 0, 0}, {width, depth, 0.5f}, liquid_spacing), {.fluid = {.spacing = liquid_spacing}}));
  add_tank(scene, {width, depth, 0.5f});
  Object buoys;
  for (int i = 0; i < 2; ++i) {
    Solid solid{.shape = Box{{side / 2, side / 2, side / 2}}};
    solid.density = 1000 * density[i];
    add_body(buoys, {solid}, {.position = {i == 0 ? 0.25f : 0.65f, depth + side / 2 - side * density[i], 0.25f}});
  }
  scene.add(buoys);
  scene.settings.threads = 1;
  World world(scene);
  for (int i = 0; i < 30; ++i) world.step(1.f / 60);
  world.record_contact_events(true);
  double push[2] = {}, of_things = 0;
  for (int i = 0; i < 60; ++i) {
    ASSERT_TRUE(world.step(1.f / 60).ok());
    for (const BodyTouch& touch : world.body_touches())
      if (touch.first.thing == Thing(ObjectId{0})) {
        ASSERT_EQ(touch.first.body, -1);
        ASSERT_GE(touch.second.body, 0);
        push[touch.second.body] += touch.push.y;
      }
    for (const ContactEvent& event : world.contact_events())
      if (event.first == Thing(ObjectId{0}) && event.second == Thing(ObjectId{1})) of_things += event.push.y;
  }
  for (int i = 0; i < 2; ++i) {
    const double weight = 1000 * static_cast<double>(density[i]) * side * side * side * 9.81;
    EXPECT_NEAR(push[i], -weight, 0.03 * weight) << "buoy " << i;
  }
  EXPECT_NEAR(push[0] + push[1], of_things, 1e-9 * std::abs(of_things)) << "the events sum what the touches have";
}

TEST(LiquidBodies, AndLiquidKeepTheirMomentum) {
  Scene scene;
  scene.gravity = {};
  Object liquid =
      make_liquid(fill_box({0, 0, 0}, {0.4f, 0.4f, 0.4f}, liquid_spacing), {.fluid = {.spacing = liquid_spacing}});
  liquid.velocities.assign(liquid.positions.size(), {3, 0.5f, 0});
  const double mass = static_cast<double>(liquid.masses.front()), count = static_cast<double>(liquid.positions.size());
  scene.add(liquid);
  scene.add(cube(0.5f, 0.4f, {0.75f, 0.25f, 0.2f}));
  World world(scene);
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(world.step(1.f / 60).ok());
  Vec3d sum{}, of_body{};
  const State& state = world.state();
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    const Record& v = state.velocities[i];
    const double m = 1 / static_cast<double>(state.positions[i].w);
    of_body = Vec3d{v.x, v.y, v.z} * m;
    sum = sum + of_body;
  }
  const double size = 3 * mass * count;
  EXPECT_GT(of_body.x, 0.1 * size) << "the liquid hits the body";
  EXPECT_NEAR(sum.x, size, 1e-5 * size);
  EXPECT_NEAR(sum.y, size / 6, 1e-5 * size);
  EXPECT_NEAR(sum.z, 0, 1e-5 * size);
}

TEST(LiquidBodies, DoNotMoveIfTheyMayNotTouch) {
  Scene scene = pool(0.5f);
  scene.objects.back().mask = 0;
  scene.gravity = {};
  scene.objects.back().positions.front() = {0.45f, 0.3f, 0.45f};
  World world(scene);
  for (int i = 0; i < 5; ++i) world.step(1.f / 60);
  EXPECT_EQ(world.state().velocities.back().x, 0);
  EXPECT_EQ(world.state().velocities.back().y, 0);
}

// Walls without a floor, and a sheet held at its edge between them: all that the water can fall through is the cloth.
TEST(LiquidOnCloth, IsHeld) {
  Scene scene;
  Object sheet = make_cloth(grid_mesh(25, 25, 0.6f, 0.6f));
  for (std::size_t i = 0; i < sheet.positions.size(); ++i) {
    const Vec3f& p = sheet.positions[i];
    if (std::abs(p.x) < 0.299f && std::abs(p.z) < 0.299f) continue;
    Pin pin;
    pin.particle = static_cast<int>(i);
    sheet.pins.push_back(pin);
  }
  sheet.collides = true;
  sheet.thickness = 0.005f;
  const std::size_t of_cloth = sheet.positions.size();
  scene.add(sheet);
  scene.add(
      make_liquid(fill_box({-0.28f, 0.04f, -0.28f}, {0.28f, 0.25f, 0.28f}, 0.04f), {.fluid = {.spacing = 0.04f}}));
  const float r = std::sqrt(0.5f);
  scene.add(wall({-0.3f, 0, 0}, {0, 0, -r, r}));
  scene.add(wall({0.3f, 0, 0}, {0, 0, r, r}));
  scene.add(wall({0, 0, -0.3f}, {r, 0, 0, r}));
  scene.add(wall({0, 0, 0.3f}, {-r, 0, 0, r}));
  World world(scene);
  for (int i = 0; i < 60; ++i) {
    const Report report = world.step(1.f / 60);
    ASSERT_TRUE(report.ok()) << report.explain();
  }
  float lowest = 0, sagging = 0;
  for (std::size_t i = 0; i < world.state().positions.size(); ++i)
    (i < of_cloth ? sagging : lowest) = std::min(i < of_cloth ? sagging : lowest, world.state().positions[i].y);
  EXPECT_LT(sagging, -0.005f) << "the water weighs on the cloth";
  EXPECT_GT(lowest, sagging) << "no particle is below the lowest place of the cloth";
}

TEST(LiquidBodies, HaveTheSameBitsOnAnyThreadsAndLevels) {
  const Scene scene = pool(0.4f, 0.2f);
  testing_support::expect_same_bits_on_any_threads_and_levels(scene, {30});
}

TEST(LiquidBodies, GoOnFromARestoredStateWithTheSameBits) {
  const Scene scene = pool(0.4f, 0.2f);
  World world(scene);
  for (int i = 0; i < 25; ++i) world.step(1.f / 60);
  const State kept = world.state();
  for (int i = 0; i < 7; ++i) world.step(1.f / 60);
  World other(scene);
  other.restore(kept);
  for (int i = 0; i < 7; ++i) other.step(1.f / 60);
  EXPECT_EQ(hash(other.state()), hash(world.state()));
}

}  // namespace
}  // namespace pliant
