// The surfaces of a scene: files that may be read, and generated meshes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "pliant/io.h"
#include "pliant/mesh.h"
#include "scene_json.h"

namespace pliant::scene_file {

/// Where the meshes of a scene may be read from.
struct MeshFolder {
  std::string path;                              ///< folder of the scene file
  bool allow_outside = false;                    ///< true: files elsewhere are allowed too
  std::map<std::string, std::string> instead{};  ///< replacement mesh files, by name of object or collider
  const SceneArrays* arrays = nullptr;           ///< null: there are none
};

/// Returns the path of the file that a scene names. Throws an Error if it is no regular file, or is not allowed.
std::string allowed_path(const JsonDocument& document, const JsonValue& at, const MeshFolder& folder);

/// True if `path` is below `folder` after links are resolved.
bool lies_below(const std::string& path, const std::string& folder);

/// Scale, rotation and position of a mesh in the scene.
struct Placement {
  float fit = 1;
  Vec3f fit_offset{}, scale{1, 1, 1}, translation{};
  bool turns = false;
  Quatf turn{};

  Vec3f place(const Vec3f& p) const;
};

/// The smallest box along the axes about some positions.
struct MeshBounds {
  Vec3f low{}, high{};

  float longest_side() const;
};
/// Of one position or more.
MeshBounds bounds_of(const std::vector<Vec3f>& positions);

/// A mesh at its place in the scene, with the data that selections need.
struct SceneMesh {
  TriangleMesh mesh;
  std::vector<std::string> repairs;
  int columns = 0, rows = 0;  ///< number of vertices along a grid; 0: no grid
  Placement placement{};      ///< already applied to the vertices
};

/// Whether a mesh file is repaired, or read vertex by vertex.
enum class Repair { yes, no };

/// Reads or generates the mesh of a checked "mesh" record, which belongs to the object or collider `name`. Throws an
/// Error if a path is not allowed, is no readable mesh file, or if a vertex is beyond `largest_place`.
SceneMesh make_mesh(const JsonDocument& document, const JsonValue& at, const MeshFolder& folder,
                    const std::string& name, Repair repair = Repair::yes);

/// The tetrahedra in memory that the string `at` names. Throws an Error if there are none, or if an index is out of
/// range.
TetrahedralMesh tetrahedra_named(const JsonDocument& document, const JsonValue& at, const MeshFolder& folder);

/// The member "positions" of a checked record: a list, or the points in memory that {"array": NAME} names; empty if it
/// is absent. Throws an Error if there are no such points, or one is beyond `largest_place`.
std::vector<Vec3f> positions_at(const JsonDocument& document, const JsonValue& at, const MeshFolder& folder);

/// Moves positions by the placement in a checked record with `fit`, `scale`, `rotate` and `translate`. Throws an Error
/// if one is then beyond `largest_place`.
Placement place(const JsonDocument& document, const JsonValue& at, std::vector<Vec3f>& positions);

/// Reads the vertices of another frame of `mesh`, with its placement. Throws like make_mesh, or if their number
/// differs.
std::vector<Vec3f> make_frame(const JsonDocument& document, const JsonValue& at, const MeshFolder& folder,
                              const SceneMesh& mesh);

/// An open tube about the y-axis. Vertex (row r, column c) has index r * columns + c; row 0 is at y = 0, the last one
/// at y = -length. The radius changes linearly from `top_radius` to `bottom_radius`. `folds` waves around the tube grow
/// linearly to `fold_depth` times the radius at the bottom. Triangles face outward.
TriangleMesh tube_mesh(int columns, int rows, float length, float top_radius, float bottom_radius, int folds,
                       float fold_depth);

/// A closed box about the origin, each edge divided into `segments` >= 1. Triangles face outward.
TriangleMesh box_mesh(const Vec3f& size, int segments);

/// A closed rabbit of the given height that stands on y = 0 and faces +z. Triangles face outward.
TriangleMesh rabbit_mesh(float height, int cells);

}  // namespace pliant::scene_file
