// Tests the STL reader: text and binary recognised by content, vertices merged by position, rejection with line and
// byte.
#include "mesh_support.h"

namespace pliant::test {
namespace {

std::string facet(const std::string& corners) {
  std::string text = "facet normal 0 0 1\n outer loop\n";
  std::size_t at = 0;
  for (int i = 0; i < 3; ++i) {
    const std::size_t end = corners.find(';', at);
    text += "  vertex " + corners.substr(at, end - at) + "\n";
    at = end + 1;
  }
  return text + " endloop\nendfacet\n";
}

const std::string text_stl =
    "solid a b c\n" + facet("0 0 0;1 0 0;0 1 0;") + facet("1 0 0;1 1 0;0 1 0;") + "endsolid a b c\n";

std::string binary_mesh(const std::vector<std::array<float, 9>>& triangles, std::string head = {}) {
  head.resize(80, ' ');
  std::string bytes = head + bytes_of(static_cast<std::uint32_t>(triangles.size()));
  for (const auto& triangle : triangles) {
    bytes += bytes_of(0.0f) + bytes_of(0.0f) + bytes_of(NAN);  // normals are ignored
    for (const float value : triangle) bytes += bytes_of(value);
    bytes += "ab";
  }
  return bytes;
}

const std::vector<std::array<float, 9>> two = {{0, 0, 0, 1, 0, 0, 0, 1, 0}, {1, 0, 0, 1, 1, 0, 0, 1, 0}};

TEST(MeshStl, ReadsTextAndBytesAlike) {
  for (const std::string& bytes : {text_stl, binary_mesh(two), binary_mesh(two, "solid but binary")}) {
    EXPECT_EQ(mesh_of(bytes, "a.stl").positions.size(), 6u);
    const MeshFile file = parse_mesh(bytes, "a.stl");
    EXPECT_EQ(file.mesh.positions.size(), 4u);
    EXPECT_EQ(file.mesh.triangles, (std::vector<std::array<int, 3>>{{0, 1, 2}, {1, 3, 2}}));
    EXPECT_EQ(joined(file.repairs), "merged 2 vertices with others at the same position, the first 3\n");
  }
}

TEST(MeshStl, TakesKeywordsOfEitherCaseAndSeveralSolids) {
  std::string upper = text_stl;
  for (char& c : upper) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  EXPECT_EQ(mesh_of(upper, "a.STL").triangles.size(), 2u);
  EXPECT_EQ(mesh_of("\n\n" + text_stl + "solid\nendsolid\n" + text_stl, "a.stl").triangles.size(), 4u);
}

TEST(MeshStl, JoinsAllThatLiesInOnePlaceEvenWhereItBranches) {
  const std::string fan = "solid\n" + facet("0 0 0;0 0 1;1 0 0;") + facet("0 0 0;0 0 1;0 1 0;") +
                          facet("0 0 0;0 0 1;-1 0 0;") + "endsolid\n";
  EXPECT_EQ(parse_mesh(fan, "a.stl").mesh.positions.size(), 5u);
}

TEST(MeshStl, RefusesDamagedTextByLine) {
  const std::pair<std::string, const char*> cases[] = {
      {"solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n",
       "stl:6: 'endloop' where 'vertex'"},
      {"solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 1 0\n",
       "stl:7: 'vertex' where 'endloop'"},
      {"solid\nfacet normal 0 0 1\nvertex 0 0 0\n", "stl:3: 'vertex' where 'outer'"},
      {"solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n", "stl:4: a vertex has fewer than 3"},
      {"solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0 0\n", "stl:4: a vertex continues with '0'"},
      {"solid\nfacet normal 0 0 1\nouter loop\nvertex 0 inf 0\n", "stl:4: 'inf' is not finite"},
      {"solid\nfacet normal 0 0 1\nouter loop\nvertex 0 1e60 0\n", "stl:4: '1e60' is too large"},
      {"solid\n" + facet("0 0 0;1 0 0;0 1 0;"), "stl:8: the file ends inside a solid"},
      {text_stl.substr(0, 40), "the file ends inside a facet"},
      {text_stl + "rubbish\n", "'rubbish' where 'solid' should stand"},
      {"solid\nendsolid\n", "has no triangles"},
  };
  for (const auto& [text, problem] : cases) EXPECT_TRUE(contains(error_of(text, "a.stl"), problem)) << text;
}

TEST(MeshStl, RefusesDamagedBytes) {
  const std::string bytes = binary_mesh(two);
  EXPECT_TRUE(contains(error_of(bytes.substr(0, bytes.size() - 1), "a.stl"),
                       "byte 80: claims 2 triangles, 184 bytes, but holds 183"));
  EXPECT_TRUE(contains(error_of(bytes.substr(0, 83), "a.stl"), "is neither a text STL"));
  EXPECT_TRUE(contains(error_of(std::string(bytes).replace(80, 4, "\xff\xff\xff\xff"), "a.stl"),
                       "claims 4294967295 triangles"));
  EXPECT_TRUE(contains(error_of(std::string(bytes).replace(84 + 50 + 12, 4, bytes_of(INFINITY)), "a.stl"),
                       "byte 146: a coordinate of triangle 1 is not finite"));
  EXPECT_TRUE(contains(error_of(std::string(bytes).replace(80, 4, std::string(4, '\0')).substr(0, 84), "a.stl"),
                       "has no triangles"));
  EXPECT_TRUE(contains(joined(parse_mesh(bytes + "xyz", "a.stl").repairs), "ignored 3 bytes after the last triangle"));
}

TEST(MeshStl, IsRecognisedWithoutASuffix) {
  EXPECT_EQ(mesh_of(text_stl, "thing").triangles.size(), 2u);
  EXPECT_EQ(mesh_of(binary_mesh(two), "thing.bin").triangles.size(), 2u);
}

}  // namespace
}  // namespace pliant::test
