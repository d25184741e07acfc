// Tests contact of particles with colliders in a World: rest, shots, friction, bounces, overlaps, and moving colliders.
// Expected values are those of a point on a rigid surface.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "collision/fields/collider_pose.h"
#include "geometry/shapes.h"
#include "math/vector.h"
#include "support/scenes.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using namespace testing_support;

constexpr float earth_gravity = 9.81f;

double distance_to(const Collider& collider, double time, const Vec3f& point) {
  const Vec3d local = to_local(collider_pose(collider, time), convert<double>(point));
  return signed_distance(local_shape(collider.shape), local).distance;
}

Collider without_friction(const Shape& shape) {
  Collider collider;
  collider.shape = shape;
  collider.static_friction = collider.kinetic_friction = 0;
  return collider;
}

// ------------------------------------------------------------------------------------------------ rest

struct NamedShape {
  std::string name;
  Shape shape;
  float top;  ///< height of the shape above its centre [m]
};
void PrintTo(const NamedShape& named, std::ostream* out) { *out << named.name; }

class OnEachShape : public testing::TestWithParam<NamedShape> {};
INSTANTIATE_TEST_SUITE_P(Shapes, OnEachShape,
                         testing::Values(NamedShape{"plane", Plane{}, 0}, NamedShape{"sphere", Sphere{0.5f}, 0.5f},
                                         NamedShape{"capsule", Capsule{0.2f, 0.3f}, 0.5f},
                                         NamedShape{"box", Box{{0.5f, 0.25f, 0.5f}}, 0.25f}),
                         [](const auto& named) { return named.param.name; });

TEST_P(OnEachShape, AParticleRestsAtTheThickness) {
  for (int substeps : {1, 4, 20}) {
    Scene scene;
    Collider collider;
    collider.shape = GetParam().shape;
    collider.position = {0.5f, 0.125f, -1};
    collider.thickness = 0.002f;
    scene.add(collider);
    Object object = loose_particles({{0.5f, 0.125f + GetParam().top + 0.2f, -1}});
    object.thickness = 0.003f;
    scene.add(object);
    World world(scene, settings_of(substeps));
    for (int frame = 0; frame < 90; ++frame) {
      const Report report = world.step(dt);
      EXPECT_GT(distance_to(collider, world.state().time, world.object(0).positions()[0]), 0.005 - 2e-6)
          << "frame " << frame;
      EXPECT_TRUE(frame < 60 || report.contacts == 1) << "frame " << frame;
    }
    EXPECT_NEAR(distance_to(collider, 0, world.object(0).positions()[0]), 0.005, 2e-6) << substeps << " substeps";
    const Vec3f v = world.object(0).velocities()[0];
    EXPECT_LT(length(v), 1e-4f);
  }
}

TEST_P(OnEachShape, AnOverlapSeparatesNoFasterThanTheCap) {
  Scene scene;
  scene.gravity = {};
  Collider collider = without_friction(GetParam().shape);
  scene.add(collider);
  std::vector<Vec3f> inside;
  std::mt19937 random(3);
  for (int i = 0; i < 60; ++i) {
    const auto coordinate = [&] { return static_cast<float>(random() % 2000) * 1e-4f - 0.1f; };
    inside.push_back({coordinate(), coordinate() - 0.11f, coordinate()});
  }
  scene.add(loose_particles(inside));
  World world(scene, settings_of(10));
  for (int frame = 0; frame < 60; ++frame) {
    ASSERT_TRUE(world.step(dt).ok());
    for (const Vec3f& v : world.object(0).velocities()) EXPECT_LE(length(v), 2.01f) << "frame " << frame;
  }
  for (const Vec3f& p : world.object(0).positions()) EXPECT_GT(distance_to(collider, 0, p), 0.001 - 2e-6);
}

// ------------------------------------------------------------------------------------------------ shots

struct Shots {
  std::vector<Vec3f> from, velocity;
};

/// Particles shot at 1 to 1000 m/s at points near the centre of a collider, which itself moves at `carried`; they come
/// from above, within 40 degrees of the vertical.
Shots shots_at(const Vec3f& centre, const Vec3f& carried, float spread, int count) {
  std::mt19937 random(1);
  const auto uniform = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(random()) / 4294967295.0;
  };
  Shots shots;
  for (int i = 0; i < count; ++i) {
    const double speed = std::pow(10.0, uniform(0, 3)), away = std::min(10.0, speed * uniform(0.05, 0.15)) + 0.5;
    const double tilt = uniform(0, 0.7), turn = uniform(0, 6.28);
    const Vec3f direction =
        convert<float>(Vec3d{std::sin(tilt) * std::cos(turn), -std::cos(tilt), std::sin(tilt) * std::sin(turn)});
    const Vec3f target =
        centre + Vec3f{static_cast<float>(uniform(-spread, spread)), 0, static_cast<float>(uniform(-spread, spread))};
    shots.from.push_back(target - direction * static_cast<float>(away));
    shots.velocity.push_back(direction * static_cast<float>(speed) + carried);
  }
  return shots;
}

/// Counts the shots that are inside the collider after some frame, or that continue as if it were not there.
int passed_through(const Collider& collider, const Vec3f& carried, float spread, int substeps, float thickness) {
  const Shots shots = shots_at(collider.position, carried, spread, 1000);
  Scene scene;
  scene.gravity = {};
  scene.add(collider);
  Object object = loose_particles(shots.from, shots.velocity);
  object.static_friction = object.kinetic_friction = 0;
  object.thickness = thickness;
  scene.add(object);
  World world(scene, settings_of(substeps));
  std::vector<char> bad(shots.from.size(), 0);
  for (int frame = 0; frame < 45; ++frame) {  // the slowest shots need 0.65 s
    EXPECT_TRUE(world.step(dt).ok());
    const std::vector<Vec3f> now = world.object(0).positions();
    for (std::size_t i = 0; i < now.size(); ++i) {
      // At 20 m from the origin, a float has an error of 2e-6 m.
      if (distance_to(collider, world.state().time, now[i]) < -1e-5) bad[i] = 1;
    }
  }
  const std::vector<Vec3f> after = world.object(0).velocities();
  for (std::size_t i = 0; i < after.size(); ++i) {
    // The normal velocity of a stopped shot vanishes, so along its own direction it keeps at most sin^2 of its angle to
    // the normal: under 0.8.
    const Vec3f before = shots.velocity[i] - carried, left = after[i] - carried;
    if (dot(before, left) > 0.9f * dot(before, before)) bad[i] = 1;
  }
  int count = 0;
  for (char b : bad) count += b;
  return count;
}

struct TargetShape {
  std::string name;
  Shape shape;
  float spread;
};
const std::vector<TargetShape>& targets() {
  static const std::vector<TargetShape> all{{"box", Box{{0.5f, 0.005f, 0.5f}}, 0.2f},
                                            {"small sphere", Sphere{0.005f}, 0.002f},
                                            {"sphere", Sphere{0.3f}, 0.1f},
                                            {"capsule", Capsule{0.005f, 0.3f}, 0.002f},
                                            {"plane", Plane{}, 1.f}};
  return all;
}

TEST(Shots, NoneGoesThroughWhatStandsStill) {
  for (const TargetShape& target : targets()) {
    Collider collider = without_friction(target.shape);
    collider.position = {0.3f, 0.2f, -0.1f};
    if (target.name == "capsule") collider.rotation = rotation({0, 0, 1}, 90);
    for (int substeps : {1, 3, 20}) {
      for (float thickness : {0.f, 0.001f, 0.01f}) {
        EXPECT_EQ(passed_through(collider, {}, target.spread, substeps, thickness), 0)
            << target.name << ", " << substeps << " substeps, " << thickness << " m thick";
      }
    }
  }
}

TEST(Shots, NoneGoesThroughWhatMoves) {
  for (const TargetShape& target : targets()) {
    if (target.name == "plane") continue;
    for (const Vec3f& carried : {Vec3f{0, 20, 0}, Vec3f{15, 0, 0}, Vec3f{-5, -8, 3}}) {
      Collider collider = without_friction(target.shape);
      if (target.name == "capsule") collider.rotation = rotation({0, 0, 1}, 90);
      collider.motion = straight(carried * 2.f, 2);
      for (int substeps : {1, 4}) {
        EXPECT_EQ(passed_through(collider, carried, target.spread, substeps, 0.001f), 0)
            << target.name << ", " << substeps << " substeps";
      }
    }
  }
}

TEST(Shots, NoneGoesThroughFromWithinTheThickness) {
  // A particle pressed on a thin plate is a little deeper than the thickness. From there it must not pass through the
  // plate either.
  for (float above : {0.f, 1e-5f, 0.0003f, 0.0007f, 0.001f}) {
    Scene scene;
    scene.gravity = {};
    const Collider plate = without_friction(Box{{0.5f, 0.005f, 0.5f}});
    scene.add(plate);
    scene.add(loose_particles({{0, 0.005f + above, 0}}, {{0, -100, 0}}));
    World world(scene, settings_of(2));
    for (int frame = 0; frame < 5; ++frame) {
      world.step(dt);
      EXPECT_GT(world.object(0).positions()[0].y, 0.004f) << above << " m above, frame " << frame;
    }
  }
}

/// Constraints of a landing balloon move particles below the ground that had no predicted contact. They must not stay
/// there.
TEST(Landing, OfABalloonNeverDipsBelowTheGround) {
  ClothOptions options;
  options.material = fabric("rubber sheet");
  options.volume = Volume{};
  TriangleMesh ball = sphere_mesh(4);
  for (Vec3f& p : ball.positions) p = p * 0.2f + Vec3f{0, 2.2f, 0};
  Scene scene;
  scene.settings = settings_of(1);
  Object balloon = make_cloth(ball, options);
  balloon.thickness = 0;
  scene.add(balloon);
  scene.add(Collider{});
  World world(scene);
  float lowest = 1;
  for (int substep = 0; substep < 4 * 120; ++substep) {  // four substeps per frame
    world.step(dt / 4);
    for (const Vec3f& p : world.object(0).positions()) lowest = std::min(lowest, p.y);
  }
  EXPECT_GT(lowest, -1e-6f);
}

// ------------------------------------------------------------------------------------------------ friction and bounce

/// A ramp that falls by `degrees` along +x, and a particle that lies on it.
Scene ramp(float degrees, float static_friction, float kinetic_friction) {
  Scene scene;
  Collider plane;
  plane.rotation = rotation({0, 0, 1}, -degrees);
  plane.static_friction = static_friction;
  plane.kinetic_friction = kinetic_friction;
  scene.add(plane);
  const double angle = degrees * 3.14159265358979 / 180;
  const Vec3d normal{std::sin(angle), std::cos(angle), 0};
  Object object = loose_particles({convert<float>(normal * 0.001)});
  object.static_friction = static_friction;
  object.kinetic_friction = kinetic_friction;
  scene.add(object);
  return scene;
}

TEST(Friction, SticksBelowItsAngleAndSlipsAbove) {
  const float mu = 0.5f;  // the friction angle is 26.565 degrees
  for (int substeps : {1, 10, 20}) {
    World below(ramp(25.6f, mu, mu), settings_of(substeps)), above(ramp(27.5f, mu, mu), settings_of(substeps));
    for (int frame = 0; frame < 120; ++frame) {
      below.step(dt);
      above.step(dt);
    }
    EXPECT_LT(length(below.object(0).positions()[0]), 0.002f) << substeps;
    EXPECT_GT(length(above.object(0).positions()[0]), 0.05f) << substeps;
  }
}

TEST(Friction, SlidesWithWhatGravityLeaves) {
  World world(ramp(40, 0.4f, 0.3f), settings_of(20));
  for (int frame = 0; frame < 60; ++frame) world.step(dt);
  const double angle = 40 * 3.14159265358979 / 180,
               acceleration = earth_gravity * (std::sin(angle) - 0.3 * std::cos(angle));
  EXPECT_NEAR(length(world.object(0).velocities()[0]), acceleration * 1.0, 0.01 * acceleration);
  EXPECT_NEAR(length(world.object(0).positions()[0]), 0.5 * acceleration, 0.01 * acceleration);
}

TEST(Friction, StopsAfterItsDistance) {
  for (float mu : {0.2f, 0.7f}) {
    for (int substeps : {5, 20}) {
      Scene scene = ramp(0, mu, mu);
      scene.objects[0].velocities = {{3, 0, 0}};
      World world(scene, settings_of(substeps));
      for (int frame = 0; frame < 180; ++frame) world.step(dt);
      const float expected = 9 / (2 * mu * earth_gravity);
      EXPECT_NEAR(world.object(0).positions()[0].x, expected, 0.01f * expected)
          << mu << ", " << substeps << " substeps";
      EXPECT_LT(length(world.object(0).velocities()[0]), 1e-4f);
    }
  }
}

TEST(Friction, IsTheGeometricMeanOfBothSides) {
  Scene scene = ramp(0, 0.9f, 0.9f);
  scene.colliders[0].static_friction = scene.colliders[0].kinetic_friction = 0.1f;
  scene.objects[0].velocities = {{3, 0, 0}};
  World world(scene, settings_of(20));
  for (int frame = 0; frame < 180; ++frame) world.step(dt);
  const float expected = 9 / (2 * 0.3f * earth_gravity);
  EXPECT_NEAR(world.object(0).positions()[0].x, expected, 0.01f * expected);
}

TEST(Restitution, ReturnsTheSquareOfTheHeight) {
  for (float e : {0.5f, 0.8f, 1.f}) {
    Scene scene;
    scene.add(Collider{});
    Object object = loose_particles({{0, 1.001f, 0}});
    object.restitution = e;
    scene.add(object);
    World world(scene, settings_of(20));
    double apex = 0;
    bool bounced = false;
    for (int frame = 0; frame < 70; ++frame) {
      world.step(dt);
      const double v = world.object(0).velocities()[0].y, h = world.object(0).positions()[0].y - 0.001;
      bounced = bounced || v > 0;
      if (bounced && v > 0) apex = std::max(apex, h + v * v / (2 * earth_gravity));
    }
    EXPECT_NEAR(apex, e * e, 0.01 * e * e) << "restitution " << e;
  }
}

TEST(Restitution, IsTheLargerOfBothSides) {
  Scene scene;
  Collider plane;
  plane.restitution = 0.8f;
  scene.add(plane);
  scene.add(loose_particles({{0, 0.5f, 0}}));
  World world(scene, settings_of(20));
  double fastest = 0;
  for (int frame = 0; frame < 40; ++frame) {
    world.step(dt);
    fastest = std::max(fastest, static_cast<double>(world.object(0).velocities()[0].y));
  }
  EXPECT_NEAR(fastest, 0.8 * std::sqrt(2 * earth_gravity * 0.499), 0.2);
}

// ------------------------------------------------------------------------------------------------ colliders that move

TEST(MovingCollider, LiftsWhatLiesOnIt) {
  Scene scene;
  Collider lift;
  lift.shape = Box{{1, 0.1f, 1}};
  lift.motion = straight({0, 2, 0}, 2);
  scene.add(lift);
  scene.add(loose_particles({{0.2f, 0.101f, 0.1f}}));
  World world(scene, settings_of(10));
  for (int frame = 0; frame < 60; ++frame) world.step(dt);
  EXPECT_NEAR(world.collider(0).pose().position.y, 1, 1e-5);
  EXPECT_NEAR(world.object(0).positions()[0].y, 1.101, 1e-5);
  EXPECT_NEAR(world.object(0).velocities()[0].y, 1, 1e-3);
  for (int frame = 0; frame < 90; ++frame) world.step(dt);
  EXPECT_NEAR(world.object(0).positions()[0].y, 2.101, 1e-5) << "and stays when it stops";
}

TEST(MovingCollider, PushesWhatIsInItsWay) {
  Scene scene;
  scene.gravity = {};
  Collider piston = without_friction(Box{{0.1f, 1, 1}});
  piston.motion = straight({6, 0, 0}, 2);
  scene.add(piston);
  scene.add(loose_particles({{0.5f, 0.3f, 0.2f}}));
  World world(scene, settings_of(10));
  for (int frame = 0; frame < 60; ++frame) world.step(dt);
  EXPECT_NEAR(world.object(0).positions()[0].x, 3.101, 1e-4);
  EXPECT_NEAR(world.object(0).velocities()[0].x, 3, 1e-3);
}

TEST(MovingCollider, CarriesByFrictionLikeAConveyor) {
  Scene scene;
  Collider belt;
  belt.shape = Box{{20, 0.1f, 1}};
  belt.motion = straight({10, 0, 0}, 10);  // moves at 1 m/s
  belt.static_friction = belt.kinetic_friction = 0.1f;
  scene.add(belt);
  Object object = loose_particles({{0, 0.101f, 0}});
  object.static_friction = object.kinetic_friction = 0.1f;
  scene.add(object);
  World world(scene, settings_of(20));
  for (int frame = 0; frame < 30; ++frame) world.step(dt);
  EXPECT_NEAR(world.object(0).velocities()[0].x, 0.1 * earth_gravity * 0.5, 0.01) << "speeding up at mu g";
  for (int frame = 0; frame < 60; ++frame) world.step(dt);
  EXPECT_NEAR(world.object(0).velocities()[0].x, 1, 1e-3) << "and then as fast as the belt";
}

TEST(MovingCollider, TurnsWhatLiesOnIt) {
  Scene scene;
  Collider table;
  table.shape = Box{{1, 0.1f, 1}};
  table.static_friction = table.kinetic_friction = 1;
  for (int i = 0; i <= 8; ++i)
    table.motion.keyframes.push_back(
        {0.25f * static_cast<float>(i), {}, rotation({0, 1, 0}, 22.5f * static_cast<float>(i))});
  scene.add(table);
  Object object = loose_particles({{0.5f, 0.101f, 0}}, {{0, 0, -0.785f}});
  object.static_friction = object.kinetic_friction = 1;
  scene.add(object);
  World world(scene, settings_of(20));
  for (int frame = 0; frame < 60; ++frame) world.step(dt);  // rotates by a right angle
  const Vec3f p = world.object(0).positions()[0];
  EXPECT_NEAR(std::hypot(p.x, p.z), 0.5, 0.01);
  EXPECT_NEAR(p.x, 0, 0.02);
  EXPECT_NEAR(p.z, -0.5, 0.02);
}

}  // namespace
}  // namespace pliant
