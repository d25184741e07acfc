// What the tests of momentum under the contact filter share: free objects to throw at one another, and what an impact
// of two of them changes.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "math/quat.h"
#include "math/vector.h"
#include "pliant/body.h"
#include "pliant/soft_body.h"
#include "pliant/world.h"
#include "world/surface_support.h"
#include "world/world_support.h"

namespace pliant::testing_support {

/// A square sheet that turns about x by an angle, with self-collision.
inline Object free_sheet(int n, float side, float density, const Vec3f& centre, float angle = 0) {
  ClothOptions options;
  options.material.area_density = density;
  TriangleMesh mesh = grid_mesh(n, n, side, side);
  Vec3f middle{};
  for (const Vec3f& p : mesh.positions) middle += p * (1.f / static_cast<float>(mesh.positions.size()));
  const float c = std::cos(angle), s = std::sin(angle);
  for (Vec3f& p : mesh.positions) {
    const Vec3f q = p - middle;
    p = centre + Vec3f{q.x, c * q.y - s * q.z, s * q.y + c * q.z};
  }
  Object object = make_cloth(mesh, options);
  object.self_collision = object.collides = true;
  return object;
}

inline Object moving(Object object, const Vec3f& velocity) {
  object.velocities.assign(object.positions.size(), velocity);
  return object;
}

/// A cube of gelatine.
inline Object gelatine(const Vec3f& corner, float side = 0.3f) {
  SoftBodyOptions options;
  options.material = elastic_solid("gelatine");
  TetrahedralMesh mesh = box_tetrahedra({side, side, side}, {4, 4, 4});
  for (Vec3f& p : mesh.positions) p += corner;
  Object object = make_soft_body(mesh, options);
  object.collides = object.self_collision = true;
  return object;
}

struct Momenta {
  Vec3d linear{}, angular{};  ///< about the origin [kg m/s, kg m^2/s]
  Vec3d moment{};             ///< of mass [kg m]
  double mass = 0;            ///< [kg]

  Vec3d centre() const { return moment * (1 / mass); }
  Vec3d about_centre() const { return angular - cross(centre(), linear); }
};

inline Vec3d vector_of(const Record& r) { return {double(r.x), double(r.y), double(r.z)}; }

/// The momentum of particles from number `first` on, about the origin.
inline Momenta momentum_of(const World& world, std::size_t first, std::size_t last) {
  Momenta sum;
  const State& state = world.state();
  for (std::size_t i = first; i < last; ++i) {
    const Record& x = state.positions[i];
    if (!(x.w > 0)) continue;
    const Vec3d p = vector_of(state.velocities[i]) * (1 / double(x.w));
    sum.linear += p;
    sum.moment += vector_of(x) * (1 / double(x.w));
    sum.mass += 1 / double(x.w);
    sum.angular += cross(vector_of(x), p);
  }
  return sum;
}

/// The angular momentum of the rotation of all rigid bodies.
inline Vec3d spin_of(const World& world) {
  Vec3d sum{};
  const FrameRecords& frames = world.state().frames;
  for (std::size_t i = 0; i < frames.orientations.size(); ++i) {
    const Record &q = frames.orientations[i], &w = frames.angular_velocities[i], &inverse = frames.inverse_inertias[i];
    if (!(inverse.x > 0)) continue;
    const Vec3d local{double(w.x) / double(inverse.x), double(w.y) / double(inverse.y),
                      double(w.z) / double(inverse.z)};
    sum += rotate(Quatd{double(q.x), double(q.y), double(q.z), double(q.w)}, local);
  }
  return sum;
}

struct Outcome {
  double energy_before = 0,
         energy_after = 0;  ///< kinetic energy of particles, in relation to their mean velocity at the start [J]
  double carried = 0;       ///< sum of m |v| at the start [kg m/s]
  double exchanged = 0;     ///< change of the second object's momentum [kg m/s]
  double linear = 0;        ///< change of the sum, over `exchanged`
  double angular = 0;       ///< the same of angular momentum about the centre of mass, over `exchanged` times 1 m
  /// The same about the origin: a lag of the centre of mass times the momentum would be in it.
  double about_origin = 0;
  double lag = 0;  ///< how far the centre of mass is from where its velocity at the start takes it [m]
  std::int64_t filtered = 0;
  std::size_t crossings = 0;
  std::vector<std::string> warnings;
};

inline double carried_by(const World& world, std::size_t particles) {
  double sum = 0;
  for (std::size_t i = 0; i < particles; ++i)
    sum += length(vector_of(world.state().velocities[i])) / double(world.state().positions[i].w);
  return sum;
}

inline double energy_of(const World& world, std::size_t particles, const Vec3f& common) {
  double sum = 0;
  for (std::size_t i = 0; i < particles; ++i) {
    const Vec3d v = vector_of(world.state().velocities[i]) - convert<double>(common);
    sum += 0.5 * dot(v, v) / double(world.state().positions[i].w);
  }
  return sum;
}

/// Runs two objects in free space, both with a velocity in common. `others`: what else is there, far away.
inline Outcome outcome_of(Object first, Object second, int frames, const Vec3f& common = {}, const Scene& others = {}) {
  Scene scene;
  scene.colliders = others.colliders;
  scene.gravity = {};
  for (Object* object : {&first, &second}) {
    if (object->velocities.empty()) object->velocities.assign(object->positions.size(), {});
    for (Vec3f& v : object->velocities) v += common;
    scene.add(*object);
  }
  for (const Object& object : others.objects) scene.add(object);
  World world(scene);
  Watch watch(world, scene);
  const std::size_t half = first.positions.size(), all = half + second.positions.size();
  const Momenta before = momentum_of(world, 0, all), of_second = momentum_of(world, half, all);
  Outcome out;
  out.carried = carried_by(world, all);
  out.energy_before = energy_of(world, all, common);
  for (int frame = 0; frame < frames; ++frame) {
    const Report report = world.step(dt);
    EXPECT_TRUE(report.ok());
    out.filtered += report.pairs.truncated;
    out.crossings += watch.crossings(world);
    out.warnings.insert(out.warnings.end(), report.warnings.begin(), report.warnings.end());
  }
  Momenta after = momentum_of(world, 0, all);
  after.angular += spin_of(world);  // none turns at the start
  out.exchanged = length(momentum_of(world, half, all).linear - of_second.linear);
  out.linear = length(after.linear - before.linear) / out.exchanged;
  out.angular = length(after.about_centre() - before.about_centre()) / out.exchanged;
  out.about_origin = length(after.angular - before.angular) / out.exchanged;
  out.lag = length(after.centre() - before.centre() - before.linear * (frames * double(dt) / before.mass));
  out.energy_after = energy_of(world, all, common);
  return out;
}

/// `rounded`: how much rounding of velocities may change the sum, over what is exchanged.
inline void expect_kept(const Outcome& outcome, double rounded = 1e-4) {
  EXPECT_GT(outcome.filtered, 0) << "the filter had nothing to do";
  EXPECT_GT(outcome.exchanged, 0.01) << "they have not met";
  EXPECT_LT(outcome.linear, rounded);
  EXPECT_LT(outcome.angular, 1e-2);
  EXPECT_LT(outcome.about_origin, 1e-2);
  EXPECT_LT(outcome.energy_after, outcome.energy_before * (1 + 1e-5)) << "a collision adds no energy";
  EXPECT_EQ(outcome.crossings, 0u);
  for (const std::string& warning : outcome.warnings)
    EXPECT_EQ(warning.find("passes through"), std::string::npos) << warning;
}

}  // namespace pliant::testing_support
