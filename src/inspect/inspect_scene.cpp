// Inspects a whole scene: settings, air, colliders, and each object in turn.
#include "inspect/inspect_scene.h"
#include "constraints/registry.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "inspect/problems.h"
#include "math/vector.h"
#include "matter/object_facts.h"
#include "model/object_sets.h"
#include "pliant/error.h"
#include "pliant/substep_bounds.h"
#include "solver/kernels.h"

namespace pliant {

namespace {

bool has_natural(const Scene& scene) {
  const bool by_default = scene.settings.sweep == Sweep::natural;
  return (by_default && scene.objects.empty()) ||
         std::any_of(scene.objects.begin(), scene.objects.end(), [&](const Object& object) {
           return object.sweep == Sweep::natural || (by_default && object.sweep == Sweep::automatic);
         });
}

void check_sweep(Problems& problems, const Settings& settings, bool uses_natural) {
  const SweepOptions& options = settings.sweep_options;
  if (!(options.relaxation > 0 && options.relaxation < 2))
    problems.grave("settings, sweep_options, relaxation", "is " + words(options.relaxation),
                   "give a number above 0 and below 2; 1 is no relaxation");
  require_range(problems, "settings, sweep_options, tether_slack", options.tether_slack, 0, 1000);
  require_range(problems, "settings, sweep_options, chain_softness", options.chain_softness, 0, 1000);
  require_range(problems, "settings, sweep_options, most_overstretch", options.most_overstretch, 0, 1000);
  require_range(problems, "settings, sweep_options, multigrid_cycles", options.multigrid_cycles, 1, 100);
  if (options.acceleration == SweepOptions::Acceleration::none) return;
  require_range(problems, "settings, sweep_options, plain_iterations", options.plain_iterations, 1, 10000);
  if (!(options.spectral_radius >= 0 && options.spectral_radius < 1))
    problems.grave("settings, sweep_options, spectral_radius", "is " + words(options.spectral_radius),
                   "give a number above 0 and below 1, or 0 to have it estimated");
  if (options.spectral_radius == 0 && options.plain_iterations < 2)
    problems.grave("settings, sweep_options, plain_iterations",
                   "is 1, but the estimate of the spectral radius needs at least 2",
                   "set it to 2 or more, or give spectral_radius");
  if (settings.iterations <= options.plain_iterations)
    problems.doubtful("settings, sweep_options, acceleration",
                      "has no effect: a substep has " + words(settings.iterations) + " iterations, and the first " +
                          words(options.plain_iterations) + " are plain",
                      "give more iterations than plain_iterations, or leave it out");
  if (uses_natural)
    problems.grave("settings, sweep_options, acceleration",
                   "is Chebyshev over Gauss-Seidel in natural order, which diverges: its iteration matrix is far from "
                   "symmetric, so the extrapolation amplifies rounding errors without bound",
                   "use it with the tiled, the symmetric or the Jacobi sweep");
}

void check_bounds(Problems& problems, const Settings& settings) {
  require_range(problems, "settings, most_substeps", settings.most_substeps, 0, 10000);
  require_range(problems, "settings, least_substeps", settings.least_substeps, 0, 10000);
  if (const auto error = error_of_bounds(settings))
    problems.grave(error->where().element, error->problem(), error->advice());
}

void check_sleep(Problems& problems, const SleepOptions& sleep) {
  const auto check = [&](const char* name, float value, const char* unit) {
    if (!(value > 0 && value <= 1000))
      problems.grave(std::string("settings, sleep, ") + name, "is " + words(value) + " " + unit,
                     std::string("give a number above 0 and up to 1000 ") + unit);
  };
  check("speed", sleep.speed, "m/s");
  check("spin", sleep.spin, "rad/s");
  require_range(problems, "settings, sleep, time", sleep.time, 0, 1e6f);
}

void check_settings(Problems& problems, const Scene& scene) {
  const Settings& settings = scene.settings;
  require_range(problems, "settings, substeps", settings.substeps, 0, 10000);
  require_range(problems, "settings, iterations", settings.iterations, 1, 10000);
  require_range(problems, "settings, threads", settings.threads, 0, 1024);
  require_range(problems, "settings, tolerance", settings.tolerance, 0, largest_place);
  check_bounds(problems, settings);
  if (!(settings.untangling_speed > 0 && settings.untangling_speed <= 1000))
    problems.grave("settings, untangling_speed", "is " + words(settings.untangling_speed) + " m/s",
                   "give a speed above 0 and up to 1000 m/s");
  check_sleep(problems, settings.sleep);
  check_sweep(problems, settings, has_natural(scene));
  require_range(problems, "frames", scene.frames, 0, std::numeric_limits<int>::max());
  if (!(scene.frame_time > 0) || std::isinf(scene.frame_time))
    problems.grave("frame_time", "is " + words(scene.frame_time) + " s",
                   "give a positive, finite time, such as 1/60 s");
  else if (settings.substeps >= 0 &&
           scene.frame_time / static_cast<double>(most_substeps_of(settings)) < shortest_substep)
    problems.grave("frame_time", "is " + words(scene.frame_time) + " s, which makes substeps too short for floats",
                   "give a longer time or fewer substeps, such as 1/60 s and 20");
  try {
    pick_kernels(settings.isa);
  } catch (const Error& error) {
    problems.grave("settings, isa", error.problem(), error.advice());
  }
}

void check_forces(Problems& problems, const Scene& scene) {
  require_place(problems, "gravity", scene.gravity);
  require_place(problems, "wind, velocity", scene.wind.velocity);
  require_range(problems, "wind, gust", scene.wind.gust, 0, 1);
  require_range(problems, "wind, air_density", scene.wind.air_density, 0, largest_place);
  if (scene.wind.gust > 0 && !(scene.wind.gust_period > 0 && scene.wind.gust_period <= largest_place))
    problems.grave("wind, gust_period", "is " + words(scene.wind.gust_period) + " s", "give a positive, finite time");
  for (std::size_t i = 0; i < scene.forces.size(); ++i)
    if (!scene.forces[i])
      problems.grave("force " + std::to_string(i), "is an empty function", "remove it");
    else if (scene.forces[i].function && scene.forces[i].array_function)
      problems.grave("force " + std::to_string(i), "has a function on particles and one on arrays",
                     "make two forces of it");
}

/// Checks the sizes of a collider's shape against their lower limits.
struct CheckShape {
  Problems& problems;

  void size(const char* name, float value) const {
    if (!(value > 0 && value <= largest_place))
      problems.grave(name, "is " + words(value) + " m", "give a positive, finite size in metres");
  }
  void operator()(const Plane&) const {}
  void operator()(const Sphere& sphere) const { size("radius", sphere.radius); }
  void operator()(const Capsule& capsule) const {
    size("radius", capsule.radius);
    require_range(problems, "half_length", capsule.half_length, 0, largest_place);
  }
  void operator()(const Box& box) const {
    size("half_extents, x", box.half_extents.x);
    size("half_extents, y", box.half_extents.y);
    size("half_extents, z", box.half_extents.z);
  }
};

void check_collider(Problems& problems, const Collider& collider) {
  std::visit(CheckShape{problems}, collider.shape);
  require_place(problems, "position", collider.position);
  check_rotation(problems, "rotation", collider.rotation);
  check_motion(problems, "motion", collider.motion);
  require_range(problems, "thickness", collider.thickness, 0, largest_place);
  check_friction(problems, collider.static_friction, collider.kinetic_friction, collider.restitution);
  check_rolling(problems, collider.rolling_friction, collider.spinning_friction);
  check_surface_velocity(problems, "surface_velocity", collider.surface_velocity);
  if (!is_finite(collider.colour)) problems.grave("colour", "is not finite", "give red, green and blue from 0 to 1");
}

/// Refuses objects whose rest lengths change under a sweep that holds those of the start.
void check_changing_lengths(Problems& problems, const Scene& scene) {
  for (const Object& object : scene.objects) {
    const Sweep sweep = object.sweep == Sweep::automatic ? scene.settings.sweep : object.sweep;
    const bool is_held =
        sweep == Sweep::multigrid || sweep == Sweep::tethered_chains || scene.settings.sweep_options.tethers;
    if (is_held && has_changing_lengths(object))
      problems.grave("'" + object.name + "', keyframes",
                     "change rest lengths, which multigrid and tethers do not follow",
                     "use the sweep chains or tiled without tethers");
  }
}

void check_count(Problems& problems, const Scene& scene) {
  std::size_t particles = 0;
  for (const Object& object : scene.objects) particles += object.positions.size() + object.attachments.size();
  for (const MeshCollider& collider : scene.mesh_colliders) particles += collider.mesh.positions.size();
  if (particles > std::numeric_limits<int>::max() / 4)
    problems.grave("", std::to_string(particles) + " particles exceed the limit of 536870911", "use fewer particles");
}

/// True if an object has what a sweep projects; liquids and grains have passes of their own.
bool has_swept(const Scene& scene) {
  return scene.objects.empty() || std::any_of(scene.objects.begin(), scene.objects.end(), [](const Object& object) {
           return !object.fluid && !object.grains && !object.tracers;
         });
}

void doubt_settings(Problems& problems, const Scene& scene) {
  const Settings settings = chosen_settings(scene);
  const int substeps = most_substeps_of(settings);
  const double substep = static_cast<double>(scene.frame_time) / substeps;
  const double gravity = std::sqrt(static_cast<double>(length_squared(scene.gravity)));
  if (scene.objects.empty()) problems.doubtful("", "the scene has no objects, so nothing will move", "add one");
  if (gravity > 1000)
    problems.doubtful("gravity", "is " + words(gravity) + " m/s^2", "lengths are in metres: 9.81 on earth");
  if (scene.frame_time > 0.1f || scene.frame_time < 1e-4f)
    problems.doubtful("frame_time", "is " + words(scene.frame_time) + " s", "films use 1/24 s, games 1/60 s");
  if (substep < 1e-6)
    problems.doubtful("settings, substeps",
                      "make substeps of " + words(substep) + " s, in which float precision loses small motions",
                      "use fewer");
  const bool solves_at_once = solves_chains(settings.sweep) || settings.sweep == Sweep::multigrid;
  if (has_swept(scene) && !solves_at_once && substeps * static_cast<std::int64_t>(settings.iterations) < 5)
    problems.doubtful("settings, substeps", "times iterations project each constraint fewer than 5 times per frame",
                      "stiff objects will stretch like rubber: 10 to 20 substeps are usual");
  if (settings.iterations > 10 && settings.iterations > substeps)
    problems.doubtful("settings, iterations", "are more than substeps",
                      "more substeps with fewer iterations converge far better at the same cost");
}

/// Warns of grains for which the named substeps are too few: those at the bottom yield, and heaps are flatter.
void doubt_substeps_of_grains(Problems& problems, const Scene& scene) {
  constexpr double planned = 0.03,
                   tolerated = 0.05;  // overlaps over the diameter: of the default substeps, and without a warning
  const int substeps = scene.settings.substeps;
  if (substeps <= 0) return;
  std::vector<SetMember> members;
  for (const Object& object : scene.objects)
    members.push_back(member_of(object, 0, SubstepRule::any, static_cast<double>(scene.frame_time)));
  for (const MeshCollider& collider : scene.mesh_colliders) members.push_back(member_of(collider));
  const std::vector<SetSubsteps> sets = substeps_of_sets(members);
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    if (!scene.objects[o].grains) continue;
    const double share = static_cast<double>(sets[o].substeps) / substeps;
    const double overlap = planned * share * share / scene.settings.iterations;
    if (overlap <= tolerated) continue;
    problems.doubtful("settings, substeps",
                      "are " + std::to_string(substeps) + ", too few for the grains of '" + scene.objects[o].name +
                          "': those at the bottom would overlap by " + words(std::round(100 * overlap)) +
                          " % of their diameter, and heaps would be too flat",
                      "leave substeps out, or give " + std::to_string(sets[o].substeps) + " or more");
  }
}

/// Names bounds that no object uses.
void doubt_bounds(Problems& problems, const Scene& scene) {
  const Settings& settings = scene.settings;
  if (scene.objects.empty() || (settings.least_substeps == 0 && settings.most_substeps == 0)) return;
  const std::vector<int> substeps = chosen_substeps(scene);
  if (std::find(substeps.begin(), substeps.end(), 0) != substeps.end()) return;
  const std::string what_to_do = settings.substeps > 0 ? "remove it" : "remove it, or name substeps instead";
  const std::string why = settings.substeps > 0
                              ? "the scene names substeps"
                              : "no object has substeps that follow its State (docs/guide/choosing_settings.md)";
  if (settings.least_substeps > 0)
    problems.doubtful("settings, least_substeps", "has no effect, because " + why, what_to_do);
  if (settings.most_substeps > 0 && scene.mesh_colliders.empty())
    problems.doubtful("settings, most_substeps", "has no effect, because " + why + " and there is no mesh collider",
                      what_to_do);
}

bool has_distances(const Scene& scene) {
  return std::any_of(scene.objects.begin(), scene.objects.end(), [](const Object& object) {
    return !object.attachments.empty() ||
           std::any_of(object.constraints.begin(), object.constraints.end(),
                       [](const ConstraintGroup& group) { return is_length(group.type) && !group.particles.empty(); });
  });
}

void doubt_tolerance(Problems& problems, const Scene& scene) {
  if (!(scene.settings.tolerance > 0)) return;
  if (scene.settings.iterations == 1)
    problems.doubtful("settings, tolerance", "has no effect, because a substep has only one iteration",
                      "set iterations to the largest permitted number");
  if (!has_distances(scene))
    problems.doubtful("settings, tolerance", "applies to distance constraints, but the scene has none",
                      "remove it: every substep runs all its iterations");
}

void doubt_names(Problems& problems, const Scene& scene) {
  std::map<std::string, int> count;
  for (const Object& object : scene.objects) ++count[object.name];
  for (const auto& [name, times] : count) {
    if (name.empty())
      problems.doubtful("", std::to_string(times) + " objects have no name",
                        "give each a name, so that messages can name it");
    if (!name.empty() && times > 1)
      problems.doubtful("", std::to_string(times) + " objects are called '" + name + "'", "give each a unique name");
  }
}

/// Checks all but initial intersections and contact cost. Returns true if everything except the objects is valid.
bool look_at_parts(Problems& problems, const Scene& scene) {
  check_settings(problems, scene);
  check_forces(problems, scene);
  check_count(problems, scene);
  check_changing_lengths(problems, scene);
  for (const Collider& collider : scene.colliders) {
    problems.at(collider.name);
    check_collider(problems, collider);
  }
  for (const MeshCollider& collider : scene.mesh_colliders) {
    problems.at(collider.name);
    check_mesh_collider(problems, collider);
  }
  check_pairs(problems, scene);
  const bool surroundings_are_sound = problems.grave_count() == 0;
  for (const Object& object : scene.objects) {
    problems.at(object.name);
    const int before = problems.grave_count();
    check_object(problems, object);
    // Warnings are computed from the object's data, so these must be valid first.
    const bool sound = surroundings_are_sound && problems.grave_count() == before;
    if (sound && problems.wants_doubts()) doubt_object(problems, object, scene);
  }
  problems.at("");
  return surroundings_are_sound;
}

void look_through(Problems& problems, const Scene& scene) {
  const bool surroundings_are_sound = look_at_parts(problems, scene);
  if (problems.grave_count() == 0) check_contact_cost(problems, scene);
  problems.at("");
  if (problems.grave_count() == 0) refuse_tangles(problems, scene);
  if (!problems.wants_doubts() || !surroundings_are_sound) return;
  doubt_settings(problems, scene);
  doubt_bounds(problems, scene);
  doubt_substeps_of_grains(problems, scene);
  if (problems.grave_count() == 0) {
    doubt_soft_bodies(problems, scene);
    doubt_substeps_of_soft_bodies(problems, scene);
    doubt_bent_solids(problems, scene);
    doubt_substeps_of_woven(problems, scene);
    doubt_substeps_of_hinges(problems, scene);
    doubt_springs_of_multigrid(problems, scene);
    doubt_plates(problems, scene);
    doubt_substeps_of_rods(problems, scene);
    doubt_jumps_of_volumes(problems, scene);
    doubt_flows(problems, scene);
    doubt_starts_in_solids(problems, scene);
    doubt_starts_in_bodies(problems, scene);
  }
  doubt_tolerance(problems, scene);
  doubt_names(problems, scene);
  if (problems.grave_count() == 0) doubt_contact(problems, scene);
}

}  // namespace

std::optional<Error> error_of_bounds(const Settings& settings) {
  const int least = settings.least_substeps, most = settings.most_substeps;
  if (least <= 0 || most <= 0) return {};
  const Location where{{}, 0, {}, "settings, least_substeps"};
  const std::string fixed = settings.substeps > 0 ? ", or remove both bounds: the scene names substeps"
                                                  : ", or name a fixed number of substeps";
  if (least > most)
    return Error(where, "is " + std::to_string(least) + ", more than most_substeps, " + std::to_string(most),
                 "increase most_substeps" + fixed);
  // In 64 bits: the next multiple of four of the largest int is no int.
  const std::int64_t rounded_up = (std::int64_t{least} + 3) / 4 * 4;
  if (most >= 4 && rounded_up > most)
    return Error(where,
                 "is " + std::to_string(least) + " and most_substeps " + std::to_string(most) +
                     ", but substeps that follow the State are multiples of four, and none lies between",
                 "increase most_substeps to " + std::to_string(rounded_up) + fixed);
  return {};
}

std::vector<Finding> inspect(const Scene& scene) {
  Problems problems(Problems::Mode::collect);
  look_through(problems, scene);
  return problems.take();
}

void refuse_grave(const Scene& scene) {
  Problems problems(Problems::Mode::throw_grave);
  look_through(problems, scene);
}

void refuse_grave_but_places(const Scene& scene) {
  Problems problems(Problems::Mode::throw_grave);
  look_at_parts(problems, scene);
}

void refuse_grave(const Object& object) {
  Problems problems(Problems::Mode::throw_grave);
  problems.at(object.name);
  check_object(problems, object);
}

void refuse_grave(const Collider& collider) {
  Problems problems(Problems::Mode::throw_grave);
  problems.at(collider.name);
  check_collider(problems, collider);
}

void refuse_grave(const MeshCollider& collider) {
  Problems problems(Problems::Mode::throw_grave);
  problems.at(collider.name);
  check_mesh_collider(problems, collider);
}

void refuse_initial_intersections(const Scene& scene) {
  Problems problems(Problems::Mode::throw_grave);
  refuse_tangles(problems, scene);
}

}  // namespace pliant
