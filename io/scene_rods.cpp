// Builds elastic rods in scene files.
#include "pliant/rod.h"

#include <algorithm>
#include <string>

#include "scene_build.h"
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
  end.body = body.text == "world" ? -1 : body_named(document, body, object);
  return end;
}

RodOptions options_of(const JsonDocument& document, const JsonValue& at, const std::string& name, const Object& object) {
  RodOptions options;
  options.name = name;
  set(at, "name", options.name);
  if (const JsonValue* material = at.find("material")) options.material = material_of(document, *material);
  set(at, "radius", options.radius);
  if (const JsonValue* stiffness = at.find("stiffness")) options.stiffness = stiffness_of(*stiffness);
  if (const JsonValue* across = at.find("across")) options.across = vector_of(*across);
  set(at, "straight", options.straight);
  options.start = end_of(document, at, "start", object);
  options.end = end_of(document, at, "end", object);
  set(at, "break_force", options.break_force);
  set(at, "break_torque", options.break_torque);
  return options;
}

bool has_rod(const Object& object, const std::string& name) {
  return std::any_of(object.bodies.begin(), object.bodies.end(),
                     [&](const ObjectBody& body) { return body.name == name + " 0"; });
}

}  // namespace

Object rod_of(const JsonDocument& document, const JsonValue& at, const std::string& name) {
  Object none;
  none.name = name;
  Object rod = make_rod(points_of(document, at), options_of(document, at, name, none));
  rod.name = name;
  return rod;
}

void add_rod_part(const JsonDocument& document, const JsonValue& at, Object& object) {
  std::string name = "rod";
  for (int number = 2; has_rod(object, name); ++number) name = "rod_" + std::to_string(number);
  try {
    add_rod(object, points_of(document, at), options_of(document, at, name, object));
  } catch (const Error& error) {
    if (!error.where().file.empty()) throw;
    Location where = document.locate(at);
    where.object = object.name;
    if (!error.where().element.empty()) where.element += ", " + error.where().element;
    throw Error(where, error.problem(), error.advice());
  }
}

}  // namespace pliant::scene_file
