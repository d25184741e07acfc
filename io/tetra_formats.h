// The readers of tetrahedral meshes, one for each format. Each gets the bytes of a file, and its name for errors.
#pragma once

#include <string>
#include <string_view>

#include "pliant/io.h"

namespace pliant {

/// TetGen: the bytes of the .node file and of the .ele file.
struct NamedText {
  std::string_view bytes;
  const std::string& name;
};
TetrahedralMeshFile read_tetgen(const NamedText& nodes, const NamedText& elements);

TetrahedralMeshFile read_gmsh(std::string_view bytes,
                              const std::string& name);  ///< .msh 2.2 and 4.1, as text and binary
TetrahedralMeshFile read_vtk(std::string_view bytes, const std::string& name);  ///< legacy .vtk
/// The same with numbers as bytes, big end first. `offset` is that of the line after "BINARY".
TetrahedralMeshFile read_binary_vtk(std::string_view bytes, std::size_t offset, const std::string& name);

TetrahedralMeshFile read_vtu(std::string_view bytes, const std::string& name);  ///< .vtu: the same in XML

TetrahedralMeshFile read_medit(std::string_view bytes, const std::string& name);         ///< .mesh, as text
TetrahedralMeshFile read_binary_medit(std::string_view bytes, const std::string& name);  ///< .meshb
TetrahedralMeshFile read_vertex_tet(std::string_view bytes, const std::string& name);    ///< lines "Vertex" and "Tet"

}  // namespace pliant
