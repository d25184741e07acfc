// Compares cells, kernels and the field with brute force.
#include "surface/field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "surface_support.h"

namespace pliant {
namespace {

using namespace surface;

/// A kernel's value at a point, by its definition.
double value_of(const Splat& splat, const Vec3d& at) {
  const Vec3d d = at - convert<double>(splat.centre);
  const auto a = [](float v) { return static_cast<double>(v); };
  const double q = a(splat.xx) * d.x * d.x + a(splat.yy) * d.y * d.y + a(splat.zz) * d.z * d.z +
                   2 * (a(splat.xy) * d.x * d.y + a(splat.xz) * d.x * d.z + a(splat.yz) * d.y * d.z);
  return q < 1 ? a(splat.weight) * std::pow(1 - q, 3) : 0;
}

Splats kernels_of(const std::vector<Vec3f>& particles) {
  Executor executor(1);
  return make_splats(sort_into_cells(particles, spacing, executor), spacing, true, executor);
}

/// The kernel of the particle nearest to a point.
Splat kernel_near(const Splats& splats, const Vec3f& point) {
  return *std::min_element(splats.all.begin(), splats.all.end(), [&](const Splat& a, const Splat& b) {
    return length_squared(a.centre - point) < length_squared(b.centre - point);
  });
}

/// The integral of a kernel by the midpoint rule, over spacing^3.
double integral(const Splat& splat) {
  constexpr int n = 40;
  double sum = 0;
  const auto along = [](int i) { return (2 * i + 1 - n) / static_cast<double>(n); };
  const Vec3d reach = convert<double>(splat.reach), centre = convert<double>(splat.centre);
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        sum += value_of(splat, centre + Vec3d{along(i) * reach.x, along(j) * reach.y, along(k) * reach.z});
  const double each = 8 * reach.x * reach.y * reach.z / (n * n * n);
  return sum * each / std::pow(static_cast<double>(spacing), 3);
}

TEST(Kernels, AParticleAloneHasABall) {
  const Splat splat = kernel_near(kernels_of({{0.3f, 0.2f, 0.1f}}), {});
  EXPECT_EQ(splat.reach.x, splat.reach.y);
  EXPECT_EQ(splat.reach.x, splat.reach.z);
  EXPECT_EQ(splat.xy, 0);
}

TEST(Kernels, WithNeighboursOnAllSidesTheIntegralIsTheParticlesVolume) {
  const Vec3f middle = offset + Vec3f{10, 10, 10} * spacing;
  const Splat splat = kernel_near(kernels_of(lattice(20)), middle);
  EXPECT_NEAR(integral(splat), 1, 1e-3);
  EXPECT_NEAR(splat.reach.x / spacing, 2, 1e-3);
}

TEST(Kernels, AreFlatAtASurfaceAndFlatterInASheet) {
  const Vec3f top = offset + Vec3f{10, 20, 10} * spacing;
  const Splat at_surface = kernel_near(kernels_of(lattice(20)), top);
  EXPECT_LT(at_surface.reach.y, 0.8f * at_surface.reach.x);
  EXPECT_NEAR(integral(at_surface), 1, 0.05);
  std::vector<Vec3f> sheet;
  for (const Vec3f& p : lattice(20))
    if (p.y < offset.y + spacing) sheet.push_back(p);
  const Splat in_sheet = kernel_near(kernels_of(sheet), offset + Vec3f{10, 0.5f, 10} * spacing);
  EXPECT_LT(in_sheet.reach.y, at_surface.reach.y);
  EXPECT_LT(in_sheet.reach.y, 0.6f * in_sheet.reach.x);
}

TEST(Kernels, FollowATiltedThread) {
  // A thread along (1, 1, 0): the kernel is wider along it than across.
  std::vector<Vec3f> thread;
  for (int i = -5; i <= 5; ++i) thread.push_back(Vec3f{1, 1, 0} * (static_cast<float>(i) * spacing * 0.7f));
  const Splat splat = kernel_near(kernels_of(thread), {});
  const double step = static_cast<double>(spacing);
  EXPECT_GT(value_of(splat, Vec3d{1, 1, 0} * (0.7 * step)), 2 * value_of(splat, Vec3d{1, -1, 0} * (0.7 * step)));
  EXPECT_LT(splat.reach.z, splat.reach.x);
}

TEST(ParticleCells, HaveEachParticleOnce) {
  Executor executor(1);
  std::vector<Vec3f> particles = spray(3000, 30, 3);
  particles.push_back({900, -800, 700});
  const ParticleCells cells = sort_into_cells(particles, spacing, executor);
  std::map<std::uint64_t, std::vector<Vec3f>> expected;
  for (const Vec3f& p : particles) expected[key_of(cell_at(p, 1 / cells.side))].push_back(p);
  ASSERT_EQ(static_cast<std::size_t>(cells.size()), expected.size());
  int cell = 0;
  for (const auto& [key, members] : expected) {
    EXPECT_EQ(cells.keys[static_cast<std::size_t>(cell)], key);
    EXPECT_EQ(cells.find(cell_of(key)), cell);
    const std::span<const Vec3f> found = cells.particles(cell++);
    EXPECT_TRUE(std::equal(found.begin(), found.end(), members.begin(), members.end()));
  }
  EXPECT_EQ(cells.find({12345, 0, 0}), -1);
}

/// Checks all nodes of a field: their value is the sum of the kernels, or 1 where that sum is above the level by 0.1 or
/// more. Returns the number of the latter.
int expect_sums(const std::vector<Vec3f>& particles, float cell) {
  Executor executor(2);
  const ParticleCells cells = sort_into_cells(particles, spacing, executor);
  const Splats splats = make_splats(cells, spacing, true, executor);
  const Field field = make_field(cells, splats, cell, executor);
  int skipped = 0, wrong = 0;
  for (int block = 0; block < field.size(); ++block)
    for (int node = 0; node < 512; ++node) {
      const Cell b = cell_of(field.keys[static_cast<std::size_t>(block)]);
      const Cell place{8 * b.x + node % 8, 8 * b.y + node / 8 % 8, 8 * b.z + node / 64};
      const Vec3d at = Vec3d{place.x + 0., place.y + 0., place.z + 0.} * static_cast<double>(cell);
      double sum = 0;
      for (const Splat& splat : splats.all) sum += value_of(splat, at);
      const double value = static_cast<double>(field.at(block, node));
      const bool is_skipped = value == 1 && sum > static_cast<double>(surface_level) + 0.1;
      skipped += is_skipped ? 1 : 0;
      wrong += is_skipped || std::abs(value - sum) < 1e-4 ? 0 : 1;
    }
  EXPECT_EQ(wrong, 0) << "cell " << cell;
  return skipped;
}

TEST(Field, IsTheSumOfAllKernels) {
  EXPECT_GT(expect_sums(lattice(12, 0.2f), spacing / 2), 0);
  expect_sums(lattice(11, 0.1f), spacing * 0.8f);
  EXPECT_EQ(expect_sums(spray(300, 8, 5), spacing / 2), 0);
}

TEST(Field, ReachesAllKernels) {
  // Beyond the blocks the field counts as 0, so the first node outside them must be out of each kernel's reach.
  Executor executor(1);
  const std::vector<Vec3f> particles = spray(200, 20, 9);
  const ParticleCells cells = sort_into_cells(particles, spacing, executor);
  const Splats splats = make_splats(cells, spacing, true, executor);
  const float cell = spacing / 2;
  const Field field = make_field(cells, splats, cell, executor);
  for (const Splat& splat : splats.all)
    for (const float side : {-1.f, 1.f})
      for (int axis = 0; axis < 3; ++axis) {
        Vec3f tip = splat.centre;
        (axis == 0   ? tip.x
         : axis == 1 ? tip.y
                     : tip.z) += side * (axis == 0   ? splat.reach.x
                                         : axis == 1 ? splat.reach.y
                                                     : splat.reach.z);
        EXPECT_GE(field.table.find(key_of(cell_at(tip, 1 / (8 * cell)))), 0);
      }
}

}  // namespace
}  // namespace pliant
