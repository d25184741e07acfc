// What the mesh formats have in common: polygons over points, and the steps that make a triangle mesh of them.
//
//   bytes --parse_obj, parse_ply, parse_stl--> PolygonMesh --triangulate--> triangles --repair--> MeshFile
//
// Each step is a function of values, so that tests and fuzzers reach it without a file.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "pliant/io.h"

namespace pliant {

/// A mesh as a file has it. Every corner is an index into `positions`, every polygon has at least three corners, every
/// coordinate is finite: the parsers see to that.
struct PolygonMesh {
  std::vector<Vec3f> positions;
  std::vector<int> corners;        ///< of all polygons, one after another
  std::vector<std::size_t> ends;   ///< where each polygon's corners end in `corners`
  std::vector<std::string> notes;  ///< what was passed over, in words
  bool is_soup = false;            ///< each triangle has corners of its own (STL): sharing must be found by position

  void close_polygon() { ends.push_back(corners.size()); }
};

/// Parsers of a file's bytes; `name` stands for the file in errors. They throw Error naming line or byte.
PolygonMesh parse_obj(std::string_view bytes, const std::string& name);
PolygonMesh parse_ply(std::string_view bytes, const std::string& name);
PolygonMesh parse_stl(std::string_view bytes, const std::string& name);

/// Cuts all polygons into triangles, n - 2 for n corners, and says in `notes` where that was doubtful; a polygon that goes
/// round several times counts once. Throws Error for a
/// concave polygon of more corners than can be cut up in reasonable time.
std::vector<std::array<int, 3>> triangulate(const PolygonMesh& mesh, const std::string& name,
                                            std::vector<std::string>& notes);

/// Makes the repairs that `options` asks for, each one reported.
void repair(MeshFile& file, bool is_soup, const MeshReadOptions& options);

/// All of it: finds out the format from the suffix of `name` and from the bytes, parses, triangulates, repairs.
MeshFile parse_mesh(std::string_view bytes, const std::string& name, const MeshReadOptions& options = {});

}  // namespace pliant
