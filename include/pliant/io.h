// Reads and writes meshes, scenes and animations. It is part of the library pliant_io; the core library accesses no
// files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "pliant/gauges.h"
#include "pliant/mesh.h"
#include "pliant/scene.h"
#include "pliant/soft_body.h"
#include "pliant/world.h"

namespace pliant {

/// A mesh that was read, and descriptions of the repairs made.
struct MeshFile {
  TriangleMesh mesh;
  std::vector<std::string> repairs;
};

/// Which repairs read_mesh_file makes.
struct MeshReadOptions {
  bool merge_duplicates = true;  ///< merge vertices with equal positions, as STL files need
  bool drop_degenerate = true;   ///< drop triangles that have no area or use a vertex twice
  bool drop_isolated = true;     ///< drop vertices that no triangle uses
};

/// Reads .obj, .ply (ASCII or binary, either byte order) or .stl (ASCII or binary), according to suffix and content.
/// Polygons are triangulated. Throws an Error with file and line (or byte) if the file cannot be read, is empty or
/// truncated, or has coordinates that are not finite or indices out of range.
MeshFile read_mesh_file(const std::string& path, const MeshReadOptions& options = {});

/// Reads a mesh as read_mesh_file does, and returns the mesh alone.
TriangleMesh read_mesh(const std::string& path);

/// A tetrahedral mesh that was read, and descriptions of the repairs made.
struct TetrahedralMeshFile {
  TetrahedralMesh mesh;
  std::vector<std::string> repairs;
};

/// Reads a mesh of linear tetrahedra: TetGen .node and .ele (either is given, both are read), Gmsh .msh 2.2 and 4.1 as
/// text or binary, VTK .vtk (legacy) and .vtu (XML), Medit .mesh (text) and .meshb (binary), and .t with lines "Vertex"
/// and "Tet". Points, lines and polygons are passed over. Tetrahedra that are inside out are turned, nodes that none
/// uses are left out, and equal points of several pieces of a .vtu file are merged. Throws an Error with file and line
/// (or byte) if the file cannot be read, is damaged or cut off, has other elements, or is so far from the origin that
/// floats lose its shape.
TetrahedralMeshFile read_tetrahedral_mesh(const std::string& path);

/// Writes a mesh as .obj or .ply. If writing fails, an existing file stays unchanged, and the Error names the path.
void write_mesh(const std::string& path, const TriangleMesh& mesh);

/// From where pictures show a scene: the "camera" of its file, or options of `pliant render`. What is absent is chosen.
struct SceneCamera {
  std::optional<float> azimuth{};        ///< angle about the vertical from the front (+z) to the right [degrees]; 28
  std::optional<float> elevation{};      ///< angle above the horizon, -89..89 [degrees]; 18
  std::optional<float> field_of_view{};  ///< vertical angle of view, 5..120 [degrees]; 30
  std::optional<Vec3f> look_at{};        ///< the point in the middle of the picture [m]; the middle of the scene
  std::optional<float> distance{};       ///< from that point, above 0 [m]; so that the scene fills the picture
  std::optional<Vec3f> position{};       ///< [m]; where the three that say from where are absent
};

/// A scene that was read, and the repairs of its meshes and the doubts about its robots ("robot 'NAME', FILE:LINE:
/// ...").
struct SceneFile {
  Scene scene;
  std::string description;  ///< the file's "description"; may be empty
  std::vector<std::string> repairs;
  std::vector<Gauge> gauges;  ///< the file's "gauges"; they measure the scene and do not change it
  /// For each fill that leaves out solids: how many particles it left out, and what they would overlap.
  std::vector<std::string> left_out{};
  SceneCamera camera{};  ///< the file's "camera"
};

/// Reads a scene in strict JSON (docs/reference/scene-format.md). Paths of meshes are relative to the scene's folder;
/// unless `allow_outside`, they may not leave it, even by links. Throws an Error with file, line, column and JSON path.
SceneFile read_scene_file(const std::string& path, bool allow_outside = true);

/// Meshes and points in memory, by name. A scene refers to one by {"array": "NAME"} as the source of a "mesh" or of
/// "tetrahedra", or in place of a list of "positions". They are taken as they are: no vertex is merged or left out, so
/// that numbers of particles are those of the caller.
struct SceneArrays {
  std::map<std::string, TriangleMesh> meshes;
  std::map<std::string, TetrahedralMesh> tetrahedra;
  std::map<std::string, std::vector<Vec3f>> points;  ///< positions [m]
};

/// Options of read_scene_file.
struct SceneReadOptions {
  bool allow_outside = true;
  /// Mesh files that replace those of the scene, by name of object or mesh collider; relative to the working directory.
  std::map<std::string, std::string> meshes{};
  SceneArrays arrays{};
  /// Members to set before the scene is checked: JSON pointers (RFC 6901) such as "/settings/substeps",
  /// "/objects/0/name" or "/colliders/-", which appends; and values, as JSON, or as text that is no JSON and stands for
  /// itself.
  std::vector<std::pair<std::string, std::string>> values{};
};

/// Reads a scene with options. Also throws an Error if `meshes` names no object or mesh collider that has a mesh, if
/// the scene refers to an array that is not there, or if an array has an index out of range or a value that is not
/// finite.
SceneFile read_scene_file(const std::string& path, const SceneReadOptions& options);

/// Reads a scene as read_scene_file does, and returns the scene alone.
Scene read_scene(const std::string& path, bool allow_outside = true);

/// Reads a scene from JSON text. `name` stands for the file in errors; mesh paths are relative to `folder`.
Scene parse_scene(const std::string& text, const std::string& name, const std::string& folder,
                  bool allow_outside = true);

/// Reads a scene from JSON text with options, such as arrays in memory.
SceneFile parse_scene_file(const std::string& text, const std::string& name, const std::string& folder,
                           const SceneReadOptions& options = {});

/// Reads one object or collider from JSON text: an item of "objects" or of "colliders" of the scene format, for
/// World::add or Scene::add. `name`, `folder` and `options` as of parse_scene_file. An object's `fill` leaves out
/// nothing, since nothing is known of what is around it. `repairs`, if not null, receives those of its meshes. Throws
/// an Error as parse_scene_file does.
Object parse_object(const std::string& text, const std::string& name = "object", const std::string& folder = ".",
                    const SceneReadOptions& options = {}, std::vector<std::string>* repairs = nullptr);
std::variant<Collider, MeshCollider> parse_collider(const std::string& text, const std::string& name = "collider",
                                                    const std::string& folder = ".",
                                                    const SceneReadOptions& options = {},
                                                    std::vector<std::string>* repairs = nullptr);

/// Writes a whole Scene as JSON: every particle and constraint, by the names of the members of these headers (bodies
/// `a` and `b` of a joint are `joint_a` and `joint_b`), to print, to compare line by line, to change and to send. It is
/// no scene file: those describe, this lists. Throws an Error if the scene has force fields, which are functions, or a
/// name that is not UTF-8.
std::string scene_json(const Scene& scene);

/// Reads what scene_json wrote: a Scene of the same fingerprint. Members that were taken out have their defaults.
/// Throws an Error with line, column and JSON path if the text is not JSON, was written by another version of the
/// format, or has a member or value that does not belong there. Texts of up to 64 MiB are read, which is some 200 000
/// particles of cloth; save larger ones. `name` stands for the file.
Scene scene_from_json(const std::string& text, const std::string& name = "scene");

/// Returns the JSON Schema (2020-12) of the scene format as text.
std::string scene_schema();

/// A Report as one line of JSON, with the names of the objects of its World. Its members are those of Report, in snake
/// case as there; `residuals` and `phases` are objects by type and phase, `nonfinite` and `widest_tie` null if there is
/// none. A number that is not finite is null.
std::string report_json(const Report& report, const World& world);

/// Options of read_urdf.
struct UrdfOptions {
  Vec3f position{};                      ///< of the root link [m]
  Quatf rotation{};                      ///< of the root link
  bool z_up = true;                      ///< the file's z-axis points up, and becomes the y-axis
  bool fixed_base = false;               ///< joins a root link with mass to the world
  bool self_collision = false;           ///< links that no joint connects collide with each other
  bool motors = false;                   ///< revolute and prismatic joints with an effort limit hold their position
  std::map<std::string, float> targets;  ///< positions to which motors move joints, by name [rad or m]
  bool allow_outside = true;             ///< false: meshes outside the file's folder are refused
  std::string packages;  ///< folder of the packages of "package://" paths; empty: searched above the file
  /// Meshes in memory by the `filename` that the file gives for them. They are taken instead of files.
  std::map<std::string, TriangleMesh> meshes{};
};

/// Reads a robot description in URDF as one object: links become rigid bodies, joints joints. Collision shapes, or else
/// visual ones, become solids; meshes (.obj, .ply, .stl) their convex hulls. What is not supported is named in
/// `warnings` with its line. Throws an Error with file and line if the file is no URDF or its links form no tree.
Object read_urdf(const std::string& path, const UrdfOptions& options = {},
                 std::vector<std::string>* warnings = nullptr);

/// Returns measure_distances(mesh, spacing) from a cache: reads it from `folder`, or measures it and writes it there.
/// Makes the folder. The file name is a hash of mesh and spacing; a damaged file is replaced. Throws as
/// measure_distances does, and an Error with the path if the folder cannot be made, read or written.
std::shared_ptr<const DistanceField> cached_distances(const TriangleMesh& mesh, float spacing,
                                                      const std::string& folder);

/// Calls cached_distances for each distance grid of a scene that has no field yet.
void use_cached_distances(Scene& scene, const std::string& folder);

/// A file that has been written completely.
struct WrittenFile {
  std::string path;
  std::uint64_t bytes = 0;
};

/// Writes the frames of a run one after another. Files are complete after finish().
class FrameWriter {
 public:
  virtual ~FrameWriter() = default;
  virtual void add(const World& world) = 0;  ///< call once for the initial state and once after each step
  virtual void finish() = 0;
  virtual std::vector<WrittenFile> written() const = 0;  ///< files written so far, in order; after finish() all
};

/// Makes a writer by suffix: .obj, .ply (a file per frame: NAME_0000.obj for State::frame 0, ...), .glb (morph
/// targets), .usda (time samples), .pc2 (and NAME.obj), .pvd (a .vtp file per frame and object). Rigid bodies are nodes
/// that move in .glb and .usda, and surfaces in the others. Throws an Error for other suffixes.
std::unique_ptr<FrameWriter> make_frame_writer(const std::string& path, const Scene& scene, const World& world);

/// Receives a file of a frame writer in memory, as soon as it is complete: its path, as it would be on disk, and its
/// bytes. What it throws comes out of the writer's add() or finish().
using FileSink = std::function<void(const std::string& path, std::vector<std::byte> bytes)>;

/// How a frame writer shows liquids, and where its files go.
struct FrameWriterOptions {
  /// True: the surface of each liquid (liquid_surface), a new mesh in each frame, instead of its particles as points.
  /// Only .obj, .ply, .usda and .pvd can have it; other suffixes throw an Error if the scene has a liquid.
  bool liquid_surfaces = false;
  /// Where files go instead of to disk, with the bytes that they would have there; empty: to disk. No file or folder is
  /// then made, and the path of the writer names the format and the files alone: "run.glb" gives one file at finish();
  /// "run.pc2" also "run.obj"; "run.obj" gives "run_0000.obj", ... at each add(); "run.pvd" gives
  /// "run/OBJECT_0000.vtp", ... at each add(), and itself at finish().
  FileSink sink{};
};

/// Makes a writer with options.
std::unique_ptr<FrameWriter> make_frame_writer(const std::string& path, const Scene& scene, const World& world,
                                               const FrameWriterOptions& options);

/// Makes a writer for a World that was made with KeepDescription, which needs no scene. Throws an Error if it was not.
std::unique_ptr<FrameWriter> make_frame_writer(const std::string& path, const World& world,
                                               const FrameWriterOptions& options = {});

}  // namespace pliant
