// Warnings about an object: settings that a World accepts, but that are probably not intended.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "collision/fields/collider_pose.h"
#include "constraints/registry.h"
#include "geometry/shapes.h"
#include "inspect/problems.h"
#include "model/cohesion.h"
#include "model/compile_surface.h"
#include "model/object_sets.h"
#include "pliant/report.h"
#include "topology/boundary.h"
#include "topology/edges.h"

namespace pliant {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Mass ratio above which heavy particles that hang on light ones stretch their constraints like rubber.
constexpr double large_mass_ratio = 1e4;
/// The speed of sound [m/s]; higher speeds are probably not intended.
constexpr double large_speed = 343;
/// Larger coordinates suggest a mesh in millimetres or centimetres [m].
constexpr float large_place = 1e4f;
/// Relative deviation from the rest length above which an edge gets a warning.
constexpr double large_strain = 0.5;
/// Angle above which the rest shape of a hinge counts as curved [rad].
constexpr double large_angle = 0.1;

/// An object under inspection, with data that several checks need.
struct Doubts {
  Problems& problems;
  const Object& object;
  const Scene& scene;
  std::vector<bool> fixed;  ///< true for particles that are pinned or have infinite mass

  Vec3d at(int particle) const {
    const Vec3f& p = object.positions[static_cast<std::size_t>(particle)];
    return {p.x, p.y, p.z};
  }
  double inverse_mass(int particle) const {
    const auto i = static_cast<std::size_t>(particle);
    return fixed[i] ? 0 : 1 / static_cast<double>(object.masses[i]);
  }
  std::size_t count() const { return object.positions.size(); }
};

double distance_between(const Doubts& d, const int* pair) {
  return std::sqrt(length_squared(d.at(pair[1]) - d.at(pair[0])));
}

double rest_length(const Doubts& d, const ConstraintGroup& group, std::size_t constraint) {
  return group.rest.empty() ? distance_between(d, &group.particles[2 * constraint]) : group.rest[constraint];
}

// ------------------------------------------------------------------------------------------------ particles

void doubt_masses(const Doubts& d) {
  std::size_t lightest = d.count(), heaviest = d.count();
  for (std::size_t i = 0; i < d.count(); ++i) {
    if (d.fixed[i]) continue;
    if (lightest == d.count() || d.object.masses[i] < d.object.masses[lightest]) lightest = i;
    if (heaviest == d.count() || d.object.masses[i] > d.object.masses[heaviest]) heaviest = i;
  }
  if (lightest == d.count() && !d.object.bodies.empty()) return;  // fixed bodies are scenery
  if (lightest == d.count())
    return d.problems.doubtful("", "all particles are pinned or fixed, so the object only moves with its pins",
                               "pin fewer particles");
  const double ratio = static_cast<double>(d.object.masses[heaviest]) / static_cast<double>(d.object.masses[lightest]);
  const bool is_of_bodies = d.object.bodies.size() == d.count();  // their joints are solved directly
  if (ratio > large_mass_ratio && !is_of_bodies)
    d.problems.doubtful("particle " + std::to_string(heaviest),
                        "is " + words(ratio) + " times as heavy as particle " + std::to_string(lightest),
                        "use more substeps, or make the masses more equal (slivers in a mesh make light particles)");
}

void doubt_pins(const Doubts& d) {
  std::vector<bool> seen(d.count(), false);
  Tally twice;
  for (const Pin& pin : d.object.pins) {
    if (seen[static_cast<std::size_t>(pin.particle)]) twice.add(pin.particle);
    seen[static_cast<std::size_t>(pin.particle)] = true;
  }
  d.problems.doubtful(twice, "particle", "is pinned more than once", "only the last motion has an effect: pin it once");
}

void doubt_attachments(const Doubts& d) {
  Tally far;
  for (std::size_t i = 0; i < d.object.attachments.size(); ++i) {
    const Attachment& attachment = d.object.attachments[i];
    const Vec3d way = Vec3d{attachment.target.x, attachment.target.y, attachment.target.z} - d.at(attachment.particle);
    const double most = static_cast<double>(large_place);
    if (length_squared(way) > most * most) far.add(static_cast<std::int64_t>(i));
  }
  d.problems.doubtful(far, "attachment", "has its target more than 10 km from its particle",
                      "it pulls the particle there at once: targets are places in the world, in metres");
}

void doubt_references(const Doubts& d) {
  if (d.object.fluid || d.object.grains || d.object.tracers)
    return;  // whose particles are in no constraint of their own
  std::vector<bool> used = d.fixed;
  const auto use = [&](int particle) { used[static_cast<std::size_t>(particle)] = true; };
  for (const ConstraintGroup& group : d.object.constraints)
    std::for_each(group.particles.begin(), group.particles.end(), use);
  for (const auto& triangle : d.object.triangles) std::for_each(triangle.begin(), triangle.end(), use);
  for (const Attachment& attachment : d.object.attachments) use(attachment.particle);
  for (const ObjectBody& body : d.object.bodies) use(body.particle);
  for (const Cluster& cluster : d.object.clusters)
    std::for_each(cluster.particles.begin(), cluster.particles.end(), use);
  Tally loose;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (!used[i]) loose.add(static_cast<std::int64_t>(i));
  if (static_cast<std::size_t>(loose.count) == d.count()) return;  // a cloud of free particles, which is intended
  d.problems.doubtful(loose, "particle", "is in no constraint and no triangle, so it moves freely",
                      "remove it, or constrain it");
}

void doubt_places(const Doubts& d) {
  Tally far, fast;
  for (std::size_t i = 0; i < d.count(); ++i) {
    const Vec3f& p = d.object.positions[i];
    if (std::fabs(p.x) > large_place || std::fabs(p.y) > large_place || std::fabs(p.z) > large_place)
      far.add(static_cast<std::int64_t>(i));
    if (i < d.object.velocities.size() &&
        static_cast<double>(length_squared(d.object.velocities[i])) > large_speed * large_speed)
      fast.add(static_cast<std::int64_t>(i));
  }
  d.problems.doubtful(far, "particle", "is more than 10 km from the origin, where a float can't tell 1 mm apart",
                      "move the scene to the origin; lengths are in metres");
  d.problems.doubtful(fast, "particle", "is faster than sound at the start", "velocities are in m/s");
}

// ------------------------------------------------------------------------------------------------ constraints

/// True if half of the object's mass, hung on the constraint, would stretch it to more than ten times its length.
bool does_nothing(const Doubts& d, const ConstraintGroup& group, std::size_t c) {
  const double alpha = group.compliances.empty() ? group.stiffness.value : group.compliances[c];
  const int* pair = &group.particles[2 * c];
  const double inverse = d.inverse_mass(pair[0]) + d.inverse_mass(pair[1]);
  return inverse > 0 && alpha * 9.81 / inverse > 10 * std::max(rest_length(d, group, c), 1e-6);
}

void doubt_distances(const Doubts& d, const ConstraintGroup& group) {
  Tally strained, idle;
  double shortest = infinity;
  for (std::size_t c = 0; c < group.particles.size() / 2; ++c) {
    const double rest = rest_length(d, group, c), now = distance_between(d, &group.particles[2 * c]);
    if (std::fabs(now - rest) > large_strain * std::max(rest, 1e-6)) strained.add(static_cast<std::int64_t>(c));
    if (rest > 0) shortest = std::min(shortest, rest);
    if (group.stiffness.kind == Stiffness::Kind::compliance && does_nothing(d, group, c))
      idle.add(static_cast<std::int64_t>(c));
  }
  d.problems.doubtful(strained, "distance constraint",
                      "has a length that differs from its rest length by more than half",
                      "the object will jump at the start: check rest lengths and units");
  d.problems.doubtful(idle, "distance constraint",
                      "is so compliant that the weight of its particles stretches it tenfold",
                      "compliance is the inverse of stiffness, in m/N: 0 is rigid");
  const double most =
      d.object.triangles.empty() ? 10 * shortest : shortest;  // short links let a thick rope bend smoothly
  if (static_cast<double>(d.object.thickness) > most)
    d.problems.doubtful(
        "thickness", "is " + words(d.object.thickness) + " m, more than the shortest edge, " + words(shortest) + " m",
        "the object will hover above colliders: lengths are in metres");
}

/// Damping is that of a spring: what is rigid has none.
void doubt_damping(const Doubts& d, const ConstraintGroup& group) {
  const Stiffness& stiffness = group.stiffness;
  if (stiffness.kind != Stiffness::Kind::compliance || stiffness.value > 0 || !(stiffness.damping > 0)) return;
  if (!group.compliances.empty() || group.particles.empty()) return;
  d.problems.doubtful(group.type + " constraints, damping", "has no effect, because they are rigid",
                      "give a compliance, or remove the damping");
}

void doubt_hinges(const Doubts& d, const ConstraintGroup& group) {
  Tally flat, curved;
  for (std::size_t c = 0; c < group.particles.size() / 4; ++c) {
    const int* v = &group.particles[4 * c];
    const Vec3d x[4] = {d.at(v[0]), d.at(v[1]), d.at(v[2]), d.at(v[3])};
    const Vec3d edge = x[1] - x[0];
    if (length_squared(cross(edge, x[2] - x[0])) == 0 || length_squared(cross(edge, x[3] - x[0])) == 0)
      flat.add(static_cast<std::int64_t>(c));
    else if (std::fabs(fold_angle(x)) > large_angle)
      curved.add(static_cast<std::int64_t>(c));
  }
  const std::string kind = group.type + " constraint";
  d.problems.doubtful(flat, kind, "has a degenerate triangle", "its angle is undefined: remove the constraint");
  if (is_flat_hinge(group.type))
    d.problems.doubtful(curved, kind, "is curved at rest, but this type supports only flat rest shapes",
                        "the surface will flatten: use dihedral bending");
}

void doubt_surface(const Doubts& d) {
  if (d.object.triangles.empty()) return;
  const std::vector<Edge> edges = find_edges(d.object.triangles, static_cast<int>(d.count()));
  Tally torn, against;
  for (const Edge& edge : edges) {
    if (edge.triangle_count > 2) torn.add(edge.triangles[0]);
    if (!edge.is_wound_consistently()) against.add(edge.triangles[1]);
  }
  d.problems.doubtful(torn, "triangle", "shares an edge with two or more other triangles",
                      "the surface is not a manifold there");
  if (against.count == 0) return;
  const bool one_sided = !find_pieces(edges, static_cast<int>(d.object.triangles.size())).one_sided_edges.empty();
  d.problems.doubtful(
      against, "triangle", "has the opposite winding of its neighbour",
      one_sided ? "the surface is one-sided: pictures will show a seam" : "flip it, so that pictures are smooth there");
}

void doubt_volume(const Doubts& d) {
  if (!d.object.volume) return;
  double six_volumes = 0;
  const Vec3d origin = d.at(0);
  for (const auto& t : d.object.triangles)
    six_volumes += dot(cross(d.at(t[0]) - origin, d.at(t[1]) - origin), d.at(t[2]) - origin);
  if (six_volumes < 0)
    d.problems.doubtful("volume", "is inside out: its triangles face inward",
                        "flip all triangles; make_cloth does so itself");
  const bool is_rigid =
      d.object.volume->stiffness.kind == Stiffness::Kind::pbd || d.object.volume->stiffness.value == 0;
  const double frame = static_cast<double>(d.scene.frame_time);
  const bool is_strained =
      strain_of_inflated(d.object) > tolerated_p99;  // less is within the bounds even if no edge yields
  if (is_rigid && is_strained && !can_follow_volume(d.object, frame / substeps_of_volumes))
    d.problems.doubtful(
        "volume",
        "has a pressure of " + words(largest_pressure(*d.object.volume)) + ", for which edges must become " +
            words(std::round(1000 * strain_of_inflated(d.object)) / 10) + " % longer, but they are too stiff for that",
        "lower the pressure, or give the distances more compliance");
}

// ------------------------------------------------------------------------------------------------ surroundings

void doubt_overlaps(const Doubts& d) {
  for (const Collider& collider : d.scene.colliders) {
    const LocalShape shape = local_shape(collider.shape);
    const Posed pose = collider_pose(collider, 0);
    Tally inside;
    for (std::size_t i = 0; i < d.count(); ++i) {
      if (d.fixed[i]) continue;
      const Vec3d local = to_local(pose, d.at(static_cast<int>(i)));
      if (signed_distance(shape, local).distance < -1e-4) inside.add(static_cast<std::int64_t>(i));
    }
    d.problems.doubtful(inside, "particle", "is inside of collider '" + collider.name + "' at the start",
                        "contact will push it out: move one of them");
  }
}

/// Says by how much too few substeps compress a liquid: by the square of their length, over their iterations.
void doubt_compression(const Doubts& d) {
  constexpr double mean_by_default = 0.0035, tolerated = 0.01;
  const Settings& settings = d.scene.settings;
  if (!d.object.fluid || settings.substeps <= 0) return;
  const int needed = substeps_of_fluid(d.object, static_cast<double>(d.scene.frame_time));
  const double longer = static_cast<double>(needed) / settings.substeps;
  const double mean = mean_by_default * longer * longer / settings.iterations;
  if (mean <= tolerated) return;
  d.problems.doubtful(
      "settings, substeps",
      "are so few that the liquid will be about " + words(100 * mean) + " % denser than at rest on average",
      "use " + std::to_string(needed) + ", or leave substeps out");
}

/// Says by how much too few substeps weaken surface tension.
void doubt_tension(const Doubts& d) {
  constexpr double tolerated = 1.2;  // the bound of solver/fluids/tension_law.cpp over the substeps by default
  const Settings& settings = d.scene.settings;
  if (!d.object.fluid || settings.substeps <= 0) return;
  const int needed = substeps_of_tension(d.object, static_cast<double>(d.scene.frame_time));
  const double longer = static_cast<double>(needed) / (settings.substeps * tolerated);
  if (longer <= 1) return;
  d.problems.doubtful(
      "settings, substeps",
      "are so few that only about " + words(100 / (longer * longer)) + " % of the surface tension can act",
      "use " + std::to_string(needed) + ", or leave substeps out");
}

/// Says so where a contact angle or a cohesion has no effect, or not all of it.
void doubt_adhesion(const Doubts& d) {
  const Settings& settings = d.scene.settings;
  if (d.object.fluid && d.object.fluid->contact_angle < 180 && !(d.object.fluid->surface_tension > 0))
    d.problems.doubtful("contact_angle", "has no effect without surface tension", "give a surface_tension too");
  if (!d.object.grains || settings.substeps <= 0) return;
  const double frame_time = static_cast<double>(d.scene.frame_time);
  const double share = acting_cohesion(d.object, frame_time, settings.substeps);
  if (share == 1) return;
  d.problems.doubtful("settings, substeps",
                      "are so few that only about " + words(100 * share) + " % of the cohesion can act",
                      "use " + std::to_string(substeps_of_cohesion(d.object, frame_time)) + ", or leave substeps out");
}

/// True if the wind could act on a body.
bool has_capsule(const Object& object) {
  return std::any_of(object.bodies.begin(), object.bodies.end(), [](const ObjectBody& body) {
    return body.solids.size() == 1 && std::holds_alternative<Capsule>(body.solids[0].shape);
  });
}

void doubt_air(const Doubts& d) {
  const Wind& wind = d.scene.wind;
  if (length_squared(wind.velocity) > 0 && wind.air_density > 0 && (d.object.fluid || d.object.grains) && !d.object.gas)
    d.problems.doubtful("", "is not pushed by the wind, which acts on triangles and on bodies that are one capsule",
                        "leave the wind out, or push the particles by a force field");
  if (length_squared(wind.velocity) > 0 && wind.air_density == 0 &&
      (!d.object.triangles.empty() || has_capsule(d.object)))
    d.problems.doubtful("", "has no effect from wind, because the air density is 0",
                        "set the wind's air_density, for example to 1.2 kg/m^3");
}

void doubt_tracers(const Doubts& d) {
  if (!d.object.tracers || !(d.object.tracers->end > 0) || d.object.tracers->end > d.object.tracers->start) return;
  d.problems.doubtful("tracers, end", "is not after their start, so that none are emitted",
                      "give a later end, or 0 to emit for ever");
}

std::vector<bool> fixed_particles(const Object& object) {
  std::vector<bool> fixed(object.positions.size());
  for (std::size_t i = 0; i < fixed.size(); ++i) fixed[i] = std::isinf(object.masses[i]);
  for (const Pin& pin : object.pins) fixed[static_cast<std::size_t>(pin.particle)] = true;
  return fixed;
}

}  // namespace

void doubt_object(Problems& problems, const Object& object, const Scene& scene) {
  const Doubts doubts{problems, object, scene, fixed_particles(object)};
  doubt_masses(doubts);
  doubt_pins(doubts);
  doubt_attachments(doubts);
  doubt_bodies(problems, object);
  doubt_joints(problems, object);
  doubt_tears(problems, object, scene);
  doubt_absorbency(problems, object, scene);
  doubt_references(doubts);
  doubt_places(doubts);
  for (const ConstraintGroup& group : object.constraints) {
    if (is_length(group.type)) doubt_distances(doubts, group);
    if (is_hinge(group.type)) doubt_hinges(doubts, group);
    doubt_damping(doubts, group);
  }
  doubt_elements(problems, object);
  doubt_surface(doubts);
  doubt_volume(doubts);
  doubt_overlaps(doubts);
  doubt_air(doubts);
  doubt_compression(doubts);
  doubt_tension(doubts);
  doubt_adhesion(doubts);
  doubt_tracers(doubts);
}

}  // namespace pliant
