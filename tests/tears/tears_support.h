// What the tests of tears and cuts share.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "pliant/soft_body.h"
#include "pliant/world.h"

namespace pliant::testing_support {

inline double mass_of(const Object& object) { return std::accumulate(object.masses.begin(), object.masses.end(), 0.); }

/// The number of sets of particles that triangles, tetrahedra and links join; particles by themselves do not count.
inline int pieces_of(const Object& object) {
  std::vector<int> root(object.positions.size());
  std::iota(root.begin(), root.end(), 0);
  const std::function<int(int)> find = [&](int i) {
    while (root[static_cast<std::size_t>(i)] != i) i = root[static_cast<std::size_t>(i)];
    return i;
  };
  std::set<int> used;
  const auto join = [&](const auto& particles) {
    for (const int p : particles) {
      root[static_cast<std::size_t>(find(p))] = find(particles[0]);
      used.insert(p);
    }
  };
  const auto tetrahedra = tetrahedra_of(object);
  for (const auto& t : tetrahedra) join(t);
  for (const auto& t : object.triangles) join(t);
  for (const ConstraintGroup& group : object.constraints)
    for (std::size_t i = 0; group.type == "distance" && i + 1 < group.particles.size(); i += 2)
      join(std::array<int, 2>{group.particles[i], group.particles[i + 1]});
  std::set<int> roots;
  for (const int p : used) roots.insert(find(p));
  return static_cast<int>(roots.size());
}

/// A scene of one object on one thread, without weight.
inline Scene weightless(Object object, int substeps) {
  Scene scene;
  scene.gravity = {};
  scene.settings.substeps = substeps;
  scene.settings.threads = 1;
  scene.add(std::move(object));
  return scene;
}

/// Pins the particles at both ends along x, and moves those ends apart until the object is `stretch` times as long.
inline void pull_apart(Object& object, float stretch, float seconds) {
  float low = object.positions[0].x, high = low;
  for (const Vec3f& p : object.positions) low = std::min(low, p.x), high = std::max(high, p.x);
  const float way = (high - low) * (stretch - 1) / 2;
  for (int i = 0; i < static_cast<int>(object.positions.size()); ++i) {
    const float x = object.positions[static_cast<std::size_t>(i)].x;
    if (x > low + 1e-4f && x < high - 1e-4f) continue;
    Pin pin{i, {}};
    pin.motion.keyframes = {{0, {}, {}}, {seconds, {x < 0 ? -way : way, 0, 0}, {}}};
    object.pins.push_back(pin);
  }
}

/// Steps and sums what tore.
inline Torn run_and_tear(World& world, int frames) {
  Torn sum;
  for (int i = 0; i < frames; ++i) {
    const Report report = world.step(1.f / 60);
    EXPECT_TRUE(report.ok()) << report.explain();
    for (const Torn& torn : report.torn) {
      sum.object = torn.object;
      sum.new_particles += torn.new_particles;
      sum.lost_constraints += torn.lost_constraints;
    }
  }
  return sum;
}

}  // namespace pliant::testing_support
