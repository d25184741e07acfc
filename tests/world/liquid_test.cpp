// Liquids: what rests keeps its density and volume, and what moves its momentum.
#include "pliant/liquid.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pliant/world.h"
#include "support/refusal.h"
#include "support/same_bits.h"
#include "world/liquid_support.h"

namespace pliant {
namespace {

using testing_support::add_tank;
using testing_support::liquid_spacing;

Scene column(float height, float width = 0.5f, float tank = 0.5f, const Fluid& fluid = {.spacing = liquid_spacing}) {
  Scene scene;
  scene.add(make_liquid(fill_box({0, 0, 0}, {width, height, 0.5f}, fluid.spacing), {.fluid = fluid}));
  add_tank(scene, {tank, height, 0.5f});
  scene.settings.threads = 1;
  return scene;
}

struct Still {
  double height = 0, speed = 0;  ///< of the centre of mass [m]; root mean square [m/s]
};

Still still_of(const World& world) {
  Still of;
  const std::vector<Vec3f> places = world.object(0).positions(), velocities = world.object(0).velocities();
  for (const Vec3f& p : places) of.height += static_cast<double>(p.y) / static_cast<double>(places.size());
  for (const Vec3f& v : velocities)
    of.speed += static_cast<double>(length_squared(v)) / static_cast<double>(places.size());
  of.speed = std::sqrt(of.speed);
  return of;
}

Report advance(World& world, int frames) {
  Report report;
  for (int i = 0; i < frames; ++i) report = world.step(1.f / 60);
  return report;
}

// The mean error is 1.3 g (depth / 2) h^2 D / w for one iteration a substep: the substeps are chosen for 0.35 %.
TEST(Liquid, ThatRestsIsAsDenseAsTheSubstepsSay) {
  World world(column(1));
  const Report report = advance(world, 180);
  ASSERT_TRUE(report.ok()) << report.explain();
  EXPECT_LT(report.compression.mean, 0.0045);
  EXPECT_GT(report.compression.mean, 0.0015) << "a column that weighs nothing";
  EXPECT_LT(report.compression.largest, 0.02);
  EXPECT_EQ(report.compression.crowded, 0);
}

TEST(Liquid, ThatRestsKeepsItsVolume) {
  World world(column(1));
  advance(world, 180);
  const Still of = still_of(world);
  EXPECT_NEAR(
      of.height, 0.5,
      0.015);  // the lattice settles by about 1 % in the first second (fluids of particles are a little denser than it)
  const double after_three_seconds = of.height;
  advance(world, 180);
  EXPECT_NEAR(still_of(world).height, after_three_seconds, 0.002);
}

// A liquid that yields is denser by p / (density c^2): g (depth / 2) / c^2 on average.
TEST(Liquid, YieldsToPressureBySpeedOfSound) {
  const double c = 12;
  Scene scene =
      column(1, 0.5f, 0.5f, {.spacing = liquid_spacing, .density = 800, .speed_of_sound = static_cast<float>(c)});
  scene.settings.substeps = 60;
  World world(scene);
  const Report report = advance(world, 240);
  const double expected = 9.81 * 0.5 / (c * c);
  EXPECT_NEAR(report.compression.mean, expected, 0.15 * expected);
}

TEST(Liquid, KeepsItsMomentumWithoutWalls) {
  Scene scene;
  scene.gravity = {};
  std::vector<Vec3f> places = fill_box({0, 0, 0}, {0.5f, 0.5f, 0.5f}, liquid_spacing);
  const std::size_t first = places.size();
  for (const Vec3f& p : fill_box({0.6f, 0.1f, 0}, {1.1f, 0.6f, 0.5f}, liquid_spacing)) places.push_back(p);
  Object liquid = make_liquid(places, {.fluid = {.spacing = liquid_spacing}});
  liquid.velocities.assign(places.size(), {});
  for (std::size_t i = first; i < places.size(); ++i) liquid.velocities[i] = {-4, 0.5f, 0};
  scene.add(liquid);
  World world(scene);
  advance(world, 60);
  Vec3d sum{};
  double size = 0;
  for (const Vec3f& v : world.object(0).velocities()) {
    sum = sum + Vec3d{v.x, v.y, v.z};
    size += std::sqrt(static_cast<double>(length_squared(v)));
  }
  const double moving = static_cast<double>(places.size() - first);
  EXPECT_NEAR(sum.x, -4 * moving, 1e-5 * size);
  EXPECT_NEAR(sum.y, 0.5 * moving, 1e-5 * size);
  EXPECT_NEAR(sum.z, 0, 1e-5 * size);
}

TEST(Liquid, ThatBreaksStaysInItsTank) {
  World world(column(1, 0.5f, 1.5f));
  for (int i = 0; i < 120; ++i) {
    const Report report = world.step(1.f / 60);
    ASSERT_TRUE(report.ok()) << report.explain();
    for (const Vec3f& p : world.object(0).positions()) {
      ASSERT_GT(p.y, 0);
      ASSERT_GT(p.x, 0);
      ASSERT_LT(p.x, 1.5f);
      ASSERT_GT(p.z, 0);
      ASSERT_LT(p.z, 0.5f);
    }
  }
}

// No particle falls faster than all energy of the column, given to it alone at its top, permits twice over.
TEST(Liquid, ThatBreaksGainsNoEnergy) {
  World world(column(1, 0.5f, 1.5f));
  const auto energy = [&] {
    double sum = 0;
    const std::vector<Vec3f> x = world.object(0).positions(), v = world.object(0).velocities();
    for (std::size_t i = 0; i < x.size(); ++i)
      sum += 9.81 * static_cast<double>(x[i].y) + 0.5 * static_cast<double>(length_squared(v[i]));
    return sum / static_cast<double>(x.size());
  };
  const double start = energy();
  double before = start;
  for (int i = 0; i < 90; ++i) {
    world.step(1.f / 60);
    const double now = energy();
    EXPECT_LT(now, before + 0.005 * start) << "frame " << i;
    before = now;
  }
  EXPECT_LT(before, start);
  EXPECT_GT(before, 0.5 * start) << "a splash, not honey";
}

TEST(Liquid, HasTheSameBitsOnAnyThreadsAndLevels) {
  const Scene scene = column(0.8f, 0.45f, 0.9f);
  testing_support::expect_same_bits_on_any_threads_and_levels(scene, {12});
}

TEST(Liquid, GoesOnFromARestoredStateWithTheSameBits) {
  const Scene scene = column(0.8f, 0.45f, 0.9f);
  World world(scene);
  advance(world, 9);
  const State kept = world.state();
  advance(world, 7);
  const std::string expected = hash(world.state());
  World other(scene);
  other.restore(kept);
  advance(other, 7);
  EXPECT_EQ(hash(other.state()), expected);
}

TEST(Liquid, OfAnotherSpacingOrMaskIsAnotherLiquid) {
  const auto speed = [](float of_second, std::uint32_t mask) {
    Scene scene;
    scene.gravity = {};
    scene.add(
        make_liquid(fill_box({0, 0, 0}, {0.4f, 0.4f, 0.4f}, liquid_spacing), {.fluid = {.spacing = liquid_spacing}}));
    Object second = make_liquid(fill_box({0, 0, 0}, {0.4f, 0.4f, 0.4f}, of_second),
                                {.name = "second", .fluid = {.spacing = of_second}});
    second.mask = mask;
    scene.add(second);
    World world(scene);
    advance(world, 5);
    return still_of(world).speed;
  };
  EXPECT_GT(speed(liquid_spacing, ~0u), 0.1) << "two liquids in one place push one another away";
  EXPECT_LT(speed(liquid_spacing, 0), 1e-2);
  EXPECT_LT(speed(0.04f, 0), 1e-2);
  EXPECT_GT(speed(0.04f, ~0u), 0.1) << "liquids that do not mix touch";
}

TEST(Liquid, ThatIsHeavierSinksBelowALighterOne) {
  Scene scene;
  const auto add = [&](const char* name, float bottom, float density) {
    const std::vector<Vec3f> places = fill_box({0, bottom, 0}, {0.5f, bottom + 0.4f, 0.5f}, liquid_spacing);
    scene.add(make_liquid(places, {.name = name, .fluid = {.spacing = liquid_spacing, .density = density}}));
  };
  add("oil", 0, 500);
  add("water", 0.4f, 1000);
  add_tank(scene, {0.5f, 1, 0.5f});
  World world(scene);
  advance(world, 600);
  const auto height = [&](int object) {
    double sum = 0;
    const std::vector<Vec3f> places = world.object(object).positions();
    for (const Vec3f& p : places) sum += static_cast<double>(p.y) / static_cast<double>(places.size());
    return sum;
  };
  // Apart, their centres are 0.4 m from one another; at first -0.4. Layers of eight particles keep drops of one in the
  // other.
  EXPECT_GT(height(0) - height(1), 0.2);
}

// They share substeps, although the low one alone would need fewer.
TEST(Liquid, MixesWithOneOfAnotherHeight) {
  Scene scene;
  const auto add = [&](const char* name, float from, float height) {
    scene.add(make_liquid(fill_box({from, 0, 0}, {from + 0.25f, height, 0.25f}, 0.025f),
                          {.name = name, .fluid = {.spacing = 0.025f}}));
  };
  add("low", 0, 0.1f);
  add("high", 0.25f, 0.6f);
  add_tank(scene, {0.5f, 1, 0.25f});
  World world(scene);
  EXPECT_EQ(world.object(0).info().substeps, world.object(1).info().substeps);
  advance(world, 120);
  double mean = 0, count = 0;
  for (int object = 0; object < 2; ++object)
    for (const Vec3f& p : world.object(object).positions()) {
      mean += static_cast<double>(p.y);
      ++count;
    }
  EXPECT_NEAR(mean / count, 0.35 / 2, 0.02);  // as deep as both together
}

TEST(Liquid, DoesNotMoveItsFixedParticles) {
  Scene scene = column(0.5f);
  scene.objects[0].pins = {{0, {}}, {40, {}}};
  const Vec3f first = scene.objects[0].positions[0], other = scene.objects[0].positions[40];
  World world(scene);
  advance(world, 30);
  EXPECT_EQ(world.object(0).positions()[0], first);
  EXPECT_EQ(world.object(0).positions()[40], other);
}

TEST(Liquid, NamesWhatIsOutOfRange) {
  EXPECT_NE(testing_support::refusal([] { make_liquid({}); }).find("without particles"), std::string::npos);
  EXPECT_NE(testing_support::refusal([] { make_liquid({{}}, {.fluid = {.spacing = 0}}); }).find("spacing"),
            std::string::npos);
  EXPECT_NE(testing_support::refusal([] { make_liquid({{}}, {.fluid = {.density = -1}}); }).find("density"),
            std::string::npos);
  EXPECT_NE(
      testing_support::refusal([] { make_liquid({{}}, {.fluid = {.speed_of_sound = NAN}}); }).find("speed_of_sound"),
      std::string::npos);
  EXPECT_NE(testing_support::refusal([] { fill_box({0, 0, 0}, {1, -1, 1}, 0.1f); }).find("side"), std::string::npos);
  EXPECT_NE(testing_support::refusal([] {
              fill_box({0, 0, 0}, {1e6f, 1e-6f, 1e-6f}, 1e-4f);
            }).find("larger spacing"),
            std::string::npos);
  EXPECT_NE(testing_support::refusal([] {
              Scene scene = column(0.5f);
              scene.objects[0].fluid->spacing = NAN;
              const World world(scene);
            }).find("spacing"),
            std::string::npos);
  EXPECT_NE(testing_support::refusal([] {
              fill_box({0, 0, 0}, {1, 1, 1}, 1e-4f);
            }).find("larger spacing"),
            std::string::npos);
}

}  // namespace
}  // namespace pliant
