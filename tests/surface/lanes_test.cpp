// Instruction set levels, the search for cells around, and the links of the mesh.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <utility>

#include "surface/marching_cubes.h"
#include "surface/smooth_mesh.h"
#include "surface/splat_formula.h"
#include "surface_support.h"

namespace pliant {
namespace {

using namespace surface;

/// A block, a spray, and a crowd that exceeds the candidates that are compared at a time.
std::vector<Vec3f> mixture() {
  std::vector<Vec3f> particles = lattice(9, 0.2f);
  for (const Vec3f& p : spray(3000, 30, 11)) particles.push_back(p + Vec3f{1, 0, 0});
  for (const Vec3f& p : spray(2500, 3, 12)) particles.push_back(p + Vec3f{0, 1, 0});
  particles.push_back({-700, 800, 900});
  return particles;
}

bool same_bits(const void* a, const void* b, std::size_t size) { return std::memcmp(a, b, size) == 0; }

void expect_same(const Field& a, const Field& b, std::size_t level) {
  ASSERT_EQ(a.keys, b.keys) << "level " << level;
  for (std::size_t block = 0; block < a.keys.size(); ++block) {
    EXPECT_EQ(a.blocks[block].inside, b.blocks[block].inside) << "level " << level << ", block " << block;
    for (std::size_t brick = 0; brick < block_bricks; ++brick)
      EXPECT_TRUE(same_bits(a.blocks[block].values[brick], b.blocks[block].values[brick], brick_nodes * sizeof(float)))
          << "level " << level << ", block " << block << ", brick " << brick;
  }
}

TEST(SurfaceKernels, AllLevelsGiveTheSameBits) {
  Executor executor(1);
  const ParticleCells cells = sort_into_cells(mixture(), spacing, executor);
  const std::vector<const SurfaceKernels*> levels = all_kernels();
  for (const bool anisotropic : {true, false}) {
    const Splats splats = make_splats(cells, spacing, anisotropic, executor, *levels.front());
    const Field field = make_field(cells, splats, spacing * 0.45f, executor, *levels.front());
    for (std::size_t level = 1; level < levels.size(); ++level) {
      const Splats others = make_splats(cells, spacing, anisotropic, executor, *levels[level]);
      EXPECT_TRUE(same_bits(splats.all.data(), others.all.data(), splats.all.size() * sizeof(Splat)))
          << "level " << level;
      EXPECT_TRUE(splats.widest == others.widest && splats.per_x == others.per_x) << "level " << level;
      expect_same(field, make_field(cells, others, spacing * 0.45f, executor, *levels[level]), level);
    }
  }
}

/// A kernel by its definition, from all particles.
Kernel<float> expected_kernel(const std::vector<Vec3f>& particles, const Vec3f& at) {
  double sum = 0;
  Vec3d places{};
  Symmetric<double> products{};
  const double radius = 2 * static_cast<double>(spacing);
  for (const Vec3f& p : particles) {
    const Vec3d d = convert<double>(p) - convert<double>(at);
    const double w = std::max(0., 1 - dot(d, d) / (radius * radius));
    sum += w;
    places += d * w;
    products.xx += w * d.x * d.x, products.yy += w * d.y * d.y, products.zz += w * d.z * d.z;
    products.xy += w * d.x * d.y, products.xz += w * d.x * d.z, products.yz += w * d.y * d.z;
  }
  const auto f = [](double v) { return static_cast<float>(v); };
  const Symmetric<float> c = covariance(
      f(sum), convert<float>(places),
      {f(products.xx), f(products.yy), f(products.zz), f(products.xy), f(products.xz), f(products.yz)}, spacing);
  const float trace = trace_of(c);
  return make_kernel(squared_radii(c, trace, true), gain_of(trace), spacing);
}

TEST(SurfaceKernels, FollowTheDefinitionInAnyCrowd) {
  Executor executor(2);
  for (const std::vector<Vec3f>& particles : {spray(2500, 3, 12), spray(400, 12, 5), lattice(3, 0.2f)}) {
    const ParticleCells cells = sort_into_cells(particles, spacing, executor);
    const Splats splats = make_splats(cells, spacing, true, executor);
    for (std::size_t i = 0; i < splats.all.size(); i += 7) {
      const Splat& splat = splats.all[i];
      const Kernel<float> expected = expected_kernel(particles, splat.centre);
      const float largest_entry = std::max({expected.a.xx, expected.a.yy, expected.a.zz});
      for (const auto& [a, b] : {std::pair{splat.xx, expected.a.xx},
                                 {splat.yy, expected.a.yy},
                                 {splat.zz, expected.a.zz},
                                 {splat.xy, expected.a.xy},
                                 {splat.xz, expected.a.xz},
                                 {splat.yz, expected.a.yz}})
        EXPECT_NEAR(a / largest_entry, b / largest_entry, 1e-4f) << i;
      EXPECT_NEAR(splat.weight / expected.weight, 1, 1e-4f) << i;
    }
  }
}

TEST(SurfaceKernels, AreWithinTheEllipsoidThatBoundsThem) {
  // Directions in which q = 1: there the sum of squared shares of the reach is at most `widest`.
  Executor executor(1);
  const ParticleCells cells = sort_into_cells(mixture(), spacing, executor);
  const Splats splats = make_splats(cells, spacing, true, executor);
  for (std::size_t i = 0; i < splats.all.size(); i += 3) {
    const Splat& s = splats.all[i];
    for (const Vec3f& d :
         {Vec3f{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, -1, 0}, {1, 0, 1}, {0, 1, -1}, {1, 1, 1}, {1, -1, 1}}) {
      const float q = s.xx * d.x * d.x + s.yy * d.y * d.y + s.zz * d.z * d.z +
                      2 * (s.xy * d.x * d.y + s.xz * d.x * d.z + s.yz * d.y * d.z);
      const float x = d.x / s.reach.x, y = d.y / s.reach.y, z = d.z / s.reach.z;
      EXPECT_LE((x * x + y * y + z * z) / q, splats.widest[i] * 1.0001f) << i;
      EXPECT_LE(std::max({x * x, y * y, z * z}) / q, 1.0001f) << i;
    }
  }
}

TEST(CellsAround, AreThoseThatTheTableFinds) {
  Executor executor(1);
  const ParticleCells cells = sort_into_cells(mixture(), spacing, executor);
  for (const int start : {0, 1, cells.size() / 3, cells.size() - 1}) {
    CellsAround around(cells, start);
    for (int cell = start; cell < cells.size(); cell += 1 + cell % 3) {
      const Cell c = cell_of(cells.keys[static_cast<std::size_t>(cell)]);
      const std::array<CellRow, 9> rows = around.of(cell);
      for (int row = 0; row < 9; ++row) {
        std::vector<int> found, expected;
        for (int i = rows[static_cast<std::size_t>(row)].first; i < rows[static_cast<std::size_t>(row)].last; ++i)
          found.push_back(i);
        for (int x = -1; x <= 1; ++x) {
          const int at = cells.find({c.x + x, c.y + row % 3 - 1, c.z + row / 3 - 1});
          if (at >= 0) expected.push_back(at);
        }
        EXPECT_EQ(found, expected) << "cell " << cell << ", row " << row;
      }
    }
  }
}

LinkedMesh linked_mesh(const std::vector<Vec3f>& particles, float cell) {
  Executor executor(2);
  const ParticleCells cells = sort_into_cells(particles, spacing, executor);
  return marching_cubes(make_field(cells, make_splats(cells, spacing, true, executor), cell, executor), executor);
}

TEST(LinkedMesh, LinksAreMutualAndEdgesOfTriangles) {
  for (const float cell : {spacing, spacing / 2}) {
    const LinkedMesh mesh = linked_mesh(spray(3000, 20, 3), cell);
    std::set<std::pair<int, int>> edges;
    for (const auto& t : mesh.triangles)
      for (std::size_t i = 0; i < 3; ++i) edges.insert({t[i], t[(i + 1) % 3]});
    const auto links_of = [&](int v) {
      const Links& links = mesh.links[static_cast<std::size_t>(v)];
      return std::set<int>(links.begin(), links.end());
    };
    ASSERT_GT(mesh.size, 1000);
    for (int v = 0; v < mesh.size; ++v) {
      EXPECT_EQ(links_of(v).size(), 4U) << v;
      for (const int other : links_of(v)) {
        EXPECT_EQ(links_of(other).count(v), 1U) << v << ", " << other;
        EXPECT_EQ(edges.count({v, other}), 1U) << v << ", " << other;
      }
    }
  }
}

TEST(LinkedMesh, SmoothingKeepsTheVolume) {
  const std::vector<Vec3f> particles = ball(8);
  Executor executor(2);
  LinkedMesh rough = linked_mesh(particles, spacing / 2), smoothed = linked_mesh(particles, spacing / 2);
  smooth(smoothed, 10, executor);
  const double before = volume(unlinked(std::move(rough), executor)),
               after = volume(unlinked(std::move(smoothed), executor));
  EXPECT_NEAR(after / before, 1, 0.003);
}

TEST(LiquidSurface, ASprayHasTheSameBitsOnAnyNumberOfThreads) {
  const std::vector<Vec3f> particles = mixture();
  const TriangleMesh alone = liquid_surface(particles, {.spacing = spacing, .threads = 1});
  for (const int threads : {2, 3, 8}) {
    const TriangleMesh mesh = liquid_surface(particles, {.spacing = spacing, .threads = threads});
    EXPECT_TRUE(mesh.positions == alone.positions && mesh.triangles == alone.triangles) << threads << " threads";
  }
}

}  // namespace
}  // namespace pliant
