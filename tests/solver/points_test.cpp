// Tests that the functors of particles, run block by block in reverse order, give the bits of every kernel table: what
// a device will run is what the lanes run.
#include "solver/points.h"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "parallel/launch.h"
#include "support/kernels.h"

namespace pliant {
namespace {

using testing_support::available_code_paths;

constexpr int point_count = 2 * launch_block + 37;

/// Records of particles, a seventh of them with infinite mass.
struct LaunchedParticles {
  std::vector<Record> positions, displacements, remainders, velocities;

  LaunchedParticles() {
    std::mt19937 random(10);
    std::uniform_real_distribution<float> metres(-2, 2);
    const auto make = [&](std::vector<Record>& records, float size) {
      for (int i = 0; i < point_count; ++i)
        records.push_back({size * metres(random), size * metres(random), size * metres(random), 0});
    };
    make(positions, 1);
    make(displacements, 1e-3f);
    make(remainders, 1e-9f);
    make(velocities, 3);
    for (int i = 0; i < point_count; ++i)
      positions[static_cast<std::size_t>(i)].w = i % 7 == 0 ? 0 : 1.f + static_cast<float>(i);
  }

  AdvanceArguments arguments() {
    AdvanceArguments a;
    a.positions = positions.data();
    a.displacements = displacements.data();
    a.remainders = remainders.data();
    a.velocities = velocities.data();
    a.last = point_count;
    a.h = 1.f / 600;
    a.inverse_h = 600;
    a.velocity_kept = 0.99f;
    a.gravity_finished = {0, -0.03f, 0.01f};
    a.gravity_begun = {0, -0.05f, 0.02f};
    a.gravity_settled = {0.001f, -0.16f, 0};
    return a;
  }
};

bool same(const std::vector<Record>& a, const std::vector<Record>& b) {
  return std::memcmp(a.data(), b.data(), a.size() * sizeof(Record)) == 0;
}

void expect_same(const LaunchedParticles& a, const LaunchedParticles& b, const std::string& what) {
  EXPECT_TRUE(same(a.positions, b.positions)) << what << ": positions";
  EXPECT_TRUE(same(a.displacements, b.displacements)) << what << ": displacements";
  EXPECT_TRUE(same(a.remainders, b.remainders)) << what << ": remainders";
  EXPECT_TRUE(same(a.velocities, b.velocities)) << what << ": velocities";
}

template <class Functor>
void run_backwards(const Functor& functor) {
  for (int block = launch_blocks(point_count) - 1; block >= 0; --block) run_block(functor, block, point_count);
}

TEST(Points, UpdateAsEveryTableOfKernels) {
  LaunchedParticles expected;
  run_backwards(UpdatePoint{expected.arguments()});
  for (const std::string& isa : available_code_paths()) {
    LaunchedParticles found;
    pick_kernels(isa).update(found.arguments());
    expect_same(found, expected, isa);
  }
}

TEST(Points, PredictAsEveryTableOfKernels) {
  LaunchedParticles expected;
  run_backwards(PredictPoint{expected.arguments()});
  for (const std::string& isa : available_code_paths()) {
    LaunchedParticles found;
    pick_kernels(isa).predict(found.arguments(), nullptr);
    expect_same(found, expected, isa);
  }
}

TEST(Points, AdvanceOnAnyNumberOfThreads) {
  LaunchedParticles expected;
  pick_kernels("sequential").advance(expected.arguments(), nullptr);
  for (const int threads : {1, 2, 4}) {
    LaunchedParticles found;
    Executor executor(threads);
    launch(executor, "update", point_count, UpdatePoint{found.arguments()});
    launch(executor, "predict", point_count, PredictPoint{found.arguments()});
    expect_same(found, expected, std::to_string(threads) + " threads");
  }
}

TEST(Points, FindWhatIsNotFinite) {
  LaunchedParticles particles;
  particles.displacements[1500].z = std::numeric_limits<float>::infinity();
  particles.displacements[3].x = particles.displacements[1500].z - particles.displacements[1500].z;
  std::vector<unsigned char> nonfinite(point_count, 2);
  run_backwards(FindNonfinite{particles.displacements.data(), nonfinite.data()});
  for (int i = 0; i < point_count; ++i)
    EXPECT_EQ(nonfinite[static_cast<std::size_t>(i)], i == 3 || i == 1500 ? 1 : 0) << i;
}

}  // namespace
}  // namespace pliant
