// Joints between the rigid bodies of one object: ball, hinge, slider and others, with limits, motors, friction and
// breaking.
//
//   const int door = add_body(object, {{.shape = Box{{0.4f, 1, 0.02f}}}}, {.position = {0.4f, 1, 0}});
//   add_joint(object, HingeJoint{.b = door, .anchor = {0, 1, 0}, .axis = {0, 1, 0}, .limit = JointRange{0, 1.5f}});
//
// Anchors and axes are in world coordinates at time 0. A body is an index in Object::bodies; -1 is the world, for which
// the first such joint adds a fixed body. An angle or displacement is that of body b relative to body a; it is 0 at
// time 0 and positive as a rotation about the axis, or along it. A joint becomes constraints of the object
// (Object::constraints), listed in Object::joints. All functions throw an Error that names the joint if a number is
// wrong, and then change nothing.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "pliant/scene.h"

namespace pliant {

/// Stands for "no limit" where a joint has a greatest force, torque, speed or a breaking load.
inline constexpr float unlimited = std::numeric_limits<float>::infinity();

/// What all joints have.
struct JointOptions {
  std::string name{};              ///< empty: "hinge 3", the kind and its index in Object::joints
  float compliance = 0;            ///< of the locked directions, 0: rigid [m/N and rad/(N m)]
  float damping = 0;               ///< of the locked directions; only with compliance [N s/m and N m s/rad]
  float break_force = unlimited;   ///< the joint breaks where it carries a greater force [N]
  float break_torque = unlimited;  ///< or a greater torque about its anchor [N m]
};

/// The range in which an angle [rad] or a displacement [m] stays. Both ends of an angle are within one turn.
struct JointRange {
  float low = 0, high = 0;
  float compliance = 0;  ///< of the stops, 0: rigid [rad/(N m) or m/N]
};

/// Drives an angle or a displacement. `speed`: at the speed `target` [rad/s or m/s]. `position`: towards `target` [rad
/// or m], at the remaining distance times `rate`, at most `most_speed`. `torque`: by the torque or force `target` [N m
/// or N].
struct JointMotor {
  enum class Kind { speed, position, torque };
  Kind kind = Kind::speed;
  float target = 0;
  float most = 1;                ///< greatest torque [N m] or force [N], > 0; no meaning for `torque`
  float rate = 10;               ///< of `position`, > 0 [1/s]
  float most_speed = unlimited;  ///< of `position`, > 0 [rad/s or m/s]
  /// The target by time instead of `target`: linear between keyframes, constant outside, until set_motor gives another.
  /// A frame has the target of its end.
  std::vector<MotorKeyframe> keyframes{};
};

/// Pulls an angle or a displacement towards `rest`, with a damper beside it.
struct JointSpring {
  float rest = 0;       ///< [rad or m]; angles within half a turn
  float stiffness = 1;  ///< torque over angle [N m/rad] or force over displacement [N/m], > 0
  float damping = 0;    ///< torque over angular velocity [N m s/rad] or force over speed [N s/m], >= 0
};

/// The two bodies share a point. `axis` is fixed in both: its angle between them is the swing, the turn about it the
/// twist.
struct BallJoint {
  int a = -1, b = 0;
  Vec3f anchor{};
  Vec3f axis{1, 0, 0};
  std::optional<float> most_swing{};  ///< 0..3 [rad]
  std::optional<JointRange> twist{};  ///< [rad]
  float friction = 0;                 ///< greatest torque about each axis [N m]
  JointOptions options{};
};

/// The two bodies move as one.
struct FixedJoint {
  int a = -1, b = 0;
  Vec3f anchor{};
  JointOptions options{};
};

/// One axis about which b rotates.
struct HingeJoint {
  int a = -1, b = 0;
  Vec3f anchor{};
  Vec3f axis{0, 0, 1};
  std::optional<JointRange> limit{};  ///< [rad]
  std::optional<JointMotor> motor{};
  float friction = 0;  ///< greatest torque [N m]
  JointOptions options{};
  float damping = 0;  ///< torque over angular velocity, >= 0 [N m s/rad]
  std::optional<JointSpring> spring{};
};

/// One axis along which b slides; b does not rotate against a.
struct SliderJoint {
  int a = -1, b = 0;
  Vec3f anchor{};
  Vec3f axis{1, 0, 0};
  std::optional<JointRange> limit{};  ///< [m]
  std::optional<JointMotor> motor{};
  float friction = 0;  ///< greatest force [N]
  JointOptions options{};
  float damping = 0;  ///< force over speed, >= 0 [N s/m]
  std::optional<JointSpring> spring{};
};

/// One axis along which b slides and about which it rotates.
struct CylindricalJoint {
  int a = -1, b = 0;
  Vec3f anchor{};
  Vec3f axis{1, 0, 0};
  std::optional<JointRange> slide_limit{}, turn_limit{};  ///< [m], [rad]
  std::optional<JointMotor> slide_motor{}, turn_motor{};
  float slide_friction = 0, turn_friction = 0;  ///< greatest force [N], greatest torque [N m]
  JointOptions options{};
  std::optional<JointSpring> slide_spring{}, turn_spring{};
};

/// Two axes that stay perpendicular and cross at the anchor: one fixed in a, one in b. The angle about each is that of
/// the cross against a, and of b against the cross. Where one is half a turn, the other is not measured well.
struct UniversalJoint {
  int a = -1, b = 0;
  Vec3f anchor{};
  Vec3f axis_a{1, 0, 0}, axis_b{0, 1, 0};
  std::optional<JointRange> limit_a{}, limit_b{};  ///< of the angles about axis_a and axis_b [rad]
  std::optional<JointMotor> motor_a{}, motor_b{};
  float friction_a = 0, friction_b = 0;  ///< greatest torque about each axis [N m]
  JointOptions options{};
  std::optional<JointSpring> spring_a{}, spring_b{};
};

/// b slides in a plane fixed in a, and rotates about its normal.
struct PlanarJoint {
  int a = -1, b = 0;
  Vec3f anchor{};
  Vec3f normal{0, 1, 0};
  /// Direction x in the plane, needed for limits and motors of x and y; y is normal x axis_x.
  std::optional<Vec3f> axis_x{};
  std::optional<JointRange> x_limit{}, y_limit{}, turn_limit{};  ///< of the displacements [m], of the angle [rad]
  std::optional<JointMotor> x_motor{}, y_motor{}, turn_motor{};
  float slide_friction = 0, turn_friction = 0;  ///< greatest force along x and along y [N], greatest torque [N m]
  JointOptions options{};
  std::optional<JointSpring> x_spring{}, y_spring{}, turn_spring{};
};

/// Two anchors keep their distance, or stay between two distances, as a rod or a rope does.
struct DistanceJoint {
  int a = -1, b = 0;
  Vec3f anchor_a{}, anchor_b{};
  std::optional<float> least{},
      most{};  ///< [m]; without both, the distance at time 0 is kept; without `most`: no upper bound
  JointOptions options{};
};

/// A spring between two anchors, with a damper beside it.
struct SpringJoint {
  int a = -1, b = 0;
  Vec3f anchor_a{}, anchor_b{};
  std::optional<float> rest_length{};  ///< [m]; the distance at time 0 if left out
  float stiffness = 1000;              ///< > 0 [N/m]
  float damping = 0;                   ///< [N s/m]
  JointOptions options{};              ///< without its compliance and damping
};

/// A rope from a over two pulleys to b: |anchor_a - pulley_a| + ratio |anchor_b - pulley_b| does not grow.
struct PulleyJoint {
  int a = 0, b = 1;
  Vec3f anchor_a{}, anchor_b{};
  Vec3f pulley_a{}, pulley_b{};
  float ratio = 1;   ///< > 0; of a tackle: the force on b over that on a
  int carrier = -1;  ///< body that has the pulleys
  JointOptions options{};
};

/// Two bodies rotate about axes fixed in a third: teeth_a times a's angle plus teeth_b times b's stays the same. Add
/// the hinges as joints of their own.
struct GearJoint {
  int a = 0, b = 1;
  Vec3f axis_a{0, 0, 1}, axis_b{0, 0, 1};
  int teeth_a = 1, teeth_b = 1;  ///< not 0; signs that differ: an inner gear or a belt, which turns b like a
  int carrier = -1;              ///< body in which both axes are fixed
  JointOptions options{};
};

/// A pinion that rotates about an axis moves a rack by its radius times its angle. Add the hinge of the pinion and the
/// slider of the rack as joints of their own.
struct RackJoint {
  int pinion = 0, rack = 1;
  Vec3f axis{0, 0, 1};       ///< of the pinion
  Vec3f direction{1, 0, 0};  ///< in which the rack moves as the pinion rotates by a positive angle
  float radius = 0.1f;       ///< of the pinion, > 0 [m]
  int carrier = -1;          ///< body in which axis and direction are fixed
  JointOptions options{};
};

/// What a six-axis joint permits along, or about, one axis.
struct AxisFreedom {
  enum class Kind { free, locked, limited };
  Kind kind = Kind::locked;
  JointRange limit{};  ///< of a limited axis [m or rad]
  std::optional<JointMotor> motor{};
  float friction = 0;  ///< greatest force [N] or torque [N m]
  std::optional<JointSpring> spring{};
};

/// Six freedoms: displacements along three axes fixed in a, and rotations about them (the twist of b about each).
struct SixAxisJoint {
  int a = -1, b = 0;
  Vec3f anchor{};
  Quatf axes{};                          ///< unit quaternion; its x, y and z axes are those of the joint
  std::array<AxisFreedom, 3> linear{};   ///< along x, y, z
  std::array<AxisFreedom, 3> angular{};  ///< about x, y, z
  JointOptions options{};
};

/// Adds a joint to an object and returns its index in Object::joints.
int add_joint(Object& object, const BallJoint& joint);
int add_joint(Object& object, const FixedJoint& joint);
int add_joint(Object& object, const HingeJoint& joint);
int add_joint(Object& object, const SliderJoint& joint);
int add_joint(Object& object, const CylindricalJoint& joint);
int add_joint(Object& object, const UniversalJoint& joint);
int add_joint(Object& object, const PlanarJoint& joint);
int add_joint(Object& object, const DistanceJoint& joint);
int add_joint(Object& object, const SpringJoint& joint);
int add_joint(Object& object, const PulleyJoint& joint);
int add_joint(Object& object, const GearJoint& joint);
int add_joint(Object& object, const RackJoint& joint);
int add_joint(Object& object, const SixAxisJoint& joint);

}  // namespace pliant
