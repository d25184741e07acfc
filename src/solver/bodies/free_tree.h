// Keeps the angular momentum of trees of joints that hold on to nothing.
//
// A substep conserves angular momentum if sum_i x_i x m_i d_i + I_i theta_i = 0, where x are the positions at its
// start, and d and theta the corrections (solver/momentum.h). Gradients of the substep's start have no torque about
// these. Those of the present, and the stiffness by which pulls hold bodies back, do: a rod that spins freely would
// lose a share of the order of the square of the angle that it turns in a substep, in each substep. So what a solve
// with these has done to a free tree is followed by a rotation of the tree as a whole that gives the angular momentum
// back. Joints stay as they are.
#pragma once

#include <vector>

#include "solver/bodies/joint_forest.h"
#include "solver/substep.h"

namespace pliant {

/// True if no joint connects a tree with what does not move, or with a body whose centre is held.
bool is_free(const JointForest& forest);

class FreeTree {
 public:
  /// Notes the angular momentum of the corrections before a solve. The bodies are those of a tree, in any order: the
  /// bits are the same. Other arguments are the arrays of its object.
  FreeTree(std::vector<JointForest::Body> bodies, const SweepArguments& points, const FrameArguments& frames);
  /// Rotates the tree so that this is what it was.
  void restore() const;

 private:
  Vec3d momentum() const;
  Vec3d centre() const;
  /// The position at the substep's start, and at present, relative to that of the first body at the start.
  Vec3d start_of(const JointForest::Body& body) const;
  Vec3d place_of(const JointForest::Body& body) const;
  double mass_of(const JointForest::Body& body) const;

  std::vector<JointForest::Body> bodies_;  ///< in the order of their particles
  SweepArguments points_;
  FrameArguments frames_;
  std::vector<Symmetric> inertias_;  ///< of the bodies in world axes [kg m^2]
  Vec3d before_{};
};

}  // namespace pliant
