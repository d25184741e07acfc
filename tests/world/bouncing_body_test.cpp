// Tests bodies that bounce without loss: none rises higher than it was let go from, in any number of bounces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "pliant/body.h"
#include "pliant/world.h"

namespace pliant {
namespace {

/// The highest place of a solid's centre in the last five of thirty seconds, let go from rest at a metre [m].
float highest_after_bounces(const SolidShape& shape, const Quatf& rotation, int substeps) {
  BodyOptions options;
  options.position = {0, 1, 0};
  options.rotation = rotation;
  Object object = make_body({{shape}}, options);
  object.restitution = 1;
  object.static_friction = object.kinetic_friction = 0;
  Scene scene;
  scene.colliders.emplace_back();
  scene.settings.threads = 1;
  scene.settings.substeps = substeps;
  scene.add(object);
  World world(scene);
  float highest = 0;
  for (int frame = 0; frame < 1800; ++frame) {
    EXPECT_TRUE(world.step(1.f / 60).ok());
    if (frame >= 1500) highest = std::max(highest, world.object(0).positions()[0].y);
  }
  return highest;
}

/// A ball of restitution 1 keeps its height within what it falls in the last substep before it turns back.
TEST(BouncingBody, ABallKeepsItsHeight) {
  for (const int substeps : {4, 8, 32}) {
    const float height = highest_after_bounces(Sphere{0.1f}, {}, substeps);
    EXPECT_NEAR(height, 1, 0.02) << substeps << " substeps";
    EXPECT_LT(height, 1.005f) << substeps << " substeps";
  }
}

/// A rod that falls flat was thrown to 5.6 m.
TEST(BouncingBody, ARodThatFallsFlatRisesNoHigher) {
  const float half = std::sqrt(0.5f);
  EXPECT_LT(highest_after_bounces(Capsule{0.01f, 0.3f}, {0, 0, half, half}, 0), 1.02f);
}

}  // namespace
}  // namespace pliant
