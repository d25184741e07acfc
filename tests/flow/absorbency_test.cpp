// Liquid in cloth (Absorbency): it spreads as an equation says, and what goes from one to the other is neither lost nor
// made.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "flow_support.h"
#include "model/compiled_object.h"
#include "pliant/edit.h"
#include "pliant/mesh.h"
#include "pliant/save.h"
#include "support/refusal.h"
#include "support/same_bits.h"
#include "world/wicking.h"

namespace pliant {
namespace {

using namespace testing_support;

constexpr float edge = 0.01f;

/// A strip of squares along x, as a surface alone.
CompiledObject strip(int columns, int rows, const Absorbency& absorbency) {
  Object object;
  ClothOptions options;
  object = make_cloth(
      grid_mesh(columns, rows, edge * static_cast<float>(columns - 1), edge * static_cast<float>(rows - 1)), options);
  object.absorbency = absorbency;
  CompiledObject out;
  out.particles = out.user_particles = static_cast<int>(object.positions.size());
  for (const Vec3f& x : object.positions) out.positions.push_back({x.x, x.y, x.z, 1});
  out.surface.triangles = object.triangles;
  compile_absorbency(object, out);
  return out;
}

constexpr auto takes_nothing = [](int, int, float) {};

double sum_of(const std::vector<float>& values) { return std::accumulate(values.begin(), values.end(), 0.); }

/// Barenblatt 1952: where u_t = (D u u_x)_x and u = 1 at x = 0, the front of a dry strip is at 1.616 sqrt(D t).
TEST(Wicking, HasTheFrontOfBoussinesqsEquation) {
  Absorbency absorbency{.capacity = 0.5f, .wicking = 1e-4f};
  const CompiledObject object = strip(60, 3, absorbency);
  const CompiledAbsorbency& surface = object.absorbency;
  const Slopes level = slopes_of(surface, std::vector<double>(surface.areas.size(), 0.));
  std::vector<float> water(surface.areas.size());
  float first = 0;
  for (const Record& x : object.positions) first = std::min(first, x.x);
  const double seconds = 300;
  for (int step = 0; step < 60 * static_cast<int>(seconds); ++step) {
    for (std::size_t i = 0; i < water.size(); ++i)
      if (object.positions[i].x < first + edge / 2) water[i] = surface.areas[i] * absorbency.capacity;
    spread(surface, level, frame, water.data(), takes_nothing);
  }
  float front = 0;
  for (std::size_t i = 0; i < water.size(); ++i)
    if (water[i] > 0.01f * surface.areas[i] * absorbency.capacity)
      front = std::max(front, object.positions[i].x - first);
  EXPECT_NEAR(static_cast<double>(front), 1.616 * std::sqrt(1e-4 * seconds), 2 * static_cast<double>(edge));
}

/// What hangs holds less the higher it is: capacity (height of the water table - y) / rise, and nothing above.
TEST(Wicking, RestsAtALinearProfile) {
  Absorbency absorbency{.capacity = 0.5f, .wicking = 2e-3f, .rise = 0.4f, .runoff = 0};
  const CompiledObject object = strip(30, 3, absorbency);
  const CompiledAbsorbency& surface = object.absorbency;
  std::vector<double> heights;
  for (const Record& x : object.positions) heights.push_back(static_cast<double>(x.x));
  const Slopes slopes = slopes_of(surface, heights);
  std::vector<float> water(surface.areas.size());
  for (std::size_t i = 0; i < water.size(); ++i) water[i] = 0.5f * surface.areas[i] * absorbency.capacity;
  const double before = sum_of(water);
  for (int step = 0; step < 60 * 1200; ++step) spread(surface, slopes, frame, water.data(), takes_nothing);
  EXPECT_NEAR(sum_of(water), before, 1e-4 * before);  // of 72 000 roundings
  double low = 1e9, high = -1e9;
  for (std::size_t i = 0; i < water.size(); ++i) {
    const double potential = static_cast<double>(water[i] / surface.areas[i] / absorbency.capacity) + heights[i] / 0.4;
    low = std::min(low, potential);
    high = std::max(high, potential);
  }
  EXPECT_LT(high - low, 0.002);
}

TEST(Wicking, RunsDownToTheLowestPlaceAndLosesNothing) {
  Absorbency absorbency{.capacity = 0.5f, .wicking = 0, .runoff = 0.1f};
  const CompiledObject object = strip(20, 3, absorbency);
  const CompiledAbsorbency& surface = object.absorbency;
  std::vector<double> heights;
  for (const Record& x : object.positions) heights.push_back(static_cast<double>(x.x));
  std::vector<float> water(surface.areas.size());
  for (std::size_t i = 0; i < water.size(); ++i) water[i] = 1.5f * surface.areas[i] * absorbency.capacity;
  const double before = sum_of(water);
  const Slopes slopes = slopes_of(surface, heights);
  for (int step = 0; step < 600; ++step) spread(surface, slopes, frame, water.data(), takes_nothing);
  EXPECT_NEAR(sum_of(water), before, 1e-5 * before);
  const double lowest = *std::min_element(heights.begin(), heights.end());
  for (std::size_t i = 0; i < water.size(); ++i) {
    const float full = surface.areas[i] * absorbency.capacity;
    if (heights[i] > lowest + static_cast<double>(edge) / 2) {
      EXPECT_NEAR(water[i], full, 0.01f * full);
    }
  }
}

/// A sheet with a cube of liquid over it.
Scene wetted(const Absorbency& absorbency, const Vec3f& low, const Vec3f& high, float spacing_of = 0.01f) {
  Scene scene;
  ClothOptions options;
  options.material = fabric("cotton");
  Object cloth = make_cloth(grid_mesh(31, 31, 0.3f, 0.3f), options);
  cloth.collides = true;
  cloth.thickness = 0.002f;
  cloth.absorbency = absorbency;
  scene.add(std::move(cloth));
  LiquidOptions liquid;
  liquid.fluid.spacing = spacing_of;
  scene.add(make_liquid(fill_box(low, high, spacing_of), liquid));
  scene.settings.threads = 1;
  return scene;
}

double water_in(const World& world, int object) {
  double sum = 0;
  for (const float mass : world.object(object).channel("water")) sum += static_cast<double>(mass);
  return sum;
}

double mass_of(const World& world, int object) {
  double sum = 0;
  for (const Record& x : world.object(object).positions_in_storage_order())
    if (x.w > 0) sum += 1 / static_cast<double>(x.w);
  return sum;
}

Vec3d momentum_of(const World& world) {
  Vec3d sum{};
  for (int object = 0; object < 2; ++object) {
    const auto x = world.object(object).positions_in_storage_order(),
               v = world.object(object).velocities_in_storage_order();
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (!(x[i].w > 0)) continue;
      const double mass = 1 / static_cast<double>(x[i].w);
      sum = {sum.x + mass * static_cast<double>(v[i].x), sum.y + mass * static_cast<double>(v[i].y),
             sum.z + mass * static_cast<double>(v[i].z)};
    }
  }
  return sum;
}

/// Without gravity and pins: drops hit a free sheet and soak in.
TEST(Absorbency, KeepsMassAndMomentum) {
  Scene scene = wetted({.capacity = 2, .uptake = 0.2f, .drag = 5}, {-0.03f, 0.01f, -0.03f}, {0.03f, 0.05f, 0.03f});
  scene.gravity = {};
  scene.objects[1].velocities.assign(scene.objects[1].positions.size(), {0.1f, -0.5f, 0});
  World world(scene);
  const double mass = mass_of(world, 0) + mass_of(world, 1);
  const Vec3d momentum = momentum_of(world);
  const FlowReport sum = run(world, 60);
  EXPECT_GT(sum.soaked, 20);
  EXPECT_NEAR(mass_of(world, 0) + mass_of(world, 1), mass, 1e-5 * mass);
  EXPECT_NEAR(water_in(world, 0), static_cast<double>(sum.soaked) * 1e-3, 1e-6);  // particles of 1 g
  EXPECT_NEAR(momentum_of(world).y, momentum.y, 1e-4 * std::abs(momentum.y));
  EXPECT_NEAR(momentum_of(world).x, momentum.x, 1e-4 * std::abs(momentum.y));
  EXPECT_EQ(static_cast<std::int64_t>(world.object(1).present().size()) + sum.soaked,
            static_cast<std::int64_t>(scene.objects[1].positions.size()));
}

/// A sheet that is held level all over has no room for more than its capacity.
Scene held(const Absorbency& absorbency, const Vec3f& low, const Vec3f& high) {
  Scene scene = wetted(absorbency, low, high);
  scene.objects[0].masses.assign(scene.objects[0].positions.size(), std::numeric_limits<float>::infinity());
  return scene;
}

TEST(Absorbency, HoldsNoMoreThanItsCapacity) {
  World world(held({.capacity = 0.5f, .uptake = 1}, {-0.1f, 0.01f, -0.1f}, {0.1f, 0.03f, 0.1f}));
  const FlowReport sum = run(world, 120);
  EXPECT_EQ(sum.dripped + sum.seeped, 0);
  for (const float mass : world.object(0).channel("water")) EXPECT_LE(mass, 0.5f * 1e-4f * 1.00001f);
  EXPECT_NEAR(water_in(world, 0), 0.5 * 0.3 * 0.3, 0.1 * 0.5 * 0.3 * 0.3);  // the block spreads over nearly all of it
}

/// Water that stands on a full sheet in a frame passes through it at the speed of seepage.
TEST(Absorbency, LetsLiquidThroughAtItsSeepage) {
  Absorbency absorbency{.capacity = 0.01f, .uptake = 10, .seepage = 0.02f};
  Scene scene = held(absorbency, {-0.1f, 0.008f, -0.1f}, {0.1f, 0.088f, 0.1f});
  for (int side = 0; side < 4; ++side) {  // of a frame about the pool, from the sheet upwards
    Collider wall;
    wall.name = "wall " + std::to_string(side);
    const float at = side % 2 == 0 ? 0.15f : -0.15f;
    wall.shape = Box{side < 2 ? Vec3f{0.05f, 0.1f, 0.25f} : Vec3f{0.25f, 0.1f, 0.05f}};
    wall.position = side < 2 ? Vec3f{at, 0.1f, 0} : Vec3f{0, 0.1f, at};
    scene.add(wall);
  }
  World world(scene);
  const FlowReport settling = run(world, 30);
  const FlowReport sum = run(world, 60);
  EXPECT_EQ(world.object(1).present().size() + static_cast<std::size_t>(settling.soaked + sum.soaked),
            scene.objects[1].positions.size());
  const double passed = static_cast<double>(sum.seeped) * 1e-6, expected = 0.02 * 0.2 * 0.2;  // m^3 in a second
  EXPECT_NEAR(passed, expected, 0.15 * expected);
  int below = 0;
  for (const Vec3f& x : world.object(1).present_positions()) below += x.y < 0 ? 1 : 0;
  EXPECT_EQ(below, settling.seeped + sum.seeped);
}

/// Water that sweeps over a full sheet does not shoot out of its other side.
TEST(Absorbency, LetsDropsGoWithTheVelocityOfTheSurface) {
  Scene scene = held({.capacity = 0.01f, .uptake = 10, .seepage = 0.05f}, {-0.1f, 0.008f, -0.1f}, {0.1f, 0.048f, 0.1f});
  scene.objects[1].velocities.assign(scene.objects[1].positions.size(), {1, 0, 0});
  World world(scene);
  int drops = 0;
  for (int frame = 0; frame < 6; ++frame) {
    run(world, 1);
    for (std::size_t i = 0; i < scene.objects[1].positions.size(); ++i) {
      const Vec3f x = world.object(1).positions()[i], v = world.object(1).velocities()[i];
      if (!(x.y < 0) || x.y < -0.02f || std::abs(x.x) > 0.14f) continue;  // not what runs over the edge
      ++drops;
      EXPECT_LT(std::abs(v.x), 0.4f) << "particle " << i << ", frame " << frame;
    }
  }
  EXPECT_GT(drops, 10);
}

/// A full sheet that is turned to hang lets go what is above its rise, in drops from its lower edge.
TEST(Absorbency, DripsWhereItIsLowest) {
  Scene scene = held({.capacity = 1, .uptake = 5, .wicking = 0.01f, .rise = 0.05f, .runoff = 0.5f},
                     {-0.03f, 0.01f, -0.03f}, {0.03f, 0.07f, 0.03f});
  for (Vec3f& x : scene.objects[0].positions) x = {x.x, x.z, 0};
  for (Vec3f& x : scene.objects[1].positions) x = {x.x, x.y + 0.06f, x.z > 0 ? x.z + 0.003f : x.z - 0.003f};
  World world(scene);
  const FlowReport sum = run(world, 600);
  EXPECT_GT(sum.dripped, 10) << sum.soaked << " soaked, " << water_in(world, 0) << " kg left";
  const double held_mass = water_in(world, 0);
  EXPECT_NEAR(held_mass, static_cast<double>(sum.soaked - sum.dripped) * 1e-3, 1e-5);
  World again(scene);
  again.restore(world.state());
  EXPECT_EQ(hash(again.state()), hash(world.state()));
  // At rest a column holds capacity rise / 2, and each drop that hangs is less than a particle.
  EXPECT_LT(held_mass, 0.3 * 1 * 0.05 / 2 + 0.3 / (4 * 0.01) * 1e-3);
}

/// A sheet that hangs by its corners.
Scene hung(const Absorbency& absorbency) {
  Scene scene = wetted(absorbency, {-0.05f, 0.01f, -0.05f}, {0.05f, 0.03f, 0.05f});
  scene.objects[0].pins = {{0}, {30}, {930}, {960}};
  return scene;
}

TEST(Absorbency, MakesClothHeavier) {
  Scene scene = hung({.capacity = 1, .uptake = 1});
  World world(scene);
  const double dry = mass_of(world, 0);
  run(world, 60);
  EXPECT_GT(water_in(world, 0), 0.01);
  EXPECT_NEAR(mass_of(world, 0), dry + water_in(world, 0), 2e-3 * dry);  // that of the corners is infinite
}

TEST(Absorbency, HasTheSameBitsOnAnyNumberOfThreadsAndAfterRestoring) {
  Scene scene = wetted({.capacity = 0.3f, .uptake = 0.5f, .seepage = 0.1f, .drag = 3}, {-0.05f, 0.01f, -0.05f},
                       {0.05f, 0.06f, 0.05f});
  scene.objects[0].pins = {{0}, {30}, {930}, {960}};
  World one(scene);
  scene.settings.threads = 3;
  World three(scene);
  run(one, 20);
  const State kept = one.state();
  run(one, 20);
  run(three, 40);
  EXPECT_EQ(hash(one.state()), hash(three.state()));
  World again(scene);
  again.restore(kept);
  run(again, 20);
  EXPECT_EQ(hash(again.state()), hash(one.state()));
}

TEST(Absorbency, RefusesAStateWhoseMassesAreNotThoseOfItsWater) {
  World world(hung({.capacity = 1, .uptake = 1}));
  run(world, 30);
  State state = world.state();
  const auto water = std::find_if(state.channels.begin(), state.channels.end(),
                                  [](const Channel& channel) { return channel.name == "water"; });
  ASSERT_NE(water, state.channels.end());
  const auto wet = std::max_element(water->values.begin(), water->values.end());
  ASSERT_GT(*wet, 0);
  *wet *= 2;
  EXPECT_THROW(world.restore(state), Error);
  *wet = -1;
  EXPECT_THROW(world.restore(state), Error);
  state.channels.clear();
  EXPECT_THROW(world.restore(state), Error);
}

TEST(Absorbency, WorksOnWhatIsAddedLater) {
  Scene scene = wetted({.capacity = 1, .uptake = 1}, {-0.05f, 0.01f, -0.05f}, {0.05f, 0.03f, 0.05f});
  const Object cloth = scene.objects[0];
  scene.objects.erase(scene.objects.begin());
  scene.gravity = {};
  World world(scene);
  run(world, 2);
  world.add(cloth);
  world.object(0).set_velocities(std::vector<Vec3f>(scene.objects[0].positions.size(), Vec3f{0, -0.3f, 0}));
  const FlowReport sum = run(world, 30);
  EXPECT_GT(sum.soaked, 10);
}

/// A tear divides what a particle holds.
TEST(Absorbency, LosesNothingWhenItIsCut) {
  Scene scene = wetted({.capacity = 1, .uptake = 1}, {-0.05f, 0.01f, -0.05f}, {0.05f, 0.03f, 0.05f});
  scene.objects[0].cuts = {{.start = 0.5f, .end = 0.5f}};
  World world(scene);
  FlowReport sum;
  bool is_cut = false;
  for (int i = 0; i < 40; ++i) {
    const Report report = world.step(frame);
    sum.add(report.flow);
    is_cut = is_cut || !report.torn.empty();
  }
  EXPECT_TRUE(is_cut);
  EXPECT_NEAR(water_in(world, 0), static_cast<double>(sum.soaked - sum.dripped) * 1e-3, 1e-6);
}

TEST(Absorbency, NamesWhatIsOutOfRange) {
  Scene scene = wetted({.capacity = 0}, {-0.05f, 0.01f, -0.05f}, {0.05f, 0.03f, 0.05f});
  const auto made = [&] { World world(scene); };
  EXPECT_NE(refusal(made).find("absorbency, capacity"), std::string::npos) << refusal(made);
  scene.objects[0].absorbency = Absorbency{};
  scene.objects[0].absorbency->rise = -1;
  EXPECT_NE(refusal(made).find("absorbency, rise"), std::string::npos) << refusal(made);
  scene.objects[0].absorbency = Absorbency{};
  scene.objects[1].groups = 2, scene.objects[1].mask = 2;
  const std::vector<Finding> findings = inspect(scene);
  EXPECT_TRUE(std::any_of(findings.begin(), findings.end(),
                          [](const Finding& one) { return one.message.find("absorbency") != std::string::npos; }));
}

}  // namespace
}  // namespace pliant
