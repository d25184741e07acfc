// Objects in the model, the State and the workspace. Each has a number in the model, a block in the State and its own
// part of the workspace, so the cost of a change depends on that object alone.
#pragma once

#include <memory>
#include <vector>

#include "world/world_data.h"

namespace pliant {

/// Moves the particles of an object that have keyframes to their positions at `time` [s].
void move_to_present(const CompiledObject& object, double time, Record* positions);
/// The distance field of a mesh collider; null if it collides as triangles. Throws an Error if the mesh is unsuitable.
std::shared_ptr<const SolidField> field_of(const MeshCollider& collider);

/// Adds a compiled mesh collider to the model. Returns its number.
int add_to_model(WorldData& world, const MeshCollider& collider, CompiledObject compiled);
/// Adds the distance field of a mesh collider. Fields are ordered by the collider's number.
void add_field(WorldData& world, const MeshCollider& collider, std::shared_ptr<const SolidField> field, int number);

/// Prepares the workspace for an object that was added, removed or recompiled.
void prepare_object(WorldData& world, int number);
/// Allocates the State and the workspace of an object that was just added to the model, and fills them.
void place_object(WorldData& world, int number);
/// Removes an object from model, State and workspace.
void remove_object(WorldData& world, int number);
/// Replaces an object. `from` lists for each new particle the old one whose state it gets, as Edit::from.
void replace_object(WorldData& world, int number, CompiledObject by, const std::vector<int>& from);

}  // namespace pliant
