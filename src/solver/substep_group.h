// Objects that are advanced in the same substeps of a frame: all sets (model/object_sets.h) of one number of substeps.
//
// Groups share nothing in a frame, so each gets the bits that it gets alone. Their substeps take turns in the order in which
// they end, so that a frame can be stopped where all groups have reached the same time (solver/step.cpp).
#pragma once

#include <memory>
#include <vector>

#include "collision/surfaces/surface_contact.h"
#include "model/model.h"

namespace pliant {

/// The data of a group that stages visit. Its lists are subsets of the model's, in the same order.
struct SubstepGroup {
  int substeps = 1;                     ///< per frame, unless a fast collider demands more (solver/divide.h)
  bool has_all = true;                  ///< every object: the model's own lists are used, and all below is empty
  std::vector<char> has{};              ///< true for each object of the group
  std::vector<int> objects{}, tiles{};  ///< ascending; indices of Model::objects and Model::tiles()
  std::vector<Phase> phases{};          ///< phases that contain only the tasks of its objects
  std::vector<Sweep> sweeps{};          ///< sweeps of its objects
  std::unique_ptr<PairModel> pair_model{};
  std::unique_ptr<SurfaceContact> pairs{};  ///< null if no surface of the group can touch another
};

/// The groups of a model's objects, by ascending substeps. Mesh colliders that touch nobody are of the first.
std::vector<SubstepGroup> make_substep_groups(const Model& model);

/// One group of all objects.
SubstepGroup group_of_all(int substeps);

/// The number of substeps of a group in a frame.
struct GroupFrame {
  const SubstepGroup* group = nullptr;
  int substeps = 1;
};

}  // namespace pliant
