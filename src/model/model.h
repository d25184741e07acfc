// Everything of a World that does not change as time passes: objects compiled, colliders, the field they are in, and one
// list of phases over all objects. It changes only when objects come, go or are edited, at the cost of those objects.
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

/// A mesh collider that particles meet as a distance grid or as ground.
struct FieldCollider {
  int object = 0;  ///< that of the mesh collider in the model
  std::shared_ptr<const SolidField> field;
  Motion motion;
  float thickness = 0, static_friction = 0, kinetic_friction = 0, restitution = 0;
  std::uint32_t groups = 1, mask = ~0u;
};

/// All that a step needs besides the State. Over fifteen members: one list for each kind of thing that a scene holds.
struct Model {
  Vec3f gravity{};
  Wind wind;
  std::vector<ForceField> forces;
  std::vector<Collider> colliders;
  std::vector<FieldCollider> fields;
  std::vector<PairProperties> pairs;
  /// Objects, and mesh colliders among them. A number whose object was removed has an empty one until it is given out again.
  std::vector<CompiledObject> objects;
  std::vector<int> first;        ///< first[o] is object o's first particle in a State
  std::vector<int> first_frame;  ///< likewise of frames
  std::vector<int> generation;   ///< of each number: how many objects had it before, and recompilations
  std::set<int> free_numbers;    ///< those of removed objects
  BlockAllocator blocks, frame_blocks;
  /// In the order in which an iteration visits them. The first is that of tiles, and what is filled in each substep is always there.
  std::vector<Phase> phases{{Driver::tile}, {Driver::surface_contact}, {Driver::collider_contact}};

  /// Adds an object and its tasks under the lowest free number, which it returns.
  int add(CompiledObject object);
  /// Empties an object and takes out its tasks. Its place in a State becomes a hole.
  void remove(int object);
  /// Replaces an object by a newly compiled one with the same number.
  void replace(int object, CompiledObject by);

  /// All tiles of all objects: what predict, update and contacts with colliders go by, too.
  const std::vector<Task>& tiles() const { return phases.front().tasks; }
  /// Of a State: one past the last that an object has; there may be holes before it.
  int particles() const { return blocks.end(); }
  int frames() const { return frame_blocks.end(); }
  int end_of(int object) const { return first[object] + objects[object].particles; }
  int end_of_frames(int object) const { return first_frame[object] + static_cast<int>(objects[object].frames.size()); }
  int object_of(int particle) const { return blocks.owner_of(particle); }
};

/// The state in which a model's objects begin.
State initial_state(const Model& model);

/// Gives a State as many frames as the model has.
void resize_frames(const Model& model, FrameRecords& frames);
/// Makes `count` frames from `first` on those of nobody.
void clear_frames(int first, int count, FrameRecords& frames);

/// Puts one object into a State where it begins; the State grows as needed.
void put_at_start(const Model& model, int object, State& state);

}  // namespace pliant
