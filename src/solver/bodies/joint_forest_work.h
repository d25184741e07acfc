// What the solution of an object's joint trees works with, and its parts.
#pragma once

#include "constraints/registry.h"
#include "solver/bodies/joint_forest.h"
#include "solver/substep.h"
#include "solver/visit.h"

namespace pliant {

/// Above this ratio of |joint force h^2| |arm| to a body's inertia, joints turn the body faster than substeps can
/// follow: it is the square of the angle by which the oscillation advances in a substep.
constexpr float largest_advance = 0.25f;

/// Contact moves one body of a tree at a time, so a joint is open by what an impact gives it in a substep, and a solve
/// is linear. Gaps above this share of a joint's arms are closed.
constexpr float closed_share = 2e-5f;
/// Each round leaves a gap of the order of the square of the last one over the length of a body.
constexpr int most_closing_rounds = 3;

/// The arrays of an object, and one constraint at a time.
struct JointWork {
  const CompiledObject& object;
  SweepArguments points;
  FrameArguments frames;
  JointForest& forest;
  int number = 0;  ///< of the object
  StencilArrays<float> arrays{};
  float bounds[3 * most_components] = {};  ///< of each row: low, high, speed
};

/// Forests that are in bundles of rods.
enum class Bundled { left_out, included };

/// Calls a function for the forests of each object that takes part.
void for_trees(Substep& s, bool first_pass, Bundled bundled, FunctionRef<void(JointWork&)> body);

/// Where a constraint of a joint is stored.
ConstraintPlace place_of(const JointWork& work, const JointForest::Part& part);

/// The multipliers of a constraint, sixteen apart; null if none are stored.
float* multipliers_of(const JointWork& work, const ConstraintPlace& at);

/// Sets masses and inertias of all bodies, by their present orientations.
void fill_masses(JointWork& work);

/// Sets the slots of a joint: its points' displacements are those of one list, its frames' orientations of another.
/// Points are relative to the first.
void load_slots(JointWork& work, const JointForest::Joint& joint, const Record* displacements,
                const Record* orientations);

/// Evaluates a constraint in the slots.
void evaluate(JointWork& work, const ConstraintDefinition& type);

/// Sets the rows of all joints of trees: C at present, gradients at the substep's start or at present.
void fill_rows(JointWork& work, bool start_gradients);

/// True if the gap of a rigid joint is larger than this share of the arms to its anchors, at most of 1 m; of angles
/// [rad]. Also if a joint with compliance is off by a thousandth of its arms.
bool is_open(JointWork& work, float share);

/// Solves, with masses and rows, until no row with bounds changes its state.
void solve_within_bounds(JointForest& forest);

}  // namespace pliant
