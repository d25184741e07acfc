// What there is to say about contact among what moves and with meshes: mesh colliders that can't be, thickness that is too
// much for a mesh, and what passes through what before anything has moved.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "collision/intersections.h"
#include "model/carrier.h"
#include "pliant/error.h"
#include "world/problems.h"
#include "world/solid_fields.h"

namespace pliant {

namespace {

std::string counted(std::size_t count, const char* noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

// ------------------------------------------------------------------------------------------------ mesh colliders

void check_mesh(Problems& problems, const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) problems.grave("mesh", "has no triangles", "give a mesh with faces, or leave it out");
  if (mesh.positions.size() > std::numeric_limits<int>::max() / 4)
    problems.grave("mesh", "has " + std::to_string(mesh.positions.size()) + " vertices",
                   "make it coarser: so many can't be numbered");
  Tally not_places, outside, repeated;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    if (!is_place(mesh.positions[i])) not_places.add(static_cast<std::int64_t>(i));
  const auto exists = [&](int corner) { return corner >= 0 && corner < static_cast<int>(mesh.positions.size()); };
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    if (!exists(a) || !exists(b) || !exists(c))
      outside.add(static_cast<std::int64_t>(i));
    else if (a == b || b == c || c == a)
      repeated.add(static_cast<std::int64_t>(i));
  }
  problems.grave(not_places, "vertex", "has a position that is not finite or more than 1e9 m away",
                 "give finite coordinates in metres, near the origin");
  problems.grave(outside, "triangle",
                 "uses a vertex that does not exist; there are " + std::to_string(mesh.positions.size()),
                 "indices count from 0");
  problems.grave(repeated, "triangle", "uses a vertex twice", "drop it, as read_mesh does");
}

// ------------------------------------------------------------------------------------------------ thickness

double distance_of(const std::vector<Vec3f>& positions, int a, int b) {
  const Vec3f &p = positions[static_cast<std::size_t>(a)], &q = positions[static_cast<std::size_t>(b)];
  return std::sqrt(static_cast<double>(length_squared(q - p)));
}

/// Of the surface, or of the links where there is none; 0 where there are neither.
double median_edge(const Object& object) {
  std::vector<double> lengths;
  for (const auto& t : object.triangles)
    for (std::size_t k = 0; k < 3; ++k) lengths.push_back(distance_of(object.positions, t[k], t[(k + 1) % 3]));
  const auto links = std::find_if(object.constraints.begin(), object.constraints.end(),
                                  [](const ConstraintGroup& group) { return group.type == "distance"; });
  if (object.triangles.empty() && links != object.constraints.end())
    for (std::size_t i = 0; i + 1 < links->particles.size(); i += 2)
      lengths.push_back(distance_of(object.positions, links->particles[i], links->particles[i + 1]));
  if (lengths.empty()) return 0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

void doubt_thickness(Problems& problems, const Object& object) {
  if (!object.self_collision && !object.collides) return;
  const double edge = median_edge(object), kept = 2 * static_cast<double>(object.thickness);
  if (edge == 0)
    return problems.doubtful("", "has neither triangles nor links: its particles touch surfaces, but not one another",
                             "leave out self_collision");
  if (kept > edge)
    problems.doubtful("thickness",
                      "is " + words(object.thickness) +
                          " m: two layers keep twice that apart, more than the median edge, " + words(edge) + " m",
                      "folds will be pushed open: give less, or a coarser mesh");
  if (object.thickness == 0)
    problems.doubtful("thickness", "is 0: layers would rest on the last distance that the filter keeps",
                      "give about a tenth of an edge");
}

// ------------------------------------------------------------------------------------------------ tangles

/// What takes part in contact, in one numbering: all objects, then all mesh colliders.
struct Surfaces {
  struct Part {
    std::string name;
    bool self, collides, is_collider;
    std::uint32_t groups, mask;
    int first;
  };
  std::vector<Part> parts;
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;

  void add(const Part& part, const std::vector<Vec3f>& places, const std::vector<std::array<int, 3>>& faces) {
    parts.push_back(part);
    const int first = parts.back().first = static_cast<int>(positions.size());
    positions.insert(positions.end(), places.begin(), places.end());
    for (const auto& [a, b, c] : faces) triangles.push_back({first + a, first + b, first + c});
  }
  int part_of(int vertex) const {
    const auto after =
        std::upper_bound(parts.begin(), parts.end(), vertex, [](int v, const Part& part) { return v < part.first; });
    return static_cast<int>(after - parts.begin()) - 1;
  }
  /// As collision/pair_model.cpp decides.
  bool meet(int a, int b) const {
    const Part &p = parts[a], &q = parts[b];
    if (a == b) return p.self;
    const bool masks = (p.groups & q.mask) != 0 && (q.groups & p.mask) != 0;
    return masks && !(p.is_collider && q.is_collider) && ((p.collides && q.collides) || p.is_collider || q.is_collider);
  }
  std::string name(int part) const {
    return (parts[part].is_collider ? "collider '" : "object '") + parts[part].name + "'";
  }
  std::string local(int vertex) const { return std::to_string(vertex - parts[part_of(vertex)].first); }
};

std::vector<Vec3f> positions_at_start(const MeshCollider& collider) {
  if (collider.frames.empty() && !collider.motion.moves()) return collider.mesh.positions;
  Carrier carrier{collider.motion, collider.mesh.positions, {}, {}, collider.repeat_frames};
  for (const MeshFrame& frame : collider.frames) {
    carrier.times.push_back(frame.time);
    carrier.frames.push_back(frame.positions);
  }
  const CarrierPose pose(carrier, 0);
  std::vector<Vec3f> places;
  for (std::size_t i = 0; i < carrier.rest.size(); ++i) places.push_back(convert<float>(pose.place(static_cast<int>(i))));
  return places;
}

Surfaces surfaces_of(const Scene& scene) {
  Surfaces all;
  for (const Object& o : scene.objects)
    all.add({o.name, o.self_collision, o.collides, false, o.groups, o.mask, 0}, o.positions, o.triangles);
  for (const MeshCollider& c : scene.mesh_colliders)
    if (c.as == MeshCollider::As::triangles)
      all.add({c.name, false, true, true, c.groups, c.mask, 0}, positions_at_start(c), c.mesh.triangles);
  return all;
}

bool any_meet(const Surfaces& all) {
  const int count = static_cast<int>(all.parts.size());
  for (int a = 0; a < count; ++a)
    for (int b = a; b < count; ++b)
      if (all.meet(a, b)) return true;
  return false;
}

void name_tangles(Problems& problems, const Scene& scene) {
  const Settings::Intersections what = scene.settings.initial_intersections;
  const Surfaces all = surfaces_of(scene);
  if (all.triangles.empty() || !any_meet(all)) return;
  IntersectionFinder finder(all.triangles, static_cast<int>(all.positions.size()));
  std::map<std::pair<int, int>, std::pair<Intersection, std::size_t>> between;
  for (const Intersection& found : finder.find(all.positions)) {
    const int a = all.part_of(found.a), b = all.part_of(all.triangles[static_cast<std::size_t>(found.triangle)][0]);
    if (!all.meet(a, b)) continue;
    auto& [first, count] = between[{std::min(a, b), std::max(a, b)}];
    if (count++ == 0) first = found;
  }
  for (const auto& [parts, found] : between) {
    const Intersection& first = found.first;
    const Triangle& t = all.triangles[static_cast<std::size_t>(first.triangle)];
    const int a = all.part_of(first.a), b = all.part_of(t[0]);
    problems.at(all.parts[a].name);
    const std::string edge = "edge " + all.local(first.a) + "-" + all.local(first.b);
    const std::string problem = "passes through triangle (" + all.local(t[0]) + ", " + all.local(t[1]) + ", " +
                                all.local(t[2]) + ") of " + (a == b ? "the same object" : all.name(b)) +
                                " at the start, one of " + counted(found.second, "crossing");
    if (what == Settings::Intersections::refuse)
      problems.grave(edge, problem, "move one of them or mend the mesh, or have initial_intersections untangled or left");
    else if (what == Settings::Intersections::untangle)
      problems.doubtful(edge, problem, "they will be drawn apart at untangling_speed");
    else
      problems.doubtful(edge, problem, "contact leaves them out until they are apart: move one of them, or mend the mesh");
  }
}

}  // namespace

namespace {

void check_frames(Problems& problems, const MeshCollider& collider) {
  const std::size_t vertices = collider.mesh.positions.size();
  for (std::size_t k = 0; k < collider.frames.size(); ++k) {
    const MeshFrame& frame = collider.frames[k];
    const std::string name = "frame " + std::to_string(k);
    require_range(problems, name + ", time", frame.time, -largest_place, largest_place);
    if (k > 0 && !(frame.time > collider.frames[k - 1].time))
      problems.grave(name, "is at " + words(frame.time) + " s, not after the one before it", "sort frames by time");
    if (frame.positions.size() != vertices)
      problems.grave(name,
                     "has " + counted(frame.positions.size(), "vertex position") + ", the mesh " + std::to_string(vertices),
                     "give one for each vertex of the mesh, in its order");
    Tally not_places;
    for (std::size_t i = 0; i < frame.positions.size(); ++i)
      if (!is_place(frame.positions[i])) not_places.add(static_cast<std::int64_t>(i));
    problems.grave(not_places, name + ", vertex", "has a position that is not finite or more than 1e9 m away",
                   "give finite coordinates in metres, near the origin");
  }
  if (!collider.frames.empty() && collider.as != MeshCollider::As::triangles)
    problems.grave("frames", "deform what is met as a distance grid or a heightfield, which can't deform",
                   "leave them out, or let it be met as triangles");
}

/// A mesh that is otherwise sound.
void check_solid(Problems& problems, const MeshCollider& collider) {
  require_range(problems, "grid_spacing", collider.grid_spacing, 0, largest_place);
  if (collider.as == MeshCollider::As::triangles || problems.grave_count() > 0) return;
  try {
    require_solid(collider);
  } catch (const Error& error) {
    problems.grave(error.where().element.empty() ? "mesh" : error.where().element, error.problem(), error.advice());
  }
}

}  // namespace

void check_mesh_collider(Problems& problems, const MeshCollider& collider) {
  check_mesh(problems, collider.mesh);
  check_frames(problems, collider);
  check_solid(problems, collider);
  check_motion(problems, "motion", collider.motion);
  require_range(problems, "thickness", collider.thickness, 0, largest_place);
  check_friction(problems, collider.static_friction, collider.kinetic_friction, collider.restitution);
  if (!is_finite(collider.colour)) problems.grave("colour", "is not finite", "give red, green and blue from 0 to 1");
}

void check_pairs(Problems& problems, const Scene& scene) {
  const auto exists = [&](const std::string& name) {
    const auto called = [&](const auto& one) { return one.name == name; };
    return std::any_of(scene.objects.begin(), scene.objects.end(), called) ||
           std::any_of(scene.mesh_colliders.begin(), scene.mesh_colliders.end(), called);
  };
  problems.at("");
  for (std::size_t i = 0; i < scene.pairs.size(); ++i) {
    const PairProperties& pair = scene.pairs[i];
    const std::string name = "pair " + std::to_string(i);
    for (const std::string& one : {pair.first, pair.second})
      if (!exists(one))
        problems.grave(name, "is of '" + one + "', which is no object or mesh collider", "use the name of one");
    require_range(problems, name + ", thickness", pair.thickness.value_or(0), 0, largest_place);
    require_range(problems, name + ", static_friction", pair.static_friction.value_or(0), 0, largest_place);
    require_range(problems, name + ", kinetic_friction", pair.kinetic_friction.value_or(0), 0, largest_place);
    require_range(problems, name + ", restitution", pair.restitution.value_or(0), 0, 1);
    if (pair.static_friction && pair.kinetic_friction && *pair.kinetic_friction > *pair.static_friction)
      problems.grave(name + ", kinetic_friction", "is larger than the static one",
                     "nothing slides harder than it sticks: lower it");
  }
}

void doubt_contact(Problems& problems, const Scene& scene) {
  for (const Object& object : scene.objects) {
    problems.at(object.name);
    doubt_thickness(problems, object);
  }
  if (scene.settings.initial_intersections != Settings::Intersections::refuse) name_tangles(problems, scene);
  problems.at("");
}

void refuse_tangles(Problems& problems, const Scene& scene) {
  if (scene.settings.initial_intersections == Settings::Intersections::refuse) name_tangles(problems, scene);
  problems.at("");
}

}  // namespace pliant
