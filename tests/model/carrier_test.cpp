// Tests the motion of mesh colliders: positions computed by hand, and bounds of displacements compared with every
// vertex.
#include "model/carrier.h"

#include <gtest/gtest.h>

#include <random>

#include "math/vector.h"

namespace pliant {
namespace {

Carrier turning() {
  Carrier carrier;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-1, 1);
  for (int i = 0; i < 200; ++i) carrier.rest.push_back({place(random), place(random), place(random)});
  carrier.motion.keyframes = {
      {0, {}, {}}, {1, {1, 2, 3}, rotation({1, 1, 0}, 120)}, {2, {0, -2, 1}, rotation({0, 1, 3}, 90)}};
  carrier.motion.pivot = {0.5f, 0, 0};
  return carrier;
}

TEST(Carrier, DeformsBeforeItMoves) {
  Carrier carrier;
  carrier.rest = {{1, 0, 0}};
  EXPECT_FALSE(carrier.moves());
  carrier.times = {0, 2};
  carrier.frames = {{{1, 0, 0}}, {{3, 0, 0}}};
  EXPECT_TRUE(carrier.moves());
  EXPECT_NEAR(length(CarrierPose(carrier, 1).place(0) - Vec3d{2, 0, 0}), 0, 1e-12);
  carrier.motion.keyframes = {{0, {0, 5, 0}, rotation({0, 0, 1}, 90)}};
  EXPECT_NEAR(length(CarrierPose(carrier, 1).place(0) - Vec3d{0, 7, 0}), 0, 1e-6);
}

TEST(Carrier, MovesNoVertexFartherThanItSays) {
  Carrier carrier = turning();
  for (const bool deforms : {false, true}) {
    if (deforms) {
      carrier.times = {0, 2};
      carrier.frames = {carrier.rest, carrier.rest};
      for (Vec3f& p : carrier.frames[1]) p = p * 3.f;
    }
    for (double from = 0; from < 2; from += 0.13) {
      const double to = from + 0.05;
      double most = 0;
      const CarrierBox box = box_at(carrier, to);
      for (int i = 0; i < 200; ++i) {
        const Vec3d end = CarrierPose(carrier, to).place(i);
        most = std::max(most, length(end - CarrierPose(carrier, from).place(i)));
        const Vec3d inside = min(end - box.low, box.high - end);
        EXPECT_GE(min(min(inside.x, inside.y), inside.z), -1e-12);
      }
      const double said = largest_move(carrier, from, to);
      EXPECT_GE(said, most * (1 - 1e-12)) << from;
      EXPECT_LE(said, most * (deforms ? 1 + 1e-12 : 2)) << from;
    }
  }
}

}  // namespace
}  // namespace pliant
