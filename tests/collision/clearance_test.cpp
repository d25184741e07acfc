// Compares the lower bound of two pieces' distance, computed from vertices alone, with the distances of all their
// primitives.
#include "collision/near/clearance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "collision/kernel_support.h"
#include "collision/narrow/pair_contact.h"
#include "collision/proxies/contact_elements.h"
#include "collision/random_support.h"
#include "math/vector.h"
#include "pliant/mesh.h"

namespace pliant {
namespace {

using namespace testing_support;

/// A sheet of 12 x 12 vertices, 1 cm apart, in nine pieces of 4 x 4 vertices and the primitives that begin at them.
class Sheet {
 public:
  static constexpr int side = 12, pieces = 9;

  Sheet() {
    const TriangleMesh mesh = grid_mesh(side, side, 0.11f, 0.11f);
    for (const Vec3f& p : mesh.positions) rest.push_back({p.x, p.y, p.z, 1});
    std::vector<Triangle> triangles;
    for (const auto& t : mesh.triangles) triangles.push_back({t[0], t[1], t[2]});
    elements_ = make_contact_elements(triangles, {}, {}, side * side);
    std::vector<Clearance::Piece> parts(pieces);
    std::vector<Clearance::Line> joined;
    const auto take = [&](Clearance::Piece& part, std::initializer_list<int> corners) {
      for (const int a : corners) {
        part.vertices.push_back(a);
        for (const int b : corners)
          if (a < b) part.lines.push_back({a, b});
      }
    };
    for (int v = 0; v < side * side; ++v) take(parts[piece_of(v)], {v});
    for (const auto& [a, b] : elements_.edges) {
      take(parts[piece_of(a)], {a, b});
      joined.push_back({a, b});
      joined.push_back({b, a});
      neighbours_.insert({a, b});
      neighbours_.insert({b, a});
    }
    for (const Triangle& t : elements_.triangles) take(parts[piece_of(t[0])], {t[0], t[1], t[2]});
    for (Clearance::Piece& part : parts) {
      std::sort(part.vertices.begin(), part.vertices.end());
      part.vertices.erase(std::unique(part.vertices.begin(), part.vertices.end()), part.vertices.end());
    }
    clearance_.add(0, 0, parts, rest, {0, side * side}, joined);
    fill_pairs();
  }

  float between(const PairKernels& kernels, int a, int b, float wanted, const std::vector<Record>& positions) {
    clearance_.place(kernels, a, positions.data());
    clearance_.place(kernels, b, positions.data());
    return clearance_.between(kernels, a, b, wanted, scratch_);
  }

  /// The distance of two pieces, over all pairs of primitives.
  double distance(int a, int b, const std::vector<Record>& positions) const {
    double least = 1e30;
    for (const PairStencil& pair : pairs_[static_cast<std::size_t>(std::min(a, b) * pieces + std::max(a, b))])
      least = std::min(least, pair_distance(pair, positions.data()).distance);
    return least;
  }

  std::vector<Record> rest;

 private:
  static int piece_of(int v) { return v / side / 4 * 3 + v % side / 4; }

  void fill_pairs() {
    pairs_.resize(pieces * pieces);
    const auto add = [&](const PairStencil& pair) {
      for (int i = 0; i < pair.first_side; ++i)
        for (int k = pair.first_side; k < 4; ++k) {
          const int v = pair.vertex[i], u = pair.vertex[k];
          if (v == u || neighbours_.count({v, u}) != 0) return;
        }
      const int a = piece_of(pair.vertex[0]), b = piece_of(pair.vertex[pair.first_side]);
      pairs_[static_cast<std::size_t>(std::min(a, b) * pieces + std::max(a, b))].push_back(pair);
    };
    for (int v = 0; v < side * side; ++v)
      for (const Triangle& t : elements_.triangles) add({{v, t[0], t[1], t[2]}, 1});
    for (std::size_t i = 0; i < elements_.edges.size(); ++i)
      for (std::size_t k = i + 1; k < elements_.edges.size(); ++k)
        add({{elements_.edges[i][0], elements_.edges[i][1], elements_.edges[k][0], elements_.edges[k][1]}, 2});
  }

  ContactElements elements_;
  Clearance clearance_;
  std::set<std::pair<int, int>> neighbours_;
  std::vector<std::vector<PairStencil>> pairs_;
  std::vector<std::int32_t> scratch_;
};

/// The sheet rolled up about an axis in it, stretched, crumpled and displaced; some vertices are moved close to others.
std::vector<Record> deformed(const std::vector<Record>& rest, Random& random) {
  const double curvature = uniform(random, 0, 80), angle = uniform(random, 0, 6),
               noise = std::pow(10., uniform(random, -5, -2)), stretch = uniform(random, 0.7, 1.3);
  const Vec3d at = random_place(random, 3);
  std::vector<Record> out;
  for (const Record& p : rest) {
    const double s = std::cos(angle) * double(p.x) + std::sin(angle) * double(p.z),
                 t = std::cos(angle) * double(p.z) - std::sin(angle) * double(p.x), turn = curvature * s;
    const Vec3d rolled = curvature < 1
                             ? Vec3d{s, 0, t}
                             : Vec3d{std::sin(turn) / curvature, (1 - std::cos(turn)) / curvature + 0.02 * turn, t};
    const Vec3d x = rolled * stretch + at + random_place(random, noise);
    out.push_back({float(x.x), float(x.y), float(x.z), 1});
  }
  for (int drawn = 0; drawn < 3; ++drawn) {
    const auto v = static_cast<std::size_t>(random() % out.size()), to = (v + 1 + random() % 60) % out.size();
    const Vec3d off = random_place(random, 0.004);
    out[v] = {out[to].x + float(off.x), out[to].y + float(off.y), out[to].z + float(off.z), 1};
  }
  return out;
}

TEST(Clearance, IsNoMoreThanTheDistanceOfAnyPair) {
  Sheet sheet;
  Random random(5);
  int near = 0, clear = 0;
  for (int trial = 0; trial < 100; ++trial) {
    const std::vector<Record> positions = deformed(sheet.rest, random);
    const auto wanted = static_cast<float>(uniform(random, 0.001, 0.03));
    for (int a = 0; a < Sheet::pieces; ++a)
      for (int b = a; b < Sheet::pieces; ++b) {
        const double least = sheet.distance(a, b, positions);
        float same = -1;
        for (const PairKernels* kernels : all_kernels()) {
          const float found = sheet.between(*kernels, a, b, wanted, positions);
          ASSERT_LE(double(found), std::min(least, double(wanted)) * (1 + 1e-6)) << "pieces " << a << " and " << b;
          ASSERT_EQ(sheet.between(*kernels, b, a, wanted, positions), found) << "either way about";
          ASSERT_TRUE(same < 0 || found == same) << "on another level";
          same = found;
        }
        near += least < double(wanted) ? 1 : 0;
        clear += double(same) > 0.5 * std::min(least, double(wanted)) ? 1 : 0;
      }
  }
  EXPECT_GT(near, 300);    // enough pairs are near
  EXPECT_GT(clear, 1000);  // enough pairs are clear
}

/// By hand: the nearest vertices that are not adjacent are the two opposite the diagonal of a square, at sqrt(2) of the
/// spacing. A quarter of a squared diagonal is subtracted for either edge, which leaves (2 - 1) of the squared spacing.
TEST(Clearance, OfAFlatSheetIsItsSpacing) {
  Sheet sheet;
  for (const auto& [a, b] : {std::pair(0, 0), std::pair(4, 4), std::pair(4, 5), std::pair(1, 4), std::pair(2, 4)})
    EXPECT_NEAR(sheet.between(*all_kernels().front(), a, b, 0.02f, sheet.rest), 0.01, 1e-5) << a << ", " << b;
  EXPECT_EQ(sheet.between(*all_kernels().front(), 0, 8, 0.02f, sheet.rest), 0.02f) << "far apart: as much as is wanted";
}

/// If all corners are equally far, the bound equals the distance: for a vertex above the middle of an equilateral
/// triangle, and for edges that cross in their middles. The edge lengths of both pieces count; the order of the pieces
/// does not matter.
TEST(Clearance, IsTheDistanceWhereCornersAreEquallyFar) {
  const float height = 0.003f, side = 0.02f, root = std::sqrt(3.f);
  const std::vector<Record> rest{{0, height, 0, 1},
                                 {side / root, 0, 0, 1},
                                 {-side / root / 2, 0, side / 2, 1},
                                 {-side / root / 2, 0, -side / 2, 1},
                                 {5 - side / 2, 0, 0, 1},
                                 {5 + side / 2, 0, 0, 1},
                                 {5, height, -side / 2, 1},
                                 {5, height, side / 2, 1}};
  Clearance clearance;
  clearance.add(0, 0, {{{0}, {}}, {{1, 2, 3}, {{1, 2}, {2, 3}, {1, 3}}}, {{4, 5}, {{4, 5}}}, {{6, 7}, {{6, 7}}}}, rest,
                {0, 8}, {});
  std::vector<std::int32_t> scratch;
  for (const PairKernels* kernels : all_kernels()) {
    for (int piece = 0; piece < 4; ++piece) clearance.place(*kernels, piece, rest.data());
    for (const auto& [a, b] : {std::pair(0, 1), std::pair(1, 0), std::pair(2, 3), std::pair(3, 2)}) {
      const float found = clearance.between(*kernels, a, b, 0.1f, scratch);
      EXPECT_LE(found, height * (1 + 1e-6f)) << a << ", " << b;
      EXPECT_NEAR(found, height, 0.02 * double(height)) << a << ", " << b;
    }
  }
}

}  // namespace
}  // namespace pliant
