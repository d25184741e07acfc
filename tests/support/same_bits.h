// What tests of equal bits share: a scene on any number of threads, on any level, and after a restore.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "pliant/world.h"
#include "support/kernels.h"

namespace pliant::testing_support {

/// Steps of a World.
struct Steps {
  int count = 1;
  float length = 1.f / 60;  ///< [s]
};

inline void make(World& world, const Steps& steps) {
  for (int i = 0; i < steps.count; ++i) {
    const Report report = world.step(steps.length);
    ASSERT_TRUE(report.ok()) << report.explain();
  }
}

inline std::string hash_after(const Scene& scene, const Steps& steps, int threads, const std::string& isa) {
  Settings settings = scene.settings;
  settings.threads = threads;
  settings.isa = isa;
  World world(scene, settings);
  make(world, steps);
  return hash(world.state());
}

/// Expects the bits of the sequential code on any number of threads, by the widest and the narrowest lanes. Returns
/// their hash.
inline std::string expect_same_bits_on_any_threads_and_levels(const Scene& scene, const Steps& steps) {
  std::string expected = hash_after(scene, steps, 1, "sequential");
  EXPECT_EQ(hash_after(scene, steps, 1, ""), expected);
  EXPECT_EQ(hash_after(scene, steps, 3, ""), expected);
  EXPECT_EQ(hash_after(scene, steps, 2, available_isas().front()), expected);
  return expected;
}

/// Expects that a World restored after `steps` goes on for as many as if it had made the first ones itself.
inline void expect_same_bits_after_a_restore(const Scene& scene, const Steps& steps) {
  World world(scene), other(scene);
  make(world, steps);
  other.restore(world.state());
  make(world, steps);
  make(other, steps);
  EXPECT_EQ(hash(other.state()), hash(world.state()));
}

}  // namespace pliant::testing_support
