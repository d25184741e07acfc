// Tests cloth and ropes: energies and masses that do not depend on the mesh, and errors that name the place.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "constraints/dihedral_bending.h"
#include "constraints/distance.h"
#include "constraints/isometric_bending.h"
#include "constraints/traits.h"
#include "pliant/error.h"
#include "pliant/scene.h"
#include "support/nonfinite.h"

namespace pliant {
namespace {

using testing_support::infinity;

Vec3d in_double(const Vec3f& p) { return {p.x, p.y, p.z}; }

/// The sum of C^2 / (2 alpha) over a group, with particles moved to `moved`; rest data are measured on the object.
template <class Type>
double energy(const Object& object, const ConstraintGroup& group, const std::vector<Vec3d>& moved) {
  double sum = 0;
  for (std::size_t c = 0; c < group.particles.size() / slot_count<Type>; ++c) {
    Vec3d rest[slot_count<Type>], now[slot_count<Type>], gradient[slot_count<Type>];
    for (std::size_t i = 0; i < slot_count<Type>; ++i) {
      const auto particle = static_cast<std::size_t>(group.particles[slot_count<Type> * c + i]);
      rest[i] = in_double(object.positions[particle]);
      now[i] = moved[particle];
    }
    const double error = Type::evaluate(now, Type::measure(rest), gradient);
    sum += error * error / (2 * double{group.compliances.at(c)});
  }
  return sum;
}

std::vector<Vec3d> moved(const Object& object, const std::function<Vec3d(const Vec3d&)>& map) {
  std::vector<Vec3d> result;
  for (const Vec3f& p : object.positions) result.push_back(map(in_double(p)));
  return result;
}

/// A flat grid whose inner vertices are displaced randomly.
TriangleMesh shaken_grid(int columns, int rows, float width, float depth) {
  TriangleMesh mesh = grid_mesh(columns, rows, width, depth);
  std::mt19937 random(11);
  for (int r = 1; r + 1 < rows; ++r)
    for (int c = 1; c + 1 < columns; ++c) {
      Vec3f& p = mesh.positions[static_cast<std::size_t>(r * columns + c)];
      p.x += 0.4f * width / static_cast<float>(columns) * (static_cast<float>(random() % 1000) / 1000 - 0.5f);
      p.z += 0.4f * depth / static_cast<float>(rows) * (static_cast<float>(random() % 1000) / 1000 - 0.5f);
    }
  return mesh;
}

/// A flat sheet of equilateral triangles with sides of `side` metres.
TriangleMesh equilateral_sheet(int columns, int rows, float side) {
  TriangleMesh mesh = grid_mesh(columns, rows, 1, 1);
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c)
      mesh.positions[static_cast<std::size_t>(r * columns + c)] = {
          side * (static_cast<float>(c) - 0.5f * static_cast<float>(r)), 0, side * 0.8660254f * static_cast<float>(r)};
  return mesh;
}

double area_of(const TriangleMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles) {
    const auto at = [&](std::size_t corner) { return in_double(mesh.positions[static_cast<std::size_t>(t[corner])]); };
    sum += std::sqrt(length_squared(cross(at(1) - at(0), at(2) - at(0)))) / 2;
  }
  return sum;
}

ClothOptions with_material(const Fabric& material) {
  ClothOptions options;
  options.material = material;
  return options;
}

/// The Error that make_cloth throws for a mesh.
Error refusal(const TriangleMesh& mesh, const ClothOptions& options = {}) {
  try {
    make_cloth(mesh, options);
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "accepted";
  return Error({}, "");
}

TEST(Cloth, GroupsOfAGrid) {
  const Object cloth = make_cloth(grid_mesh(5, 4, 2, 1.5f), with_material(fabric("cotton")));
  ASSERT_EQ(cloth.constraints.size(), 2u);
  EXPECT_EQ(cloth.constraints[0].type, "distance");
  EXPECT_EQ(cloth.constraints[0].particles.size(), 2u * (4 * 4 + 5 * 3 + 4 * 3));
  EXPECT_EQ(cloth.constraints[1].type, "dihedral_bending");
  EXPECT_EQ(cloth.constraints[1].particles.size(), 4u * (3 * 3 + 4 * 2 + 4 * 3));
  EXPECT_FLOAT_EQ(cloth.constraints[0].rest[0], 0.5f);
  EXPECT_EQ(cloth.thickness, fabric("cotton").thickness);
  EXPECT_EQ(cloth.kinetic_friction, fabric("cotton").kinetic_friction);
}

TEST(Cloth, VanGelderOnASquareGridByHand) {
  Fabric material;
  material.stretch_stiffness = 100;
  const Object cloth = make_cloth(grid_mesh(3, 3, 2, 2), with_material(material));  // cells of 1 m
  const ConstraintGroup& stretch = cloth.constraints[0];
  for (std::size_t e = 0; e < stretch.compliances.size(); ++e) {
    const bool diagonal = stretch.rest[e] > 1.2f;
    const int a = stretch.particles[2 * e], b = stretch.particles[2 * e + 1];
    const bool inner = a == 4 || b == 4;  // the middle vertex is on every inner edge
    EXPECT_FLOAT_EQ(stretch.compliances[e], diagonal ? 0.02f : inner ? 0.01f : 0.02f);
  }
}

TEST(Cloth, MassIsAreaTimesDensityWhateverTheMesh) {
  Fabric material;
  material.area_density = 0.3f;
  for (const TriangleMesh& mesh : {grid_mesh(2, 2, 2, 3), shaken_grid(17, 23, 2, 3), sphere_mesh(3)}) {
    const Object cloth = make_cloth(mesh, with_material(material));
    double mass = 0;
    for (float m : cloth.masses) mass += m;
    EXPECT_NEAR(mass, 0.3 * area_of(mesh), 1e-6);
  }
  EXPECT_FLOAT_EQ(make_cloth(grid_mesh(2, 2, 1, 1), with_material(material)).masses[1],
                  0.05f);  // a third of one triangle
}

TEST(Cloth, StretchEnergyOfEqualStrainIsTheSameOnEveryMesh) {
  // Stretched by s in all directions, each edge gains s L, so the energy is 3/2 s^2 Y times the area.
  const double strain = 1e-3;
  // Irregular meshes store more, as their vertices give way (matter/irregular_springs_test.cpp).
  for (const TriangleMesh& mesh : {grid_mesh(4, 4, 1, 1), grid_mesh(30, 9, 1, 1), grid_mesh(20, 11, 1, 1)}) {
    const Object cloth = make_cloth(mesh, with_material(fabric("denim")));
    const auto larger = moved(cloth, [&](const Vec3d& p) { return p * (1 + strain); });
    EXPECT_NEAR(energy<Distance>(cloth, cloth.constraints[0], larger), 1.5 * strain * strain * 15000, 1e-6);
  }
}

TEST(Cloth, EquilateralSheetHasTheYoungsModulusAskedFor) {
  // A lattice of springs is an isotropic sheet with Poisson's ratio 1/3: stretched along x by s, it contracts by s / 3
  // and stores s^2 Y / 2 per area. Edges at the border have half the stiffness, so the area is that of the sheet.
  const double s = 1e-3;
  const TriangleMesh mesh = equilateral_sheet(40, 40, 0.01f);
  const Object cloth = make_cloth(mesh, with_material(fabric("silk")));
  const auto pulled = moved(cloth, [&](const Vec3d& p) { return Vec3d{p.x * (1 + s), p.y, p.z * (1 - s / 3)}; });
  EXPECT_NEAR(energy<Distance>(cloth, cloth.constraints[0], pulled) / (s * s * 12000 / 2 * area_of(mesh)), 1, 1e-3);
}

/// The energy per area of a sheet that is rolled to radius 1 m about an axis at `degrees` to the z-axis, as a share of
/// B / 2.
template <class Type>
double rolled_energy(const TriangleMesh& mesh, ClothOptions::Bending model, double degrees) {
  ClothOptions options = with_material(fabric("wool"));
  options.bending_model = model;
  const Object cloth = make_cloth(mesh, options);
  const double cosine = std::cos(degrees * 0.017453292519943295), sine = std::sin(degrees * 0.017453292519943295);
  const auto rolled = moved(cloth, [&](const Vec3d& p) {
    const double around = cosine * p.x + sine * p.z, along = cosine * p.z - sine * p.x, away = std::sin(around);
    return Vec3d{cosine * away - sine * along, 1 - std::cos(around), sine * away + cosine * along};
  });
  return energy<Type>(cloth, cloth.constraints[1], rolled) / (0.5 * 1.2e-5 * area_of(mesh));
}

TEST(Cloth, RolledSheetStoresWhatItsFlexuralRigiditySays) {
  // Half of the border's hinges are missing, so up to 2 % less. A lattice of equilateral triangles has no preferred
  // direction; a grid rolled along its sides or diagonals is exact too.
  using Bending = ClothOptions::Bending;
  for (double degrees : {0., 20., 45., 70., 90.}) {
    const TriangleMesh sheet = equilateral_sheet(80, 80, 0.01f);
    EXPECT_NEAR(rolled_energy<DihedralBending>(sheet, Bending::dihedral, degrees), 1, 0.02) << degrees;
    EXPECT_NEAR(rolled_energy<IsometricBending>(sheet, Bending::isometric, degrees), 1, 0.02) << degrees;
  }
  for (int columns : {51, 101}) {
    const TriangleMesh grid = grid_mesh(columns, columns, 1, 1);
    EXPECT_NEAR(rolled_energy<DihedralBending>(grid, Bending::dihedral, 0), 1, 0.025);
    EXPECT_NEAR(rolled_energy<IsometricBending>(grid, Bending::isometric, 90), 1, 0.025);
  }
}

TEST(Cloth, InfiniteStretchStiffnessIsRigidAndOverridesWin) {
  ClothOptions options;
  options.material.stretch_stiffness = infinity;
  options.bending = Stiffness::pbd(0.25f);
  const Object cloth = make_cloth(grid_mesh(4, 4, 1, 1), options);
  EXPECT_TRUE(cloth.constraints[0].compliances.empty());
  EXPECT_EQ(cloth.constraints[0].stiffness.value, 0);
  EXPECT_TRUE(cloth.constraints[1].compliances.empty());
  EXPECT_EQ(cloth.constraints[1].stiffness.kind, Stiffness::Kind::pbd);
  options.stretch = Stiffness::compliance(1e-5f, 2);
  const Object softer = make_cloth(grid_mesh(4, 4, 1, 1), options);
  EXPECT_EQ(softer.constraints[0].stiffness.value, 1e-5f);
  EXPECT_EQ(softer.constraints[0].stiffness.damping, 2);
}

TEST(Cloth, NoBendingWhereNoneIsAskedFor) {
  ClothOptions options;
  options.bending_model = ClothOptions::Bending::none;
  EXPECT_EQ(make_cloth(grid_mesh(4, 4, 1, 1), options).constraints.size(), 1u);
  ClothOptions limp;
  limp.material.bending_stiffness = 0;
  EXPECT_EQ(make_cloth(grid_mesh(4, 4, 1, 1), limp).constraints.size(), 1u);
  EXPECT_EQ(make_cloth({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}).constraints.size(),
            1u);  // one triangle, no hinge
}

TEST(Cloth, BendingDampingIsTheFractionOfCriticalOfAHinge) {
  // Two right triangles of a unit square. Their tips are 1/sqrt(2) from the diagonal, whose ends each take half of both
  // tips' gradients with the opposite sign. With a mass m at each corner, w |grad|^2 sums to 2 (2/m_tip + 2/m_end).
  Fabric material;
  material.area_density = 3;
  material.bending_damping = 0.25f;
  for (auto model : {ClothOptions::Bending::dihedral, ClothOptions::Bending::isometric}) {
    ClothOptions options = with_material(material);
    options.bending_model = model;
    const ConstraintGroup group = make_cloth(grid_mesh(2, 2, 1, 1), options).constraints[1];
    const double tip = 0.5, end = 1;  // kg: thirds of triangles of 1.5 kg
    const double dihedral_mass = 1 / (2 * (2 / tip + 2 / end));
    // C of the isometric type is |e| sqrt(3 / (A1 + A2)) times the angle, here sqrt(6).
    const double inverse = 1 / dihedral_mass * (model == ClothOptions::Bending::dihedral ? 1 : 6);
    const double expected = 0.25 * 2 / std::sqrt(inverse * double{group.compliances[0]});
    EXPECT_NEAR(group.stiffness.damping / expected, 1, 1e-6);
  }
}

TEST(Cloth, TrianglesAreWoundAlikeWhereTheyCanBe) {
  TriangleMesh mesh = grid_mesh(4, 4, 1, 1);
  const auto wound = mesh.triangles;
  std::swap(mesh.triangles[5][0], mesh.triangles[5][1]);
  const Object cloth = make_cloth(mesh);
  EXPECT_EQ(cloth.constraints[1].particles, make_cloth(grid_mesh(4, 4, 1, 1)).constraints[1].particles);
  const TriangleMesh moebius{{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 1}, {2, 0, 1}, {2, 1, 0}},
                             {{0, 2, 3}, {0, 3, 1}, {2, 4, 5}, {2, 5, 3}, {4, 1, 0}, {4, 0, 5}}};
  EXPECT_EQ(make_cloth(moebius).constraints[1].particles.size(), 4u * 6);
  ClothOptions balloon;
  balloon.volume = Volume{};
  refusal(moebius, balloon);
}

TEST(Cloth, BalloonFacesOutAndMustBeClosed) {
  ClothOptions options{.volume = Volume{2, {}}};
  TriangleMesh mesh = sphere_mesh(1);
  EXPECT_EQ(make_cloth(mesh, options).triangles, mesh.triangles);
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  EXPECT_EQ(make_cloth(mesh, options).triangles, sphere_mesh(1).triangles);
  mesh.triangles.pop_back();
  EXPECT_EQ(refusal(mesh, options).where().element.substr(0, 5), "edge ");
  const TriangleMesh pillow{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}, {1, 0, 3}, {1, 3, 2}}};
  EXPECT_NE(refusal(pillow, options).problem().find("no volume"), std::string::npos);
}

TEST(Cloth, RefusalsNameThePlace) {
  TriangleMesh mesh = grid_mesh(3, 3, 1, 1);
  mesh.triangles[3][2] = 99;
  EXPECT_EQ(refusal(mesh).where().element, "triangle 3");
  EXPECT_EQ(refusal(mesh).where().object, "cloth");
  mesh = grid_mesh(3, 3, 1, 1);
  mesh.triangles[2] = {1, 1, 2};
  EXPECT_EQ(refusal(mesh).where().element, "triangle 2");
  mesh = grid_mesh(3, 3, 1, 1);
  mesh.positions[4] = {infinity, 0, 0};
  EXPECT_EQ(refusal(mesh).where().element, "vertex 4");
  mesh = grid_mesh(3, 3, 1, 1);
  mesh.positions.push_back({5, 5, 5});
  EXPECT_EQ(refusal(mesh).where().element, "vertex 9");
  mesh = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {1, 2, 0}}};
  EXPECT_EQ(refusal(mesh).where().element, "triangle 1");
  EXPECT_NE(refusal({}).problem().find("no triangle"), std::string::npos);
}

TEST(Cloth, AnEdgeOfThreeTrianglesStretchesAndIsNotBent) {
  TriangleMesh mesh = grid_mesh(3, 3, 1, 1);  // 16 edges, 8 of them inner
  mesh.triangles.push_back({0, 4, 2});        // a third triangle at edge 0-4; edges 4-2 and 2-0 are new
  const Object cloth = make_cloth(mesh);
  ASSERT_EQ(cloth.constraints.size(), 2u);
  EXPECT_EQ(cloth.constraints[0].particles.size(), 2u * 18);
  EXPECT_EQ(cloth.constraints[1].particles.size(), 4u * 7);
}

TEST(Cloth, RefusesMaterialsThatAreNone) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (float Fabric::*field : {&Fabric::area_density, &Fabric::thickness, &Fabric::stretch_stiffness,
                               &Fabric::bending_stiffness, &Fabric::bending_damping})
    for (float bad : {nan, -1.f}) {
      Fabric material;
      material.*field = bad;
      EXPECT_EQ(refusal(grid_mesh(3, 3, 1, 1), with_material(material)).where().element.substr(0, 8), "material");
    }
}

TEST(Rope, LinksStrutsAndMasses) {
  RopeOptions options;
  options.linear_density = 2;
  options.bends = true;
  const Object rope = make_rope({{0, 0, 0}, {1, 0, 0}, {1, 3, 0}, {1, 3, 1}}, options);
  EXPECT_EQ(rope.masses, (std::vector<float>{1, 4, 4, 1}));
  ASSERT_EQ(rope.constraints.size(), 2u);
  EXPECT_EQ(rope.constraints[0].particles, (std::vector<int>{0, 1, 1, 2, 2, 3}));
  EXPECT_EQ(rope.constraints[1].particles, (std::vector<int>{0, 2, 1, 3}));
  EXPECT_EQ(rope.constraints[1].stiffness.value, 1);
  EXPECT_EQ(make_rope({{0, 0, 0}, {1, 0, 0}}, options).constraints.size(), 1u);
}

TEST(Rope, RefusesWhatHasNoLength) {
  EXPECT_THROW(make_rope({}), Error);
  EXPECT_THROW(make_rope({{0, 0, 0}}), Error);
  EXPECT_THROW(make_rope({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}}), Error);
  EXPECT_THROW(make_rope({{0, 0, 0}, {infinity, 0, 0}}), Error);
  for (float bad : {0.f, -1.f, infinity, std::numeric_limits<float>::quiet_NaN()}) {
    RopeOptions options;
    options.linear_density = bad;
    EXPECT_THROW(make_rope({{0, 0, 0}, {1, 0, 0}}, options), Error);
  }
}

}  // namespace
}  // namespace pliant
