#include "world/tear_rods.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>
#include <vector>

#include "constraints/registry.h"
#include "constraints/rod_joint.h"
#include "math/disjoint_sets.h"
#include "math/quat.h"
#include "matter/plane_sides.h"
#include "model/rods.h"
#include "solver/bodies/joint_load.h"

namespace pliant {

namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The joints of an object's rods that are not broken.
class WholeRods {
 public:
  WholeRods(const WorldData& world, int number, const Object& object)
      : world_(world), number_(number), object_(object), compiled_(world.model.objects[at(number)]) {
    const std::vector<int>& broken = world.workspace.joints[at(number)].broken;
    for (int j = 0; j < static_cast<int>(object.joints.size()); ++j)
      if (is_of_rod(object.joints[at(j)]) && !std::binary_search(broken.begin(), broken.end(), j)) joints_.push_back(j);
  }

  /// Those between segments on both sides of a plane, where the blade has been.
  std::vector<int> cut_by(const PlaneCut& cut, double time) const {
    std::vector<int> found;
    if (joints_.empty() || time < static_cast<double>(cut.start)) return found;
    const PlaneSides sides(object_, cut, time);
    for (const int j : joints_) {
      const ObjectJoint& joint = object_.joints[at(j)];
      if (joint.a < 0 || joint.b < 0) continue;
      const int a = object_.bodies[at(joint.a)].particle, b = object_.bodies[at(joint.b)].particle;
      if (sides.are_parted(std::array<int, 1>{a}, std::array<int, 1>{b}) && sides.is_reached(std::array<int, 2>{a, b}))
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
      if (joint.a >= 0 && joint.b >= 0) rods.join(at(joint.a), at(joint.b));
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
  /// The end of a segment at a joint, and how far that is from its middle.
  struct End {
    Vec3d place;
    double arm = 0;
  };

  /// `side`: 0 for body a, 1 for b. A rod_joint has the anchors of both as its first rest fields.
  End end_of(const CompiledJoint::Part& part, int side) const {
    const Pool& pool = compiled_.pools[at(part.pool)];
    const auto field = [&](int i) { return static_cast<double>(pool.row(3 * side + i, part.batch)[part.lane]); };
    const Vec3d anchor{field(0), field(1), field(2)};
    const Record& x = world_.state.positions[at(world_.model.first[at(number_)] + part.slots[at(2 * side)])];
    const int frame = part.slots[at(2 * side + 1)] - compiled_.particles;
    const Record& q = world_.state.frames.orientations[at(world_.model.first_frame[at(number_)] + frame)];
    const Quatd turn{double(q.x), double(q.y), double(q.z), double(q.w)};
    return {Vec3d{double(x.x), double(x.y), double(x.z)} + rotate(turn, anchor), std::sqrt(dot(anchor, anchor))};
  }

  /// The length over that at rest of the rod between the middles of two segments, or between what holds a rod and the middle of the first.
  double stretch_of(int j) const {
    for (const CompiledJoint::Part& part : compiled_.joints[at(j)].parts) {
      const Pool& pool = compiled_.pools[at(part.pool)];
      if (pool.type != find_constraint_type(RodJointRows::name)) continue;
      const End a = end_of(part, 0), b = end_of(part, 1);
      const Vec3d gap = b.place - a.place;
      return 1 + std::sqrt(dot(gap, gap)) / rest_length(j, a.arm, b.arm, pool, part);
    }
    return 0;  // an end on a ball joint, which does not stretch
  }

  /// The rod_joint knows its radius over its length; that says whether the body a is a segment, too.
  double rest_length(int j, double arm_a, double arm_b, const Pool& pool, const CompiledJoint::Part& part) const {
    const std::vector<Solid>& solids = object_.bodies[at(object_.joints[at(j)].b)].solids;
    const auto* capsule = solids.size() == 1 ? std::get_if<Capsule>(&solids[0].shape) : nullptr;
    const double per_angle = static_cast<double>(pool.row(pool.fields - 1, part.batch)[part.lane]);
    if (capsule == nullptr || !(per_angle > 0)) return arm_a + arm_b;
    const double expected = static_cast<double>(capsule->radius) / per_angle;
    return std::fabs(arm_b - expected) < std::fabs(arm_a + arm_b - expected) ? arm_b : arm_a + arm_b;
  }

  const WorldData& world_;
  int number_;
  const Object& object_;
  const CompiledObject& compiled_;
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
