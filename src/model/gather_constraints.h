// Collects an Object's groups into one list of constraints for each type and law.
#pragma once

#include <vector>

#include "model/column.h"
#include "model/pool.h"
#include "pliant/scene.h"

namespace pliant {

/// Unscheduled constraints of one type and law, in the user's order. Unchanged
/// arrays refer to the Object, so that a large cloth is not stored twice.
struct ConstraintList {
  int type = 0;
  Law law = Law::compliant;
  int size = 0, fields = 0, components = 1;
  bool in_lanes = true;
  bool chained = false;  ///< solved along paths
  Column<int> stencils;  ///< size x constraints; frame f of the object has index particles + f
  Column<float> rest;    ///< fields x constraints
  Column<float> response;
  Column<float> damping;
  Ordinals origin;  ///< index among the object's constraints of this type

  int count() const { return static_cast<int>(response.size()); }
  /// A copy without constraints.
  ConstraintList empty() const;
};

/// All constraints of an object, ordered by type and law; attachments are last, as
/// distances of rest length zero to extra particles. Missing rest data are measured from
/// the positions in double. The lists refer to the object, which must outlive them.
std::vector<ConstraintList> gather_constraints(const Object& object, int passes);
/// The same in less memory: arrays are moved out of the object.
std::vector<ConstraintList> gather_constraints(Object&& object, int passes);

}  // namespace pliant
