// Findings about initial intersections and enclosures: errors or warnings, as the scene's settings require.
#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "collision/fields/mesh_query.h"
#include "collision/untangle/intersections.h"
#include "inspect/problems.h"
#include "matter/surfaces.h"
#include "topology/boundary.h"

namespace pliant {

namespace {

using Intersections = Settings::Intersections;

constexpr const char* advice_on_tangles =
    "move one of them or repair the mesh, or set initial_intersections to \"untangle\" or \"leave\"";

/// The intersections between two parts: their number, and the first.
struct Crossings {
  Intersection first{};
  std::size_t count = 0;
};
using CrossingsOfParts = std::map<std::pair<int, int>, Crossings>;

/// The pairs of parts that cross or touch. Within one part only crossings count, because its seams may coincide.
struct Meetings {
  CrossingsOfParts crossing, touching;
};

Meetings find_meetings(const Surfaces& all) {
  Meetings between;
  IntersectionFinder finder(all.triangles, static_cast<int>(all.positions.size()));
  for (const Intersection& found : finder.find(all.positions, true)) {
    const int a = all.part_of(found.a), b = all.part_of(all.triangles[static_cast<std::size_t>(found.triangle)][0]);
    const bool crosses = found.kind == EdgeTriangle::crossing;
    if (!all.meet(a, b) || (a == b && !crosses)) continue;
    Crossings& meetings = (crosses ? between.crossing : between.touching)[std::minmax(a, b)];
    if (meetings.count++ == 0) meetings.first = found;
  }
  return between;
}

bool any_meet(const Surfaces& all) {
  const int count = static_cast<int>(all.parts.size());
  for (int a = 0; a < count; ++a)
    for (int b = a; b < count; ++b)
      if (all.meet(a, b)) return true;
  return false;
}

void name_crossings(Problems& problems, const Surfaces& all, const Crossings& crossings, Intersections what) {
  const Intersection& first = crossings.first;
  const Triangle& t = all.triangles[static_cast<std::size_t>(first.triangle)];
  const int a = all.part_of(first.a), b = all.part_of(t[0]);
  problems.at(all.parts[a].name);
  const std::string edge = "edge " + all.local(first.a) + "-" + all.local(first.b);
  const std::string problem = "passes through triangle (" + all.local(t[0]) + ", " + all.local(t[1]) + ", " +
                              all.local(t[2]) + ") of " + (a == b ? "the same object" : all.name(b)) +
                              " at the start, one of " + std::to_string(crossings.count) + " crossing" +
                              (crossings.count == 1 ? "" : "s");
  if (what == Intersections::refuse)
    problems.grave(edge, problem, advice_on_tangles);
  else if (what == Intersections::untangle)
    problems.doubtful(
        edge, problem,
        "parts that are cut off or inside a closed collider will be moved apart at untangling_speed; a slit "
        "from border to border remains: move one of them, or repair the mesh");
  else
    problems.doubtful(
        edge, problem,
        "contact ignores these intersections until the surfaces are apart: move one of them, or repair the mesh");
}

/// Reports surfaces at distance 0 as grave: which side they are on is a guess (world/touching_starts.h).
void refuse_touching(Problems& problems, const Surfaces& all, const Crossings& touching) {
  const Intersection& first = touching.first;
  const Triangle& t = all.triangles[static_cast<std::size_t>(first.triangle)];
  problems.at(all.parts[static_cast<std::size_t>(all.part_of(first.a))].name);
  problems.grave(
      "edge " + all.local(first.a) + "-" + all.local(first.b),
      "touches triangle (" + all.local(t[0]) + ", " + all.local(t[1]) + ", " + all.local(t[2]) + ") of " +
          all.name(all.part_of(t[0])) + " at the start, at a distance of 0, one of " + std::to_string(touching.count) +
          (touching.count == 1 ? " place" : " places"),
      "its side is not known: move one of them by their thickness, or set initial_intersections to \"leave\", which "
      "holds it on the side of the normals");
}

// ---------------------------------------------------------------- inside

/// A closed surface that might enclose an object without touching it.
struct Closed {
  std::string name;  ///< name for messages: "closed collider 'ball'"
  int part = -1;     ///< its part in Surfaces; -1: a distance grid
  std::uint32_t groups = 1, mask = ~0u;
  MeshQuery query;
};

bool is_closed_mesh(const std::vector<Triangle>& triangles, int vertices) {
  return !triangles.empty() && is_closed(find_edges(triangles, vertices));
}

std::vector<Closed> closed_surfaces(const Scene& scene, const Surfaces& all) {
  std::vector<Closed> out;
  for (int part = 0; part < static_cast<int>(all.parts.size()); ++part) {
    const Surfaces::Part& of = all.parts[static_cast<std::size_t>(part)];
    const std::vector<Triangle> triangles = all.triangles_of(part);
    if (!is_closed_mesh(triangles, all.end_of(part) - of.first)) continue;
    const std::vector<Vec3f> places(all.positions.begin() + of.first, all.positions.begin() + all.end_of(part));
    out.push_back({"closed " + all.name(part), part, of.groups, of.mask, MeshQuery(places, triangles)});
  }
  for (const MeshCollider& c : scene.mesh_colliders)
    if (c.as == MeshCollider::As::distance_grid)
      out.push_back({"distance grid '" + c.name + "'", -1, c.groups, c.mask,
                     MeshQuery(positions_at_start(c), {c.mesh.triangles.begin(), c.mesh.triangles.end()})});
  return out;
}

bool meet(const Surfaces& all, int object, const Closed& closed) {
  const Surfaces::Part& of = all.parts[static_cast<std::size_t>(object)];
  if (closed.part >= 0) return object != closed.part && all.meet(object, closed.part);
  return (of.groups & closed.mask) != 0 && (closed.groups & of.mask) != 0;
}

/// Counts the particles of an object that are inside a closed surface.
Tally inside_of(const Surfaces& all, int object, const MeshQuery& query) {
  Tally inside;
  const BoxBounds& box = query.bounds();
  const int first = all.parts[static_cast<std::size_t>(object)].first;
  for (int v = first; v < all.end_of(object); ++v) {
    const Vec3f& p = all.positions[static_cast<std::size_t>(v)];
    if (overlap(BoxBounds{p, p}, box) && query.is_inside(p)) inside.add(v - first);
  }
  return inside;
}

/// Reports objects that are enclosed without a crossing; crossings are reported separately. If enclosures are only
/// warnings, closed objects are left out, because one object may contain another on purpose.
void name_inside(Problems& problems, const Scene& scene, const Surfaces& all, const CrossingsOfParts& crossings,
                 Intersections what) {
  const int objects = static_cast<int>(scene.objects.size());
  for (const Closed& closed : closed_surfaces(scene, all)) {
    for (int object = 0; object < objects; ++object) {
      if (!meet(all, object, closed) || crossings.count(std::minmax(object, closed.part)) > 0) continue;
      if (what != Intersections::refuse && closed.part >= 0 && closed.part < objects) continue;
      problems.at(all.parts[static_cast<std::size_t>(object)].name);
      const Tally inside = inside_of(all, object, closed.query);
      const std::string problem = "is inside of " + closed.name + " at the start";
      if (what == Intersections::refuse)
        problems.grave(inside, "particle", problem, advice_on_tangles);
      else if (what == Intersections::leave)
        problems.doubtful(inside, "particle", problem,
                          "move one of them, or set initial_intersections to \"untangle\", which moves it out");
      else
        problems.doubtful(inside, "particle", problem,
                          "it will be moved out at untangling_speed: move one of them to avoid this");
    }
  }
}

// ---------------------------------------------------------------- touching

float thickness_of(const Scene& scene, int part) {
  const std::size_t objects = scene.objects.size(), number = static_cast<std::size_t>(part);
  return number < objects ? scene.objects[number].thickness : scene.mesh_colliders[number - objects].thickness;
}

/// The contact distance of two parts: the sum of their thicknesses [m].
float kept_between(const Scene& scene, const Surfaces& all, int a, int b) {
  float kept = thickness_of(scene, a) + thickness_of(scene, b);
  const std::string &first = all.parts[static_cast<std::size_t>(a)].name,
                    &second = all.parts[static_cast<std::size_t>(b)].name;
  for (const PairProperties& pair : scene.pairs) {
    const bool is_it = (pair.first == first && pair.second == second) || (pair.first == second && pair.second == first);
    if (is_it && pair.thickness) kept = *pair.thickness;
  }
  return kept;
}

/// Counts the particles of part `a` that are nearer to a surface than `kept`, and finds the least distance.
Tally near_to(const Surfaces& all, int a, const MeshQuery& query, float kept, float& least) {
  Tally near;
  const int first = all.parts[static_cast<std::size_t>(a)].first;
  const BoxBounds& box = query.bounds();
  for (int v = first; v < all.end_of(a); ++v) {
    const Vec3f &p = all.positions[static_cast<std::size_t>(v)], margin{kept, kept, kept};
    if (!overlap(BoxBounds{p - margin, p + margin}, box)) continue;
    const SurfacePoint found = query.closest(p, kept);
    if (found.triangle < 0) continue;
    near.add(v - first);
    least = std::min(least, found.distance);
  }
  return near;
}

/// Warns of parts that start within the contact distance of each other: contact pushes them apart at once.
void doubt_touching(Problems& problems, const Scene& scene, const Surfaces& all, const CrossingsOfParts& crossings) {
  constexpr float share = 0.9f;  // layers at just the contact distance are intended
  const int objects = static_cast<int>(scene.objects.size()), parts = static_cast<int>(all.parts.size());
  for (int b = 0; b < parts; ++b) {
    const std::vector<Triangle> triangles = all.triangles_of(b);
    if (triangles.empty()) continue;
    const MeshQuery query(
        {all.positions.begin() + all.parts[static_cast<std::size_t>(b)].first, all.positions.begin() + all.end_of(b)},
        triangles);
    for (int a = 0; a < objects; ++a) {
      const bool was_told = a > b && b < objects && !all.triangles_of(a).empty();  // reported with a and b exchanged
      if (a == b || was_told || !all.meet(a, b) || crossings.count(std::minmax(a, b)) > 0) continue;
      const float kept = kept_between(scene, all, a, b);
      float least = kept;
      const Tally near = near_to(all, a, query, share * kept, least);
      problems.at(all.parts[static_cast<std::size_t>(a)].name);
      problems.doubtful(near, "particle",
                        "starts nearer to " + all.name(b) + " than the " + words(kept) +
                            " m that the two keep, the nearest " + words(least) + " m from it",
                        least > 0
                            ? "contact pushes it away in the first frames: start farther apart, or reduce the thickness"
                            : "at a distance of 0 it is held on the side of the normals of colliders, then of closed "
                              "surfaces, then of the earlier object: start farther apart, or turn that mesh over if "
                              "this is the wrong side");
    }
  }
}

void look_at(Problems& problems, const Scene& scene) {
  const Intersections what = scene.settings.initial_intersections;
  const Surfaces all = surfaces_of(scene);
  Meetings between;
  if (!all.triangles.empty() && any_meet(all)) between = find_meetings(all);
  for (const auto& [parts, found] : between.crossing) name_crossings(problems, all, found, what);
  if (what == Intersections::refuse)
    for (const auto& [parts, found] : between.touching)
      if (between.crossing.count(parts) == 0) refuse_touching(problems, all, found);
  name_inside(problems, scene, all, between.crossing, what);
  if (problems.wants_doubts()) doubt_touching(problems, scene, all, between.crossing);
}

}  // namespace

void doubt_tangles(Problems& problems, const Scene& scene) {
  if (scene.settings.initial_intersections != Intersections::refuse) look_at(problems, scene);
  problems.at("");
}

void refuse_tangles(Problems& problems, const Scene& scene) {
  if (scene.settings.initial_intersections == Intersections::refuse) look_at(problems, scene);
  problems.at("");
}

}  // namespace pliant
