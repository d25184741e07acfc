// A substep group: all sets of objects (model/object_sets.h) that have the same number of substeps in a frame.
//
// Groups share nothing within a frame, so each gets the bits that it gets alone. The group whose substep ends first
// always goes next, so that a frame can be stopped where all groups have reached the same time (solver/step.cpp).
#pragma once

#include <memory>
#include <vector>

#include "collision/surfaces/surface_contact.h"
#include "model/model.h"

namespace pliant {

/// The data of a group that stages use. Its lists are subsets of the model's lists, in the same order.
struct SubstepGroup {
  int substeps = 1;                     ///< substeps per frame, unless a fast collider requires more (solver/divide.h)
  bool has_all = true;                  ///< true: all objects; stages then use the model's lists, and all below is empty
  std::vector<char> has{};              ///< for each object of the model, 1 if the group has it
  std::vector<int> objects{}, tiles{};  ///< ascending; indices of Model::objects and Model::tiles()
  std::vector<Phase> phases{};          ///< phases with the tasks of these objects only
  std::vector<Sweep> sweeps{};          ///< sweeps that these objects use
  std::unique_ptr<PairModel> pair_model{};
  std::unique_ptr<SurfaceContact> pairs{};  ///< contact between surfaces; null if no two of the group can touch
};

/// Makes the groups of a model, ordered by substeps. Mesh colliders that touch no object belong to the first group.
std::vector<SubstepGroup> make_substep_groups(const Model& model);

/// Makes one group of all objects.
SubstepGroup group_of_all(int substeps);

/// A group and its number of substeps in a frame.
struct GroupFrame {
  const SubstepGroup* group = nullptr;
  int substeps = 1;
};

}  // namespace pliant
