// The particles and frames of a compiled object: their numbers, tiles and States at the start, and those that follow
// keyframes.
#pragma once

#include <vector>

#include "model/compiled_object.h"
#include "model/gather_constraints.h"

namespace pliant {

/// The positions of the user's particles, then the targets of attachments.
std::vector<Vec3f> all_positions(const Object& object);

/// Cuts particles into tiles and numbers them tile by tile. `tile` becomes the tile of each particle, by the user's
/// index. `held`: an object whose targets are to be in the tiles of their particles, or null.
void number_particles(const std::vector<Vec3f>& positions, const std::vector<ConstraintList>& lists, int largest_tile,
                      const Object* held, std::vector<int>& tile, CompiledObject& out);
/// Numbers particles as an earlier schedule does. Throws an Error if that is not one of so many particles.
void number_as_before(const KeptSchedule& kept, std::vector<int>& tile, CompiledObject& out);

// After number_particles:
void fill_particles(const Object& object, const std::vector<Vec3f>& positions, CompiledObject& out);
void fill_frames(const Object& object, FrameRecords& out);
void fill_kinematics(const Object& object, CompiledObject& out);

}  // namespace pliant
