// Finds the trees of joints of an object.
#include "solver/bodies/joint_forest.h"

#include <algorithm>
#include <map>
#include <utility>

#include "constraints/registry.h"
#include "core/islands.h"
#include "solver/bodies/rod_bundle.h"
#include "solver/visit.h"

namespace pliant {

namespace {

/// What a body can do: nothing, move and rotate, rotate about a held centre. Those that are held about some axes alone
/// are left to the stencil driver.
enum class Mobility { fixed, free, rotating, partial };

Mobility mobility(const CompiledObject& object, std::int32_t point, std::int32_t frame) {
  const Record& inverse = object.frames.inverse_inertias[static_cast<std::size_t>(frame)];
  const float w = object.positions[static_cast<std::size_t>(point)].w;
  if (inverse.x > 0 && inverse.y > 0 && inverse.z > 0) return w > 0 ? Mobility::free : Mobility::rotating;
  return w == 0 && inverse.x == 0 && inverse.y == 0 && inverse.z == 0 ? Mobility::fixed : Mobility::partial;
}

/// Numbers the bodies of a forest while its joints are found.
class BodyNumbers {
 public:
  BodyNumbers(const CompiledObject& object, JointForest& forest) : object_(object), forest_(forest) {}

  /// The number of a body; -1: fixed. Returns false if the body cannot be part of a tree.
  bool find(std::int32_t point, std::int32_t frame, int& number) {
    const Mobility its = mobility(object_, point, frame);
    number = -1;
    if (its == Mobility::fixed || its == Mobility::partial) return its == Mobility::fixed;
    const auto [at, is_new] = numbers_.try_emplace(point, static_cast<int>(forest_.bodies.size()));
    if (is_new) forest_.bodies.push_back({point, frame, its == Mobility::rotating});
    number = at->second;
    return forest_.bodies[static_cast<std::size_t>(number)].frame == frame;
  }

 private:
  const CompiledObject& object_;
  JointForest& forest_;
  std::map<std::int32_t, int> numbers_;
};

bool is_marked(const std::vector<std::vector<char>>& marks, const ConstraintPlace& at) {
  if (marks.empty()) return false;
  const auto& pool = marks[static_cast<std::size_t>(at.pool_number)];
  return !pool.empty() && pool[static_cast<std::size_t>(at.batch * batch_width + at.lane)] != 0;
}

std::array<std::int32_t, 4> slots_of(const CompiledObject& object, const std::int32_t* number) {
  return {number[0], number[1] - object.particles, number[2], number[3] - object.particles};
}

void find_joints(const CompiledObject& object, const std::vector<std::vector<char>>& is_broken, JointForest& forest) {
  BodyNumbers numbers(object, forest);
  for (const Segment& segment : object.segments) {
    const Pool& pool = object.pools[static_cast<std::size_t>(segment.pool)];
    if (!constraint_type(pool.type).is_joint || pool.law == Law::pbd) continue;
    for_segment(object, segment, [&](const ConstraintPlace& at, const std::int32_t* number) {
      if (is_marked(is_broken, at)) return;
      JointForest::Joint joint{slots_of(object, number), {{at.pool_number, at.batch, at.lane}}, pool.components, true};
      JointEnds ends;
      const bool a = numbers.find(joint.slots[0], joint.slots[1], ends.a);
      const bool b = numbers.find(joint.slots[2], joint.slots[3], ends.b);
      if (!a || !b) return;
      forest.joints.push_back(joint);
      forest.ends.push_back(ends);
    });
  }
}

bool acts_on_two_bodies(const ConstraintDefinition& type) {
  return type.slots == std::vector<SlotKind>{SlotKind::point, SlotKind::frame, SlotKind::point, SlotKind::frame};
}

/// Adds the limits, or the motors and friction, to the joints of trees whose bodies they act on, as far as there is
/// room.
void add_bounded_parts(const CompiledObject& object, const std::vector<std::vector<char>>& is_broken, bool motors,
                       std::vector<JointForest>& forests) {
  std::map<std::array<std::int32_t, 4>, JointForest::Joint*> joints;
  for (JointForest& forest : forests)
    for (JointForest::Joint& joint : forest.joints)
      if (joint.in_tree) joints.try_emplace(joint.slots, &joint);
  for (const Segment& segment : object.segments) {
    const Pool& pool = object.pools[static_cast<std::size_t>(segment.pool)];
    const ConstraintDefinition& type = constraint_type(pool.type);
    if (type.evaluate_bounded == nullptr || type.acts_on_motion != motors || !acts_on_two_bodies(type) ||
        pool.law == Law::pbd)
      continue;
    for_segment(object, segment, [&](const ConstraintPlace& at, const std::int32_t* number) {
      const auto found = joints.find(slots_of(object, number));
      if (found == joints.end() || is_marked(is_broken, at)) return;
      JointForest::Joint& joint = *found->second;
      if (joint.rows + pool.components > most_joint_rows) return;
      joint.parts.push_back({at.pool_number, at.batch, at.lane});
      joint.rows += pool.components;
    });
  }
}

/// Marks the constraints of broken joints, and of bodies that sleep.
std::vector<std::vector<char>> find_left_out(const CompiledObject& object, const ObjectJoints& joints) {
  std::vector<std::vector<char>> marks = joints.is_broken;
  if (joints.is_asleep.empty()) return marks;
  marks.resize(object.pools.size());
  std::vector<char> is_asleep(static_cast<std::size_t>(object.particles) + object.frames.size());  // [slot]
  for (std::size_t b = 0; b < joints.is_asleep.size(); ++b) {
    const CompiledBodies::Body& body = object.bodies.bodies[b];
    const int frame = object.particles + body.frame;
    is_asleep[static_cast<std::size_t>(body.particle)] = is_asleep[static_cast<std::size_t>(frame)] =
        joints.is_asleep[b];
  }
  for (const Segment& segment : object.segments) {
    const Pool& pool = object.pools[static_cast<std::size_t>(segment.pool)];
    if (pool.in_lanes) continue;
    for_segment(object, segment, [&](const ConstraintPlace& at, const std::int32_t* number) {
      const bool sleeps = std::any_of(number, number + pool.stencil, [&](std::int32_t slot) {
        return is_asleep[static_cast<std::size_t>(slot)] != 0;
      });
      if (!sleeps) return;
      auto& of_pool = marks[static_cast<std::size_t>(at.pool_number)];
      of_pool.resize(static_cast<std::size_t>(pool.batches) * batch_width);
      of_pool[static_cast<std::size_t>(at.batch * batch_width + at.lane)] = 1;
    });
  }
  return marks;
}

/// Divides joints by the bodies that they connect, in the order of the first joint of each.
std::vector<JointForest> divided(const JointForest& all) {
  Islands islands;
  islands.reset(static_cast<int>(all.bodies.size()));
  for (const auto& [a, b] : all.ends)
    if (a >= 0 && b >= 0) islands.unite(a, b);
  std::vector<JointForest> forests;
  std::vector<int> forest_of(all.bodies.size(), -1), number(all.bodies.size(), -1);
  for (std::size_t j = 0; j < all.joints.size(); ++j) {
    const auto [a, b] = all.ends[j];
    if (a < 0 && b < 0) continue;  // both are fixed
    const auto root = static_cast<std::size_t>(islands.find(std::max(a, b)));
    if (forest_of[root] < 0) {
      forest_of[root] = static_cast<int>(forests.size());
      forests.emplace_back();
    }
    JointForest& forest = forests[static_cast<std::size_t>(forest_of[root])];
    const auto numbered = [&](int body) {
      if (body < 0) return -1;
      int& its = number[static_cast<std::size_t>(body)];
      if (its < 0) {
        its = static_cast<int>(forest.bodies.size());
        forest.bodies.push_back(all.bodies[static_cast<std::size_t>(body)]);
      }
      return its;
    };
    const int of_a = numbered(a);
    forest.joints.push_back(all.joints[j]);
    forest.ends.push_back({of_a, numbered(b)});
  }
  return forests;
}

/// Marks the constraints that the stencil driver leaves out.
void mark_skipped(const CompiledObject& object, const std::vector<JointForest>& forests,
                  const std::vector<std::vector<char>>& left_out, ObjectJoints& into) {
  into.is_skipped = left_out;
  into.is_skipped.resize(object.pools.size());
  for (const JointForest& forest : forests)
    for (const JointForest::Joint& joint : forest.joints) {
      if (!joint.in_tree) continue;
      for (const JointForest::Part& part : joint.parts) {
        auto& marks = into.is_skipped[static_cast<std::size_t>(part.pool)];
        marks.resize(static_cast<std::size_t>(object.pools[static_cast<std::size_t>(part.pool)].batches) * batch_width);
        marks[static_cast<std::size_t>(part.batch * batch_width + part.lane)] = 1;
      }
    }
  into.skipped.clear();
  for (const auto& marks : into.is_skipped) into.skipped.push_back(marks.empty() ? nullptr : marks.data());
  if (std::all_of(into.skipped.begin(), into.skipped.end(), [](const char* p) { return p == nullptr; }))
    into.skipped.clear();
}

}  // namespace

ObjectJoints::ObjectJoints() = default;
ObjectJoints::~ObjectJoints() = default;
ObjectJoints::ObjectJoints(ObjectJoints&&) noexcept = default;
ObjectJoints& ObjectJoints::operator=(ObjectJoints&&) noexcept = default;

void prepare_joints(const CompiledObject& object, ObjectJoints& joints) {
  JointForest all;
  const std::vector<std::vector<char>> left_out = find_left_out(object, joints);
  find_joints(object, left_out, all);
  joints.forests = divided(all);
  for (JointForest& forest : joints.forests) {
    std::vector<char> is_held;
    for (const JointForest::Body& body : forest.bodies) is_held.push_back(body.is_held ? 1 : 0);
    forest.tree.emplace(static_cast<int>(forest.bodies.size()), forest.ends, is_held);
    for (const int loose : forest.tree->loose()) forest.joints[static_cast<std::size_t>(loose)].in_tree = false;
  }
  // Where a motor drives against a stop, both are rows of one direction, and the solve leaves out the later one.
  for (const bool motors : {false, true}) add_bounded_parts(object, left_out, motors, joints.forests);
  mark_skipped(object, joints.forests, left_out, joints);
  joints.bundles = bundle_rods(object, joints.forests);
}

}  // namespace pliant
