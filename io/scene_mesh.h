// The surfaces of a scene: files that may be read, and generated shapes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "pliant/mesh.h"
#include "scene_json.h"

namespace pliant::scene_file {

/// Where a scene's meshes may be read from.
struct MeshFolder {
  std::string path;                              ///< the scene's folder
  bool allow_outside = false;                    ///< permits files elsewhere
  std::map<std::string, std::string> instead{};  ///< replacement mesh files, by name of object or collider
};

/// The placement of a mesh record.
struct Placement {
  float fit = 1;
  Vec3f fit_offset{}, scale{1, 1, 1}, translation{};
  bool turns = false;
  Quatf turn{};

  Vec3f place(const Vec3f& p) const;
};

/// A placed surface, with the data that selections need.
struct SceneMesh {
  TriangleMesh mesh;
  std::vector<std::string> repairs;
  int columns = 0, rows = 0;  ///< size of a grid in vertices, else 0
  Placement placement{};      ///< already applied
};

/// Whether a mesh file is repaired or read vertex by vertex.
enum class Repair { yes, no };

/// Reads or generates the surface of a checked "mesh" record of the object or collider `name`. Throws an Error if a path is
/// not permitted, is no file or no readable mesh, or if a vertex lies beyond `largest_place`.
SceneMesh make_mesh(const JsonDocument& document, const JsonValue& at, const MeshFolder& folder, const std::string& name,
                    Repair repair = Repair::yes);

/// The vertices of another frame of `mesh`, placed alike. Throws like make_mesh, or if the number of vertices differs.
std::vector<Vec3f> make_frame(const JsonDocument& document, const JsonValue& at, const MeshFolder& folder,
                              const SceneMesh& mesh);

/// An open tube about the y-axis: vertex (row r, column c) has index r * columns + c; row 0 is at y = 0, the last at y =
/// -length. The radius changes linearly from `top_radius` to `bottom_radius`. `folds` waves around it grow linearly to
/// `fold_depth` times the radius at the bottom. Triangles face outward.
TriangleMesh tube_mesh(int columns, int rows, float length, float top_radius, float bottom_radius, int folds,
                       float fold_depth);

/// A closed box about the origin; each edge has `segments` >= 1. Triangles face outward.
TriangleMesh box_mesh(const Vec3f& size, int segments);

/// A closed animal of the given height on y = 0 that faces +z. Triangles face outward.
TriangleMesh rabbit_mesh(float height, int cells);

}  // namespace pliant::scene_file
