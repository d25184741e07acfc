#include "world/tear_rods.h"

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

#include "constraints/registry.h"
#include "constraints/rod_joint.h"
#include "core/at.h"
#include "math/disjoint_sets.h"
#include "math/quat.h"
#include "matter/plane_sides.h"
#include "model/rods.h"
#include "solver/bodies/joint_load.h"

namespace pliant {

namespace {

/// The joints of an object's rods that are not broken.
class WholeRods {
 public:
  WholeRods(const WorldData& world, int number, const Object& object)
      : world_(world), number_(number), object_(object), compiled_(world.model.objects[at(number)]) {
    const std::vector<int>& broken = world.workspace.joints[at(number)].broken;
    for (int j = 0; j < static_cast<int>(object.joints.size()); ++j)
      if (is_of_rod(object.joints[at(j)]) && !std::binary_search(broken.begin(), broken.end(), j)) joints_.push_back(j);
  }

  /// Those between segments on both sides of a plane, or between an end and the middle of the first segment, where the
  /// blade has been.
  std::vector<int> cut_by(const PlaneCut& cut, double time) const {
    std::vector<int> found;
    if (joints_.empty() || time < static_cast<double>(cut.start)) return found;
    const PlaneSides sides(object_, cut, time);
    for (const int j : joints_) {
      const Vec3d place = place_of(j), ahead = middle_of(object_.joints[at(j)].b);
      const Vec3d behind = is_end(j) ? place : middle_of(object_.joints[at(j)].a);
      if (sides.is_ahead(ahead) != sides.is_ahead(behind) && sides.is_reached((ahead + behind) * 0.5))
        found.push_back(j);
    }
    return found;
  }

  /// Of each rod the joint that is stretched farthest, if beyond a limit: what breaks there relieves the others.
  std::vector<int> stretched_beyond(double limit) const {
    DisjointSets rods(object_.bodies.size());
    std::vector<int> longest(object_.bodies.size(), -1);
    std::vector<double> stretch(joints_.size());
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const ObjectJoint& joint = object_.joints[at(joints_[i])];
      if (!is_end(joints_[i])) rods.join(at(joint.a), at(joint.b));  // what holds several rods does not make them one
      stretch[i] = stretch_of(joints_[i]);
    }
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      int& of_rod = longest[rods.root(at(object_.joints[at(joints_[i])].b))];
      if (stretch[i] > limit && (of_rod < 0 || stretch[i] > stretch[at(of_rod)])) of_rod = static_cast<int>(i);
    }
    std::vector<int> found;
    for (const int i : longest)
      if (i >= 0) found.push_back(joints_[at(i)]);
    return found;
  }

 private:
  Vec3d middle_of(int body) const { return convert<double>(object_.positions[at(object_.bodies[at(body)].particle)]); }

  /// The place of a joint in the rest shape.
  Vec3d place_of(int j) const {
    const ObjectJoint& joint = object_.joints[at(j)];
    const Quatf& turn = object_.frames[at(object_.bodies[at(joint.b)].frame)].orientation;
    return middle_of(joint.b) + rotate(convert<double>(turn), convert<double>(joint.anchor));
  }

  /// The rod_joint of a joint; null: it is the end of a rod on a ball joint.
  const CompiledJoint::Part* rod_part(int j) const {
    for (const CompiledJoint::Part& part : compiled_.joints[at(j)].parts)
      if (pool_of(part).type == type_) return &part;
    return nullptr;
  }
  const Pool& pool_of(const CompiledJoint::Part& part) const { return compiled_.pools[at(part.pool)]; }
  double field(const CompiledJoint::Part& part, int i) const {
    return static_cast<double>(pool_of(part).row(i, part.batch)[part.lane]);
  }

  /// The anchor of a body, which a rod_joint has first: in its principal axes about its centre. `side`: 0 for body a, 1
  /// for b.
  Vec3d anchor_of(const CompiledJoint::Part& part, int side) const {
    return {field(part, 3 * side), field(part, 3 * side + 1), field(part, 3 * side + 2)};
  }

  /// True if body a is what holds the rod, and no segment: the rod_joint, which knows the radius over the length of rod
  /// that it stands for, counts only the half segment of b.
  bool is_end(int j) const {
    const CompiledJoint::Part* const part = rod_part(j);
    const std::vector<Solid>& solids = object_.bodies[at(object_.joints[at(j)].b)].solids;
    const auto* capsule = solids.size() == 1 ? std::get_if<Capsule>(&solids[0].shape) : nullptr;
    if (part == nullptr || capsule == nullptr) return false;
    const double expected = static_cast<double>(capsule->radius) / field(*part, pool_of(*part).fields - 1);
    const double arm_a = length_of(anchor_of(*part, 0)), arm_b = length_of(anchor_of(*part, 1));
    return std::fabs(arm_b - expected) < std::fabs(arm_a + arm_b - expected);
  }

  static double length_of(const Vec3d& v) { return std::sqrt(dot(v, v)); }

  /// Where the anchor of a body is at present.
  Vec3d present_anchor(const CompiledJoint::Part& part, int side) const {
    const Record& x = world_.state.positions[at(world_.model.first[at(number_)] + part.slots[at(2 * side)])];
    const int frame = part.slots[at(2 * side + 1)] - compiled_.particles;
    const Record& q = world_.state.frames.orientations[at(world_.model.first_frame[at(number_)] + frame)];
    const Quatd turn{double(q.x), double(q.y), double(q.z), double(q.w)};
    return Vec3d{double(x.x), double(x.y), double(x.z)} + rotate(turn, anchor_of(part, side));
  }

  /// The length over that at rest of the rod between the middles of two segments, or between its end and the middle of
  /// the first.
  double stretch_of(int j) const {
    const CompiledJoint::Part* const part = rod_part(j);
    if (part == nullptr) return 0;
    const double arm_a = is_end(j) ? 0 : length_of(anchor_of(*part, 0)), arm_b = length_of(anchor_of(*part, 1));
    return 1 + length_of(present_anchor(*part, 1) - present_anchor(*part, 0)) / (arm_a + arm_b);
  }

  const WorldData& world_;
  int number_;
  const Object& object_;
  const CompiledObject& compiled_;
  int type_ = find_constraint_type(RodJointRows::name);
  std::vector<int> joints_;
};

/// Breaks joints, ascending, of an object.
void break_joints(WorldData& world, ObjectId id, const std::vector<int>& joints, Report& report) {
  const int number = world.number(id);
  ObjectJoints& now = world.workspace.joints[at(number)];
  std::vector<int> broken = now.broken;
  broken.insert(broken.end(), joints.begin(), joints.end());
  std::sort(broken.begin(), broken.end());
  set_broken(world.model.objects[at(number)], broken, now);
  for (const int joint : joints) {
    world.state.broken_joints.push_back({number, joint});
    report.broken_joints.push_back({id, joint, world.model.objects[at(number)].joints[at(joint)].name});
  }
  std::sort(world.state.broken_joints.begin(), world.state.broken_joints.end());
  world.state.rest_times.clear();  // what hangs on the rod wakes
  world.groups.bodies_meet_others = true;
}

}  // namespace

void tear_rods(WorldData& world, ObjectId id, const Object& object, bool is_being_cut, Report& report) {
  const WholeRods rods(world, world.number(id), object);
  std::vector<int> joints;
  for (const PlaneCut& cut : object.cuts) {
    if (!is_being_cut) break;
    const std::vector<int> parted = rods.cut_by(cut, world.state.time);
    joints.insert(joints.end(), parted.begin(), parted.end());
  }
  if (object.tearing) {
    const std::vector<int> torn = rods.stretched_beyond(static_cast<double>(object.tearing->stretch));
    joints.insert(joints.end(), torn.begin(), torn.end());
  }
  std::sort(joints.begin(), joints.end());
  joints.erase(std::unique(joints.begin(), joints.end()), joints.end());
  if (!joints.empty()) break_joints(world, id, joints, report);
}

}  // namespace pliant
