// A World from the outside: what it answers, what it refuses, and that nothing put into it can break it.
#include "pliant/world.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "pliant/error.h"
#include "support/scenes.h"

namespace pliant {
namespace {

using namespace testing_support;

constexpr float dt = 1.f / 60;
constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();

double distance(const Vec3f& a, const Vec3f& b) { return std::sqrt(static_cast<double>(length_squared(a - b))); }

bool is_finite(const State& state) {
  for (const auto* records : {&state.positions, &state.remainders, &state.velocities}) {
    for (const Record& r : *records) {
      if (!std::isfinite(r.x) || !std::isfinite(r.y) || !std::isfinite(r.z) || !std::isfinite(r.w)) return false;
    }
  }
  return std::isfinite(state.time);
}

Scene hanging_cloth() {
  Scene scene;
  const int cloth = scene.add_cloth(grid_mesh(12, 12, 1, 1));
  scene.pin(cloth, {0, 11});
  Collider ball;
  ball.shape = Sphere{0.3f};
  ball.position = {0, -0.5f, 0};
  ball.motion = straight({0.2f, 0, 0}, 1);
  scene.add(ball);
  scene.settings = settings_of(8);
  return scene;
}

// ------------------------------------------------------------------------------------------------ snapshots

TEST(Snapshot, ResumesInTheSameBits) {
  World world(hanging_cloth());
  for (int frame = 0; frame < 10; ++frame) world.step(dt);
  const State middle = world.state();
  std::vector<std::string> hashes;
  for (int frame = 0; frame < 10; ++frame) {
    world.step(dt);
    hashes.push_back(world.state_hash());
  }
  world.restore(middle);
  EXPECT_EQ(world.state_hash(), hash(middle));
  for (const std::string& expected : hashes) {
    world.step(dt);
    EXPECT_EQ(world.state_hash(), expected);
  }
  World another(hanging_cloth());
  another.restore(middle);
  for (const std::string& expected : hashes) {
    another.step(dt);
    EXPECT_EQ(another.state_hash(), expected) << "in a World made anew";
  }
}

TEST(Snapshot, OfAnotherWorldOrSpoiltIsRefused) {
  World world(hanging_cloth());
  world.step(dt);
  const std::string before = world.state_hash();
  const auto refused = [&](const auto& spoil) {
    State state = world.state();
    spoil(state);
    try {
      world.restore(state);
    } catch (const Error&) {
      return true;
    }
    return false;
  };
  EXPECT_TRUE(refused([](State& s) { s.positions.pop_back(); }));
  EXPECT_TRUE(refused([](State& s) { s.velocities.pop_back(); }));
  EXPECT_TRUE(refused([](State& s) { s.remainders.clear(); }));
  EXPECT_TRUE(refused([](State& s) { s.positions.resize(1000); }));
  EXPECT_TRUE(refused([](State& s) { s.positions[3].x = nan; }));
  EXPECT_TRUE(refused([](State& s) { s.velocities[3].y = infinity; }));
  EXPECT_TRUE(refused([](State& s) { s.remainders[3].z = nan; }));
  EXPECT_TRUE(refused([](State& s) { s.positions[3].w = 77; }));
  EXPECT_TRUE(refused([](State& s) { s.positions[3].w = nan; }));
  EXPECT_TRUE(refused([](State& s) { s.velocities[3].w = 1; })) << "it would change the mass";
  EXPECT_TRUE(refused([](State& s) { s.remainders[3].w = 1; })) << "it would change the mass";
  EXPECT_TRUE(refused([](State& s) { s.time = std::numeric_limits<double>::infinity(); }));
  EXPECT_TRUE(refused([](State& s) { s.frame = -1; }));
  EXPECT_TRUE(refused([](State& s) { s.frame = std::numeric_limits<std::int64_t>::max(); })) << "it could not count on";
  EXPECT_EQ(world.state_hash(), before) << "and nothing has changed";
  EXPECT_FALSE(refused([](State&) {}));
}

TEST(Snapshot, ReadsTheSameInAnyWorld) {
  Scene scene = hanging_cloth();
  scene.settings.record_multipliers = true;
  ClothOptions options;
  options.volume = Volume{2, Stiffness::compliance(1e-3f)};
  scene.add_cloth(sphere_mesh(1), options);
  World world(scene), fresh(scene);
  for (int frame = 0; frame < 10; ++frame) world.step(dt);
  const State state = world.state();
  for (World* each : {&world, &fresh}) each->restore(state);
  const std::vector<Residual> expected = world.residuals(), found = fresh.residuals();
  ASSERT_EQ(expected.size(), found.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].rms, expected[i].rms) << found[i].type;
  EXPECT_EQ(world.multipliers(0, "distance"), fresh.multipliers(0, "distance"));
  EXPECT_EQ(world.multipliers(1, "volume"), fresh.multipliers(1, "volume"));
}

TEST(Hash, SeesEveryMemberAndEveryBit) {
  World world(hanging_cloth());
  world.step(dt);
  const State state = world.state();
  const std::string original = hash(state);
  EXPECT_EQ(original.size(), 64u);
  const auto changed = [&](const auto& change) {
    State copy = state;
    change(copy);
    return hash(copy) != original;
  };
  EXPECT_TRUE(changed([](State& s) { s.time += 1e-9; }));
  EXPECT_TRUE(changed([](State& s) { ++s.frame; }));
  EXPECT_TRUE(changed([](State& s) { s.positions.back().z = std::nextafter(s.positions.back().z, 9.f); }));
  EXPECT_TRUE(changed([](State& s) { s.remainders[5].x += 1e-12f; }));
  EXPECT_TRUE(changed([](State& s) { s.velocities[0].y = -s.velocities[0].y - 1e-30f; }));
  EXPECT_FALSE(changed([](State&) {}));
}

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
  EXPECT_EQ(world.kinetic_energy(), 0);
  EXPECT_EQ(world.potential_energy(), 0);
  EXPECT_TRUE(world.residuals().empty());
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
  EXPECT_NEAR(world.collider_position(0).x, 0.5, 1e-6);
}

TEST(World, OfOneParticleFalls) {
  Scene scene;
  scene.add(loose_particles({{1, 2, 3}}));
  World world(scene, settings_of(1));
  world.step(0.5f);
  EXPECT_NEAR(world.positions(0)[0].y, 2 - 9.81f * 0.25f, 1e-5);
  EXPECT_NEAR(world.kinetic_energy(), 0.5 * 4.905 * 4.905, 1e-4);
  EXPECT_EQ(world.enclosed_volume(0), 0);
  EXPECT_TRUE(world.mesh(0).triangles.empty());
}

TEST(World, OfFixedParticlesAloneStaysWhereItIs) {
  Scene scene;
  Object object = chain(3, 1);
  object.masses.assign(3, infinity);
  scene.add(object);
  World world(scene);
  const std::vector<Vec3f> before = world.positions(0);
  for (int frame = 0; frame < 5; ++frame) EXPECT_TRUE(world.step(dt).ok());
  EXPECT_EQ(world.positions(0), before);
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
    EXPECT_THROW(world.info(index), Error);
    EXPECT_THROW(world.positions(index), Error);
    EXPECT_THROW(world.velocities(index), Error);
    EXPECT_THROW(world.mesh(index), Error);
    EXPECT_THROW(world.multipliers(index, "distance"), Error);
    EXPECT_THROW(world.enclosed_volume(index), Error);
    EXPECT_THROW(world.collider_position(index), Error);
    EXPECT_THROW(world.collider_rotation(index), Error);
  }
  EXPECT_TRUE(world.multipliers(0, "no such type").empty());
  EXPECT_TRUE(world.multipliers(0, "distance").empty()) << "none are kept for one iteration unless asked for";
}

TEST(World, CountsWhatWasCompiled) {
  Scene scene = hanging_cloth();
  scene.objects[0].attachments.push_back({40, {1, 1, 1}, {}, {}});
  World world(scene);
  const ObjectInfo info = world.info(0);
  EXPECT_EQ(info.name, "cloth");
  EXPECT_EQ(info.particles, 144);
  ASSERT_EQ(info.constraints.size(), 2u);
  EXPECT_EQ(info.constraints[0], std::make_pair(std::string("distance"), std::int64_t{2 * 12 * 11 + 11 * 11 + 1}));
  EXPECT_EQ(info.constraints[1], std::make_pair(std::string("dihedral_bending"), std::int64_t{2 * 11 * 10 + 11 * 11}));
  EXPECT_EQ(world.positions(0).size(), 144u) << "the attachment's target is no particle of the user's";
  EXPECT_EQ(world.mesh(0).triangles.size(), 2u * 11 * 11);
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

// ------------------------------------------------------------------------------------------------ what goes wrong

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

/// A scene in which everything explodes once `armed` is set.
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

// ------------------------------------------------------------------------------------------------ control

TEST(Pins, DoNotMoveByABit) {
  World world(hanging_cloth());
  const Vec3f first = world.positions(0)[0], last = world.positions(0)[11];
  for (int frame = 0; frame < 30; ++frame) world.step(dt);
  EXPECT_EQ(world.positions(0)[0], first);
  EXPECT_EQ(world.positions(0)[11], last);
  EXPECT_LT(world.positions(0)[60].y, -0.05f);
}

TEST(Pins, FollowTheirKeyframes) {
  Motion motion{
      {Keyframe{0, {}, {}}, Keyframe{0.5f, {0.3f, 0.1f, 0}, rotation({0, 1, 0}, 90)}, Keyframe{1, {0, 0.5f, 0.2f}, {}}},
      {0.5f, 0, 0},
      false};
  Scene scene;
  scene.add(chain(10, 0.1f));
  scene.objects[0].pins.push_back({0, motion});
  World world(scene, settings_of(16));
  for (int frame = 1; frame <= 75; ++frame) {
    world.step(1.f / 64);
    const double time = frame / 64.0;
    // About the pivot (0.5, 0, 0) the rest place lies at (-0.5, 0, 0); at a quarter turn about y it is at z = +0.5.
    if (frame == 32) {
      EXPECT_LT(distance(world.positions(0)[0], {0.8f, 0.1f, 0.5f}), 1e-6);
    }
    if (time >= 1) {
      EXPECT_LT(distance(world.positions(0)[0], {0, 0.5f, 0.2f}), 1e-6) << frame;
    }
  }
}

TEST(Attachments, ConvergeToTheirTarget) {
  for (const bool moves : {false, true}) {
    Scene scene;
    scene.gravity = {};
    Object object = chain(2, 1);
    object.attachments.push_back(
        {0, {0, 0.4f, 0}, moves ? straight({0.5f, 0, 0}, 0.5f) : Motion{}, Stiffness::compliance(1e-4f)});
    object.damping = 5;
    scene.add(object);
    World world(scene, settings_of(20));
    for (int frame = 0; frame < 240; ++frame) world.step(dt);
    EXPECT_LT(distance(world.positions(0)[0], {moves ? 0.5f : 0, 0.4f, 0}), 2e-3) << moves;
  }
}

TEST(Attachments, HoldAWeightWithTheirCompliance) {
  Scene scene;
  Object object = loose_particles({{0, 0, 0}});
  object.attachments.push_back({0, {0, 0, 0}, {}, Stiffness::compliance(0.01f)});
  object.damping = 10;
  scene.add(object);
  World world(scene, settings_of(20));
  for (int frame = 0; frame < 300; ++frame) world.step(dt);
  EXPECT_NEAR(world.positions(0)[0].y, -0.0981, 1e-5);  // alpha m g
}

TEST(Wind, PushesAFlagAlongAndNotBeyondItsSpeed) {
  Scene scene;
  scene.gravity = {};
  scene.wind.velocity = {0, 3, 0};
  scene.wind.air_density = 1.2f;
  scene.add_cloth(grid_mesh(10, 10, 1, 1));
  World world(scene, settings_of(10));
  double before = 0;
  for (int frame = 0; frame < 240; ++frame) {
    ASSERT_TRUE(world.step(dt).ok());
    double speed = 0;
    for (const Vec3f& v : world.velocities(0)) speed += v.y / 100.0;
    EXPECT_GE(speed, before - 1e-3) << frame;
    EXPECT_LE(speed, 3.001);
    before = speed;
  }
  EXPECT_GT(before, 2.5);
  scene.wind.air_density = 0;
  World still(scene, settings_of(10));
  still.step(dt);
  EXPECT_EQ(still.kinetic_energy(), 0);
}

// ------------------------------------------------------------------------------------------------ stiffness

TEST(PbdStiffness, RemovesItsShareWhateverTheIterations) {
  for (float k : {0.1f, 0.5f, 0.9f, 1.f}) {
    for (int iterations : {1, 2, 5, 20, 200}) {
      Scene scene;
      scene.gravity = {};
      Object object = chain(2, 1, Stiffness::pbd(k));
      object.constraints[0].rest = {0.6f};
      scene.add(object);
      World world(scene, settings_of(1, iterations));
      world.step(dt);
      EXPECT_NEAR(distance(world.positions(0)[0], world.positions(0)[1]) - 0.6, (1 - k) * 0.4, 2e-6)
          << k << ", " << iterations;
    }
  }
}

TEST(Compliance, IsBackwardEulerWhateverTheIterations) {
  // One mass on a fixed point: x = (m x~ + h^2 k l0) / (m + h^2 k), every step.
  for (int iterations : {1, 2, 7, 50}) {
    Scene scene;
    scene.gravity = {};
    Object object = chain(2, 1, Stiffness::compliance(0.002f));
    object.constraints[0].rest = {0.8f};
    object.masses[0] = infinity;
    scene.add(object);
    World world(scene, settings_of(1, iterations));
    const double h = dt, k = 500, m = 1;
    double x = 1, v = 0;
    for (int frame = 0; frame < 30; ++frame) {
      world.step(dt);
      const double next = (m * (x + h * v) + h * h * k * 0.8) / (m + h * h * k);
      v = (next - x) / h;
      x = next;
      EXPECT_NEAR(world.positions(0)[1].x, x, 3e-6) << iterations << " iterations, frame " << frame;
    }
  }
}

TEST(Multipliers, StandInTheOrderOfTheGroups) {
  // A chain that hangs: link i carries the weight of all below it. Its links are given in two groups, out of order.
  Scene scene;
  Object object = chain(7, 0.5f);
  for (Vec3f& p : object.positions) p = {0, -p.x, 0};
  object.masses[0] = infinity;
  object.constraints.clear();
  object.constraints.push_back({"distance", {3, 4, 0, 1}, {}, {}, {}});
  object.constraints.push_back({"distance", {5, 6, 2, 1, 4, 5}, {}, Stiffness::compliance(0, 1), {}});
  object.constraints.push_back({"distance", {2, 3}, {}, {}, {}});
  scene.add(object);
  Settings settings = settings_of(10, 30);
  settings.record_multipliers = true;
  World world(scene, settings);
  for (int frame = 0; frame < 10; ++frame) world.step(dt);
  const std::vector<float> multipliers = world.multipliers(0, "distance");
  const double h = dt / 10.0, below[] = {3, 6, 1, 5, 2, 4};
  ASSERT_EQ(multipliers.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(multipliers[i] / (h * h), -9.81 * below[i], 0.1) << "link " << i;
}

// ------------------------------------------------------------------------------------------------ floats and many substeps

TEST(Substeps, FreeFallIsTheDiscretePathInFloat) {
  for (int substeps : {1, 10, 100, 1000}) {
    Scene scene;
    scene.gravity = {0, -10, 0};
    scene.add(loose_particles({{0, 1, 0}}));
    World world(scene, settings_of(substeps));
    for (int frame = 0; frame < 30; ++frame) world.step(dt);
    const double h = static_cast<double>(dt) / substeps, n = 30.0 * substeps;
    const double fall = 10 * h * h * n * (n + 1) / 2;
    EXPECT_NEAR(1 - world.positions(0)[0].y, fall, 1e-4 * fall) << substeps;
  }
}

TEST(Substeps, AHangingSpringRestsAtTheSamePlace) {
  for (int substeps : {1, 10, 100, 1000}) {
    Scene scene;
    scene.gravity = {0, -10, 0};
    Object object = loose_particles({{0, 0, 0}, {0, -1.02f, 0}});
    object.masses[0] = infinity;
    object.constraints.push_back({"distance", {0, 1}, {1.f}, Stiffness::compliance(0.002f), {}});
    object.damping = 8;
    scene.add(object);
    World world(scene, settings_of(substeps));
    for (int frame = 0; frame < 120; ++frame) world.step(dt);
    EXPECT_NEAR(world.positions(0)[1].y, -1.02, 1e-4 * 0.02 + 2e-6) << substeps;
  }
}

}  // namespace
}  // namespace pliant
