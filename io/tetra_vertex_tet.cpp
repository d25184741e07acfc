// Reads the text format of Gaia and of other research code: lines "Vertex NUMBER X Y Z" and "Tet NUMBER A B C D"; what
// follows on a line is not read.
#include "tetra_builder.h"
#include "tetra_formats.h"
#include "tetra_text.h"

namespace pliant {

TetrahedralMeshFile read_vertex_tet(std::string_view bytes, const std::string& name) {
  WordReader words(bytes, name);
  TetraBuilder builder(name);
  while (words.next_line()) {
    const std::string_view keyword = words.here();
    if (keyword == "Vertex") {
      const std::int64_t number = words.integer("the number of a vertex");
      const float x = words.real("x"), y = words.real("y"), z = words.real("z");
      builder.add_node(number, {x, y, z}, words.line());
    } else if (keyword == "Tet") {
      words.integer("the number of a tetrahedron");
      std::array<std::int64_t, 4> corners{};
      for (std::int64_t& corner : corners) corner = words.integer("a corner");
      builder.add_tetrahedron(corners, words.line());
    } else if (keyword != "Edge" && keyword != "Face") {
      words.fail(in_quotes(keyword) + " is no keyword of this format", "lines begin with 'Vertex' or 'Tet'");
    }
    words.skip_line();
  }
  return builder.result();
}

}  // namespace pliant
