// Tests kinematic bodies: they follow their motion or the poses that a program sets, whatever lies on them, and act on
// all else.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "pliant/body.h"
#include "pliant/grains.h"
#include "pliant/joint.h"
#include "pliant/mesh.h"
#include "pliant/world.h"
#include "support/refusal.h"
#include "support/run.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using testing_support::refusal;
using testing_support::run;

/// The angle between the y-axes of a pose and of the world [degrees].
double tilt_of(const RigidPose& pose) {
  const Quatf& q = pose.rotation;
  const double up = 1 - 2 * (static_cast<double>(q.x) * q.x + static_cast<double>(q.z) * q.z);
  return std::acos(std::fmin(up, 1)) * 180 / std::numbers::pi;
}

Motion lifting(const Vec3f& to, float seconds) { return {{{0}, {seconds, to}}}; }

/// A platform of 1 m x 1 m whose top is at y = 0.05 m.
BodyOptions platform() {
  BodyOptions options;
  options.name = "platform";
  options.kinematic = true;
  return options;
}
const std::vector<Solid> platform_solids{{.shape = Box{{0.5f, 0.05f, 0.5f}}}};

/// A platform, and a crate near its edge.
Object loaded(const BodyOptions& options) {
  Object lift = make_body(platform_solids, options);
  add_body(lift, {{.shape = Box{{0.1f, 0.1f, 0.1f}}}}, {.name = "crate", .position = {0.35f, 0.15f, 0}});
  lift.static_friction = lift.kinetic_friction = 0.8f;
  return lift;
}

/// The load rises with the platform, which stays level: where it is off the centre by 0.35 m, a pin that only moves
/// lets it tip off.
TEST(KinematicBody, LiftsALoadThatIsOffItsCentre) {
  Scene scene;
  BodyOptions options = platform();
  options.motion = lifting({0, 0.5f, 0}, 1);
  scene.add(loaded(options));
  World world(scene);
  for (int frame = 0; frame < 60; ++frame) {
    run(world, 1);
    ASSERT_LT(tilt_of(world.object(0).pose("platform")), 1e-3) << frame;
  }
  const RigidPose lift = world.object(0).pose("platform"), crate = world.object(0).pose("crate");
  EXPECT_NEAR(lift.position.y, 0.5, 1e-6);
  EXPECT_NEAR(crate.position.y, 0.65, 1e-3);
  EXPECT_NEAR(crate.position.x, 0.35, 1e-3);
  EXPECT_LT(tilt_of(crate), 1);
}

/// Friction accelerates the load at mu g until it has the velocity of the platform: it falls behind by v^2 / (2 mu g).
TEST(KinematicBody, CarriesALoadAlongByFriction) {
  Scene scene;
  BodyOptions options = platform();
  options.motion = lifting({1, 0, 0}, 1);
  Object lift = loaded(options);
  scene.add(lift);
  World world(scene);
  run(world, 50);
  const double moved = 50 / 60., behind = 1 / (2 * 0.8 * 9.81);
  EXPECT_NEAR(world.object(0).pose("crate").position.x - 0.35, moved - behind, 0.01);
  EXPECT_NEAR(world.object(0).velocities()[1].x, 1, 0.01);
}

/// By a pose for each frame it does what keyframes do.
TEST(KinematicBody, GoesWhereItIsSet) {
  Scene scene;
  BodyOptions options = platform();
  options.position = {0, 1, 0};
  options.rotation = rotation({0, 1, 0}, 30);
  Object lift = make_body({{Box{{0.1f, 0.2f, 0.3f}}, {0.5f, 0, 0}}}, options);
  scene.add(lift);
  World world(scene);
  const RigidPose wanted{{0.3f, 1.2f, -0.1f}, rotation({1, 2, 3}, 50)};
  world.object(0).set_pose("platform", wanted);
  for (int frame = 0; frame < 3; ++frame) {
    run(world, 1);
    const RigidPose pose = world.object(0).pose(0);
    EXPECT_LT(length_squared(pose.position - wanted.position), 1e-12f) << "it stays";
    const Quatf &p = pose.rotation, &q = wanted.rotation;
    EXPECT_NEAR(std::fabs(p.x * q.x + p.y * q.y + p.z * q.z + p.w * q.w), 1, 1e-6);
  }
  EXPECT_EQ(world.object(0).angular_velocities()[0], (Vec3f{}));
  EXPECT_EQ(world.object(0).velocities()[0], (Vec3f{}));
}

TEST(KinematicBody, CarriesWhatLiesOnItWhereItIsSet) {
  Scene scene;
  scene.add(loaded(platform()));
  World world(scene);
  for (int frame = 1; frame <= 60; ++frame) {
    world.object(0).set_pose(
        0, {{0, 0.5f * static_cast<float>(frame) / 60, 0}, rotation({0, 1, 0}, 1.5f * static_cast<float>(frame))});
    run(world, 1);
  }
  const RigidPose crate = world.object(0).pose("crate");
  EXPECT_NEAR(crate.position.y, 0.65, 1e-3);
  EXPECT_NEAR(crate.position.z, -0.35, 0.03) << "it was carried round by a quarter of a turn";
  EXPECT_LT(tilt_of(crate), 1);
}

/// Joints, cloth and grains: all are carried, and none moves it.
TEST(KinematicBody, TakesAlongWhatIsJointedToIt) {
  Scene scene;
  BodyOptions options = platform();
  options.motion = lifting({0, 0.5f, 0}, 1);
  Object crane = make_body(platform_solids, options);
  const int bob = add_body(crane, {{.shape = Sphere{0.1f}}}, {.position = {0, -0.5f, 0}});
  add_joint(crane, BallJoint{.a = 0, .b = bob, .anchor = {0, 0, 0}});
  scene.add(crane);
  World world(scene);
  run(world, 60);
  EXPECT_NEAR(world.object(0).pose(bob).position.y, 0, 1e-3);
  EXPECT_NEAR(world.object(0).pose(0).position.y, 0.5, 1e-6);
}

TEST(KinematicBody, CarriesClothAndGrains) {
  Scene scene;
  BodyOptions options = platform();
  options.motion = lifting({0, 0.25f, 0}, 0.5f);
  scene.add(make_body(platform_solids, options));
  TriangleMesh sheet = grid_mesh(6, 6, 0.3f, 0.3f);
  for (Vec3f& p : sheet.positions) p += Vec3f{-0.2f, 0.055f, 0};
  Object cloth = make_cloth(sheet);
  cloth.collides = true;
  scene.add(cloth);
  scene.add(make_grains({{0.3f, 0.08f, 0}}, {.grains = {.radius = 0.02f}}));
  World world(scene);
  run(world, 30);
  EXPECT_NEAR(world.object(0).pose(0).position.y, 0.25, 1e-6);
  for (const Vec3f& p : world.object(1).positions()) {
    EXPECT_GT(p.y, 0.29f);
    EXPECT_LT(p.y, 0.31f);
  }
  EXPECT_NEAR(world.object(2).positions()[0].y, 0.3 + 0.02, 5e-3);
}

TEST(KinematicBody, WakesWhatSleepsOnItWhenItIsSet) {
  Scene scene;
  scene.settings.sleep.on = true;
  scene.settings.sleep.time = 0.1f;
  scene.add(loaded(platform()));
  World world(scene);
  run(world, 30);
  ASSERT_TRUE(world.object(0).body_is_asleep(1));
  world.object(0).set_pose(0, {{0, -0.05f, 0}, {}});
  run(world, 30);
  EXPECT_NEAR(world.object(0).pose(1).position.y, 0.1, 1e-3);
}

/// With keyframes and with poses set, also where the last pose was set in the step before.
TEST(KinematicBody, GoesOnAfterARestoreWithTheSameBits) {
  Scene scene;
  scene.add(loaded(platform()));
  BodyOptions other = platform();
  other.position = {3, 0, 0};
  other.motion = lifting({0, 0.5f, 0.2f}, 1);
  scene.add(loaded(other));
  World world(scene), resumed(scene);
  for (int frame = 1; frame <= 10; ++frame) {
    world.object(0).set_pose(
        0, {{0, 0.01f * static_cast<float>(frame), 0}, rotation({0, 1, 0}, static_cast<float>(frame))});
    run(world, 1);
  }
  resumed.restore(world.state());
  run(world, 10);
  run(resumed, 10);
  EXPECT_EQ(world.state_hash(), resumed.state_hash());
}

TEST(KinematicBody, RefusesPosesThatItCannotHave) {
  Scene scene;
  Object lift = loaded(platform());
  lift.name = "lift";
  scene.add(lift);
  World world(scene);
  const auto said = [&](const auto& body, const RigidPose& pose) {
    return refusal([&] { world.object(0).set_pose(body, pose); });
  };
  EXPECT_NE(said(1, {}).find("object 'lift', body 1 'crate': is dynamic, so its pose cannot be set"),
            std::string::npos);
  EXPECT_NE(said("crate", {}).find("\"kinematic\": true"), std::string::npos);
  EXPECT_NE(said(2, {}).find("body 2: does not exist"), std::string::npos);
  EXPECT_NE(said("wing", {}).find("body 'wing': does not exist"), std::string::npos);
  EXPECT_NE(said(0, {{0, NAN, 0}, {}}).find("body 0 'platform': its pose is not finite"), std::string::npos);
  EXPECT_NE(said(0, {{}, {0, 0, 0, 0}}).find("its rotation is zero"), std::string::npos);
  EXPECT_NE(refusal([] {
              (void)make_body(platform_solids, {.name = "lift", .motion = lifting({0, 1, 0}, 1)});
            }).find("lift', motion: is given to a body that is not kinematic"),
            std::string::npos);
}

}  // namespace
}  // namespace pliant
