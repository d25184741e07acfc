// What the tests of joints share: mechanisms of boxes, and where their bodies are after a while.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "math/quat.h"
#include "pliant/body.h"
#include "pliant/joint.h"
#include "pliant/world.h"
#include "support/run.h"

namespace pliant::testing_support {

constexpr double gravity = 9.81, pi = 3.14159265358979324;
constexpr float half_link = 0.25f;  ///< of chains [m]

inline Vec3d wide(const Vec3f& v) { return {v.x, v.y, v.z}; }
inline double length(const Vec3d& v) { return std::sqrt(length_squared(v)); }

/// An object whose bodies touch nothing, and a World of it.
struct Mechanism {
  Object object;
  Scene scene;
  int substeps = 20, iterations = 1, threads = 1;
  std::unique_ptr<World> world;

  Mechanism() { object.name = "mechanism"; }

  /// A box of unit half extents times `half`, about `at`.
  int box(const Vec3f& at, float mass = 1, const Vec3f& half = {0.5f, 0.1f, 0.1f}, const Vec3f& velocity = {},
          const Vec3f& spin = {}) {
    BodyOptions options;
    options.name = "box " + std::to_string(object.bodies.size());
    options.position = at;
    options.mass = mass;
    options.velocity = velocity;
    options.angular_velocity = spin;
    return add_body(object, {{Box{half}, {}, {}, 1000}}, options);
  }

  void start() {
    object.collides = object.self_collision = false;
    scene.objects = {object};
    Settings settings;
    settings.sweep = Sweep::tiled;
    settings.substeps = substeps;
    settings.iterations = iterations;
    settings.threads = threads;
    world = std::make_unique<World>(scene, settings);
  }

  void run(double seconds) {
    if (!world) start();
    const int frames = static_cast<int>(std::lround(seconds * 60));
    for (int i = 0; i < frames; ++i) {
      const Report report = world->step(frame_time);
      ASSERT_TRUE(report.ok()) << report.explain();
    }
  }

  Posed pose(int body) const {
    const ObjectBody& of = object.bodies[static_cast<std::size_t>(body)];
    const Vec3f x = world->object(0).positions()[static_cast<std::size_t>(of.particle)];
    return {wide(x), normalise(convert<double>(world->object(0).orientations()[static_cast<std::size_t>(of.frame)]))};
  }
  Posed start_pose(int body) const {
    const ObjectBody& of = object.bodies[static_cast<std::size_t>(body)];
    return {wide(object.positions[static_cast<std::size_t>(of.particle)]),
            normalise(convert<double>(object.frames[static_cast<std::size_t>(of.frame)].orientation))};
  }
  /// Where a point of a body is now that was at `start` at time 0.
  Vec3d place(int body, const Vec3f& start) const {
    return to_world(pose(body), to_local(start_pose(body), wide(start)));
  }
  /// The rotation of a body since time 0 as a vector in world axes, up to pi long [rad].
  Vec3d turned(int body) const {
    Quatd q = multiply(pose(body).rotation, conjugate(start_pose(body).rotation));
    if (q.w < 0) q = {-q.x, -q.y, -q.z, -q.w};
    const double sine = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z);
    return Vec3d{q.x, q.y, q.z} * (sine > 0 ? 2 * std::atan2(sine, q.w) / sine : 0);
  }
  Vec3d velocity(int body) const {
    return wide(world->object(0)
                    .velocities()[static_cast<std::size_t>(object.bodies[static_cast<std::size_t>(body)].particle)]);
  }
  Vec3d spin(int body) const {
    return wide(
        world->object(0)
            .angular_velocities()[static_cast<std::size_t>(object.bodies[static_cast<std::size_t>(body)].frame)]);
  }
};

/// Kinetic and gravitational energy [J].
inline double energy(const Mechanism& m) {
  return m.world->measure().kinetic_energy() + m.world->measure().potential_energy();
}

/// The body of link `i` of a chain that hangs from the world, which is the second body, since it is added with the
/// first joint.
inline int body_of_link(int i) { return i == 0 ? 0 : i + 1; }

/// The moment of inertia of a box about an axis through its centre that is perpendicular to sides 2a and 2b.
inline double box_inertia(double mass, double a, double b) { return mass * (a * a + b * b) / 3; }

}  // namespace pliant::testing_support
