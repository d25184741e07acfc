// What all mesh formats share: polygons, and the steps that make a triangle mesh of them.
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

#include "pliant/parse.h"

namespace pliant {

/// The polygons of a mesh file. Parsers guarantee that every corner is an index into `positions`, every polygon has
/// three or more corners, and every coordinate is finite.
struct PolygonMesh {
  std::vector<Vec3f> positions;
  std::vector<int> corners;        ///< corners of all polygons, one after another
  std::vector<std::size_t> ends;   ///< one past the last corner of each polygon
  std::vector<std::string> notes;  ///< messages about content that was ignored
  bool is_soup = false;            ///< triangles without shared vertices (STL): vertices must be merged by position

  void close_polygon() { ends.push_back(corners.size()); }
};

/// Equal cases: their number, and the index of the first.
struct Tally {
  std::size_t count = 0, first = 0;
  void add(std::size_t place) {
    if (count++ == 0) first = place;
  }
};

/// Parsers of a file's bytes. `name` stands for the file in errors. They throw an Error with line or byte offset.
PolygonMesh parse_obj(std::string_view bytes, const std::string& name);
PolygonMesh parse_ply(std::string_view bytes, const std::string& name);
PolygonMesh parse_stl(std::string_view bytes, const std::string& name);

/// Divides every polygon of n corners into n - 2 triangles, and describes doubtful cases in `notes`. If a polygon lists
/// its corners several times, they count once. Throws an Error for a concave polygon with so many corners that ear
/// clipping would take too long.
std::vector<std::array<int, 3>> triangulate(const PolygonMesh& mesh, const std::string& name,
                                            std::vector<std::string>& notes);

/// Makes the repairs that `options` requests, and describes each in `file.repairs`.
void repair(MeshFile& file, bool is_soup, const MeshReadOptions& options);

}  // namespace pliant
