// Tests repairs: what is repaired, what is left alone, and that every repair is described.
#include "mesh_support.h"

namespace pliant::test {
namespace {

MeshFile obj_file(const std::string& text, const MeshReadOptions& options = {}) {
  return parse_mesh(text, "a.obj", options);
}

TEST(MeshRepair, MergesTwoHalvesAlongTheirSeam) {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv -0 1 -0\nf 1 2 3\nf 4 5 6\n";
  const MeshFile file = obj_file(text);
  EXPECT_EQ(file.mesh.positions.size(), 4u);
  EXPECT_EQ(file.mesh.triangles, (std::vector<std::array<int, 3>>{{0, 1, 2}, {1, 3, 2}}));
  EXPECT_EQ(joined(file.repairs), "merged 2 vertices with others at the same position, the first 3\n");
  EXPECT_EQ(obj_file(text, as_it_is).mesh.positions.size(), 6u);
  EXPECT_TRUE(obj_file(text, as_it_is).repairs.empty());
}

TEST(MeshRepair, DropsTrianglesWithoutArea) {
  const std::string start =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nv 0.1 0.1 0.1\nv 0.2 0.2 0.2\nv 0.4 0.4 0.4\nf 1 2 3\n";
  for (const char* face : {"f 1 1 2", "f 1 2 4", "f 2 3 3", "f 5 6 7"}) {
    const MeshFile file = obj_file(start + face);
    EXPECT_EQ(file.mesh.triangles.size(), 1u) << face;
    EXPECT_TRUE(contains(joined(file.repairs), "dropped 1 triangle without area, the first 1")) << face;
  }
  EXPECT_EQ(obj_file(start + "f 1 2 4", {true, false, true}).mesh.triangles.size(), 2u);
  EXPECT_TRUE(contains(error_of("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3", "a.obj"), "has only degenerate triangles"));
}

TEST(MeshRepair, KeepsATriangleThatIsMerelySmall) {
  EXPECT_EQ(obj_file("v 0 0 0\nv 1e-19 0 0\nv 0 1e-19 0\nf 1 2 3").mesh.triangles.size(), 1u);
}

TEST(MeshRepair, DropsTrianglesThatRepeatAnother) {
  const std::string start = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 4\nf 1 2 3\n";
  EXPECT_TRUE(
      contains(joined(obj_file(start + "f 2 3 1").repairs), "dropped 1 triangle that repeats another, the first 2"));
  EXPECT_TRUE(contains(joined(obj_file(start + "f 1 2 2\nf 3 1 2\nf 2 3 1").repairs),
                       "dropped 2 triangles that repeat another, the first 3"));
  EXPECT_EQ(obj_file(start + "f 3 2 1").mesh.triangles.size(), 3u) << "the other side of a leaf is no repetition";
}

TEST(MeshRepair, DropsIsolatedVerticesAndRenumbers) {
  const std::string text = "v 9 9 9\nv 0 0 0\nv 8 8 8\nv 1 0 0\nv 0 1 0\nv 1 0 0\nf 2 4 5\n";
  const MeshFile file = obj_file(text);
  EXPECT_EQ(file.mesh.positions, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(file.mesh.triangles, (std::vector<std::array<int, 3>>{{0, 1, 2}}));
  EXPECT_TRUE(contains(joined(file.repairs), "dropped 2 vertices of no triangle, the first 0"));
  EXPECT_EQ(obj_file(text, {true, true, false}).mesh.positions.size(), 5u) << "what merging emptied goes all the same";
}

TEST(MeshRepair, SaysWhereFloatsAreCoarse) {
  const MeshFile file = obj_file("v 500000 0 0\nv 500000.1 0 0\nv 500000 0.1 0\nf 1 2 3\n");
  EXPECT_TRUE(
      contains(joined(file.repairs), "lies 500000.1 from the origin, where floats are 0.031 apart, 28 % of its"));
  EXPECT_TRUE(obj_file("v 5000 0 0\nv 5000.1 0 0\nv 5000 0.1 0\nf 1 2 3\n").repairs.empty());
}

/// A grid of columns x rows vertices in the xz-plane at height 0, as OBJ text.
std::string sheet(int columns, int rows, int first_index) {
  std::string text;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) text += "v " + std::to_string(c) + " 0 " + std::to_string(r) + "\n";
  for (int r = 0; r + 1 < rows; ++r)
    for (int c = 0; c + 1 < columns; ++c) {
      const int i = first_index + r * columns + c;
      text += "f " + std::to_string(i) + " " + std::to_string(i + columns) + " " + std::to_string(i + columns + 1) +
              " " + std::to_string(i + 1) + "\n";
    }
  return text;
}

std::string reversed_sheet(int columns, int rows, int first_index) {
  std::string text = sheet(columns, rows, first_index), result;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    std::string line = text.substr(at, end - at);
    if (line[0] == 'f') {
      int a, b, c, d;
      EXPECT_EQ(std::sscanf(line.c_str(), "f %d %d %d %d", &a, &b, &c, &d), 4);
      line = "f " + std::to_string(a) + " " + std::to_string(d) + " " + std::to_string(c) + " " + std::to_string(b);
    }
    result += line + "\n";
    at = end + 1;
  }
  return result;
}

TEST(MeshRepair, LeavesTwoSheetsInOnePlaceApart) {
  const MeshFile file = obj_file(sheet(4, 4, 1) + reversed_sheet(4, 4, 17));
  EXPECT_EQ(file.mesh.positions.size(), 32u);
  EXPECT_EQ(file.mesh.triangles.size(), 36u);
  EXPECT_TRUE(
      contains(joined(file.repairs), "kept 16 vertices separate from others at the same position, the first 16"));
}

TEST(MeshRepair, TakesASheetThatIsThereTwiceForOne) {
  const MeshFile file = obj_file(sheet(4, 4, 1) + sheet(4, 4, 17));
  EXPECT_EQ(file.mesh.positions.size(), 16u);
  EXPECT_EQ(file.mesh.triangles.size(), 18u);
}

TEST(MeshRepair, KeepsAFoldTogetherWhoseStripHasNoWidth) {
  // Two sheets in one place. At row 0 a strip of triangles between coincident vertices connects them.
  std::string text = sheet(4, 3, 1) + reversed_sheet(4, 3, 13);
  for (int c = 1; c < 4; ++c)
    text += "f " + std::to_string(c) + " " + std::to_string(c + 1) + " " + std::to_string(c + 13) + "\nf " +
            std::to_string(c) + " " + std::to_string(c + 13) + " " + std::to_string(c + 12) + "\n";
  const MeshFile file = obj_file(text);
  EXPECT_EQ(file.mesh.positions.size(), 20u) << "4 of 24 are one with their neighbours across the fold";
  EXPECT_EQ(file.mesh.triangles.size(), 24u);
  EXPECT_TRUE(contains(joined(file.repairs), "dropped 6 triangles without area"));
  EXPECT_TRUE(contains(joined(file.repairs), "merged 4 vertices"));
  for (const Finding& finding : inspect(file.mesh)) {
    EXPECT_FALSE(contains(finding.message, "pieces"));
    EXPECT_FALSE(contains(finding.message, "more than two triangles"));
  }
}

}  // namespace
}  // namespace pliant::test
