// Tests rigid bodies in a World.
#include "pliant/body.h"

#include <gtest/gtest.h>

#include "pliant/world.h"

namespace pliant {
namespace {

/// It falls, and keeps its spin about its axis of largest inertia.
TEST(BodyInAWorld, FallsAndSpins) {
  Scene scene;
  BodyOptions options;
  options.angular_velocity = {3, 0, 0};
  scene.add(make_body({{Box{{0.1f, 0.5f, 1}}}}, options));
  World world(scene);
  for (int frame = 0; frame < 60; ++frame) ASSERT_TRUE(world.step(1.f / 60).ok());
  EXPECT_NEAR(world.object(0).positions()[0].y, -9.81 / 2, 0.1);
  EXPECT_NEAR(world.state().frames.angular_velocities[0].x, 3, 1e-4);
}

}  // namespace
}  // namespace pliant
