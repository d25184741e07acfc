// Builds elastic rods in scene files.
#include "pliant/rod.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "scene_build.h"
#include "scene_grammar.h"
#include "scene_mesh.h"
#include "scene_values.h"

namespace pliant::scene_file {

namespace {

RodMaterial material_of(const JsonDocument& document, const JsonValue& at) {
  if (at.kind == JsonValue::Kind::string) return rod_material(at.text);
  RodMaterial material;
  if (const JsonValue* base = at.find("base")) material = rod_material(base->text);
  set(at, "name", material.name);
  set(at, "source", material.source);
  set(at, "density", material.density);
  set(at, "youngs_modulus", material.youngs_modulus);
  set(at, "shear_modulus", material.shear_modulus);
  set(at, "damping", material.damping);
  set_friction(document, at, material.static_friction, material.kinetic_friction);
  set(at, "plasticity", material.plasticity);
  set(at, "bending_share", material.bending_share);
  return material;
}

RodStiffness stiffness_of(const JsonValue& at) {
  RodStiffness stiffness;
  set(at, "stretch", stiffness.stretch);
  set(at, "shear", stiffness.shear);
  set(at, "bending", stiffness.bending);
  set(at, "bending_2", stiffness.bending_2);
  set(at, "twist", stiffness.twist);
  return stiffness;
}

std::vector<Vec3f> points_of(const JsonDocument& document, const JsonValue& at) {
  std::vector<Vec3f> points;
  for (const JsonValue& point : elements(at, "points")) points.push_back(vector_of(point));
  if (const JsonValue* line = at.find("line")) points = line_points(*line);
  if (const JsonValue* coil = at.find("helix")) {
    float radius = 0, height = 0, turns = 0;
    int segments = 0;
    set(*coil, "radius", radius);
    set(*coil, "height", height);
    set(*coil, "turns", turns);
    set(*coil, "segments", segments);
    points = helix(radius, height, turns, segments);
  }
  place(document, at, points);
  return points;
}

/// What holds an end: a body that the object has, or the world.
RodEnd end_of(const JsonDocument& document, const JsonValue& at, const char* name, const Object& object) {
  RodEnd end;
  const JsonValue* value = at.find(name);
  if (value == nullptr) return end;
  const JsonValue* clamp = value->find("clamped");
  const JsonValue& body = clamp != nullptr ? *clamp : *value->find("ball");
  end.kind = clamp != nullptr ? RodEnd::Kind::clamped : RodEnd::Kind::ball;
  if (body.text == "world") return end;
  if (object.bodies.empty())
    document.fail(body, "the object has no body '" + printable(body.text) + "'",
                  "name \"world\", or make the rod one of the `parts` of the object with that body");
  end.body = body_named(document, body, object);
  return end;
}

RodOptions options_of(const JsonDocument& document, const JsonValue& at, const std::string& name,
                      const Object& object) {
  RodOptions options;
  options.name = name;
  set(at, "name", options.name);
  if (const JsonValue* material = at.find("material")) options.material = material_of(document, *material);
  set(at, "radius", options.radius);
  set(at, "end_radius", options.end_radius);
  if (const JsonValue* stiffness = at.find("stiffness")) options.stiffness = stiffness_of(*stiffness);
  if (const JsonValue* across = at.find("across")) options.across = vector_of(*across);
  set(at, "straight", options.straight);
  options.start = end_of(document, at, "start", object);
  options.end = end_of(document, at, "end", object);
  set(at, "break_force", options.break_force);
  set(at, "break_torque", options.break_torque);
  return options;
}

constexpr double golden_angle = 137.50776405003785;  // [degrees]

/// Poses of copies that stand on a sphere about +y, evenly (a Fibonacci lattice).
std::vector<RigidPose> poses_on_cap(const JsonValue& at) {
  int count = 1;
  Vec3f centre;
  float radius = 1, degrees = 90;
  set(at, "count", count);
  set(at, "centre", centre);
  set(at, "radius", radius);
  set(at, "degrees", degrees);
  const float lowest = rotated(rotation({0, 0, 1}, degrees), {1, 0, 0}).x;
  std::vector<RigidPose> poses;
  for (int i = 0; i < count; ++i) {
    const float share = (static_cast<float>(i) + 0.5f) / static_cast<float>(count), y = 1 - (1 - lowest) * share;
    const float across = std::sqrt(std::fmax(0.f, 1 - y * y));
    const auto angle = static_cast<float>(std::fmod(golden_angle * i, 360.));
    const Vec3f out = rotated(rotation({0, 1, 0}, angle), {across, y, 0});
    // The shortest rotation from +y; straight down it is half a turn.
    const float norm = std::sqrt(std::fmax(0.f, 2 * (1 + y)));
    const Quatf turn = norm > 1e-4f ? Quatf{out.z / norm, 0, -out.x / norm, (1 + y) / norm} : Quatf{1, 0, 0, 0};
    poses.push_back({centre + radius * out, turn});
  }
  return poses;
}

std::vector<RigidPose> poses_on_grid(const JsonValue& at) {
  const std::vector<JsonValue>&counts = at.find("counts")->items, &spacing = at.find("spacing")->items;
  std::vector<RigidPose> poses;
  for (int z = 0; z < static_cast<int>(counts[1].number); ++z)
    for (int x = 0; x < static_cast<int>(counts[0].number); ++x)
      poses.push_back({{static_cast<float>(x * spacing[0].number), 0, static_cast<float>(z * spacing[1].number)}, {}});
  return poses;
}

/// Where copies stand; one pose that changes nothing if there are none.
std::vector<RigidPose> poses_of(const JsonDocument& document, const JsonValue& at, std::size_t segments) {
  const JsonValue* repeat = at.find("repeat");
  if (repeat == nullptr) return {RigidPose{}};
  const JsonValue *cap = repeat->find("cap"), *grid = repeat->find("grid");
  const double copies = cap != nullptr ? cap->find("count")->number
                                       : grid->find("counts")->items[0].number * grid->find("counts")->items[1].number;
  if (copies * static_cast<double>(segments) > largest_scene)
    document.fail(*repeat, "more than " + std::to_string(largest_scene) + " segments", "make fewer copies");
  return cap != nullptr ? poses_on_cap(*cap) : poses_on_grid(*grid);
}

/// Adds the rod of a record, or its copies.
void add_copies(const JsonDocument& document, const JsonValue& at, const RodOptions& options, Object& object) {
  const std::vector<Vec3f> points = points_of(document, at);
  const std::vector<RigidPose> poses = poses_of(document, at, points.size());
  RodOptions copy = options;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (at.find("repeat") != nullptr) copy.name = options.name + "_" + std::to_string(i);
    std::vector<Vec3f> moved = points;
    for (Vec3f& p : moved) p = rotated(poses[i].rotation, p) + poses[i].position;
    if (options.across) copy.across = rotated(poses[i].rotation, *options.across);
    add_rod(object, moved, copy);
  }
}

bool has_rod(const Object& object, const std::string& name) {
  return std::any_of(object.bodies.begin(), object.bodies.end(),
                     [&](const ObjectBody& body) { return body.name == name + " 0" || body.name == name + "_0 0"; });
}

}  // namespace

Object rod_of(const JsonDocument& document, const JsonValue& at, const std::string& name) {
  Object rod;
  rod.name = name;
  const RodOptions options = options_of(document, at, name, rod);
  rod.static_friction = options.material.static_friction;
  rod.kinetic_friction = options.material.kinetic_friction;
  add_copies(document, at, options, rod);
  return rod;
}

void add_rod_part(const JsonDocument& document, const JsonValue& at, Object& object) {
  std::string name = "rod";
  for (int number = 2; has_rod(object, name); ++number) name = "rod_" + std::to_string(number);
  try {
    add_copies(document, at, options_of(document, at, name, object), object);
  } catch (const Error& error) {
    if (!error.where().file.empty()) throw;
    Location where = document.locate(at);
    where.object = object.name;
    if (!error.where().element.empty()) where.element += ", " + error.where().element;
    throw Error(where, error.problem(), error.advice());
  }
}

}  // namespace pliant::scene_file
