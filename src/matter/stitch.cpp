#include "pliant/stitch.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <type_traits>
#include <utility>

#include "constraints/distance_limit.h"
#include "constraints/registry.h"
#include "math/disjoint_sets.h"
#include "math/vector.h"
#include "matter/edit_parts.h"
#include "model/soft_body_substeps.h"
#include "pliant/error.h"

namespace pliant {

namespace {

void require_particle(const Object& object, int particle, const std::string& element) {
  if (particle >= 0 && static_cast<std::size_t>(particle) < object.positions.size()) return;
  throw Error({.object = object.name, .element = element},
              "has particle " + std::to_string(particle) + ", but there are " + std::to_string(object.positions.size()),
              "particles count from 0");
}

void require_pairs(const Object& object, std::span<const std::array<int, 2>> pairs) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::string element = "pair " + std::to_string(i);
    for (const int particle : pairs[i]) require_particle(object, particle, element);
    if (pairs[i][0] == pairs[i][1])
      throw Error({.object = object.name, .element = element}, "has particle " + std::to_string(pairs[i][0]) + " twice",
                  "give two different particles");
  }
}

/// Throws an Error if a triangle, pin, attachment, cluster or skin names a particle that does not exist.
void require_indices(const Object& object) {
  for (const auto& triangle : object.triangles)
    for (const int corner : triangle) require_particle(object, corner, "triangles");
  for (const Pin& pin : object.pins) require_particle(object, pin.particle, "pins");
  for (const Attachment& attachment : object.attachments) require_particle(object, attachment.particle, "attachments");
  for (const Cluster& cluster : object.clusters)
    for (const int particle : cluster.particles) require_particle(object, particle, "clusters");
  if (object.skin)
    for (const SkinVertex& vertex : object.skin->vertices)
      for (const int particle : vertex.particles) require_particle(object, particle, "skin");
}

/// Throws an Error unless a group has rest data and compliances for each of its constraints, or none.
void require_rows(const Object& object, const ConstraintGroup& group, const ConstraintType& type) {
  const std::size_t count = group.particles.size() / static_cast<std::size_t>(type.stencil_size);
  const bool has_rest = group.rest.empty() || group.rest.size() == count * type.rest_fields.size();
  const bool has_compliances = group.compliances.empty() || group.compliances.size() == count;
  const bool has_places = std::all_of(object.clusters.begin(), object.clusters.end(), [](const Cluster& cluster) {
    return cluster.rest.empty() || cluster.rest.size() == cluster.particles.size();
  });
  if (!has_rest || !has_compliances || !has_places)
    throw Error({.object = object.name, .element = group.type + " constraints"},
                "or clusters have rest data or compliances of another number", "give one for each, or none");
}

/// Which particles become one, and what number it has.
class Welding {
 public:
  Welding(const Object& object, std::span<const std::array<int, 2>> pairs)
      : object_(object), sets_(object.positions.size()) {
    for (const Pin& pin : object.pins) pinned_.insert(pin.particle);
    for (const auto& [a, b] : pairs) sets_.join(static_cast<std::size_t>(a), static_cast<std::size_t>(b));
    number_.assign(object.positions.size(), -1);
    for (std::size_t i = 0; i < number_.size(); ++i) {
      int& of_set = number_[sets_.root(i)];
      if (of_set < 0) {
        of_set = static_cast<int>(from_.size());
        from_.push_back(static_cast<int>(i));
      }
      int& chosen = from_[static_cast<std::size_t>(of_set)];
      if (weight(static_cast<int>(i)) > weight(chosen)) chosen = static_cast<int>(i);
    }
    for (std::size_t i = 0; i < number_.size(); ++i) number_[i] = number_[sets_.root(i)];
  }

  Edit edit() const {
    Edit edit{object_, from_};
    Object& to = edit.object;
    to.positions.clear();
    to.velocities.clear();
    to.masses.assign(from_.size(), 0);
    for (const int origin : from_) {
      to.positions.push_back(object_.positions[static_cast<std::size_t>(origin)]);
      if (!object_.velocities.empty()) to.velocities.push_back(object_.velocities[static_cast<std::size_t>(origin)]);
    }
    for (std::size_t i = 0; i < number_.size(); ++i) to.masses[at(static_cast<int>(i))] += object_.masses[i];
    for (ConstraintGroup& group : to.constraints) group = welded(group);
    std::erase_if(to.constraints, [](const ConstraintGroup& group) { return group.particles.empty(); });
    for (std::array<int, 3>& triangle : to.triangles) weld_triangle(triangle);
    if (is_soft_body(object_)) remove_inner_faces(to.triangles);
    hold(to.pins);
    hold(to.attachments);
    for (Cluster& cluster : to.clusters) weld_cluster(cluster);
    std::erase_if(to.clusters, [](const Cluster& cluster) { return cluster.particles.size() < 2; });
    if (to.skin)
      for (SkinVertex& vertex : to.skin->vertices)
        for (int& particle : vertex.particles) particle = number_[static_cast<std::size_t>(particle)];
    return edit;
  }

 private:
  /// What is pinned stays where its pin is, then what is fixed, then the heaviest.
  std::pair<bool, float> weight(int particle) const {
    return {pinned_.count(particle) != 0, object_.masses[static_cast<std::size_t>(particle)]};
  }

  std::size_t at(int particle) const { return static_cast<std::size_t>(number_[static_cast<std::size_t>(particle)]); }

  /// A group with its rest data, which the places of welded particles no longer tell.
  ConstraintGroup with_rest(const ConstraintGroup& group, std::size_t count) const {
    ConstraintGroup out = group;
    const ConstraintDefinition& type = constraint_type(find_constraint_type(group.type));
    if (!group.rest.empty() || type.measure == nullptr || type.rest_fields.empty()) return out;
    for (std::size_t c = 0; c < count; ++c)
      for (const double one : rest_of(group, static_cast<int>(c), object_)) out.rest.push_back(static_cast<float>(one));
    return out;
  }

  ConstraintGroup welded(const ConstraintGroup& group) const {
    const auto slots = static_cast<std::size_t>(slots_of(group, object_));
    const std::size_t count = group.particles.size() / slots;
    const ConstraintGroup given = with_rest(group, count);
    ConstraintGroup out = empty_like(given);
    for (std::size_t c = 0; c < count; ++c) {
      const std::vector<int> stencil = stencil_of(given, static_cast<int>(slots), static_cast<int>(c));
      std::vector<int> to;
      to.reserve(stencil.size());
      for (const int particle : stencil) to.push_back(number_[static_cast<std::size_t>(particle)]);
      const std::set<int> before(stencil.begin(), stencil.end()), after(to.begin(), to.end());
      if (after.size() == before.size()) append(given, static_cast<int>(c), to, 1, out);
    }
    return out;
  }

  void weld_triangle(std::array<int, 3>& triangle) const {
    const std::array<int, 3> before = triangle;
    for (int& corner : triangle) corner = number_[static_cast<std::size_t>(corner)];
    if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0])
      throw Error({.object = object_.name,
                   .element = "triangle " + std::to_string(before[0]) + ", " + std::to_string(before[1]) + ", " +
                              std::to_string(before[2])},
                  "has two particles that become one", "weld particles of different triangles");
  }

  /// Triangles of the surfaces of two tetrahedra become one inner face, which is part of no surface.
  static void remove_inner_faces(std::vector<std::array<int, 3>>& triangles) {
    std::map<std::array<int, 3>, int> count;
    const auto key = [](std::array<int, 3> triangle) {
      std::sort(triangle.begin(), triangle.end());
      return triangle;
    };
    for (const std::array<int, 3>& triangle : triangles) ++count[key(triangle)];
    std::erase_if(triangles, [&](const std::array<int, 3>& triangle) { return count[key(triangle)] == 2; });
  }

  /// Pins and attachments follow. Of the pins of particles that become one the first stays.
  template <class Held>
  void hold(std::vector<Held>& held) const {
    std::set<int> seen;
    for (Held& one : held) one.particle = number_[static_cast<std::size_t>(one.particle)];
    if constexpr (std::is_same_v<Held, Pin>)
      std::erase_if(held, [&](const Held& one) { return !seen.insert(one.particle).second; });
  }

  void weld_cluster(Cluster& cluster) const {
    const Cluster before = cluster;
    std::set<int> seen;
    cluster.particles.clear();
    cluster.rest.clear();
    for (std::size_t i = 0; i < before.particles.size(); ++i) {
      const auto particle = static_cast<std::size_t>(before.particles[i]);
      if (!seen.insert(number_[particle]).second) continue;
      cluster.particles.push_back(number_[particle]);
      cluster.rest.push_back(before.rest.empty() ? object_.positions[particle] : before.rest[i]);
    }
  }

  const Object& object_;
  DisjointSets sets_;
  std::set<int> pinned_;
  std::vector<int> number_;  ///< of each old particle: that of the new one
  std::vector<int> from_;
};

}  // namespace

std::vector<std::array<int, 2>> nearest_pairs(const Object& object, std::span<const int> particles,
                                              std::span<const int> others) {
  for (const int particle : particles) require_particle(object, particle, "particles");
  for (const int other : others) require_particle(object, other, "others");
  std::vector<std::array<int, 2>> pairs;
  for (const int particle : particles) {
    int nearest = -1;
    double least = 0;
    for (const int other : others) {
      const Vec3d way = convert<double>(object.positions[static_cast<std::size_t>(other)]) -
                        convert<double>(object.positions[static_cast<std::size_t>(particle)]);
      const double distance = dot(way, way);
      if (other == particle || (nearest >= 0 && (distance > least || (distance == least && other >= nearest))))
        continue;
      nearest = other;
      least = distance;
    }
    if (nearest < 0)
      throw Error({.object = object.name, .element = "particle " + std::to_string(particle)},
                  "has no other to be paired with", "give particles of the other side");
    pairs.push_back({particle, nearest});
  }
  return pairs;
}

void add_stitches(Object& object, std::span<const std::array<int, 2>> pairs, const StitchOptions& options) {
  require_pairs(object, pairs);
  if (!(options.closing_time >= 0 && options.closing_time <= 1e6f))
    throw Error({.object = object.name, .element = "stitches, closing_time"},
                "is " + std::to_string(options.closing_time), "give 0 s or more");
  if (pairs.empty()) return;
  ConstraintGroup group;
  group.type = DistanceLimit::name;
  group.stiffness = options.stiffness;
  group.break_force = options.break_force;
  group.keyframes = {{0, options.closing_time > 0 ? 1.f : 0.f}};
  if (options.closing_time > 0) group.keyframes.push_back({options.closing_time, 0});
  for (const auto& [a, b] : pairs) {
    const Vec3d way = convert<double>(object.positions[static_cast<std::size_t>(b)]) -
                      convert<double>(object.positions[static_cast<std::size_t>(a)]);
    group.particles.insert(group.particles.end(), {a, b});
    group.rest.insert(group.rest.end(), {static_cast<float>(length(way)), 0});
  }
  object.constraints.push_back(std::move(group));
}

Edit weld(const Object& object, std::span<const std::array<int, 2>> pairs) {
  require_masses(object);
  require_pairs(object, pairs);
  if (!object.bodies.empty() || object.fluid || object.gas || object.grains || object.tracers)
    throw Error({.object = object.name}, "has rigid bodies, or is a liquid, gas or grains, whose particles stay apart",
                "weld cloth, ropes, soft bodies or plain particles");
  if (object.absorbency)
    throw Error({.object = object.name}, "takes up liquid, of which welding would lose some",
                "weld it before it gets wet, without its absorbency");
  require_indices(object);
  for (const ConstraintGroup& group : object.constraints) {
    const ConstraintType& type = type_of(group, object);
    const auto slots = static_cast<std::size_t>(type.stencil_size);
    require_rows(object, group, type);
    for (std::size_t c = 0; c < group.particles.size() / slots; ++c)
      (void)points_of(type, stencil_of(group, type.stencil_size, static_cast<int>(c)), object);
    if (std::any_of(type.slots.begin(), type.slots.end(), [](SlotKind kind) { return kind == SlotKind::frame; }))
      throw Error({.object = object.name, .element = group.type + " constraints"},
                  "have frames, whose numbers would be lost", "weld objects without frames");
  }
  return Welding(object, pairs).edit();
}

}  // namespace pliant
