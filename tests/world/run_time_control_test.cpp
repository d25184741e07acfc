// Tests what the user moves and pushes between steps, with known answers.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "pliant/error.h"
#include "support/nonfinite.h"
#include "support/refusal.h"
#include "world/run_time_support.h"

namespace pliant {
namespace {

using namespace testing_support;

Scene free_sheet() {
  Scene scene;
  scene.gravity = {};
  scene.add_cloth(grid_mesh(9, 9, 1, 1));
  scene.settings = settings_of(8);
  return scene;
}

void expect_near(const Vec3<double>& found, const Vec3<double>& expected, double tolerance) {
  EXPECT_NEAR(found.x, expected.x, tolerance);
  EXPECT_NEAR(found.y, expected.y, tolerance);
  EXPECT_NEAR(found.z, expected.z, tolerance);
}

TEST(Control, AnImpulseChangesMomentumByItself) {
  World world(free_sheet());
  std::vector<Vec3f> impulses(81);
  impulses[3] = {0.01f, 0, 0};
  impulses[40] = {0, 0.02f, -0.01f};
  world.object(0).add_impulses(impulses);
  expect_near(momentum(world, 0), {0.01, 0.02, -0.01}, 1e-8);
  world.step(dt);
  expect_near(momentum(world, 0), {0.01, 0.02, -0.01}, 1e-6);  // internal forces do not change it
}

TEST(Control, AForceForAFrameGivesForceTimesTimeAndIsGone) {
  World world(free_sheet());
  std::vector<Vec3f> forces(81);
  for (Vec3f& force : forces) force = {0, 0.05f, 0};
  world.object(0).set_forces(forces);
  world.step(dt);
  expect_near(momentum(world, 0), {0, 81 * 0.05 * static_cast<double>(dt), 0}, 1e-6);
  world.step(dt);
  expect_near(momentum(world, 0), {0, 81 * 0.05 * static_cast<double>(dt), 0}, 1e-6);
}

/// Pulls all particles of the free sheet by an offset from where the sheet was at first.
void pull_all(World& world, const std::vector<Vec3f>& first, const Vec3f& by, float frequency) {
  std::vector<int> particles(first.size());
  std::iota(particles.begin(), particles.end(), 0);
  std::vector<Vec3f> places = first;
  for (Vec3f& place : places) place += by;
  world.object(0).set_pulls(particles, places, std::vector<float>(first.size(), frequency));
}

TEST(Control, APullIsACriticallyDampedSpringForAFrame) {
  Scene scene = free_sheet();
  scene.settings = settings_of(200);
  World world(scene);
  const std::vector<Vec3f> first = world.object(0).positions();
  const double omega = 20, by = 0.3;
  for (int frame = 1; frame <= 40; ++frame) {
    pull_all(world, first, {0, 0.3f, 0}, 20);
    world.step(dt);
    const double turn = omega * frame * static_cast<double>(dt);
    EXPECT_NEAR(world.object(0).positions()[40].y - first[40].y, by * (1 - (1 + turn) * std::exp(-turn)), 0.002)
        << frame;
  }
  pull_all(world, first, {0, 0, 0}, 20);
  world.step(dt);
  const double momentum_after = momentum(world, 0).y;
  EXPECT_LT(momentum_after, 0);
  world.step(dt);
  EXPECT_NEAR(momentum(world, 0).y, momentum_after, 1e-6) << "it lasts one frame";
}

TEST(Control, APullOfAnyFrequencyIsStable) {
  for (const float frequency : {0.f, 1e3f, 1e10f, 3e38f}) {
    World world(free_sheet());
    const std::vector<Vec3f> first = world.object(0).positions();
    for (int frame = 0; frame < 20; ++frame) {
      pull_all(world, first, {0.2f, 0, 0}, frequency);
      world.step(dt);
      const float moved = world.object(0).positions()[0].x - first[0].x;
      EXPECT_GE(moved, -1e-6) << frequency;
      EXPECT_LE(moved, 0.2f + 1e-6) << frequency;
    }
    EXPECT_NEAR(world.object(0).positions()[0].x - first[0].x, frequency > 0 ? 0.2 : 0, 1e-5) << frequency;
  }
}

TEST(Control, VelocitiesAreTakenAsTheyAre) {
  Scene scene = free_sheet();
  scene.pin(0, {7});
  World world(scene);
  std::vector<Vec3f> velocities(81, Vec3f{1, 2, 3});
  world.object(0).set_velocities(velocities);
  velocities[7] = {};
  EXPECT_EQ(world.object(0).velocities(), velocities) << "a pin has none";
}

TEST(Control, ATargetIsReachedAndEqualsTheSameMotionByKeyframes) {
  const auto path = [](float time) { return Vec3f{0.5f * time, 0.2f * time, 0}; };
  Scene by_targets, by_keyframes;
  for (Scene* scene : {&by_targets, &by_keyframes}) {
    scene->add(chain(10, 0.1f));
    scene->settings = settings_of(16);
  }
  by_targets.pin(0, {0});
  by_keyframes.pin(0, {0}, straight({0.5f, 0.2f, 0}, 1));
  World world(by_targets), expected(by_keyframes);
  const Vec3f start = world.object(0).positions()[0];
  const float frame_time = 1.f / 64;
  for (int frame = 1; frame <= 32; ++frame) {
    const int pin = 0;
    const Vec3f target = start + path(static_cast<float>(frame) * frame_time);
    world.object(0).set_targets({&pin, 1}, {&target, 1});
    world.step(frame_time);
    expected.step(frame_time);
    EXPECT_EQ(world.object(0).positions()[0], target);
    for (int i = 0; i < 10; ++i)
      EXPECT_LT(distance(world.object(0).positions()[i], expected.object(0).positions()[i]), 2e-5) << frame;
    EXPECT_LT(distance(world.object(0).velocities()[0], expected.object(0).velocities()[0]), 1e-4);
  }
  const Vec3f last = world.object(0).positions()[0];
  for (int frame = 0; frame < 5; ++frame) world.step(frame_time);
  EXPECT_EQ(world.object(0).positions()[0], last) << "it stays where it was brought";
  EXPECT_EQ(world.object(0).velocities()[0], (Vec3f{}));
}

TEST(Control, AttachmentsFollowTheirTargets) {
  Scene scene;
  scene.gravity = {};
  Object object = chain(2, 1);
  object.damping = 5;
  object.attachments.push_back({0, {0, 0.4f, 0}, {}, Stiffness::compliance(1e-4f)});
  scene.add(object);
  World world(scene, settings_of(20));
  const int first = 0;
  const Vec3f target{0.3f, 0.1f, -0.2f};
  world.object(0).set_attachment_targets({&first, 1}, {&target, 1});
  for (int frame = 0; frame < 240; ++frame) world.step(dt);
  EXPECT_LT(distance(world.object(0).positions()[0], target), 2e-3);
}

TEST(Control, CollidersGoWhereTheyAreSetAndCarryWhatLiesOnThem) {
  for (const int kind : {0, 1, 2}) {
    Scene scene;
    scene.settings = settings_of(16);
    scene.add_cloth(grid_mesh(9, 9, 0.3f, 0.3f));
    scene.objects[0].thickness = 0.01f;
    scene.objects[0].static_friction = scene.objects[0].kinetic_friction = 1;
    for (Vec3f& p : scene.objects[0].positions) p.y += 0.12f;
    if (kind == 0) {
      Collider box;
      box.shape = Box{{0.5f, 0.1f, 0.5f}};
      box.static_friction = box.kinetic_friction = 1;
      scene.add(box);
    } else {
      MeshCollider box;
      box.mesh = box_mesh({1, 0.2f, 1});
      box.as = kind == 1 ? MeshCollider::As::triangles : MeshCollider::As::distance_grid;
      box.static_friction = box.kinetic_friction = 1;
      scene.add(box);
    }
    World world(scene);
    for (int frame = 0; frame < 20; ++frame) world.step(dt);
    const float before = world.object(0).positions()[40].y;
    State middle;
    std::vector<std::string> hashes;
    const auto drive = [&](int frame) {
      const RigidPose pose{{0, 0.004f * static_cast<float>(frame), 0}, {}};
      kind == 0 ? world.collider(0).set_pose(pose) : world.mesh_collider(0).set_pose(pose);
      EXPECT_TRUE(world.step(dt).ok());
    };
    for (int frame = 1; frame <= 40; ++frame) {
      drive(frame);
      if (frame == 30) middle = world.state();
      if (frame > 30) hashes.push_back(world.state_hash());
    }
    EXPECT_NEAR(world.object(0).positions()[40].y, before + 0.16f, 0.01f) << kind;
    for (int frame = 0; frame < 20; ++frame) world.step(dt);
    EXPECT_NEAR(world.object(0).positions()[40].y, before + 0.16f, 0.01f) << kind << ": it stays where it was brought";
    if (kind == 0) {
      EXPECT_EQ(world.collider(0).pose().position, (Vec3f{0, 0.004f * 40.f, 0}));
    } else if (kind == 1) {
      EXPECT_NEAR(world.mesh_collider(0).positions()[0].y, scene.mesh_colliders[0].mesh.positions[0].y + 0.16f, 1e-6f);
    }
    world.restore(middle);
    for (int frame = 31; frame <= 40; ++frame) {
      drive(frame);
      EXPECT_EQ(world.state_hash(), hashes[static_cast<std::size_t>(frame - 31)]) << kind;
    }
  }
}

TEST(Control, ADrivenPoseEqualsTheSameMotionByKeyframes) {
  Scene by_hand = hanging_cloth(), by_keyframes = hanging_cloth();
  by_hand.colliders[0].motion = {};
  by_keyframes.colliders[0].motion = straight({0.25f, 0, 0}, 1);
  World world(by_hand), expected(by_keyframes);
  for (int frame = 1; frame <= 40; ++frame) {
    const RigidPose pose{by_hand.colliders[0].position + Vec3f{0.25f * static_cast<float>(frame) / 64, 0, 0}, {}};
    world.collider(0).set_pose(pose);
    world.step(1.f / 64);
    expected.step(1.f / 64);
  }
  // Every pose, of frames and of their eight substeps, is exact in float, so contact sees the same ball.
  EXPECT_EQ(world.object(0).positions(), expected.object(0).positions());
  EXPECT_LT(distance(world.collider(0).pose().position, expected.collider(0).pose().position), 1e-6);
}

TEST(Control, VerticesOfAMeshColliderGoWhereTheyAreSet) {
  Scene scene;
  scene.settings = settings_of(8);
  MeshCollider box;
  box.mesh = box_mesh({1, 0.2f, 1});
  scene.add(box);
  World world(scene);
  std::vector<Vec3f> places = box.mesh.positions;
  for (Vec3f& p : places) p = {2 * p.x, p.y + 0.1f, p.z};
  world.mesh_collider(0).set_positions(places);
  world.step(dt);
  EXPECT_EQ(world.mesh_collider(0).positions(), places);
  world.step(dt);
  EXPECT_EQ(world.mesh_collider(0).positions(), places);
}

TEST(Control, WrongSizesAndNumbersAreNamedAndChangeNothing) {
  Scene scene = hanging_cloth();
  World world(scene);
  world.step(dt);
  const std::string before = world.state_hash();
  std::vector<Vec3f> values(144);
  values[12].y = nan;
  const std::vector<Vec3f> few(3);
  for (const auto& bad : {values, few}) {
    EXPECT_NE(refusal([&] { world.object(0).set_velocities(bad); }).find("cloth"), std::string::npos);
    EXPECT_NE(refusal([&] { world.object(0).add_impulses(bad); }).find("cloth"), std::string::npos);
    EXPECT_NE(refusal([&] { world.object(0).set_forces(bad); }).find("cloth"), std::string::npos);
  }
  EXPECT_NE(refusal([&] { world.object(0).add_impulses(values); }).find("particle 12"), std::string::npos);
  const std::vector<int> free = {40}, missing = {144}, pin = {0};
  const std::vector<Vec3f> place(1), off = {{0, nan, 0}};
  EXPECT_NE(refusal([&] { world.object(0).set_targets(free, place); }).find("particle 40"), std::string::npos);
  EXPECT_NE(refusal([&] { world.object(0).set_targets(missing, place); }).find("particle 144"), std::string::npos);
  EXPECT_NE(refusal([&] { world.object(0).set_targets(pin, off); }).find("not finite"), std::string::npos);
  EXPECT_NE(refusal([&] { world.object(0).set_targets(pin, few); }).find("3 positions"), std::string::npos);
  const std::vector<float> frequency = {1}, negative = {-1}, two_of_one = {1, 1};
  EXPECT_NE(refusal([&] { world.object(0).set_pulls(missing, place, frequency); }).find("particle 144"),
            std::string::npos);
  EXPECT_NE(refusal([&] { world.object(0).set_pulls(free, off, frequency); }).find("not finite"), std::string::npos);
  EXPECT_NE(refusal([&] { world.object(0).set_pulls(free, place, negative); }).find("negative"), std::string::npos);
  EXPECT_NE(refusal([&] { world.object(0).set_pulls(free, place, two_of_one); }).find("2 for 1 particles"),
            std::string::npos);
  const std::vector<int> twice = {0, 0};
  const std::vector<Vec3f> two(2);
  EXPECT_NE(refusal([&] { world.object(0).set_targets(twice, two); }).find("particle 0: is given twice"),
            std::string::npos);
  EXPECT_THROW(world.collider(7).set_pose({}), Error);
  EXPECT_THROW(world.collider(0).set_pose({{}, {0, 0, 0, 0}}), Error);
  EXPECT_THROW(world.collider(0).set_pose({{nan, 0, 0}, {}}), Error);
  std::vector<Vec3f> small(3);
  EXPECT_THROW(world.object(0).read_positions(small), Error);
  EXPECT_EQ(world.state_hash(), before);
  World same(scene);
  same.step(dt);
  same.step(dt);
  world.step(dt);
  EXPECT_EQ(world.state_hash(), same.state_hash()) << "nothing of what was refused was kept";
}

TEST(Reading, SpansAndCopiesSayTheSame) {
  Scene scene = hanging_cloth();
  scene.objects[0].attachments.push_back({5, {0, 1, 0}, {}, Stiffness::compliance(1e-3f)});
  World world(scene);
  for (int frame = 0; frame < 5; ++frame) world.step(dt);
  const std::vector<Vec3f> positions = world.object(0).positions(), velocities = world.object(0).velocities();
  std::vector<Vec3f> read(144), moving(144);
  world.object(0).read_positions(read);
  world.object(0).read_velocities(moving);
  EXPECT_EQ(read, positions);
  EXPECT_EQ(moving, velocities);
  const auto stored = world.object(0).positions_in_storage_order();
  const auto fast = world.object(0).velocities_in_storage_order();
  const auto order = world.object(0).storage_order();
  ASSERT_EQ(stored.size(), 145u) << "and the target";
  ASSERT_EQ(order.size(), 145u);
  for (std::size_t i = 0; i < 145; ++i) {
    const auto user = static_cast<std::size_t>(order[i]);
    if (user == 144) continue;
    EXPECT_EQ((Vec3f{stored[i].x, stored[i].y, stored[i].z}), positions[user]);
    EXPECT_EQ((Vec3f{fast[i].x, fast[i].y, fast[i].z}), velocities[user]);
    EXPECT_EQ(stored[i].w == 0, user == 0 || user == 11);
  }
}

TEST(ForceFields, OnAllThreadsGiveTheSameBits) {
  const auto swirl = [](const Vec3f& x, const Vec3f& v, float mass, float time) {
    return Vec3f{-x.z * mass * 3, mass * time - v.y * 0.001f, x.x * mass * 3};
  };
  const auto drag = [](const Vec3f&, const Vec3f& v, float mass, float) { return v * (-0.5f * mass); };
  const auto spoilt = [](const Vec3f& x, const Vec3f&, float, float) { return Vec3f{x.x > 0.4f ? nan : 0, 0, 0}; };
  std::string hashes[2], words[2];
  for (const bool all_threads : {false, true}) {
    Scene scene;
    scene.settings = settings_of(4);
    scene.settings.threads = all_threads ? 3 : 1;
    scene.add_cloth(grid_mesh(90, 90, 1, 1));
    scene.add(chain(20, 0.1f));
    scene.forces = {ForceField(swirl, all_threads), ForceField(drag, all_threads), ForceField(spoilt, all_threads)};
    World world(scene);
    for (int frame = 0; frame < 5; ++frame) words[all_threads ? 1 : 0] = world.step(dt).explain();
    hashes[all_threads ? 1 : 0] = world.state_hash();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(words[0], words[1]);
  EXPECT_NE(words[0].find("force field 2"), std::string::npos) << words[0];
}

TEST(ForceFields, OnArraysGiveTheBitsOfThoseOnParticles) {
  const auto swirl = [](const Vec3f& x, const Vec3f& v, float mass, float time) {
    return Vec3f{-x.z * mass * 3, mass * time - v.y * 0.001f, x.x * mass * 3};
  };
  const auto drag = [](const Vec3f&, const Vec3f& v, float mass, float) { return v * (-0.5f * mass); };
  const auto spoilt = [](const Vec3f& x, const Vec3f&, float, float) { return Vec3f{x.x > 0.4f ? nan : 0, 0, 0}; };
  const auto on_arrays = [](auto force) {
    return ForceField::on_arrays([force](const ForceField::Arrays& of) {
      EXPECT_TRUE(of.object == "cloth" || of.object == "rope");
      for (std::size_t i = 0; i < of.forces.size(); ++i)
        if (std::isfinite(of.masses[i]))
          of.forces[i] = force(of.positions[i], of.velocities[i], of.masses[i], static_cast<float>(of.time));
    });
  };
  const std::vector<std::vector<ForceField>> ways{{ForceField(swirl), ForceField(drag), ForceField(spoilt)},
                                                  {on_arrays(swirl), on_arrays(drag), on_arrays(spoilt)},
                                                  {ForceField(swirl), on_arrays(drag), ForceField(spoilt, true)}};
  std::set<std::string> hashes, words;
  for (const std::vector<ForceField>& way : ways) {
    Scene scene;
    scene.settings = settings_of(4);
    const int cloth = scene.add_cloth(grid_mesh(12, 12, 1, 1));
    scene.pin(cloth, {0, 11});
    Object rope = chain(20, 0.1f);
    rope.name = "rope";
    scene.add(rope);
    scene.forces = way;
    World world(scene);
    for (int frame = 0; frame < 5; ++frame) words.insert(world.step(dt).explain());
    hashes.insert(world.state_hash());
  }
  EXPECT_EQ(hashes.size(), 1u);
  EXPECT_EQ(words.size(), 1u) << *words.begin() << *words.rbegin();
  EXPECT_NE(words.begin()->find("force field 2"), std::string::npos) << *words.begin();
}

}  // namespace
}  // namespace pliant
