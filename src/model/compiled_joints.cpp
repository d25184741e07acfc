#include "model/compiled_joints.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "constraints/joint_rows.h"
#include "constraints/registry.h"
#include "model/compiled_object.h"
#include "pliant/error.h"

namespace pliant {

namespace {

/// Where the constraints of each type are, by their number among the object's constraints of that type.
using Places = std::map<std::pair<int, int>, CompiledJoint::Part>;

void add_places(const Pool& pool, const Segment& segment, Places& places) {
  const std::int32_t* index = pool.indices.data() + segment.index_offset;
  for (int b = 0; b < segment.batches; ++b, index += indices_per_batch(pool, segment)) {
    for (int lane = 0; lane < batch_width; ++lane) {
      if (!lane_is_valid(segment, b, lane)) continue;
      CompiledJoint::Part part{segment.pool, std::int64_t{segment.first_batch} + b, lane, {}};
      for (int slot = 0; slot < pool.stencil; ++slot)
        part.slots[static_cast<std::size_t>(slot)] = particle_of(segment, index, slot, lane);
      places[{pool.type, pool.origin[static_cast<std::size_t>(part.batch * batch_width + lane)]}] = part;
    }
  }
}

Places places_of(const CompiledObject& object) {
  Places places;
  for (const Segment& segment : object.segments) {
    const Pool& pool = object.pools[static_cast<std::size_t>(segment.pool)];
    if (!pool.in_lanes) add_places(pool, segment, places);  // joints have frames
  }
  return places;
}

/// The type of each group, and how many constraints of that type earlier groups have.
std::vector<std::pair<int, int>> first_numbers(const Object& object) {
  std::vector<std::pair<int, int>> first;
  std::map<int, int> counts;
  for (const ConstraintGroup& group : object.constraints) {
    const int type = find_constraint_type(group.type);
    first.emplace_back(type, counts[type]);
    counts[type] += static_cast<int>(group.particles.size() / constraint_type(type).slots.size());
  }
  return first;
}

bool is_motor(const Pool& pool, const char* name) { return constraint_type(pool.type).name == name; }

/// Where a rest field of a motor is stored.
std::size_t place_of(const Pool& pool, const CompiledJoint::Part& part, int field) {
  return static_cast<std::size_t>(part.batch * pool.block_floats + pool.row_offset[static_cast<std::size_t>(field)] +
                                  part.lane);
}

[[noreturn]] void refuse(const Object& object, const ObjectJoint& joint, const std::string& problem) {
  throw Error({.object = object.name, .element = "joint '" + joint.name + "'"}, problem, "make joints by add_joint");
}

/// A motor as the description has it.
CompiledJoint::Motor motor_of(const Object& object, const CompiledObject& compiled, const ObjectJoint& joint,
                              const CompiledJoint& made, const ObjectJointMotor& motor) {
  if (motor.constraint < 0 || static_cast<std::size_t>(motor.constraint) >= made.parts.size())
    refuse(object, joint, "has a motor whose constraint does not exist");
  const auto index = static_cast<std::size_t>(motor.constraint);
  const CompiledJoint::Part& part = made.parts[index];
  const Pool& pool = compiled.pools[static_cast<std::size_t>(part.pool)];
  const bool is_angle = is_motor(pool, "joint_angle_motor");
  if (!is_angle && !is_motor(pool, "joint_offset_motor"))
    refuse(object, joint, "has a motor whose constraint is of another type");
  for (std::size_t k = 0; k < motor.keyframes.size(); ++k) {
    const MotorKeyframe& key = motor.keyframes[k];
    if (!std::isfinite(key.time) || !std::isfinite(key.target))
      refuse(object, joint, "has a motor whose keyframe " + std::to_string(k) + " is not finite");
    if (k > 0 && !(key.time > motor.keyframes[k - 1].time))
      refuse(object, joint, "has a motor whose keyframe " + std::to_string(k) + " is not after the one before");
  }
  if (motor.is_torque && motor.to_position)
    refuse(object, joint, "has a motor to a position that is one of a torque, too");
  const auto value = [&](int field) { return pool.blocks[place_of(pool, part, field)]; };
  const float most = value(joint::motor_most), speed = value(joint::motor_speed);
  const float target = motor.is_torque     ? (speed < 0 ? -most : most)
                       : motor.to_position ? value(joint::motor_target)
                                           : speed;
  return {motor.name, index, is_angle, motor.to_position, motor.is_torque, target, most, motor.keyframes};
}

CompiledJoint::Side side_of(const Object& object, const CompiledObject& compiled, int number, const Vec3f& anchor,
                            const Quatf& axes) {
  const ObjectBody& body = object.bodies[static_cast<std::size_t>(number)];
  const float size = axes.x * axes.x + axes.y * axes.y + axes.z * axes.z + axes.w * axes.w;
  if (!(size > 0.9f && size < 1.1f) || !std::isfinite(anchor.x + anchor.y + anchor.z))
    throw Error({.object = object.name}, "has a joint whose axes or anchor are not finite or no rotation",
                "make joints by add_joint");
  return {compiled.place[static_cast<std::size_t>(body.particle)], body.frame, anchor, axes};
}

}  // namespace

std::vector<CompiledJoint> compile_joints(const Object& object, const CompiledObject& compiled) {
  std::vector<CompiledJoint> out;
  if (object.joints.empty()) return out;
  const Places places = places_of(compiled);
  const auto first = first_numbers(object);
  for (const ObjectJoint& joint : object.joints) {
    for (const int number : {joint.a, joint.b})
      if (number < 0 || static_cast<std::size_t>(number) >= object.bodies.size())
        refuse(object, joint, "has a body that does not exist");
    const ObjectBody& body = object.bodies[static_cast<std::size_t>(joint.b)];
    CompiledJoint made{joint.name,
                       compiled.place[static_cast<std::size_t>(body.particle)],
                       body.frame,
                       joint.anchor,
                       joint.break_force,
                       joint.break_torque,
                       {},
                       {},
                       side_of(object, compiled, joint.a, joint.anchor_a, joint.axes_a),
                       side_of(object, compiled, joint.b, joint.anchor, joint.axes_b)};
    for (const auto& [group, index] : joint.constraints) {
      if (group < 0 || static_cast<std::size_t>(group) >= first.size())
        refuse(object, joint, "has a group that does not exist");
      const auto& [type, before] = first[static_cast<std::size_t>(group)];
      const auto found = places.find({type, before + index});
      if (found == places.end()) refuse(object, joint, "has a constraint that does not exist");
      made.parts.push_back(found->second);
    }
    for (const ObjectJointMotor& motor : joint.motors)
      made.motors.push_back(motor_of(object, compiled, joint, made, motor));
    out.push_back(std::move(made));
  }
  return out;
}

void set_motor(CompiledObject& object, const CompiledJoint& joint, const CompiledJoint::Motor& motor, float target,
               float most) {
  const CompiledJoint::Part& part = joint.parts[motor.part];
  Pool& pool = object.pools[static_cast<std::size_t>(part.pool)];
  if (motor.is_torque) {
    most = std::max(std::fabs(target), joint::least_torque);
    target = std::copysign(joint::speed_of_torque, target);
  }
  if (motor.is_angle && motor.to_position) target = joint::wrap_turns(target);
  pool.blocks[place_of(pool, part, motor.to_position ? joint::motor_target : joint::motor_speed)] = target;
  pool.blocks[place_of(pool, part, joint::motor_most)] = std::min(most, joint::no_limit);
}

}  // namespace pliant
