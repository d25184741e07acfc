// The substeps of a group that follow its State: as many as its strain and its motion demand.
//
// They are decided at the start of each quarter of a frame from positions and velocities alone, so a restored State has
// the same. An error in the lengths turns into velocity where the substeps change, so they must follow before it grows:
// whole frames are too long for that (docs/internals/default_settings_tried.md).
#pragma once

#include <vector>

#include "solver/substep.h"

namespace pliant {

inline constexpr int quarters = 4;                              ///< of a frame, in which substeps may differ
inline constexpr int least_by_state = 12, most_by_state = 100;  ///< substeps per frame, unless the settings differ
/// The same where there are only ropes, whose ends may crack like whips and cost little.
inline constexpr int most_of_ropes = 200;
inline constexpr int least_of_hanging = 6;  ///< the same where SubstepGroup::hangs

/// True if the current substep is the last of a quarter.
inline bool ends_quarter(const Substep& s) { return s.most > 0 && (s.number + 1) * quarters % s.planned == 0; }

/// Call at the start of a frame: where substeps are fixed, the State keeps no number of them. If it had one that was
/// far smaller, because an object followed its State until something came near, the frame is guarded.
void forget_substeps(Substep& s);

/// Call before each substep: at the start of a quarter, decides the length of its substeps.
void begin_quarter(Substep& s);

/// Call where a frame is stopped: within a guarded quarter the State gets the number of the quarter before, so that the
/// next frame is guarded too.
void leave_quarter(Substep& s);

}  // namespace pliant
