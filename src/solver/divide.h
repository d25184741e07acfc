// Into how many substeps a frame is divided where mesh colliders move fast.
//
// What nothing pushes can't be stopped by shortening moves: where it goes farther in a substep than the gap to what it meets, the
// filter has nothing left to do. Contacts keep that gap near the thickness, so a collider that moves half of it in a
// substep never outruns them. Only what is near counts: a collider far from everything costs nothing.
#pragma once

#include <string>
#include <vector>

#include "collision/proxies/pair_model.h"
#include "model/control.h"
#include "model/model.h"

namespace pliant {

/// A frame ahead, as its settings would have it.
struct PlannedFrame {
  double start = 0, dt = 0;  ///< [s]
  int substeps = 1, most_substeps = 1;
};

/// At least `substeps`; more, up to `most_substeps`, until no mesh collider that comes near an object moves more than half the
/// pair's thickness in one. Depends on the state and on what the user moves alone. A warning says how much dearer
/// the frame becomes, another where the most is not enough.
int divided_substeps(const Model& model, const Control& control, const PairModel& pairs, const State& state,
                     const PlannedFrame& frame, std::vector<std::string>& warnings);

}  // namespace pliant
