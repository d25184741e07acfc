// Joints between bodies solved directly, all at once, where they form trees. Joints that close loops are left to sweeps.
#pragma once

#include <array>
#include <vector>

#include "math/block_tree.h"
#include "math/vector.h"

namespace pliant {

/// Two bodies and the joint between them; -1: the ground.
struct JointEnds {
  int a = -1, b = -1;
};

constexpr int most_joint_rows = 10;  ///< of a joint with its limits and motors

/// One joint's rows at the start of a solve: gradients for displacement and rotation of both bodies, and the value that the
/// corrections shall take away.
struct JointRows {
  int rows = 0;
  std::array<std::array<Vec3f, 2>, most_joint_rows> of_a{}, of_b{};  ///< [row], for displacement and rotation
  std::array<float, most_joint_rows> value{};
  std::array<float, most_joint_rows> compliance{};  ///< alpha / h^2 of each row
};

/// What a body resists with: its mass, and its inertia in world axes.
struct BodyMass {
  float mass = 1;                  ///< [kg]
  std::array<float, 6> inertia{};  ///< xx, yy, zz, yz, zx, xy [kg m^2]
};

/// Displacement and rotation of a body by which joints are satisfied.
struct BodyCorrection {
  Vec3f displacement{}, rotation{};
};

class JointTree {
 public:
  /// Joints that close a loop are loose; so are further joints of a body that has one with the ground, and joints of a body with
  /// itself.
  JointTree(int bodies, const std::vector<JointEnds>& joints);

  /// Joints that are left out, in ascending order.
  const std::vector<int>& loose() const { return loose_; }

  /// Solves M d + J^T lambda = 0, J d - compliance lambda = -value for all joints that are not loose. `corrections` are by body,
  /// zero where none acts; `multipliers` by joint, if not null.
  void solve(const std::vector<BodyMass>& masses, const std::vector<JointRows>& joints,
             std::vector<BodyCorrection>& corrections,
             std::vector<std::array<float, most_joint_rows>>* multipliers = nullptr);

 private:
  struct Node {
    bool is_body = false;
    int index = 0;         ///< of the body or joint
    int parent = -1;       ///< node; the order is that of the blocks
    bool at_b = false;     ///< of a joint: its parent is its body b; of a body: it is the parent joint's body b
    int ground = -1;       ///< of a body: its joint with the ground, which is part of its block
    bool is_held = false;  ///< of a joint: its tree has two joints with the ground or more
  };

  void order(const std::vector<JointEnds>& joints, const std::vector<std::vector<int>>& joints_of);
  void order_tree(int root, const std::vector<JointEnds>& joints, const std::vector<std::vector<int>>& joints_of,
                  std::vector<char>& seen);
  void fill(std::size_t node, const std::vector<BodyMass>& masses, const std::vector<JointRows>& joints);
  void couple(std::size_t node, const std::vector<JointRows>& joints);

  std::vector<JointEnds> ends_;
  std::vector<Node> nodes_;
  std::vector<int> ground_;        ///< joint of each body with the ground; -1: none
  std::vector<char> ground_is_a_;  ///< [body] 1: that joint has the ground as its body a
  std::vector<char> held_;         ///< [body] 1: its tree has two joints with the ground or more
  std::vector<int> loose_;
  std::vector<TreeBlock<float>> blocks_;
};

}  // namespace pliant
