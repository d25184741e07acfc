// Tests triangulation by what holds for every polygon: n - 2 triangles, none reversed, whose areas sum to the polygon's
// area, whatever direction the polygon faces.
#include <iomanip>
#include <random>
#include <sstream>

#include "mesh_support.h"

namespace pliant::test {
namespace {

struct Polygon {
  std::vector<std::array<double, 2>> corners;  // positions in a plane, counter-clockwise
};

double area(const Polygon& polygon) {
  double twice = 0;
  const std::size_t n = polygon.corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    const auto &a = polygon.corners[i], &b = polygon.corners[(i + 1) % n];
    twice += a[0] * b[1] - a[1] * b[0];
  }
  return twice / 2;
}

/// The polygon in the plane spanned by u and v.
PolygonMesh placed(const Polygon& polygon, const Vec3d& u, const Vec3d& v) {
  PolygonMesh mesh;
  for (std::size_t i = 0; i < polygon.corners.size(); ++i) {
    const Vec3d p = u * polygon.corners[i][0] + v * polygon.corners[i][1];
    mesh.positions.push_back({static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
    mesh.corners.push_back(static_cast<int>(i));
  }
  mesh.close_polygon();
  return mesh;
}

/// Triangulates the polygon facing along each axis in both directions, and obliquely; checks the areas along the
/// normal.
void expect_cut_well(const Polygon& polygon, const std::string& what) {
  const Vec3d frames[][2] = {{{1, 0, 0}, {0, 1, 0}},   {{0, 1, 0}, {0, 0, 1}},        {{0, 0, 1}, {1, 0, 0}},
                             {{0, 1, 0}, {1, 0, 0}},   {{0, 0, 1}, {0, 1, 0}},        {{1, 0, 0}, {0, 0, 1}},
                             {{.6, .8, 0}, {0, 0, 1}}, {{.8, 0, .6}, {-.36, .8, .48}}};
  for (const auto& [u, v] : frames) {
    const PolygonMesh mesh = placed(polygon, u, v);
    std::vector<std::string> notes;
    const auto triangles = triangulate(mesh, what, notes);
    EXPECT_TRUE(notes.empty()) << what << ": " << joined(notes);
    EXPECT_EQ(triangles.size(), polygon.corners.size() - 2) << what;
    const Vec3d normal = cross(u, v);
    double sum = 0;
    for (const auto& t : triangles) {
      const auto at = [&](std::size_t k) {
        const Vec3f& p = mesh.positions[static_cast<std::size_t>(t[k])];
        return Vec3d{p.x, p.y, p.z};
      };
      const double signed_area = 0.5 * dot(cross(at(1) - at(0), at(2) - at(0)), normal);
      EXPECT_GT(signed_area, 0) << what;
      sum += signed_area;
    }
    EXPECT_NEAR(sum, area(polygon), 1e-5 * area(polygon)) << what;
  }
}

TEST(MeshTriangulate, CutsKnownPolygons) {
  expect_cut_well({{{0, 0}, {1, 0}, {1, 1}, {0, 1}}}, "square");
  expect_cut_well({{{0, 0}, {2, 0}, {0.5, 0.5}, {0, 2}}}, "dart");
  expect_cut_well({{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}}, "angle");
  expect_cut_well({{{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}},
                  "square with points on its sides");
  expect_cut_well({{{0, 0}, {5, 0}, {5, 3}, {4, 3}, {4, 1}, {3, 1}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}},
                  "comb");
  expect_cut_well({{{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}}},
                  "square with a bridged hole");
}

TEST(MeshTriangulate, CutsRandomStars) {
  std::mt19937 random(7);
  for (int round = 0; round < 200; ++round) {
    Polygon star;
    const int n = 4 + static_cast<int>(random() % 60);
    for (int i = 0; i < n; ++i) {
      const double radius = 0.1 + 0.9 * static_cast<double>(random() % 1024) / 1024,
                   angle = 2 * 3.14159265358979 * i / n;
      star.corners.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    expect_cut_well(star, "star " + std::to_string(round));
  }
}

TEST(MeshTriangulate, CutsASquareFromItsFirstCorner) {
  EXPECT_EQ(mesh_of("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4", "a.obj").triangles,
            (std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(MeshTriangulate, KeepsNeedlesAwayWhereItCan) {
  // A square with points on its sides, up to rounding. A fan, or cutting the first ear found, would make needles there.
  std::string text, face = "f";
  const int along[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}}, start[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  constexpr int parts = 7;
  for (int side = 0; side < 4; ++side)
    for (int i = 0; i < parts; ++i) {
      const double t = static_cast<double>(i) / parts, off = i % 3 == 1 ? -1e-7 : 0;
      for (int axis = 0; axis < 2; ++axis) {
        const int across = axis == 0 ? -along[side][1] : along[side][0];
        std::ostringstream number;
        number << std::setprecision(9) << start[side][axis] + along[side][axis] * t + across * off;
        text += (axis == 0 ? "v " : " ") + number.str();
      }
      text += " 0\n";
      // The face begins at a corner that would be a needle.
      face += " " + std::to_string((side * parts + i + 1) % (4 * parts) + 1);
    }
  const TriangleMesh mesh = parse_mesh(text + face, "a.obj").mesh;
  EXPECT_EQ(mesh.triangles.size(), 4u * parts - 2);
  for (const Finding& finding : inspect(mesh)) EXPECT_FALSE(contains(finding.message, "sliver"));
}

TEST(MeshTriangulate, SaysWhereAPolygonIsNotSimple) {
  const std::string corners = "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nv 5 5 0\n";
  const MeshFile file = parse_mesh(corners + "f 1 3 2\nf 1 2 3 4\n", "a.obj", as_it_is);
  EXPECT_TRUE(contains(joined(file.repairs),
                       "1 polygon that crosses or touches itself triangulated as well as possible, the first 1"));
  EXPECT_EQ(file.mesh.triangles.size(), 3u);
  const MeshFile round = parse_mesh(corners + "f 1 3 2 4 1 3 2 4 1 3 2 4\n", "a.obj", as_it_is);
  EXPECT_TRUE(
      contains(joined(round.repairs), "1 polygon that goes round its corners several times counted once, the first 0"));
  EXPECT_EQ(round.mesh.triangles.size(), 2u);
  const std::string star = "v 0 1 0\nv -.6 -.8 0\nv .95 .3 0\nv -.95 .3 0\nv .6 -.8 0\nf 1 2 3 4 5\n";
  EXPECT_TRUE(contains(joined(parse_mesh(star, "a.obj", as_it_is).repairs), "crosses"))
      << "turns left everywhere, but goes round twice";
}

TEST(MeshTriangulate, RefusesWhatWouldTakeTooLong) {
  PolygonMesh zigzag;
  for (int i = 0; i < 20000; ++i) {
    zigzag.positions.push_back({static_cast<float>(i), i % 2 == 0 ? 0.f : -1.f, 0});
    zigzag.corners.push_back(i);
  }
  zigzag.close_polygon();
  std::vector<std::string> notes;
  try {
    triangulate(zigzag, "a.obj", notes);
    FAIL();
  } catch (const Error& error) {
    EXPECT_TRUE(contains(error.what(), "polygon 0: is concave and has 20000 corners"));
  }
}

}  // namespace
}  // namespace pliant::test
