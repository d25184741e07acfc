// Errors in how an object tears, is cut, and what skin it has.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "constraints/distance_limit.h"
#include "constraints/registry.h"
#include "inspect/problems.h"
#include "math/vector.h"
#include "matter/break_constraints.h"
#include "matter/edit_parts.h"
#include "model/object_sets.h"
#include "model/rods.h"
#include "model/soft_body_substeps.h"

namespace pliant {

namespace {

bool has_links(const Object& object) {
  for (const ConstraintGroup& group : object.constraints)
    if (find_constraint_type(group.type) >= 0 && is_length(group.type)) return true;
  return false;
}

/// True if edges are limited to less than the stretch at which they tear.
bool is_never_reached(const Object& object) {
  for (const ConstraintGroup& group : object.constraints) {
    if (group.type != DistanceLimit::name || !group.keyframes.empty()) continue;  // threads
    for (std::size_t i = 0; 2 * i + 1 < std::min(group.particles.size(), group.rest.size()); ++i) {
      const auto a = static_cast<std::size_t>(group.particles[2 * i]),
                 b = static_cast<std::size_t>(group.particles[2 * i + 1]);
      if (a >= object.positions.size() || b >= object.positions.size()) continue;
      if (group.rest[2 * i] < object.tearing->stretch * length(object.positions[b] - object.positions[a])) return true;
    }
  }
  return false;
}

/// True if a World has made a cut, and has said so in the description.
bool is_made(const PlaneCut& cut) { return std::isinf(cut.start) && cut.start > 0 && cut.start == cut.end; }

void check_tearing(Problems& problems, const Object& object) {
  if (!object.tearing) return;
  if (!(object.tearing->stretch > 1 && object.tearing->stretch <= 1e6f))
    problems.grave("tearing, stretch", "is " + words(static_cast<double>(object.tearing->stretch)),
                   "give the greatest length over that at rest, above 1");
  for (const ConstraintGroup& group : object.constraints) {
    if (!group.keyframes.empty() && group.type == "distance")
      problems.grave("tearing", "is of an object whose rest lengths change, which a stretch cannot be measured by",
                     "leave the keyframes or the tearing out");
  }
  if (is_never_reached(object))
    problems.doubtful("tearing", "is of an object whose limits of strain keep it from being stretched so far",
                      "give a strain_limit whose `most` is above the stretch of the tearing");
  if (!is_soft_body(object) && !has_links(object) && !has_rods(object))
    problems.grave("tearing", "is of an object without distance constraints, tetrahedra or rods, so nothing can tear",
                   "give it to cloth of springs, a rope, a rod or a soft body");
}

void check_cut(Problems& problems, const PlaneCut& cut, const std::string& name) {
  if (is_made(cut)) return;
  require_range(problems, name + ", start", static_cast<double>(cut.start), 0, static_cast<double>(largest_place));
  require_range(problems, name + ", end", static_cast<double>(cut.end), static_cast<double>(cut.start),
                static_cast<double>(largest_place));
  require_place(problems, name + ", point", cut.point);
  require_place(problems, name + ", normal", cut.normal);
  require_place(problems, name + ", along", cut.along);
  const Vec3f across = cross(cut.normal, cut.along);
  const float sizes = length_squared(cut.normal) * length_squared(cut.along);
  if (!(length_squared(cut.normal) > 1e-12f) || !(length_squared(across) > 1e-8f * sizes))
    problems.grave(name, "has a normal of no direction, or a blade that moves along it",
                   "let `along` be a direction in the plane");
}

void check_skin(Problems& problems, const Object& object) {
  if (!object.skin) return;
  const Skin& skin = *object.skin;
  if (skin.triangles.empty()) problems.grave("skin", "has no triangles", "leave it out");
  if (object.fluid || object.grains || object.tracers)
    problems.grave("skin", "is of a liquid, a gas, grains or tracers", "leave it out");
  if (object.tearing || !object.cuts.empty())
    problems.grave("skin", "is of an object that tears or is cut, which a skin cannot follow", "leave the skin out");
  Tally bad_vertices, bad_triangles;
  for (std::size_t i = 0; i < skin.vertices.size(); ++i)
    for (std::size_t k = 0; k < 4; ++k) {
      const int particle = skin.vertices[i].particles[k];
      if (particle >= 0 && static_cast<std::size_t>(particle) < object.positions.size() &&
          std::isfinite(skin.vertices[i].weights[k]))
        continue;
      bad_vertices.add(static_cast<std::int64_t>(i));
      break;
    }
  for (std::size_t t = 0; t < skin.triangles.size(); ++t)
    for (const int corner : skin.triangles[t])
      if (corner < 0 || static_cast<std::size_t>(corner) >= skin.vertices.size()) {
        bad_triangles.add(static_cast<std::int64_t>(t));
        break;
      }
  problems.grave(bad_vertices, "skin vertex", "uses a particle that does not exist, or a weight that is not finite",
                 "make_skin makes sound ones");
  problems.grave(bad_triangles, "skin triangle", "uses a vertex that does not exist", "indices count from 0");
}

/// By how much rounding changes the force of constraint `number` that the World knows [N]: by its elongation or by its
/// multiplier, whichever is more exact.
double error_of_force(const Object& object, const ConstraintGroup& group, int number, double h) {
  const std::vector<int> stencil = stencil_of(group, slots_of(group, object), number);
  double extent = 0, mass = std::numeric_limits<double>::infinity();
  for (const int p : points_of(type_of(group, object), stencil, object)) {
    const Vec3f& x = object.positions[static_cast<std::size_t>(p)];
    const Vec3f& first = object.positions[static_cast<std::size_t>(stencil[0])];
    extent = std::max(extent, length(convert<double>(x) - convert<double>(first)));
    mass = std::min(mass, static_cast<double>(object.masses[static_cast<std::size_t>(p)]));
  }
  const auto alpha = static_cast<double>(
      group.compliances.empty() ? group.stiffness.value : group.compliances[static_cast<std::size_t>(number)]);
  return rounding_of_elongation(extent) * std::min(1 / alpha, mass / (h * h));
}

void doubt_break_forces(Problems& problems, const Object& object, const Scene& scene) {
  const double h = static_cast<double>(scene.frame_time) / most_substeps_of(scene.settings);
  constexpr double most_error = 0.1;  // as a share of the force
  for (const ConstraintGroup& group : object.constraints) {
    if (!(group.break_force > 0) || !breaks_by_force(group.type)) continue;
    const int count = static_cast<int>(group.particles.size()) / slots_of(group, object);
    double error = 0;
    for (int c = 0; c < count; ++c) error = std::max(error, error_of_force(object, group, c, h));
    if (error > most_error * static_cast<double>(group.break_force))
      problems.doubtful(group.type + " constraints",
                        "break at " + words(static_cast<double>(group.break_force)) +
                            " N, but rounding changes their force by " + words(error) + " N",
                        "give a greater compliance or fewer substeps");
  }
}

}  // namespace

void doubt_tears(Problems& problems, const Object& object, const Scene& scene) {
  if (object.tearing && object.tearing->stretch < 1.02f)
    problems.doubtful("tearing, stretch",
                      "is " + words(static_cast<double>(object.tearing->stretch)) +
                          ", which the error of the solve exceeds, so it may tear by itself",
                      "give 1.05 or more");
  doubt_break_forces(problems, object, scene);
  for (std::size_t i = 0; i < object.cuts.size(); ++i) {
    const PlaneCut& cut = object.cuts[i];
    const std::string name = "cut " + std::to_string(i);
    if (is_made(cut)) continue;
    if (static_cast<double>(cut.start) > scene.frames * static_cast<double>(scene.frame_time))
      problems.doubtful(name, "starts after the last frame", "give more frames, or an earlier time");
    bool is_before = false, is_behind = false;
    const int world = world_particle(object);
    for (std::size_t p = 0; p < object.positions.size(); ++p) {
      if (static_cast<int>(p) == world) continue;
      (dot(object.positions[p] - cut.point, cut.normal) > 0 ? is_before : is_behind) = true;
    }
    if (!is_before || !is_behind)
      problems.doubtful(name, "misses the object", "let `point` lie in the object's rest shape");
  }
  if (!object.skin) return;
  Tally far;
  for (std::size_t v = 0; v < object.skin->vertices.size(); ++v)
    for (const float weight : object.skin->vertices[v].weights)
      if (std::fabs(weight) > 4) {
        far.add(static_cast<std::int64_t>(v));
        break;
      }
  problems.doubtful(far, "skin vertex", "lies far outside of the tetrahedra, and will exaggerate how they move",
                    "move the skin to where the body is");
}

void check_tears(Problems& problems, const Object& object) {
  check_tearing(problems, object);
  for (std::size_t i = 0; i < object.cuts.size(); ++i) check_cut(problems, object.cuts[i], "cut " + std::to_string(i));
  if (!object.cuts.empty() && object.triangles.empty() && !has_links(object) && !is_soft_body(object) &&
      !has_rods(object))
    problems.grave("cuts", "are of an object without triangles, links or rods, so there is nothing to cut",
                   "leave them out");
  check_skin(problems, object);
}

}  // namespace pliant
