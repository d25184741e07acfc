// What truncation takes from the motion that free objects have in common.
//
// A step that is cut ends short of where its velocity leads, so the centre of mass lags, and the angular momentum about
// other points changes by that lag times the momentum. Therefore a free group (free_objects.h) is moved as a whole by
// what its centre of mass lags in the substep. Velocities stay, and so do distances within the group.
#pragma once

namespace pliant {

struct Substep;

/// After all truncation of a substep: moves each free group by its lag, unless something else that it may meet comes
/// within that. Returns true if any was moved.
bool move_by_lag(Substep& s);

}  // namespace pliant
