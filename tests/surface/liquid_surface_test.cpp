// Surfaces of particles whose liquid has a known shape.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "pliant/error.h"
#include "surface_support.h"

namespace pliant {
namespace {

SurfaceOptions options() { return {.spacing = spacing}; }

TriangleMesh surface(const std::vector<Vec3f>& particles) { return liquid_surface(particles, options()); }

TEST(LiquidSurface, NoParticlesHaveAnEmptyMesh) {
  const TriangleMesh mesh = surface({});
  EXPECT_TRUE(mesh.positions.empty());
  EXPECT_TRUE(mesh.triangles.empty());
}

TEST(LiquidSurface, EncloseTheVolumeOfABlock) {
  // A twentieth of a spacing on each of the six faces of 20 spacings.
  const std::vector<Vec3f> particles = lattice(20);
  const TriangleMesh mesh = surface(particles);
  EXPECT_EQ(topology_fault(mesh), "");
  EXPECT_NEAR(volume_share(particles, mesh), 1, 0.015);
}

TEST(LiquidSurface, EncloseTheVolumeOfABall) {
  const std::vector<Vec3f> particles = ball(8);
  const TriangleMesh mesh = surface(particles);
  EXPECT_EQ(topology_fault(mesh), "");
  EXPECT_NEAR(volume_share(particles, mesh), 1, 0.03);
  EXPECT_EQ(components(mesh), 1);
}

TEST(LiquidSurface, AParticleAloneIsASmallBall) {
  const Vec3f centre{0.31f, -0.17f, 2.03f};
  const TriangleMesh mesh = surface({centre});
  EXPECT_EQ(topology_fault(mesh), "");
  float nearest = 1, farthest = 0;
  for (const Vec3f& p : mesh.positions) {
    nearest = std::min(nearest, length(p - centre) / spacing);
    farthest = std::max(farthest, length(p - centre) / spacing);
  }
  // A ball of its volume has a radius of 0.62 spacings. A quarter of a cell of tolerance.
  EXPECT_GT(nearest, 0.62f - 0.125f);
  EXPECT_LT(farthest, 0.62f + 0.125f);
  EXPECT_GT(volume(mesh), 0);
}

TEST(LiquidSurface, BlocksApartAreTwoComponents) {
  std::vector<Vec3f> particles = lattice(6);
  for (const Vec3f& p : lattice(6)) particles.push_back(p + Vec3f{1, 0.5f, 0});
  const TriangleMesh mesh = surface(particles);
  EXPECT_EQ(topology_fault(mesh), "");
  EXPECT_EQ(components(mesh), 2);
}

/// The heights of the surface above the top of a block, away from its edges, in spacings.
std::vector<float> top_of_block(const TriangleMesh& mesh, int n) {
  const float side = static_cast<float>(n) * spacing, edge = 4 * spacing;
  std::vector<float> heights;
  for (const Vec3f& vertex : mesh.positions) {
    const Vec3f p = vertex - offset;
    const bool is_inner = p.x > edge && p.z > edge && p.x < side - edge && p.z < side - edge;
    if (is_inner && p.y > side / 2) heights.push_back((p.y - side) / spacing);
  }
  return heights;
}

struct Bumps {
  double mean = 0, rms = 0;  ///< rms: of the deviation from the mean
};

Bumps bumps_of(const std::vector<float>& heights) {
  Bumps b;
  for (const float h : heights) b.mean += static_cast<double>(h) / static_cast<double>(heights.size());
  for (const float h : heights)
    b.rms += std::pow(static_cast<double>(h) - b.mean, 2) / static_cast<double>(heights.size());
  b.rms = std::sqrt(b.rms);
  return b;
}

TEST(LiquidSurface, TheTopOfALatticeIsFlat) {
  const Bumps bumps = bumps_of(top_of_block(surface(lattice(20)), 20));
  EXPECT_LT(bumps.rms, 0.005);            // a hundredth of a cell
  EXPECT_LT(std::abs(bumps.mean), 0.05);  // a tenth of a cell
}

TEST(LiquidSurface, TheTopIsSmootherThanTheParticles) {
  // Shifts of up to a tenth of a spacing have an rms of 0.1 / sqrt 3.
  const Bumps bumps = bumps_of(top_of_block(surface(lattice(20, 0.1f)), 20));
  EXPECT_LT(bumps.rms, 0.1 / std::sqrt(3.));
}

TEST(LiquidSurface, ASheetOfOneLayerHasNoHoles) {
  std::vector<Vec3f> particles;
  for (const Vec3f& p : lattice(12))
    if (p.y < offset.y + spacing) particles.push_back(p);
  const TriangleMesh mesh = surface(particles);
  EXPECT_EQ(topology_fault(mesh), "");
  EXPECT_EQ(components(mesh), 1);
  // Euler's formula: V - E + F = 2 without a hole, and a closed mesh has 3 F / 2 edges.
  const int vertices = static_cast<int>(mesh.positions.size()), triangles = static_cast<int>(mesh.triangles.size());
  EXPECT_EQ(vertices - triangles / 2, 2);
  EXPECT_NEAR(volume_share(particles, mesh), 1, 0.15);
}

TEST(LiquidSurface, TheMeshOfASprayIsTwoManifold) {
  // With cells of a spacing the field is coarse, so all cases of marching cubes occur.
  for (unsigned seed = 0; seed < 4; ++seed)
    for (const float cell : {spacing, spacing / 2}) {
      const std::vector<Vec3f> particles = spray(6000, 25, seed);
      const TriangleMesh mesh = liquid_surface(particles, {.spacing = spacing, .cell = cell});
      EXPECT_EQ(topology_fault(mesh), "") << "seed " << seed << ", cell " << cell;
      EXPECT_GT(volume(mesh), 0);
    }
}

TEST(LiquidSurface, FacesOutwards) {
  // Each triangle of a ball's surface has its normal away from the centre.
  const TriangleMesh mesh = surface(ball(5));
  Vec3d centre{};
  for (int v = 0; v < static_cast<int>(mesh.positions.size()); ++v) centre += at(mesh, v);
  centre = centre * (1.0 / static_cast<double>(mesh.positions.size()));
  for (const auto& t : mesh.triangles) {
    const Vec3d a = at(mesh, t[0]), b = at(mesh, t[1]), c = at(mesh, t[2]);
    EXPECT_GT(dot(cross(b - a, c - a), (a + b + c) * (1.0 / 3) - centre), 0);
  }
}

bool same_bits(const TriangleMesh& a, const TriangleMesh& b) {
  return a.positions == b.positions && a.triangles == b.triangles;
}

TEST(LiquidSurface, SameBitsOnAnyNumberOfThreads) {
  SurfaceOptions one = options();
  one.threads = 1;
  const std::vector<Vec3f> particles = lattice(16, 0.3f);
  const TriangleMesh alone = liquid_surface(particles, one);
  for (const int threads : {2, 3, 8}) {
    SurfaceOptions several = options();
    several.threads = threads;
    EXPECT_TRUE(same_bits(alone, liquid_surface(particles, several))) << threads << " threads";
  }
}

TEST(LiquidSurface, AStrayParticleCostsNoMoreThanItsOwnBall) {
  // A grid over the bounding box would have 10^15 cells.
  std::vector<Vec3f> particles = lattice(8);
  const TriangleMesh without = surface(particles);
  const Vec3f stray{4000, -3000, 1000};
  particles.push_back(stray);
  const TriangleMesh with = surface(particles);
  EXPECT_EQ(topology_fault(with), "");
  EXPECT_EQ(components(with), 2);
  EXPECT_EQ(with.positions.size(), without.positions.size() + surface({stray}).positions.size());
}

TEST(LiquidSurface, FinerCellsKeepTheShape) {
  const std::vector<Vec3f> particles = ball(6);
  const double usual = volume_share(particles, surface(particles));
  for (const float cells : {1.f, 3.f, 8.f}) {
    const TriangleMesh mesh = liquid_surface(particles, {.spacing = spacing, .cell = spacing / cells});
    EXPECT_EQ(topology_fault(mesh), "") << cells;
    EXPECT_NEAR(volume_share(particles, mesh), usual, 0.02) << cells;
  }
}

TEST(LiquidSurface, CellsWithoutALinkToTheSpacingWork) {
  for (const float share : {0.37f, 0.71f, 0.93f}) {
    const std::vector<Vec3f> particles = lattice(14, 0.2f);
    const TriangleMesh mesh = liquid_surface(particles, {.spacing = spacing, .cell = spacing * share});
    EXPECT_EQ(topology_fault(mesh), "") << share;
    EXPECT_EQ(components(mesh), 1) << share;
  }
}

std::string message_of(const std::vector<Vec3f>& particles, const SurfaceOptions& of) {
  try {
    liquid_surface(particles, of);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(LiquidSurface, ErrorsNameTheParticle) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  for (const Vec3f& bad :
       {Vec3f{nan, 0, 0}, Vec3f{0, nan, 0}, Vec3f{0, 0, nan}, Vec3f{0, infinity, 0}, Vec3f{-infinity, 0, infinity}})
    EXPECT_EQ(message_of({{0, 0, 0}, {1, 0, 0}, bad}, options()),
              "particle 2: has a position that is not finite; leave it out, or find what made it so");
  EXPECT_EQ(
      message_of({{0, 0, -6e4f}}, options()),
      "particle 0: is farther from the origin than a million spacings; leave it out, or move the liquid to the origin");
}

TEST(LiquidSurface, ErrorsNameTheOption) {
  const auto starts_with = [](const std::string& text, const char* start) { return text.rfind(start, 0) == 0; };
  for (const float bad : {0.f, -1.f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
    EXPECT_TRUE(starts_with(message_of({}, {.spacing = bad}), "spacing: ")) << bad;
  for (const float bad : {-0.1f, 0.001f, 0.06f, std::numeric_limits<float>::quiet_NaN()})
    EXPECT_TRUE(starts_with(message_of({}, {.spacing = spacing, .cell = bad}), "cell: ")) << bad;
  EXPECT_TRUE(starts_with(message_of({}, {.spacing = spacing, .smoothing = -1}), "smoothing: "));
  EXPECT_TRUE(starts_with(message_of({}, {.spacing = spacing, .threads = -1}), "threads: "));
}

}  // namespace
}  // namespace pliant
