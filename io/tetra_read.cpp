// Chooses the reader of a tetrahedral mesh by the suffix of its file.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>

#include "file_bytes.h"
#include "pliant/error.h"
#include "pliant/parse.h"
#include "tetra_formats.h"

namespace pliant {

namespace {

std::string suffix_of(const std::string& path) {
  std::string suffix = std::filesystem::path(path).extension().string();
  std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return suffix;
}

/// The same path with another suffix.
std::string beside(const std::string& path, const char* suffix) {
  return std::filesystem::path(path).replace_extension(suffix).string();
}

TetrahedralMeshFile read_pair(const std::string& node, const std::string& ele) {
  const std::string nodes = read_file_bytes(node), elements = read_file_bytes(ele);
  return read_tetgen({nodes, node}, {elements, ele});
}

[[noreturn]] void refuse(const std::string& path, const std::string& suffix) {
  static const std::map<std::string, std::pair<const char*, const char*>> known{
      {".obj", {"is a surface", "fill it with tetrahedra: `mesh` in a scene, or fill_with_tetrahedra"}},
      {".stl", {"is a surface", "fill it with tetrahedra: `mesh` in a scene, or fill_with_tetrahedra"}},
      {".ply", {"is a surface", "fill it with tetrahedra: `mesh` in a scene, or fill_with_tetrahedra"}}};
  if (const auto found = known.find(suffix); found != known.end())
    throw Error({.file = path}, found->second.first, found->second.second);
  throw Error({.file = path}, "has the suffix '" + suffix + "', which no format of tetrahedra has",
              "give .node or .ele, .msh, .vtk, .vtu, .mesh, .meshb or .t");
}

using TetrahedraReader = TetrahedralMeshFile (*)(std::string_view, const std::string&);

/// The reader of a format that is one file. Throws an Error if no format has the suffix.
TetrahedraReader reader_of(const std::string& path, const std::string& suffix) {
  static const std::map<std::string, TetrahedraReader> readers{
      {".msh", read_gmsh},           {".vtk", read_vtk},     {".vtu", read_vtu}, {".mesh", read_medit},
      {".meshb", read_binary_medit}, {".t", read_vertex_tet}};
  const auto reader = readers.find(suffix);
  if (reader == readers.end()) refuse(path, suffix);
  return reader->second;
}

}  // namespace

TetrahedralMeshFile parse_tetrahedral_mesh(std::string_view bytes, const std::string& name) {
  const std::string suffix = suffix_of(name);
  if (suffix == ".ele" || suffix == ".node")
    throw Error({.file = name}, "is one of the two files of a mesh of TetGen", "give both to parse_tetgen");
  const TetrahedraReader reader = reader_of(name, suffix);
  if (bytes.empty()) throw Error({.file = name}, "is empty", "export the mesh again");
  return reader(bytes, name);
}

TetrahedralMeshFile parse_tetgen(std::string_view nodes, std::string_view elements, const std::string& name) {
  return read_tetgen({nodes, name + ".node"}, {elements, name + ".ele"});
}

TetrahedralMeshFile read_tetrahedral_mesh(const std::string& path) {
  const std::string suffix = suffix_of(path);
  if (suffix == ".ele") return read_pair(beside(path, ".node"), path);
  if (suffix == ".node") return read_pair(path, beside(path, ".ele"));
  reader_of(path, suffix);  // before the file is read
  return parse_tetrahedral_mesh(read_file_bytes(path), path);
}

}  // namespace pliant
