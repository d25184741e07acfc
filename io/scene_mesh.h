// Where the surfaces of a scene come from: files that may be read, and generated shapes.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "pliant/mesh.h"
#include "scene_json.h"

namespace pliant::scene_file {

/// Where meshes may be looked for.
struct MeshFolder {
  std::string path;                              ///< of the scene
  bool allow_outside = false;                    ///< whether files elsewhere may be read
  std::map<std::string, std::string> instead{};  ///< by name of object or collider: the file that its mesh comes from
};

/// Where a mesh record puts what it describes.
struct Placement {
  float fit = 1;
  Vec3f fit_offset{}, scale{1, 1, 1}, translation{};
  bool turns = false;
  Quatf turn{};

  Vec3f place(const Vec3f& p) const;
};

/// A surface in its place, with what selections need to know about it.
struct SceneMesh {
  TriangleMesh mesh;
  std::vector<std::string> repairs;
  int columns = 0, rows = 0;  ///< of a grid, else 0
  Placement placement{};      ///< as was done already
};

/// Whether files are mended as they are read, or kept vertex by vertex.
enum class Repair { yes, no };

/// Reads or generates the surface that a checked record "mesh" of the object or collider `name` describes. Throws Error where a
/// path is not allowed, is no file, can't be read as a mesh, or where a vertex ends up beyond `largest_place`.
SceneMesh make_mesh(const JsonDocument& document, const JsonValue& at, const MeshFolder& folder, const std::string& name,
                    Repair repair = Repair::yes);

/// The vertices of another frame of `mesh`, placed as it is. Throws Error as make_mesh does, and where there are more or fewer.
std::vector<Vec3f> make_frame(const JsonDocument& document, const JsonValue& at, const MeshFolder& folder,
                              const SceneMesh& mesh);

/// Vertex (row r, column c) of an open tube about the y-axis has index r * columns + c; row 0 is at y = 0, the last one at
/// y = -length. The radius goes evenly from `top_radius` to `bottom_radius`; `folds` waves around grow evenly to
/// `fold_depth` times the radius at the bottom. Triangles face outwards.
TriangleMesh tube_mesh(int columns, int rows, float length, float top_radius, float bottom_radius, int folds,
                       float fold_depth);

/// A closed box about the origin; each edge is cut in `segments` >= 1. Triangles face outwards.
TriangleMesh box_mesh(const Vec3f& size, int segments);

/// A closed animal of the given height on y = 0, looking along +z. Triangles face outwards.
TriangleMesh rabbit_mesh(float height, int cells);

}  // namespace pliant::scene_file
