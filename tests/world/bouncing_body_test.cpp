// Tests bodies that bounce without loss: none rises higher than it was let go from, in any number of bounces.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "math/quat.h"
#include "math/vector.h"
#include "pliant/body.h"
#include "pliant/mesh.h"
#include "pliant/random.h"
#include "pliant/world.h"

namespace pliant {
namespace {

/// The highest place of a solid's centre in the last five of thirty seconds, let go from rest at a metre [m].
float highest_after_bounces(const SolidShape& shape, const Quatf& rotation, int substeps) {
  BodyOptions options;
  options.position = {0, 1, 0};
  options.rotation = rotation;
  Object object = make_body({{shape}}, options);
  object.restitution = 1;
  object.static_friction = object.kinetic_friction = 0;
  Scene scene;
  scene.colliders.emplace_back();
  scene.settings.threads = 1;
  scene.settings.substeps = substeps;
  scene.add(object);
  World world(scene);
  float highest = 0;
  for (int frame = 0; frame < 1800; ++frame) {
    EXPECT_TRUE(world.step(1.f / 60).ok());
    if (frame >= 1500) highest = std::max(highest, world.object(0).positions()[0].y);
  }
  return highest;
}

/// A ball of restitution 1 keeps its height within what it falls in the last substep before it turns back.
TEST(BouncingBody, ABallKeepsItsHeight) {
  for (const int substeps : {4, 8, 32}) {
    const float height = highest_after_bounces(Sphere{0.1f}, {}, substeps);
    EXPECT_NEAR(height, 1, 0.02) << substeps << " substeps";
    EXPECT_LT(height, 1.005f) << substeps << " substeps";
  }
}

/// A rod that falls flat was thrown to 5.6 m.
TEST(BouncingBody, ARodThatFallsFlatRisesNoHigher) {
  const float half = std::sqrt(0.5f);
  EXPECT_LT(highest_after_bounces(Capsule{0.01f, 0.3f}, {0, 0, half, half}, 0), 1.02f);
}

/// Friction of an impact lets a ball leave rolling, with 3 (1 - 1 / (1 + 2.5 k^2)) of its 3 m/s, k r being the arm of
/// friction: 15/7 at its surface. Impacts are found up to half a frame's way ahead, between both surfaces, so k may be
/// as much as 1.37.
TEST(BouncingBody, ABallBouncesWithFriction) {
  Scene scene;
  scene.add(Collider{});
  scene.colliders[0].static_friction = scene.colliders[0].kinetic_friction = 0.2f;
  BodyOptions options;
  options.position = {0, 1, 0};
  options.velocity = {3, 0, 0};
  Object ball = make_body({{Sphere{0.1f}}}, options);
  ball.static_friction = ball.kinetic_friction = 0.2f;
  ball.restitution = 0.8f;
  scene.add(ball);
  World world(scene);
  for (int frame = 0; frame < 40; ++frame) ASSERT_TRUE(world.step(1.f / 60).ok());
  EXPECT_GT(world.object(0).velocities()[0].x, 2.13f);
  EXPECT_LT(world.object(0).velocities()[0].x, 2.47f);
  EXPECT_LT(world.state().frames.angular_velocities[0].z, -15);
}

/// A ball that hits another one off its middle sends it along the line of centres: sin = offset / diameter (20.9
/// degrees).
TEST(BouncingBody, ABallIsSentAlongTheLineOfCentres) {
  for (const float speed : {1.f, 2.f}) {
    Scene scene;
    scene.gravity = {0, 0, 0};
    Object balls;
    balls.restitution = 1;
    balls.static_friction = balls.kinetic_friction = 0;
    BodyOptions options;
    add_body(balls, {{Sphere{0.028f}}}, options);
    options.position = {-0.5f, 0, 0.02f};
    options.velocity = {speed, 0, 0};
    options.name = "cue";
    add_body(balls, {{Sphere{0.028f}}}, options);
    scene.add(balls);
    World world(scene);
    for (int frame = 0; frame < 60; ++frame) ASSERT_TRUE(world.step(1.f / 60).ok());
    const Vec3f v = world.object(0).velocities()[0];
    EXPECT_NEAR(std::atan2(-v.z, v.x) * 57.29578f, 20.9f, 1.5f)
        << speed;  // within 0.1 of the radius (far_moved) and a substep's way
  }
}

// ------------------------------------------------------------------------------------------------ random bodies

constexpr double gravity_on_bouncers = 9.81;  // [m/s^2]

int number_below(Random& random, int end) {
  return std::min(static_cast<int>(random.next() * static_cast<float>(end)), end - 1);
}

/// The hull of points on a sphere.
Hull random_hull(Random& random, int corners, float radius) {
  Hull hull;
  hull.points.reserve(static_cast<std::size_t>(corners));
  for (int i = 0; i < corners; ++i) hull.points.push_back(rotate(random.rotation(), {0, radius, 0}));
  return hull;
}

struct Bouncer {
  std::string what;
  std::vector<Solid> solids;
};

/// A box, a hull of 4 to 162 corners, a cylinder, a capsule, or two solids that are one body.
Bouncer random_bouncer(Random& random, int kind) {
  const float size = random.between(0.05f, 0.4f);
  const auto length = [&] { return size * random.between(0.2f, 1); };
  const auto beside = [&] { return Vec3f{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)} * size; };
  const auto box = [&] { return Box{{length(), length(), length()}}; };
  switch (kind) {
    case 0:
      return {"a box", {{box()}}};
    case 1:
      return {"a cube", {{Box{{size, size, size}}}}};
    case 2:
      return {"a hull of few corners", {{random_hull(random, 4 + number_below(random, 9), size)}}};
    case 3:
      return {"a hull of many corners", {{random_hull(random, 13 + number_below(random, 150), size)}}};
    case 4:
      return {"a cylinder", {{Cylinder{length(), length()}}}};
    case 5:
      return {"a capsule", {{Capsule{length(), length()}}}};
    case 6:
      return {"two boxes", {{box()}, {box(), beside(), random.rotation()}}};
    default:
      return {"a ball with a cylinder",
              {{Sphere{length()}}, {Cylinder{length(), length()}, beside(), random.rotation()}}};
  }
}

constexpr int kinds_of_bouncers = 8, kinds_of_grounds = 4;

/// A flat grid of triangles about the origin.
MeshCollider flat_triangles(bool as_heightfield) {
  MeshCollider ground;
  ground.mesh = grid_mesh(21, 21, 14, 14);
  if (as_heightfield) ground.as = MeshCollider::As::heightfield;
  ground.static_friction = ground.kinetic_friction = 0;
  return ground;
}

/// Adds frictionless ground at y = 0: a plane, a box, a mesh or a heightfield.
std::string add_ground(Scene& scene, int kind) {
  if (kind >= 2) {
    scene.add(flat_triangles(kind == 3));
    return kind == 2 ? "a mesh" : "a heightfield";
  }
  Collider ground;
  ground.static_friction = ground.kinetic_friction = 0;
  if (kind == 1) {
    ground.shape = Box{{7, 1, 7}};
    ground.position = {0, -1, 0};
  }
  scene.add(ground);
  return kind == 1 ? "a box" : "a plane";
}

struct Bounces {
  std::string what;
  double gained = 0;  ///< most energy in relation to that at the start, less 1
  double lost = 0;    ///< 1 less what is left at the end
};

/// The energy of the only body of a World [J]. Velocities of symplectic Euler are those of half a substep earlier.
double energy_of_body(const World& world, const Object& body, double substep) {
  const Vec3f x = world.object(0).positions()[0], v = world.object(0).velocities()[0];
  const Vec3f inertia = body.frames[0].inertia;
  const Record w = world.state().frames.angular_velocities[0];
  const Vec3d velocity{double(v.x), double(v.y) - gravity_on_bouncers * substep / 2, double(v.z)};
  const double turning = double(inertia.x) * double(w.x) * double(w.x) + double(inertia.y) * double(w.y) * double(w.y) +
                         double(inertia.z) * double(w.z) * double(w.z);
  return double(body.masses[0]) * (gravity_on_bouncers * double(x.y) + 0.5 * dot(velocity, velocity)) + 0.5 * turning;
}

/// Drops a random body for some seconds: from 0.2 to 5 m, half of them with a spin.
Bounces random_bounces(int seed, double seconds) {
  Random random(seed);
  Scene scene;
  scene.gravity = {0, static_cast<float>(-gravity_on_bouncers), 0};
  Bounces out;
  const Bouncer bouncer = random_bouncer(random, seed % kinds_of_bouncers);
  out.what = bouncer.what + " on " + add_ground(scene, seed / kinds_of_bouncers % kinds_of_grounds);
  BodyOptions options;
  options.rotation = random.rotation();
  options.position = {random.between(-0.3f, 0.3f), random.between(0.2f, 5) + 0.8f, random.between(-0.3f, 0.3f)};
  if (random.next() < 0.5f) options.angular_velocity = rotate(random.rotation(), {0, random.between(1, 30), 0});
  Object body = make_body(bouncer.solids, options);
  body.restitution = 1;
  body.static_friction = body.kinetic_friction = 0;
  scene.add(body);
  const float frame_time = random.next() < 0.5f ? 1.f / 60 : random.between(1.f / 240, 1.f / 24);
  scene.settings.substeps = std::vector<int>{0, 4, 8, 16, 40}[static_cast<std::size_t>(number_below(random, 5))];
  scene.settings.threads = 1;
  out.what += ", frames of " + std::to_string(frame_time) + " s, " + std::to_string(scene.settings.substeps) +
              " substeps, seed " + std::to_string(seed);
  World world(scene);
  double start = 0, now = 0, most = 0;
  for (int frame = 0; frame < static_cast<int>(seconds / double(frame_time)); ++frame) {
    const Report report = world.step(frame_time);
    EXPECT_TRUE(report.ok()) << out.what;
    now = energy_of_body(world, body, double(frame_time) / report.substeps);
    if (frame == 0) start = now;
    most = std::max(most, now);
  }
  out.gained = most / start - 1;
  out.lost = 1 - now / start;
  return out;
}

/// How often 32 bodies are dropped, each time others.
int rounds_of_bounces() {
  const char* const wanted = std::getenv("PLIANT_BOUNCES");
  return wanted != nullptr ? std::max(std::atoi(wanted), 1) : 1;
}

/// An impulse that was computed with the spin of the substep's middle and added to that of its end brought up to 449 %.
TEST(BouncingBody, OfRandomShapeGainsNoEnergy) {
  const int bodies = kinds_of_bouncers * kinds_of_grounds * rounds_of_bounces();
  for (int seed = 0; seed < bodies; ++seed) {
    const Bounces bounces = random_bounces(seed, 20);
    EXPECT_LT(bounces.gained, 1e-3) << bounces.what;
  }
}

/// Those two of 1 280 gained 0.19 and 0.13 %: the lowest place of a rim was left out where others were less than 1 % of
/// the size higher, went in, and was pushed out in the next frame.
TEST(BouncingBody, ACylinderOnItsRimGainsNoEnergy) {
  for (const int seed : {1052, 1164}) {
    const Bounces bounces = random_bounces(seed, 20);
    EXPECT_LT(bounces.gained, 1e-3) << bounces.what;
  }
}

}  // namespace
}  // namespace pliant
