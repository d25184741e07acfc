// A substep group: all sets of objects (model/object_sets.h) that have the same number of substeps in a frame, or one
// set whose substeps follow its State (substep_law.h).
//
// Groups share nothing within a frame, so each gets the bits that it gets alone, also if they run side by side. Where
// they take turns, the group whose substep ends first always goes next, so that a frame can be stopped where all groups
// have reached the same time (solver/step.cpp).
#pragma once

#include <memory>
#include <vector>

#include "collision/surfaces/surface_contact.h"
#include "model/model.h"
#include "model/object_sets.h"
#include "solver/systems/systems.h"

namespace pliant {

/// The data of a group that stages use. Its lists are subsets of the model's lists, in the same order.
struct SubstepGroup {
  int substeps = 1;         ///< substeps per frame, unless a fast collider requires more (solver/divide.h)
  bool by_state = false;    ///< true: `substeps` is a first guess, decided again in each quarter of a frame
  int least = 0;            ///< where they follow the State: what objects need that do not
  bool has_sheets = false;  ///< true: some object has triangles; false: ropes and loose particles
  bool hangs = false;       ///< true: all of its objects hang by tethers
  int least_hanging = 0;    ///< where they do: what the finest object needs by its resolution
  bool has_all = true;      ///< true: all objects; stages then use the model's lists, and all below is empty
  int number = 0;           ///< index among the groups
  /// Of all groups: each object's group, -1 where it was removed.
  std::shared_ptr<const std::vector<int>> group_of_object{};
  std::vector<int> objects{}, tiles{};  ///< ascending; indices of Model::objects and Model::tiles()
  std::vector<Phase> phases{};          ///< phases with the tasks of these objects only
  std::vector<Sweep> sweeps{};          ///< sweeps that these objects use
  std::vector<Task> lengths{};  ///< also where it has all: objects solved by chains, and each of their LengthRanges
  Systems systems{};            ///< also where it has all
  std::unique_ptr<PairModel> pair_model{};
  std::unique_ptr<SurfaceContact> pairs{};  ///< contact between surfaces; null if no two of the group can touch

  bool has(int object) const {
    if (has_all) return true;
    const auto o = static_cast<std::size_t>(object);
    return o < group_of_object->size() && (*group_of_object)[o] == number;
  }
};

/// The groups before objects were added, removed or edited, and the numbers of these objects, ascending.
struct GroupsBefore {
  std::vector<SubstepGroup>& groups;
  const std::vector<int>& changed;
};

/// Makes the groups of a model, ordered by substeps. `sets` has the first object of each one's set; null: those by
/// rules. Mesh colliders that touch no object belong to the first group, or to one of a single substep if that follows
/// its State. A group of the same unchanged objects as before takes the phases and lengths of that group, so that one
/// object that comes or goes costs little beside a thousand groups.
std::vector<SubstepGroup> make_substep_groups(const Model& model, const GroupsBefore* before = nullptr,
                                              const std::vector<int>* sets = nullptr);

/// For each object, the substeps of the group that make_substep_groups() puts it in, without making groups. Groups are
/// the same if these are equal.
std::vector<SetSubsteps> planned_substeps(const Model& model, const std::vector<int>* sets = nullptr);

/// Makes one group of all objects.
SubstepGroup group_of_all(const Model& model, int substeps, bool by_state = false, int least = 0);

/// A group and its number of substeps in a frame.
struct GroupFrame {
  const SubstepGroup* group = nullptr;
  int substeps = 1;       ///< where they follow the State the least number
  int most_substeps = 0;  ///< where they follow the State the largest number; 0: `substeps` is fixed
  int least_hanging = 0;  ///< the least number where the group hangs; 0: it cannot
};

}  // namespace pliant
