// Everything of a World that does not change as time passes: objects compiled, colliders, the field they are in, and one
// list of tasks over all objects. It changes only when objects come or go.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "model/compiled_object.h"
#include "pliant/scene.h"

namespace pliant {

/// One tile of one object.
struct TileTask {
  int object = 0, tile = 0;
};

/// Segments of inter-tile constraints that share no particle, over all objects.
struct InterTilePhase {
  struct Task {
    int object = 0, segment = 0;
  };
  std::vector<Task> tasks;
  int batches = 0;
};

/// Chain batches that share no particle, over all objects.
struct ChainPhase {
  struct Task {
    int object = 0, batch = 0;
  };
  std::vector<Task> tasks;
  int steps = 0;
};

class SolidField;

/// A mesh collider that particles meet as a distance grid or as ground.
struct FieldCollider {
  std::shared_ptr<const SolidField> field;
  Motion motion;
  float thickness = 0, static_friction = 0, kinetic_friction = 0, restitution = 0;
  std::uint32_t groups = 1, mask = ~0u;
};

struct Model {
  Vec3f gravity{};
  Wind wind;
  std::vector<ForceField> forces;
  std::vector<Collider> colliders;
  std::vector<FieldCollider> fields;
  std::vector<PairProperties> pairs;
  std::vector<CompiledObject> objects;  ///< the user's, then one for each mesh collider
  int user_objects = 0;
  std::vector<int> first;        ///< first[o] is object o's first particle in a State; one more at the end
  std::vector<int> first_frame;  ///< likewise of frames
  std::vector<TileTask> tiles;
  std::vector<InterTilePhase> inter_tile;
  std::vector<InterTilePhase> stencils;  ///< what is projected one constraint at a time (solver/stencil.h)
  std::vector<ChainPhase> chains;

  /// Appends an object and its tasks.
  void add(CompiledObject object);
  int particles() const { return first.empty() ? 0 : first.back(); }
  int frames() const { return first_frame.empty() ? 0 : first_frame.back(); }
};

/// The state in which a model's objects begin.
State initial_state(const Model& model);

}  // namespace pliant
