// Sets of objects that can meet within a frame: the sets that groups and masks permit (model/object_sets.h), divided by
// distance.
//
// Two objects are near where the boxes of their particles overlap, each grown on all sides by its own size, by twice
// the largest displacement in the frame of anything in its set, and by its thickness. So what is far away has no
// influence on an object's substeps. The size is a margin: objects join while they are still apart, and sets seldom
// change. A displacement counts twice, because an elastic impact on something light doubles a speed. Sets follow from
// the State, the user's control and the length of the frame alone. Grains, gases, and scenes with force fields are not
// divided.
#pragma once

#include <vector>

#include "model/control.h"
#include "model/model.h"
#include "model/object_sets.h"

namespace pliant {

/// What determines the sets of a model's objects by rules, by number of the object.
std::vector<SetMember> set_members(const Model& model);

class NearSets {
 public:
  NearSets() = default;
  explicit NearSets(const Model& model);

  /// False if the sets by rules hold whatever the distances.
  bool depend_on_distance() const { return !divided_.empty(); }
  /// For each object the first one of its set, in a frame of `dt` seconds that begins now.
  std::vector<int> find(const Model& model, const State& state, const Control& control, double dt) const;

 private:
  std::vector<SetMember> members_;
  std::vector<int> by_rules_;              ///< find_sets() of the members
  std::vector<std::vector<int>> divided_;  ///< the sets by rules whose members' distances count, ascending
  std::vector<double> radius_;             ///< of each member about its particles: solids, thickness, spacing [m]
};

}  // namespace pliant
