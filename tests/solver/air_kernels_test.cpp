// Compares the air's forces in lanes with the sequential reference bit by bit, for all lengths of the tail.
#include "solver/air_kernels.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <string>
#include <vector>

#include "solver/kernels.h"
#include "solver/random_support.h"
#include "solver/records_support.h"
#include "support/kernels.h"

namespace pliant {
namespace {

using namespace testing_support;

/// Random triangles of random particles. Some particles have infinite mass or are at rest in the air, and some
/// triangles have no area.
struct TrianglesInAir {
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> begin, corners;
  Records positions, velocities, forces;

  TrianglesInAir(int count, bool nasty, std::mt19937& random) {
    const int particles = count / 2 + 3;
    const auto number = [&] { return nasty ? nasty_float(random) : uniform_float(random, -1, 1); };
    for (int i = 0; i < particles; ++i) {
      positions.push_back({number(), number(), number(), i % 5 == 0 ? 0.f : uniform_float(random, 1, 9)});
      velocities.push_back(i % 3 == 0 ? Record{air.x, air.y, air.z, 0} : Record{number(), number(), number(), 0});
    }
    const auto any_particle = [&] { return static_cast<int>(random() % static_cast<unsigned>(particles)); };
    for (int t = 0; t < count; ++t) triangles.push_back({any_particle(), any_particle(), any_particle()});
    gather_corners(particles);
    forces.resize(static_cast<std::size_t>((count + air_batch - 1) / air_batch * air_batch));
  }

  /// The corners of each particle's triangles, as Surface has them.
  void gather_corners(int particles) {
    begin.push_back(0);
    for (int i = 0; i < particles; ++i) {
      for (std::size_t t = 0; t < triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
          if (triangles[t][k] == i) corners.push_back(static_cast<int>(4 * t + k));
      begin.push_back(static_cast<int>(corners.size()));
    }
  }

  /// The velocities after the air's forces.
  Records pushed(const AirKernels& kernels) {
    Records changed = velocities;
    const AirArguments a{triangles.front().data(),
                         begin.data(),
                         corners.data(),
                         positions.data(),
                         changed.data(),
                         forces.data(),
                         air,
                         {0.01f, -0.05f, 0},
                         1.f / 600,
                         1.2f,
                         1.1f,
                         0.7f};
    kernels.find_forces(a, 0, static_cast<int>(triangles.size()));
    kernels.apply(a, 0, static_cast<int>(positions.size()));
    forces.resize(triangles.size());
    return changed;
  }

  static constexpr Vec3f air{3, 0.5f, -1};
};

TEST(AirKernels, SameBitsAsTheReference) {
  std::mt19937 random(3);
  for (const bool nasty : {false, true})
    for (int count = 1; count <= 3 * air_batch + 1; ++count) {
      const TrianglesInAir start(count, nasty, random);
      TrianglesInAir reference = start;
      const Records expected = reference.pushed(kernels_sequential().air);
      for (const std::string& isa : available_isas()) {
        TrianglesInAir in_lanes = start;
        const Records found = in_lanes.pushed(pick_kernels(isa).air);
        const std::string what = isa + ", " + std::to_string(count) + " triangles";
        ASSERT_NO_FATAL_FAILURE(expect_same(in_lanes.forces, reference.forces, what + ", forces"));
        ASSERT_NO_FATAL_FAILURE(expect_same(found, expected, what + ", velocities"));
      }
    }
}

}  // namespace
}  // namespace pliant
