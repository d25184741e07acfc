// A robot description in URDF as plain data, in its own units and axes: z points up, angles are in radians.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pliant/vec3.h"

namespace pliant::urdf {

/// A pose in a parent frame.
struct Pose {
  Vec3f position{};
  Quatf rotation{};
};

struct Geometry {
  enum class Kind { box, cylinder, sphere, capsule, mesh };
  Kind kind = Kind::box;
  Vec3f size{};  ///< of a box: its sizes; else radius and length (x, y), along z [m]
  std::string file;
  Vec3f scale{1, 1, 1};
  Pose origin{};
  int line = 0;
};

struct Inertial {
  float mass = 0;
  Pose origin{};
  Vec3f moments{}, products{};  ///< Ixx, Iyy, Izz; Iyz, Izx, Ixy in the frame of `origin`
  int line = 0;
};

struct Link {
  std::string name;
  std::optional<Inertial> inertial;
  std::vector<Geometry> visual, collision;
  std::optional<Vec3f> colour;  ///< of the first visual that has one, as in the file
  int line = 0;
};

struct Joint {
  std::string name, type, parent, child;
  Pose origin{};
  Vec3f axis{1, 0, 0};
  float lower = 0, upper = 0, velocity = 0, friction = 0, damping = 0;
  std::optional<float> effort{};  ///< greatest torque [N m] or force [N] of its motor
  std::string mimics;  ///< the joint that it follows: its position is that one's times `multiplier` plus `offset`
  float multiplier = 1, offset = 0;
  bool has_limit = false;
  int line = 0;
};

struct Robot {
  std::string name;
  std::vector<Link> links;
  std::vector<Joint> joints;
};

/// True of a joint that a motor can move to a target: revolute or continuous [rad], or prismatic [m].
inline bool has_target(const Joint& joint) {
  return joint.type == "revolute" || joint.type == "continuous" || joint.type == "prismatic";
}

/// Reads a file. Throws an Error with file and line if it is no XML, or what it says is no URDF. Elements and
/// attributes that are ignored are named in `warnings`, each kind once.
Robot read(const std::string& path, std::vector<std::string>& warnings);
/// Reads the bytes of a file. `name` stands for it.
Robot parse(std::string_view bytes, const std::string& name, std::vector<std::string>& warnings);

}  // namespace pliant::urdf
