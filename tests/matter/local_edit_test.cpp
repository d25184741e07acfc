// Edits look at what is near the particles that split. Here they are compared with all of the object.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "matter/around.h"
#include "matter/cut_edges.h"
#include "matter/cut_faces.h"
#include "matter/edit_parts.h"
#include "matter/plane_sides.h"
#include "pliant/body.h"
#include "pliant/edit.h"
#include "pliant/error.h"
#include "pliant/mesh.h"
#include "pliant/soft_body.h"

namespace pliant {
namespace {

int below(std::mt19937& random, std::size_t most) { return static_cast<int>(random() % most); }
float between(std::mt19937& random, float low, float high) {
  return low + (high - low) * static_cast<float>(random() % 10001) / 10000;
}

/// A block of uneven tetrahedra, some of them mirrored. With damping they are in several groups, in another order than
/// the surface.
Object uneven_block(std::mt19937& random, float damping = 0) {
  TetrahedralMesh mesh = box_tetrahedra({1, 1, 1}, {2 + below(random, 4), 2 + below(random, 4), 2 + below(random, 4)});
  for (Vec3f& p : mesh.positions)
    for (float* x : {&p.x, &p.y, &p.z}) *x += between(random, -0.03f, 0.03f);
  for (auto& t : mesh.tetrahedra)
    if (below(random, 2) == 0) std::swap(t[0], t[1]);
  SoftBodyOptions options;
  options.material.damping = damping;
  return make_soft_body(mesh, options);
}

Object sheet(std::mt19937& random) {
  TriangleMesh mesh = grid_mesh(4 + below(random, 9), 4 + below(random, 9), 1, 1);
  for (Vec3f& p : mesh.positions) p.x += between(random, -0.02f, 0.02f), p.z += between(random, -0.02f, 0.02f);
  return make_cloth(mesh);
}

/// Parts some elements from the others.
std::vector<int> some_parts(std::mt19937& random, std::size_t count) {
  std::vector<int> part(count);
  for (int& one : part) one = below(random, 12) == 0 ? 1 + below(random, 2) : 0;
  return part;
}

std::vector<int> some_of(std::mt19937& random, std::size_t count) {
  std::vector<int> some(4);
  for (int& one : some) one = below(random, count);
  return some;
}

/// The triangles that border_triangles finds in all of a body, after those of cloth in the same object.
std::vector<std::array<int, 3>> whole_surface(const Object& object, std::vector<std::array<int, 3>> cloth) {
  const std::vector<std::array<int, 3>> border = border_triangles({object.positions, tetrahedra_of(object)});
  cloth.insert(cloth.end(), border.begin(), border.end());
  return cloth;
}

/// Edits a body some times.
void expect_whole_surface(Object object, std::mt19937& random, const std::vector<std::array<int, 3>>& cloth) {
  for (int edit = 0; edit < 6; ++edit) {
    const std::size_t count = tetrahedra_of(object).size();
    object = edit % 2 == 0 ? part_tetrahedra(object, some_parts(random, count)).object
                           : remove_tetrahedra(object, some_of(random, count)).object;
    ASSERT_EQ(object.triangles, whole_surface(object, cloth)) << "after edit " << edit;
  }
}

TEST(LocalEdit, SurfacesAreTheBorderOfAllTetrahedra) {
  std::mt19937 random(1);
  for (int body = 0; body < 40; ++body) {
    SCOPED_TRACE(body);
    expect_whole_surface(uneven_block(random, body % 2 == 0 ? 0 : 0.01f), random, {});
  }
}

TEST(LocalEdit, ClothInTheSameObjectKeepsItsTriangles) {
  std::mt19937 random(2);
  for (int body = 0; body < 20; ++body) {
    SCOPED_TRACE(body);
    Object both = uneven_block(random);
    const std::size_t before = both.triangles.size();
    append(both, sheet(random));
    const std::vector<std::array<int, 3>> cloth(both.triangles.begin() + static_cast<std::ptrdiff_t>(before),
                                                both.triangles.end());
    append(both, uneven_block(random));
    expect_whole_surface(both, random, cloth);
  }
}

TEST(LocalEdit, SurfacesThatAreNotTheBorderAreMadeIt) {
  std::mt19937 random(3);
  const Object whole = uneven_block(random);
  const std::vector<int> part = some_parts(random, tetrahedra_of(whole).size());
  const std::vector<std::array<int, 3>> border = part_tetrahedra(whole, part).object.triangles;
  Object changed = whole;
  changed.triangles.erase(changed.triangles.begin() + 3);
  EXPECT_EQ(part_tetrahedra(changed, part).object.triangles, border) << "without a triangle";
  changed = whole;
  std::rotate(changed.triangles[5].begin(), changed.triangles[5].begin() + 1, changed.triangles[5].end());
  EXPECT_EQ(part_tetrahedra(changed, part).object.triangles, border) << "from another corner";
  changed = whole;
  std::swap(changed.triangles[0], changed.triangles[7]);
  EXPECT_EQ(part_tetrahedra(changed, part).object.triangles, border) << "in another order";
  changed = whole;
  changed.triangles.clear();
  EXPECT_EQ(part_tetrahedra(changed, part).object.triangles, border) << "without a surface";
}

TEST(LocalEdit, AFaceOfThreeTetrahedraIsRefusedFarFromTheEditToo) {
  Object bar = make_soft_body(box_tetrahedra({1, 0.1f, 0.1f}, {8, 1, 1}));
  const std::vector<int>& shear = bar.constraints[0].particles;
  ConstraintGroup again;
  again.type = "tetrahedron_shear";
  again.particles.assign(shear.begin(), shear.begin() + 4);
  bar.constraints.push_back(again);
  std::vector<int> part(tetrahedra_of(bar).size(), 0);
  part[part.size() - 2] = 1;
  EXPECT_THROW((void)part_tetrahedra(bar, part), Error);
}

/// A plane through an object, and the way of its blade.
PlaneCut some_cut(std::mt19937& random) {
  const auto vector = [&](float most) {
    return Vec3f{between(random, -most, most), between(random, -most, most), between(random, -most, most)};
  };
  return {0, 1, vector(0.3f), vector(1), vector(1)};
}

TEST(LocalEdit, SidesOfAPlaneAreThoseOfTheMiddlesBeTheyInTheRounding) {
  std::mt19937 random(9);
  for (int body = 0; body < 40; ++body) {
    const Object object = body % 2 == 0 ? uneven_block(random) : make_soft_body(box_tetrahedra({1, 1, 1}, {4, 4, 4}));
    const std::vector<std::array<int, 4>> all = tetrahedra_of(object);
    PlaneCut cut = some_cut(random);
    if (body % 4 == 1) cut.normal = {1, 0, 0};
    cut.point = {};  // through the middle of a tetrahedron, as nearly as rounding lets it
    for (const int corner : all[static_cast<std::size_t>(below(random, all.size()))])
      cut.point = cut.point + 0.25f * object.positions[static_cast<std::size_t>(corner)];
    const PlaneSides sides(object, cut, 0.5);
    const std::vector<int> ahead = sides.ahead_of(all);
    for (std::size_t t = 0; t < all.size(); ++t) ASSERT_EQ(ahead[t] != 0, sides.is_ahead(all[t])) << body;
  }
}

std::vector<int> shared_corners(std::array<int, 4> a, std::array<int, 4> b) {
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  std::vector<int> shared;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(shared));
  return shared;
}

TEST(LocalEdit, CutsOfSolidsOpenTheFacesThatAPlaneParts) {
  std::mt19937 random(4);
  for (int body = 0; body < 60; ++body) {
    Object object = uneven_block(random);
    object.cuts = {some_cut(random)};
    const double time = 0.25 * below(random, 5);
    const std::vector<std::array<int, 4>> all = tetrahedra_of(object);
    const PlaneSides sides(object, object.cuts[0], time);
    std::set<Face> faces;
    for (std::size_t a = 0; a < all.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) {
        const std::vector<int> shared = shared_corners(all[a], all[b]);
        if (shared.size() != 3 || !sides.are_parted(all[a], all[b])) continue;
        if (const Face face{shared[0], shared[1], shared[2]}; sides.is_reached(face)) faces.insert(face);
      }
    const std::optional<Edit> found = make_cuts(object, time);
    const Edit expected = cut_faces(object, faces);
    ASSERT_EQ(found.has_value(), expected.object.positions.size() > object.positions.size()) << body;
    if (!found) continue;
    EXPECT_EQ(found->from, expected.from);
    EXPECT_EQ(tetrahedra_of(found->object), tetrahedra_of(expected.object));
  }
}

TEST(LocalEdit, EdgesBetweenPartsAreThoseOfAllTriangles) {
  std::mt19937 random(5);
  for (int cloth = 0; cloth < 60; ++cloth) {
    const Object object = sheet(random);
    const std::vector<int> part = some_parts(random, object.triangles.size());
    std::map<EdgeEnds, std::set<int>> parts;
    for (std::size_t t = 0; t < part.size(); ++t)
      for (std::size_t i = 0; i < 3; ++i)
        parts[edge_of(object.triangles[t][i], object.triangles[t][(i + 1) % 3])].insert(part[t]);
    std::set<EdgeEnds> edges;
    for (const auto& [edge, numbers] : parts)
      if (numbers.size() > 1) edges.insert(edge);
    EXPECT_EQ(edges_between(object, part), edges) << cloth;
  }
}

/// A group of links between random particles. Their rest lengths tell them apart.
ConstraintGroup some_links(std::mt19937& random, std::size_t particles) {
  ConstraintGroup links;
  links.type = "distance";
  for (int i = 1; i <= 60; ++i) {
    const int a = below(random, particles), b = below(random, particles);
    if (a == b) continue;
    links.particles.insert(links.particles.end(), {a, b});
    links.rest.push_back(static_cast<float>(i));
  }
  return links;
}

TEST(LocalEdit, LinksThatACutReachesGoUnlessATriangleHasThem) {
  std::mt19937 random(6);
  for (int cloth = 0; cloth < 30; ++cloth) {
    Object object = sheet(random);
    const ConstraintGroup links = some_links(random, object.positions.size());
    object.constraints = {links};
    object.cuts = {some_cut(random)};
    const PlaneSides sides(object, object.cuts[0], 0.5);
    std::set<float> left;
    for (std::size_t i = 0; i < links.rest.size(); ++i) {
      const int a = links.particles[2 * i], b = links.particles[2 * i + 1];
      const bool is_edge = std::any_of(object.triangles.begin(), object.triangles.end(),
                                       [&](const auto& t) { return has_corner(t, a) && has_corner(t, b); });
      const bool is_parted = sides.are_parted(std::array<int, 1>{a}, std::array<int, 1>{b});
      if (is_edge || !is_parted || !sides.is_reached(std::array<int, 2>{a, b})) left.insert(links.rest[i]);
    }
    const std::optional<Edit> edit = make_cuts(object, 0.5);
    const std::vector<float> after = (edit ? edit->object : object).constraints[0].rest;
    EXPECT_EQ(std::set<float>(after.begin(), after.end()), left) << cloth;
  }
}

TEST(LocalEdit, ConstraintsAtParticlesAreThoseThatUseThem) {
  std::mt19937 random(7);
  Object object = sheet(random);
  std::vector<char> marks(object.positions.size());
  for (int i = 0; i < 5; ++i) marks[static_cast<std::size_t>(below(random, marks.size()))] = 1;
  for (const ConstraintGroup& group : object.constraints) {
    const int slots = slots_of(group, object);
    std::vector<int> expected;
    for (int c = 0; c < static_cast<int>(group.particles.size()) / slots; ++c) {
      const std::vector<int> stencil = stencil_of(group, slots, c);
      if (std::any_of(stencil.begin(), stencil.end(), [&](int p) { return marks[static_cast<std::size_t>(p)] != 0; }))
        expected.push_back(c);
    }
    EXPECT_EQ(constraints_at(group, marks, object), expected) << group.type;
  }
  object.constraints[0].particles.back() = 100000;
  EXPECT_THROW((void)constraints_at(object.constraints[0], marks, object), Error);
}

TEST(LocalEdit, RunsOfConstraintsKeepTheirOrderAndData) {
  ConstraintGroup group;
  group.type = "distance";
  for (int c = 0; c < 10; ++c) {
    group.particles.insert(group.particles.end(), {c, c + 1});
    group.rest.push_back(static_cast<float>(c));
  }
  group.stiffness = Stiffness::compliance(0.5f);
  const std::vector<int> followed{0, 3, 4, 9};
  ConstraintGroup after = group;
  rewrite(after, 2, followed, [&](int c, ConstraintGroup& to) {
    for (int copy = 0; copy < c % 3; ++copy) append(group, c, {c + 100, c + 101}, 2, to);  // 0 0 1 0 times
  });
  EXPECT_EQ(after.rest, (std::vector<float>{1, 2, 4, 5, 6, 7, 8}));
  EXPECT_EQ(after.compliances, (std::vector<float>{0.5f, 0.5f, 1, 0.5f, 0.5f, 0.5f, 0.5f}));
  EXPECT_EQ(after.particles, (std::vector<int>{1, 2, 2, 3, 104, 105, 5, 6, 6, 7, 7, 8, 8, 9}));
  after = group;
  rewrite(after, 2, {2, 9}, [&](int c, ConstraintGroup& to) { append(group, c, {c + 100, c + 101}, 2, to); });
  EXPECT_EQ(after.rest, group.rest);
  EXPECT_EQ(after.compliances, (std::vector<float>{0.5f, 0.5f, 1, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 1}));
  EXPECT_EQ(after.particles, (std::vector<int>{0, 1, 1, 2, 102, 103, 3, 4, 4, 5, 5, 6, 6, 7, 7, 8, 8, 9, 109, 110}));
}

TEST(LocalEdit, AroundHasTheElementsAtMarkedParticles) {
  std::mt19937 random(8);
  const Object object = uneven_block(random);
  const std::vector<std::array<int, 4>> all = tetrahedra_of(object);
  std::vector<char> marks(object.positions.size());
  for (char& mark : marks) mark = below(random, 3) == 0 ? 1 : 0;
  const Around around(all, marks);
  for (int p = 0; p < static_cast<int>(marks.size()); ++p) {
    std::vector<int> expected;
    for (int t = 0; t < static_cast<int>(all.size()); ++t)
      if (marks[static_cast<std::size_t>(p)] != 0 &&
          std::count(all[static_cast<std::size_t>(t)].begin(), all[static_cast<std::size_t>(t)].end(), p) != 0)
        expected.push_back(t);
    EXPECT_EQ(std::vector<int>(around[p].begin(), around[p].end()), expected) << p;
  }
}

}  // namespace
}  // namespace pliant
