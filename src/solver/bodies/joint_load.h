// The force and torque that joints carry, and the joints that break because of them.
#pragma once

#include "model/compiled_joints.h"
#include "solver/workspace.h"

namespace pliant {

struct Substep;

/// What a joint does to its body b, in world axes.
struct ReactionLoad {
  Vec3f force{}, torque{};  ///< [N]; about the anchor [N m]
};

/// Positions of an object's particles and frames, and the multipliers of its last substep.
struct LoadView {
  const CompiledObject& object;
  const Record* positions;
  const Record* displacements;  ///< null: the positions are those of the substep's end
  const Record* orientations;
  const std::vector<AlignedVector<float>>& multipliers;  ///< by pool
  float h;                                               ///< length of the last substep [s]
};

ReactionLoad load_of(const LoadView& view, const CompiledJoint& joint);

/// Breaks the joints that carry more than they can, after the solve of a substep: of each rod only the one with the
/// greatest load over its limit. Names them in the Report.
void break_joints(Substep& s);

/// Marks joints of an object as broken, so that their constraints are left out. `joints` are indices in ascending
/// order.
void set_broken(const CompiledObject& object, const std::vector<int>& joints, ObjectJoints& into);

}  // namespace pliant
