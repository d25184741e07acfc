// Vorticity confinement of liquids: swirls last longer, momentum is kept.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "pliant/error.h"
#include "pliant/gas.h"
#include "pliant/liquid.h"
#include "pliant/world.h"

namespace pliant {
namespace {

constexpr float spacing = 0.05f, side = 0.8f, frame_time = 1.f / 60;

/// An eddy about the vertical axis through the middle of a cube of liquid, which flies along x.
Scene eddy(float vorticity) {
  Object liquid =
      make_liquid(fill_box({}, {side, side, side}, spacing), {.fluid = {.spacing = spacing, .vorticity = vorticity}});
  liquid.velocities.assign(liquid.positions.size(), {});
  for (std::size_t i = 0; i < liquid.positions.size(); ++i) {
    const Vec3f d = liquid.positions[i] - Vec3f{side / 2, side / 2, side / 2};
    const float decay = std::exp(-(d.x * d.x + d.z * d.z) / 0.03f);
    liquid.velocities[i] = Vec3f{d.z, 0, -d.x} * (5 * decay) + Vec3f{0.25f, 0, 0};
  }
  Scene scene;
  scene.gravity = {};
  scene.settings.threads = 1;
  scene.settings.substeps = 8;
  scene.add(liquid);
  return scene;
}

/// Mean velocity, and about the vertical axis through the centre of mass the mean moment of velocity in the eddy's core.
struct Motion {
  Vec3d mean{};
  double swirl = 0;
};

Motion motion_of(const World& world) {
  const std::vector<Vec3f> x = world.object(0).positions(), v = world.object(0).velocities();
  Motion motion;
  Vec3d centre{};
  for (std::size_t i = 0; i < x.size(); ++i) {
    motion.mean += Vec3d{v[i].x, v[i].y, v[i].z} * (1 / static_cast<double>(x.size()));
    centre += Vec3d{x[i].x, x[i].y, x[i].z} * (1 / static_cast<double>(x.size()));
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double dx = static_cast<double>(x[i].x) - centre.x, dz = static_cast<double>(x[i].z) - centre.z;
    if (dx * dx + dz * dz > 0.04) continue;
    motion.swirl += dz * (static_cast<double>(v[i].x) - motion.mean.x) - dx * (static_cast<double>(v[i].z) - motion.mean.z);
  }
  return motion;
}

double swirl_after(float vorticity, int frames) {
  World world(eddy(vorticity));
  for (int i = 0; i < frames; ++i) EXPECT_TRUE(world.step(frame_time).ok());
  return motion_of(world).swirl;
}

TEST(Vorticity, KeepsSwirls) {
  const double at_first = swirl_after(0, 0), without = swirl_after(0, 30), with = swirl_after(0.2f, 30);
  EXPECT_LT(without, 0.8 * at_first);
  EXPECT_GT(with, 1.2 * without);
  EXPECT_LT(with, 1.1 * at_first);
}

TEST(Vorticity, KeepsMomentum) {
  World world(eddy(0.5f));
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(world.step(frame_time).ok());
  const Motion motion = motion_of(world);
  EXPECT_NEAR(motion.mean.x, 0.25, 1e-6);
  EXPECT_NEAR(motion.mean.y, 0, 1e-6);
  EXPECT_NEAR(motion.mean.z, 0, 1e-6);
}

// A liquid without it takes part in the same pool, and is not moved where it is at rest.
TEST(Vorticity, DoesNotMoveLiquidAtRest) {
  Scene scene = eddy(0.5f);
  Object still = make_liquid(fill_box({2, 0, 0}, {2.4f, 0.4f, 0.4f}, spacing),
                             {.name = "still", .fluid = {.spacing = spacing, .vorticity = 0.5f}});
  scene.add(still);
  World world(scene);
  for (int i = 0; i < 30; ++i) ASSERT_TRUE(world.step(frame_time).ok());
  for (const Vec3f& v : world.object(1).velocities()) EXPECT_LT(length_squared(v), 1e-6f);
}

std::string hash_after(const Scene& scene, int threads, const char* isa) {
  Settings settings = scene.settings;
  settings.threads = threads;
  settings.isa = isa;
  World world(scene, settings);
  for (int i = 0; i < 6; ++i) world.step(frame_time);
  return hash(world.state());
}

TEST(Vorticity, HasTheSameBitsOnAnyThreadsAndLevels) {
  const Scene scene = eddy(0.5f);
  const std::string expected = hash_after(scene, 1, "sequential");
  EXPECT_EQ(hash_after(scene, 1, ""), expected);
  EXPECT_EQ(hash_after(scene, 3, ""), expected);
  EXPECT_EQ(hash_after(scene, 2, "generic"), expected);
  EXPECT_NE(hash_after(eddy(0), 1, ""), expected);
}

TEST(Vorticity, GoesOnFromARestoredStateWithTheSameBits) {
  const Scene scene = eddy(0.5f);
  World world(scene), other(scene);
  for (int i = 0; i < 3; ++i) world.step(frame_time);
  other.restore(world.state());
  for (int i = 0; i < 3; ++i) world.step(frame_time), other.step(frame_time);
  EXPECT_EQ(hash(other.state()), hash(world.state()));
}

std::string why_not(const std::function<void()>& make) {
  try {
    make();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Vorticity, OutOfRangeIsNamed) {
  EXPECT_NE(why_not([] { make_liquid({{}}, {.fluid = {.vorticity = -1}}); }).find("vorticity"), std::string::npos);
  Scene scene;
  scene.add(make_liquid({{}}, {.name = "brook"}));
  scene.objects[0].fluid->vorticity = NAN;
  EXPECT_NE(why_not([&] { const World world(scene); }).find("'brook'"), std::string::npos);
  Scene gas;
  gas.add(make_gas({{}}));
  gas.objects[0].fluid->vorticity = 1;
  EXPECT_NE(why_not([&] { const World world(gas); }).find("gas.vorticity"), std::string::npos);
}

}  // namespace
}  // namespace pliant
