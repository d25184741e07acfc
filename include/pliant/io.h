// File input and output: meshes, scenes and geometry. Part of the library pliant_io; the core accesses no files.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "pliant/mesh.h"
#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant {

/// A mesh as read, and its repairs in words.
struct MeshFile {
  TriangleMesh mesh;
  std::vector<std::string> repairs;
};

/// The repairs that read_mesh makes.
struct MeshReadOptions {
  bool merge_duplicates = true;  ///< merge vertices with equal positions (STL needs it)
  bool drop_degenerate = true;   ///< triangles that use a vertex twice or have no area
  bool drop_isolated = true;     ///< vertices of no triangle
};

/// Reads .obj, .ply (ASCII or binary, either byte order) or .stl (ASCII or binary), told apart by suffix and content;
/// polygons are triangulated. Throws Error with file and line (or byte) if the file can't be read, is empty or truncated, or
/// has non-finite coordinates or indices out of range.
MeshFile read_mesh_file(const std::string& path, const MeshReadOptions& options = {});

/// The mesh of read_mesh_file alone.
TriangleMesh read_mesh(const std::string& path);

/// Writes .obj or .ply. If writing fails, the old file stays as it was and the Error names the path.
void write_mesh(const std::string& path, const TriangleMesh& mesh);

/// A scene as read, and the repairs of its meshes in words.
struct SceneFile {
  Scene scene;
  std::string description;  ///< the file's "description"; may be empty
  std::vector<std::string> repairs;
};

/// Reads a scene in strict JSON (docs/reference/scene-format.md). Throws an Error with file, line, column and JSON path.
/// Unless `allow_outside`, mesh paths may not leave the scene's folder, even by links; they are relative to it.
SceneFile read_scene_file(const std::string& path, bool allow_outside = true);

/// Options of read_scene_file.
struct SceneReadOptions {
  bool allow_outside = true;
  /// Mesh files that replace those of the scene, by name of object or mesh collider; relative to the current folder.
  std::map<std::string, std::string> meshes;
};

/// The same. Throws Error too if `meshes` names no object or mesh collider with a mesh.
SceneFile read_scene_file(const std::string& path, const SceneReadOptions& options);

/// The scene of read_scene_file alone.
Scene read_scene(const std::string& path, bool allow_outside = true);

/// The same from text. Errors call the file `name`; mesh paths are relative to `folder`.
Scene parse_scene(const std::string& text, const std::string& name, const std::string& folder, bool allow_outside = true);

/// The JSON Schema (2020-12) of the scene format, as text.
std::string scene_schema();

/// measure_distances with a cache: reads the field from `folder`, or measures it and writes it there. Creates the folder. The key
/// is a hash of mesh and spacing; a damaged file is replaced. Throws as measure_distances does, and Error with the path if the
/// folder can't be created, read or written.
std::shared_ptr<const DistanceField> cached_distances(const TriangleMesh& mesh, float spacing, const std::string& folder);

/// Sets the field of each distance grid of the scene that has none, by cached_distances.
void use_cached_distances(Scene& scene, const std::string& folder);

/// A file that was written completely.
struct WrittenFile {
  std::string path;
  std::uint64_t bytes = 0;
};

/// Writes the frames of a run one by one. The file is complete after finish().
class FrameWriter {
 public:
  virtual ~FrameWriter() = default;
  virtual void add(const World& world) = 0;  ///< call once a frame, the initial state first
  virtual void finish() = 0;
  virtual std::vector<WrittenFile> written() const = 0;  ///< files written so far, in order; all files after finish()
};

/// A writer by suffix: NAME.obj and NAME.ply (one file per frame, NAME_0000.obj for State::frame 0, ...), .glb (morph
/// targets), .usda (time samples), .pc2 (with NAME.obj), .pvd (one .vtp per frame and object). Throws an Error otherwise.
std::unique_ptr<FrameWriter> make_frame_writer(const std::string& path, const Scene& scene, const World& world);

}  // namespace pliant
