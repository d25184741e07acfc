// Keeps the schedule of an object over an edit, so that only what the edit reached is scheduled again.
//
// Particles that an edit adds are stored after the others, in tiles of their own, so no other particle moves. A
// constraint that has the same particles as before keeps its colour. Others go into colours that are for them, each
// into the first in which its particles are free. When these are more than a quarter of all, or such particles are, the
// object is scheduled from scratch.
#pragma once

#include <optional>
#include <vector>

#include "model/compiled_object.h"
#include "model/gather_constraints.h"
#include "pliant/kept_schedule.h"
#include "topology/colouring.h"

namespace pliant {

/// The schedule of a compiled object.
KeptSchedule schedule_of(const CompiledObject& object);

/// What an edit leaves of the schedule of an object. Nothing if it is better made from scratch: the object is small,
/// particles went or changed places, or more than a quarter of them were added by edits.
std::optional<KeptSchedule> follow_edit(const CompiledObject& before, const Object& after,
                                        const std::vector<int>& from);

/// True if more than a quarter of the constraints in lanes have colours of edits: then the object is better scheduled
/// from scratch.
bool has_many_additions(const CompiledObject& object);

/// Throws an Error if a schedule does not fit an object of so many particles, with the targets of its attachments.
void require_fits(const KeptSchedule& kept, std::size_t particles, const std::string& name);

/// The colours that the constraints of a list keep.
struct KeptColours {
  /// Those inside a tile, or between tiles.
  struct OfTile {
    std::vector<Colour> first, added;  ///< those of the first schedule, and those of constraints that edits changed
  };
  std::vector<OfTile> of_tile;  ///< for each tile, then for what is between tiles
  std::vector<char> is_kept;    ///< for each constraint of the list
};

/// Of a list whose stencils are places in storage. What does not fit, is not kept: a file may have any numbers.
KeptColours keep_colours(const KeptSchedule& kept, ConstraintList& list, const std::vector<int>& tile_of, int tiles);

}  // namespace pliant
