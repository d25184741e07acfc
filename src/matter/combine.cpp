// Puts objects together, and ties particles to bodies.
#include <algorithm>
#include <iterator>
#include <set>
#include <string>
#include <utility>

#include "constraints/registry.h"
#include "model/body_names.h"
#include "pliant/body.h"
#include "pliant/error.h"

namespace pliant {

namespace {

void require(const Object& object, const std::string& kind, int index, std::size_t count) {
  if (index < 0 || static_cast<std::size_t>(index) >= count)
    throw Error({"", 0, object.name, kind + ' ' + std::to_string(index)},
                "does not exist; there are " + std::to_string(count), "indices count from 0");
}

/// Moves the slots of a group's stencils to the places of another object's particles and frames.
ConstraintGroup shifted(ConstraintGroup group, int particles, int frames) {
  const int number = find_constraint_type(group.type);
  if (number < 0)
    throw Error({"", 0, "", "constraint type '" + group.type + "'"}, "does not exist",
                "use one of: " + constraint_type_names());
  const std::vector<SlotKind>& slots = constraint_type(number).slots;
  for (std::size_t i = 0; i < group.particles.size(); ++i)
    group.particles[i] += slots[i % slots.size()] == SlotKind::frame ? frames : particles;
  return group;
}

/// A name that is not taken: "door", else "door_2", "door_3" and so on.
std::string free_name(const std::string& name, std::set<std::string>& taken) {
  if (taken.insert(name).second) return name;
  const auto first = taken.lower_bound(name + "_"), last = taken.lower_bound(name + "`");  // the character after _
  auto number = std::distance(first, last) + 2;
  std::string found;
  do found = name + "_" + std::to_string(number++);
  while (!taken.insert(found).second);
  return found;
}

/// Bodies may share the name of those without one, and that of the world.
void append_bodies(Object& object, const Object& other, int particles, int frames) {
  std::set<std::string> taken;
  for (const ObjectBody& body : object.bodies) taken.insert(body.name);
  for (ObjectBody body : other.bodies) {
    body.particle += particles;
    body.frame += frames;
    if (has_own_name(body.name)) body.name = free_name(body.name, taken);
    object.bodies.push_back(std::move(body));
  }
}

/// Joints list constraints by the number of their group.
void append_joints(Object& object, const Object& other, int bodies, int groups) {
  std::set<std::string> taken;
  for (const ObjectJoint& joint : object.joints) taken.insert(joint.name);
  for (ObjectJoint joint : other.joints) {
    joint.name = free_name(joint.name, taken);
    joint.a += bodies;
    joint.b += bodies;
    for (std::array<int, 2>& constraint : joint.constraints) constraint[0] += groups;
    object.joints.push_back(std::move(joint));
  }
}

/// The skin of an object; if it has none, its own triangles as one.
Skin skin_or_surface(const Object& object) {
  if (object.skin) return *object.skin;
  Skin skin;
  skin.triangles = object.triangles;
  for (int i = 0; i < static_cast<int>(object.positions.size()); ++i)
    skin.vertices.push_back({{i, i, i, i}, {1, 0, 0, 0}});
  return skin;
}

/// If one of two objects has a skin, both get one.
void append_skin(Object& object, const Object& other) {
  if (!object.skin && !other.skin) return;
  Skin skin = skin_or_surface(object);
  const int particles = static_cast<int>(object.positions.size()), vertices = static_cast<int>(skin.vertices.size());
  const Skin added = skin_or_surface(other);
  for (SkinVertex vertex : added.vertices) {
    for (int& particle : vertex.particles) particle += particles;
    skin.vertices.push_back(vertex);
  }
  for (const auto& [a, b, c] : added.triangles) skin.triangles.push_back({a + vertices, b + vertices, c + vertices});
  object.skin = std::move(skin);
}

}  // namespace

int append(Object& object, const Object& other) {
  if (other.volume)
    throw Error({"", 0, other.name, "volume"}, "cannot become part of an object", "add the object by itself");
  const int particles = static_cast<int>(object.positions.size()), frames = static_cast<int>(object.frames.size()),
            bodies = static_cast<int>(object.bodies.size()), groups = static_cast<int>(object.constraints.size());
  append_skin(object, other);
  if (!object.velocities.empty() || !other.velocities.empty()) {
    object.velocities.resize(object.positions.size());
    object.velocities.insert(object.velocities.end(), other.velocities.begin(), other.velocities.end());
    object.velocities.resize(object.positions.size() + other.positions.size());
  }
  object.positions.insert(object.positions.end(), other.positions.begin(), other.positions.end());
  object.masses.insert(object.masses.end(), other.masses.begin(), other.masses.end());
  object.frames.insert(object.frames.end(), other.frames.begin(), other.frames.end());
  append_bodies(object, other, particles, frames);
  for (const ConstraintGroup& group : other.constraints)
    object.constraints.push_back(shifted(group, particles, frames));
  append_joints(object, other, bodies, groups);
  for (const auto& [a, b, c] : other.triangles)
    object.triangles.push_back({a + particles, b + particles, c + particles});
  for (Cluster cluster : other.clusters) {
    for (int& particle : cluster.particles) particle += particles;
    object.clusters.push_back(std::move(cluster));
  }
  for (Pin pin : other.pins) {
    pin.particle += particles;
    object.pins.push_back(std::move(pin));
  }
  for (Attachment attachment : other.attachments) {
    attachment.particle += particles;
    object.attachments.push_back(std::move(attachment));
  }
  return particles;
}

void attach(Object& object, const std::vector<int>& particles, int body, const Stiffness& stiffness) {
  require(object, "body", body, object.bodies.size());
  if (particles.empty())
    throw Error({"", 0, object.name, "body " + std::to_string(body)}, "is tied to no particles", "give at least one");
  for (const int particle : particles) require(object, "particle", particle, object.positions.size());
  const ObjectBody& to = object.bodies[static_cast<std::size_t>(body)];
  ConstraintGroup group;
  group.type = "body_anchor";
  group.stiffness = stiffness;
  for (const int particle : particles) group.particles.insert(group.particles.end(), {to.particle, to.frame, particle});
  object.constraints.push_back(std::move(group));
}

}  // namespace pliant
