// The common part of the mesh formats: polygons over points, and the steps that convert them to a triangle mesh.
//
//   bytes --parse_obj, parse_ply, parse_stl--> PolygonMesh --triangulate--> triangles --repair--> MeshFile
//
// Each step is a function of values, so that tests and fuzzers need no file.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "pliant/io.h"

namespace pliant {

/// A mesh as stored in a file. Parsers guarantee that every corner is an index into `positions`, every polygon has three or
/// more corners, and every coordinate is finite.
struct PolygonMesh {
  std::vector<Vec3f> positions;
  std::vector<int> corners;        ///< corners of all polygons, concatenated
  std::vector<std::size_t> ends;   ///< end of each polygon in `corners`
  std::vector<std::string> notes;  ///< messages about ignored content
  bool is_soup = false;            ///< triangles without shared vertices (STL): vertices must be merged by position

  void close_polygon() { ends.push_back(corners.size()); }
};

/// Parsers of file bytes; `name` stands for the file in errors. They throw an Error with a line or byte offset.
PolygonMesh parse_obj(std::string_view bytes, const std::string& name);
PolygonMesh parse_ply(std::string_view bytes, const std::string& name);
PolygonMesh parse_stl(std::string_view bytes, const std::string& name);

/// Triangulates all polygons, n - 2 triangles for n corners, and adds doubtful cases
/// to `notes`. A polygon that repeats its corner cycle counts once. Throws an Error
/// for a concave polygon with too many corners for ear clipping in reasonable time.
std::vector<std::array<int, 3>> triangulate(const PolygonMesh& mesh, const std::string& name,
                                            std::vector<std::string>& notes);

/// Makes the repairs that `options` requests and reports each.
void repair(MeshFile& file, bool is_soup, const MeshReadOptions& options);

/// Detects the format from the suffix of `name` and from the bytes, then parses, triangulates and repairs.
MeshFile parse_mesh(std::string_view bytes, const std::string& name, const MeshReadOptions& options = {});

}  // namespace pliant
