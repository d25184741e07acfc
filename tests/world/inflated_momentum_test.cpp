// Tests that inflated objects neither turn nor drift by themselves, and still roll, spin and bounce when pushed.
#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "math/vector.h"
#include "pliant/body.h"
#include "pliant/world.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using testing_support::dt;

constexpr float inflated_radius = 0.2f;

ClothOptions of_fabric(const char* name) {
  ClothOptions options;
  options.material = fabric(name);
  return options;
}

/// A material of 0.5 kg/m^2 in which waves of stretch have the given speed [m/s].
ClothOptions of_wave_speed(float speed) {
  ClothOptions options;
  options.material.area_density = 0.5f;
  options.material.stretch_stiffness = 0.5f * speed * speed;
  return options;
}

Object ball(ClothOptions options, float pressure, int subdivisions = 3) {
  options.name = "ball";
  options.volume = Volume{pressure, Stiffness::rigid()};
  TriangleMesh mesh = sphere_mesh(subdivisions);
  for (Vec3f& p : mesh.positions) p = p * inflated_radius;
  return make_cloth(mesh, options);
}

Object moving(Object object, const Vec3f& velocity, const Vec3f& spin) {
  for (const Vec3f& p : object.positions) object.velocities.push_back(velocity + cross(spin, p));
  return object;
}

Object at(Object object, const Vec3f& place) {
  for (Vec3f& p : object.positions) p += place;
  return object;
}

Scene in_free_space(const Object& object) {
  Scene scene;
  scene.gravity = {};
  scene.add(object);
  return scene;
}

Vec3d as_double(const Record& r) { return {r.x, r.y, r.z}; }

/// The motion of an object as a whole.
struct WholeMotion {
  Vec3d centre{}, velocity{}, angular_momentum{};
  double mass = 0, inertia = 0;  ///< inertia of a sphere: 2/3 sum of m r^2
  double energy = 0;             ///< kinetic energy [J]

  Vec3d angular_velocity() const { return angular_momentum * (1 / inertia); }
};

WholeMotion motion_of(const World& world, std::size_t number = 0) {
  const ObjectView object = world.object(world.objects()[number]);
  const std::span<const Record> positions = object.positions_in_storage_order(),
                                velocities = object.velocities_in_storage_order();
  WholeMotion of;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double mass = 1 / static_cast<double>(positions[i].w);
    of.mass += mass;
    of.centre += as_double(positions[i]) * mass;
    of.velocity += as_double(velocities[i]) * mass;
  }
  of.centre = of.centre * (1 / of.mass);
  of.velocity = of.velocity * (1 / of.mass);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double mass = 1 / static_cast<double>(positions[i].w);
    const Vec3d x = as_double(positions[i]) - of.centre, v = as_double(velocities[i]);
    of.angular_momentum += cross(x, v - of.velocity) * mass;
    of.inertia += 2.0 / 3 * length_squared(x) * mass;
    of.energy += 0.5 * length_squared(v) * mass;
  }
  return of;
}

World after(const Scene& scene, int frames) {
  World world(scene);
  for (int frame = 0; frame < frames; ++frame) EXPECT_TRUE(world.step(dt).ok());
  return world;
}

/// Edges of cotton cannot follow the volume, those of rubber can: `tiled` in 20 substeps and `chains` in 152. In four
/// seconds cotton came to 26 rad/s, and rubber to 2.5.
TEST(InflatedMomentum, DoesNotArise) {
  for (const char* name : {"cotton", "rubber sheet"}) {
    const World world = after(in_free_space(ball(of_fabric(name), 1.4f)), 240);
    const WholeMotion motion = motion_of(world);
    EXPECT_LT(length(motion.angular_velocity()), 1e-3) << name;
    EXPECT_LT(length(motion.centre), 1e-5) << name;
    EXPECT_LT(motion.energy / motion.mass, 1e-9) << name;
  }
}

/// What is sucked together is crumpled by forces that stay, too: it came to 13 rad/s in one second.
TEST(InflatedMomentum, DoesNotArisePumpedOut) {
  Object falling = ball(of_fabric("rubber sheet"), 1, 2), by_keyframes = falling;
  falling.volume->pressure = 0;
  by_keyframes.volume->keyframes = {{0, 1}, {0.5f, 0.3f}};
  for (const Object& one : {falling, by_keyframes}) {
    const WholeMotion motion = motion_of(after(in_free_space(one), 60));
    EXPECT_LT(length(motion.angular_velocity()), 1e-3);
    EXPECT_LT(length(motion.centre), 1e-4);
  }
}

TEST(InflatedMomentum, OfAThrownBallIsKeptByAllSweeps) {
  const Vec3f velocity{1, 0, 0.5f}, spin{1, 5, -2};
  for (const Sweep sweep : {Sweep::tiled, Sweep::symmetric, Sweep::jacobi, Sweep::chains, Sweep::sequential}) {
    Scene scene = in_free_space(moving(ball(of_wave_speed(40), 1.4f, 2), velocity, spin));
    scene.settings.sweep = sweep;
    scene.settings.substeps = 20;
    for (const int iterations : {1, 3}) {
      scene.settings.iterations = iterations;
      const WholeMotion start = motion_of(World(scene)), end = motion_of(after(scene, 60));
      const std::string what =
          "sweep " + std::to_string(static_cast<int>(sweep)) + ", iterations " + std::to_string(iterations);
      EXPECT_LT(length(end.angular_momentum - start.angular_momentum), 1e-4 * length(start.angular_momentum)) << what;
      EXPECT_LT(length(end.velocity - start.velocity), 1e-5) << what;
      EXPECT_LT(end.energy, start.energy) << what;
    }
  }
}

/// The limit of overstretch acts in each substep, and shortens edges one after another.
TEST(InflatedMomentum, IsKeptByTheLimitOfOverstretch) {
  Scene scene = in_free_space(ball(of_wave_speed(170), 1.1f));
  scene.settings.sweep = Sweep::chains;
  scene.settings.substeps = 80;
  const World world = after(scene, 90);
  EXPECT_GT(world.measure().overstretch().p99, 0.045f) << "the limit does not act";
  EXPECT_LT(length(motion_of(world).angular_velocity()), 1e-3) << "was 0.5";
}

/// A mesh without friction exerts no torque about the vertical. Chains are solved again where the ball presses on it.
TEST(InflatedMomentum, DoesNotTurnABallOnASmoothMesh) {
  Object one = at(ball(of_fabric("rubber sheet"), 1.4f), {0, 1.12f * inflated_radius + 0.011f, 0});
  one.collides = true;
  one.thickness = 0.005f;
  one.static_friction = one.kinetic_friction = 0;
  Scene scene;
  scene.add(one);
  MeshCollider floor;
  floor.mesh = grid_mesh(9, 9, 1, 1);
  floor.static_friction = floor.kinetic_friction = 0;
  scene.add(floor);
  EXPECT_LT(std::abs(motion_of(after(scene, 120)).angular_velocity().y), 0.002);
}

/// Chains are solved again where the balls press on one another. Without friction a central impact causes no spin but
/// by the flat triangles that meet.
TEST(InflatedMomentum, IsKeptByBallsThatCollide) {
  Scene scene;
  scene.gravity = {};
  for (const float side : {-1.f, 1.f}) {
    Object one = at(moving(ball(of_fabric("rubber sheet"), 1.4f, 2), {-2 * side, 0, 0}, {}), {0.3f * side, 0, 0});
    one.name += std::to_string(side);
    one.collides = true;
    one.thickness = 0.005f;
    one.static_friction = one.kinetic_friction = 0;
    scene.add(one);
  }
  const World world = after(scene, 60);
  const WholeMotion left = motion_of(world, 0), right = motion_of(world, 1);
  EXPECT_LT(left.velocity.x, -0.5) << "they did not bounce";
  EXPECT_LT(length(left.velocity + right.velocity), 1e-3);
  const Vec3d about_origin = left.angular_momentum + right.angular_momentum +
                             cross(left.centre, left.velocity) * left.mass +
                             cross(right.centre, right.velocity) * right.mass;
  EXPECT_LT(length(about_origin), 0.02 * left.mass * 2 * static_cast<double>(inflated_radius));
}

/// Linear momentum, and angular momentum about the origin, of all that moves in a World whose rigid bodies are spheres.
struct Momentum {
  Vec3d linear{}, angular{};
};

Momentum momentum_of(const World& world) {
  const State& state = world.state();
  Momentum of;
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    if (!(state.positions[i].w > 0)) continue;
    const Vec3d p = as_double(state.velocities[i]) * (1 / static_cast<double>(state.positions[i].w));
    of.linear += p;
    of.angular += cross(as_double(state.positions[i]), p);
  }
  for (std::size_t i = 0; i < state.frames.inverse_inertias.size(); ++i) {
    const auto inverse = static_cast<double>(state.frames.inverse_inertias[i].x);
    if (inverse > 0) of.angular += as_double(state.frames.angular_velocities[i]) * (1 / inverse);
  }
  return of;
}

/// A balloon and a rigid ball that fly at one another, off centre.
Scene balloon_and_body(float velocity_of_balloon, float velocity_of_body, float mass) {
  Object one = moving(ball(of_fabric("rubber sheet"), 1.1f, 2), {velocity_of_balloon, 0, 0}, {});
  one.collides = true;
  one.thickness = 0.005f;
  Scene scene = in_free_space(one);
  BodyOptions options;
  options.position = {-0.4f, 0.04f, 0.02f};
  options.mass = mass;
  Object body = make_body({{Sphere{0.1f}}}, options);
  body.velocities = {{velocity_of_body, 0, 0}};
  scene.add(body);
  return scene;
}

/// Chains give bodies impulses as well as contacts do. What a balloon gave them it did not lose: a ball lost 3 % of its
/// momentum in the balloon, and a balloon that met a ball came to 1.4 times as much.
TEST(InflatedMomentum, IsKeptWithRigidBodies) {
  for (const bool is_thrown : {true, false})
    for (const float mass : {0.05f, 0.5f, 5.f}) {
      const Scene scene = is_thrown ? balloon_and_body(0, 3, mass) : balloon_and_body(-3, 0, mass);
      const Momentum start = momentum_of(World(scene));
      const World world = after(scene, 30);
      const Momentum end = momentum_of(world);
      const std::string what = (is_thrown ? "body thrown, " : "balloon thrown, ") + std::to_string(mass) + " kg";
      EXPECT_LT(length(end.linear - start.linear), 1e-4 * length(start.linear)) << what;
      EXPECT_LT(length(end.angular - start.angular), 2e-3 * length(start.linear) * static_cast<double>(inflated_radius))
          << what;
      EXPECT_GT(motion_of(world).velocity.x - static_cast<double>(world.object(1).velocities()[0].x), 0.3)
          << what << ": no impact";
    }
}

Scene on_a_slope(const Object& object, double sine) {
  Scene scene;
  scene.add(at(object, {0, 1.12f * inflated_radius + 0.005f, 0}));
  scene.gravity = {static_cast<float>(9.81 * sine), static_cast<float>(-9.81 * std::sqrt(1 - sine * sine)), 0};
  Collider ground;
  ground.static_friction = ground.kinetic_friction = 0.8f;
  scene.add(ground);
  return scene;
}

/// Rubber rolled 0.43 m in four seconds.
TEST(InflatedMomentum, DoesNotRollABallOnLevelGround) {
  const Vec3d centre = motion_of(after(on_a_slope(ball(of_fabric("rubber sheet"), 1.4f), 0), 240)).centre;
  EXPECT_LT(std::hypot(centre.x, centre.z), 0.02);
}

/// A rigid spherical shell that rolls down a slope accelerates by 3/5 g sin a. This one is soft and faceted, which
/// costs energy.
TEST(InflatedMomentum, LetsABallRollDownASlope) {
  const double sine = 0.1;
  const Scene scene = on_a_slope(ball(of_fabric("rubber sheet"), 1.4f), sine);
  const WholeMotion early = motion_of(after(scene, 60)), late = motion_of(after(scene, 180));
  const double acceleration = (late.velocity.x - early.velocity.x) / 2 / (9.81 * sine);
  EXPECT_GT(acceleration, 0.48);
  EXPECT_LT(acceleration, 0.62);
  EXPECT_NEAR(-late.angular_velocity().z * 1.12 * static_cast<double>(inflated_radius), late.velocity.x,
              0.05 * late.velocity.x);
}

/// Five tiles, another ball in the same group, and other kernels.
TEST(InflatedMomentum, HasTheSameBitsOnAnyThreads) {
  Scene scene = in_free_space(moving(ball(of_fabric("rubber sheet"), 1.4f, 5), {}, {1, 2, 3}));
  scene.settings.substeps = 20;
  scene.add(at(ball(of_fabric("rubber sheet"), 1.2f, 2), {1, 0, 0}));
  scene.objects[1].name = "other";
  scene.settings.threads = 1;
  const std::string hash = after(scene, 2).state_hash();
  for (const int threads : {2, 3, 8}) {
    scene.settings.threads = threads;
    EXPECT_EQ(after(scene, 2).state_hash(), hash) << threads << " threads";
  }
  scene.settings.isa = "sequential";
  EXPECT_EQ(after(scene, 2).state_hash(), hash);
  scene.settings.isa = "";
  const std::vector<Vec3f> beside = [&] {
    const World both = after(scene, 2);
    return both.object(both.objects()[0]).positions();
  }();
  scene.objects.pop_back();
  const World alone = after(scene, 2);
  EXPECT_EQ(alone.object(alone.objects()[0]).positions(), beside);
}

}  // namespace
}  // namespace pliant
