// Collects an Object's constraint groups into one list for each type and law.
#pragma once

#include <vector>

#include "model/column.h"
#include "model/pool.h"
#include "pliant/scene.h"

namespace pliant {

/// The constraints of one type and law before they are scheduled, in the user's order. While arrays are unchanged, the
/// list refers to those of the Object, so that a large cloth is not stored twice.
struct ConstraintList {
  int type = 0;
  Law law = Law::compliant;
  int size = 0, fields = 0, components = 1;
  bool in_lanes = true;
  bool changes = false;  ///< true: rest data of some of them may change (model/changing_rest.h)
  bool chained = false;  ///< true: solved along paths by the sweep `chains`
  Column<int> stencils;  ///< indices, `size` per constraint; frame f of the object has index particles + f
  Column<float> rest;    ///< rest data, `fields` per constraint
  Column<float> response;
  Column<float> damping;
  Ordinals origin;  ///< index of each constraint among the object's constraints of its type

  int count() const { return static_cast<int>(response.size()); }
  /// A copy without constraints.
  ConstraintList empty() const;
};

/// Lists all constraints of an object, ordered by type and law. Attachments come last, as distances of rest length zero
/// to additional particles. Missing rest data are computed from the initial positions in double precision. The lists
/// refer to the object, which must outlive them.
std::vector<ConstraintList> gather_constraints(const Object& object, int passes);
/// Lists all constraints of an object with less memory: arrays are moved out of the object.
std::vector<ConstraintList> gather_constraints(Object&& object, int passes);

}  // namespace pliant
