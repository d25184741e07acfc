// The joints of a compiled object: which constraints each consists of, and at which load it breaks.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "pliant/scene.h"

namespace pliant {

struct CompiledObject;

struct CompiledJoint {
  /// A constraint of the joint.
  struct Part {
    int pool = 0;
    std::int64_t batch = 0;
    int lane = 0;
    std::array<std::int32_t, 8> slots{};  ///< storage indices; frames come after all particles
  };
  struct Motor {
    std::string name;
    std::size_t part = 0;  ///< index in `parts`
    bool is_angle = false, to_position = false, is_torque = false;
    float target = 0, most = 0;  ///< as described: [rad, m, rad/s, m/s, N m or N], [N m or N]
    std::vector<MotorKeyframe> keyframes;
  };
  /// How the joint is fixed in one of its bodies.
  struct Side {
    int point = 0, frame = 0;  ///< storage index, and index among the object's frames
    Vec3f anchor{};            ///< in the principal axes of the body, about its centre of mass [m]
    Quatf axes{};              ///< of the joint, in those axes
  };
  std::string name;
  int point = 0, frame = 0;                 ///< of body b: storage index, and index among the object's frames
  Vec3f anchor{};                           ///< in the principal axes of b, about its centre of mass [m]
  float break_force = 0, break_torque = 0;  ///< [N], [N m]; 0: no limit
  std::vector<Part> parts;
  std::vector<Motor> motors;
  Side a{}, b{};

  bool may_break() const { return break_force > 0 || break_torque > 0; }
};

/// Compiles the joints of an object whose constraints are compiled. Throws an Error if a joint names a body or a
/// constraint that does not exist.
std::vector<CompiledJoint> compile_joints(const Object& object, const CompiledObject& compiled);

/// Sets the target and the greatest torque or force of a motor in the rest data. An angle counts modulo a full turn.
void set_motor(CompiledObject& object, const CompiledJoint& joint, const CompiledJoint::Motor& motor, float target,
               float most);

}  // namespace pliant
