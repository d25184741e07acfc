// Woven cloth: what warp, weft and shear stiffness mean, in the energy of a mesh and in cloth that hangs.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "constraints/triangle_shear.h"
#include "constraints/triangle_stretch.h"
#include "pliant/error.h"
#include "pliant/mesh.h"
#include "pliant/scene.h"
#include "pliant/world.h"
#include "soft_bodies/linear_woven.h"
#include "support/refusal.h"

namespace pliant {
namespace {

using testing_support::refusal;

constexpr double gravity = 9.81;

ClothOptions woven(float warp, float weft, float shear, const Vec3f& direction) {
  ClothOptions options;
  options.material.area_density = 0.12f;
  options.material.stretch_stiffness = warp;
  options.material.weft_stiffness = weft;
  options.material.shear_stiffness = shear;
  options.stretch_model = ClothOptions::Stretching::woven;
  options.bending_model = ClothOptions::Bending::none;
  options.warp = direction;
  return options;
}

/// C of one constraint of a group.
template <class Type>
double value(const ConstraintGroup& group, std::size_t number, const std::vector<Vec3d>& positions) {
  constexpr std::size_t fields = Type::fields.size();
  Vec3d x[3], gradient[3];
  for (std::size_t k = 0; k < 3; ++k) x[k] = positions[static_cast<std::size_t>(group.particles[3 * number + k])];
  typename Type::template Params<double> params{};
  const float* rest = &group.rest[fields * number];
  if constexpr (fields == 3)
    params = {rest[0], rest[1], rest[2]};
  else
    params = {rest[0], rest[1], rest[2], rest[3]};
  return Type::evaluate(x, params, gradient);
}

/// The energy of the distances of a group [J].
double energy_of_edges(const ConstraintGroup& group, const std::vector<Vec3d>& positions) {
  double sum = 0;
  for (std::size_t i = 0; 2 * i < group.particles.size(); ++i) {
    const Vec3d across = positions[static_cast<std::size_t>(group.particles[2 * i + 1])] -
                         positions[static_cast<std::size_t>(group.particles[2 * i])];
    const double c = std::sqrt(dot(across, across)) - static_cast<double>(group.rest[i]);
    sum += c * c / (2 * static_cast<double>(group.compliances[i]));
  }
  return sum;
}

/// The energy of cloth in a given shape [J].
double energy(const Object& cloth, const std::vector<Vec3d>& positions) {
  double sum = 0;
  for (const ConstraintGroup& group : cloth.constraints) {
    if (group.type == "distance") {
      sum += energy_of_edges(group, positions);
      continue;
    }
    for (std::size_t i = 0; 3 * i < group.particles.size(); ++i) {
      const double c = group.type == "triangle_stretch" ? value<TriangleStretch>(group, i, positions)
                                                        : value<TriangleShear>(group, i, positions);
      sum += c * c / (2 * static_cast<double>(group.compliances[i]));
    }
  }
  return sum;
}

/// A flat mesh without regular rows.
TriangleMesh uneven() {
  TriangleMesh mesh = grid_mesh(9, 7, 0.4f, 0.3f);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const auto part = [&](std::size_t prime) { return 0.012f * static_cast<float>(i * prime % 17) / 17; };
    mesh.positions[i] = mesh.positions[i] + Vec3f{part(5), 0, part(11)};
  }
  return mesh;
}

double area_of(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3f n = cross(mesh.positions[static_cast<std::size_t>(b)] - mesh.positions[static_cast<std::size_t>(a)],
                          mesh.positions[static_cast<std::size_t>(c)] - mesh.positions[static_cast<std::size_t>(a)]);
    sum += 0.5 * std::sqrt(static_cast<double>(dot(n, n)));
  }
  return sum;
}

/// The patch test: any mesh of an area A in the same homogeneous deformation holds A (Y1 e1^2 + Y2 e2^2 + G angle^2) /
/// 2.
void expect_energy_of_moduli(const TriangleMesh& mesh, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const Object cloth = make_cloth(mesh, woven(700, 300, 40, {static_cast<float>(s), 0.3f, static_cast<float>(c)}));
  const double stretch1 = 1.03, stretch2 = 0.96, shear = 0.1;
  std::vector<Vec3d> positions;
  for (const Vec3f& x : mesh.positions) {
    const double along = s * static_cast<double>(x.x) + c * static_cast<double>(x.z);
    const double across = c * static_cast<double>(x.x) - s * static_cast<double>(x.z);
    // Warp goes to stretch1 along x, weft to stretch2 at an angle of asin(shear) from the square; then all is tilted.
    const double u = stretch1 * along + stretch2 * shear * across, v = stretch2 * std::sqrt(1 - shear * shear) * across;
    positions.push_back({u, 0.6 * v, 0.8 * v});
  }
  const double expected =
      area_of(mesh) / 2 *
      (700 * std::pow(stretch1 - 1, 2) + 300 * std::pow(stretch2 - 1, 2) + 40 * std::pow(std::asin(shear), 2));
  EXPECT_NEAR(energy(cloth, positions), expected, 1e-4 * expected) << angle;
}

TEST(WovenCloth, HoldsTheEnergyOfItsModuliOnAnyMesh) {
  expect_energy_of_moduli(uneven(), 0.4);
  const TriangleMesh squares = grid_mesh(8, 6, 0.35f, 0.25f);
  for (const double angle : {0., 0.25 * 3.14159265, 0.5 * 3.14159265, 0.4}) expect_energy_of_moduli(squares, angle);
}

std::size_t constraints_of(const Object& cloth, const std::string& type) {
  std::size_t count = 0;
  for (const ConstraintGroup& group : cloth.constraints)
    if (group.type == type) count += group.compliances.size();
  return count;
}

/// Of 4 x 3 squares there are 3 x 3 + 4 x 2 edges along x, 4 x 2 + 3 x 3 along z, and as many diagonals as squares.
TEST(WovenCloth, HasDistancesAlongItsYarns) {
  const TriangleMesh mesh = grid_mesh(5, 4, 1, 0.75f);
  const auto count = [&](const Vec3f& warp, const std::string& type) {
    return constraints_of(make_cloth(mesh, woven(60, 25, 8, warp)), type);
  };
  EXPECT_EQ(count({0, 0, 1}, "distance"), 31u);
  EXPECT_EQ(count({0, 0, 1}, "triangle_stretch"), 0u);
  EXPECT_EQ(count({1, 0, 0.0005f}, "distance"), 31u) << "within a milliradian";
  EXPECT_EQ(count({1, 0, 0.002f}, "distance"), 0u);
  EXPECT_EQ(count({1, 0, 0.002f}, "triangle_stretch"), 48u);
  EXPECT_EQ(count({1, 0, 1}, "distance"), 12u) << "diagonals";
  EXPECT_EQ(count({1, 0, 1}, "triangle_stretch"), 24u);
  EXPECT_EQ(count({1, 0, 1}, "triangle_shear"), 24u);
}

/// Pins the particles that lie at `low` along an axis, and returns the mean of z of those at `high` in a scene that
/// came to rest [m].
double rests_at(Scene& scene, float Vec3f::*axis, float low, float high, int substeps, int frames = 300,
                double pull = gravity) {
  std::vector<int> held, ends;
  const Object& object = scene.objects[0];
  for (std::size_t i = 0; i < object.positions.size(); ++i) {
    const float at = object.positions[i].*axis;
    if (at < low + 1e-4f) held.push_back(static_cast<int>(i));
    if (at > high - 1e-4f) ends.push_back(static_cast<int>(i));
  }
  scene.pin(0, held);
  scene.gravity = {0, 0, static_cast<float>(pull)};  // in the plane of the sheet
  scene.objects[0].damping = 4;
  scene.settings.threads = 1;
  scene.settings.substeps = substeps;
  World world(scene);
  for (int frame = 0; frame < frames; ++frame) world.step(1.f / 60);
  double sum = 0;
  const std::vector<Vec3f> at = world.object(0).positions();
  for (const int end : ends) sum += static_cast<double>(at[static_cast<std::size_t>(end)].z);
  return sum / static_cast<double>(ends.size());
}

/// How much longer a strip of 0.1 m by 1 m becomes that hangs by its upper edge [m]. 0 substeps: the default.
double hangs_longer(const ClothOptions& options, int rows, int substeps, int frames = 300) {
  Scene scene;
  scene.add_cloth(grid_mesh((rows - 1) / 10 + 1, rows, 0.1f, 1), options);
  return rests_at(scene, &Vec3f::z, -0.5f, 0.5f, substeps, frames) - 0.5;
}

/// Its own weight stretches it by rho g L^2 / (2 Y).
TEST(WovenCloth, HangsByItsModulus) {
  const double of_warp = 0.12 * gravity / (2 * 60), of_weft = 0.12 * gravity / (2 * 25);
  EXPECT_NEAR(hangs_longer(woven(60, 25, 8, {0, 0, 1}), 31, 20), of_warp, 0.02 * of_warp);
  EXPECT_NEAR(hangs_longer(woven(60, 25, 8, {1, 0, 0}), 31, 20), of_weft, 0.02 * of_weft);
}

/// Whatever the rows and the substeps. Triangles alone hang 1.6 and 3.7 times too far with 41 and 81 rows and 20
/// substeps.
TEST(WovenCloth, HangsAlikeOnAnyMesh) {
  const double of_warp = 0.12 * gravity / (2 * 60);
  for (const int rows : {21, 41, 81})
    for (const int substeps : {0, 10, 20})
      EXPECT_NEAR(hangs_longer(woven(60, 25, 8, {0, 0, 1}), rows, substeps), of_warp, 0.03 * of_warp)
          << rows << ", " << substeps;
}

/// A sheet of width W that is held at one side shears by its weight: the other side sinks by rho g W^2 / (2 G). It
/// bends in its plane, too, by 1.5 rho g W^4 / (Y H^2). With G = 20 and 81 rows 20 substeps are too few, so it has more
/// by default.
TEST(WovenCloth, ShearsByItsModulusOnAnyMesh) {
  const double width = 0.25, shear = 0.12 * gravity * width * width / (2 * 20),
               bends = 1.5 * 0.12 * gravity * std::pow(width, 4) / 10000;
  for (const int rows : {21, 41, 81}) {
    Scene scene;
    scene.add_cloth(grid_mesh((rows - 1) / 4 + 1, rows, 0.25f, 1), woven(10000, 10000, 20, {0, 0, 1}));
    EXPECT_NEAR(rests_at(scene, &Vec3f::x, -0.125f, 0.125f, 0, 150), shear + bends, 0.03 * shear) << rows;
  }
}

/// By which angle the warp is cut, and by how much inner vertices are moved, as a share of an edge.
struct Cut {
  double degrees = 0;
  float moved = 0;
};

TriangleMesh moved_grid(int rows, float by) {
  TriangleMesh mesh = grid_mesh((rows - 1) / 4 + 1, rows, 0.25f, 1);
  const float edge = 1 / static_cast<float>(rows - 1);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    Vec3f& p = mesh.positions[i];
    if (std::fabs(p.z) > 0.499f || std::fabs(p.x) > 0.1249f) continue;
    const auto part = [&](std::size_t prime) { return static_cast<float>(i * prime % 17) / 8 - 1; };
    p = p + Vec3f{part(5), 0, part(11)} * (by * edge);
  }
  return mesh;
}

/// How far the lower edge of a sheet hangs, over a direct solve of the same distances and triangles at small strain.
double sag_over_linear(const Cut& cut, int rows) {
  const double angle = cut.degrees * 3.14159265 / 180;
  const Vec3f warp{static_cast<float>(std::sin(angle)), 0, static_cast<float>(std::cos(angle))};
  Scene scene;
  scene.add_cloth(moved_grid(rows, cut.moved), woven(60, 25, 8, warp));
  const Object& cloth = scene.objects[0];
  std::vector<int> top;
  for (int i = 0; i < (rows - 1) / 4 + 1; ++i) top.push_back(i);
  const double tenth = gravity / 10;  // so that strains are small
  const std::vector<Vec3d> right = testing_support::LinearWoven(cloth).hang({0, 0, tenth}, top);
  double sum = 0;
  for (std::size_t i = right.size() - top.size(); i < right.size(); ++i) sum += right[i].z;
  const double expected = sum / static_cast<double>(top.size());
  return (rests_at(scene, &Vec3f::z, -0.5f, 0.5f, 0, 240, tenth) - 0.5) / expected;
}

/// Yarns along no edge, and irregular meshes: their triangles give way as they should.
TEST(WovenCloth, HangsAsItsElementsDoInAnyDirection) {
  for (const int rows : {21, 41})
    for (const Cut& cut : {Cut{15}, Cut{30}, Cut{45}, Cut{0, 0.25f}, Cut{30, 0.25f}})
      EXPECT_NEAR(sag_over_linear(cut, rows), 1, 0.03) << rows << ", " << cut.degrees << ", " << cut.moved;
}

/// Cut on the bias, at 45 degrees, 1 / Y = (1 / Y1 + 1 / Y2 + 1 / G) / 4: shear lets it stretch.
TEST(WovenCloth, StretchesOnTheBiasByItsShear) {
  const double modulus = 4 / (1. / 200 + 1. / 200 + 1. / 15), expected = 0.12 * gravity / (2 * modulus);
  EXPECT_NEAR(hangs_longer(woven(200, 200, 15, {1, 0, 1}), 41, 160, 400), expected, 0.06 * expected);
}

/// Substeps follow what one pass can solve: twice as many for half the edge or four times the stiffness.
TEST(WovenCloth, HasSubstepsForItsTriangles) {
  const auto substeps = [](int rows, float shear, const Vec3f& warp) {
    Scene scene;
    scene.add_cloth(grid_mesh((rows - 1) / 4 + 1, rows, 0.25f, 1), woven(7000, 7000, shear, warp));
    return chosen_substeps(scene)[0];
  };
  EXPECT_EQ(substeps(21, 20, {0, 0, 1}), 20);
  const int at_81 = substeps(81, 50, {0, 0, 1});      // s = 50 x 80^2 / (0.12 x 1200^2) = 1.85 with 20, 0.5 is enough
  EXPECT_NEAR(at_81, 20 * std::sqrt(1.85 / 0.5), 3);  // more at borders, where masses are smaller
  EXPECT_NEAR(substeps(161, 50, {0, 0, 1}), 2 * at_81, 3);
  EXPECT_NEAR(substeps(81, 200, {0, 0, 1}), 2 * at_81, 2);
  EXPECT_GT(substeps(41, 20, {1, 0, 3}), 50) << "yarns along no edge";
  EXPECT_EQ(substeps(161, 1000, {0, 0, 1}), 160);
}

/// Tethers would not let it shear, and multigrid corrects lengths alone.
TEST(WovenCloth, IsSolvedByChains) {
  Scene scene;
  scene.add_cloth(grid_mesh(21, 21, 1, 1), woven(7000, 4500, 50, {0, 0, 1}));
  scene.pin(0, {0, 20});
  EXPECT_EQ(chosen_sweep(scene, 0), Sweep::chains);
}

/// Upright cloth, which the default warp is square to, has it downwards; a fabric that does not say how it shears,
/// shears as most do.
TEST(WovenCloth, HasDefaultsThatHoldUpright) {
  TriangleMesh mesh = grid_mesh(4, 5, 1, 1);
  for (Vec3f& p : mesh.positions) p = {p.x, p.z, 0};
  ClothOptions options = woven(700, 25, 7, {0, 1, 0});
  const Object told = make_cloth(mesh, options);
  options.warp = ClothOptions{}.warp;
  options.material.shear_stiffness = 0;
  const Object open = make_cloth(mesh, options);
  ASSERT_EQ(open.constraints.size(), told.constraints.size());
  for (std::size_t i = 0; i < told.constraints.size(); ++i) {
    EXPECT_EQ(open.constraints[i].rest, told.constraints[i].rest);
    EXPECT_EQ(open.constraints[i].compliances, told.constraints[i].compliances);
  }
}

TEST(WovenCloth, RefusesWhatItDoesNotHave) {
  const TriangleMesh mesh = grid_mesh(3, 3, 1, 1);
  ClothOptions options = woven(60, 25, 8, {0, 0, 0});
  const auto made = [&] { make_cloth(mesh, options); };
  EXPECT_NE(refusal(made).find("warp"), std::string::npos) << refusal(made);
  options = woven(60, -1, 8, {0, 0, 1});
  EXPECT_NE(refusal(made).find("weft_stiffness"), std::string::npos) << refusal(made);
  options = woven(60, 25, 8, {0, 0, 1});
  options.stretch = Stiffness::rigid();
  EXPECT_NE(refusal(made).find("stretch"), std::string::npos) << refusal(made);
}

/// Yarns that go straight through a triangle leave it those of its first edge.
TEST(WovenCloth, TakesAnEdgeWhereTheWarpGoesThrough) {
  const Object cloth = make_cloth(grid_mesh(4, 4, 1, 1), woven(60, 25, 8, {0, 1, 0}));
  std::vector<Vec3d> positions;
  for (const Vec3f& x : cloth.positions) positions.push_back(Vec3d{x.x, x.y, x.z});
  EXPECT_NEAR(energy(cloth, positions), 0, 1e-9);
}

}  // namespace
}  // namespace pliant
