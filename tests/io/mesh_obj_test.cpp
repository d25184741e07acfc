// Tests the OBJ reader: every form of a face, every line ending, and rejection with the line.
#include "mesh_support.h"

namespace pliant::test {
namespace {

const std::string three = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
using Triangles = std::vector<std::array<int, 3>>;

TEST(MeshObj, ReadsEveryFormOfAFace) {
  for (const char* face :
       {"f 1 2 3", "f 1/1 2/2 3/3", "f 1//1 2//2 3//3", "f 1/1/1 2/2/2 3/3/3", "f 1// 2// 3//", "f 1/ 2/ 3/",
        "f -3 -2 -1", "f -3/-1 -2/-1 -1/-1", "fo 1 2 3", "  f\t1   2 3  ", "f 1 2 3 # the only one"})
    EXPECT_EQ(mesh_of(three + face, "a.obj").triangles, (Triangles{{0, 1, 2}})) << face;
}

TEST(MeshObj, TakesAnyLineEnding) {
  for (const std::string end : {"\n", "\r\n", "\r", "\n\n", "  \n"}) {
    std::string text;
    for (const char* line : {"v 0 0 0", "v 1 0 0", "v 0 1 0", "f 1 2 3"}) text += line + end;
    EXPECT_EQ(mesh_of(text, "a.obj").triangles.size(), 1u);
    text.resize(text.size() - end.size());
    EXPECT_EQ(mesh_of(text, "a.obj").triangles.size(), 1u) << "without an end of the last line";
  }
}

TEST(MeshObj, JoinsLinesAtABackslashAndKeepsCounting) {
  EXPECT_EQ(mesh_of(three + "f 1 \\\n 2 \\\r\n 3", "a.obj").triangles, (Triangles{{0, 1, 2}}));
  EXPECT_TRUE(contains(error_of(three + "f 1 \\\n 2 \\\n 3\nv 1 2 x\n", "a.obj"), "a.obj:7:"));
  EXPECT_EQ(mesh_of("# from C:\\meshes\\\n" + three + "f 1 2 3", "a.obj").positions.size(), 3u)
      << "a comment is not joined";
  EXPECT_TRUE(contains(error_of(three + "f 1 2 \\", "a.obj"), "2 corners")) << "joined with nothing";
}

TEST(MeshObj, ReadsNumbersAsPeopleWriteThem) {
  const TriangleMesh mesh = mesh_of("v +1 .5e-001 -2.\nv 1E2 -.7e+2 1e-400\nv 0 0.0 00 1.0\nf 1 2 3", "a.obj");
  EXPECT_EQ(mesh.positions[0], (Vec3f{1, 0.05f, -2}));
  EXPECT_EQ(mesh.positions[1], (Vec3f{100, -70, 0}));
  EXPECT_EQ(mesh.positions[2], (Vec3f{0, 0, 0}));
}

TEST(MeshObj, RefusesWhatIsNoCoordinate) {
  const std::pair<const char*, const char*> cases[] = {
      {"nan", "is not finite"},      {"-inf", "is not finite"},    {"infinity", "is not finite"},
      {"1.#INF", "is not a number"}, {"1,5", "is not a number"},   {"0x10", "is not a number"},
      {"3.1+e2", "is not a number"}, {"+-1", "is not a number"},   {"++1", "is not a number"},
      {"1e39", "is too large"},      {"1e99999", "is too large"},  {"-1e39", "is too large"},
      {"--1", "is not a number"},    {"1.0.0", "is not a number"}, {"+", "is not a number"},
      {"e5", "is not a number"},
  };
  for (const auto& [word, problem] : cases) {
    const std::string error = error_of("v 0 0 0\nv 1 " + std::string(word) + " 0\nv 0 1 0\nf 1 2 3\n", "a.obj");
    EXPECT_TRUE(contains(error, "a.obj:2: value 2 of vertex 2, '" + std::string(word) + "', " + problem));
  }
}

TEST(MeshObj, IgnoresWeightsAndColours) {
  const std::string rest = "\nv 1 0 0 1\nv 0 1 0 0.5 0.5 0.5 1\nf 1 2 3";
  for (const char* first : {"v 0 0 0", "v 0 0 0 1", "v 0 0 0 1 0 0", "v 0 0 0 1 1 0 0", "v 0 0 0 # origin"})
    EXPECT_EQ(mesh_of(first + rest, "a.obj").positions.size(), 3u) << first;
  EXPECT_TRUE(
      contains(error_of("v 0 0 0 red" + rest, "a.obj"), "a.obj:1: value 4 of vertex 1, 'red', is not a number"));
  EXPECT_TRUE(contains(error_of("v 0 0 0 1 1 1 1 1 1" + rest, "a.obj"), "a.obj:1: a vertex has more than 8 values"));
  EXPECT_TRUE(contains(error_of("v 0 0" + rest, "a.obj"), "a.obj:1: a vertex has 2 coordinates"));
}

TEST(MeshObj, RefusesWhatIsNoFace) {
  const std::pair<const char*, const char*> cases[] = {
      {"f 1 2", "a face has 2 corners"},
      {"f", "a face has 0 corners"},
      {"f 1", "a face has 1 corner instead"},
      {"f 0 1 2", "vertex index 0"},
      {"f 1 2 4", "vertex index 4 but"},
      {"f -4 -2 -1", "vertex index -4 but"},
      {"f 1 2 x", "'x' is not a face corner"},
      {"f 1 2 3.5", "'3.5' is not a face corner"},
      {"f 1/a 2 3", "'1/a' is not a face corner"},
      {"f 1/1/1/1 2 3", "more than three parts"},
      {"f /1 2 3", "'/1' is not a face corner"},
      {"f 1 2 99999999999999999999", "is not a face corner"},
      {"f 1 2 3000000000", "vertex index 3000000000 but"},
  };
  for (const auto& [face, problem] : cases) {
    const std::string error = error_of(three + face + "\n", "a.obj");
    EXPECT_TRUE(contains(error, "a.obj:4: ")) << face;
    EXPECT_TRUE(contains(error, problem)) << face;
  }
}

TEST(MeshObj, LetsFacesComeBeforeTheirVertices) {
  EXPECT_EQ(mesh_of("f 1 2 3\n" + three, "a.obj").triangles, (Triangles{{0, 1, 2}}));
  EXPECT_TRUE(
      contains(error_of("f 1 2 3\nf 1 2 4\n" + three, "a.obj"), "a.obj:2: vertex index 4 but there are 3 vertices"));
}

TEST(MeshObj, SaysWhatItPassedOver) {
  const MeshFile file = parse_mesh(three + "p 1\nl 1 2\nl 2 3\nf 1 2 3\nusemtl x\ng a b\nvt 0 0\nvn 0 0 1\n", "a.obj");
  EXPECT_EQ(joined(file.repairs), "ignored 1 point, the first on line 4\nignored 2 lines, the first on line 5\n");
  EXPECT_TRUE(contains(error_of(three + "l 1 2 3\n", "a.obj"),
                       "has 3 vertices but no faces (ignored 1 line, the first on line 4)"));
}

/// Keywords as programs for garments write them.
TEST(MeshObj, NamesKeywordsThatTheFormatDoesNotHave) {
  const MeshFile file = parse_mesh(three + "seam 1 2\nstitch 1 3\nseam 2 3\nf 1 2 3\nseam-allowance 0.01\n", "a.obj");
  EXPECT_EQ(file.mesh.triangles, (Triangles{{0, 1, 2}}));
  EXPECT_EQ(joined(file.repairs),
            "ignored unknown keywords 'seam' (2 lines, the first 4), 'seam-allowance' (1 line, the first 8), 'stitch' "
            "(1 line, "
            "the first 5)\n");
  std::string many;
  for (char c = 'a'; c <= 'k'; ++c) many += std::string("word") + c + "\n";
  EXPECT_TRUE(contains(joined(parse_mesh(many + three + "f 1 2 3\n", "a.obj").repairs),
                       "'wordh' (1 line, the first 8) and 3 more"));
  std::string prose;
  for (int i = 0; i < 200; ++i)
    prose += std::string("so") + static_cast<char>('a' + i / 26) + static_cast<char>('a' + i % 26) + "\n";
  EXPECT_TRUE(contains(error_of(prose + three + "f 1 2 3\n", "a.obj"), "a.obj:101: unknown keyword"));
}

TEST(MeshObj, RefusesWhatItDoesNotKnow) {
  EXPECT_TRUE(contains(error_of(three + "w 1 1 1\nf 1 2 3\n", "a.obj"), "a.obj:4: unknown keyword 'w'"));
  EXPECT_TRUE(contains(error_of("\x01\x02\xff", "a.obj"),
                       "a.obj:1: unknown keyword '?"
                       "?"
                       "?'"));
  EXPECT_TRUE(contains(error_of(three + std::string("f 1 2 3\0\n", 9), "a.obj"), "a.obj:4: contains a zero byte"));
  EXPECT_TRUE(contains(error_of(std::string(1000, 'z'), "a.obj"), "zzz...'"));
}

TEST(MeshObj, TellsFormatsApartByTheirContent) {
  EXPECT_TRUE(contains(error_of("", "a.obj"), "a.obj: is empty"));
  EXPECT_TRUE(contains(error_of("\xff\xfev", "a.obj"), "UTF-16"));
  EXPECT_TRUE(contains(error_of("PK\x03\x04zip", "a.obj"), "zip archive"));
  EXPECT_TRUE(contains(error_of("version https://git-lfs.github.com/spec/v1\n", "a.ply"), "Git LFS"));
  EXPECT_TRUE(contains(error_of("hello", "a.txt"), "has an unknown mesh format"));
  EXPECT_EQ(mesh_of("\xef\xbb\xbf" + three + "f 1 2 3", "A.OBJ").triangles.size(), 1u) << "a UTF-8 mark is no harm";
  EXPECT_EQ(mesh_of("# mesh\n" + three + "f 1 2 3", "mesh").triangles.size(), 1u) << "no suffix";
  EXPECT_EQ(
      mesh_of("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
              "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
              "wrong.obj")
          .triangles.size(),
      1u);
}

}  // namespace
}  // namespace pliant::test
