// What the tests of rods share: rods of round section, and a World in which they come to rest.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "math/vector.h"
#include "pliant/rod.h"
#include "pliant/world.h"
#include "support/run.h"

namespace pliant::testing_support {

constexpr double pi = 3.14159265358979324, gravity = 9.81;

inline RodMaterial material_of(double youngs_modulus, double shear_modulus, double density) {
  RodMaterial material;
  material.youngs_modulus = static_cast<float>(youngs_modulus);
  material.shear_modulus = static_cast<float>(shear_modulus);
  material.density = static_cast<float>(density);
  return material;
}

inline double second_moment(double radius) { return pi * radius * radius * radius * radius / 4; }

/// Points from one place to another, evenly spaced.
inline std::vector<Vec3f> line(const Vec3f& from, const Vec3f& to, int segments) {
  std::vector<Vec3f> points;
  for (int i = 0; i <= segments; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(segments);
    points.push_back((1 - share) * from + share * to);
  }
  return points;
}

inline RodOptions clamped_rod(const RodMaterial& material, float radius) {
  RodOptions options;
  options.material = material;
  options.radius = radius;
  options.start.kind = RodEnd::Kind::clamped;
  return options;
}

/// An object in a World of its own, which touches nothing.
struct Lone {
  Scene scene;
  World world;

  explicit Lone(Object object, int substeps = 20, bool falls = true)
      : scene(scene_of(std::move(object), substeps, falls)), world(scene) {}

  void run(double seconds) {
    const int frames = static_cast<int>(std::lround(seconds * 60));
    for (int i = 0; i < frames; ++i) {
      const Report report = world.step(frame_time);
      ASSERT_TRUE(report.ok()) << report.explain();
    }
  }

  Vec3d position(int particle) const {
    return convert<double>(world.object(0).positions()[static_cast<std::size_t>(particle)]);
  }
  Vec3d velocity(int particle) const {
    return convert<double>(world.object(0).velocities()[static_cast<std::size_t>(particle)]);
  }
  /// The free end of a rod of so many segments, which are the first bodies: half a segment beyond the middle of the
  /// last.
  Vec3d tip(int segments) const {
    return position(segments - 1) + (position(segments - 1) - position(segments - 2)) * 0.5;
  }

 private:
  static Scene scene_of(Object object, int substeps, bool falls) {
    Scene made;
    object.collides = object.self_collision = false;
    made.settings.substeps = substeps;
    made.settings.threads = 1;
    if (!falls) made.gravity = {};
    made.add(std::move(object));
    return made;
  }
};

}  // namespace pliant::testing_support
