#include "matter/edit_parts.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "constraints/registry.h"
#include "math/vector.h"
#include "pliant/error.h"

namespace pliant {

namespace {

/// Pins and attaches a copy as its origin is.
void copy_pins(int of, int copy, Object& object) {
  const std::vector<Pin> pins = object.pins;
  for (const Pin& pin : pins)
    if (pin.particle == of) object.pins.push_back({copy, pin.motion});
  const std::vector<Attachment> attachments = object.attachments;
  for (Attachment attachment : attachments) {
    if (attachment.particle != of) continue;
    attachment.particle = copy;
    object.attachments.push_back(attachment);
  }
}

/// A copy joins the clusters of its origin, at the same rest place.
void add_to_clusters(int of, int copy, Object& object) {
  for (Cluster& cluster : object.clusters) {
    const auto found = std::find(cluster.particles.begin(), cluster.particles.end(), of);
    if (found == cluster.particles.end()) continue;
    const std::ptrdiff_t at = found - cluster.particles.begin();
    if (!cluster.rest.empty()) cluster.rest.push_back(cluster.rest[static_cast<std::size_t>(at)]);
    cluster.particles.push_back(copy);
  }
}

}  // namespace

void require_masses(const Object& object) {
  if (object.masses.size() != object.positions.size())
    throw Error({.object = object.name},
                "has " + std::to_string(object.masses.size()) + " masses for " + std::to_string(object.positions.size()) +
                    " particles",
                "give one for each");
}

const ConstraintType& type_of(const ConstraintGroup& group, const Object& object) {
  for (const ConstraintType& type : constraint_types())
    if (type.name == group.type) return type;
  throw Error({.object = object.name, .element = group.type + " constraints"}, "have an unknown type",
              "constraint_types() lists the known ones");
}

int slots_of(const ConstraintGroup& group, const Object& object) { return type_of(group, object).stencil_size; }

std::vector<int> points_of(const ConstraintType& type, const std::vector<int>& stencil, const Object& object) {
  std::vector<int> points = stencil;
  for (std::size_t slot = 0; slot < points.size(); ++slot) {
    if (type.slots[slot] == SlotKind::frame) {
      points[slot] = -1;
    } else if (points[slot] < 0 || static_cast<std::size_t>(points[slot]) >= object.positions.size()) {
      throw Error({.object = object.name, .element = type.name + " constraints"},
                  "use particle " + std::to_string(points[slot]) + ", which does not exist", "particles count from 0");
    }
  }
  return points;
}

void append(const ConstraintGroup& from, int number, const std::vector<int>& stencil, double softer, ConstraintGroup& to) {
  const auto slots = stencil.size();
  const std::size_t count = from.particles.size() / slots, fields = count > 0 ? from.rest.size() / count : 0;
  const auto at = static_cast<std::size_t>(number);
  to.particles.insert(to.particles.end(), stencil.begin(), stencil.end());
  const auto rest = from.rest.begin() + static_cast<std::ptrdiff_t>(at * fields);
  to.rest.insert(to.rest.end(), rest, rest + static_cast<std::ptrdiff_t>(fields));
  const bool compliant = from.stiffness.kind == Stiffness::Kind::compliance;
  const float alpha = from.compliances.empty() ? from.stiffness.value : from.compliances[at];
  if (compliant || !from.compliances.empty())
    to.compliances.push_back(softer == 1 ? alpha : static_cast<float>(alpha * softer));
}

std::vector<double> places_of(const std::vector<int>& particles, std::span<const Vec3f> positions) {
  const Vec3d origin = convert<double>(positions[static_cast<std::size_t>(particles[0])]);
  std::vector<double> out;
  for (const int particle : particles) {
    const Vec3d x = convert<double>(positions[static_cast<std::size_t>(particle)]) - origin;
    out.insert(out.end(), {x.x, x.y, x.z, 0});
  }
  return out;
}

std::vector<double> rest_of(const ConstraintGroup& group, int number, const Object& object) {
  const ConstraintDefinition& type = constraint_type(find_constraint_type(group.type));
  const std::size_t fields = type.rest_fields.size(), first = static_cast<std::size_t>(number) * fields;
  std::vector<double> rest(fields);
  for (std::size_t f = 0; f < fields && !group.rest.empty(); ++f) rest[f] = static_cast<double>(group.rest[first + f]);
  if (group.rest.empty() && type.measure != nullptr)
    type.measure(places_of(stencil_of(group, static_cast<int>(type.slots.size()), number), object.positions).data(),
                 rest.data());
  return rest;
}

ConstraintGroup empty_like(const ConstraintGroup& group) {
  ConstraintGroup out = group;
  out.particles.clear();
  out.rest.clear();
  out.compliances.clear();
  return out;
}

std::vector<int> stencil_of(const ConstraintGroup& group, int slots, int number) {
  const auto first = group.particles.begin() + static_cast<std::ptrdiff_t>(number) * slots;
  return {first, first + slots};
}

void hold_like(int of, int copy, Object& object) {
  copy_pins(of, copy, object);
  add_to_clusters(of, copy, object);
}

}  // namespace pliant
