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
  std::string name;
  int point = 0, frame = 0;                 ///< of body b: storage index, and index among the object's frames
  Vec3f anchor{};                           ///< in the principal axes of b, about its centre of mass [m]
  float break_force = 0, break_torque = 0;  ///< [N], [N m]; 0: no limit
  std::vector<Part> parts;

  bool may_break() const { return break_force > 0 || break_torque > 0; }
};

/// Compiles the joints of an object whose constraints are compiled. Throws an Error if a joint names a body or a constraint that
/// does not exist.
std::vector<CompiledJoint> compile_joints(const Object& object, const CompiledObject& compiled);

}  // namespace pliant
