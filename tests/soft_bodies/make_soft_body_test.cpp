// Makers of soft bodies: tetrahedra of boxes and of closed meshes, masses, borders, and what they refuse.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>
#include <string>

#include "pliant/edit.h"
#include "pliant/error.h"
#include "soft_bodies/soft_body_support.h"
#include "support/paths.h"
#include "support/refusal.h"
#include "topology/boundary.h"
#include "topology/edges.h"

namespace pliant {
namespace {

using namespace testing_support;

double sum(const std::vector<double>& of) {
  double all = 0;
  for (const double one : of) all += one;
  return all;
}

double volume_inside(const std::vector<Vec3f>& positions, const std::vector<std::array<int, 3>>& triangles) {
  double six = 0;
  for (const auto& [a, b, c] : triangles) {
    const auto at = [&](int i) { return convert<double>(positions[static_cast<std::size_t>(i)]); };
    six += dot(cross(at(a), at(b)), at(c));
  }
  return six / 6;
}

TEST(BoxTetrahedra, FillTheBoxAndMatch) {
  const TetrahedralMesh mesh = box_tetrahedra({0.3f, 0.2f, 0.4f}, {3, 2, 4});
  EXPECT_EQ(mesh.positions.size(), 4u * 3 * 5);
  EXPECT_EQ(mesh.tetrahedra.size(), 6u * 3 * 2 * 4);
  const std::vector<double> volumes = six_volumes(mesh.positions, mesh.tetrahedra);
  EXPECT_GT(*std::min_element(volumes.begin(), volumes.end()), 0);
  EXPECT_NEAR(sum(volumes) / 6, 0.3 * 0.2 * 0.4, 1e-7);
  const auto border = border_triangles(mesh);
  EXPECT_EQ(border.size(), 4u * (3 * 2 + 2 * 4 + 3 * 4));
  EXPECT_TRUE(is_closed(find_edges(border, static_cast<int>(mesh.positions.size()))));
  EXPECT_NEAR(volume_inside(mesh.positions, border), 0.024, 1e-7);
}

/// True if the mirror image of a mesh along an axis is the same mesh.
bool is_its_own_mirror_image(const TetrahedralMesh& mesh, float Vec3f::*axis) {
  using Place = std::array<float, 3>;
  const auto corners = [&](bool mirrored) {
    std::set<std::set<Place>> all;
    for (const auto& t : mesh.tetrahedra) {
      std::set<Place> places;
      for (const int corner : t) {
        Vec3f p = mesh.positions[static_cast<std::size_t>(corner)];
        if (mirrored) p.*axis = 0 - p.*axis;
        places.insert({p.x, p.y, p.z});
      }
      all.insert(places);
    }
    return all;
  };
  return corners(false) == corners(true);
}

TEST(BoxTetrahedra, MirroredOnesAreTheirMirrorImages) {
  for (const std::array<int, 3>& cells : {std::array{2, 4, 8}, std::array{4, 4, 4}}) {
    const TetrahedralMesh mesh = box_tetrahedra({0.25f, 0.5f, 0.75f}, cells, BoxCut::mirrored);
    for (float Vec3f::*axis : {&Vec3f::x, &Vec3f::y, &Vec3f::z}) EXPECT_TRUE(is_its_own_mirror_image(mesh, axis));
    EXPECT_FALSE(is_its_own_mirror_image(box_tetrahedra({0.25f, 0.5f, 0.75f}, cells), &Vec3f::x));
  }
}

TEST(BoxTetrahedra, MirroredOnesFillTheBoxAndMatch) {
  for (const std::array<int, 3>& cells : {std::array{1, 1, 1}, std::array{3, 2, 4}, std::array{5, 4, 1}}) {
    const TetrahedralMesh mesh = box_tetrahedra({0.3f, 0.2f, 0.4f}, cells, BoxCut::mirrored);
    const std::vector<double> volumes = six_volumes(mesh.positions, mesh.tetrahedra);
    EXPECT_GT(*std::min_element(volumes.begin(), volumes.end()), 0);
    EXPECT_NEAR(sum(volumes) / 6, 0.3 * 0.2 * 0.4, 1e-7);
    const auto border = border_triangles(mesh);
    EXPECT_EQ(border.size(),
              4u * static_cast<unsigned>(cells[0] * cells[1] + cells[1] * cells[2] + cells[2] * cells[0]));
    EXPECT_TRUE(is_closed(find_edges(border, static_cast<int>(mesh.positions.size()))));
  }
}

TEST(BoxTetrahedra, RefuseWhatIsNoBox) {
  EXPECT_NE(refusal([] { box_tetrahedra({0, 1, 1}, {1, 1, 1}); }).find("size"), std::string::npos);
  EXPECT_NE(refusal([] { box_tetrahedra({1, 1, 1}, {0, 1, 1}); }).find("cells"), std::string::npos);
  EXPECT_NE(refusal([] { box_tetrahedra({1, 1, 1}, {1 << 24, 1 << 24, 1 << 24}); }).find("cells"), std::string::npos);
  EXPECT_NE(refusal([] { box_tetrahedra({1, std::nanf(""), 1}, {1, 1, 1}); }).find("size"), std::string::npos);
}

TEST(MakeSoftBody, HasTheMassOfItsVolume) {
  SoftBodyOptions options;
  options.material = elastic_solid("rubber");
  const Object body = make_soft_body(box_tetrahedra({0.3f, 0.2f, 0.4f}, {3, 2, 4}), options);
  double mass = 0;
  for (const float one : body.masses) mass += static_cast<double>(one);
  EXPECT_NEAR(mass, 950 * 0.024, 1e-3);
  ASSERT_EQ(body.constraints.size(), 2u);
  EXPECT_TRUE(body.collides);
  EXPECT_TRUE(is_closed(find_edges(body.triangles, static_cast<int>(body.positions.size()))));
}

TEST(MakeSoftBody, ComplianceIsThatOfLame) {
  SoftBodyOptions options;
  options.material = solid_of(1e5f, 0.25f);
  const Object body = make_soft_body({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}}, options);
  // lambda = mu = E / 2.5 = 40 kPa for a ratio of a quarter; the volume is a sixth.
  EXPECT_NEAR(body.constraints[0].compliances[0], 6 / 4e4, 1e-9);
  EXPECT_NEAR(body.constraints[1].compliances[0], 6 / 4e4, 1e-9);
}

TEST(MakeSoftBody, WithoutPoissonsRatioHasNoVolumeConstraint) {
  SoftBodyOptions options;
  options.material = solid_of(1e5f, 0);
  EXPECT_EQ(make_soft_body(box_tetrahedra({1, 1, 1}, {1, 1, 1}), options).constraints.size(), 1u);
}

TEST(MakeSoftBody, TakesTheWholeRangeOfPoissonsRatio) {
  SoftBodyOptions options;
  options.material = solid_of(1e5f, 0.495f);
  EXPECT_EQ(make_soft_body(box_tetrahedra({1, 1, 1}, {1, 1, 1}), options).constraints.size(), 2u);
}

TEST(MakeSoftBody, OfSoftGelIsAsSoftAtTheScaleOfCells) {
  SoftBodyOptions options;
  options.material = solid_of(100, 0.3f);
  const Object tiny = make_soft_body(box_tetrahedra({1e-5f, 1e-5f, 1e-5f}, {1, 1, 1}), options);
  EXPECT_NEAR(tiny.constraints[0].compliances[0] * (100 / 2.6) * 1e-15 / 6, 1, 1e-3);
}

TEST(MakeSoftBody, TurnsTetrahedraAndDropsCornersWithoutOne) {
  const TetrahedralMesh mesh{{{9, 9, 9}, {0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}}, {{1, 2, 3, 4}}};
  const Object body = make_soft_body(mesh);
  EXPECT_EQ(body.positions.size(), 4u);
  EXPECT_NEAR(volume_inside(body.positions, body.triangles), 1.0 / 6, 1e-7);
}

TEST(MakeSoftBody, NamesWhatItRefuses) {
  const TetrahedralMesh good{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}};
  const auto of_mesh = [&](auto change) {
    TetrahedralMesh mesh = good;
    change(mesh);
    return refusal([&] { make_soft_body(mesh); });
  };
  const auto of_options = [&](auto change) {
    SoftBodyOptions options;
    change(options);
    return refusal([&] { make_soft_body(good, options); });
  };
  const float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
  EXPECT_NE(of_mesh([](auto& m) { m.tetrahedra.clear(); }).find("no tetrahedron"), std::string::npos);
  EXPECT_NE(of_mesh([](auto& m) { m.tetrahedra[0][2] = 4; }).find("tetrahedron 0"), std::string::npos);
  EXPECT_NE(of_mesh([](auto& m) { m.tetrahedra[0][2] = -1; }).find("vertex -1"), std::string::npos);
  EXPECT_NE(of_mesh([](auto& m) { m.tetrahedra[0][2] = 1; }).find("twice"), std::string::npos);
  EXPECT_NE(of_mesh([](auto& m) { m.positions[3].z = 0; }).find("flat"), std::string::npos);
  EXPECT_NE(of_mesh([&](auto& m) { m.positions[3].z = nan; }).find("vertex 3"), std::string::npos);
  EXPECT_NE(of_mesh([](auto& m) { m.tetrahedra.push_back(m.tetrahedra[0]); }).find("border"), std::string::npos);
  EXPECT_NE(of_mesh([](auto& m) {
              m.tetrahedra.push_back(m.tetrahedra[0]);
              m.tetrahedra.push_back(m.tetrahedra[0]);
            }).find("shares a face"),
            std::string::npos);
  EXPECT_NE(of_options([](auto& o) { o.material.youngs_modulus = 0; }).find("youngs_modulus"), std::string::npos);
  EXPECT_NE(of_options([&](auto& o) { o.material.youngs_modulus = infinity; }).find("youngs_modulus"),
            std::string::npos);
  EXPECT_NE(of_options([](auto& o) { o.material.poisson_ratio = 0.5f; }).find("0.495"), std::string::npos);
  EXPECT_NE(of_options([&](auto& o) { o.material.density = nan; }).find("density"), std::string::npos);
  EXPECT_NE(of_options([](auto& o) { o.material.damping = -1; }).find("damping"), std::string::npos);
  EXPECT_NE(of_options([](auto& o) { o.material.static_friction = 0.1f; }).find("static_friction"), std::string::npos);
  EXPECT_NE(of_options([](auto& o) { o.thickness = -1; }).find("thickness"), std::string::npos);
}

TEST(MakeSoftBody, IsNotCutAsASurface) {
  const Object body = make_soft_body(box_tetrahedra({1, 1, 1}, {1, 1, 1}));
  const std::vector<int> path{body.triangles[0][0], body.triangles[0][1]}, first{0};
  EXPECT_NE(refusal([&] { cut(body, path); }).find("cannot be cut"), std::string::npos);
  EXPECT_NE(refusal([&] { remove_triangles(body, first); }).find("cannot be cut"), std::string::npos);
}

TEST(ElasticSolids, AreUsableAndNamed) {
  ASSERT_FALSE(elastic_solids().empty());
  for (const ElasticSolid& solid : elastic_solids()) {
    EXPECT_EQ(&elastic_solid(solid.name), &solid);
    EXPECT_FALSE(solid.source.empty());
    SoftBodyOptions options;
    options.material = solid;
    EXPECT_NO_THROW(make_soft_body(box_tetrahedra({1, 1, 1}, {1, 1, 1}), options)) << solid.name;
  }
  EXPECT_NE(refusal([] { elastic_solid("jelly"); }).find("gelatine"), std::string::npos);
}

std::string number(float value) {
  char text[32];
  std::snprintf(text, sizeof text, value >= 1e5f ? "%.0f" : "%g", static_cast<double>(value));
  return text;
}

TEST(ElasticSolids, AreThoseOfTheGuide) {
  std::ifstream file(test::in_tree("docs/guide/soft_bodies.md"));
  std::ostringstream text;
  text << file.rdbuf();
  for (const ElasticSolid& s : elastic_solids()) {
    std::string row = "| " + s.name;
    for (const float value :
         {s.density, s.youngs_modulus, s.poisson_ratio, s.damping, s.static_friction, s.kinetic_friction})
      row += " | " + number(value);
    EXPECT_NE(text.str().find(row + " |"), std::string::npos) << "docs/guide/soft_bodies.md should hold\n" << row;
  }
}

// ------------------------------------------------------------------------------------------------ closed meshes

TEST(FillWithTetrahedra, FillsASphere) {
  const TriangleMesh sphere = sphere_mesh(4);
  const FilledMesh filled = fill_with_tetrahedra(sphere, 0.2f);
  EXPECT_TRUE(filled.notes.empty()) << filled.notes.front();
  const std::vector<double> volumes = six_volumes(filled.mesh.positions, filled.mesh.tetrahedra);
  EXPECT_GT(*std::min_element(volumes.begin(), volumes.end()), 0);
  EXPECT_NEAR(sum(volumes) / 6 / volume_inside(sphere.positions, sphere.triangles), 1, 0.03);
  double farthest = 0;
  const auto border = border_triangles(filled.mesh);
  for (const auto& triangle : border)
    for (const int corner : triangle)
      farthest =
          std::max(farthest,
                   std::fabs(static_cast<double>(length(filled.mesh.positions[static_cast<std::size_t>(corner)])) - 1));
  EXPECT_LT(farthest, 0.25 * 0.2);  // a quarter of an edge
  EXPECT_TRUE(is_closed(find_edges(border, static_cast<int>(filled.mesh.positions.size()))));
}

TEST(FillWithTetrahedra, TakesAnInwardMeshAlike) {
  TriangleMesh sphere = sphere_mesh(3);
  const FilledMesh outward = fill_with_tetrahedra(sphere, 0.3f);
  for (auto& triangle : sphere.triangles) std::swap(triangle[1], triangle[2]);
  const FilledMesh inward = fill_with_tetrahedra(sphere, 0.3f);
  EXPECT_EQ(outward.mesh.tetrahedra, inward.mesh.tetrahedra);
}

TEST(FillWithTetrahedra, SaysWhatItLeavesOut) {
  TriangleMesh two = sphere_mesh(3);  // and a ball much smaller than the cells
  TriangleMesh small = sphere_mesh(2);
  const auto first = static_cast<int>(two.positions.size());
  for (const Vec3f& p : small.positions) two.positions.push_back(0.15f * p + Vec3f{3.05f, 0.02f, 0.04f});
  for (const auto& [a, b, c] : small.triangles) two.triangles.push_back({first + a, first + b, first + c});
  const FilledMesh filled = fill_with_tetrahedra(two, 0.25f);
  for (const Vec3f& p : filled.mesh.positions) EXPECT_LT(p.x, 2);
  ASSERT_FALSE(filled.notes.empty());
  EXPECT_NE(filled.notes.back().find("162 of 804 vertices of the mesh, the first 642, lie off the tetrahedra"),
            std::string::npos)
      << filled.notes.back();
}

TEST(FillWithTetrahedra, TakesAMeshThatOverlapsItself) {
  TriangleMesh two = sphere_mesh(3);
  const auto first = static_cast<int>(two.positions.size());
  for (const Vec3f& p : sphere_mesh(3).positions) two.positions.push_back(p + Vec3f{0.7f, 0.1f, 0});
  for (const auto& [a, b, c] : sphere_mesh(3).triangles) two.triangles.push_back({first + a, first + b, first + c});
  const FilledMesh filled = fill_with_tetrahedra(two, 0.2f);
  EXPECT_TRUE(filled.notes.empty()) << filled.notes.front();
  const double distance = std::sqrt(0.5),
               cap = 3.14159265 * (1 - distance / 2) * (1 - distance / 2) * (2 + distance / 2) / 3;
  EXPECT_NEAR(sum(six_volumes(filled.mesh.positions, filled.mesh.tetrahedra)) / 6, 2 * (4.18879 - cap), 0.3);
}

TEST(FillWithTetrahedra, RefusesWhatEnclosesNothing) {
  TriangleMesh open = sphere_mesh(2);
  open.triangles.pop_back();
  EXPECT_NE(refusal([&] { fill_with_tetrahedra(open, 0.3f); }), "nothing was refused");
  EXPECT_NE(refusal([] { fill_with_tetrahedra({}, 0.3f); }), "nothing was refused");
  EXPECT_NE(refusal([] { fill_with_tetrahedra(sphere_mesh(2), 0); }).find("size"), std::string::npos);
  EXPECT_NE(refusal([] { fill_with_tetrahedra(sphere_mesh(2), 50); }).find("too large"), std::string::npos);
  EXPECT_NE(refusal([] { fill_with_tetrahedra(sphere_mesh(2), 1e-4f); }).find("larger size"), std::string::npos);
  TriangleMesh far = sphere_mesh(2);
  for (Vec3f& p : far.positions) p.x += 9e5f;
  EXPECT_NE(refusal([&] { fill_with_tetrahedra(far, 0.25f); }).find("move the mesh to the origin"), std::string::npos);
}

}  // namespace
}  // namespace pliant
