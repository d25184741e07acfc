// Tests the scene's `pairs` between rigid bodies and what is made of particles: friction, thickness and restitution.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "pliant/body.h"
#include "pliant/error.h"
#include "pliant/world.h"
#include "support/run.h"
#include "support/scenes.h"
#include "world/run_time_support.h"
#include "world/surface_support.h"

namespace pliant {
namespace {

using testing_support::run;
using testing_support::scene_of;

/// A fixed slab whose upper side is at a height of 0.
Object slab(const SolidShape& shape, float top) {
  BodyOptions options;
  options.mass = INFINITY;
  options.position = {0, -top, 0};
  Object object = make_body({{shape}}, options);
  object.name = "slab";
  return object;
}

enum class Kind { cloth, rope, particle };

Object thing(Kind kind, float height) {
  Object object;
  if (kind == Kind::cloth) object = testing_support::cloth(testing_support::sheet(4, 0.2f, height));
  if (kind == Kind::rope) object = make_rope({{-0.1f, height, 0}, {0, height, 0}, {0.1f, height, 0}});
  if (kind == Kind::particle) object = testing_support::loose_particles({{0, height, 0}});
  object.name = "thing";
  object.thickness = 0.002f;
  object.collides = true;
  object.static_friction = object.kinetic_friction = 0.4f;
  return object;
}

/// Where something is after a second on a slab, in a field that is level but for 1 m/s^2 along x [m].
Vec3f place_after_a_second(Kind kind, const Object& on, const PairProperties& pair) {
  Scene scene = scene_of(10);
  scene.gravity = {1, -9.81f, 0};
  scene.add(on);
  scene.add(thing(kind, pair.thickness.value_or(0.002f)));
  if (!pair.first.empty()) scene.pairs = {pair};
  World world(scene);
  run(world, 60);
  Vec3f mean{};
  const std::vector<Vec3f> places = world.object(1).positions();
  for (const Vec3f& p : places) mean += p * (1 / static_cast<float>(places.size()));
  return mean;
}

TEST(NamedPairs, OfBodiesWithParticlesHaveTheirFriction) {
  const Object box = slab(Box{{2, 0.1f, 1}}, 0.1f);
  for (const Kind kind : {Kind::cloth, Kind::rope, Kind::particle}) {
    EXPECT_LT(place_after_a_second(kind, box, {}).x, 0.01f) << int(kind);
    EXPECT_NEAR(place_after_a_second(kind, box, {"thing", "slab", {}, 0.f, {}, {}}).x, 0.5f, 0.02f) << int(kind);
    // 1 - 0.05 g, and the other order of names
    EXPECT_NEAR(place_after_a_second(kind, box, {"slab", "thing", {}, 0.05f, 0.05f, {}}).x, 0.255f, 0.02f) << int(kind);
  }
}

TEST(NamedPairs, OfBodiesWithParticlesKeepTheirThickness) {
  const Object box = slab(Box{{2, 0.1f, 1}}, 0.1f), drum = slab(Cylinder{1, 0.1f}, 0.1f);
  for (const float kept : {0.0005f, 0.02f})
    for (const Kind kind : {Kind::cloth, Kind::rope, Kind::particle})
      EXPECT_NEAR(place_after_a_second(kind, box, {"thing", "slab", kept, {}, {}, {}}).y, kept, 1e-4f) << int(kind);
  EXPECT_NEAR(place_after_a_second(Kind::cloth, drum, {"thing", "slab", 0.02f, {}, {}, {}}).y, 0.02f, 1e-3f);
}

TEST(NamedPairs, OfOtherBodiesDoNotAct) {
  Scene scene = scene_of(10);
  scene.gravity = {1, -9.81f, 0};
  Object other = slab(Box{{0.1f, 0.1f, 0.1f}}, 5);
  other.name = "other";
  scene.add(slab(Box{{2, 0.1f, 1}}, 0.1f));
  scene.add(thing(Kind::cloth, 0.002f));
  scene.add(other);
  World plain(scene);
  scene.pairs = {{"thing", "other", 0.02f, 0.f, {}, {}}};
  World named(scene);
  run(plain, 20);
  run(named, 20);
  EXPECT_EQ(plain.object(1).positions(), named.object(1).positions());
}

TEST(NamedPairs, HaveTheirRestitution) {
  Scene scene = scene_of(10);
  scene.add(slab(Box{{2, 0.1f, 1}}, 0.1f));
  scene.add(thing(Kind::particle, 0.5f));
  scene.pairs = {{"thing", "slab", {}, {}, {}, 1.f}};
  World world(scene);
  run(world, 38);  // falls for 0.32 s
  EXPECT_GT(world.object(1).positions()[0].y, 0.45f);
}

/// The message of a scene that is refused; empty if it is not.
std::string refusal(const Scene& scene) {
  try {
    World world(scene);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

TEST(NamedPairs, AreRefusedWhereContactDoesNotReadThem) {
  Scene scene = scene_of(2);
  scene.add(slab(Box{{1, 0.1f, 1}}, 0.1f));
  Object brick = slab(Box{{0.1f, 0.1f, 0.1f}}, -1);
  brick.name = "brick";
  scene.add(brick);
  scene.pairs = {{"slab", "brick", 0.01f, 0.2f, {}, {}}};
  EXPECT_EQ(
      refusal(scene),
      "pair 0, thickness: has no effect: rigid bodies touch one another and mesh colliders at their surfaces; remove "
      "it, or make the solids larger");
  scene.pairs = {{"slab", "brick", {}, 0.2f, {}, {}}};
  EXPECT_EQ(refusal(scene), "");
  MeshCollider crate;
  crate.name = "crate";
  crate.mesh = testing_support::box_mesh({1, 1, 1});
  crate.as = MeshCollider::As::distance_grid;
  scene.add(crate);
  scene.pairs = {{"crate", "brick", {}, 0.2f, {}, {}}};
  EXPECT_EQ(
      refusal(scene),
      "pair 0: names 'crate', a distance grid or heightfield, and has no effect on it; set the properties of that mesh "
      "collider itself, or use it as triangles");
}

}  // namespace
}  // namespace pliant
