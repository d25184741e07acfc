#include "solver/bodies/joint_tree.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace pliant {

namespace {

constexpr int body_unknowns = 6;
/// Between two joints with the ground a joint may find that one side cannot move along some direction at all, and has no pivot
/// there before the other side is known. Joints get this share of their inverse mass as compliance in such trees.
constexpr float softness = 1e-4f;

/// The inverse mass that one body gives a row, with the mean of its inertia.
float inverse_mass(const std::array<Vec3f, 2>& gradient, const BodyMass& body) {
  const float inertia = (body.inertia[0] + body.inertia[1] + body.inertia[2]) / 3;
  return length_squared(gradient[0]) / body.mass + length_squared(gradient[1]) / inertia;
}

std::array<float, 6> six(const std::array<Vec3f, 2>& g) { return {g[0].x, g[0].y, g[0].z, g[1].x, g[1].y, g[1].z}; }

void set_inertia(const BodyMass& body, TreeBlock<float>& block) {
  block.size = body_unknowns;
  for (std::size_t i = 0; i < body_unknowns; ++i) block.diagonal[i] = {};
  for (std::size_t i = 0; i < 3; ++i) block.diagonal[i][i] = body.mass;
  const auto& i = body.inertia;
  block.diagonal[3][3] = i[0];
  block.diagonal[4][4] = i[1];
  block.diagonal[5][5] = i[2];
  block.diagonal[5][4] = block.diagonal[4][5] = i[3];
  block.diagonal[5][3] = block.diagonal[3][5] = i[4];
  block.diagonal[4][3] = block.diagonal[3][4] = i[5];
}

/// The root of a body's tree, with paths halved on the way.
int root_of(std::vector<int>& above, int body) {
  while (above[static_cast<std::size_t>(body)] != body) {
    int& next = above[static_cast<std::size_t>(body)];
    next = above[static_cast<std::size_t>(next)];
    body = next;
  }
  return body;
}

}  // namespace

JointTree::JointTree(int bodies, const std::vector<JointEnds>& joints) : ends_(joints) {
  const auto count = static_cast<std::size_t>(bodies);
  std::vector<int> above(count);
  for (int i = 0; i < bodies; ++i) above[static_cast<std::size_t>(i)] = i;
  std::vector<std::vector<int>> joints_of(count);
  ground_.assign(count, -1);
  ground_is_a_.assign(count, 0);
  for (int j = 0; j < static_cast<int>(joints.size()); ++j) {
    const auto [a, b] = joints[static_cast<std::size_t>(j)];
    if ((a < 0) != (b < 0)) {
      const auto body = static_cast<std::size_t>(std::max(a, b));
      if (ground_[body] >= 0) loose_.push_back(j);
      if (ground_[body] >= 0) continue;
      ground_[body] = j;
      ground_is_a_[body] = static_cast<char>(a < 0);
      continue;
    }
    if (a < 0 || root_of(above, a) == root_of(above, b)) {
      loose_.push_back(j);
      continue;
    }
    above[static_cast<std::size_t>(root_of(above, a))] = root_of(above, b);
    joints_of[static_cast<std::size_t>(a)].push_back(j);
    joints_of[static_cast<std::size_t>(b)].push_back(j);
  }
  std::vector<int> grounds(count, 0);
  for (int i = 0; i < bodies; ++i)
    if (ground_[static_cast<std::size_t>(i)] >= 0) ++grounds[static_cast<std::size_t>(root_of(above, i))];
  held_.assign(count, 0);
  for (int i = 0; i < bodies; ++i)
    held_[static_cast<std::size_t>(i)] = static_cast<char>(grounds[static_cast<std::size_t>(root_of(above, i))] > 1);
  order(joints, joints_of);
  blocks_.resize(nodes_.size());
}

/// From each tree's root outward; reversed, children come before parents. The root is the first body that has a joint with the
/// ground, else the first body: seen from a body that the ground holds, a joint may have no inverse mass along some direction.
void JointTree::order(const std::vector<JointEnds>& joints, const std::vector<std::vector<int>>& joints_of) {
  std::vector<char> seen(joints_of.size(), 0);
  for (std::size_t root = 0; root < joints_of.size(); ++root)
    if (seen[root] == 0 && ground_[root] >= 0) order_tree(static_cast<int>(root), joints, joints_of, seen);
  for (std::size_t root = 0; root < joints_of.size(); ++root)
    if (seen[root] == 0 && !joints_of[root].empty()) order_tree(static_cast<int>(root), joints, joints_of, seen);
  std::reverse(nodes_.begin(), nodes_.end());
  const auto count = static_cast<int>(nodes_.size());
  for (Node& node : nodes_)
    if (node.parent >= 0) node.parent = count - 1 - node.parent;
}

void JointTree::order_tree(int root, const std::vector<JointEnds>& joints, const std::vector<std::vector<int>>& joints_of,
                           std::vector<char>& seen) {
  const auto add_body = [&](int body, int parent, bool at_b) {
    seen[static_cast<std::size_t>(body)] = 1;
    nodes_.push_back({true, body, parent, at_b, ground_[static_cast<std::size_t>(body)], false});
  };
  std::size_t next = nodes_.size();
  add_body(root, -1, false);
  for (; next < nodes_.size(); ++next) {
    const Node node = nodes_[next];
    const auto here = static_cast<int>(next);
    if (!node.is_body) {
      const auto [a, b] = joints[static_cast<std::size_t>(node.index)];
      add_body(node.at_b ? a : b, here, !node.at_b);  // the parent is at the other end
      continue;
    }
    for (const int j : joints_of[static_cast<std::size_t>(node.index)])
      if (node.parent < 0 || nodes_[static_cast<std::size_t>(node.parent)].index != j)
        nodes_.push_back({false, j, here, joints[static_cast<std::size_t>(j)].b == node.index, -1,
                          held_[static_cast<std::size_t>(node.index)] != 0});
  }
}

/// The diagonal block and the right-hand side of a node. A joint with the ground comes after its body's unknowns, since it has
/// no pivot of its own.
void JointTree::fill(std::size_t n, const std::vector<BodyMass>& masses, const std::vector<JointRows>& joints) {
  const Node& node = nodes_[n];
  TreeBlock<float>& block = blocks_[n];
  block.x = {};
  std::size_t first = 0;
  if (node.is_body) {
    set_inertia(masses[static_cast<std::size_t>(node.index)], block);
    if (node.ground < 0) return;
    first = body_unknowns;
  }
  const JointRows& rows = joints[static_cast<std::size_t>(node.is_body ? node.ground : node.index)];
  block.size = static_cast<int>(first) + rows.rows;
  for (std::size_t i = first; i < static_cast<std::size_t>(block.size); ++i) block.diagonal[i] = {};
  for (std::size_t r = 0; r < static_cast<std::size_t>(rows.rows); ++r) {
    block.diagonal[first + r][first + r] = -rows.compliance[r];
    block.x[first + r] = -rows.value[r];
    if (!node.is_body) {
      const auto [a, b] = ends_[static_cast<std::size_t>(node.index)];
      if (node.is_held)
        block.diagonal[r][r] -= softness * (inverse_mass(rows.of_a[r], masses[static_cast<std::size_t>(a)]) +
                                            inverse_mass(rows.of_b[r], masses[static_cast<std::size_t>(b)]));
      continue;
    }
    const std::array<float, 6> g =
        six(ground_is_a_[static_cast<std::size_t>(node.index)] != 0 ? rows.of_b[r] : rows.of_a[r]);
    for (std::size_t c = 0; c < body_unknowns; ++c) block.diagonal[first + r][c] = g[c];
  }
}

void JointTree::couple(std::size_t n, const std::vector<JointRows>& joints) {
  const Node& node = nodes_[n];
  TreeBlock<float>& block = blocks_[n];
  block.parent = node.parent;
  if (node.parent < 0) return;
  const Node& parent = nodes_[static_cast<std::size_t>(node.parent)];
  const Node& joint = node.is_body ? parent : node;
  const JointRows& rows = joints[static_cast<std::size_t>(joint.index)];
  for (std::size_t i = 0; i < static_cast<std::size_t>(block.size); ++i) block.to_parent[i] = {};
  for (std::size_t r = 0; r < static_cast<std::size_t>(rows.rows); ++r) {
    const std::array<float, 6> g = six(node.at_b ? rows.of_b[r] : rows.of_a[r]);
    for (std::size_t c = 0; c < body_unknowns; ++c) (node.is_body ? block.to_parent[c][r] : block.to_parent[r][c]) = g[c];
  }
}

void JointTree::solve(const std::vector<BodyMass>& masses, const std::vector<JointRows>& joints,
                      std::vector<BodyCorrection>& corrections,
                      std::vector<std::array<float, most_joint_rows>>* multipliers) {
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    fill(n, masses, joints);
    couple(n, joints);
  }
  solve_block_tree(blocks_);
  corrections.assign(masses.size(), {});
  if (multipliers != nullptr) multipliers->assign(joints.size(), {});
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const Node& node = nodes_[n];
    const auto& x = blocks_[n].x;
    const int joint = node.is_body ? node.ground : node.index;
    const std::size_t first = node.is_body ? body_unknowns : 0;
    if (node.is_body) corrections[static_cast<std::size_t>(node.index)] = {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}};
    if (multipliers == nullptr || joint < 0) continue;
    for (std::size_t r = 0; r < most_joint_rows; ++r) (*multipliers)[static_cast<std::size_t>(joint)][r] = x[first + r];
  }
}

}  // namespace pliant
