// Motors of joints: targets that the user gives, and those of keyframes.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "constraints/joint_rows.h"
#include "pliant/error.h"
#include "world/control.h"

namespace pliant {

namespace {

[[noreturn]] void refuse_command(const std::string& object, const std::string& element, const std::string& problem,
                                 const std::string& advice) {
  throw Error({.object = object, .element = element}, problem, advice);
}

struct MotorPlace {
  std::size_t joint = 0, motor = 0;
};

/// The names of things, for messages.
template <class Named>
std::string names_of(const std::vector<Named>& things) {
  std::string names;
  for (const Named& one : things) names += (names.empty() ? "'" : ", '") + one.name + "'";
  return names;
}

/// The motor of that name of a joint; without a name its only one.
MotorPlace find_motor(const CompiledObject& of, const std::string& joint, const std::string& name) {
  const auto found =
      std::find_if(of.joints.begin(), of.joints.end(), [&](const CompiledJoint& one) { return one.name == joint; });
  if (found == of.joints.end())
    refuse_command(of.name, "joint '" + joint + "'", "does not exist",
                   of.joints.empty() ? "the object has no joints" : "name one of " + names_of(of.joints));
  const std::vector<CompiledJoint::Motor>& motors = found->motors;
  const auto index = static_cast<std::size_t>(found - of.joints.begin());
  if (motors.empty())
    refuse_command(of.name, "joint '" + joint + "'", "has no motor", "describe one when you add the joint");
  if (name.empty() && motors.size() == 1) return {index, 0};
  for (std::size_t m = 0; m < motors.size(); ++m)
    if (motors[m].name == name) return {index, m};
  refuse_command(of.name, "joint '" + joint + "'", name.empty() ? "has several motors" : "has no motor '" + name + "'",
                 "name one of " + names_of(motors));
}

/// The target at a time: linear between keyframes, constant outside.
float target_at(const std::vector<MotorKeyframe>& keyframes, double time) {
  const auto after = std::find_if(keyframes.begin(), keyframes.end(),
                                  [&](const MotorKeyframe& key) { return static_cast<double>(key.time) > time; });
  if (after == keyframes.begin()) return keyframes.front().target;
  if (after == keyframes.end()) return keyframes.back().target;
  const MotorKeyframe &a = *(after - 1), &b = *after;
  const double start = static_cast<double>(a.time);
  const double share = (time - start) / (static_cast<double>(b.time) - start);
  return static_cast<float>(static_cast<double>(a.target) +
                            share * (static_cast<double>(b.target) - static_cast<double>(a.target)));
}

/// Gives the motors of an object's joint that have keyframes their targets.
void follow(WorldData& world, int number, int joint, double time) {
  CompiledObject& object = world.model.objects[static_cast<std::size_t>(number)];
  const CompiledJoint& of = object.joints[static_cast<std::size_t>(joint)];
  for (int m = 0; m < static_cast<int>(of.motors.size()); ++m) {
    const CompiledJoint::Motor& motor = of.motors[static_cast<std::size_t>(m)];
    if (motor.keyframes.empty()) continue;
    const MotorSetting place{number, joint, m, 0, 0};
    if (std::binary_search(world.state.motors.begin(), world.state.motors.end(), place, is_earlier)) continue;
    const float target = target_at(motor.keyframes, time);
    // Sleeping bodies wake where the target moves; at the first keyframe they may rest.
    if (target != target_at(motor.keyframes, world.state.time)) wake_bodies(world, number);
    set_motor(object, of, motor, target, motor.most);
  }
}

}  // namespace

void follow_motors(WorldData& world, double time) {
  for (int number = 0; number < static_cast<int>(world.model.objects.size()); ++number)
    for (int joint = 0; joint < static_cast<int>(world.model.objects[static_cast<std::size_t>(number)].joints.size());
         ++joint)
      follow(world, number, joint, time);
}

bool is_earlier(const MotorSetting& a, const MotorSetting& b) {
  return std::tie(a.block, a.joint, a.motor) < std::tie(b.block, b.joint, b.motor);
}

void ObjectHandle::set_motor(const std::string& joint, const MotorCommand& command) {
  const int number = world_->number(id());
  CompiledObject& of = world_->model.objects[static_cast<std::size_t>(number)];
  const MotorPlace place = find_motor(of, joint, command.motor);
  const CompiledJoint& its = of.joints[place.joint];
  const CompiledJoint::Motor& motor = its.motors[place.motor];
  const std::string element = "motor '" + motor.name + "' of joint '" + joint + "'";
  if (!std::isfinite(command.target) || std::fabs(command.target) > joint::no_limit)
    refuse_command(of.name, element, "its target is not finite", "give a finite number");
  if (command.most && motor.is_torque)
    refuse_command(of.name, element, "is given a greatest torque or force beside its own", "leave `most` out");
  if (command.most && !(*command.most > 0))
    refuse_command(of.name, element, "its greatest torque or force is " + std::to_string(*command.most),
                   "give a number above 0");
  MotorSetting setting{number, static_cast<int>(place.joint), static_cast<int>(place.motor), command.target,
                       motor.most};
  std::vector<MotorSetting>& all = world_->state.motors;
  const auto at = std::lower_bound(all.begin(), all.end(), setting, is_earlier);
  const bool is_known = at != all.end() && !is_earlier(setting, *at);
  if (is_known) setting.most = at->most;
  setting.most = command.most.value_or(setting.most);
  pliant::set_motor(of, its, motor, setting.target, setting.most);
  wake_bodies(*world_, number);
  if (is_known)
    *at = setting;
  else
    all.insert(at, setting);
}

}  // namespace pliant
