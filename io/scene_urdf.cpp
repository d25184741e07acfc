// Builds an object of a scene file from a robot description.
#include <algorithm>

#include "pliant/io.h"
#include "scene_build.h"
#include "scene_hints.h"
#include "scene_mesh.h"
#include "scene_values.h"
#include "urdf_model.h"

namespace pliant::scene_file {

namespace {

std::map<std::string, float> targets_of(const JsonValue& at) {
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

/// Refuses a target that has no joint or one that no motor moves, and an angle where a joint slides.
void require_target(const JsonDocument& document, const JsonValue& item, const urdf::Robot& robot) {
  const JsonValue& name = *item.find("joint");
  const auto is_it = [&](const urdf::Joint& joint) { return joint.name == name.text; };
  const auto joint = std::find_if(robot.joints.begin(), robot.joints.end(), is_it);
  if (joint == robot.joints.end()) {
    std::vector<std::string> names;
    for (const urdf::Joint& one : robot.joints) names.push_back(one.name);
    const std::string near = nearest_name(name.text, names);
    document.fail(name, "the robot has no joint '" + printable(name.text) + "'",
                  near.empty() ? "name a joint of the file" : "did you mean '" + printable(near) + "'?");
  }
  const std::string called = "joint '" + printable(name.text) + "' is " + printable(joint->type);
  if (!has_target(*joint))
    document.fail(name, called + ", so no motor moves it to a target",
                  "remove the target; revolute, continuous and prismatic joints have motors");
  const bool slides = joint->type == "prismatic";
  const JsonValue* wrong = item.find(slides ? "angle" : "displacement");
  if (wrong != nullptr)
    document.fail(*wrong, called + ", so its target is " + (slides ? "a displacement" : "an angle"),
                  slides ? "give 'displacement' in metres" : "give 'angle' in degrees");
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
  const std::string path = allowed_path(document, *at.find("file"), folder);
  std::vector<std::string> warnings;
  const urdf::Robot description = urdf::read(path, warnings);
  for (const JsonValue& item : elements(at, "targets")) require_target(document, item, description);
  warnings.clear();
  Object robot = read_urdf(path, options, &warnings);
  for (const std::string& warning : warnings) repairs.push_back("robot '" + name + "', " + warning);
  robot.name = name;
  return robot;
}

}  // namespace pliant::scene_file
