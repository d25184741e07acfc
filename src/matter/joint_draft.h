// A joint while it is made: its parts are collected, and added to the object only when all numbers are known to be
// right.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "constraints/joint_rows.h"
#include "math/quat.h"
#include "pliant/joint.h"

namespace pliant {

/// A body to which a joint is fixed. The world has the pose of the origin.
struct JointBody {
  int body = -1;             ///< index in Object::bodies
  int point = 0, frame = 0;  ///< indices in Object::positions and Object::frames
  Posed pose{};              ///< of its centre of mass and principal axes at time 0

  Vec3d local(const Vec3d& place) const { return to_local(pose, place); }
  Quatd local(const Quatd& axes) const { return normalise(multiply(conjugate(pose.rotation), axes)); }
};

/// Appends a vector or a quaternion to rest data.
void append(const Vec3d& v, std::vector<float>& to);
void append(const Quatd& q, std::vector<float>& to);

class JointDraft {
 public:
  /// Throws an Error if a body does not exist, if a and b are the same or both fixed, or if an option is wrong.
  JointDraft(Object& object, std::string kind, int a, int b, const JointOptions& options);

  const JointBody& a() const { return a_; }
  const JointBody& b() const { return b_; }
  /// A third body, which must differ from a and b.
  JointBody third(int body) const;

  [[noreturn]] void refuse(const std::string& problem, const std::string& advice) const;
  /// Refuses a number that is not finite, or not within the bounds.
  void require(float value, const char* name, float least, float most = unlimited, bool may_be_infinite = false) const;
  /// A finite vector as a unit vector.
  Vec3d direction(const Vec3f& axis, const char* name) const;
  Vec3d place(const Vec3f& at, const char* name) const;

  /// Where the joint is fixed, for the rest data of the following parts. `axes` is the joint frame in the world.
  void set_frame(const Vec3d& anchor, const Quatd& axes);
  const Vec3d& anchor() const { return anchor_; }

  /// Adds a constraint between a and b in the joint frame with its axes exchanged so that `axis` (0, 1, 2) is its
  /// x-axis. `more` follows the places in the rest data.
  void add(const char* type, int axis, const std::vector<float>& more, float compliance, float damping = 0);
  /// Adds the constraint that holds the bodies together, with the compliance of the options.
  void lock(const char* type) { add(type, 0, {}, options_.compliance, options_.damping); }
  /// Adds a constraint of any slots and rest data.
  void add_raw(const char* type, const std::vector<int>& slots, const std::vector<float>& rest, float compliance,
               float damping = 0, const std::optional<Plasticity>& plasticity = {});

  void limit_angle(int axis, const JointRange& range);
  void limit_offset(int axis, const JointRange& range);
  /// A motor and friction. `name` is that of the motor, by which users set its target.
  void drive_angle(int axis, const std::optional<JointMotor>& motor, float friction, const char* name = "motor");
  void drive_offset(int axis, const std::optional<JointMotor>& motor, float friction, const char* name = "motor");
  /// A spring with a damper, if there is one.
  void spring_angle(int axis, const std::optional<JointSpring>& spring);
  void spring_offset(int axis, const std::optional<JointSpring>& spring);
  /// A viscous damper [N m s/rad; N s/m].
  void damp_angle(int axis, float damping) { add_damper("joint_angle_motor", axis, damping, true); }
  void damp_offset(int axis, float damping) { add_damper("joint_offset_motor", axis, damping, false); }

  const JointOptions& options() const { return options_; }
  /// Adds everything to the object. Returns the index of the joint.
  int finish();

 private:
  struct Part {
    std::string type;
    std::vector<int> slots;
    std::vector<float> rest;
    Stiffness stiffness;
    std::optional<Plasticity> plasticity;
  };
  JointBody find(int body) const;
  JointBody world() const;
  void add_world();
  void require_spring(const JointSpring& spring) const;
  void require_keyframes(const JointMotor& motor) const;
  void require_range(const JointRange& range, bool is_angle) const;
  void add_motor(const char* type, int axis, const JointMotor& motor, const char* name, bool is_angle);
  void add_friction(const char* type, int axis, float friction, bool is_angle);
  void add_damper(const char* type, int axis, float damping, bool is_angle);

  Object& object_;
  std::string kind_, name_;
  JointOptions options_;
  JointBody a_, b_;
  Vec3d anchor_{};
  Quatd axes_{};
  std::vector<Part> parts_;
  std::vector<ObjectJointMotor> motors_;
  std::array<float, 3> middles_{joint::no_limit, joint::no_limit,
                                joint::no_limit};  ///< of the ranges of angles, by axis [rad]
  mutable bool needs_world_ = false;
};

/// The shortest rotation from x to a unit vector.
Quatd rotation_from_x(const Vec3d& axis);

/// The rotation that takes x to `x`, and y to where `y` points beside it. Both are unit vectors.
Quatd rotation_from_xy(const Vec3d& x, const Vec3d& y);

/// An angle modulo a full turn, between -pi and pi [rad].
double principal_angle(double angle);

}  // namespace pliant
