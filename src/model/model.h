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

/// All input of a step except the State. It has over fifteen members: one list for each kind of thing in a scene.
struct Model {
  Vec3f gravity{};
  Wind wind;
  std::vector<ForceField> forces;
  std::vector<Collider> colliders;
  std::vector<FieldCollider> fields;
  std::vector<PairProperties> pairs;
  /// Objects and mesh colliders by number. The number of a removed object holds an empty one until it is reused.
  std::vector<CompiledObject> objects;
  std::vector<int> first;        ///< first[o] is object o's first particle in a State
  std::vector<int> first_frame;  ///< first_frame[o] is its first frame
  std::vector<int> generation;   ///< of each number: counts removals and recompilations
  std::set<int> free_numbers;    ///< the numbers of removed objects
  BlockAllocator blocks, frame_blocks;
  /// In the order of execution. The phases of tiles and of contacts always exist; that of tiles is the first.
  std::vector<Phase> phases{{Driver::tile}, {Driver::surface_contact}, {Driver::collider_contact}};

  /// Adds an object and its tasks under the lowest free number, which it returns.
  int add(CompiledObject object);
  /// Removes an object and its tasks. Its block in a State becomes a hole.
  void remove(int object);
  /// Replaces an object by a newly compiled one with the same number.
  void replace(int object, CompiledObject by);

  /// All tiles of all objects. Prediction, velocity update and contacts with colliders also run by tile.
  const std::vector<Task>& tiles() const { return phases.front().tasks; }
  /// One past the last particle in a State; holes are included.
  int particles() const { return blocks.end(); }
  int frames() const { return frame_blocks.end(); }
  int end_of(int object) const { return first[object] + objects[object].particles; }
  int end_of_frames(int object) const { return first_frame[object] + static_cast<int>(objects[object].frames.size()); }
  int object_of(int particle) const { return blocks.owner_of(particle); }
};

/// The State at time 0.
State initial_state(const Model& model);

/// Resizes the frame records of a State to the model's number of frames.
void resize_frames(const Model& model, FrameRecords& frames);
/// Resets `count` frames from `first` on to unused ones.
void clear_frames(int first, int count, FrameRecords& frames);

/// Copies an object's initial state into a State, which grows as needed.
void put_at_start(const Model& model, int object, State& state);

}  // namespace pliant
