// Reads TetGen .node and .ele (Si 2015, TetGen's manual, section 5.2): a line with counts, then a line for each node or
// element, of which attributes and markers at its end are not read. Numbers may start at 0 or 1.
#include "tetra_builder.h"
#include "tetra_formats.h"
#include "tetra_text.h"

namespace pliant {

namespace {

constexpr const char* again = "export it again with TetGen, or check the first line";

/// Throws an Error if rows follow the last one that the first line announces. Comments may.
void expect_end(WordReader& words, std::int64_t count) {
  if (words.next_line())
    words.fail("has more rows than the " + std::to_string(count) + " that its first line announces", again);
}

void read_nodes(const NamedText& file, TetraBuilder& builder) {
  WordReader words(file.bytes, file.name);
  const std::int64_t count = words.count("the number of nodes");
  if (const std::int64_t dimensions = words.integer("the dimension"); dimensions != 3)
    words.fail("nodes have " + std::to_string(dimensions) + " coordinates, not 3", "give a mesh in space");
  words.skip_line();
  for (std::int64_t i = 0; i < count; ++i) {
    if (!words.next_line())
      words.fail("ends after " + std::to_string(i) + " of " + std::to_string(count) + " nodes", again);
    const std::int64_t number = words.integer("the number of a node");
    const float x = words.real("x"), y = words.real("y"), z = words.real("z");
    builder.add_node(number, {x, y, z}, words.line());
    words.skip_line();
  }
  expect_end(words, count);
}

void read_elements(const NamedText& file, TetraBuilder& builder) {
  WordReader words(file.bytes, file.name);
  const std::int64_t count = words.count("the number of tetrahedra");
  if (const std::int64_t corners = words.integer("the number of nodes of a tetrahedron"); corners != 4)
    words.fail("tetrahedra have " + std::to_string(corners) + " nodes, not 4",
               "make the mesh again without the option -o2");
  words.skip_line();
  for (std::int64_t i = 0; i < count; ++i) {
    if (!words.next_line())
      words.fail("ends after " + std::to_string(i) + " of " + std::to_string(count) + " tetrahedra", again);
    words.integer("the number of a tetrahedron");
    std::array<std::int64_t, 4> corners{};
    for (std::int64_t& corner : corners) corner = words.integer("a corner");
    builder.add_tetrahedron(corners, words.line());
    words.skip_line();
  }
  expect_end(words, count);
}

}  // namespace

TetrahedralMeshFile read_tetgen(const NamedText& nodes, const NamedText& elements) {
  TetraBuilder builder(elements.name);
  read_nodes(nodes, builder);
  read_elements(elements, builder);
  return builder.result();
}

}  // namespace pliant
