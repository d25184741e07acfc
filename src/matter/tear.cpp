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

/// The ends of those that are links.
std::set<EdgeEnds> ends_of(const Object& object, const std::set<std::pair<int, int>>& links) {
  std::set<EdgeEnds> ends;
  for (const auto& [group, number] : links) {
    if (!is_length(object.constraints[static_cast<std::size_t>(group)].type)) continue;
    const std::vector<int>& particles = object.constraints[static_cast<std::size_t>(group)].particles;
    const int* const first = particles.data() + 2 * std::ptrdiff_t{number};
    ends.insert(edge_of(first[0], first[1]));
  }
  return ends;
}

/// The limits of a group that limit these lengths, ascending.
std::vector<int> limits_of(const ConstraintGroup& group, const std::set<EdgeEnds>& lengths, const Object& object) {
  if (group.type != DistanceLimit::name || lengths.empty()) return {};
  std::vector<char> at(object.positions.size());
  for (const EdgeEnds& length : lengths) at[static_cast<std::size_t>(length.first)] = 1;
  std::vector<int> found = constraints_at(group, at, object);
  std::erase_if(found, [&](int c) {
    const std::vector<int> limited = stencil_of(group, 2, c);
    return lengths.count(edge_of(limited[0], limited[1])) == 0;
  });
  return found;
}

}  // namespace

Object without_constraints(const Object& object, const std::set<std::pair<int, int>>& links) {
  Object without = object;
  const std::set<EdgeEnds> ends = ends_of(object, links);
  for (int g = 0; g < static_cast<int>(object.constraints.size()) && !links.empty(); ++g) {
    const ConstraintGroup& group = object.constraints[static_cast<std::size_t>(g)];
    std::vector<int> gone = limits_of(group, ends, object);  // of a link that goes, its limit goes too
    for (auto link = links.lower_bound({g, 0}); link != links.end() && link->first == g; ++link)
      gone.push_back(link->second);
    std::sort(gone.begin(), gone.end());
    gone.erase(std::unique(gone.begin(), gone.end()), gone.end());
    rewrite(without.constraints[static_cast<std::size_t>(g)], slots_of(group, object), gone,
            [](int, const ConstraintGroup&) {});
  }
  return without;
}

namespace {

/// Throws an Error if an object has no mass for each particle, or a link uses a particle that does not exist, or has no
/// rest length.
void require_sound(const Object& object) {
  require_masses(object);
  for (const ConstraintGroup& group : object.constraints) {
    if (find_constraint_type(group.type) < 0 || !is_length(group.type)) continue;
    const ConstraintType& type = type_of(group, object);
    const std::size_t count = group.particles.size() / 2;
    const auto exists = [&](int p) { return p >= 0 && static_cast<std::size_t>(p) < object.positions.size(); };
    for (std::size_t c = 0; c < count; ++c)
      if (!exists(group.particles[2 * c]) || !exists(group.particles[2 * c + 1]))
        (void)points_of(type, stencil_of(group, 2, static_cast<int>(c)), object);  // throws
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
  for_each_pair(object, [&](int, int, int a, int b) { join(a, b); });
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

/// A cluster whose particles are of several pieces becomes one for each piece, of two particles or more. Particles that
/// nothing joins, as grains, are a piece together.
void divide_clusters(Object& object) {
  if (object.clusters.empty()) return;
  constexpr auto unjoined = static_cast<std::size_t>(-1);
  DisjointSets pieces = pieces_of(object);
  std::vector<int> size(pieces.count());
  for (std::size_t i = 0; i < pieces.count(); ++i) ++size[pieces.root(i)];
  std::vector<Cluster> divided;
  for (Cluster& cluster : object.clusters) {
    const auto piece_of = [&](int particle) {
      const std::size_t piece = pieces.root(static_cast<std::size_t>(particle));
      return size[piece] > 1 ? piece : unjoined;
    };
    if (std::all_of(cluster.particles.begin(), cluster.particles.end(),
                    [&](int p) { return piece_of(p) == piece_of(cluster.particles[0]); })) {
      if (cluster.particles.size() > 1) divided.push_back(std::move(cluster));
      continue;
    }
    std::map<std::size_t, std::vector<std::size_t>> members;  // of each piece: indices in the cluster
    for (std::size_t i = 0; i < cluster.particles.size(); ++i) members[piece_of(cluster.particles[i])].push_back(i);
    for (const auto& [of, indices] : members)
      if (indices.size() > 1) divided.push_back(part_of(cluster, indices));
  }
  object.clusters = std::move(divided);
}

/// One edit after another, if there is one.
Edit then(const std::optional<Edit>& first, Edit second) {
  if (first)
    for (int& from : second.from) from = from < 0 ? from : first->from[static_cast<std::size_t>(from)];
  return second;
}

/// True if no particle of what comes apart may split.
bool is_held_together(const Object& object, const Breaks& at) {
  const std::vector<char> held = held_particles(object);
  const auto is_held = [&](int p) { return held[static_cast<std::size_t>(p)] != 0; };
  return at.links.empty() &&
         std::all_of(at.edges.begin(), at.edges.end(),
                     [&](const EdgeEnds& edge) { return is_held(edge.first) && is_held(edge.second); }) &&
         std::all_of(at.faces.begin(), at.faces.end(),
                     [&](const Face& face) { return std::all_of(face.begin(), face.end(), is_held); });
}

/// The Edit that breaks an object; nothing if no particle splits and no link goes. Held particles are not split,
/// because their copies would be held in one place.
std::optional<Edit> broken(const Object& object, const Breaks& at) {
  if (is_held_together(object, at)) return {};
  std::optional<Edit> edit;
  const auto now = [&]() -> const Object& { return edit ? edit->object : object; };
  if (!at.links.empty()) edit = edit_to(without_constraints(object, at.links));
  if (!at.edges.empty()) edit = then(edit, cut_edges(now(), at.edges, held_particles(now())));
  const bool is_open = now().positions.size() > object.positions.size();
  if (!at.faces.empty()) edit = then(edit, cut_faces(now(), at.faces, held_particles(now())));
  if (at.links.empty() && now().positions.size() == object.positions.size()) return {};
  if (is_open) edit->object.volume.reset();  // through the tear the gas escapes
  divide_clusters(edit->object);
  return edit;
}

/// Adds the faces that a cut has reached. Returns for each particle 1 if it is of a tetrahedron.
std::vector<char> add_cut_faces(const Object& object, const PlaneSides& sides, Breaks& breaks) {
  std::vector<char> is_solid(object.positions.size());
  if (!is_soft_body(object)) return is_solid;
  const std::vector<std::array<int, 4>> tetrahedra = required_tetrahedra(object);
  for (const auto& t : tetrahedra)
    for (const int corner : t) is_solid[static_cast<std::size_t>(corner)] = 1;
  const std::vector<int> ahead = sides.ahead_of(tetrahedra);
  const std::vector<char> meet = where_parts_meet(tetrahedra, ahead, object.positions.size());
  for (const InnerFace& inner : inner_faces(tetrahedra, meet, [&](const Face& face) { return sides.is_reached(face); }))
    if (ahead[static_cast<std::size_t>(inner.a)] != ahead[static_cast<std::size_t>(inner.b)])
      breaks.faces.insert(inner.face);
  return is_solid;
}

/// Adds the links that a cut has reached, apart from edges of triangles.
void add_cut_links(const Object& object, const PlaneSides& sides, Breaks& breaks) {
  struct Link {
    int group, number, a, b;
  };
  std::vector<Link> links;
  std::vector<char> at(object.positions.size());
  for_each_pair(object, [&](int group, int number, int a, int b) {
    if (!sides.are_parted(std::array<int, 1>{a}, std::array<int, 1>{b}) || !sides.is_reached(std::array<int, 2>{a, b}))
      return;
    links.push_back({group, number, a, b});
    at[static_cast<std::size_t>(a)] = 1;
  });
  if (links.empty()) return;
  const Around around(object.triangles, at);
  for (const auto& [group, number, a, b] : links) {
    const std::span<const int> near = around[a];
    if (std::none_of(near.begin(), near.end(),
                     [&, end = b](int t) { return has_corner(object.triangles[static_cast<std::size_t>(t)], end); }))
      breaks.links.insert({group, number});
  }
}

/// Adds what a cut has reached at a time.
void add_cut(const Object& object, const PlaneCut& cut, double time, Breaks& breaks) {
  const PlaneSides sides(object, cut, time);
  const std::vector<char> is_solid = add_cut_faces(object, sides, breaks);
  require_triangles(object);
  for (const EdgeEnds& edge : edges_between(object, sides.ahead_of(object.triangles)))
    if (sides.is_reached(std::array<int, 2>{edge.first, edge.second}) &&
        is_solid[static_cast<std::size_t>(edge.first)] == 0 && is_solid[static_cast<std::size_t>(edge.second)] == 0)
      breaks.edges.insert(edge);
  add_cut_links(object, sides, breaks);
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
