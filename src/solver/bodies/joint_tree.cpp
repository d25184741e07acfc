#include "solver/bodies/joint_tree.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "math/scalar.h"
#include "solver/bodies/body_math.h"

namespace pliant {

namespace {

constexpr int body_unknowns = 6;
/// Between two joints with the ground a joint may find that one side cannot move along some direction at all, and has
/// no pivot there before the other side is known. Joints get this share of their inverse mass as compliance in such
/// trees.
constexpr double compliance_share = 1e-4;
/// A row with compliance of its own needs no more than this share, above least_pivot of the blocks.
constexpr double least_compliance = 2e-6;

using BodyInverseMass = joint_tree_formulas::InverseMass<double>;

/// In double: along a chain whose joints hold angles, the smallest eigenvalues of the system fall with the fourth power
/// of its length, below a float's rounding of the largest at a hundred links.
using RowGradient = joint_tree_formulas::Gradient<double>;

RowGradient gradient(const std::array<Vec3f, 2>& g) { return {convert<double>(g[0]), convert<double>(g[1])}; }

const std::array<std::array<Vec3f, 2>, most_joint_rows>& gradients_of(const JointRows& rows, const JointEnds& ends,
                                                                      int body) {
  return ends.b == body ? rows.of_b : rows.of_a;
}

/// The gradients of a joint's rows for one of its bodies. Each is needed for several products.
struct Gradients {
  std::array<RowGradient, most_joint_rows> of;

  Gradients(const JointRows& joint, const JointEnds& ends, int body) {
    const auto& g = gradients_of(joint, ends, body);
    for (int r = 0; r < joint.rows; ++r) of[at(r)] = gradient(g[at(r)]);
  }
  const RowGradient& operator[](int row) const { return of[at(row)]; }
};

/// What a body yields by, in double.
BodyInverseMass inverse_mass_of(const BodyMass& body) {
  BodyInverseMass of{};
  of.mass = 1 / static_cast<double>(body.mass);
  std::copy(body.inverse.begin(), body.inverse.end(), of.inertia);
  return of;
}

/// The inverse mass that one body gives a row, with the mean of its inertia.
double inverse_mass(const RowGradient& gradient, const BodyMass& body) {
  const auto inertia = static_cast<double>((body.inertia[0] + body.inertia[1] + body.inertia[2]) / 3);
  return length_squared(gradient.displacement) / static_cast<double>(body.mass) +
         length_squared(gradient.rotation) / inertia;
}

void set_row(const RowGradient& g, double* row) {
  const Vec3d &d = g.displacement, &r = g.rotation;
  const double six[body_unknowns] = {d.x, d.y, d.z, r.x, r.y, r.z};
  std::copy_n(six, body_unknowns, row);
}

void set_inertia(const BodyMass& body, double* m, int stride) {
  for (int i = 0; i < 3; ++i) m[i * stride + i] = static_cast<double>(body.mass);
  std::array<double, 6> inertia;
  std::copy(body.inertia.begin(), body.inertia.end(), inertia.begin());
  m[3 * stride + 3] = inertia[0];
  m[4 * stride + 4] = inertia[1];
  m[5 * stride + 5] = inertia[2];
  m[4 * stride + 5] = inertia[3];
  m[3 * stride + 5] = inertia[4];
  m[3 * stride + 4] = inertia[5];
}

/// The root of a body's tree, with paths halved on the way.
int root_of(std::vector<int>& above, int body) {
  while (above[at(body)] != body) {
    int& next = above[at(body)];
    next = above[at(next)];
    body = next;
  }
  return body;
}

/// A power of two whose product with a positive number is 1 to 2.
float inverse_power_of_two(float x) {
  const auto exponent = (bits_as<std::uint32_t>(x) >> 23) & 0xff;
  return bits_as<float>((254 - std::min(exponent, 253u)) << 23);
}

}  // namespace

Symmetric inverse_of(const Symmetric& given) {
  // Scaled by a power of two, which changes no bits, so that the products of a small body's moments do not vanish.
  const float scale = inverse_power_of_two(given[0] + given[1] + given[2]);
  Symmetric m = given;
  for (float& element : m) element = element * scale;
  const Vec3f r0{m[0], m[5], m[4]}, r1{m[5], m[1], m[3]}, r2{m[4], m[3], m[2]};
  const Vec3f c0 = cross(r1, r2), c1 = cross(r2, r0), c2 = cross(r0, r1);
  const float inverse = 1 / dot(r0, c0) * scale;
  return {c0.x * inverse, c1.y * inverse, c2.z * inverse, c1.z * inverse, c0.z * inverse, c0.y * inverse};
}

JointTree::JointTree(int bodies, const std::vector<JointEnds>& joints, const std::vector<char>& centre_is_held)
    : ends_(joints), joints_of_(static_cast<std::size_t>(bodies)) {
  find_loose(bodies, centre_is_held);
  order();
}

bool JointTree::is_plain() const {
  return std::none_of(nodes_.begin(), nodes_.end(), [](const Node& node) { return node.is_body; }) &&
         std::all_of(held_.begin(), held_.end(), [](char held) { return held == 0; });
}

void JointTree::find_loose(int bodies, const std::vector<char>& centre_is_held) {
  std::vector<int> above(at(bodies));
  for (int i = 0; i < bodies; ++i) above[at(i)] = i;
  ground_.assign(above.size(), -1);
  for (int j = 0; j < static_cast<int>(ends_.size()); ++j) {
    const auto [a, b] = ends_[at(j)];
    const int body = std::max(a, b);
    const bool is_ground = (a < 0) != (b < 0);
    if (is_ground ? ground_[at(body)] >= 0 : a < 0 || root_of(above, a) == root_of(above, b)) {
      loose_.push_back(j);
      continue;
    }
    if (is_ground)
      ground_[at(body)] = j;
    else
      above[at(root_of(above, a))] = root_of(above, b);
    for (const int end : {a, b})
      if (end >= 0) joints_of_[at(end)].push_back(j);
  }
  std::vector<int> grounds(above.size(), 0);
  for (int i = 0; i < bodies; ++i)
    if (ground_[at(i)] >= 0 || (!centre_is_held.empty() && centre_is_held[at(i)] != 0))
      ++grounds[at(root_of(above, i))];
  held_.assign(above.size(), 0);
  for (int i = 0; i < bodies; ++i) held_[at(i)] = static_cast<char>(grounds[at(root_of(above, i))] > 1);
}

/// From each tree's root outward; reversed, children come before parents. The root is at the first body that has a
/// joint with the ground, else at the first body: seen from a body that the ground holds, a joint may have no inverse
/// mass along some direction.
void JointTree::order() {
  std::vector<char> seen(joints_of_.size(), 0);
  for (const bool grounded : {true, false})
    for (std::size_t body = 0; body < joints_of_.size(); ++body) {
      if (seen[body] != 0 || joints_of_[body].empty() || (grounded && ground_[body] < 0)) continue;
      const std::size_t first = nodes_.size();
      order_tree(static_cast<int>(body));
      for (std::size_t n = first; n < nodes_.size(); ++n) {
        const auto [is_body, index, parent, through] = nodes_[n];
        for (const int end : {is_body ? index : ends_[at(index)].a, is_body ? index : ends_[at(index)].b})
          if (end >= 0) seen[at(end)] = 1;
      }
    }
  std::reverse(nodes_.begin(), nodes_.end());
  const auto count = static_cast<int>(nodes_.size());
  for (Node& node : nodes_)
    if (node.parent >= 0) node.parent = count - 1 - node.parent;
}

void JointTree::order_tree(int root) {
  std::size_t next = nodes_.size();
  if (!is_eliminated(root))
    nodes_.push_back({true, root, -1, -1});
  else
    nodes_.push_back({false, ground_[at(root)] >= 0 ? ground_[at(root)] : joints_of_[at(root)].front(), -1, -1});
  for (; next < nodes_.size(); ++next) {
    const Node node = nodes_[next];
    const auto here = static_cast<int>(next);
    if (node.is_body) {
      add_joints_of(node.index, here, node.parent < 0 ? -1 : nodes_[at(node.parent)].index);
      continue;
    }
    const auto [a, b] = ends_[at(node.index)];
    for (const int end : {a, b}) {
      if (end < 0 || end == node.through) continue;
      if (is_eliminated(end))
        add_joints_of(end, here, node.index);
      else
        nodes_.push_back({true, end, here, end});
    }
  }
}

/// Adds the joints of a body but one as children of a node.
void JointTree::add_joints_of(int body, int parent, int but) {
  for (const int j : joints_of_[at(body)])
    if (j != but && (is_eliminated(body) || j != ground_[at(body)])) nodes_.push_back({false, j, parent, body});
}

/// Sets the sizes of all blocks, where they have changed.
void JointTree::shape_blocks(const std::vector<JointRows>& joints) {
  std::vector<BlockTree<double>::Block> blocks;
  blocks.reserve(nodes_.size());
  for (const Node& node : nodes_) {
    const int joint = node.is_body ? ground_[at(node.index)] : node.index;
    blocks.push_back({node.parent, (node.is_body ? body_unknowns : 0) + (joint < 0 ? 0 : joints[at(joint)].rows)});
  }
  if (blocks == blocks_->blocks())
    blocks_->set_to_zero();
  else
    blocks_->reset(std::move(blocks));
}

/// The block of a joint: -J M^-1 J^T of its eliminated bodies, less compliance. If the body on the way to the parent is
/// eliminated, it couples the two joints; else the parent is that body.
void JointTree::fill_joint(std::size_t n, const std::vector<BodyMass>& masses, const std::vector<JointRows>& joints) {
  const Node& node = nodes_[n];
  const JointEnds& ends = ends_[at(node.index)];
  const JointRows& rows = joints[at(node.index)];
  const int stride = blocks_->stride();
  double *const m = blocks_->diagonal(n), *const up = blocks_->to_parent(n);
  for (int r = 0; r < rows.rows; ++r) {
    m[r * stride + r] = static_cast<double>(-rows.compliance[at(r)]);
    blocks_->x(n)[r] = static_cast<double>(-rows.value[at(r)]);
  }
  for (const int body : {ends.a, ends.b}) {
    if (body < 0) continue;
    const BodyMass& mass = masses[at(body)];
    const BodyInverseMass inverse = inverse_mass_of(mass);
    const Gradients g(rows, ends, body);
    const bool is_held = ends.a >= 0 && ends.b >= 0 && held_[at(body)] != 0;
    for (int r = 0; is_held && r < rows.rows; ++r) {
      const auto own = static_cast<double>(rows.compliance[at(r)]);
      if (own == 0)
        m[r * stride + r] -= compliance_share * inverse_mass(g[r], mass);
      else
        m[r * stride + r] -= std::max(0., least_compliance * product(accelerated(g[r], inverse), g[r]) - own);
    }
    if (!is_eliminated(body)) {
      for (int r = 0; body == node.through && r < rows.rows; ++r) set_row(g[r], up + r * stride);
      continue;
    }
    std::array<RowGradient, most_joint_rows> moved;
    subtract_body(g.of.data(), inverse, rows.rows, m, stride, moved.data());
    if (body != node.through) continue;
    const int parent = nodes_[at(node.parent)].index;
    const JointRows& above = joints[at(parent)];
    couple(moved.data(), rows.rows, Gradients(above, ends_[at(parent)], body).of.data(), above.rows, up, stride);
  }
}

/// The block of a body, followed by its joint with the ground, which has no pivot of its own.
void JointTree::fill_body(std::size_t n, const std::vector<BodyMass>& masses, const std::vector<JointRows>& joints) {
  const Node& node = nodes_[n];
  const int stride = blocks_->stride(), ground = ground_[at(node.index)];
  double *const m = blocks_->diagonal(n), *const up = blocks_->to_parent(n);
  set_inertia(masses[at(node.index)], m, stride);
  if (node.parent >= 0) {
    const int joint = nodes_[at(node.parent)].index;
    const JointRows& rows = joints[at(joint)];
    const auto& g = gradients_of(rows, ends_[at(joint)], node.index);
    for (int r = 0; r < rows.rows; ++r) {
      double row[body_unknowns];
      set_row(gradient(g[at(r)]), row);
      for (int c = 0; c < body_unknowns; ++c) up[c * stride + r] = row[c];
    }
  }
  if (ground < 0) return;
  const JointRows& rows = joints[at(ground)];
  const auto& g = gradients_of(rows, ends_[at(ground)], node.index);
  for (int r = 0; r < rows.rows; ++r) {
    double row[body_unknowns];
    set_row(gradient(g[at(r)]), row);
    for (int c = 0; c < body_unknowns; ++c) m[c * stride + body_unknowns + r] = row[c];
    m[(body_unknowns + r) * stride + body_unknowns + r] = static_cast<double>(-rows.compliance[at(r)]);
    blocks_->x(n)[body_unknowns + r] = static_cast<double>(-rows.value[at(r)]);
  }
}

/// The bodies that are no blocks: d = -M^-1 J^T lambda of their joints.
void JointTree::move_eliminated(const std::vector<BodyMass>& masses, const std::vector<JointRows>& joints) {
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    if (nodes_[n].is_body) continue;
    const JointEnds& ends = ends_[at(nodes_[n].index)];
    const JointRows& rows = joints[at(nodes_[n].index)];
    for (const int body : {ends.a, ends.b}) {
      if (body < 0 || !is_eliminated(body)) continue;
      const Gradients g(rows, ends, body);
      move_body(g.of.data(), blocks_->x(n), rows.rows, inverse_mass_of(masses[at(body)]), moves_[at(body)]);
    }
  }
}

void JointTree::solve(const std::vector<BodyMass>& masses, const std::vector<JointRows>& joints,
                      std::vector<BodyCorrection>& corrections,
                      std::vector<std::array<float, most_joint_rows>>* multipliers) {
  thread_local BlockTree<double> of_thread;
  blocks_ = &of_thread;
  shape_blocks(joints);
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    if (nodes_[n].is_body)
      fill_body(n, masses, joints);
    else
      fill_joint(n, masses, joints);
  }
  blocks_->solve();
  if (multipliers != nullptr) multipliers->assign(joints.size(), {});
  moves_.assign(masses.size(), {});
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const Node& node = nodes_[n];
    const double* x = blocks_->x(n);
    if (node.is_body) moves_[at(node.index)] = {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}};
    const int joint = node.is_body ? ground_[at(node.index)] : node.index;
    if (multipliers == nullptr || joint < 0) continue;
    const double* const first = x + (node.is_body ? body_unknowns : 0);
    for (int r = 0; r < joints[at(joint)].rows; ++r) (*multipliers)[at(joint)][at(r)] = static_cast<float>(first[r]);
  }
  move_eliminated(masses, joints);
  corrections.clear();
  for (const RowGradient& move : moves_)
    corrections.push_back({convert<float>(move.displacement), convert<float>(move.rotation)});
}

}  // namespace pliant
