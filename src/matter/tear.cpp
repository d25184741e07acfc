// Edits that tear objects where they are stretched too far, and cut them along planes.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "constraints/distance_limit.h"
#include "math/disjoint_sets.h"
#include "matter/break_constraints.h"
#include "matter/edit_parts.h"
#include "matter/plane_sides.h"
#include "matter/tears.h"
#include "model/soft_body_substeps.h"
#include "pliant/error.h"
#include "pliant/soft_body.h"

namespace pliant {

std::vector<char> held_particles(const Object& object) {
  std::vector<char> held(object.positions.size());
  const auto hold = [&](int particle) {
    if (particle >= 0 && static_cast<std::size_t>(particle) < held.size()) held[static_cast<std::size_t>(particle)] = 1;
  };
  for (std::size_t i = 0; i < object.masses.size(); ++i)
    if (std::isinf(object.masses[i])) hold(static_cast<int>(i));
  for (const Pin& pin : object.pins) hold(pin.particle);
  for (const Attachment& attachment : object.attachments) hold(attachment.particle);
  return held;
}

namespace {

/// The ends of those that are links, both ways round.
std::set<std::vector<int>> ends_of(const Object& object, const std::set<std::pair<int, int>>& links) {
  std::set<std::vector<int>> ends;
  for (const auto& [group, number] : links) {
    if (!is_length(object.constraints[static_cast<std::size_t>(group)].type)) continue;
    const std::vector<int>& particles = object.constraints[static_cast<std::size_t>(group)].particles;
    const int* const first = particles.data() + 2 * std::ptrdiff_t{number};
    const int a = first[0], b = first[1];
    ends.insert({a, b});
    ends.insert({b, a});
  }
  return ends;
}

}  // namespace

Object without_constraints(const Object& object, const std::set<std::pair<int, int>>& links) {
  Object without = object;
  const std::set<std::vector<int>> ends = ends_of(object, links);
  for (std::size_t g = 0; g < object.constraints.size() && !links.empty(); ++g) {
    const ConstraintGroup& group = object.constraints[g];
    const bool is_limit = group.type == DistanceLimit::name;  // of a link that goes, it goes too
    const int slots = slots_of(group, object);
    ConstraintGroup kept = empty_like(group);
    for (int c = 0; c < static_cast<int>(group.particles.size()) / slots; ++c)
      if (links.count({static_cast<int>(g), c}) == 0 && !(is_limit && ends.count(stencil_of(group, slots, c)) != 0))
        append(group, c, stencil_of(group, slots, c), 1, kept);
    without.constraints[g] = std::move(kept);
  }
  return without;
}

namespace {

/// Throws an Error if an object has no mass for each particle, or a link uses a particle that does not exist, or has no rest length.
void require_sound(const Object& object) {
  require_masses(object);
  for (const ConstraintGroup& group : object.constraints) {
    if (find_constraint_type(group.type) < 0 || !is_length(group.type)) continue;
    const ConstraintType& type = type_of(group, object);
    const std::size_t count = group.particles.size() / 2;
    for (std::size_t c = 0; c < count; ++c) (void)points_of(type, stencil_of(group, 2, static_cast<int>(c)), object);
    if (!group.rest.empty() && group.rest.size() != count)
      throw Error({.object = object.name, .element = group.type + " constraints"},
                  "have " + std::to_string(group.rest.size()) + " rest lengths for " + std::to_string(count),
                  "give one for each, or none");
  }
}

/// The pieces of an object: particles that tetrahedra, triangles and links join.
DisjointSets pieces_of(const Object& object) {
  DisjointSets pieces(object.positions.size());
  const auto join = [&](int a, int b) { pieces.join(static_cast<std::size_t>(a), static_cast<std::size_t>(b)); };
  for (const auto& t : tetrahedra_of(object))
    for (const int corner : t) join(t[0], corner);
  for (const auto& t : object.triangles)
    for (const int corner : t) join(t[0], corner);
  for_each_link(object, [&](int, int, int a, int b, double) { join(a, b); });
  return pieces;
}

Cluster part_of(const Cluster& cluster, const std::vector<std::size_t>& indices) {
  Cluster part = cluster;
  part.particles.clear();
  part.rest.clear();
  for (const std::size_t i : indices) {
    part.particles.push_back(cluster.particles[i]);
    if (!cluster.rest.empty()) part.rest.push_back(cluster.rest[i]);
  }
  return part;
}

/// A cluster whose particles are of several pieces becomes one for each piece, of two particles or more. Particles that nothing joins, as
/// grains, are a piece together.
void divide_clusters(Object& object) {
  if (object.clusters.empty()) return;
  constexpr auto unjoined = static_cast<std::size_t>(-1);
  DisjointSets pieces = pieces_of(object);
  std::vector<int> size(pieces.count());
  for (std::size_t i = 0; i < pieces.count(); ++i) ++size[pieces.root(i)];
  std::vector<Cluster> divided;
  for (const Cluster& cluster : object.clusters) {
    std::map<std::size_t, std::vector<std::size_t>> members;  // of each piece: indices in the cluster
    for (std::size_t i = 0; i < cluster.particles.size(); ++i) {
      const std::size_t piece = pieces.root(static_cast<std::size_t>(cluster.particles[i]));
      members[size[piece] > 1 ? piece : unjoined].push_back(i);
    }
    for (const auto& [of, indices] : members)
      if (indices.size() > 1) divided.push_back(part_of(cluster, indices));
  }
  object.clusters = std::move(divided);
}

/// One edit after another.
Edit then(const Edit& first, Edit second) {
  for (int& from : second.from) from = from < 0 ? from : first.from[static_cast<std::size_t>(from)];
  return second;
}

/// The Edit that breaks an object; nothing if no particle splits and no link goes. Held particles are not split, because their copies would
/// be held in one place.
std::optional<Edit> broken(const Object& object, const Breaks& at) {
  Edit edit = unchanged(without_constraints(object, at.links));
  if (!at.edges.empty()) edit = then(edit, cut_edges(edit.object, at.edges, held_particles(edit.object)));
  const bool is_open = edit.object.positions.size() > object.positions.size();
  if (!at.faces.empty()) edit = then(edit, cut_faces(edit.object, at.faces, held_particles(edit.object)));
  if (is_open) edit.object.volume.reset();  // through the tear the gas escapes
  if (at.links.empty() && edit.object.positions.size() == object.positions.size()) return {};
  divide_clusters(edit.object);
  return edit;
}

/// Adds what a cut has reached at a time.
void add_cut(const Object& object, const PlaneCut& cut, double time, Breaks& breaks) {
  const PlaneSides sides(object, cut, time);
  std::vector<char> is_solid(object.positions.size());
  if (is_soft_body(object)) {
    const std::vector<std::array<int, 4>> tetrahedra = required_tetrahedra(object);
    for (const auto& t : tetrahedra)
      for (const int corner : t) is_solid[static_cast<std::size_t>(corner)] = 1;
    for (const InnerFace& inner : inner_faces(tetrahedra))
      if (sides.are_parted(tetrahedra[static_cast<std::size_t>(inner.a)], tetrahedra[static_cast<std::size_t>(inner.b)]) &&
          sides.is_reached(inner.face))
        breaks.faces.insert(inner.face);
  }
  const Around around = triangles_around(object);
  std::vector<int> side;
  side.reserve(object.triangles.size());
  for (const auto& triangle : object.triangles) side.push_back(sides.is_ahead(triangle) ? 1 : 0);
  for (const Edge& edge : edges_between(object, side))
    if (sides.is_reached(std::array<int, 2>{edge.first, edge.second}) &&
        is_solid[static_cast<std::size_t>(edge.first)] == 0 && is_solid[static_cast<std::size_t>(edge.second)] == 0)
      breaks.edges.insert(edge);
  for_each_link(object, [&](int group, int number, int a, int b, double) {
    if (triangles_of({a, b}, object, around).empty() && sides.are_parted(std::array<int, 1>{a}, std::array<int, 1>{b}) &&
        sides.is_reached(std::array<int, 2>{a, b}))
      breaks.links.insert({group, number});
  });
}

}  // namespace

bool comes_apart(const Object& object) { return object.tearing || !object.cuts.empty() || can_break(object); }

std::optional<Edit> tear(const Object& object, std::span<const Vec3f> positions) {
  if (positions.size() != object.positions.size())
    throw Error({.object = object.name},
                "has " + std::to_string(object.positions.size()) + " particles and is given " +
                    std::to_string(positions.size()) + " positions",
                "give one for each particle of the description");
  if (!object.tearing) return {};
  require_sound(object);
  Breaks breaks = tears_of_surface(object, positions);
  if (is_soft_body(object)) breaks.faces = faces_that_tear(object, positions);
  if (!breaks.any()) return {};
  return broken(object, breaks);
}

std::optional<Edit> make_cuts(const Object& object, double time) {
  require_sound(object);
  Breaks breaks;
  for (const PlaneCut& cut : object.cuts)
    if (time >= static_cast<double>(cut.start)) add_cut(object, cut, time, breaks);
  if (!breaks.any()) return {};
  return broken(object, breaks);
}

}  // namespace pliant
