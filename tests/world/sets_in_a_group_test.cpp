// Tests that sets of objects that cannot meet get the bits that they get alone, although they share a group, its
// near lists and its contacts.
#include <gtest/gtest.h>

#include "world/substep_groups_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// A sheet in two layers that are thrown at one another while both fly sideways.
Object clapping(const std::string& name, float x, float sideways, float speed, int n = 14) {
  Object object = sheet(name, {x, -0.6f, 3}, n);
  object.pins.clear();
  object.self_collision = true;
  object.sweep = Sweep::tiled;
  object.velocities.assign(object.positions.size(), Vec3f{sideways, 0, 0});
  for (std::size_t i = 0; i < object.positions.size(); ++i) {
    Vec3f& p = object.positions[i];
    if (p.z <= 3) continue;
    p = {p.x, p.y + 0.03f, 6 - p.z};
    object.velocities[i].y = -speed;
  }
  return object;
}

/// One set flies off, so that the mean displacement of the two differs from that of each.
TEST(SetsInAGroup, DoNotShareTheFrameInWhichPathsAreSeen) {
  expect_each_set_as_alone({{clapping("still", 0, 0, 1)}, {clapping("fast", 5, 20, 1)}});
}

/// The impacts of one set take more rounds than those of the other.
TEST(SetsInAGroup, DoNotShareTheRoundsOfImpacts) {
  expect_each_set_as_alone({{clapping("gentle", 0, 0, 2)}, {clapping("hard", 5, 0, 40)}});
  Object bouncing = clapping("bouncing", -5, 0, 30);
  bouncing.restitution = 0.8f;
  expect_each_set_as_alone({{bouncing}, {clapping("gentle", 0, 0, 2)}, {clapping("hard", 5, 0, 40)}});
}

/// Two sheets that can meet are one set, beside another.
TEST(SetsInAGroup, OfSeveralObjectsAreAsAlone) {
  Object lower = clapping("lower", 0, 0, 3), upper = clapping("upper", 0, -1, 3);
  for (Vec3f& p : upper.positions) p.y += 0.1f;
  lower.collides = upper.collides = true;
  expect_each_set_as_alone({{clapping("first", 9, 2, 5)}, {lower, upper}, {clapping("last", 5, 20, 5)}});
}

/// Sets of one group change where an object is added or removed.
TEST(SetsInAGroup, FollowAdditionsAndRemovals) {
  World world(scene_of({clapping("still", 0, 0, 1)}));
  run(world, 3);
  const ObjectId other = world.add(clapping("fast", 5, 20, 1));
  run(world, 10);
  World alone(scene_of({clapping("still", 0, 0, 1)}));
  run(alone, 13);
  expect_the_same(world, {0}, alone, {0});
  world.remove(other);
  run(world, 5);
  run(alone, 5);
  expect_the_same(world, {0}, alone, {0});
}

}  // namespace
}  // namespace pliant
