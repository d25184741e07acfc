// First modes of springs, bars, rods and sheets, and what is left of them after a while.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "joints/joint_support.h"
#include "pliant/cluster.h"
#include "pliant/rod.h"
#include "pliant/soft_body.h"
#include "pliant/world.h"

namespace pliant::testing_support {

using Integrator = Settings::Integrator;

/// A scene of one object at rest that has the velocity of a mode [m/s]; `frequency` is about that of the mode [rad/s].
struct Mode {
  Scene scene;
  std::vector<Vec3f> shape;
  double frequency = 1;

  /// Gives each particle a share of a velocity. `shape_at(place)` is zero where particles are to be held.
  template <class ShapeAt>
  void begin(Object object, float speed, double of_frequency, const ShapeAt& shape_at) {
    scene.gravity = {};
    scene.settings.threads = 1;
    object.collides = object.self_collision = false;
    object.velocities.assign(object.positions.size(), {});
    shape.assign(object.positions.size(), {});
    for (std::size_t i = 0; i < object.positions.size(); ++i) {
      shape[i] = shape_at(object.positions[i]);
      object.velocities[i] = shape[i] * speed;
    }
    frequency = of_frequency;
    scene.objects = {std::move(object)};
  }
  void hold(double below_x) {
    std::vector<int> held;
    const std::vector<Vec3f>& places = scene.objects[0].positions;
    for (std::size_t i = 0; i < places.size(); ++i)
      if (static_cast<double>(places[i].x) < below_x) held.push_back(static_cast<int>(i));
    scene.pin(0, held);
  }
};

inline double share_of_clamped_beam(double along) {
  constexpr double k = 1.875104, s = 0.734096;
  return (std::cosh(k * along) - std::cos(k * along) - s * (std::sinh(k * along) - std::sin(k * along))) / 2;
}

/// A body on a spring, or on so many side by side: all but one close loops of joints.
inline Mode spring_mode(double frequency, double damping = 0, int springs = 1) {
  Mode mode;
  Mechanism m;
  m.box({1, 0, 0}, 2, {0.1f, 0.1f, 0.1f});
  for (int i = 0; i < springs; ++i)
    add_joint(m.object, SpringJoint{.b = 0,
                                    .anchor_b = {1, 0, 0},
                                    .stiffness = static_cast<float>(2 * frequency * frequency / springs),
                                    .damping = static_cast<float>(2 * damping / springs)});
  mode.begin(m.object, 0.1f, frequency, [](const Vec3f& x) { return x.x > 0.5f ? Vec3f{1, 0, 0} : Vec3f{}; });
  return mode;
}

/// An arm of 0.5 m on a hinge with a spring, with the decay exp(-damping t / 2).
inline Mode hinge_mode(double frequency, double damping = 0) {
  Mode mode;
  Mechanism m;
  m.box({0.5f, 0, 0}, 2, {0.1f, 0.1f, 0.1f}, {}, {0, 0, 0.2f});
  const double inertia = box_inertia(2, 0.1, 0.1) + 2 * 0.25;
  const JointSpring spring{.stiffness = static_cast<float>(inertia * frequency * frequency),
                           .damping = static_cast<float>(inertia * damping)};
  add_joint(m.object, HingeJoint{.b = 0, .axis = {0, 0, 1}, .spring = spring});
  mode.begin(m.object, 0.1f, frequency, [](const Vec3f& x) { return x.x > 0.4f ? Vec3f{0, 1, 0} : Vec3f{}; });
  return mode;
}

/// The corners of a cube in one cluster, whose size changes, with the decay exp(-damping t / 2).
inline Mode cluster_mode(double frequency, double damping) {
  Object cube;
  cube.name = "cube";
  std::vector<int> all;
  for (int i = 0; i < 8; ++i) {
    cube.positions.push_back({i % 2 == 0 ? -1.f : 1.f, i / 2 % 2 == 0 ? -1.f : 1.f, i < 4 ? -1.f : 1.f});
    cube.masses.push_back(1);
    all.push_back(i);
  }
  const Stiffness stiffness =
      Stiffness::compliance(static_cast<float>(1 / (frequency * frequency)), static_cast<float>(damping));
  add_cluster(cube, all, {.stiffness = stiffness});
  Mode mode;
  mode.begin(std::move(cube), 0.1f, frequency, [](const Vec3f& x) { return x; });
  return mode;
}

/// Bodies in a row, each on two springs to the one before.
inline Mode bodies_on_springs(double frequency, int bodies) {
  Mechanism m;
  for (int i = 0; i < bodies; ++i) m.box({1 + static_cast<float>(i), 0, 0}, 2, {0.1f, 0.1f, 0.1f});
  const auto stiffness = static_cast<float>(frequency * frequency);
  for (int i = 0; i < bodies; ++i) {
    const float at = static_cast<float>(i), aside = 0.1f;
    for (const float y : {aside, -aside})
      add_joint(
          m.object,
          SpringJoint{.a = i - 1, .b = i, .anchor_a = {at, y, 0}, .anchor_b = {1 + at, y, 0}, .stiffness = stiffness});
  }
  Mode mode;
  mode.begin(m.object, 0.1f, frequency, [](const Vec3f& x) { return x.x > 0.5f ? Vec3f{1, 0, 0} : Vec3f{}; });
  return mode;
}

/// A line of particles and springs between two pins, in its lengthwise mode.
inline Mode line_mode(double frequency, int springs, Sweep sweep, double damping_time = 0) {
  Object line;
  line.name = "line";
  line.sweep = sweep;
  ConstraintGroup group;
  group.type = "distance";
  const double pi_ = 3.14159265358979324, stiffness = std::pow(frequency / (2 * std::sin(pi_ / 2 / springs)), 2);
  for (int i = 0; i <= springs; ++i) {
    line.positions.push_back({static_cast<float>(i) / static_cast<float>(springs), 0, 0});
    line.masses.push_back(1);
    if (i > 0) group.particles.insert(group.particles.end(), {i - 1, i});
  }
  group.stiffness =
      Stiffness::compliance(static_cast<float>(1 / stiffness), static_cast<float>(damping_time * stiffness));
  line.constraints = {group};
  Mode mode;
  mode.begin(std::move(line), 0.01f, frequency, [&](const Vec3f& x) {
    return Vec3f{static_cast<float>(std::sin(pi_ * static_cast<double>(x.x))), 0, 0};
  });
  mode.scene.pin(0, {0, springs});
  return mode;
}

/// A bar of 1 m, held at one end, in its lengthwise mode, or as a cantilever.
inline Mode bar_mode(double modulus, double poisson, double damping, bool bends) {
  SoftBodyOptions options;
  options.material.youngs_modulus = static_cast<float>(modulus);
  options.material.poisson_ratio = static_cast<float>(poisson);
  options.material.damping = static_cast<float>(damping);
  const double speed = std::sqrt(modulus / 1000), pi_ = 3.14159265358979324;
  Mode mode;
  mode.begin(make_soft_body(box_tetrahedra({1, 0.1f, 0.1f}, {10, 1, 1}), options), 0.05f,
             bends ? 3.516 * speed * 0.1 / std::sqrt(12.) : pi_ / 2 * speed, [&](const Vec3f& x) {
               const double along = static_cast<double>(x.x) + 0.5;
               const auto lift = static_cast<float>(share_of_clamped_beam(along));
               return bends ? Vec3f{0, lift, lift}  // a principal axis of a section that is cut along its diagonal
                            : Vec3f{static_cast<float>(std::sin(pi_ / 2 * along)), 0, 0};
             });
  mode.hold(-0.4999);
  return mode;
}

/// So many clamped rods of 1 m side by side. More than five are solved in lanes.
inline Mode rod_mode(double modulus, int rods, double damping = 0) {
  constexpr int segments = 16;
  Object object;
  object.name = "rods";
  RodOptions options;
  options.material.youngs_modulus = static_cast<float>(modulus);
  options.material.shear_modulus = static_cast<float>(0.35 * modulus);
  options.material.damping = static_cast<float>(damping);
  options.radius = 0.01f;
  options.start.kind = RodEnd::Kind::clamped;
  std::vector<Vec3f> points(segments + 1);
  for (int rod = 0; rod < rods; ++rod) {
    options.name = "rod " + std::to_string(rod);
    for (int i = 0; i <= segments; ++i)
      points[static_cast<std::size_t>(i)] = {static_cast<float>(i) / segments, 0, static_cast<float>(rod)};
    add_rod(object, points, options);
  }
  Mode mode;
  mode.begin(std::move(object), 0.1f, 3.516 * 0.005 * std::sqrt(modulus / 1000), [](const Vec3f& x) {
    return Vec3f{0, static_cast<float>(share_of_clamped_beam(static_cast<double>(x.x))), 0};
  });
  return mode;
}

/// A strip of cloth of 1 m in its plane, held at one end.
inline Mode cloth_mode(double stiffness, Sweep sweep) {
  constexpr int along = 16, across = 4;
  TriangleMesh mesh;
  for (int i = 0; i <= along; ++i)
    for (int j = 0; j <= across; ++j)
      mesh.positions.push_back({static_cast<float>(i) / along, 0, static_cast<float>(j) / along});
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < across; ++j) {
      const int a = i * (across + 1) + j, b = a + across + 1;
      const bool turns = (i + j) % 2 == 1;  // diagonals alternate, so that the strip is alike to both sides
      mesh.triangles.push_back({a, b, turns ? a + 1 : b + 1});
      mesh.triangles.push_back({turns ? b : a, b + 1, a + 1});
    }
  ClothOptions options;
  options.material.area_density = 0.3f;
  options.material.stretch_stiffness = static_cast<float>(stiffness);
  Scene scene;
  scene.add_cloth(mesh, options);
  scene.objects[0].sweep = sweep;
  Mode mode;
  constexpr double half_pi = 3.14159265358979324 / 2;
  mode.begin(scene.objects[0], 0.02f, half_pi * std::sqrt(stiffness / 0.3), [](const Vec3f& x) {
    return Vec3f{static_cast<float>(std::sin(half_pi * static_cast<double>(x.x))), 0, 0};
  });
  mode.hold(1e-4);
  return mode;
}

/// A mode's coordinate in a World, frame by frame, with its velocity over its frequency.
struct ModeTrace {
  std::vector<double> position, velocity;
  double rate = 60;  ///< frames per second
  bool ok = true;

  ModeTrace(const Mode& mode, const Settings& settings, double seconds, double in_rate = 60) : rate(in_rate) {
    World world(mode.scene, settings);
    const int frames = static_cast<int>(std::lround(seconds * rate));
    position.reserve(static_cast<std::size_t>(frames) + 1);
    velocity.reserve(static_cast<std::size_t>(frames) + 1);
    add(mode, world);
    for (int i = 0; i < frames && ok; ++i) {
      ok = world.step(static_cast<float>(1 / rate)).ok();
      add(mode, world);
    }
  }
  /// 2 pi times the number of zeros over twice the time between them [rad/s]; `guess` if there are too few.
  double frequency(double guess) const {
    double first = -1, last = 0;
    int zeros = 0;
    for (std::size_t i = 1; i < position.size(); ++i) {
      if ((position[i - 1] < 0) == (position[i] < 0)) continue;
      last = static_cast<double>(i) - position[i] / (position[i] - position[i - 1]);
      if (first < 0) first = last;
      ++zeros;
    }
    return zeros < 3 ? guess : 3.14159265358979324 * (zeros - 1) / (last - first) * rate;
  }
  /// The mean amplitude of the period that begins with a frame.
  double amplitude(std::size_t frame, double omega) const {
    const auto period = static_cast<std::size_t>(std::lround(2 * 3.14159265358979324 / omega * rate));
    double sum = 0;
    for (std::size_t i = frame; i < frame + period; ++i) sum += std::hypot(position[i], velocity[i] / omega);
    return sum / static_cast<double>(period);
  }

 private:
  void add(const Mode& mode, const World& world) {
    double x = 0, v = 0, squares = 0;
    for (std::size_t i = 0; i < mode.shape.size(); ++i) {
      const Vec3d s = convert<double>(mode.shape[i]);
      x +=
          dot(s, convert<double>(world.object(0).positions()[i]) - convert<double>(mode.scene.objects[0].positions[i]));
      v += dot(s, convert<double>(world.object(0).velocities()[i]));
      squares += length_squared(s);
    }
    position.push_back(x / squares);
    velocity.push_back(v / squares);
  }
};

/// The share of the amplitude that is left between the first period and the one that begins ten periods later.
inline double kept_after_ten(const Mode& mode, Integrator integrator, int substeps = 0) {
  Settings settings = mode.scene.settings;
  settings.integrator = integrator;
  settings.substeps = substeps;
  const double period = 2 * 3.14159265358979324 / mode.frequency;
  const ModeTrace trace(mode, settings, 13 * period);
  EXPECT_TRUE(trace.ok);
  const double omega = trace.frequency(mode.frequency);
  return trace.amplitude(static_cast<std::size_t>(10 * 2 * 3.14159265358979324 / omega * 60), omega) /
         trace.amplitude(0, omega);
}

}  // namespace pliant::testing_support
