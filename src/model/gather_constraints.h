// From the groups of an Object to one list of constraints for each type and law.
#pragma once

#include <vector>

#include "model/column.h"
#include "model/pool.h"
#include "pliant/scene.h"

namespace pliant {

/// Constraints of one type and law, not yet scheduled, in the object's own numbering. Its numbers stand in the Object as long as
/// they are as given there: a large cloth is then not held twice.
struct ConstraintList {
  int type = 0;
  Law law = Law::compliant;
  int size = 0, fields = 0, components = 1;
  bool in_lanes = true;
  bool chained = false;  ///< solved along paths, not one by one
  Column<int> stencils;  ///< size x constraints; frame f of the object is number particles + f
  Column<float> rest;    ///< fields x constraints
  Column<float> response;
  Column<float> damping;
  Ordinals origin;  ///< number among the object's constraints of this type

  int count() const { return static_cast<int>(response.size()); }
  /// Without its constraints.
  ConstraintList empty() const;
};

/// All constraints of an object, its attachments last as distances of rest length zero to the particles after its own.
/// Types in the order of their numbers, laws within them. Rest data that a group leaves out is measured from the positions
/// in double. The lists refer to the object, which must outlive them.
std::vector<ConstraintList> gather_constraints(const Object& object, int passes);

}  // namespace pliant
