// Finds the format of a mesh file, and converts its bytes to a mesh.
//
// The suffix says which format is meant, the first bytes which one it is. Clear bytes (the first word of PLY, or an
// unsupported format) override the suffix. If bytes are ambiguous, the suffix decides; if the suffix is unknown, the
// look of the text decides.
#include <algorithm>
#include <utility>

#include "far_mesh.h"
#include "file_bytes.h"
#include "mesh_polygons.h"
#include "pliant/error.h"
#include "text_lines.h"

namespace pliant {

namespace {

enum class Format { unknown, obj, ply, stl };

bool starts_with(std::string_view bytes, std::string_view start) { return bytes.substr(0, start.size()) == start; }

constexpr const char* of_tetrahedra =
    "give an OBJ, PLY or STL file; in a scene a soft_body reads tetrahedra as {\"tetrahedra\": {\"file\": ...}}, in "
    "code "
    "read_tetrahedral_mesh";

/// Throws an Error for known types of files that are often mistaken for meshes.
void refuse_what_is_known(std::string_view bytes, const std::string& name) {
  if (bytes.empty()) refuse_file(name, "is empty", "export the mesh again");
  const std::string_view wide_marks[] = {"\xff\xfe", "\xfe\xff"};
  for (const std::string_view mark : wide_marks)
    if (starts_with(bytes, mark)) refuse_file(name, "is text in UTF-16", "save it as UTF-8 or ASCII");
  if (starts_with(bytes, "version https://git-lfs"))
    refuse_file(name, "is a pointer of Git LFS, not the file itself", "fetch it with 'git lfs pull'");
  const std::pair<std::string_view, const char*> others[] = {
      {"PK\x03\x04", "a zip archive"}, {"\x1f\x8b", "compressed by gzip"}, {"glTF", "a binary glTF file"},
      {"OFF", "an OFF file"},          {"<?xml", "an XML file"},           {"{", "a JSON file"},
      {"#usda", "a USD file"},         {"PXR-USDC", "a USD file"},
  };
  if (starts_with(bytes, "$MeshFormat")) refuse_file(name, "is a Gmsh file", of_tetrahedra);
  const bool is_vtk_xml = bytes.substr(0, 400).find("<VTKFile") != std::string_view::npos;
  if (starts_with(bytes, "# vtk") || is_vtk_xml) refuse_file(name, "is a VTK file", of_tetrahedra);
  for (const auto& [start, what] : others)
    if (starts_with(bytes, start)) refuse_file(name, std::string("is ") + what, "give an OBJ, PLY or STL file");
}

Format format_by_suffix(const std::string& name) {
  if (name.size() < 4) return Format::unknown;
  std::string suffix = name.substr(name.size() - 4);
  for (char& c : suffix) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  if (suffix == ".obj") return Format::obj;
  if (suffix == ".ply") return Format::ply;
  if (suffix == ".stl") return Format::stl;
  return Format::unknown;
}

bool looks_like_ply(std::string_view bytes) {
  return starts_with(bytes, "ply") && bytes.size() > 3 && (bytes[3] == '\n' || bytes[3] == '\r' || bytes[3] == ' ');
}

bool looks_like_binary_stl(std::string_view bytes) {
  if (bytes.size() < 84) return false;
  std::size_t count = 0;
  for (std::size_t i = 4; i-- > 0;) count = count << 8 | static_cast<unsigned char>(bytes[80 + i]);
  return bytes.size() == 84 + 50 * count;
}

/// Guesses the format of a text by its first line that is neither empty nor a comment.
Format looks_like_text(std::string_view bytes) {
  LineReader lines(bytes);
  while (lines.next()) {
    std::string_view rest = lines.line();
    const std::string_view word = take_word(rest);
    if (word.empty() || word.front() == '#') continue;
    if (word == "solid") return Format::stl;
    for (const std::string_view keyword : {"v", "vt", "vn", "o", "g", "mtllib", "usemtl", "s"})
      if (word == keyword) return Format::obj;
    break;
  }
  return Format::unknown;
}

Format format_of(std::string_view bytes, const std::string& name) {
  if (looks_like_ply(bytes)) return Format::ply;
  const Format suffix = format_by_suffix(name);
  if (suffix != Format::unknown) return suffix;
  if (looks_like_binary_stl(bytes)) return Format::stl;
  return looks_like_text(bytes);
}

PolygonMesh parse(std::string_view bytes, const std::string& name) {
  // A UTF-8 byte order mark has no meaning; only texts begin with one.
  if (starts_with(bytes, "\xef\xbb\xbf")) bytes.remove_prefix(3);
  refuse_what_is_known(bytes, name);
  switch (format_of(bytes, name)) {
    case Format::obj:
      return parse_obj(bytes, name);
    case Format::ply:
      return parse_ply(bytes, name);
    case Format::stl:
      return parse_stl(bytes, name);
    case Format::unknown:
      break;
  }
  const std::string suffix = name.substr(std::min(name.rfind('.'), name.size()));
  const bool may_be_tetrahedra = suffix == ".node" || suffix == ".ele" || suffix == ".mesh" || suffix == ".t";
  refuse_file(name, "has an unknown mesh format", may_be_tetrahedra ? of_tetrahedra : "give an OBJ, PLY or STL file");
}

}  // namespace

MeshFile parse_mesh(std::string_view bytes, const std::string& name, const MeshReadOptions& options) {
  PolygonMesh polygons = parse(bytes, name);
  MeshFile file;
  file.repairs = std::move(polygons.notes);
  file.mesh.triangles = triangulate(polygons, name, file.repairs);
  file.mesh.positions = std::move(polygons.positions);
  repair(file, polygons.is_soup, options);
  const Rounding rounding = rounding_of(file.mesh.positions, file.mesh.triangles);
  if (rounding.is_noticeable()) file.repairs.push_back(rounding.in_words() + ": " + move_nearer);
  if (!file.mesh.triangles.empty()) return file;
  refuse_file(name, "has only degenerate triangles",
              "the corners of each lie on one line or coincide; check the scale");
}

MeshFile read_mesh_file(const std::string& path, const MeshReadOptions& options) {
  return parse_mesh(read_file_bytes(path), path, options);
}

TriangleMesh read_mesh(const std::string& path) { return read_mesh_file(path).mesh; }

}  // namespace pliant
