#include "matter/edit_parts.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <string>
#include <utility>

#include "constraints/body_anchor.h"
#include "constraints/point_in_tetrahedron.h"
#include "constraints/point_on_triangle.h"
#include "constraints/registry.h"
#include "math/vector.h"
#include "pliant/error.h"

namespace pliant {

namespace {

/// Holds copies by pins or attachments as their origins are.
template <class Holder>
void copy_holders(const std::vector<int>& origins, int first, std::size_t particles, std::vector<Holder>& holders) {
  if (holders.empty()) return;
  std::vector<char> held(particles);
  const std::size_t count = holders.size();
  for (const Holder& holder : holders)
    if (holder.particle >= 0 && static_cast<std::size_t>(holder.particle) < particles)
      held[static_cast<std::size_t>(holder.particle)] = 1;
  for (std::size_t i = 0; i < origins.size(); ++i)
    for (std::size_t h = 0; h < count && held[static_cast<std::size_t>(origins[i])] != 0; ++h) {
      if (holders[h].particle != origins[i]) continue;
      Holder copy = holders[h];
      copy.particle = first + static_cast<int>(i);
      holders.push_back(std::move(copy));
    }
}

/// Copies join a cluster of their origins, at the same rest places.
void add_to_cluster(const std::vector<int>& origins, int first, std::size_t particles, Cluster& cluster) {
  std::vector<int> place(particles, -1);
  for (std::size_t i = cluster.particles.size(); i-- > 0;)
    if (cluster.particles[i] >= 0 && static_cast<std::size_t>(cluster.particles[i]) < particles)
      place[static_cast<std::size_t>(cluster.particles[i])] = static_cast<int>(i);
  for (std::size_t i = 0; i < origins.size(); ++i) {
    const int at = place[static_cast<std::size_t>(origins[i])];
    if (at < 0) continue;
    if (!cluster.rest.empty()) cluster.rest.push_back(cluster.rest[static_cast<std::size_t>(at)]);
    cluster.particles.push_back(first + static_cast<int>(i));
  }
}

/// True if an alpha is given for each constraint of a group once it is edited.
bool has_compliances(const ConstraintGroup& group) {
  return group.stiffness.kind == Stiffness::Kind::compliance || !group.compliances.empty();
}

/// Gives each constraint of a group its alpha, and takes off what is not a whole constraint.
void complete(ConstraintGroup& group, int slots) {
  const auto size = static_cast<std::size_t>(slots), count = group.particles.size() / size;
  group.particles.resize(count * size);
  group.rest.resize(count > 0 ? group.rest.size() / count * count : 0);
  if (has_compliances(group)) group.compliances.resize(count, group.stiffness.value);
}

/// Appends copies of constraints `begin` to `end` - 1 of a group whose data are complete.
void append_run(const ConstraintGroup& from, int slots, int begin, int end, ConstraintGroup& to) {
  if (begin >= end) return;
  const auto size = static_cast<std::size_t>(slots), count = from.particles.size() / size,
             fields = from.rest.size() / count;
  const auto copy = [&](const auto& all, std::size_t each, auto& out) {
    const auto first = all.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(begin) * each);
    out.insert(out.end(), first, first + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(end - begin) * each));
  };
  copy(from.particles, size, to.particles);
  copy(from.rest, fields, to.rest);
  if (!from.compliances.empty()) copy(from.compliances, 1, to.compliances);
}

/// Puts followers, one for each, in the place of some constraints of a group.
void overwrite(ConstraintGroup& group, int slots, const std::vector<int>& numbers, const ConstraintGroup& followers) {
  if (numbers.empty()) return;
  const auto fields = static_cast<std::ptrdiff_t>(followers.rest.size() / numbers.size());
  for (std::ptrdiff_t i = 0; i < std::ssize(numbers); ++i) {
    const std::ptrdiff_t at = numbers[static_cast<std::size_t>(i)];
    std::copy_n(followers.particles.begin() + i * slots, slots, group.particles.begin() + at * slots);
    std::copy_n(followers.rest.begin() + i * fields, fields, group.rest.begin() + at * fields);
    if (!group.compliances.empty())
      group.compliances[static_cast<std::size_t>(at)] = followers.compliances[static_cast<std::size_t>(i)];
  }
}

}  // namespace

void require_masses(const Object& object) {
  if (object.masses.size() != object.positions.size())
    throw Error({.object = object.name},
                "has " + std::to_string(object.masses.size()) + " masses for " +
                    std::to_string(object.positions.size()) + " particles",
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

int tied_slot(const ConstraintType& type) {
  if (type.name == BodyAnchor::name) return type.stencil_size - 1;
  return type.name == PointOnTriangle::name || type.name == PointInTetrahedron::name ? 0 : -1;
}

void append_for_copies(const ConstraintGroup& from, int number, std::vector<int> stencil, const ConstraintType& type,
                       const std::vector<int>& origins, int first, ConstraintGroup& to) {
  const int slot = tied_slot(type);
  if (slot < 0) return;
  int& tied = stencil[static_cast<std::size_t>(slot)];
  const int origin = tied;
  for (std::size_t i = 0; i < origins.size(); ++i) {
    if (origins[i] != origin) continue;
    tied = first + static_cast<int>(i);
    append(from, number, stencil, 1, to);
  }
}

std::vector<int> constraints_at(const ConstraintGroup& group, const std::vector<char>& marks, const Object& object) {
  const ConstraintType& type = type_of(group, object);
  const auto slots = static_cast<std::size_t>(type.stencil_size), count = group.particles.size() / slots;
  std::vector<std::size_t> points;
  for (std::size_t slot = 0; slot < slots; ++slot)
    if (type.slots[slot] == SlotKind::point) points.push_back(slot);
  std::vector<int> found;
  const auto find = [&](const auto& slots_of_points) {
    const int* stencil = group.particles.data();
    for (std::size_t c = 0; c < count; ++c, stencil += slots) {
      char any = 0;
      for (const std::size_t slot : slots_of_points) {
        const auto particle = static_cast<std::size_t>(stencil[slot]);
        if (particle >= marks.size()) (void)points_of(type, {stencil, stencil + slots}, object);  // throws
        any |= marks[particle];
      }
      if (any != 0) found.push_back(static_cast<int>(c));
    }
  };
  if (slots == 4 && points.size() == 4)
    find(std::array<std::size_t, 4>{0, 1, 2, 3});  // the compiler unrolls it: most constraints are of this kind
  else
    find(points);
  return found;
}

void append(const ConstraintGroup& from, int number, const std::vector<int>& stencil, double softer,
            ConstraintGroup& to) {
  const auto slots = stencil.size();
  const std::size_t count = from.particles.size() / slots, fields = count > 0 ? from.rest.size() / count : 0;
  const auto at = static_cast<std::size_t>(number);
  to.particles.insert(to.particles.end(), stencil.begin(), stencil.end());
  const auto rest = from.rest.begin() + static_cast<std::ptrdiff_t>(at * fields);
  to.rest.insert(to.rest.end(), rest, rest + static_cast<std::ptrdiff_t>(fields));
  const float alpha = from.compliances.empty() ? from.stiffness.value : from.compliances[at];
  if (has_compliances(from)) to.compliances.push_back(softer == 1 ? alpha : static_cast<float>(alpha * softer));
}

void replace_constraints(ConstraintGroup& group, int slots, const std::vector<int>& numbers,
                         const ConstraintGroup& followers, const std::vector<int>& ends) {
  complete(group, slots);
  bool one_each = true;
  for (std::size_t i = 0; i < ends.size(); ++i) one_each &= ends[i] == static_cast<int>(i) + 1;
  if (one_each) return overwrite(group, slots, numbers, followers);
  ConstraintGroup out = empty_like(group);
  int next = 0, follower = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    append_run(group, slots, next, numbers[i], out);
    append_run(followers, slots, follower, ends[i], out);
    next = numbers[i] + 1;
    follower = ends[i];
  }
  append_run(group, slots, next, static_cast<int>(group.particles.size()) / slots, out);
  group = std::move(out);
}

namespace {

template <class R>
std::vector<double> relative_places(const std::vector<int>& particles, std::span<const Vec3<R>> positions) {
  const auto at = [&](int particle) { return convert<double>(positions[static_cast<std::size_t>(particle)]); };
  std::vector<double> out;
  for (const int particle : particles) {
    const Vec3d x = at(particle) - at(particles[0]);
    out.insert(out.end(), {x.x, x.y, x.z, 0});
  }
  return out;
}

}  // namespace

std::vector<double> places_of(const std::vector<int>& particles, std::span<const Vec3f> positions) {
  return relative_places(particles, positions);
}

std::vector<double> places_of(const std::vector<int>& particles, std::span<const Vec3d> positions) {
  return relative_places(particles, positions);
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
  return {group.type, {}, {}, group.stiffness, {}, group.plasticity, group.keyframes, group.break_force};
}

std::vector<int> stencil_of(const ConstraintGroup& group, int slots, int number) {
  const auto first = group.particles.begin() + static_cast<std::ptrdiff_t>(number) * slots;
  return {first, first + slots};
}

void hold_like(const std::vector<int>& origins, int first, Object& object) {
  if (origins.empty()) return;
  const std::size_t particles = object.positions.size();
  copy_holders(origins, first, particles, object.pins);
  copy_holders(origins, first, particles, object.attachments);
  for (Cluster& cluster : object.clusters) add_to_cluster(origins, first, particles, cluster);
}

Edit edit_to(Object object) {
  Edit edit{std::move(object), {}};
  edit.from.resize(edit.object.positions.size());
  std::iota(edit.from.begin(), edit.from.end(), 0);
  return edit;
}

}  // namespace pliant
