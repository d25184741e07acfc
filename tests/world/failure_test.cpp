// Tests errors within a step: each is skipped or stops the step, is named, and leaves a State from which a run can
// continue.
#include <gtest/gtest.h>

#include <stdexcept>

#include "pliant/body.h"
#include "support/nonfinite.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using namespace testing_support;

TEST(BadForce, IsLeftOutAndNamed) {
  Scene scene = hanging_cloth();
  scene.forces.push_back([](const Vec3f& x, const Vec3f&, float, float) { return Vec3f{x.x > 0.4f ? nan : 0, 0, 0}; });
  World world(scene);
  const Report report = world.step(dt);
  EXPECT_TRUE(report.ok());
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_NE(report.warnings[0].find("force field 0"), std::string::npos) << report.warnings[0];
  EXPECT_NE(report.warnings[0].find("particle"), std::string::npos);
  EXPECT_NE(report.warnings[0].find("cloth"), std::string::npos);
  EXPECT_TRUE(is_finite(world.state()));
}

TEST(BadForce, ThatThrowsStopsTheWorldUntilARestore) {
  bool throws = false;
  Scene scene = hanging_cloth();
  scene.forces.push_back([&](const Vec3f&, const Vec3f&, float, float) {
    if (throws) throw std::runtime_error("no force today");
    return Vec3f{};
  });
  World world(scene);
  world.step(dt);
  const State before = world.state();
  throws = true;
  EXPECT_THROW(world.step(dt), std::runtime_error);
  throws = false;
  const std::string stopped = world.state_hash();
  EXPECT_FALSE(world.step(dt).ok()) << "half a frame is no state to go on from";
  EXPECT_EQ(world.state_hash(), stopped);
  world.restore(before);
  EXPECT_TRUE(world.step(dt).ok());
}

/// A scene in which everything becomes infinite when `armed` is set.
Scene bomb(const bool& armed, Object object) {
  Scene scene;
  scene.add(loose_particles({{5, 5, 5}}));
  object.name = "bomb";
  scene.add(object);
  scene.settings = settings_of(4);
  scene.forces.push_back([&armed](const Vec3f& x, const Vec3f&, float, float) {
    return armed && x.x < 4 ? Vec3f{(x.x + 1) * 3e37f, 0, 0} : Vec3f{};
  });
  return scene;
}

TEST(NonFiniteValue, IsNamedAndTheWorldWaitsForARestore) {
  for (const bool is_tied : {false, true}) {
    bool armed = false;
    Object object = is_tied ? chain(6, 0.5f) : loose_particles({{0, 0, 0}, {1, 0, 0}});
    if (!is_tied) object.masses.assign(2, 1e-15f);
    World world(bomb(armed, object));
    EXPECT_TRUE(world.step(dt).ok());
    const State before = world.state();
    armed = true;
    Report report = world.step(dt);
    for (int frame = 0; frame < 5 && report.ok(); ++frame) report = world.step(dt);
    ASSERT_FALSE(report.ok());
    EXPECT_EQ(report.nonfinite->object, "bomb");
    const std::string expected = is_tied ? "distance constraint" : "particle";
    EXPECT_NE(report.nonfinite->element.find(expected), std::string::npos) << report.nonfinite->element;
    EXPECT_NE(report.explain().find("bomb"), std::string::npos);
    EXPECT_TRUE(is_finite(world.state()));

    const std::string stopped = world.state_hash();
    report = world.step(dt);
    EXPECT_FALSE(report.ok()) << "it refuses to go on";
    EXPECT_NE(report.explain().find("stopped at an earlier step; restore"), std::string::npos) << report.explain();
    EXPECT_EQ(report.explain().find("object"), std::string::npos) << report.explain();
    EXPECT_EQ(world.state_hash(), stopped);
    armed = false;
    world.restore(before);
    EXPECT_TRUE(world.step(dt).ok());
    EXPECT_TRUE(is_finite(world.state()));
  }
}

TEST(NonFiniteValue, OfABodyHasItsName) {
  bool armed = true;
  Object object;
  for (const char* name : {"ball", "top"})
    add_body(object, {{Sphere{0.1f}}},
             {.name = name, .position = {static_cast<float>(object.bodies.size()), 0, 0}, .mass = 1e-15f});
  object.collides = object.self_collision = false;
  World world(bomb(armed, object));
  Report report = world.step(dt);
  for (int frame = 0; frame < 5 && report.ok(); ++frame) report = world.step(dt);
  ASSERT_FALSE(report.ok());
  EXPECT_NE(report.explain().find("body 0 ('ball')"), std::string::npos) << report.explain();
}

}  // namespace
}  // namespace pliant
