// Makes the constraints of each kind of joint (pliant/joint.h).
#include "pliant/joint.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "constraints/joint_rows.h"
#include "matter/joint_draft.h"

namespace pliant {

namespace {

double distance(const Vec3d& a, const Vec3d& b) { return std::sqrt(length_squared(b - a)); }

/// Sets the joint frame with `axis` as its x-axis.
void set_axis(JointDraft& draft, const Vec3f& anchor, const Vec3f& axis, const char* name = "axis") {
  draft.set_frame(draft.place(anchor, "anchor"), rotation_from_x(draft.direction(axis, name)));
}

/// The joint frame of a planar joint: x is the normal, y is axis_x.
void set_plane(JointDraft& draft, const PlanarJoint& joint) {
  if (!joint.axis_x) {
    if (joint.x_limit || joint.y_limit || joint.x_motor || joint.y_motor || joint.x_spring || joint.y_spring)
      draft.refuse("has limits, motors or springs in its plane, but no axis_x", "give the direction of x");
    set_axis(draft, joint.anchor, joint.normal, "normal");
    return;
  }
  const Vec3d normal = draft.direction(joint.normal, "normal"), x = draft.direction(*joint.axis_x, "axis_x");
  if (std::fabs(dot(normal, x)) > 1e-3)
    draft.refuse("has an axis_x that is not in its plane", "give one perpendicular to `normal`");
  draft.set_frame(draft.place(joint.anchor, "anchor"), rotation_from_xy(normal, x));
}

std::vector<int> slots_of(const JointDraft& draft) {
  return {draft.a().point, draft.a().frame, draft.b().point, draft.b().frame};
}

std::string in_metres(float length) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g m", static_cast<double>(length));
  return text;
}

/// Adds a joint_distance between two anchors.
void add_distance(JointDraft& draft, const Vec3d& a, const Vec3d& b, float least, float most, float compliance,
                  float damping) {
  std::vector<float> rest;
  append(draft.a().local(a), rest);
  append(draft.b().local(b), rest);
  rest.insert(rest.end(), {least, most});
  draft.set_frame(b, {});
  draft.add_raw("joint_distance", slots_of(draft), rest, compliance, damping);
}

}  // namespace

int add_joint(Object& object, const BallJoint& joint) {
  JointDraft draft(object, "ball", joint.a, joint.b, joint.options);
  set_axis(draft, joint.anchor, joint.axis);
  draft.lock("ball_joint");
  if (joint.most_swing) {
    draft.require(*joint.most_swing, "greatest swing [rad]", 0, 3);
    draft.add("joint_swing", 0, {*joint.most_swing}, 0);
  }
  if (joint.twist) draft.limit_angle(0, *joint.twist);
  for (int axis = 0; axis < 3; ++axis) draft.drive_angle(axis, {}, joint.friction);
  return draft.finish();
}

int add_joint(Object& object, const FixedJoint& joint) {
  JointDraft draft(object, "fixed", joint.a, joint.b, joint.options);
  draft.set_frame(draft.place(joint.anchor, "anchor"), {});
  draft.lock("fixed_joint");
  return draft.finish();
}

int add_joint(Object& object, const HingeJoint& joint) {
  JointDraft draft(object, "hinge", joint.a, joint.b, joint.options);
  set_axis(draft, joint.anchor, joint.axis);
  draft.lock("hinge_joint");
  if (joint.limit) draft.limit_angle(0, *joint.limit);
  draft.drive_angle(0, joint.motor, joint.friction);
  draft.damp_angle(0, joint.damping);
  draft.spring_angle(0, joint.spring);
  return draft.finish();
}

int add_joint(Object& object, const SliderJoint& joint) {
  JointDraft draft(object, "slider", joint.a, joint.b, joint.options);
  set_axis(draft, joint.anchor, joint.axis);
  draft.lock("slider_joint");
  if (joint.limit) draft.limit_offset(0, *joint.limit);
  draft.drive_offset(0, joint.motor, joint.friction);
  draft.damp_offset(0, joint.damping);
  draft.spring_offset(0, joint.spring);
  return draft.finish();
}

int add_joint(Object& object, const CylindricalJoint& joint) {
  JointDraft draft(object, "cylindrical", joint.a, joint.b, joint.options);
  set_axis(draft, joint.anchor, joint.axis);
  draft.lock("cylindrical_joint");
  if (joint.slide_limit) draft.limit_offset(0, *joint.slide_limit);
  if (joint.turn_limit) draft.limit_angle(0, *joint.turn_limit);
  draft.drive_offset(0, joint.slide_motor, joint.slide_friction, "slide_motor");
  draft.drive_angle(0, joint.turn_motor, joint.turn_friction, "turn_motor");
  draft.spring_offset(0, joint.slide_spring);
  draft.spring_angle(0, joint.turn_spring);
  return draft.finish();
}

int add_joint(Object& object, const UniversalJoint& joint) {
  JointDraft draft(object, "universal", joint.a, joint.b, joint.options);
  const Vec3d x = draft.direction(joint.axis_a, "axis_a"), y = draft.direction(joint.axis_b, "axis_b");
  if (std::fabs(dot(x, y)) > 1e-3)
    draft.refuse("has axes that are not perpendicular", "give two axes at a right angle");
  draft.set_frame(draft.place(joint.anchor, "anchor"), rotation_from_xy(x, y));
  draft.lock("universal_joint");
  // x of a and y of b stay perpendicular, so the rotation of b against a is one about x and then one about y; the
  // twists about x and y (joint_rows.h) are these two angles.
  if (joint.limit_a) draft.limit_angle(0, *joint.limit_a);
  if (joint.limit_b) draft.limit_angle(1, *joint.limit_b);
  draft.drive_angle(0, joint.motor_a, joint.friction_a, "motor_a");
  draft.drive_angle(1, joint.motor_b, joint.friction_b, "motor_b");
  draft.spring_angle(0, joint.spring_a);
  draft.spring_angle(1, joint.spring_b);
  return draft.finish();
}

int add_joint(Object& object, const PlanarJoint& joint) {
  JointDraft draft(object, "planar", joint.a, joint.b, joint.options);
  set_plane(draft, joint);
  draft.lock("planar_joint");
  if (joint.x_limit) draft.limit_offset(1, *joint.x_limit);
  if (joint.y_limit) draft.limit_offset(2, *joint.y_limit);
  if (joint.turn_limit) draft.limit_angle(0, *joint.turn_limit);
  draft.drive_offset(1, joint.x_motor, joint.slide_friction, "x_motor");
  draft.drive_offset(2, joint.y_motor, joint.slide_friction, "y_motor");
  draft.drive_angle(0, joint.turn_motor, joint.turn_friction, "turn_motor");
  draft.spring_offset(1, joint.x_spring);
  draft.spring_offset(2, joint.y_spring);
  draft.spring_angle(0, joint.turn_spring);
  return draft.finish();
}

int add_joint(Object& object, const DistanceJoint& joint) {
  JointDraft draft(object, "distance", joint.a, joint.b, joint.options);
  const Vec3d a = draft.place(joint.anchor_a, "anchor_a"), b = draft.place(joint.anchor_b, "anchor_b");
  const bool is_kept = !joint.least && !joint.most;
  const auto now = static_cast<float>(distance(a, b));
  const float least = is_kept ? now : joint.least.value_or(0),
              most = is_kept ? now : joint.most.value_or(joint::no_limit);
  draft.require(least, "least distance [m]", 0);
  if (least > most)
    draft.refuse("has a least distance of " + in_metres(least) + ", more than its greatest of " + in_metres(most),
                 "give 'most' at least as large as 'least'");
  draft.require(most, "greatest distance [m]", 0);
  add_distance(draft, a, b, least, most, joint.options.compliance, joint.options.damping);
  return draft.finish();
}

int add_joint(Object& object, const SpringJoint& joint) {
  JointDraft draft(object, "spring", joint.a, joint.b, joint.options);
  const Vec3d a = draft.place(joint.anchor_a, "anchor_a"), b = draft.place(joint.anchor_b, "anchor_b");
  const float length = joint.rest_length.value_or(static_cast<float>(distance(a, b)));
  draft.require(length, "rest_length", 0);
  draft.require(joint.stiffness, "stiffness", 1e-20f, 1e20f);
  draft.require(joint.damping, "damping", 0);
  add_distance(draft, a, b, length, length, 1 / joint.stiffness, joint.damping);
  return draft.finish();
}

int add_joint(Object& object, const PulleyJoint& joint) {
  JointDraft draft(object, "pulley", joint.a, joint.b, joint.options);
  const JointBody third = draft.third(joint.carrier);
  const Vec3d a = draft.place(joint.anchor_a, "anchor_a"), b = draft.place(joint.anchor_b, "anchor_b"),
              pulley_a = draft.place(joint.pulley_a, "pulley_a"), pulley_b = draft.place(joint.pulley_b, "pulley_b");
  draft.require(joint.ratio, "ratio", 1e-6f, 1e6f);
  std::vector<float> rest;
  append(draft.a().local(a), rest);
  append(draft.b().local(b), rest);
  append(third.local(pulley_a), rest);
  append(third.local(pulley_b), rest);
  const double length = distance(a, pulley_a) + static_cast<double>(joint.ratio) * distance(b, pulley_b);
  rest.insert(rest.end(), {joint.ratio, static_cast<float>(length)});
  std::vector<int> slots = slots_of(draft);
  slots.insert(slots.end(), {third.point, third.frame});
  draft.set_frame(b, {});
  draft.add_raw("pulley_joint", slots, rest, joint.options.compliance, joint.options.damping);
  return draft.finish();
}

int add_joint(Object& object, const GearJoint& joint) {
  JointDraft draft(object, "gear", joint.a, joint.b, joint.options);
  const JointBody third = draft.third(joint.carrier);
  const Quatd a = rotation_from_x(draft.direction(joint.axis_a, "axis_a")),
              b = rotation_from_x(draft.direction(joint.axis_b, "axis_b"));
  if (joint.teeth_a == 0 || joint.teeth_b == 0) draft.refuse("has a gear without teeth", "give a number that is not 0");
  std::vector<float> rest;
  append(draft.a().local(a), rest);
  append(draft.b().local(b), rest);
  append(third.local(a), rest);
  append(third.local(b), rest);
  rest.insert(rest.end(), {static_cast<float>(joint.teeth_a), static_cast<float>(joint.teeth_b)});
  draft.set_frame(draft.b().pose.position, {});
  draft.add_raw("gear_joint", {draft.a().frame, draft.b().frame, third.frame}, rest, joint.options.compliance,
                joint.options.damping);
  return draft.finish();
}

int add_joint(Object& object, const RackJoint& joint) {
  JointDraft draft(object, "rack", joint.pinion, joint.rack, joint.options);
  const JointBody third = draft.third(joint.carrier);
  const Quatd axes = rotation_from_x(draft.direction(joint.axis, "axis"));
  const Vec3d u = draft.direction(joint.direction, "direction");
  draft.require(joint.radius, "radius", 1e-6f, 1e6f);
  const double start = dot(u, draft.b().pose.position - third.pose.position);
  std::vector<float> rest;
  append(draft.a().local(axes), rest);
  append(third.local(axes), rest);
  append(rotate(conjugate(third.pose.rotation), u), rest);
  rest.insert(rest.end(), {static_cast<float>(start), joint.radius});
  draft.set_frame(draft.b().pose.position, {});
  draft.add_raw("rack_joint", {draft.a().frame, draft.b().point, third.point, third.frame}, rest,
                joint.options.compliance, joint.options.damping);
  return draft.finish();
}

namespace {

using Freedoms = std::array<AxisFreedom, 3>;

bool all_locked(const Freedoms& axes) {
  return std::all_of(axes.begin(), axes.end(),
                     [](const AxisFreedom& f) { return f.kind == AxisFreedom::Kind::locked; });
}

JointRange range_of(const AxisFreedom& freedom, const JointOptions& options) {
  return freedom.kind == AxisFreedom::Kind::locked ? JointRange{0, 0, options.compliance} : freedom.limit;
}

}  // namespace

int add_joint(Object& object, const SixAxisJoint& joint) {
  JointDraft draft(object, "six_axis", joint.a, joint.b, joint.options);
  const Quatd axes = convert<double>(joint.axes);
  const double size = dot(axes, axes);
  if (!(size > 0.9 && size < 1.1))
    draft.refuse("has axes that are no unit quaternion", "give x, y, z, w of length one");
  draft.set_frame(draft.place(joint.anchor, "anchor"), normalise(axes));
  const bool has_place = all_locked(joint.linear), has_rotation = all_locked(joint.angular);
  if (has_place) draft.lock(has_rotation ? "fixed_joint" : "ball_joint");
  constexpr const char *linear_motors[3] = {"linear_x", "linear_y", "linear_z"},
                       *angular_motors[3] = {"angular_x", "angular_y", "angular_z"};
  for (int axis = 0; axis < 3; ++axis) {
    const AxisFreedom &along = joint.linear[static_cast<std::size_t>(axis)],
                      &about = joint.angular[static_cast<std::size_t>(axis)];
    if (!has_place && along.kind != AxisFreedom::Kind::free) draft.limit_offset(axis, range_of(along, joint.options));
    if (!(has_place && has_rotation) && about.kind != AxisFreedom::Kind::free)
      draft.limit_angle(axis, range_of(about, joint.options));
    draft.drive_offset(axis, along.motor, along.friction, linear_motors[axis]);
    draft.drive_angle(axis, about.motor, about.friction, angular_motors[axis]);
    draft.spring_offset(axis, along.spring);
    draft.spring_angle(axis, about.spring);
  }
  return draft.finish();
}

}  // namespace pliant
