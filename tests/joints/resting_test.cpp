// Tests that jointed bodies at rest on a plane stay where they are.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>

#include "pliant/body.h"
#include "pliant/joint.h"
#include "pliant/world.h"

namespace pliant {
namespace {

constexpr int substeps = 8, frames_to_settle = 120, frames = 180;
constexpr Vec3f anchor{0.21f, 0.12f, 0};

/// A box that lies flat, and one joined to it that leans on the ground with its far edge, if the joint lets it.
Scene leaning_pair(const std::function<void(Object&)>& join) {
  Scene scene;
  Object object;
  add_body(object, {{.shape = Box{{0.2f, 0.1f, 0.1f}}, .density = 1000}}, {.position = {0, 0.0995f, 0}});
  add_body(object, {{.shape = Box{{0.2f, 0.05f, 0.1f}}, .density = 1000}}, {.position = {0.42f, 0.12f, 0}});
  join(object);
  object.static_friction = 0.5f;
  scene.add(object);
  scene.add(Collider{.shape = Plane{}});
  scene.settings.substeps = substeps;
  return scene;
}

/// The largest distance that a body moves in `frames`, after it has settled [m].
double creep(const Scene& scene) {
  World world(scene);
  const auto step = [&](int count) {
    for (int frame = 0; frame < count; ++frame) EXPECT_TRUE(world.step(1.f / 60).ok());
  };
  step(frames_to_settle);
  const auto before = world.state().positions;
  step(frames);
  double most = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const Record &was = before[i], &is = world.state().positions[i];
    most = std::fmax(most, std::hypot(double(is.x - was.x), double(is.y - was.y), double(is.z - was.z)));
  }
  return most;
}

/// The orientation's rounding at the arm from the first centre to the second, in every substep in the same direction
/// [m].
double largest_rounding() { return 0.42 * std::ldexp(1., -24) * substeps * frames; }

TEST(JointedBodiesAtRest, StayWithABallJoint) {
  EXPECT_LT(creep(leaning_pair([](Object& o) { add_joint(o, BallJoint{.a = 0, .b = 1, .anchor = anchor}); })),
            largest_rounding());
}

TEST(JointedBodiesAtRest, StayWithAHinge) {
  EXPECT_LT(creep(leaning_pair([](Object& o) {
              add_joint(o, HingeJoint{.a = 0, .b = 1, .anchor = anchor, .axis = {0, 0, 1}});
            })),
            largest_rounding());
}

TEST(JointedBodiesAtRest, StayWithAFixedJoint) {
  EXPECT_LT(creep(leaning_pair([](Object& o) { add_joint(o, FixedJoint{.a = 0, .b = 1, .anchor = anchor}); })),
            largest_rounding());
}

/// A small plate fixed to the world, on whose end a box a hundred times as heavy rests: its push would turn the plate
/// by more than a quarter of a radian in a substep, if no joint held it.
Object heavy_load() {
  Object object;
  object.name = "load";
  add_body(object, {{.shape = Box{{0.02f, 0.005f, 0.02f}}, .density = 1000}}, {.position = {30, 2, 0}});
  add_body(object, {{.shape = Box{{0.02f, 0.02f, 0.02f}}, .density = 25000}}, {.position = {30.03f, 2.025f, 0}});
  add_joint(object, FixedJoint{.a = -1, .b = 0, .anchor = {30, 2, 0}});
  add_joint(object, SliderJoint{.a = -1, .b = 1, .anchor = {30.03f, 2.025f, 0}, .axis = {0, 1, 0}});
  return object;
}

/// What contacts do elsewhere decides how an island is solved only in that island.
TEST(JointedBodiesAtRest, KeepTheirBitsBesideAHeavyLoad) {
  const Scene alone = leaning_pair([](Object& o) { add_joint(o, BallJoint{.a = 0, .b = 1, .anchor = anchor}); });
  Scene beside = alone;
  beside.add(heavy_load());
  World first(alone), second(beside);
  for (int frame = 0; frame < 60; ++frame) {
    ASSERT_TRUE(first.step(1.f / 60).ok());
    ASSERT_TRUE(second.step(1.f / 60).ok());
  }
  const auto is = first.object(0).positions(), other = second.object(0).positions();
  ASSERT_EQ(is.size(), other.size());
  EXPECT_EQ(std::memcmp(is.data(), other.data(), is.size() * sizeof(Vec3f)), 0);
}

}  // namespace
}  // namespace pliant
