// Joints between bodies solved directly, all at once, where they form trees. Joints that close loops are left to
// sweeps.
#pragma once

#include <array>
#include <vector>

#include "math/block_tree.h"
#include "math/vector.h"
#include "solver/bodies/joint_tree_formulas.h"

namespace pliant {

/// Two bodies and the joint between them; -1: the ground.
struct JointEnds {
  int a = -1, b = -1;
};

constexpr int most_joint_rows = 10;  ///< of a joint with its limits and motors

/// One joint's rows at the start of a solve: gradients for displacement and rotation of both bodies, and the value that
/// the corrections shall take away.
struct JointRows {
  int rows = 0;
  std::array<std::array<Vec3f, 2>, most_joint_rows> of_a{}, of_b{};  ///< [row], for displacement and rotation
  std::array<float, most_joint_rows> value{};
  std::array<float, most_joint_rows> compliance{};  ///< alpha / h^2 of each row
};

using Symmetric = std::array<float, 6>;  ///< xx, yy, zz, yz, zx, xy

/// The inverse of a positive definite matrix, by cofactors.
Symmetric inverse_of(const Symmetric& m);

/// What a body resists with: its mass, and its inertia in world axes.
struct BodyMass {
  float mass = 1;       ///< [kg]
  Symmetric inertia{};  ///< [kg m^2]
  Symmetric inverse{};  ///< of the inertia [1 / (kg m^2)]
};

/// Displacement and rotation of a body by which joints are satisfied.
struct BodyCorrection {
  Vec3f displacement{}, rotation{};
};

class JointTree {
 public:
  /// A joint, or a body with three joints or more; its joint with the ground is part of its block. Other bodies are
  /// eliminated beforehand, since the inverse of their mass is known. That couples their two joints.
  struct Node {
    bool is_body = false;
    int index = 0;     ///< of the body or joint
    int parent = -1;   ///< node; the order is that of the blocks
    int through = -1;  ///< the body that is shared with the parent, or the body itself; -1: a root
  };

  /// Joints that close a loop are loose; so are further joints of a body that has one with the ground, and joints of a
  /// body with itself. `centre_is_held` by body: its mass is so large that it only rotates; empty: none.
  JointTree(int bodies, const std::vector<JointEnds>& joints, const std::vector<char>& centre_is_held = {});

  /// Joints that are left out, in ascending order.
  const std::vector<int>& loose() const { return loose_; }

  /// The blocks, children before their parents.
  const std::vector<Node>& nodes() const { return nodes_; }
  /// True if no block is a body's, and no tree has two joints with the ground.
  bool is_plain() const;

  /// Solves M d + J^T lambda = 0, J d - compliance lambda = -value for all joints that are not loose. `corrections` are
  /// by body, zero where none acts; `multipliers` by joint, if not null.
  void solve(const std::vector<BodyMass>& masses, const std::vector<JointRows>& joints,
             std::vector<BodyCorrection>& corrections,
             std::vector<std::array<float, most_joint_rows>>* multipliers = nullptr);

 private:
  void find_loose(int bodies, const std::vector<char>& centre_is_held);
  void order();
  void order_tree(int root);
  void add_joints_of(int body, int parent, int but);
  bool is_eliminated(int body) const { return joints_of_[static_cast<std::size_t>(body)].size() <= 2; }
  void shape_blocks(const std::vector<JointRows>& joints);
  void fill_joint(std::size_t node, const std::vector<BodyMass>& masses, const std::vector<JointRows>& joints);
  void fill_body(std::size_t node, const std::vector<BodyMass>& masses, const std::vector<JointRows>& joints);
  void move_eliminated(const std::vector<BodyMass>& masses, const std::vector<JointRows>& joints);

  std::vector<JointEnds> ends_;
  std::vector<Node> nodes_;
  std::vector<std::vector<int>> joints_of_;  ///< [body] that are not loose
  std::vector<int> ground_;                  ///< joint of each body with the ground; -1: none
  std::vector<char> held_;                   ///< [body] 1: its tree has two joints with the ground or more
  std::vector<int> loose_;
  BlockTree<double>* blocks_ = nullptr;  ///< of the thread that solves: thousands of trees would not fit a cache
  std::vector<joint_tree_formulas::Gradient<double>> moves_;  ///< [body] displacement and rotation; scratch
};

}  // namespace pliant
