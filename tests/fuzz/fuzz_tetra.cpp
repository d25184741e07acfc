// Fuzzes the readers of tetrahedral meshes. The first byte chooses the format; of TetGen the second says where the
// elements begin.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "io/tetra_formats.h"
#include "pliant/error.h"
#include "pliant/soft_body.h"

namespace {

pliant::TetrahedralMeshFile read(std::string_view bytes) {
  static const std::string name = "fuzz";
  const int format = static_cast<unsigned char>(bytes[0]) % 7;
  const std::size_t divided = static_cast<unsigned char>(bytes[1]) * bytes.size() / 256;
  bytes.remove_prefix(2);
  switch (format) {
    case 0:
      return pliant::read_gmsh(bytes, name);
    case 1:
      return pliant::read_vtk(bytes, name);
    case 2:
      return pliant::read_medit(bytes, name);
    case 3:
      return pliant::read_vertex_tet(bytes, name);
    case 4:
      return pliant::read_vtu(bytes, name);
    case 5:
      return pliant::read_binary_medit(bytes, name);
    default:
      return pliant::read_tetgen({bytes.substr(0, divided), name},
                                 {bytes.substr(std::min(divided, bytes.size())), name});
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  try {
    pliant::make_soft_body(read({reinterpret_cast<const char*>(data), size}).mesh);
  } catch (const pliant::Error&) {  // what it should do with most inputs
  }
  return 0;
}
