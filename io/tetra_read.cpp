#include "pliant/error.h"
#include "pliant/io.h"

namespace pliant {

TetrahedralMeshFile read_tetrahedral_mesh(const std::string& path) {
  throw Error({.file = path}, "cannot be read yet", "use a mesh");
}

}  // namespace pliant
