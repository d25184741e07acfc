// Tests the guard of energy of rigid bodies on cloth: it holds for an island of bodies, and for nothing else.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "pliant/body.h"
#include "pliant/joint.h"
#include "pliant/mesh.h"
#include "pliant/world.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using testing_support::dt;
using testing_support::floor_at;

constexpr float start_height = 0.6f;  ///< height of the ball above the sheet [m]

/// A sheet that cannot stretch, with 7 % of slack inside its pinned border, about a place.
Object slack_sheet(const Vec3f& place) {
  constexpr float side = 1.2f;
  ClothOptions options;
  options.stretch = Stiffness{};
  Object cloth = make_cloth(grid_mesh(25, 25, side, side), options);
  Vec3f centre{};
  for (const Vec3f& p : cloth.positions) centre += p * (1.f / static_cast<float>(cloth.positions.size()));
  cloth.collides = true;
  cloth.thickness = 0.01f;
  for (std::size_t i = 0; i < cloth.positions.size(); ++i) {
    const Vec3f local{cloth.positions[i].x - centre.x, 0, cloth.positions[i].z - centre.z};
    if (std::max(std::fabs(local.x), std::fabs(local.z)) > 0.499f * side)
      cloth.pins.push_back({static_cast<int>(i), {}});
    cloth.positions[i] = place + local * 0.93f;
  }
  return cloth;
}

int add_moving_body(Object& object, const SolidShape& shape, const Vec3f& position, const Vec3f& velocity = {}) {
  BodyOptions options;
  options.position = position;
  options.velocity = velocity;
  options.mass = 1;
  return add_body(object, {{shape}}, options);
}

Scene guarded_scene(const std::vector<Object>& objects) {
  Scene scene;
  scene.settings.substeps = 40;  // the same with cloth and without
  for (const Object& object : objects) scene.add(object);
  return scene;
}

/// The path of particle `particle` of object `object`.
std::vector<Vec3f> path(const Scene& scene, int object, int particle, int frames = 90) {
  World world(scene);
  std::vector<Vec3f> out;
  for (int frame = 0; frame < frames; ++frame) {
    EXPECT_TRUE(world.step(dt).ok());
    out.push_back(world.object(object).positions()[static_cast<std::size_t>(particle)]);
  }
  return out;
}

/// By how much a body rises after its lowest place above where it ends [m].
float rebound(const std::vector<Vec3f>& heights) {
  float lowest = heights.front().y, highest = lowest;
  for (const Vec3f& p : heights) {
    if (p.y < lowest) lowest = highest = p.y;
    highest = std::max(highest, p.y);
  }
  return highest - heights.back().y;
}

/// The fall is plastic (BodyPoints.AHeavyBallDoesNotBounceOnAnInextensibleSheet): a tenth of it is left.
constexpr float plastic = 0.1f * start_height;

bool are_equal(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Vec3f& x, const Vec3f& y) { return x.x == y.x && x.y == y.y && x.z == y.z; });
}

/// A ball that falls on cloth and a slider far away are bodies of one object.
TEST(BodyGuard, ASliderFarAwayGoesAsFarAsWithoutTheCloth) {
  Object bodies;
  bodies.static_friction = bodies.kinetic_friction = 0.3f;
  bodies.collides = bodies.self_collision = true;
  add_moving_body(bodies, Sphere{.15f}, {0.02f, start_height, 0.01f});
  const int slider = add_moving_body(bodies, Box{{.2f, .1f, .2f}}, {20, -2.9f, 0}, {4, 0, 1});
  Scene with = guarded_scene({slack_sheet({}), bodies}), without = guarded_scene({bodies});
  for (Scene* scene : {&with, &without}) scene->colliders.push_back(floor_at(-3));
  const auto particle = bodies.bodies[static_cast<std::size_t>(slider)].particle;
  const std::vector<Vec3f> beside_cloth = path(with, 1, particle);
  EXPECT_GT(beside_cloth.back().x, 21.f);
  EXPECT_TRUE(are_equal(beside_cloth, path(without, 0, particle)));
  EXPECT_LT(rebound(path(with, 1, 0)), plastic) << "the ball is guarded";
}

/// A platform goes up and down far away from the cloth.
TEST(BodyGuard, AMovingPlatformElsewhereChangesNothing) {
  Object ball;
  ball.collides = true;
  add_moving_body(ball, Sphere{.15f}, {0.02f, start_height, 0.01f});
  Scene without = guarded_scene({slack_sheet({}), ball}), with = without;
  Collider platform;
  platform.shape = Box{{1, 0.1f, 1}};
  platform.position = {10, 0, 0};
  platform.motion.keyframes = {{0, {}}, {0.5f, {0, 1, 0}}, {1.5f, {}}};
  with.colliders.push_back(platform);
  const std::vector<Vec3f> alone = path(without, 1, 0);
  EXPECT_LT(rebound(alone), plastic);
  EXPECT_TRUE(are_equal(path(with, 1, 0), alone));
}

/// A hinge with a motor holds two other bodies of the ball's object.
TEST(BodyGuard, AMotorElsewhereInTheObjectChangesNothing) {
  Object ball;
  ball.collides = ball.self_collision = true;
  add_moving_body(ball, Sphere{.15f}, {0.02f, start_height, 0.01f});
  Object more = ball;
  BodyOptions fixed;
  fixed.position = {10, 0, 0};
  fixed.mass = std::numeric_limits<float>::infinity();
  const int base = add_body(more, {{Box{{.1f, .1f, .1f}}}}, fixed);
  const int arm = add_moving_body(more, Box{{.5f, .05f, .05f}}, {10.6f, 0, 0});
  HingeJoint hinge;
  hinge.a = base;
  hinge.b = arm;
  hinge.anchor = {10, 0, 0};
  hinge.axis = {0, 0, 1};
  hinge.motor = JointMotor{JointMotor::Kind::speed, 5, 50};
  add_joint(more, hinge);
  const std::vector<Vec3f> alone = path(guarded_scene({slack_sheet({}), ball}), 1, 0);
  EXPECT_LT(rebound(alone), plastic);
  EXPECT_TRUE(are_equal(path(guarded_scene({slack_sheet({}), more}), 1, 0), alone));
}

/// Two balls that a rigid joint connects: the joint does no work, so they do not bounce either.
TEST(BodyGuard, BodiesThatARigidJointConnectsDoNotBounce) {
  Object pair;
  pair.collides = pair.self_collision = true;
  FixedJoint joint;
  joint.a = add_moving_body(pair, Sphere{.1f}, {-0.1f, start_height, 0.01f});
  joint.b = add_moving_body(pair, Sphere{.1f}, {0.1f, start_height, 0.01f});
  joint.anchor = {0, start_height, 0.01f};
  add_joint(pair, joint);
  EXPECT_LT(rebound(path(guarded_scene({slack_sheet({}), pair}), 1, 0)), plastic);
}

/// A ball that falls twice as far on another sheet is an island of its own.
TEST(BodyGuard, TwoSheetsAreTwoIslands) {
  Object balls;
  balls.collides = balls.self_collision = true;
  add_moving_body(balls, Sphere{.15f}, {0.02f, start_height, 0.01f});
  Object both = balls;
  add_moving_body(both, Sphere{.15f}, {10.03f, 2 * start_height, 0.05f});
  const std::vector<Vec3f> alone = path(guarded_scene({slack_sheet({}), balls}), 1, 0);
  EXPECT_TRUE(are_equal(path(guarded_scene({slack_sheet({}), both, slack_sheet({10, 0, 0})}), 1, 0), alone));
}

/// A motor of the island lifts a ball off a plate that lies on the sheet, at 2 m/s: it does work, so the guard may not
/// hold the ball back. In 0.5 s it rises by 1 m; a tenth is left for the start and for the plate, which is pressed
/// down.
TEST(BodyGuard, AMotorOfTheIslandDoesWork) {
  Object lift;
  lift.collides = lift.self_collision = true;
  SliderJoint slider;
  slider.a = add_moving_body(lift, Box{{.3f, .02f, .3f}}, {0, 0.04f, 0});
  slider.b = add_moving_body(lift, Sphere{.1f}, {0, 0.3f, 0});
  slider.anchor = {0, 0.3f, 0};
  slider.axis = {0, 1, 0};
  slider.motor = JointMotor{JointMotor::Kind::speed, 2, 200};
  add_joint(lift, slider);
  const Scene scene = guarded_scene({slack_sheet({}), lift});
  const float ball = path(scene, 1, 1, 30).back().y, plate = path(scene, 1, 0, 30).back().y;
  EXPECT_GT(ball - plate, 0.26f + 0.9f);
}

}  // namespace
}  // namespace pliant
