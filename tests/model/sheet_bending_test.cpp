// Tests the bending energy of fine sheets: what it says of shapes with known energies, on grids and irregular meshes,
// and that its levels interpolate linearly and are never softer than the sheet.
#include "model/sheet_bending.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <string>

#include "core/at.h"
#include "model/sheet_choice.h"
#include "pliant/mesh.h"
#include "topology/edges.h"

namespace pliant {
namespace {

constexpr double spacing = 0.002, rigidity = 1.75e-5, density = 0.12;  // [m], [N m], [kg/m^2]

double area_of(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  return double(std::sqrt(length_squared(cross(b - a, c - a)))) / 2;
}

/// A sheet of particles and hinges alone, with the compliances of its material (matter/cloth.cpp).
Object with_hinges(const TriangleMesh& mesh) {
  Object object;
  object.positions = mesh.positions;
  object.triangles = mesh.triangles;
  object.masses.assign(mesh.positions.size(), 0);
  for (const auto& t : mesh.triangles)
    for (const int v : t)
      object.masses[at(v)] += static_cast<float>(
          density * area_of(mesh.positions[at(t[0])], mesh.positions[at(t[1])], mesh.positions[at(t[2])]) / 3);
  ConstraintGroup group;
  group.type = "dihedral_bending";
  for (const Edge& edge : find_edges(mesh.triangles, static_cast<int>(mesh.positions.size()))) {
    if (!edge.is_inner()) continue;
    const Hinge h = hinge_of(edge);
    const auto p = [&](int v) { return mesh.positions[at(v)]; };
    for (const int v : {h.v0, h.v1, h.v2, h.v3}) group.particles.push_back(v);
    const double areas = area_of(p(h.v0), p(h.v1), p(h.v2)) + area_of(p(h.v0), p(h.v1), p(h.v3));
    group.compliances.push_back(static_cast<float>(areas / (double(length_squared(p(h.v1) - p(h.v0))) * rigidity)));
  }
  object.constraints = {group};
  return object;
}

/// A square sheet in the plane y = 0. Inner vertices are moved by up to a share of an edge; diagonals alternate or not.
Object fine_sheet(int n, double moved, bool alternates) {
  std::mt19937 random(5);
  const auto uniform = [&] { return static_cast<double>(random() % 65536) / 32768 - 1; };
  TriangleMesh mesh;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const bool is_inner = i > 0 && j > 0 && i + 1 < n && j + 1 < n;
      const double x = i + (is_inner ? moved * uniform() : 0), z = j + (is_inner ? moved * uniform() : 0);
      mesh.positions.push_back({static_cast<float>(x * spacing), 0, static_cast<float>(z * spacing)});
    }
  for (int i = 0; i + 1 < n; ++i)
    for (int j = 0; j + 1 < n; ++j) {
      const int a = i * n + j, b = a + n, c = b + 1, d = a + 1;
      const bool crosses = alternates && (i + j) % 2 == 1;
      mesh.triangles.push_back(crosses ? std::array<int, 3>{a, d, b} : std::array<int, 3>{a, c, b});
      mesh.triangles.push_back(crosses ? std::array<int, 3>{b, d, c} : std::array<int, 3>{a, d, c});
    }
  return with_hinges(mesh);
}

struct Built {
  Object object;
  SheetBending sheet;

  explicit Built(Object of) : object(std::move(of)) {
    std::vector<int> place(object.positions.size());
    std::iota(place.begin(), place.end(), 0);
    std::vector<Record> positions;
    for (std::size_t i = 0; i < place.size(); ++i) {
      const bool is_pinned =
          std::any_of(object.pins.begin(), object.pins.end(), [&](const Pin& p) { return at(p.particle) == i; });
      const Vec3f& p = object.positions[i];
      positions.push_back({p.x, p.y, p.z, is_pinned ? 0 : 1 / object.masses[i]});
    }
    sheet = build_sheet(object, facts_of_sheet(object), place, positions, {});
  }
  const SheetLevel& finest() const { return sheet.levels.front(); }
};

/// K w of a level, for one number a vertex.
std::vector<double> times(const SheetLevel& level, const std::vector<double>& w) {
  std::vector<double> out(w.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::size_t p = at(level.pattern[i]);
    out[i] = static_cast<double>(level.diagonal[p]) * w[i];
    for (std::int32_t e = level.begin[p]; e < level.begin[p + 1]; ++e)
      out[i] += static_cast<double>(level.stiffness[at(e)]) * w[at(static_cast<int>(i) + level.offset[at(e)])];
  }
  return out;
}

double energy(const SheetLevel& level, const std::vector<double>& w) {
  const std::vector<double> force = times(level, w);
  return std::inner_product(w.begin(), w.end(), force.begin(), 0.0) / 2;
}

/// What it would be if only one vertex at a time were moved.
double energy_apart(const SheetLevel& level, const std::vector<double>& w) {
  double sum = 0;
  for (std::size_t i = 0; i < w.size(); ++i)
    sum += static_cast<double>(level.diagonal[at(level.pattern[i])]) * w[i] * w[i] / 2;
  return sum;
}

/// The heights of a surface over the vertices of a flat object.
template <class Height>
std::vector<double> heights(const Object& object, const Height& of) {
  std::vector<double> out;
  for (const Vec3f& p : object.positions) out.push_back(of(double(p.x), double(p.z)));
  return out;
}

class SheetEnergy : public testing::TestWithParam<std::array<int, 2>> {
 protected:
  Object object(int n) const { return fine_sheet(n, GetParam()[0] / 100.0, GetParam()[1] != 0); }
};

TEST_P(SheetEnergy, IsThatOfTheSurfaceWhereItIsKnown) {
  constexpr int n = 17;
  const Built built(object(n));
  const double size = (n - 1) * spacing,
               area = size * size;  // corners have few vertices around them: up to 0.25 % is missing
  const auto of = [&](auto height) {
    return energy(built.finest(), heights(built.object, height)) / (rigidity * area / 2);
  };
  EXPECT_NEAR(of([](double x, double) { return x * x / 2; }), 1, 4e-3) << "rolled about z: kxx = 1";
  EXPECT_NEAR(of([](double, double z) { return z * z / 2; }), 1, 4e-3) << "rolled about x: kzz = 1";
  EXPECT_NEAR(of([](double x, double z) { return (x + z) * (x + z) / 4; }), 1, 4e-3) << "rolled about a diagonal";
  EXPECT_NEAR(of([](double x, double z) { return (x - z) * (x - z) / 4; }), 1, 4e-3) << "rolled about the other one";
  EXPECT_NEAR(of([](double x, double z) { return x * z; }), 2, 8e-3) << "twisted: kxy = 1";
  EXPECT_NEAR(of([](double x, double z) { return (x * x + z * z) / 2; }), 2, 8e-3) << "a dome: kxx = kzz = 1";
}

TEST_P(SheetEnergy, ResistsNeitherTranslationNorRotation) {
  const Built built(object(15));
  for (const auto& w : {heights(built.object, [](double, double) { return 0.01; }),
                        heights(built.object, [](double x, double z) { return 0.02 * x - 0.03 * z; })})
    EXPECT_LT(std::fabs(energy(built.finest(), w)), 1e-6 * energy_apart(built.finest(), w));
}

TEST_P(SheetEnergy, LevelsInterpolateLinearly) {
  const Built built(object(21));
  ASSERT_GE(built.sheet.levels.size(), 3u);
  std::vector<double> exact = heights(built.object, [](double x, double z) { return 3 + 40 * x - 25 * z; });
  // A vertex that is kept has one parent with weight 1, so the values of the next level are those of kept vertices.
  for (std::size_t l = 0; l + 1 < built.sheet.levels.size(); ++l) {
    const SheetLevel& level = built.sheet.levels[l];
    std::vector<double> coarse(at(built.sheet.levels[l + 1].rows), 0);
    std::vector<char> is_known(coarse.size(), 0);
    for (std::size_t i = 0; i < exact.size(); ++i)
      for (std::size_t p = 0; p < 3; ++p)
        if (level.share[i][p] == 1) coarse[at(level.parent[i][p])] = exact[i], is_known[at(level.parent[i][p])] = 1;
    ASSERT_EQ(std::count(is_known.begin(), is_known.end(), 0), 0) << "level " << l;
    for (std::size_t i = 0; i < exact.size(); ++i) {
      double found = 0;
      for (std::size_t p = 0; p < 3; ++p)
        found += static_cast<double>(level.share[i][p]) * coarse[at(level.parent[i][p])];
      EXPECT_NEAR(found, exact[i], 1e-4) << "level " << l << ", row " << i;
    }
    exact = coarse;
  }
}

INSTANTIATE_TEST_SUITE_P(Meshes, SheetEnergy,
                         testing::Values(std::array<int, 2>{0, 0}, std::array<int, 2>{25, 0}, std::array<int, 2>{0, 1},
                                         std::array<int, 2>{25, 1}),
                         [](const auto& of) {
                           return std::string(of.param[1] != 0 ? "Alternating" : "OneDiagonal") + "MovedBy" +
                                  std::to_string(of.param[0]) + "Percent";
                         });

TEST(SheetBending, CoarseLevelsAreGalerkinProducts) {
  const Built built(fine_sheet(21, 0.25, false));
  std::mt19937 random(3);
  const SheetLevel &fine = built.sheet.levels[0], &coarse = built.sheet.levels[1];
  std::vector<double> w;
  for (int i = 0; i < coarse.rows; ++i) w.push_back(static_cast<double>(random() % 1000) / 1000);
  std::vector<double> interpolated(at(fine.rows), 0);
  for (std::size_t i = 0; i < interpolated.size(); ++i)
    for (std::size_t p = 0; p < 3; ++p)
      interpolated[i] += static_cast<double>(fine.share[i][p]) * w[at(fine.parent[i][p])];
  EXPECT_NEAR(energy(coarse, w) / energy(fine, interpolated), 1, 1e-4);
}

TEST(SheetBending, RowsOfAGridShareTheirEntries) {
  const Built grid(fine_sheet(65, 0, false)), irregular(fine_sheet(65, 0.25, false));
  EXPECT_LT(grid.finest().patterns(), 300) << "of 4 225 rows: borders, and beside the borders of five blocks";
  EXPECT_EQ(irregular.finest().patterns(), irregular.finest().rows);
}

// The rest positions of a grid are rounded. If all rows took the entries of the first, its rounding would pull them all
// one way in the plane: here by up to 6e-7 of K_ii times an edge.
TEST(SheetBending, SharedEntriesPullNoWay) {
  constexpr int n = 65;
  const Built grid(fine_sheet(n, 0, false));
  const SheetLevel& level = grid.finest();
  for (int i = 0; i < level.rows; ++i) {
    const std::size_t p = at(level.pattern[at(i)]);
    double sum = 0;
    for (std::int32_t e = level.begin[p]; e < level.begin[p + 1]; ++e)
      sum += static_cast<double>(level.stiffness[at(e)]) * ((i + level.offset[at(e)]) / n - i / n);
    EXPECT_LT(std::fabs(sum) / static_cast<double>(level.diagonal[p]), 3e-7) << "row " << i;
  }
}

// (B / rho g)^(1/3) is 24.6 mm; edges with diagonals are 1.138 times 2 mm on average.
TEST(SheetBending, EdgesAreLongWhereTheSheetBendsWithinTwo) {
  const Object sheet = fine_sheet(9, 0, false);
  const double bending_length = std::cbrt(rigidity / (density * 9.81)), edge = 1.138 * spacing;
  const double of_long_edges = 9.81 * std::pow(bending_length * 0.45 / edge, 3);  // gravity that makes them so
  EXPECT_FALSE(has_long_edges(sheet, 0.8 * of_long_edges));
  EXPECT_TRUE(has_long_edges(sheet, 1.25 * of_long_edges));
  EXPECT_FALSE(has_long_edges(sheet, 0));
}

TEST(SheetBending, IsForFlatSheetsWithTheHingesOfAMaterial) {
  constexpr double h = 1.0 / 60 / 20;
  const Object fine = fine_sheet(9, 0, false);
  EXPECT_TRUE(bends_as_sheet(fine, h));
  EXPECT_TRUE(bends_as_sheet(fine, h / 2000)) << "substeps so short that hinges converge, but too soft by their mesh";

  Object folded = fine;
  for (Vec3f& p : folded.positions) p.y = 0.3f * std::fabs(p.x - 0.008f);
  EXPECT_FALSE(bends_as_sheet(folded, h)) << "a rest shape with a fold";

  Object plastic = fine;
  for (ConstraintGroup& group : plastic.constraints)
    if (group.type == "dihedral_bending") group.plasticity = Plasticity{};
  EXPECT_FALSE(bends_as_sheet(plastic, h));

  Object finned = fine;  // a third triangle at an inner edge
  finned.positions.push_back({0.004f, 0.003f, 0.004f});
  finned.masses.push_back(1e-6f);
  finned.triangles.push_back({finned.triangles[40][0], finned.triangles[40][1], 81});
  EXPECT_FALSE(bends_as_sheet(finned, h)) << "an edge of three triangles";

  Object seam = fine;
  for (ConstraintGroup& group : seam.constraints) {
    group.particles.resize(group.particles.size() - 4);
    group.compliances.pop_back();
  }
  EXPECT_FALSE(bends_as_sheet(seam, h)) << "an edge that bends freely";

  Object crease = fine;
  crease.constraints.front().compliances[60] *= 10;
  EXPECT_FALSE(bends_as_sheet(crease, h)) << "a hinge softer than those beside it";

  Object welded = fine;
  ConstraintGroup edge{"distance", {0, 1}, {0.003f}, Stiffness::rigid(), {}};
  welded.constraints.push_back(edge);
  EXPECT_FALSE(bends_as_sheet(welded, h)) << "initial positions that are not the rest shape";

  Object as_given = fine;
  for (ConstraintGroup& group : as_given.constraints)
    if (group.type == "dihedral_bending") group.compliances.clear();
  EXPECT_FALSE(bends_as_sheet(as_given, h)) << "a compliance that the user gives each hinge";
  EXPECT_EQ(facts_of_sheet(as_given).stiffness, 0);
  EXPECT_EQ(facts_of_sheet(as_given).rigidity.front(), 0);
}

}  // namespace
}  // namespace pliant
