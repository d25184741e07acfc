// Vorticity confinement of liquids: swirls last longer, momentum is kept.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "pliant/gas.h"
#include "pliant/liquid.h"
#include "pliant/world.h"
#include "support/refusal.h"
#include "support/run.h"
#include "support/same_bits.h"

namespace pliant {
namespace {

using testing_support::frame_time;

constexpr float tank_spacing = 0.04f, tank_side = 0.8f;

/// A slab of liquid with an eddy about the vertical axis through its middle.
Object eddy(float height, float vorticity, const Vec3f& velocity = {}) {
  Object liquid = make_liquid(fill_box({}, {tank_side, height, tank_side}, tank_spacing),
                              {.fluid = {.spacing = tank_spacing, .vorticity = vorticity}});
  liquid.velocities.assign(liquid.positions.size(), {});
  for (std::size_t i = 0; i < liquid.positions.size(); ++i) {
    const Vec3f d = liquid.positions[i] - Vec3f{tank_side / 2, 0, tank_side / 2};
    const float decay = std::exp(-(d.x * d.x + d.z * d.z) / 0.03f);
    liquid.velocities[i] = Vec3f{d.z, 0, -d.x} * (5 * decay) + velocity;
  }
  return liquid;
}

/// The eddy in a tank without friction.
Scene tank(float vorticity) {
  Scene scene;
  scene.settings.threads = 1;
  scene.add(eddy(0.2f, vorticity));
  const float r = std::sqrt(0.5f);
  const auto add_wall = [&](const Vec3f& at, const Quatf& rotation) {
    Collider wall;
    wall.position = at;
    wall.rotation = rotation;
    scene.add(wall);
  };
  add_wall({}, {0, 0, 0, 1});
  add_wall({}, {0, 0, -r, r});
  add_wall({tank_side, 0, 0}, {0, 0, r, r});
  add_wall({}, {r, 0, 0, r});
  add_wall({0, 0, tank_side}, {-r, 0, 0, r});
  return scene;
}

/// The eddy in free flight.
Scene flight(float vorticity) {
  Scene scene;
  scene.gravity = {};
  scene.settings.threads = 1;
  scene.settings.substeps = 8;
  scene.add(eddy(0.4f, vorticity, {0.25f, 0, 0}));
  return scene;
}

Vec3d mean(const std::vector<Vec3f>& values) {
  Vec3d sum{};
  for (const Vec3f& v : values) sum += Vec3d{v.x, v.y, v.z};
  return sum * (1 / static_cast<double>(values.size()));
}

/// The moment of velocity about the vertical axis through the centre of mass, within 20 cm of it.
double swirl_of(const World& world) {
  const std::vector<Vec3f> x = world.object(0).positions(), v = world.object(0).velocities();
  const Vec3d centre = mean(x), drift = mean(v);
  double swirl = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = static_cast<double>(x[i].x) - centre.x, dz = static_cast<double>(x[i].z) - centre.z;
    if (dx * dx + dz * dz > 0.04) continue;
    swirl += dz * (static_cast<double>(v[i].x) - drift.x) - dx * (static_cast<double>(v[i].z) - drift.z);
  }
  return swirl;
}

/// The share of the swirl that is left after two seconds.
double swirl_left(float vorticity) {
  World world(tank(vorticity));
  const double before = swirl_of(world);
  for (int i = 0; i < 120; ++i) EXPECT_TRUE(world.step(frame_time).ok());
  return swirl_of(world) / before;
}

TEST(Vorticity, KeepsSwirls) {
  const double without = swirl_left(0), little = swirl_left(0.05f), much = swirl_left(0.2f);
  EXPECT_GT(little, 1.25 * without);
  EXPECT_GT(much, 1.25 * little);
  EXPECT_LT(much, 1);
}

TEST(Vorticity, KeepsMomentum) {
  World world(flight(0.5f));
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(world.step(frame_time).ok());
  const Vec3d velocity = mean(world.object(0).velocities());
  EXPECT_NEAR(velocity.x, 0.25, 1e-6);
  EXPECT_NEAR(velocity.y, 0, 1e-6);
  EXPECT_NEAR(velocity.z, 0, 1e-6);
}

// The particles of a block far away mix with those of the eddy, and get nothing of the momentum that these give back.
TEST(Vorticity, DoesNotMoveLiquidAtRest) {
  Scene scene = flight(0.5f);
  scene.add(make_liquid(fill_box({9, 0, 0}, {9.4f, 0.4f, 0.4f}, tank_spacing),
                        {.name = "still", .fluid = {.spacing = tank_spacing, .vorticity = 0.5f}}));
  World world(scene);
  for (int i = 0; i < 30; ++i) ASSERT_TRUE(world.step(frame_time).ok());
  for (const Vec3f& v : world.object(1).velocities()) EXPECT_LT(length_squared(v), 1e-6f);
}

TEST(Vorticity, HasTheSameBitsOnAnyThreadsAndLevels) {
  const Scene scene = flight(0.5f);
  const std::string expected = testing_support::expect_same_bits_on_any_threads_and_levels(scene, {6, frame_time});
  EXPECT_NE(testing_support::hash_after(flight(0), {6, frame_time}, 1, ""), expected);
}

TEST(Vorticity, GoesOnFromARestoredStateWithTheSameBits) {
  const Scene scene = flight(0.5f);
  testing_support::expect_same_bits_after_a_restore(scene, {3, frame_time});
}

TEST(Vorticity, OutOfRangeIsNamed) {
  EXPECT_NE(testing_support::refusal([] { make_liquid({{}}, {.fluid = {.vorticity = -1}}); }).find("vorticity"),
            std::string::npos);
  Scene scene;
  scene.add(make_liquid({{}}, {.name = "brook"}));
  scene.objects[0].fluid->vorticity = NAN;
  EXPECT_NE(testing_support::refusal([&] { const World world(scene); }).find("'brook'"), std::string::npos);
  Scene gas;
  gas.add(make_gas({{}}));
  gas.objects[0].fluid->vorticity = 1;
  EXPECT_NE(testing_support::refusal([&] { const World world(gas); }).find("gas.vorticity"), std::string::npos);
}

}  // namespace
}  // namespace pliant
