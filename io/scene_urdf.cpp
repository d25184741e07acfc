// Builds an object of a scene file from a robot description.
#include <algorithm>

#include "pliant/io.h"
#include "scene_build.h"
#include "scene_mesh.h"
#include "scene_values.h"

namespace pliant::scene_file {

namespace {

std::map<std::string, float> targets_of(const JsonValue& at) {
  constexpr float radian = 0.017453292519943295f;  // per degree
  std::map<std::string, float> targets;
  for (const JsonValue& item : elements(at, "targets")) {
    std::string joint;
    float value = 0;
    set(item, "joint", joint);
    if (set(item, "angle", value)) value *= radian;
    set(item, "displacement", value);
    targets[joint] = value;
  }
  return targets;
}

/// Refuses a target that has no joint.
void require_joints(const JsonDocument& document, const JsonValue& at, const Object& robot) {
  for (const JsonValue& item : elements(at, "targets")) {
    const JsonValue& name = *item.find("joint");
    const auto is_it = [&](const ObjectJoint& joint) { return joint.name == name.text; };
    if (std::none_of(robot.joints.begin(), robot.joints.end(), is_it))
      document.fail(name, "the robot has no joint '" + printable(name.text) + "'", "name a joint of the file");
  }
}

}  // namespace

Object build_robot(const JsonDocument& document, const JsonValue& at, const std::string& name, const MeshFolder& folder,
                   std::vector<std::string>& repairs) {
  UrdfOptions options;
  set(at, "position", options.position);
  set(document, at, "rotation", options.rotation);
  set(at, "z_up", options.z_up);
  set(at, "fixed_base", options.fixed_base);
  set(at, "motors", options.motors);
  options.allow_outside = folder.allow_outside;
  options.targets = targets_of(at);
  std::vector<std::string> warnings;
  Object robot = read_urdf(allowed_path(document, *at.find("file"), folder), options, &warnings);
  for (const std::string& warning : warnings) repairs.push_back("object '" + name + "', " + warning);
  require_joints(document, at, robot);
  robot.name = name;
  return robot;
}

}  // namespace pliant::scene_file
