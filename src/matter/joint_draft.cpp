#include "matter/joint_draft.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "constraints/joint_rows.h"
#include "model/body_names.h"
#include "pliant/error.h"

namespace pliant {

namespace {

constexpr float above_zero = 1e-20f;
constexpr const char* world_name = "world";

/// True also for the world's body before it is added.
bool is_fixed(const Object& object, const JointBody& body) {
  const auto point = static_cast<std::size_t>(body.point);
  return point >= object.masses.size() || std::isinf(object.masses[point]);
}

/// Rest data are finite.
float limited(float value) { return std::min(value, joint::no_limit); }

/// The rotation that takes x to axis 0, 1 or 2, and permutes the others.
Quatd exchange_axes(int axis) {
  if (axis == 0) return {0, 0, 0, 1};
  return axis == 1 ? Quatd{0.5, 0.5, 0.5, 0.5} : Quatd{-0.5, -0.5, -0.5, 0.5};
}

bool are_equal(const std::optional<Plasticity>& a, const std::optional<Plasticity>& b) {
  if (!a || !b) return !a && !b;
  return a->yield == b->yield && a->rate == b->rate && a->most == b->most;
}

bool accepts(const ConstraintGroup& group, const std::string& type, const Stiffness& stiffness,
             const std::optional<Plasticity>& plasticity) {
  const Stiffness& own = group.stiffness;
  return group.type == type && own.kind == stiffness.kind && own.value == stiffness.value &&
         own.damping == stiffness.damping && are_equal(group.plasticity, plasticity) && group.compliances.empty() &&
         group.keyframes.empty() && !group.rest.empty();
}

/// "an axis", "a ratio".
std::string with_article(const std::string& name) {
  return (std::string("aeiou").find(name.front()) == std::string::npos ? "a " : "an ") + name;
}

/// "1.5 m", or of an angle "1.5 rad (85.9 degrees)", because scene files have degrees.
std::string in_words(float value, bool is_angle) {
  char text[80];
  const auto number = static_cast<double>(value);
  if (is_angle)
    std::snprintf(text, sizeof text, "%.4g rad (%.4g degrees)", number, number * 180 / std::numbers::pi);
  else
    std::snprintf(text, sizeof text, "%.6g m", number);
  return text;
}

/// "body 3 ('wheel')", or "body 3" of one without its own name.
std::string called(const Object& object, int body) {
  const auto index = static_cast<std::size_t>(body);
  const std::string name = index < object.bodies.size() ? object.bodies[index].name : world_name;
  const bool is_named = has_own_name(name) || name == world_name;
  return "body " + std::to_string(body) + (is_named ? " ('" + name + "')" : "");
}

/// The group to which a constraint can be added; a new one if there is none.
std::size_t group_for(Object& object, const std::string& type, const Stiffness& stiffness,
                      const std::optional<Plasticity>& plasticity) {
  for (std::size_t i = 0; i < object.constraints.size(); ++i)
    if (accepts(object.constraints[i], type, stiffness, plasticity)) return i;
  object.constraints.push_back({type, {}, {}, stiffness, {}, plasticity});
  return object.constraints.size() - 1;
}

}  // namespace

void append(const Vec3d& v, std::vector<float>& to) {
  for (const double x : {v.x, v.y, v.z}) to.push_back(static_cast<float>(x));
}
void append(const Quatd& q, std::vector<float>& to) {
  for (const double x : {q.x, q.y, q.z, q.w}) to.push_back(static_cast<float>(x));
}

Quatd rotation_from_x(const Vec3d& axis) {
  if (axis.x < -1 + 1e-12) return {0, 0, 1, 0};  // half a turn about z
  return normalise(Quatd{0, -axis.z, axis.y, 1 + axis.x});
}

Quatd rotation_from_xy(const Vec3d& x, const Vec3d& y) {
  const Quatd to_x = rotation_from_x(x);
  const Vec3d local = rotate(conjugate(to_x), y);
  const double half = atan2(local.z, local.y) / 2;
  return multiply(to_x, Quatd{sin(half), 0, 0, cos(half)});
}

double principal_angle(double angle) { return std::remainder(angle, 2 * std::numbers::pi); }

JointDraft::JointDraft(Object& object, std::string kind, int a, int b, const JointOptions& options)
    : object_(object), kind_(std::move(kind)), name_(options.name), options_(options) {
  if (name_.empty()) name_ = kind_ + " " + std::to_string(object.joints.size());
  const bool is_taken =
      !options.name.empty() && std::any_of(object.joints.begin(), object.joints.end(),
                                           [&](const ObjectJoint& other) { return other.name == options.name; });
  if (is_taken) refuse("has a name that is taken", "joints of an object have different names");
  a_ = find(a);
  b_ = find(b);
  if (a_.body == b_.body) refuse("joins " + called(object, a_.body) + " with itself", "give two bodies");
  if (is_fixed(object, a_) && is_fixed(object, b_))
    refuse("joins two fixed bodies", "make at least one of them dynamic");
  require(options.compliance, "compliance", 0);
  require(options.damping, "damping", 0);
  require(options.break_force, "break_force", above_zero, unlimited, true);
  require(options.break_torque, "break_torque", above_zero, unlimited, true);
}

void JointDraft::refuse(const std::string& problem, const std::string& advice) const {
  throw Error({"", 0, object_.name, "joint '" + name_ + "'"}, problem, advice);
}

void JointDraft::require(float value, const char* name, float least, float most, bool may_be_infinite) const {
  if (value >= least && value <= most && (may_be_infinite || std::isfinite(value))) return;
  refuse("has " + with_article(name) + " of " + std::to_string(value),
         std::isinf(most) ? "give a number of at least " + std::to_string(least)
                          : "give a number from " + std::to_string(least) + " to " + std::to_string(most));
}

Vec3d JointDraft::place(const Vec3f& at, const char* name) const {
  if (!is_finite(at)) refuse("has " + with_article(name) + " that is not finite", "give coordinates in metres");
  return convert<double>(at);
}

Vec3d JointDraft::direction(const Vec3f& axis, const char* name) const {
  const Vec3d v = place(axis, name);
  const double size = std::sqrt(length_squared(v));
  if (!(size > 0)) refuse("has " + with_article(name) + " of length zero", "give the direction of the axis");
  return v * (1 / size);
}

JointBody JointDraft::find(int body) const {
  if (body == -1) return world();
  if (body < 0 || static_cast<std::size_t>(body) >= object_.bodies.size())
    refuse("uses body " + std::to_string(body) + "; there are " + std::to_string(object_.bodies.size()),
           "give an index in Object::bodies, or -1 for the world");
  const ObjectBody& of = object_.bodies[static_cast<std::size_t>(body)];
  const Quatd axes = convert<double>(object_.frames.at(static_cast<std::size_t>(of.frame)).orientation);
  return {body,
          of.particle,
          of.frame,
          {convert<double>(object_.positions.at(static_cast<std::size_t>(of.particle))), normalise(axes)}};
}

/// The fixed body that stands for the world; if there is none yet, the indices that it will get.
JointBody JointDraft::world() const {
  const auto at_origin = [&](const ObjectBody& body) {
    return body.name == world_name && body.solids.empty() &&
           object_.positions.at(static_cast<std::size_t>(body.particle)) == Vec3f{} &&
           std::isinf(object_.masses.at(static_cast<std::size_t>(body.particle)));
  };
  const auto found = std::find_if(object_.bodies.begin(), object_.bodies.end(), at_origin);
  if (found != object_.bodies.end()) return find(static_cast<int>(found - object_.bodies.begin()));
  needs_world_ = true;
  JointBody made;
  made.body = static_cast<int>(object_.bodies.size());
  made.point = static_cast<int>(object_.positions.size());
  made.frame = static_cast<int>(object_.frames.size());
  return made;
}

JointBody JointDraft::third(int body) const {
  const JointBody found = find(body);
  if (found.body == a_.body || found.body == b_.body)
    refuse("uses body " + std::to_string(body) + " twice", "give a third body as carrier, or -1 for the world");
  return found;
}

void JointDraft::add_world() {
  object_.positions.push_back({});
  constexpr float infinity = std::numeric_limits<float>::infinity();
  object_.masses.push_back(infinity);
  if (!object_.velocities.empty()) object_.velocities.push_back({});
  object_.frames.push_back({{}, {}, {infinity, infinity, infinity}});
  ObjectBody body;
  body.name = world_name;
  body.particle = static_cast<int>(object_.positions.size()) - 1;
  body.frame = static_cast<int>(object_.frames.size()) - 1;
  object_.bodies.push_back(std::move(body));
}

void JointDraft::set_frame(const Vec3d& anchor, const Quatd& axes) {
  anchor_ = anchor;
  axes_ = axes;
}

void JointDraft::add(const char* type, int axis, const std::vector<float>& more, float compliance, float damping) {
  const Quatd axes = normalise(multiply(axes_, exchange_axes(axis)));
  std::vector<float> rest;
  append(a_.local(anchor_), rest);
  append(b_.local(anchor_), rest);
  append(a_.local(axes), rest);
  append(b_.local(axes), rest);
  rest.insert(rest.end(), more.begin(), more.end());
  add_raw(type, {a_.point, a_.frame, b_.point, b_.frame}, rest, compliance, damping);
}

void JointDraft::add_raw(const char* type, const std::vector<int>& slots, const std::vector<float>& rest,
                         float compliance, float damping, const std::optional<Plasticity>& plasticity) {
  parts_.push_back({type, slots, rest, Stiffness::compliance(compliance, damping), plasticity});
}

void JointDraft::require_range(const JointRange& range, bool is_angle) const {
  if (!std::isfinite(range.low) || !std::isfinite(range.high) || range.low > range.high)
    refuse("has a range from " + in_words(range.low, is_angle) + " to " + in_words(range.high, is_angle),
           "give two finite numbers, the lower one first");
  require(range.compliance, "compliance of its range", 0);
}

void JointDraft::limit_angle(int axis, const JointRange& range) {
  require_range(range, true);
  const double low = static_cast<double>(range.low), high = static_cast<double>(range.high);
  constexpr double rounding = 1e-6;  // of -180 to 180 degrees in single precision
  if (high - low > 2 * std::numbers::pi + rounding)
    refuse("has a range of " + in_words(static_cast<float>(high - low), true), "give at most a full turn, or no range");
  const float middle = middles_[static_cast<std::size_t>(axis)] = static_cast<float>(principal_angle((low + high) / 2));
  add("joint_angle", axis, {middle, static_cast<float>(std::min((high - low) / 2, std::numbers::pi)), joint::no_limit},
      range.compliance);
}

void JointDraft::limit_offset(int axis, const JointRange& range) {
  require_range(range, false);
  add("joint_offset", axis, {range.low, range.high, joint::no_limit}, range.compliance);
}

void JointDraft::require_spring(const JointSpring& spring) const {
  require(spring.rest, "rest of its spring", -joint::no_limit, joint::no_limit);
  require(spring.stiffness, "stiffness of its spring", 1e-20f, 1e20f);
  require(spring.damping, "damping of its spring", 0, 1e30f);
}

void JointDraft::spring_angle(int axis, const std::optional<JointSpring>& spring) {
  if (!spring) return;
  require_spring(*spring);
  const auto rest = static_cast<float>(principal_angle(static_cast<double>(spring->rest)));
  add("joint_angle", axis, {rest, 0, joint::no_limit}, 1 / spring->stiffness, spring->damping);
}

void JointDraft::spring_offset(int axis, const std::optional<JointSpring>& spring) {
  if (!spring) return;
  require_spring(*spring);
  add("joint_offset", axis, {spring->rest, spring->rest, joint::no_limit}, 1 / spring->stiffness, spring->damping);
}

void JointDraft::require_keyframes(const JointMotor& motor) const {
  for (std::size_t k = 0; k < motor.keyframes.size(); ++k) {
    const MotorKeyframe& key = motor.keyframes[k];
    require(key.time, "time of a motor's keyframe", -joint::no_limit, joint::no_limit);
    require(key.target, "target of a motor's keyframe", -joint::no_limit, joint::no_limit);
    if (k > 0 && !(key.time > motor.keyframes[k - 1].time))
      refuse("has a motor whose keyframe " + std::to_string(k) + " is not after the one before", "times must increase");
  }
}

void JointDraft::add_motor(const char* type, int axis, const JointMotor& motor, const char* name, bool is_angle) {
  const bool to_position = motor.kind == JointMotor::Kind::position;
  require(motor.target, "motor target", -joint::no_limit, joint::no_limit);
  require(motor.most, "greatest motor torque or force", above_zero, unlimited, true);
  require(motor.rate, "motor rate", 0);
  require(motor.most_speed, "greatest motor speed", 0, unlimited, true);
  require_keyframes(motor);
  const float first = motor.keyframes.empty() ? motor.target : motor.keyframes.front().target;
  const float target = is_angle ? static_cast<float>(principal_angle(static_cast<double>(first))) : first;
  const bool is_torque = motor.kind == JointMotor::Kind::torque;
  const float speed = is_torque ? std::copysign(joint::speed_of_torque, first) : first;
  const float most = is_torque ? std::max(std::fabs(first), joint::least_torque) : limited(motor.most);
  motors_.push_back({name, static_cast<int>(parts_.size()), to_position, is_torque, motor.keyframes});
  std::vector<float> rest{to_position ? target : 0, to_position ? motor.rate : 0,
                          to_position ? limited(motor.most_speed) : 0, to_position ? 0 : speed, most};
  if (is_angle) rest.push_back(middles_[static_cast<std::size_t>(axis)]);
  add(type, axis, rest, 0);
}

void JointDraft::add_friction(const char* type, int axis, float friction, bool is_angle) {
  require(friction, "friction", 0);
  if (friction == 0) return;
  std::vector<float> rest{0, 0, 0, 0, friction};
  if (is_angle) rest.push_back(joint::no_limit);
  add(type, axis, rest, 0);
}

/// A motor at rest of any strength, whose compliance lets it give way in proportion to its force.
void JointDraft::add_damper(const char* type, int axis, float damping, bool is_angle) {
  require(damping, "damping", 0, 1e30f);
  if (damping < above_zero) return;
  std::vector<float> rest{0, 0, 0, 0, joint::no_limit};
  if (is_angle) rest.push_back(joint::no_limit);
  add(type, axis, rest, 1 / damping);
}

void JointDraft::drive_angle(int axis, const std::optional<JointMotor>& motor, float friction, const char* name) {
  if (motor) add_motor("joint_angle_motor", axis, *motor, name, true);
  add_friction("joint_angle_motor", axis, friction, true);
}
void JointDraft::drive_offset(int axis, const std::optional<JointMotor>& motor, float friction, const char* name) {
  if (motor) add_motor("joint_offset_motor", axis, *motor, name, false);
  add_friction("joint_offset_motor", axis, friction, false);
}

int JointDraft::finish() {
  if (needs_world_) add_world();
  ObjectJoint joint;
  joint.name = name_;
  joint.kind = kind_;
  joint.a = a_.body;
  joint.b = b_.body;
  joint.anchor = convert<float>(b_.local(anchor_));
  joint.anchor_a = convert<float>(a_.local(anchor_));
  joint.axes_a = convert<float>(a_.local(axes_));
  joint.axes_b = convert<float>(b_.local(axes_));
  joint.break_force = std::isinf(options_.break_force) ? 0 : options_.break_force;
  joint.break_torque = std::isinf(options_.break_torque) ? 0 : options_.break_torque;
  for (const Part& part : parts_) {
    const std::size_t number = group_for(object_, part.type, part.stiffness, part.plasticity);
    ConstraintGroup& group = object_.constraints[number];
    joint.constraints.push_back(
        {static_cast<int>(number), static_cast<int>(group.particles.size() / part.slots.size())});
    group.particles.insert(group.particles.end(), part.slots.begin(), part.slots.end());
    group.rest.insert(group.rest.end(), part.rest.begin(), part.rest.end());
  }
  joint.motors = motors_;
  object_.joints.push_back(std::move(joint));
  return static_cast<int>(object_.joints.size()) - 1;
}

}  // namespace pliant
