// Tests that fine sheets bend as their material says, whatever the mesh, the substeps and the frame time: cantilevers
// against the beam's formula, the same sheet by halves of them against itself; and that bending moves nothing by
// itself.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "core/at.h"
#include "math/vector.h"
#include "pliant/mesh.h"
#include "pliant/world.h"

namespace pliant {
namespace {

constexpr double gravity_of_tests = 9.81, sag_over_length = 0.05;

struct Strip {
  std::string material = "cotton";
  int edges = 12;  ///< in the free length
  double moved = 0;
  bool alternates = false;
  float heavier = 1;         ///< of the material's mass and stiffness
  int behind = 1;            ///< rows pinned behind that of the clamp
  bool is_attached = false;  ///< the clamp is made of rigid attachments instead of pins
  double rounded = 0;        ///< heights at random up to this share of an edge
  int columns = 9;
};

TriangleMesh mesh_of(const Strip& strip, double edge) {
  std::mt19937 random(1);
  const auto uniform = [&] { return strip.moved * (static_cast<double>(random() % 65536) / 32768 - 1); };
  const int rows = strip.edges + 1 + strip.behind;
  TriangleMesh mesh;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < strip.columns; ++j) {
      const bool is_inner = i > strip.behind && j > 0 && i + 1 < rows && j + 1 < strip.columns;
      const double x = i - strip.behind + (is_inner ? uniform() : 0), z = j + (is_inner ? uniform() : 0);
      const double y = strip.rounded * (static_cast<double>((i * 7 + j * 5) % 11) / 5 - 1);
      mesh.positions.push_back(
          {static_cast<float>(x * edge), static_cast<float>(y * edge), static_cast<float>(z * edge)});
    }
  for (int i = 0; i + 1 < rows; ++i)
    for (int j = 0; j + 1 < strip.columns; ++j) {
      const int a = i * strip.columns + j, b = a + strip.columns, c = b + 1, d = a + 1;
      const bool crosses = strip.alternates && (i + j) % 2 == 1;
      mesh.triangles.push_back(crosses ? std::array<int, 3>{a, d, b} : std::array<int, 3>{a, c, b});
      mesh.triangles.push_back(crosses ? std::array<int, 3>{b, d, c} : std::array<int, 3>{a, d, c});
    }
  return mesh;
}

/// The sag of a cantilever at rest, clamped by two rows or more, over q L^4 / (8 B). Its length is chosen for a sag of
/// L / 20.
double sag_ratio(const Strip& strip, int substeps, double frame_time = 1.0 / 60) {
  Fabric material = fabric(strip.material);
  for (float* value : {&material.area_density, &material.bending_stiffness, &material.stretch_stiffness})
    *value *= strip.heavier;
  const double q = double(material.area_density) * gravity_of_tests, b = double(material.bending_stiffness);
  const double length = std::cbrt(8 * sag_over_length * b / q);
  ClothOptions options;
  options.material = material;
  Object cloth = make_cloth(mesh_of(strip, length / strip.edges), options);
  cloth.damping = 10;
  for (int i = 0; i < (1 + strip.behind) * strip.columns; ++i) {
    if (strip.is_attached)
      cloth.attachments.push_back({i, cloth.positions[at(i)], {}, Stiffness::compliance(0)});
    else
      cloth.pins.push_back({i, {}});
  }
  Scene scene;
  scene.frame_time = static_cast<float>(frame_time);
  scene.settings.substeps = substeps;
  scene.add(cloth);
  World world(scene);
  for (int frame = 0; frame < 1.2 / frame_time; ++frame) world.step(static_cast<float>(frame_time));
  const std::vector<Vec3f> at_rest = world.object(world.objects().front()).positions();
  double tip = 0;
  for (int j = 0; j < strip.columns; ++j) tip -= double(at_rest[at_rest.size() - at(j) - 1].y) / strip.columns;
  return tip / (q * length * length * length * length / (8 * b));
}

TEST(SheetBendingInAWorld, SagsAsTheBeamOfItsFabricDoes) {
  for (const char* material : {"cotton", "silk", "denim", "wool", "leather", "rubber sheet"})
    for (const int edges : {6, 12, 24})
      EXPECT_NEAR(sag_ratio({material, edges}, 0), 1, 0.05) << material << ", " << edges;
}

TEST(SheetBendingInAWorld, SagsAlikeOnIrregularMeshes) {
  for (const int edges : {6, 12, 24}) {
    EXPECT_NEAR(sag_ratio({"cotton", edges, 0.25}, 0), 1, 0.05) << edges << " edges, vertices moved";
    EXPECT_NEAR(sag_ratio({"cotton", edges, 0, true}, 0), 1, 0.05) << edges << " edges, alternating diagonals";
    EXPECT_NEAR(sag_ratio({"cotton", edges, 0.25, true}, 0), 1, 0.05) << edges << " edges, both";
  }
}

TEST(SheetBendingInAWorld, SagsAlikeInAClampOfManyRows) {
  for (const double moved : {0.0, 0.25})
    for (const bool alternates : {false, true})
      EXPECT_NEAR(sag_ratio({"cotton", 12, moved, alternates, 1, 4}, 0), 1, 0.05) << moved << ", " << alternates;
}

TEST(SheetBendingInAWorld, IsClampedByRigidAttachmentsAsByPins) {
  for (const int edges : {6, 24}) EXPECT_NEAR(sag_ratio({"cotton", edges, 0, false, 1, 1, true}, 0), 1, 0.05) << edges;
}

TEST(SheetBendingInAWorld, SagsAlikeWhereAFileRoundsItsPlane) {
  for (const double rounded : {0.002, 0.01})
    EXPECT_NEAR(sag_ratio({"cotton", 12, 0, false, 1, 1, false, rounded}, 0), 1, 0.05) << rounded;
}

TEST(SheetBendingInAWorld, SagsAlikeWhateverTheSubstepsAndTheFrameTime) {
  const double by_default = sag_ratio({}, 0);
  for (const int substeps : {10, 20, 80}) EXPECT_NEAR(sag_ratio({}, substeps) / by_default, 1, 0.01) << substeps;
  EXPECT_NEAR(sag_ratio({}, 0, 1.0 / 120) / by_default, 1, 0.01);
  EXPECT_NEAR(sag_ratio({}, 0, 1.0 / 30) / by_default, 1, 0.01);
}

/// From one step of a polynomial for several substeps to a multigrid cycle for each.
TEST(SheetBendingInAWorld, SagsAlikeWithShortFramesAndWithManySubsteps) {
  for (const bool alternates : {false, true}) {
    const Strip strip{"cotton", 6, 0.25, alternates};
    const double by_default = sag_ratio(strip, 0);
    EXPECT_NEAR(by_default, 1, 0.05);
    for (const int substeps : {10, 40, 160}) EXPECT_NEAR(sag_ratio(strip, substeps) / by_default, 1, 0.01) << substeps;
    for (const double rate : {120.0, 500.0, 1000.0})
      EXPECT_NEAR(sag_ratio(strip, 10, 1 / rate) / by_default, 1, 0.01) << "frames of 1/" << rate << " s";
  }
}

TEST(SheetBendingInAWorld, SagsAsTheBeamHoweverFewParticlesItHas) {
  Strip strip{"cotton", 6};
  strip.columns = 2;
  EXPECT_NEAR(sag_ratio(strip, 0), 1, 0.15) << "2 x 8 particles";
  strip.alternates = true;
  EXPECT_NEAR(sag_ratio(strip, 0), 1, 0.05) << "2 x 8 particles, alternating diagonals";
  EXPECT_NEAR(sag_ratio({"denim", 3, 0, false, 1, 1, false, 0, 5}, 0), 1, 0.05) << "5 x 5 particles";
  EXPECT_NEAR(sag_ratio({"leather", 2, 0, false, 1, 1, false, 0, 7}, 0), 1, 0.05) << "7 x 4 particles";
}

// One bending for 9 to 40 substeps made sheets with few edges crumple.
TEST(SheetBendingInAWorld, SheetsOfFewEdgesStaySmoothWithAnyNumberOfSubsteps) {
  for (const int substeps : {8, 13, 17, 19})
    EXPECT_NEAR(sag_ratio({"cotton", 2, 0, false, 1, 1, false, 0, 7}, substeps), 1, 0.05) << substeps;
  for (const int substeps : {21, 30, 42})
    EXPECT_NEAR(sag_ratio({"cotton", 3, 0.25, true, 1, 1, false, 0, 7}, substeps), 1, 0.05) << substeps;
}

TEST(SheetBendingInAWorld, SagsAlikeWhateverItsUnitOfMass) {
  for (const int edges : {12, 24})
    EXPECT_NEAR(sag_ratio({"cotton", edges, 0, false, 1e6f}, 0) / sag_ratio({"cotton", edges}, 0), 1, 1e-3) << edges;
}

/// A rumpled sheet of leather of 21 x 21 particles that flies and spins without gravity.
World flying(bool bends, float width = 0.06f) {
  ClothOptions options;
  options.material = fabric("leather");
  if (!bends) options.bending_model = ClothOptions::Bending::none;
  Object cloth = make_cloth(grid_mesh(21, 21, width, width), options);
  for (const Vec3f& p : cloth.positions) {
    const Vec3f spin{-4 * p.z, 0.5f * std::sin(4.8f / width * p.x), 4 * p.x};
    cloth.velocities.push_back(Vec3f{1, 2, -0.5f} + spin);
  }
  Scene scene;
  scene.gravity = {};
  scene.settings.substeps = 60;
  scene.add(cloth);
  return World(scene);
}

struct Momenta {
  Vec3d linear{}, angular{};
  double mass = 0;
};

Momenta momenta_of(const World& world) {
  Momenta sum;
  const State& state = world.state();
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    const Record &x = state.positions[i], &v = state.velocities[i];
    const double m = 1 / double(x.w);
    const Vec3d p{double(x.x), double(x.y), double(x.z)}, u{double(v.x), double(v.y), double(v.z)};
    sum.mass += m;
    sum.linear += u * m;
    sum.angular += cross(p, u) * m;
  }
  return sum;
}

TEST(SheetBendingInAWorld, BendingTakesNoMomentumInFlight) {
  World world = flying(true), without = flying(false);
  const Momenta before = momenta_of(world);
  for (int frame = 0; frame < 30; ++frame) ASSERT_FALSE(world.step(1.f / 60).nonfinite);
  for (int frame = 0; frame < 30; ++frame) without.step(1.f / 60);
  const Momenta after = momenta_of(world);
  EXPECT_LT(length(after.linear - before.linear), 1e-5 * length(before.linear));
  // Stretching takes some of the angular momentum, in proportion to h^2.
  const double kept = length(after.angular) / length(before.angular);
  EXPECT_NEAR(kept, length(momenta_of(without).angular) / length(before.angular), 0.02);
}

double kinetic_energy(const World& world) {
  double sum = 0;
  const State& state = world.state();
  for (std::size_t i = 0; i < state.positions.size(); ++i)
    sum += double(length_squared(Vec3f{state.velocities[i].x, state.velocities[i].y, state.velocities[i].z})) /
           double(state.positions[i].w) / 2;
  return sum;
}

/// Edges of 5, 10 and 15 mm: polynomials of two terms and one, with nothing that moves its pieces back.
TEST(SheetBendingInAWorld, SheetsOfLongEdgesKeepMomentumAndGainNoEnergy) {
  for (const float width : {0.1f, 0.2f, 0.3f}) {
    World world = flying(true, width);
    const Momenta before = momenta_of(world);
    const double energy = kinetic_energy(world);
    for (int frame = 0; frame < 60; ++frame) {
      ASSERT_FALSE(world.step(1.f / 60).nonfinite);
      ASSERT_LT(kinetic_energy(world), 1.0001 * energy) << "frame " << frame << ", width " << width;
    }
    const Momenta after = momenta_of(world);
    EXPECT_LT(length(after.linear - before.linear), 1e-5 * length(before.linear)) << width;
    EXPECT_GT(length(after.angular), 0.9 * length(before.angular)) << width;
    EXPECT_LT(length(after.angular), 1.0001 * length(before.angular)) << width;
  }
}

TEST(SheetBendingInAWorld, AFlatSheetFallsAsAStoneDoes) {
  ClothOptions options;
  options.material = fabric("cotton");
  Scene scene;
  scene.add(make_cloth(grid_mesh(41, 41, 0.1f, 0.1f), options));
  World world(scene);
  for (int frame = 0; frame < 30; ++frame) world.step(1.f / 60);
  const double fallen = gravity_of_tests * 0.5 * 0.5 / 2;
  for (const Vec3f& p : world.object(world.objects().front()).positions())
    EXPECT_NEAR(double(p.y), -fallen, 0.02 * fallen);
  float least = 1e9f, most = -1e9f;
  for (const Vec3f& p : world.object(world.objects().front()).positions())
    least = std::min(least, p.y), most = std::max(most, p.y);
  EXPECT_LT(most - least, 1e-5f) << "it stays flat";
}

TEST(SheetBendingInAWorld, HasTheSameBitsOnAnyNumberOfThreads) {
  std::string first;
  for (const int threads : {1, 2, 3}) {
    ClothOptions options;
    options.material = fabric("denim");
    Object cloth = make_cloth(grid_mesh(65, 65, 0.13f, 0.13f), options);  // rows in several blocks
    cloth.pins = {{0, {}}, {64, {}}};
    Scene scene;
    scene.settings.threads = threads;
    scene.add(cloth);
    World world(scene);
    for (int frame = 0; frame < 8; ++frame) world.step(1.f / 60);
    if (first.empty()) first = world.state_hash();
    EXPECT_EQ(world.state_hash(), first) << threads;
  }
}

}  // namespace
}  // namespace pliant
