// Reads Medit .mesh as text (Frey 2001, "MEDIT: an interactive mesh visualization software"): keywords, each with a
// count and rows.
#include <algorithm>
#include <iterator>

#include "tetra_builder.h"
#include "tetra_formats.h"
#include "tetra_text.h"

namespace pliant {

namespace {

/// Keywords that are passed over, and how many words each of their rows has.
struct Passed {
  std::string_view keyword;
  int words;
};
constexpr Passed passed[] = {{"Edges", 3},
                             {"Triangles", 4},
                             {"Quadrilaterals", 5},
                             {"Corners", 1},
                             {"Ridges", 1},
                             {"RequiredVertices", 1},
                             {"RequiredEdges", 1},
                             {"RequiredTriangles", 1},
                             {"RequiredQuadrilaterals", 1},
                             {"RequiredTetrahedra", 1},
                             {"Normals", 3},
                             {"Tangents", 3},
                             {"NormalAtVertices", 2},
                             {"TangentAtVertices", 2},
                             {"TangentAtEdges", 3},
                             {"NormalAtTriangleVertices", 3}};
constexpr std::string_view refused_keywords[] = {"Hexahedra", "Hexaedra", "Prisms", "Pyramids", "TetrahedraP2"};

void read_vertices(WordReader& words, TetraBuilder& builder) {
  const std::int64_t count = words.count("the number of vertices");
  for (std::int64_t i = 1; i <= count; ++i) {
    const float x = words.real("x"), y = words.real("y"), z = words.real("z");
    builder.add_node(i, {x, y, z}, words.line());
    words.real("a reference");
  }
}

void read_tetrahedra(WordReader& words, TetraBuilder& builder) {
  const std::int64_t count = words.count("the number of tetrahedra");
  for (std::int64_t i = 0; i < count; ++i) {
    std::array<std::int64_t, 4> corners{};
    for (std::int64_t& corner : corners) corner = words.integer("a corner");
    builder.add_tetrahedron(corners, words.line());
    words.integer("a reference");
  }
}

void pass_over(WordReader& words, std::string_view keyword) {
  const auto* found =
      std::find_if(std::begin(passed), std::end(passed), [&](const Passed& one) { return one.keyword == keyword; });
  if (found == std::end(passed))
    words.fail(in_quotes(keyword) + " is no keyword of this format",
               "remove it with its rows, or write the mesh without it");
  const std::int64_t count = words.count("the number of rows");
  for (std::int64_t i = 0; i < count * found->words; ++i)
    if (words.word().empty()) words.fail("ends in its " + std::string(keyword), "the file is cut off: export it again");
}

}  // namespace

TetrahedralMeshFile read_medit(std::string_view bytes, const std::string& name) {
  WordReader words(bytes, name);
  TetraBuilder builder(name);
  words.expect("MeshVersionFormatted");
  words.integer("the version");
  for (std::string_view keyword = words.word(); !keyword.empty() && keyword != "End"; keyword = words.word()) {
    if (keyword == "Dimension") {
      if (const std::int64_t dimension = words.integer("the dimension"); dimension != 3)
        words.fail("has " + std::to_string(dimension) + " dimensions", "give a mesh in space");
    } else if (keyword == "Vertices") {
      read_vertices(words, builder);
    } else if (keyword == "Tetrahedra") {
      read_tetrahedra(words, builder);
    } else if (std::find(std::begin(refused_keywords), std::end(refused_keywords), keyword) !=
               std::end(refused_keywords)) {
      if (words.count("the number of rows") > 0)
        words.fail("has " + std::string(keyword), "export linear tetrahedra alone");
    } else {
      pass_over(words, keyword);
    }
  }
  return builder.result();
}

}  // namespace pliant
