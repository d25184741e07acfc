// Makes a Scene of a JSON tree that has been checked.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "pliant/io.h"
#include "scene_json.h"
#include "scene_mesh.h"

namespace pliant::scene_file {

/// Builds the scene of a document that passed check() with scene_record(). Throws an Error if values contradict each
/// other, a mesh cannot be read or used as cloth, a particle does not exist, or a selection is empty.
SceneFile build(const JsonDocument& document, const MeshFolder& folder);

/// Build one object or collider of a document whose root passed check() with object_record() or collider_record().
/// Nothing is around an object, so that its `fill` leaves nothing out.
Object build_object(const JsonDocument& document, const MeshFolder& folder, std::vector<std::string>& repairs);
std::variant<Collider, MeshCollider> build_collider(const JsonDocument& document, const MeshFolder& folder,
                                                    std::vector<std::string>& repairs);

/// An object, with the data that selections of its particles need.
struct BuiltObject {
  Object object;
  int columns = 0, rows = 0;          ///< number of vertices along a grid; 0: no grid
  std::vector<int> own_velocities{};  ///< the particles of bodies that have a velocity of their own
};

/// Builds an object without pins and attachments. `what` is the member "cloth", "soft_body", "rope" and so on.
BuiltObject build_matter(const JsonDocument& document, const JsonValue& what, const std::string& name,
                         const MeshFolder& folder, std::vector<std::string>& repairs);

/// Removes the particles of an object's record `at` that its `fill` puts into what is solid in `around`, and says how
/// many in `left_out`. Call it before anything refers to particles. Throws an Error if all are.
void leave_out(const JsonDocument& document, const JsonValue& at, const JsonValue& fill, const Scene& around,
               Object& object, std::vector<std::string>& left_out);

/// How the particles of a record "liquid" or "grains" come and go.
Flow particle_flow(const JsonDocument& document, const JsonValue& at);

/// The shape of a record "plane", "sphere", "capsule" or "box".
Shape shape_of(const JsonValue& at);

/// Builds an object of rigid bodies. `list` is the member "bodies".
BuiltObject build_bodies(const JsonDocument& document, const JsonValue& list, const std::string& name,
                         const MeshFolder& folder, std::vector<std::string>& repairs);

/// Builds an object from a robot description. `at` is the member "urdf".
Object build_robot(const JsonDocument& document, const JsonValue& at, const std::string& name, const MeshFolder& folder,
                   std::vector<std::string>& repairs);

/// Adds the joints of an object's record `at`, if it has any.
void set_joints(const JsonDocument& document, const JsonValue& at, Object& object);

/// Builds the gauges of the root, which measure objects and colliders of its scene.
std::vector<Gauge> build_gauges(const JsonDocument& document, const JsonValue& root, const Scene& scene);

/// Builds the camera of a record. Throws an Error if it has no direction, or two.
SceneCamera build_camera(const JsonDocument& document, const JsonValue& at);

/// Add the pins and attachments of a record, of an object or a part, to what it builds.
void set_clusters(const JsonDocument& document, const JsonValue& at, BuiltObject& built);
void set_stitches(const JsonDocument& document, const JsonValue& at, BuiltObject& built);
void set_pins(const JsonDocument& document, const JsonValue& at, BuiltObject& built);
void set_attachments(const JsonDocument& document, const JsonValue& at, BuiltObject& built);

/// Adds the parts of an object's record `at`, if it has any, and ties them to its bodies.
void add_parts(const JsonDocument& document, const JsonValue& at, const MeshFolder& folder, Object& object,
               std::vector<std::string>& repairs);

/// The particles that a checked selection denotes, each once.
std::vector<int> selected(const JsonDocument& document, const JsonValue& at, const BuiltObject& built);

/// What particles are made with: where they are read, and how far apart they are [m].
struct Filling {
  const JsonDocument& document;
  const MeshFolder& folder;
  const std::string& name;
  std::vector<std::string>& repairs;
  float spacing = 0;
};

/// The places in `positions`, or those that fill the box or mesh `fill` at a spacing.
std::vector<Vec3f> places_of(const Filling& by, const JsonValue& at);

// Defined in scene_gases.cpp.
BuiltObject gas_of(const JsonDocument& document, const JsonValue& at, const std::string& name, const MeshFolder& folder,
                   std::vector<std::string>& repairs);
BuiltObject tracers_of(const JsonValue& at, const std::string& name);

/// The points of a record "line".
std::vector<Vec3f> line_points(const JsonValue& at);

// Defined in scene_rods.cpp.
Object rod_of(const JsonDocument& document, const JsonValue& at, const std::string& name);
/// Adds a rod to an object of bodies.
void add_rod_part(const JsonDocument& document, const JsonValue& at, Object& object);

/// The index of the body that a string names. Throws an Error with the nearest name if there is none.
int body_named(const JsonDocument& document, const JsonValue& at, const Object& object);

// Defined in scene_soft_bodies.cpp.
BuiltObject soft_body_of(const JsonDocument& document, const JsonValue& at, const std::string& name,
                         const MeshFolder& folder, std::vector<std::string>& repairs);

}  // namespace pliant::scene_file
