// Tests that launch runs the same functors on the host and on a device with the same bits.
#include <gtest/gtest.h>

#include <cstring>

#include "device.h"
#include "parallel/launch.h"

#include "launch_case.h"

namespace pliant::cuda {
namespace {

constexpr int side = 50, particles = side * side;

void add_triangle(LaunchCase& c, int a, int b, int d) {
  for (const int corner : {a, b, d}) c.triangles.push_back(corner);
}

/// A crumpled moving sheet of `side` by `side` particles; a seventh of them has infinite mass.
LaunchCase sheet() {
  LaunchCase c;
  std::uint32_t state = 10;
  const auto number = [&](float size) {
    state = state * 1664525u + 1013904223u;
    return size * (static_cast<float>(state >> 8) * (2.f / 16777216) - 1);
  };
  for (int i = 0; i < particles; ++i) {
    const float x = 0.02f * static_cast<float>(i % side), z = 0.02f * static_cast<float>(i / side);
    c.positions.push_back(
        {x + number(0.005f), number(0.01f), z + number(0.005f), i % 7 == 0 ? 0.f : 900 + number(100)});
    c.displacements.push_back({number(1e-3f), number(1e-3f), number(1e-3f), 0});
    c.remainders.push_back({number(1e-9f), number(1e-9f), number(1e-9f), 0});
    c.velocities.push_back({number(2), number(2), number(2), 0});
  }
  for (int z = 0; z + 1 < side; ++z)
    for (int x = 0; x + 1 < side; ++x) {
      const int i = z * side + x;
      add_triangle(c, i, i + 1, i + side);
      add_triangle(c, i + 1, i + side + 1, i + side);
    }
  c.corner_begin.assign(particles + 1, 0);
  for (const int corner : c.triangles) ++c.corner_begin[static_cast<std::size_t>(corner) + 1];
  for (std::size_t p = 0; p < particles; ++p) c.corner_begin[p + 1] += c.corner_begin[p];
  std::vector<int> next(c.corner_begin.begin(), c.corner_begin.end() - 1);
  c.corners.resize(c.triangles.size());
  for (std::size_t k = 0; k < c.triangles.size(); ++k)
    c.corners[static_cast<std::size_t>(next[static_cast<std::size_t>(c.triangles[k])]++)] =
        static_cast<int>(k / 3 * 4 + k % 3);
  c.forces.resize(c.triangles.size() / 3);
  c.nonfinite.resize(particles, 2);
  return c;
}

template <class T>
bool same(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

TEST(Launch, SameBitsOnHostAndDevice) {
  const std::string reason = why_no_device();
  if (!reason.empty()) GTEST_SKIP() << "no device to compare with: " << reason;
  LaunchCase host = sheet(), device = sheet();
  Executor executor(2);
  for (int step = 0; step < 3; ++step) {
    launch_all(executor, host.view());
    launch_all_on_device(device);
  }
  EXPECT_TRUE(same(host.positions, device.positions));
  EXPECT_TRUE(same(host.displacements, device.displacements));
  EXPECT_TRUE(same(host.remainders, device.remainders));
  EXPECT_TRUE(same(host.velocities, device.velocities));
  EXPECT_TRUE(same(host.forces, device.forces));
  EXPECT_TRUE(same(host.nonfinite, device.nonfinite));
}

/// Without a device, tests at least that the run on the host has an effect.
TEST(Launch, MovesTheSheet) {
  LaunchCase before = sheet(), after = sheet();
  Executor executor(1);
  launch_all(executor, after.view());
  EXPECT_FALSE(same(before.positions, after.positions));
  EXPECT_FALSE(same(before.velocities, after.velocities));
  for (const unsigned char flag : after.nonfinite) EXPECT_EQ(flag, 0);
}

}  // namespace
}  // namespace pliant::cuda
