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

/// The energy of cloth in a given shape [J].
double energy(const Object& cloth, const std::vector<Vec3d>& positions) {
  double sum = 0;
  for (const ConstraintGroup& group : cloth.constraints)
    for (std::size_t i = 0; 3 * i < group.particles.size(); ++i) {
      const double c = group.type == "triangle_stretch" ? value<TriangleStretch>(group, i, positions)
                                                        : value<TriangleShear>(group, i, positions);
      sum += c * c / (2 * static_cast<double>(group.compliances[i]));
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

/// The patch test: any mesh of an area A in the same homogeneous deformation holds A (Y1 e1^2 + Y2 e2^2 + G angle^2) / 2.
TEST(WovenCloth, HoldsTheEnergyOfItsModuliOnAnyMesh) {
  const TriangleMesh mesh = uneven();
  const double angle = 0.4, c = std::cos(angle), s = std::sin(angle);
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
  EXPECT_NEAR(energy(cloth, positions), expected, 1e-4 * expected);
}

/// How much longer a strip of 0.1 m by 1 m becomes that hangs by its upper edge [m]. What hangs below each row is borne by it in one
/// substep, so rows and substeps decide how exactly: the excess goes with (rows / substeps)^2.
double hangs_longer(const ClothOptions& options, int rows, int substeps) {
  TriangleMesh mesh = grid_mesh((rows - 1) / 10 + 1, rows, 0.1f, 1);
  Scene scene;
  const int cloth = scene.add_cloth(mesh, options);
  std::vector<int> top;
  for (int i = 0; i < (rows - 1) / 10 + 1; ++i) top.push_back(i);
  scene.pin(cloth, top);
  scene.gravity = {0, 0, static_cast<float>(gravity)};  // along the strip
  scene.objects[0].damping = 4;
  scene.settings.threads = 1;
  scene.settings.substeps = substeps;
  World world(scene);
  for (int frame = 0; frame < 600; ++frame) world.step(1.f / 60);
  double sum = 0;
  const std::vector<Vec3f> at = world.object(cloth).positions();
  for (std::size_t i = at.size() - top.size(); i < at.size(); ++i) sum += static_cast<double>(at[i].z) - 0.5;
  return sum / static_cast<double>(top.size());
}

/// Its own weight stretches it by rho g L^2 / (2 Y).
TEST(WovenCloth, HangsByItsModulus) {
  const double of_warp = 0.12 * gravity / (2 * 60), of_weft = 0.12 * gravity / (2 * 25);
  EXPECT_NEAR(hangs_longer(woven(60, 25, 8, {0, 0, 1}), 31, 120), of_warp, 0.02 * of_warp);
  EXPECT_NEAR(hangs_longer(woven(60, 25, 8, {1, 0, 0}), 31, 120), of_weft, 0.02 * of_weft);
}

TEST(WovenCloth, HangsAlikeOnAnyMesh) {
  const double of_warp = 0.12 * gravity / (2 * 60);
  for (const int rows : {21, 41, 61})
    EXPECT_NEAR(hangs_longer(woven(60, 25, 8, {0, 0, 1}), rows, 4 * rows), of_warp, 0.02 * of_warp) << rows;
}

/// Cut on the bias, at 45 degrees, 1 / Y = (1 / Y1 + 1 / Y2 + 1 / G) / 4: shear lets it stretch.
TEST(WovenCloth, StretchesOnTheBiasByItsShear) {
  const double modulus = 4 / (1. / 200 + 1. / 200 + 1. / 15), expected = 0.12 * gravity / (2 * modulus);
  EXPECT_NEAR(hangs_longer(woven(200, 200, 15, {1, 0, 1}), 41, 160), expected, 0.06 * expected);
}

/// Upright cloth, which the default warp is square to, has it downwards; a fabric that does not say how it shears, shears as most do.
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
