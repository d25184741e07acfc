// Increases a frame's substeps for fast mesh colliders.
//
// The filter cannot limit kinematic colliders: one that moves farther in a substep than the gap leaves no room. Contacts
// keep the gap near the thickness, so a collider that moves at most half of it per substep never outruns them. Only
// colliders near an object count; distant ones cost nothing.
#pragma once

#include <string>
#include <vector>

#include "collision/proxies/pair_model.h"
#include "model/control.h"
#include "model/model.h"

namespace pliant {

/// A frame as planned from the settings.
struct PlannedFrame {
  double start = 0, dt = 0;  ///< [s]
  int substeps = 1, most_substeps = 1;
};

/// The number of substeps: at least `substeps`, and up to `most_substeps` so that no mesh
/// collider near an object moves more than half the pair's thickness in one. Depends on State
/// and user control alone. Warnings report the extra cost, and a limit that is too low.
int divided_substeps(const Model& model, const Control& control, const PairModel& pairs, const State& state,
                     const PlannedFrame& frame, std::vector<std::string>& warnings);

}  // namespace pliant
