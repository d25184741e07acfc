// Findings about contact: invalid mesh colliders, and a thickness that is too large for the mesh or too costly.
// inspect_tangles.cpp has those about initial intersections.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "collision/fields/solid_fields.h"
#include "constraints/registry.h"
#include "inspect/inspect_scene.h"
#include "inspect/problems.h"
#include "math/vector.h"
#include "model/soft_body_substeps.h"
#include "pliant/error.h"
#include "topology/edges.h"
#include "topology/folds.h"

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
                   "make it coarser: the limit is 536870911");
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

}  // namespace

double median_edge(const Object& object) {
  std::vector<double> lengths;
  for (const auto& t : object.triangles)
    for (std::size_t k = 0; k < 3; ++k) lengths.push_back(distance_of(object.positions, t[k], t[(k + 1) % 3]));
  const auto links = std::find_if(object.constraints.begin(), object.constraints.end(),
                                  [](const ConstraintGroup& group) { return is_length(group.type); });
  if (object.triangles.empty() && links != object.constraints.end())
    for (std::size_t i = 0; i + 1 < links->particles.size(); i += 2)
      lengths.push_back(distance_of(object.positions, links->particles[i], links->particles[i + 1]));
  if (lengths.empty()) return 0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return *middle;
}

namespace {

// ------------------------------------------------------------------------------------------------ cost

/// Number of pairs per vertex that contact tests on a sheet whose thickness suits its edge length.
constexpr double usual_pairs = 60;

/// Estimates how many pairs of an object's own primitives are near. A vertex has triangles of area A within the contact
/// distance plus one edge; the number of pairs is three times theirs. On grids with a thickness of one to nine edges
/// the error is within 15 %.
double estimated_pairs(const Object& object, double kept) {
  std::vector<double> areas(object.positions.size(), 0);
  std::vector<int> triangles(object.positions.size(), 0);
  for (const auto& t : object.triangles) {
    const Vec3f &a = object.positions[static_cast<std::size_t>(t[0])],
                &b = object.positions[static_cast<std::size_t>(t[1])],
                &c = object.positions[static_cast<std::size_t>(t[2])];
    const double area = 0.5 * std::sqrt(static_cast<double>(length_squared(cross(b - a, c - a))));
    for (const int corner : t) {
      areas[static_cast<std::size_t>(corner)] += area;
      ++triangles[static_cast<std::size_t>(corner)];
    }
  }
  constexpr double pi = 3.14159265358979323846;
  double pairs = 0;
  const double all = static_cast<double>(object.triangles.size());
  for (std::size_t i = 0; i < areas.size(); ++i) {
    if (!(areas[i] > 0)) continue;
    const double area = areas[i] / triangles[i], reach = kept + std::sqrt(2 * area);
    pairs += 3 * std::min(all, pi * reach * reach / area);
  }
  return pairs;
}

/// Warns of a large thickness: if it is n edges, on the whole mesh or on its finest part, a frame takes n^2 times as
/// long.
void doubt_cost(Problems& problems, const Object& object) {
  if (!object.self_collision || object.triangles.empty()) return;
  const double kept = 2 * static_cast<double>(object.thickness),
               usual = usual_pairs * static_cast<double>(object.positions.size());
  const double pairs = estimated_pairs(object, kept);
  constexpr double out_of_proportion = 5;
  if (pairs < out_of_proportion * usual) return;
  double fitting = kept;
  while (fitting > 1e-9 && estimated_pairs(object, fitting) > 2 * usual) fitting *= 0.8;
  problems.doubtful("thickness",
                    "is " + words(object.thickness) + " m: about " + words(pairs / 1e6) +
                        " million pairs of its primitives are tested, " + words(std::round(pairs / usual)) +
                        " times as many as usual, and a frame takes longer by the same factor",
                    "reduce it to about " + words(fitting / 2) + " m, or use a coarser or more even mesh");
}

void doubt_thickness(Problems& problems, const Object& object) {
  if (!object.self_collision && !object.collides) return;
  const double edge = median_edge(object), kept = 2 * static_cast<double>(object.thickness);
  if (object.fluid || object.grains || object.tracers || (edge == 0 && object.bodies.size() == object.positions.size()))
    return;
  if (edge == 0)
    return problems.doubtful("", "has neither triangles nor links: its particles collide as spheres of its thickness",
                             "add triangles or links if it is meant as a surface or a rope");
  if (kept > edge &&
      !object.triangles.empty())  // ropes bend no more sharply than they are thick, so they need no warning
    problems.doubtful("thickness",
                      "is " + words(object.thickness) +
                          " m: two layers keep twice this distance, more than the median edge, " + words(edge) + " m",
                      "contact will push folds open: reduce it, or use a coarser mesh");
  if (object.thickness == 0)
    problems.doubtful("thickness", "is 0: only the filter's separating margin would keep layers apart",
                      "set it to about a tenth of an edge");
}

template <class A, class B>
bool masks_allow(const A& a, const B& b) {
  return (a.groups & b.mask) != 0 && (b.groups & a.mask) != 0;
}

/// Warns of an object that is set to collide but can meet nothing: it would pass through everything.
void doubt_company(Problems& problems, const Object& object, const Scene& scene) {
  if (!object.collides || !object.bodies.empty() || object.fluid || object.grains || is_soft_body(object))
    return;  // which collide by default
  const auto is_met_by_object = [&](const Object& other) {
    return &other != &object && other.collides && masks_allow(object, other);
  };
  const auto is_met_by_mesh = [&](const MeshCollider& mesh) {
    return mesh.as == MeshCollider::As::triangles && masks_allow(object, mesh);
  };
  if (std::any_of(scene.objects.begin(), scene.objects.end(), is_met_by_object) ||
      std::any_of(scene.mesh_colliders.begin(), scene.mesh_colliders.end(), is_met_by_mesh))
    return;
  problems.doubtful("collides", "is set, but the object can collide with no other object or mesh collider",
                    "set `collides` on another object too, and let the mask of each contain a group of the other; "
                    "primitive colliders need no `collides`");
}

/// The mean finite mass of a surface's particles [kg]; 0 where there is none.
double particle_mass(const Object& object) {
  double sum = 0, count = 0;
  for (const float mass : object.masses) {
    if (!std::isfinite(mass) || object.triangles.empty()) continue;
    sum += static_cast<double>(mass);
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

/// A sheet whose particles are so much heavier than those of one that it can press on that contact hardly converges:
/// the light sheet yields in each projection, and the filter holds both in round after round.
struct HeavySheet {
  const Object* object;
  std::string problem, advice;
};

HeavySheet words_of_heavy(const Object& heavy, const Object& light, double ratio, double most_ratio) {
  return {&heavy,
          "are " + words(std::round(ratio)) + " times those of '" + light.name +
              "', on which it can press: contact between them yields, and frames may take ten times as long",
          "let the masses of a particle differ by less than " + words(most_ratio) +
              " times, hold the heavy one by pins or a collider, or let masks keep them apart; the setting "
              "`most_substeps` bounds what frames take"};
}

std::vector<HeavySheet> find_heavy_sheets(const Scene& scene) {
  constexpr double most_ratio = 1e4;
  struct Sheet {
    const Object* object;
    double mass;
  };
  std::vector<Sheet> sheets;
  double least = std::numeric_limits<double>::infinity();
  for (const Object& object : scene.objects) {
    const double mass = object.collides ? particle_mass(object) : 0;
    if (!(mass > 0)) continue;
    sheets.push_back({&object, mass});
    least = std::min(least, mass);
  }
  std::vector<HeavySheet> found;
  for (const Sheet& heavy : sheets) {
    if (heavy.mass < most_ratio * least) continue;
    const auto light = std::find_if(sheets.begin(), sheets.end(), [&](const Sheet& other) {
      return heavy.mass >= most_ratio * other.mass && masks_allow(*heavy.object, *other.object);
    });
    if (light != sheets.end())
      found.push_back(words_of_heavy(*heavy.object, *light->object, heavy.mass / light->mass, most_ratio));
  }
  return found;
}

void doubt_masses(Problems& problems, const Scene& scene) {
  for (const HeavySheet& found : find_heavy_sheets(scene)) {
    problems.at(found.object->name);
    problems.doubtful("masses", found.problem, found.advice);
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
      problems.grave(name, "is at " + words(frame.time) + " s, but times must increase", "sort frames by time");
    if (frame.positions.size() != vertices)
      problems.grave(
          name, "has " + counted(frame.positions.size(), "vertex position") + ", the mesh " + std::to_string(vertices),
          "give one position per vertex of the mesh, in its order");
    Tally not_places;
    for (std::size_t i = 0; i < frame.positions.size(); ++i)
      if (!is_place(frame.positions[i])) not_places.add(static_cast<std::int64_t>(i));
    problems.grave(not_places, name + ", vertex", "has a position that is not finite or more than 1e9 m away",
                   "give finite coordinates in metres, near the origin");
  }
  if (!collider.frames.empty() && collider.as != MeshCollider::As::triangles)
    problems.grave("frames", "are given for a distance grid or a heightfield, which cannot deform",
                   "remove them, or use the mesh as triangles");
}

/// Checks a mesh collider as a distance grid or heightfield; call it if its mesh has no grave finding.
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

namespace {

/// Warns of edges whose two triangles lie on one another, in the words of the inspection of a mesh.
void doubt_folds(Problems& problems, const std::vector<Vec3f>& positions,
                 const std::vector<std::array<int, 3>>& triangles) {
  const std::vector<Edge> edges = find_edges(triangles, static_cast<int>(positions.size()));
  const std::vector<int> folded = folded_edges(positions, edges);
  if (folded.empty()) return;
  const Edge& first = edges[static_cast<std::size_t>(folded.front())];
  const std::string more = folded.size() > 1 ? " and " + std::to_string(folded.size() - 1) + " more" : "";
  problems.doubtful(
      "edge " + std::to_string(first.a) + "-" + std::to_string(first.b) + more, "folds the surface back on itself",
      "the two triangles there lie on one another, so that contact has no side to push to; open the fold, or "
      "remove one of them");
}

/// Reports triangles that give contact no direction.
void doubt_shapes(Problems& problems, const TriangleMesh& mesh) {
  const auto at = [&](int vertex) { return convert<double>(mesh.positions[static_cast<std::size_t>(vertex)]); };
  Tally flat;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    if (!(length_squared(cross(at(b) - at(a), at(c) - at(a))) > 0)) flat.add(static_cast<std::int64_t>(i));
  }
  problems.doubtful(flat, "triangle", "has no area, so that it has no side", "remove it, as read_mesh does");
  doubt_folds(problems, mesh.positions, mesh.triangles);
}

}  // namespace

void check_mesh_collider(Problems& problems, const MeshCollider& collider) {
  const int before = problems.grave_count();
  check_mesh(problems, collider.mesh);
  if (problems.wants_doubts() && problems.grave_count() == before) doubt_shapes(problems, collider.mesh);
  check_frames(problems, collider);
  check_solid(problems, collider);
  check_motion(problems, "motion", collider.motion);
  require_range(problems, "thickness", collider.thickness, 0, largest_place);
  check_friction(problems, collider.static_friction, collider.kinetic_friction, collider.restitution);
  check_rolling(problems, collider.rolling_friction, collider.spinning_friction);
  check_surface_velocity(problems, "surface_velocity", collider.surface_velocity);
  if (!is_finite(collider.colour)) problems.grave("colour", "is not finite", "give red, green and blue from 0 to 1");
}

namespace {

/// What a pair names: an object, or a mesh collider.
struct Named {
  const Object* object = nullptr;
  const MeshCollider* mesh = nullptr;

  /// Of bodies alone: ropes between them keep a thickness.
  bool is_of_bodies() const {
    return object != nullptr && !object->bodies.empty() && object->bodies.size() == object->positions.size();
  }
  bool is_solid_mesh() const { return mesh != nullptr && mesh->as != MeshCollider::As::triangles; }
};

Named find_named(const Scene& scene, const std::string& name) {
  const auto called = [&](const auto& one) { return one.name == name; };
  const auto object = std::find_if(scene.objects.begin(), scene.objects.end(), called);
  const auto mesh = std::find_if(scene.mesh_colliders.begin(), scene.mesh_colliders.end(), called);
  return {object == scene.objects.end() ? nullptr : &*object, mesh == scene.mesh_colliders.end() ? nullptr : &*mesh};
}

/// Refuses what a pair sets, and contact of its kind does not read.
void refuse_idle_pair(Problems& problems, const Scene& scene, const PairProperties& pair, const std::string& name) {
  const Named first = find_named(scene, pair.first), second = find_named(scene, pair.second);
  for (const auto& [one, called] : {std::pair{first, pair.first}, std::pair{second, pair.second}})
    if (one.is_solid_mesh())
      problems.grave(name, "names '" + called + "', a distance grid or heightfield, and has no effect on it",
                     "set the properties of that mesh collider itself, or use it as triangles");
  const auto is_of_grains = [](const Named& one) { return one.object != nullptr && one.object->grains; };
  if (is_of_grains(first) && is_of_grains(second))
    problems.grave(name, "names grains twice, and has no effect on contact of grains with one another",
                   "set the properties of the grains themselves");
  const bool is_rigid = (first.is_of_bodies() && (second.is_of_bodies() || second.mesh != nullptr)) ||
                        (second.is_of_bodies() && first.mesh != nullptr);
  if (is_rigid && pair.thickness)
    problems.grave(name + ", thickness",
                   "has no effect: rigid bodies touch one another and mesh colliders at their surfaces",
                   "remove it, or make the solids larger");
}

}  // namespace

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
        problems.grave(name, "names '" + one + "', which is not an object or mesh collider", "use the name of one");
    require_range(problems, name + ", thickness", pair.thickness.value_or(0), 0, largest_place);
    require_range(problems, name + ", static_friction", pair.static_friction.value_or(0), 0, largest_place);
    require_range(problems, name + ", kinetic_friction", pair.kinetic_friction.value_or(0), 0, largest_place);
    require_range(problems, name + ", restitution", pair.restitution.value_or(0), 0, 1);
    if (pair.static_friction && pair.kinetic_friction && *pair.kinetic_friction > *pair.static_friction)
      problems.grave(name + ", kinetic_friction", "is larger than the static one",
                     "lower it to the static friction or less");
    refuse_idle_pair(problems, scene, pair, name);
  }
}

void doubt_contact(Problems& problems, const Scene& scene) {
  for (const Object& object : scene.objects) {
    problems.at(object.name);
    doubt_thickness(problems, object);
    doubt_cost(problems, object);
    doubt_company(problems, object, scene);
    if (object.self_collision) doubt_folds(problems, object.positions, object.triangles);
  }
  doubt_masses(problems, scene);
  doubt_tangles(problems, scene);
  problems.at("");
}

std::vector<std::string> warnings_of_masses(const Scene& scene) {
  std::vector<std::string> warnings;
  for (const HeavySheet& found : find_heavy_sheets(scene))
    warnings.push_back("object '" + found.object->name + "', masses: " + found.problem + "; " + found.advice);
  return warnings;
}

}  // namespace pliant
