// The table of the scene format. Ranges are wide: they reject slips and attacks, not unusual values.
#include "scene_grammar.h"

#include <algorithm>

#include "pliant/scene.h"
#include "scene_grammar_parts.h"
#include "scene_grammar_words.h"

namespace pliant::scene_file {

namespace {

// ------------------------------------------------------------------------------------------------ objects

const Record& cloth_record() {
  static const Record result{
      "cloth",
      "A surface that resists stretching and bending; with `volume`, a balloon.",
      {needed("mesh", record(mesh_record()),
              "The surface and its rest shape, flat or curved; any triangle mesh; an edge of three triangles or more is "
              "not bent."),
       field("material", any_of({choice(fabric_names()), record(fabric_record())}), "the defaults of fabric",
             "What it is made of: the name of a built-in fabric, or a fabric."),
       field("stretch", stiffness(), "from the material", "Of every edge, instead of the material's."),
       field("bending", stiffness(), "from the material", "Of every inner edge, instead of the material's."),
       field("bending_model", choice({"none", "dihedral", "isometric"}), "dihedral",
             "Bending by the angle between triangles, or by the isometric bending energy."),
       field("volume", record(volume_record()), "none", "Makes it a balloon; the surface must be closed.")},
      {}};
  return result;
}

const Record& line_record() {
  static const Record result{"line",
                             "Points in a straight line, evenly spaced.",
                             {needed("from", place(), "First point."), needed("to", place(), "Last point."),
                              needed("points", integer(2, 1000000), "How many, both ends included.")},
                             {}};
  return result;
}

const Record& rope_record() {
  static const Record result{"rope",
                             "A line of particles at fixed distances.",
                             {either("points", list(place(), 2), "Where its particles are."),
                              either("line", record(line_record()), "The same in a straight line."),
                              field("linear_density", positive("kg/m"), RopeOptions{}.linear_density, "Mass per length."),
                              field("stretch", stiffness(), "\"rigid\"", "Of the distance between neighbours."),
                              field("bending", stiffness(), "none", "Of the distance between second neighbours.")},
                             {"points", "line"}};
  return result;
}

std::vector<std::string> constraint_names() {
  std::vector<std::string> names;
  for (const ConstraintType& type : constraint_types()) names.push_back(type.name);
  return names;
}

const Record& constraint_record() {
  static const Record result{"constraints",
                             "Constraints of one type. Any type that the library has can be named; its particles and rest "
                             "data are in constraints.md.",
                             {needed("type", choice(&constraint_names, "a type of constraints.md"), "Which."),
                              needed("particles", list(list(particle_index(), 1)),
                                     "The particles of each constraint; of a frame slot, the number of a frame."),
                              field("rest", list(list(number("as the type has it", -largest_quantity))),
                                    "measured from the positions", "The rest data of each constraint."),
                              field("stiffness", stiffness(), "\"rigid\"", "Of all of them."),
                              field("compliances", list(number("as the type has it", 0)), "none",
                                    "One compliance a constraint, instead of the one in `stiffness`.")},
                             {}};
  return result;
}

const Record& frame_record() {
  static const Record result{
      "frame",
      "An orientation with inertia, for constraints that have frame slots: a rigid body is a particle and a frame.",
      {field("orientation", record(rotation_record()), "none", "How its principal axes are turned at the start."),
       field("angular_velocity", vector("rad/s", largest_velocity), Vec3f{}, "At the start, in world axes."),
       needed("inertia", any_of({vector("kg m^2", largest_quantity), choice({"fixed"})}),
              "About its three principal axes, above 0; \"fixed\" for a frame that never turns.")},
      {}};
  return result;
}

const Record& particles_record() {
  static const Record result{
      "particles",
      "Anything else: particles with constraints of any type among them.",
      {needed("positions", list(place(), 1), "Where they are; also the rest shape."),
       needed("masses", any_of({positive("kg"), list(any_of({positive("kg"), choice({"fixed"})}), 1)}),
              "One mass for all, or one each; \"fixed\" for a particle that never moves."),
       field("velocities", list(vector("m/s", largest_velocity)), "at rest", "One each."),
       field("frames", list(record(frame_record())), "none", "Orientations that constraints join to the particles."),
       field("constraints", list(record(constraint_record())), "none", "What holds them together."),
       field("triangles", list(list(particle_index(), 3, 3)), "none",
             "The surface, counter-clockwise seen from outside: for air, volume and pictures."),
       field("volume", record(volume_record()), "none", "Pressure inside the surface, which must be closed.")},
      {}};
  return result;
}

const Record& box_select_record() {
  static const Record result{"box of particles",
                             "The particles inside a box with sides along the axes, its surface included.",
                             {needed("min", place(), "Corner with the smallest coordinates."),
                              needed("max", place(), "Corner with the largest coordinates.")},
                             {}};
  return result;
}

const Record& select_record() {
  static const Record result{"selection",
                             "Particles chosen by where they are at rest.",
                             {either("box", record(box_select_record()), "Those inside a box."),
                              either("nearest", place(), "The one nearest to a point.")},
                             {"box", "nearest"}};
  return result;
}

Type selection() {
  return any_of({choice({"all", "corners", "ends"}), list(particle_index(), 1), record(select_record())});
}

constexpr const char* selection_meaning =
    "Which: indices, a selection, or \"all\", \"corners\" (the four of a grid) or \"ends\" (the first and the last).";

const Record& pin_record() {
  static const Record result{"pin",
                             "Kinematic particles: they stay where they are or follow a motion.",
                             {needed("particles", selection(), selection_meaning),
                              field("motion", record(motion_record()), "none", "Their motion, from their rest positions.")},
                             {}};
  return result;
}

const Record& attachment_record() {
  static const Record result{"attachment",
                             "Ties particles to targets by distance constraints of rest length 0; targets may move.",
                             {needed("particles", selection(), selection_meaning),
                              field("target", place(), "each particle's own place", "The target at time 0."),
                              field("motion", record(motion_record()), "none", "How the targets move."),
                              field("stiffness", stiffness(), "\"rigid\"", "Of the bond.")},
                             {}};
  return result;
}

std::vector<std::string> sweep_names() {
  std::vector<std::string> names{"automatic"};
  for (const NamedSweep& one : sweeps()) names.push_back(one.name);
  return names;
}

const Record& object_record() {
  static const Record result{
      "object",
      "Something made of particles: a cloth, a rope, or particles as such.",
      {field("name", string(), "the kind, and a number where that is taken",
             "A name of its own, used in messages and files."),
       either("cloth", record(cloth_record()), "A cloth, garment or balloon."),
       either("rope", record(rope_record()), "A rope."),
       either("particles", record(particles_record()), "Particles with constraints."),
       field("velocity", vector("m/s", largest_velocity), Vec3f{}, "Velocity of all its particles at the start."),
       field("pins", list(record(pin_record())), "none", "Kinematic particles."),
       field("attachments", list(record(attachment_record())), "none", "Particles tied to targets."),
       field("thickness", number("m", 0, largest_place), "the material's; 0.005 for a rope, else 0.001",
             "Distance kept from colliders; two surfaces keep the sum of both."),
       field("self_collision", boolean(), Object{}.self_collision,
             "Its surface does not pass through itself; without triangles, its links do not (docs/guide/contact.md)."),
       field("collides", boolean(), Object{}.collides,
             "It does not pass through other objects with `collides`. Mesh colliders always collide."),
       field("groups", bits(), "[0]",
             "Numbers of its groups, 0 to 31. Two objects collide if the `mask` of each has a group of the other."),
       field("mask", bits(), "all", "The groups that it collides with; [] for none."),
       field("static_friction", number("-", 0, 1000), "the material's, else 0.4", "Coefficient of friction at rest."),
       field("kinetic_friction", number("-", 0, 1000), "the material's, else 0.3, or the static one where that is less",
             "Coefficient of friction in motion; at most the static one."),
       field("restitution", share(), Object{}.restitution, "Share of the speed kept in a bounce."),
       field("sweep", choice(sweep_names()), "automatic",
             "The sweep of its constraints. `automatic`: that of the `settings`; if these name none, the one "
             "that measured best on objects of its kind."),
       field("drag", number("-", 0, 1000), Object{}.drag, "Drag coefficient of a triangle perpendicular to the wind."),
       field("lift", number("-", 0, 1000), Object{}.lift, "Lift coefficient."),
       field("damping", number("1/s", 0, 1e6), Object{}.damping,
             "The share of velocity lost in a second is 1 - exp(-damping)."),
       field("colour", colour(), Object{}.colour, "Linear red, green and blue.")},
      {"cloth", "rope", "particles"}};
  return result;
}

// ------------------------------------------------------------------------------------------------ the rest

const Record& wind_record() {
  static const Record result{
      "wind",
      "Moving air that pushes triangles by drag and lift.",
      {needed("velocity", vector("m/s", largest_velocity), "Mean velocity."),
       needed("air_density", number("kg/m^3", 0, 1e5), "Density of the air: 1.2 at sea level; 0 means no air at all."),
       field("gust", share(), Wind{}.gust, "Amplitude of the gust as a share of the wind."),
       field("gust_period", positive("s", 1e6), Wind{}.gust_period, "Period of the gusts.")},
      {}};
  return result;
}

const Record& sweep_options_record() {
  static const Record result{
      "sweep_options",
      "Options of sweeps; docs/internals/convergence.md says when each helps.",
      {field("relaxation", positive("-", 2), SweepOptions{}.relaxation,
             "Factor of every correction, below 2; above 1 over-relaxes."),
       field("sharing", choice({"split", "average"}), "split",
             "Of `jacobi`: `split` gives each of a particle's constraints a part of its mass and keeps momentum, `average` "
             "does not."),
       field("acceleration", choice({"none", "chebyshev"}), "none",
             "Chebyshev semi-iteration, of use from some 20 iterations a substep on; refused over `natural`."),
       field("plain_iterations", integer(1, 10000), SweepOptions{}.plain_iterations,
             "Iterations of a substep before acceleration begins; 2 or more where the spectral radius is estimated."),
       field("spectral_radius", number("-", 0, 1), SweepOptions{}.spectral_radius,
             "Of the sweep, below 1; 0: estimated in every substep."),
       field("tethers", boolean(), SweepOptions{}.tethers,
             "Limit every particle's distance from the pins to that along the mesh (long-range attachments)."),
       field("tether_slack", number("-", 0, 1000), SweepOptions{}.tether_slack,
             "Share by which that distance may be exceeded, for cloth that is meant to stretch."),
       field("chain_softness", number("-", 0, 1000), SweepOptions{}.chain_softness,
             "Of `chains`: keeps a straight row between two pins solvable; a link stretches by about this times g h^2."),
       field("multigrid_cycles", integer(1, 100), SweepOptions{}.multigrid_cycles,
             "Of `multigrid`: W-cycles a substep, each a step of conjugate gradients.")},
      {}};
  return result;
}

const Record& settings_record() {
  static const Record result{
      "settings",
      "How the constraints are solved. `threads`, `isa` and what is measured do not change the result.",
      {field("substeps", integer(0, 10000), Settings{}.substeps,
             "Substeps a frame; 0: 10 where every object is solved by `multigrid`, else 20."),
       field("iterations", integer(1, 10000), Settings{}.iterations, "Iterations a substep."),
       field(
           "tolerance", number("m", 0, largest_place), Settings{}.tolerance,
           "A substep makes no more iterations once the root mean square error of its distance constraints is below this; "
           "0: always all of them."),
       field("threads", integer(0, 1024), Settings{}.threads, "0: as many as the machine has."),
       field(
           "sweep", choice(sweep_names()), "automatic",
           "The method that projects constraints (docs/internals/convergence.md), unless an object names its own. "
           "`automatic` is chosen for each object: `multigrid` for cloth and rope of 32 particles or more, and `tiled` for "
           "volumes, stiff sheets, PBD stiffness, iterations, or a surface that can touch others or itself. `sequential` "
           "is "
           "the slow, readable reference with the bits of `tiled`."),
       field("sweep_options", record(sweep_options_record()), "the defaults", "Options of sweeps."),
       field("contact_filter", boolean(), Settings{}.contact_filter,
             "Truncate steps so that colliding surfaces never cross (docs/guide/contact.md); without it "
             "contacts "
             "alone must do."),
       field("most_substeps", integer(0, 10000), "eight times `substeps`",
             "Into how many substeps a frame may be divided where a mesh collider moves fast (docs/guide/contact.md)."),
       field("initial_intersections", choice({"leave", "untangle", "refuse"}), "leave",
             "What to do about surfaces that intersect at the start: nothing, moving them apart, or "
             "refusing the scene."),
       field("untangling_speed", positive("m/s", 1000), Settings{}.untangling_speed, "Speed limit of depenetration."),
       field("measure", boolean(), Settings{}.measure, "Measure residuals and stretch each frame."),
       field("record_residuals", boolean(), Settings{}.record_residuals,
             "Measure both residuals after every iteration of each frame's last substep; slow."),
       field("record_multipliers", boolean(), Settings{}.record_multipliers,
             "Keep multipliers readable with one iteration too."),
       field("isa", choice({"x86-64-v2", "x86-64-v3", "x86-64-v4", "generic", "sequential"}),
             "the best that the machine has", "Forces a code path: the same bits at another speed.")},
      {}};
  return result;
}

void collect(const Type& type, std::vector<const Record*>& found);

void collect(const Record& record, std::vector<const Record*>& found) {
  if (std::find(found.begin(), found.end(), &record) != found.end()) return;
  found.push_back(&record);
  for (const Field& one : record.fields) collect(one.type, found);
}

void collect(const Type& type, std::vector<const Record*>& found) {
  if (type.record != nullptr) collect(*type.record, found);
  for (const Type& part : type.parts) collect(part, found);
}

}  // namespace

const Field* Record::find(const std::string& wanted) const {
  for (const Field& one : fields)
    if (one.name == wanted) return &one;
  return nullptr;
}

const Record& scene_record() {
  static const Record result{
      "scene",
      "The whole file.",
      {field("$schema", string(), "none", "For editors, which check the file as it is written; Pliant ignores it."),
       field("description", text(), "none", "What the scene shows; Pliant ignores it."),
       field("gravity", vector("m/s^2", 1e5), Scene{}.gravity, "Acceleration of everything."),
       field("wind", record(wind_record()), "no air", "Moving air."),
       field("frame_time", positive("s", 10), Scene{}.frame_time, "Duration of a frame."),
       field("frames", integer(0, 10000000), Scene{}.frames, "How many a run lasts unless told otherwise."),
       field("settings", record(settings_record()), "the defaults", "How it is solved."),
       needed("objects", list(record(object_record())), "What moves."),
       field("colliders", list(record(collider_record())), "none", "What it meets."),
       field("pairs", list(record(pair_record())), "none", "Contact properties of single pairs.")},
      {}};
  return result;
}

std::vector<const Record*> all_records() {
  std::vector<const Record*> found;
  collect(scene_record(), found);
  return found;
}

}  // namespace pliant::scene_file
