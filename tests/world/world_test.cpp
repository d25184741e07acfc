// Tests a World from outside: what it returns and what it rejects, for steps and scenes however small or odd.
#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "pliant/error.h"
#include "pliant/world.h"
#include "support/nonfinite.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using namespace testing_support;

// ------------------------------------------------------------------------------------------------ steps that are none

TEST(StepSize, ThatMakesNoSenseMovesNothingAndSaysSo) {
  World world(hanging_cloth());
  world.step(dt);
  const std::string before = world.state_hash();
  for (float bad : {0.f, -1.f, nan, infinity, -infinity, 1e-45f, 1e-38f, 1e-30f}) {
    const Report report = world.step(bad);
    EXPECT_TRUE(report.ok());
    EXPECT_FALSE(report.warnings.empty()) << bad;
    EXPECT_FALSE(report.explain().empty());
    EXPECT_EQ(world.state_hash(), before) << bad;
  }
  EXPECT_TRUE(world.step(dt).warnings.empty());
}

TEST(StepSize, FromShortToLongStaysFinite) {
  for (float step : {1e-5f, 1e-3f, 0.1f, 1.f, 100.f, 1e6f, 3e38f}) {
    World world(hanging_cloth());
    for (int frame = 0; frame < 10; ++frame) {
      const Report report = world.step(step);
      EXPECT_TRUE(is_finite(world.state())) << step;
      if (!report.ok()) {
        EXPECT_FALSE(report.nonfinite->element.empty());
        break;
      }
    }
  }
}

// ------------------------------------------------------------------------------------------------ little in it

TEST(World, OfNothingSteps) {
  World world{Scene{}};
  for (int frame = 0; frame < 3; ++frame) EXPECT_TRUE(world.step(dt).ok());
  EXPECT_EQ(world.object_count(), 0);
  EXPECT_EQ(world.measure().kinetic_energy(), 0);
  EXPECT_EQ(world.measure().potential_energy(), 0);
  EXPECT_TRUE(world.measure().residuals().empty());
  EXPECT_EQ(world.state().frame, 3);
  EXPECT_NEAR(world.state().time, 3 * dt, 1e-6);
}

TEST(World, OfCollidersAloneMovesThem) {
  Scene scene;
  Collider ball;
  ball.shape = Sphere{1};
  ball.motion = straight({1, 0, 0}, 1);
  scene.add(ball);
  World world(scene);
  for (int frame = 0; frame < 30; ++frame) EXPECT_TRUE(world.step(dt).ok());
  EXPECT_NEAR(world.collider(0).pose().position.x, 0.5, 1e-6);
}

TEST(World, OfOneParticleFalls) {
  Scene scene;
  scene.add(loose_particles({{1, 2, 3}}));
  World world(scene, settings_of(1));
  world.step(0.5f);
  EXPECT_NEAR(world.object(0).positions()[0].y, 2 - 9.81f * 0.25f, 1e-5);
  EXPECT_NEAR(world.measure().kinetic_energy(), 0.5 * 4.905 * 4.905, 1e-4);
  EXPECT_EQ(world.object(0).enclosed_volume(), 0);
  EXPECT_TRUE(world.object(0).mesh().triangles.empty());
}

TEST(World, OfFixedParticlesAloneStaysWhereItIs) {
  Scene scene;
  Object object = chain(3, 1);
  object.masses.assign(3, infinity);
  scene.add(object);
  World world(scene);
  const std::vector<Vec3f> before = world.object(0).positions();
  for (int frame = 0; frame < 5; ++frame) EXPECT_TRUE(world.step(dt).ok());
  EXPECT_EQ(world.object(0).positions(), before);
}

TEST(World, OfASceneGivenAwayIsTheSame) {
  for (const Sweep sweep : {Sweep::automatic, Sweep::multigrid, Sweep::chains}) {
    Scene scene = hanging_cloth();
    scene.add(make_rope({{0, 0, 1}, {1, 0, 1}}, {}));
    scene.settings.sweep = sweep;
    World kept(scene);
    Scene same = scene;
    World given(std::move(same));
    World with_settings(Scene(scene), scene.settings);
    for (int frame = 0; frame < 3; ++frame) {
      kept.step(dt);
      given.step(dt);
      with_settings.step(dt);
    }
    EXPECT_EQ(given.state_hash(), kept.state_hash());
    EXPECT_EQ(with_settings.state_hash(), kept.state_hash());
  }
}

TEST(World, CanBeMovedFromAndToAnother) {
  World first(hanging_cloth());
  first.step(dt);
  const std::string before = first.state_hash();
  World second(std::move(first));
  EXPECT_EQ(second.state_hash(), before);
  first = World(hanging_cloth());  // what was moved from takes a new one
  first.step(dt);
  EXPECT_EQ(first.state_hash(), before);
  second = std::move(first);
  EXPECT_TRUE(second.step(dt).ok());
}

TEST(World, RefusesIndicesThatDoNotExist) {
  World world(hanging_cloth());
  for (int index : {-1, 1, 1000000, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()}) {
    EXPECT_THROW(world.object(index).info(), Error);
    EXPECT_THROW(world.object(index).positions(), Error);
    EXPECT_THROW(world.object(index).velocities(), Error);
    EXPECT_THROW(world.object(index).mesh(), Error);
    EXPECT_THROW(world.object(index).multipliers("distance"), Error);
    EXPECT_THROW(world.object(index).enclosed_volume(), Error);
    EXPECT_THROW((void)world.collider(index).pose(), Error);
  }
  EXPECT_TRUE(world.object(0).multipliers("no such type").empty());
  EXPECT_TRUE(world.object(0).multipliers("dihedral_bending").empty())
      << "none are kept for one iteration unless asked for";
  EXPECT_FALSE(world.object(0).multipliers("distance").empty()) << "overstretch is measured with them";
}

TEST(World, CountsWhatWasCompiled) {
  Scene scene = hanging_cloth();
  scene.objects[0].attachments.push_back({40, {1, 1, 1}, {}, {}});
  World world(scene);
  const ObjectInfo info = world.object(0).info();
  EXPECT_EQ(info.name, "cloth");
  EXPECT_EQ(info.particles, 144);
  ASSERT_EQ(info.constraints.size(), 2u);
  EXPECT_EQ(info.constraints[0], std::make_pair(std::string("distance"), std::int64_t{2 * 12 * 11 + 11 * 11 + 1}));
  EXPECT_EQ(info.constraints[1], std::make_pair(std::string("dihedral_bending"), std::int64_t{2 * 11 * 10 + 11 * 11}));
  EXPECT_EQ(world.object(0).positions().size(), 144u) << "the attachment's target is no particle of the user's";
  EXPECT_EQ(world.object(0).mesh().triangles.size(), 2u * 11 * 11);
  EXPECT_EQ(world.threads(), 1);
}

TEST(Report, TellsTimesContactsAndResiduals) {
  Scene scene = hanging_cloth();
  scene.settings.measure = true;
  World world(scene);
  Report report;
  for (int frame = 0; frame < 20; ++frame) report = world.step(dt);
  EXPECT_EQ(report.frame, 20);
  EXPECT_NEAR(report.time, 20.0 / 60, 1e-6);
  EXPECT_GT(report.milliseconds, 0);
  EXPECT_FALSE(report.phases.empty());
  EXPECT_GT(report.contacts, 0);
  ASSERT_EQ(report.residuals.size(), 2u);
  EXPECT_EQ(report.residuals[0].type, "distance");
  EXPECT_LE(report.residuals[0].rms, report.residuals[0].largest);
  ASSERT_TRUE(report.stretch.has_value());
  EXPECT_LE(report.stretch->mean, report.stretch->largest);
  EXPECT_LE(report.stretch->p99, report.stretch->largest);
  EXPECT_EQ(report.explain(), "");
}

}  // namespace
}  // namespace pliant
