// Tests the gauges of liquids: known values of a lattice and of falling liquid, the weight on a floor, and what is
// refused.
#include "pliant/gauges.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "pliant/body.h"
#include "pliant/error.h"
#include "pliant/liquid.h"

namespace pliant {
namespace {

constexpr float spacing = 0.05f, dt = 1.f / 60;

/// A block of liquid of 0.4 x 0.6 x 0.2 m with a corner at the origin.
Object block(const std::string& name = "water", const Vec3f& at = {}) {
  LiquidOptions options;
  options.name = name;
  options.fluid.spacing = spacing;
  return make_liquid(fill_box(at, at + Vec3f{0.4f, 0.6f, 0.2f}, spacing), options);
}

Scene scene_of(const std::vector<Object>& objects, const Vec3f& gravity = {0, -9.81f, 0}) {
  Scene scene;
  scene.gravity = gravity;
  scene.settings.threads = 2;
  for (const Object& object : objects) scene.add(object);
  return scene;
}

double first_value(const Gauge& gauge, const Scene& scene) {
  World world(scene);
  return Gauges({gauge}, scene, world).read(world).front();
}

TEST(HeightGauge, MeasuresTheVolumeOverAFootprint) {
  const Scene scene = scene_of({block()});
  EXPECT_NEAR(first_value({"all", HeightGauge{{0, 0, 0}, {0.4f, 1, 0.2f}}}, scene), 0.6, 1e-6);
  EXPECT_NEAR(first_value({"part", HeightGauge{{0.11f, 0, 0}, {0.23f, 1, 0.2f}}}, scene), 0.6, 1e-6)
      << "cuts particles";
  EXPECT_NEAR(first_value({"half empty", HeightGauge{{-0.4f, 0, 0}, {0.4f, 1, 0.2f}}}, scene), 0.3, 1e-6);
  EXPECT_NEAR(first_value({"low", HeightGauge{{0, 0, 0}, {0.4f, 0.27f, 0.2f}}}, scene), 0.27, 1e-6);
  EXPECT_NEAR(first_value({"along x", HeightGauge{{0, 0, 0}, {1, 0.6f, 0.2f}, 0}}, scene), 0.4, 1e-6);
  EXPECT_EQ(first_value({"beside", HeightGauge{{1, 0, 0}, {2, 1, 0.2f}}}, scene), 0);
}

TEST(HeightGauge, MeasuresTheLiquidsThatItNames) {
  const Scene scene = scene_of({block("water"), block("oil", {0, 0.6f, 0})});
  const HeightGauge over{{0, 0, 0}, {0.4f, 2, 0.2f}};
  EXPECT_NEAR(first_value({"both", over}, scene), 1.2, 1e-6);
  EXPECT_NEAR(first_value({"oil", over, {"oil"}}, scene), 0.6, 1e-6);
}

TEST(FrontGauge, IsWhereAShareOfTheVolumeIsBehind) {
  const Scene scene = scene_of({block()});
  EXPECT_NEAR(first_value({"x", FrontGauge{{2, 0, 0}}}, scene), 0.99 * 0.4, 1e-6);
  EXPECT_NEAR(first_value({"half", FrontGauge{{0, 1, 0}, 0.5f}}, scene), 0.3, 1e-6);
  EXPECT_NEAR(first_value({"back", FrontGauge{{-1, 0, 0}, 0.75f}}, scene), -0.1, 1e-6);
}

/// The volume that passed through a rectangle, from the flow of each frame.
double passed(const FlowGauge& through, const Scene& scene, int frames) {
  World world(scene);
  Gauges gauges({{"gate", through}}, scene, world);
  EXPECT_TRUE(std::isnan(gauges.read(world).front())) << "a flow before the first step";
  double volume = 0;
  for (int i = 0; i < frames; ++i) {
    const double before = world.state().time;
    world.step(dt);
    volume += gauges.read(world).front() * (world.state().time - before);
  }
  return volume;
}

TEST(FlowGauge, CountsAllThatPassesOnce) {
  Object water = block();
  water.velocities.assign(water.positions.size(), {3, 0, 0});
  const Scene scene = scene_of({water}, {});
  const double all = 0.4 * 0.6 * 0.2;
  const Vec3f corner{0.613f, -1, -1}, up{0, 3, 0}, side{0, 0, 3};
  EXPECT_NEAR(passed({corner, up, side}, scene, 30), all, 1e-6);
  EXPECT_NEAR(passed({corner, side, up}, scene, 30), -all, 1e-6) << "the other way round";
  EXPECT_NEAR(passed({{0.613f, -1, -1}, up, {0, 0, 1.1f}}, scene, 30), all / 2, 1e-6)
      << "half of it beside the opening";
  EXPECT_NEAR(passed({{9, -1, -1}, up, side}, scene, 30), 0, 1e-12) << "far away";
}

TEST(FlowGauge, IsSpeedTimesArea) {
  Object water = block();
  water.velocities.assign(water.positions.size(), {1.5f, 0, 0});
  const Scene scene = scene_of({water}, {});
  World world(scene);
  Gauges gauges({{"gate", FlowGauge{{0.4f, -1, -1}, {0, 3, 0}, {0, 0, 3}}}}, scene, world);
  gauges.read(world);
  world.step(dt);
  gauges.read(world);
  for (int i = 0; i < 5; ++i) {
    world.step(dt);
    EXPECT_NEAR(gauges.read(world).front(), 1.5 * 0.6 * 0.2, 1e-4);
  }
}

/// A tank of five boxes around the block, with its floor below y = 0.
void add_tank(Scene& scene) {
  const auto wall = [&](const char* name, const Vec3f& position, const Vec3f& half) {
    Collider collider;
    collider.name = name;
    collider.shape = Box{half};
    collider.position = position;
    scene.add(collider);
  };
  wall("floor", {0.2f, -0.1f, 0.1f}, {0.6f, 0.1f, 0.5f});
  wall("left", {-0.1f, 0.5f, 0.1f}, {0.1f, 0.5f, 0.5f});
  wall("right", {0.5f, 0.5f, 0.1f}, {0.1f, 0.5f, 0.5f});
  wall("back", {0.2f, 0.5f, -0.1f}, {0.2f, 0.5f, 0.1f});
  wall("front", {0.2f, 0.5f, 0.3f}, {0.2f, 0.5f, 0.1f});
}

/// The means of gauges over `frames` frames, after as many seconds as a liquid needs to come to rest.
std::vector<double> settled(const std::vector<Gauge>& of, const Scene& scene, int frames) {
  World world(scene);
  Gauges gauges(of, scene, world);
  std::vector<double> sums(of.size(), 0);
  for (int i = 0; i < 120; ++i) world.step(dt);
  gauges.read(world);
  for (int i = 0; i < frames; ++i) {
    world.step(dt);
    const std::vector<double> values = gauges.read(world);
    for (std::size_t g = 0; g < of.size(); ++g) sums[g] += values[g] / frames;
  }
  return sums;
}

TEST(ForceGauge, OfAFloorIsTheWeightAndOfAWallThePressure) {
  Scene scene = scene_of({block()});
  add_tank(scene);
  const std::vector<double> force = settled({{"down", ForceGauge{"floor"}},
                                             {"right", ForceGauge{"right", {1, 0, 0}}},
                                             {"left", ForceGauge{"left", {1, 0, 0}}}},
                                            scene, 60);
  const double weight = 1000 * 0.4 * 0.6 * 0.2 * 9.81;
  EXPECT_NEAR(force[0], weight, 0.02 * weight);
  EXPECT_NEAR(force[1], -force[2], 0.02 * force[1]) << "the walls hold each other's push";
  const double pressure = 0.5 * 1000 * 9.81 * 0.6 * 0.6 * 0.2;
  EXPECT_NEAR(force[1], pressure, 0.15 * pressure);
}

// What floats at rest is held by the liquid alone.
TEST(ForceGauge, OfAFloatingBodyIsItsWeight) {
  Scene scene = scene_of({block()});
  add_tank(scene);
  Solid ball;
  ball.shape = Sphere{0.07f};
  ball.density = 500;
  BodyOptions options;
  options.position = {0.2f, 0.62f, 0.1f};
  Object float_ball = make_body({ball}, options);
  float_ball.name = "ball";
  scene.add(float_ball);
  const std::vector<double> force = settled({{"up", ForceGauge{"ball", {0, 1, 0}}}}, scene, 90);
  const double weight = 500 * 4 * 3.14159265 / 3 * 0.07 * 0.07 * 0.07 * 9.81;
  EXPECT_NEAR(force[0], weight, 0.05 * weight);
}

// Drops that bounce off a body press on it for a frame or two: the gauge sees twice what stops them, where nothing is
// lost.
TEST(ForceGauge, OfABodyHasTheWholeBounceOfALiquid) {
  for (const float restitution : {0.f, 0.5f, 1.f}) {
    LiquidOptions options;
    options.fluid.spacing = spacing;
    options.velocity = {0, -2, 0};
    Object drops = make_liquid({{0, 0.3f, 0}, {0.5f, 0.4f, 0}, {-0.5f, 0.35f, 0}}, options);
    drops.restitution = restitution;
    Scene scene = scene_of({drops}, {});
    Object slab = make_body({{Box{{1, 0.1f, 1}}}}, {.mass = 1e4f});
    slab.name = "slab";
    scene.add(slab);
    World world(scene);
    Gauges gauges({{"down", ForceGauge{"slab"}}}, scene, world);
    gauges.read(world);
    double impulse = 0;
    for (int frame = 0; frame < 40; ++frame) {
      world.step(dt);
      impulse += gauges.read(world).front() / 60;
    }
    const double mass = 1000 * 0.05 * 0.05 * 0.05, expected = 3 * mass * 2 * (1 + double(restitution));
    EXPECT_NEAR(impulse, expected, 0.01 * expected) << restitution;
    EXPECT_NEAR(world.object(0).velocities()[0].y, 2 * restitution, 0.01) << restitution;
  }
}

std::string refusal(const Gauge& gauge, const Scene& scene) {
  World world(scene);
  try {
    Gauges({gauge}, scene, world);
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing is refused";
}

TEST(Gauges, RefuseWhatCannotBeMeasured) {
  Scene scene = scene_of({block()});
  add_tank(scene);
  const auto says = [&](const Gauge& gauge, const std::string& words) {
    EXPECT_NE(refusal(gauge, scene).find(words), std::string::npos) << refusal(gauge, scene);
  };
  says({"a", HeightGauge{{0, 0, 0}, {1, 0, 1}}}, "gauge 'a': has a box without a volume");
  says({"a", HeightGauge{{0, 0, 0}, {1, 1, 1}, 3}}, "has the axis 3");
  says({"a", FlowGauge{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}}, "span no area");
  says({"a", FrontGauge{{0, 0, 0}}}, "no length");
  says({"a", FrontGauge{{1, 0, 0}, 1}}, "has the share 1");
  says({"a", ForceGauge{"roof"}}, "'roof', which does not exist");
  says({"a", ForceGauge{"water"}}, "is a liquid");
  says({"a", FrontGauge{}, {"oil"}}, "no liquid of that name");
  says({"", FrontGauge{}}, "has no name");
  EXPECT_NE(refusal({"a", FrontGauge{}}, Scene{}).find("finds no liquid"), std::string::npos);
}

TEST(Gauges, ChangeNothing) {
  Scene scene = scene_of({block()});
  add_tank(scene);
  World plain(scene), measured(scene);
  Gauges gauges({{"down", ForceGauge{"floor"}}, {"x", FrontGauge{}}}, scene, measured);
  for (int i = 0; i < 20; ++i) {
    plain.step(dt);
    measured.step(dt);
    gauges.read(measured);
  }
  EXPECT_EQ(plain.state_hash(), measured.state_hash());
}

}  // namespace
}  // namespace pliant
