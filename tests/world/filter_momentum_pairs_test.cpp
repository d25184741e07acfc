// Tests that free objects keep their momentum, and cross nowhere, where random pairs of them collide.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>

#include "math/vector.h"
#include "pliant/body.h"
#include "pliant/random.h"
#include "pliant/world.h"
#include "world/filter_momentum_support.h"

namespace pliant {
namespace {

using namespace testing_support;

struct Thrown {
  std::string what;
  Object object;
  float radius = 0;  ///< of a sphere about the origin that contains it [m]
};

/// A sheet, a cube of gelatine or, as the second of a pair, a ball, about the origin.
Thrown random_thing(Random& random, bool may_be_ball) {
  const float kind = random.next(), heavier = std::pow(10.f, random.between(-1, 1));
  if (kind < 0.33f && may_be_ball) {
    BodyOptions options;
    options.mass = 0.2f * heavier;
    return {"a ball of " + std::to_string(options.mass) + " kg", make_body({{Sphere{0.08f}}}, options), 0.08f};
  }
  const Quatf rotation = random.rotation();
  const float side = random.between(0.12f, 0.2f);
  Thrown thing = kind < 0.66f ? Thrown{"gelatine of " + std::to_string(side) + " m", gelatine({}, side), 0.87f * side}
                              : Thrown{"a sheet of " + std::to_string(0.2f * heavier) + " kg/m^2",
                                       free_sheet(12, 0.5f, 0.2f * heavier, {}), 0.36f};
  for (Vec3f& p : thing.object.positions) p = rotate(rotation, p);
  return thing;
}

struct Collision {
  std::string what;
  Outcome outcome;
};

/// Throws one random object at another, in half of the cases with a velocity that both have in common.
Collision collide(int seed) {
  Random random(seed);
  Thrown target = random_thing(random, false), shot = random_thing(random, true);
  const Vec3f from = rotate(random.rotation(), {0, 1, 0});
  const float speed = std::pow(20.f, random.next()), away = target.radius + shot.radius + 0.01f;
  const Vec3f beside = cross(from, {random.between(-0.05f, 0.05f), random.between(-0.05f, 0.05f), 0.05f});
  for (Vec3f& p : shot.object.positions) p += from * away + beside;
  const float common = random.next() < 0.5f ? 0 : random.between(1, 20);
  const int frames = std::min(8 + static_cast<int>(60 * away / speed), 60);
  return {
      shot.what + " at " + std::to_string(speed) + " m/s into " + target.what + ", " + std::to_string(common) +
          " m/s in common, seed " + std::to_string(seed),
      outcome_of(target.object, moving(shot.object, from * -speed), frames, rotate(random.rotation(), {common, 0, 0}))};
}

/// How often twenty-four pairs are thrown, each time others.
int rounds_of_collisions() {
  const char* const wanted = std::getenv("PLIANT_COLLISIONS");
  return wanted != nullptr ? std::max(std::atoi(wanted), 1) : 1;
}

/// Velocities are rounded in each substep, which changes the sum of m |v| by some 1e-5 in a second. Angular momentum
/// is kept to 1 % in all but one of 1 200, about the centre of mass as about the origin.
TEST(FilterMomentum, IsKeptByRandomPairs) {
  int met = 0, filtered = 0, over = 0;
  const int pairs = 24 * rounds_of_collisions();
  for (int seed = 1; seed <= pairs; ++seed) {
    const Collision collision = collide(seed);
    const Outcome& outcome = collision.outcome;
    const double rounded = 1e-5 * outcome.carried / outcome.exchanged;
    EXPECT_EQ(outcome.crossings, 0u) << collision.what;
    met += outcome.exchanged > 1e-3 ? 1 : 0;
    filtered += outcome.filtered > 0 ? 1 : 0;
    EXPECT_LT(outcome.linear, 1e-4 + rounded) << collision.what;
    EXPECT_LT(outcome.angular, 2e-2 + rounded) << collision.what;
    EXPECT_LT(outcome.about_origin, 2e-2 + rounded) << collision.what;
    over += outcome.about_origin > 1e-2 + rounded ? 1 : 0;
    EXPECT_LT(outcome.energy_after, outcome.energy_before * (1 + 1e-5)) << collision.what;
  }
  EXPECT_LE(over, pairs / 500);
  EXPECT_GE(met, pairs * 9 / 10);
  EXPECT_GE(filtered, pairs / 6);
}

/// What truncation takes from the motion of both is made up for in the substep. Before, the centre of mass of the first
/// two lagged by 19 and 0.8 mm, which times their momentum was 17 and 7 % of what they exchange.
TEST(FilterMomentum, CentresOfMassDoNotLag) {
  for (const int seed : {134, 264, 334, 368}) {
    const Collision collision = collide(seed);
    const Outcome& outcome = collision.outcome;
    EXPECT_GT(outcome.filtered, 0);
    EXPECT_LT(outcome.lag, 1e-4) << collision.what;
    EXPECT_LT(outcome.about_origin, 1e-2) << collision.what;
    EXPECT_EQ(outcome.crossings, 0u) << collision.what;
  }
}

/// At 20 m/s in common. After the frame moves with what is cut, nothing is cut: then it moves on, else all that is near
/// stops in the world.
TEST(FilterMomentum, IsKeptInAFrameInWhichNothingIsCut) {
  const Collision collision = collide(297);
  EXPECT_GT(collision.outcome.filtered, 0);
  EXPECT_LT(collision.outcome.angular, 2e-2) << collision.what;
}

/// At 8 m/s in common. The displacement of a frame does not round gaps away, else the frame stands still: particles
/// then stay behind by 3 mm, and what stretched gave the cloth two fifths more energy.
TEST(FilterMomentum, AFrameRoundsNoGapsAway) {
  const Collision collision = collide(422);
  EXPECT_GT(collision.outcome.filtered, 0);
  EXPECT_LT(collision.outcome.energy_after, collision.outcome.energy_before) << collision.what;
}

/// At 14 m/s in common. A ball that comes near free cloth without touching it moves in one frame with it: else it
/// leaves the frame of the cloth no room.
TEST(FilterMomentum, WhatComesNearMovesInOneFrame) {
  const Collision collision = collide(179);
  EXPECT_GT(collision.outcome.filtered, 0);
  EXPECT_LT(collision.outcome.angular, 1e-2) << collision.what;
  EXPECT_LT(collision.outcome.lag, 0.01) << collision.what;
}

}  // namespace
}  // namespace pliant
