// Increases the number of a frame's substeps where mesh colliders are fast.
//
// The filter cannot limit kinematic colliders: one that moves farther in a substep than the gap leaves no room.
// Contacts keep the gap near the thickness, so a collider that moves at most half the thickness per substep always
// leaves room. Colliders far from all objects are ignored, so they cost nothing.
#pragma once

#include <string>
#include <vector>

#include "collision/proxies/pair_model.h"
#include "model/control.h"
#include "model/model.h"

namespace pliant {

/// The start, length and number of substeps of a frame, as the settings plan it.
struct PlannedFrame {
  double start = 0, dt = 0;  ///< start and length of the frame [s]
  int substeps = 1, most_substeps = 1;
  int usual_substeps = 0;  ///< a warning is given only if the frame gets more than these
  int multiple = 1;        ///< the number is a multiple of this, unless it is `most_substeps`
};

/// Returns the number of substeps: at least `substeps`, and up to `most_substeps` so that no mesh collider near an
/// object moves more than half the pair's thickness in a substep. It depends on the State and user control alone.
/// Warnings report the extra cost, and when `most_substeps` is too low.
int divided_substeps(const Model& model, const Control& control, const PairModel& pairs, const State& state,
                     const PlannedFrame& frame, std::vector<std::string>& warnings);

}  // namespace pliant
