// The joints of an object's rigid bodies that form trees, solved directly in each pass over the stencils (JointTree).
//
// C is that of the present positions, its gradients are those of the substep's start, which keeps energy (SHAKE; Ryckaert,
// Ciccotti, Berendsen 1977). Where joints pull so hard that a body would oscillate faster than substeps can follow, gradients
// are those of the present, and the geometric stiffness of the joint forces is added to the body's inertia (Tournier, Nesme,
// Gilles, Faure 2015). Limits, motors, and joints that close loops remain with the stencil driver.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "solver/bodies/joint_tree.h"

namespace pliant {

struct CompiledObject;
struct Substep;

/// The joints of one object that are solved directly, and scratch data for them.
struct JointForest {
  /// A constraint, and its slots: point and frame of a, then of b. Indices of frames count from the object's first one.
  struct Joint {
    int pool = 0;
    std::int64_t batch = 0;
    int lane = 0;
    std::array<std::int32_t, 4> slots{};
  };
  struct Body {
    std::int32_t point = 0, frame = 0;
  };

  std::vector<Joint> joints;  ///< in the order of the schedule
  std::vector<JointEnds> ends;
  std::vector<Body> bodies;
  std::optional<JointTree> tree;
  std::vector<std::vector<char>> is_skipped;  ///< [pool][16 batch + lane] 1: the stencil driver leaves the constraint out
  std::vector<const char*> skipped;           ///< pointers to the same; null: none of the pool. Empty: none at all

  std::vector<BodyMass> masses;
  std::vector<JointRows> rows;
  std::vector<BodyCorrection> corrections;
  std::vector<std::array<float, most_joint_rows>> multipliers;
  std::vector<std::array<float, 6>> stiffness;  ///< [body] geometric stiffness times h^2 [kg m^2]
  std::vector<char> in_tree;                    ///< [joint]
};

/// The joints of an object in a World: those that are broken, and the trees of the others.
struct ObjectJoints {
  std::vector<int> broken;                   ///< indices in CompiledObject::joints, ascending
  std::vector<std::vector<char>> is_broken;  ///< [pool][16 batch + lane] 1: part of a broken joint; empty: none
  JointForest forest;
};

/// Finds the trees of an object. `is_broken` is by pool and lane as JointForest::is_skipped; empty: none is.
void prepare_joints(const CompiledObject& object, const std::vector<std::vector<char>>& is_broken, JointForest& forest);

/// Solves the trees of all objects that take part.
void solve_joint_trees(Substep& s, bool first_pass);

}  // namespace pliant
