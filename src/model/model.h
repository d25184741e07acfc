// The constant part of a World: compiled objects, colliders, external fields, and one list of phases over all objects.
// It changes only when objects are added, removed or edited, at a cost that depends on these objects alone.
#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include "model/blocks.h"
#include "model/compiled_object.h"
#include "model/phase.h"
#include "pliant/scene.h"

namespace pliant {

class SolidField;

/// A mesh collider that particles meet as a distance grid or as terrain.
struct FieldCollider {
  int object = 0;  ///< index of the mesh collider in Model::objects
  std::shared_ptr<const SolidField> field;
  Motion motion;
  float thickness = 0, static_friction = 0, kinetic_friction = 0, restitution = 0;
  std::uint32_t groups = 1, mask = ~0u;
};

/// All input of a step but the State. Over fifteen members: a list for each kind of thing in a scene.
struct Model {
  Vec3f gravity{};
  Wind wind;
  std::vector<ForceField> forces;
  std::vector<Collider> colliders;
  std::vector<FieldCollider> fields;
  std::vector<PairProperties> pairs;
  /// Objects and mesh colliders by number. The entry of a removed object is empty until its number is used again.
  std::vector<CompiledObject> objects;
  std::vector<int> first;        ///< first particle of each object in a State
  std::vector<int> first_frame;  ///< first frame of each object in a State
  std::vector<int> generation;   ///< for each number, how often its object was removed or compiled again
  std::set<int> free_numbers;    ///< numbers of removed objects
  BlockAllocator blocks, frame_blocks;
  /// Phases in the order of execution. Those of tiles and of contacts always exist; that of tiles is the first.
  std::vector<Phase> phases{{Driver::tile}, {Driver::surface_contact}, {Driver::collider_contact}};

  /// Adds an object and its tasks under the lowest free number. Returns the number.
  int add(CompiledObject object);
  /// Removes an object and its tasks. Its block in a State becomes a hole.
  void remove(int object);
  /// Replaces an object by one that was compiled again; the number stays.
  void replace(int object, CompiledObject by);

  /// Tasks for all tiles of all objects. Prediction, update and contacts of particles with colliders run by tile.
  const std::vector<Task>& tiles() const { return phases.front().tasks; }
  /// One past the last particle in a State; holes are included.
  int particles() const { return blocks.end(); }
  int frames() const { return frame_blocks.end(); }
  int end_of(int object) const { return first[object] + objects[object].particles; }
  int end_of_frames(int object) const { return first_frame[object] + static_cast<int>(objects[object].frames.size()); }
  int object_of(int particle) const { return blocks.owner_of(particle); }
};

/// Channels of a State: of gases [K], and of tracers [s], where `no_age` says that one is not there.
inline constexpr const char *temperature_channel = "temperature", *age_channel = "age", *water_channel = "water";
inline constexpr float no_age = -1;

/// The State at time 0.
State initial_state(const Model& model);

/// Resizes the frame records of a State to the model's number of frames.
void resize_frames(const Model& model, FrameRecords& frames);
/// Resets `count` frame records from `first` on to those of unused frames.
void clear_frames(int first, int count, FrameRecords& frames);

/// Copies an object's initial state into a State, which is resized if necessary.
void put_at_start(const Model& model, int object, State& state);

}  // namespace pliant
