// The table of the scene format. Ranges are wide: they reject mistakes and attacks, not unusual values.
#include "scene_grammar.h"

#include <algorithm>

#include "pliant/scene.h"
#include "pliant/stitch.h"
#include "scene_grammar_parts.h"
#include "scene_grammar_words.h"

namespace pliant::scene_file {

namespace {

// ------------------------------------------------------------------------------------------------ objects

const Record& box_select_record() {
  static const Record result{"box of particles",
                             "The particles inside an axis-aligned box or on its surface.",
                             {needed("min", place(), "Corner with the smallest coordinates."),
                              needed("max", place(), "Corner with the largest coordinates.")},
                             {}};
  return result;
}

const Record& select_record() {
  static const Record result{"selection",
                             "Particles selected by their rest positions.",
                             {either("box", record(box_select_record()), "The particles inside a box."),
                              either("nearest", place(), "The particle nearest to a point.")},
                             {"box", "nearest"}};
  return result;
}

Type selection() {
  return any_of({choice({"all", "corners", "ends"}), list(particle_index(), 1), record(select_record())});
}

constexpr const char* selection_meaning =
    "The particles: indices, a selection, or \"all\", \"corners\" (of a grid) or \"ends\" (the first and the last).";

const Record& pin_record() {
  static const Record result{
      "pin",
      "Kinematic particles, which stay in place or follow a motion.",
      {needed("particles", selection(), selection_meaning),
       field("motion", record(motion_record()), "none", "Motion of the particles from their rest positions.")},
      {}};
  return result;
}

const Record& cluster_record() {
  static const Record result{
      "cluster",
      "Particles that keep the shape in which they are at the start: shape matching.",
      {field("particles", selection(), "\"all\"", selection_meaning),
       field(
           "size", positive("m", largest_place), "none",
           "Divides all particles into overlapping clusters of cells of this size, so that the whole bends; instead of "
           "`particles`."),
       field("mode", choice({"rigid", "linear", "quadratic"}), "rigid",
             "What the shape may do to fit: move and turn; also stretch and shear; also bend and twist."),
       field("share", share(), Cluster{}.share, "Share of the deformation that `linear` and `quadratic` keep."),
       field("stiffness", stiffness(), "\"rigid\"",
             "Stiffness; the compliance is per mass, in s^2: particles swing at 1 / (2 pi sqrt(compliance)) Hz."),
       field("plasticity", record(plasticity_record()), "none",
             "How strain becomes permanent: the shape takes on what it is stretched and sheared by. Needs a stiffness "
             "that "
             "yields.")},
      {}};
  return result;
}

const Record& attachment_record() {
  static const Record result{"attachment",
                             "Ties particles to targets by distance constraints of rest length 0; targets may move.",
                             {needed("particles", selection(), selection_meaning),
                              field("target", place(), "each particle's position", "Position of the target at time 0."),
                              field("motion", record(motion_record()), "none", "Motion of the targets."),
                              field("stiffness", stiffness(), "\"rigid\"", "Stiffness of the attachment.")},
                             {}};
  return result;
}

const Record& stitch_record() {
  static const Record result{
      "stitch",
      "Threads between particles, each to the nearest of others: they become shorter until both meet, and never push.",
      {needed("particles", selection(), selection_meaning),
       needed("to", selection(), "The particles of the other side."),
       field("closing_time", number("s", 0, 1e6), StitchOptions{}.closing_time,
             "Until when threads shorten from the distance at the start to nothing; 0: at once."),
       field("stiffness", stiffness(), "\"rigid\"", "Stiffness of the threads."),
       field("break_force", number("N", 0, largest_quantity), StitchOptions{}.break_force,
             "Force at which a thread breaks, which needs a compliance; 0: they hold.")},
      {}};
  return result;
}

const Record& tie_record() {
  static const Record result{
      "tie",
      "Ties particles of a part to places of a body, where they are at the start.",
      {needed("particles", selection(), selection_meaning), needed("body", string(), "Name of the body."),
       field("stiffness", stiffness(), "\"rigid\"", "Stiffness of the ties.")},
      {}};
  return result;
}

const Record& tearing_record() {
  static const Record result{"tearing",
                             "The object tears at edges, tetrahedra and joints of rods that become too long.",
                             {needed("stretch", number("-", 1.000001, 1e6), "Greatest length over that at rest.")},
                             {}};
  return result;
}

const Record& plane_cut_record() {
  static const Record result{
      "plane cut",
      "A cut along a plane of the object's rest shape, by a blade that passes through it. It follows faces of "
      "tetrahedra, edges of triangles, links of ropes and joints of rods.",
      {field("start", number("s", 0, 1e9), PlaneCut{}.start, "When the blade enters the object."),
       field("end", number("s", 0, 1e9), "`start`: all at once", "When the blade has passed."),
       field("point", place(), PlaneCut{}.point, "A point of the plane, in the object's rest shape."),
       field("normal", vector("-", largest_place), PlaneCut{}.normal, "Normal of the plane, of any length but 0."),
       field("along", vector("-", largest_place), PlaneCut{}.along, "The way of the blade, not parallel to `normal`.")},
      {}};
  return result;
}

const Record& absorbency_record() {
  const Absorbency none;
  static const Record result{
      "absorbency",
      "The surface takes up liquid that touches it, gets heavier, and drips (docs/guide/wet_cloth.md).",
      {field("capacity", number("kg/m^2", 1e-6, 1e6), none.capacity, "Most liquid that it holds against gravity."),
       field("uptake", number("m/s", 0, 1e6), none.uptake, "Speed at which liquid soaks in while it is not full."),
       field("wicking", number("m^2/s", 0, 1e6), none.wicking, "Diffusivity of the liquid along it."),
       field("rise", number("m", 1e-6, 1e6), none.rise, "How high it draws liquid up against gravity."),
       field("runoff", number("m/s", 0, 1e6), none.runoff, "Speed at which what is more than `capacity` runs down it."),
       field("seepage", number("m/s", 0, 1e6), none.seepage,
             "Speed at which liquid that lies on it passes through where it is full."),
       field("drag", number("1/s", 0, 1e6), none.drag, "Rate at which liquid that touches it takes on its velocity.")},
      {}};
  return result;
}

const Record& part_record() {
  static const Record result{
      "part",
      "A rope, rod, cloth, soft body or particles that belong to an object of bodies, and are tied to them. Properties "
      "such as "
      "`thickness` "
      "and friction are those of the object.",
      {either("cloth", record(cloth_record()), "A cloth; not a balloon."),
       either("soft_body", record(soft_body_record()), "A soft body."),
       either("rope", record(rope_record()), "A rope."),
       either("rod", record(rod_record()), "An elastic rod, which is tied by its `start` and `end` alone."),
       either("particles", record(particles_record()), "Particles with constraints."),
       field("ties", list(record(tie_record())), "none",
             "What ties it to bodies. What is tied to a body does not touch it."),
       field("pins", list(record(pin_record())), "none",
             "Kinematic particles; indices count from the part's first one."),
       field("attachments", list(record(attachment_record())), "none", "Particles tied to targets.")},
      {"cloth", "soft_body", "rope", "rod", "particles"}};
  return result;
}

std::vector<std::string> sweep_names() {
  std::vector<std::string> names{"automatic"};
  for (const NamedSweep& one : sweeps()) names.push_back(one.name);
  return names;
}

}  // namespace

const Record& object_record() {
  static const Record result{
      "object",
      "A cloth, a soft body, a rope, a rod, a liquid, a gas, tracers, grains, particles with constraints, rigid "
      "bodies, or "
      "a "
      "robot.",
      {field("name", string(), "the kind, with a number if it is taken", "Unique name, used in messages and files."),
       either("cloth", record(cloth_record()), "A cloth, garment or balloon."),
       either("soft_body", record(soft_body_record()), "An elastic solid."),
       either("rope", record(rope_record()), "A rope."),
       either("rod", record(rod_record()), "An elastic rod: a wire, a cable, a spring."),
       either("liquid", record(liquid_record()), "A liquid."),
       either("grains", record(grains_record()), "Sand or gravel."),
       either("gas", record(gas_record()), "A gas."),
       either("tracers", record(tracers_record()), "Points that gases carry along, as smoke."),
       either("particles", record(particles_record()), "Particles with constraints."),
       either("bodies", list(record(body_record()), 1), "Rigid bodies: one, a pile, or the parts of a mechanism."),
       either("urdf", record(urdf_record()), "A robot description."),
       field("joints", list(record(joint_record())), "none", "Joints between its bodies."),
       field("parts", list(record(part_record())), "none",
             "Ropes, rods, cloth and soft bodies that are tied to its bodies. Their particles follow those of the "
             "bodies."),
       field("velocity", vector("m/s", largest_velocity), Vec3f{}, "Initial velocity of all its particles."),
       field("clusters", list(record(cluster_record())), "none", "Groups of its particles that keep their shape."),
       field("pins", list(record(pin_record())), "none",
             "Kinematic particles. A body whose particle has a pin turns with it, if a keyframe has a rotation; else "
             "it is "
             "free to "
             "turn, and a load tips it (`kinematic` of a body)."),
       field("attachments", list(record(attachment_record())), "none", "Particles tied to targets."),
       field("stitches", list(record(stitch_record())), "none", "Threads that sew its particles together."),
       field("tearing", record(tearing_record()), "none",
             "Cloth, ropes, rods and soft bodies: at which stretch they tear."),
       field("cuts", list(record(plane_cut_record())), "none", "Cuts that are made during the simulation."),
       field("absorbency", record(absorbency_record()), "none", "Its triangles take up liquid."),
       field("thickness", number("m", 0, largest_place),
             "the material's; 0.005 for a rope, half the spacing for a liquid or gas, the radius of grains, else 0.001",
             "Distance kept from colliders; two surfaces keep the sum of both."),
       field("self_collision", boolean(), "false; true for rods and bodies",
             "The surface does not pass through itself; without triangles, the links do not (docs/guide/contact.md). "
             "Bodies "
             "do not pass through each other."),
       field("collides", boolean(), "false; true for soft bodies, rods, bodies, liquids, gases and grains",
             "The object does not pass through other objects with `collides`. Mesh colliders always collide."),
       field(
           "groups", bits(), "[0]",
           "Indices of its groups, 0 to 31. Two objects collide if the `mask` of each contains a group of the other."),
       field("mask", bits(), "all", "Indices of the groups that it collides with; [] for none."),
       field("static_friction", number("-", 0, 1000), "the material's; 0 for a liquid or gas, that of grains, else 0.4",
             "Coefficient of static friction."),
       field("kinetic_friction", number("-", 0, 1000),
             "the material's; 0 for a liquid or gas, that of grains, else 0.3; at most the static one",
             "Coefficient of kinetic friction, at most the static one."),
       field("restitution", share(), Object{}.restitution,
             "Coefficient of restitution: the share of the normal speed kept in a bounce. Soft bodies rebound by their "
             "elasticity instead."),
       field("rolling_friction", number("m", 0, largest_place), Object{}.rolling_friction,
             "Of bodies: greatest torque against rolling, per normal force."),
       field("spinning_friction", number("m", 0, largest_place), Object{}.spinning_friction,
             "Of bodies: greatest torque about the contact normal, per normal force, in addition to that of friction."),
       field(
           "sweep", choice(sweep_names()), "automatic",
           "The sweep that solves its constraints. `automatic`: the sweep of `settings`, or if that is automatic too, "
           "the one that measured best on such objects."),
       field("drag", number("-", 0, 1000), Object{}.drag,
             "Drag coefficient of a triangle, or of a body that is one capsule, perpendicular to the wind."),
       field("lift", number("-", 0, 1000), Object{}.lift, "Lift coefficient."),
       field("damping", number("1/s", 0, 1e6), Object{}.damping,
             "Velocity damping: in a second a share of 1 - exp(-damping) is lost."),
       field("colour", colour(), Object{}.colour, "Colour as linear red, green and blue."),
       field(
           "clarity", number("m", 0, largest_place), Object{}.clarity,
           "In pictures of solids, clusters and closed surfaces: the way in them that leaves a third of the light that "
           "is not of their colour. Jelly 0.05. 0: opaque.")},
      {"cloth", "soft_body", "rope", "rod", "liquid", "gas", "tracers", "grains", "particles", "bodies", "urdf"}};
  return result;
}

namespace {

// ------------------------------------------------------------------------------------------------ the rest

const Record& wind_record() {
  static const Record result{
      "wind",
      "Moving air that pushes triangles by drag and lift, and bodies that are one capsule, as segments of rods are, by "
      "drag.",
      {needed("velocity", vector("m/s", largest_velocity), "Mean velocity."),
       needed("air_density", number("kg/m^3", 0, 1e5), "Density of the air: 1.2 at sea level; 0: no air."),
       field("gust", share(), Wind{}.gust, "Amplitude of the gust as a share of the wind."),
       field("gust_period", positive("s", 1e6), Wind{}.gust_period, "Period of the gusts.")},
      {}};
  return result;
}

const Record& sweep_options_record() {
  static const Record result{
      "sweep_options",
      "Options of sweeps; docs/internals/sweeps.md says when each helps.",
      {field("relaxation", positive("-", 2), SweepOptions{}.relaxation,
             "Factor of every correction, below 2; above 1 is over-relaxation."),
       field(
           "sharing", choice({"split", "average"}), "split",
           "For `jacobi`: `split` divides a particle's mass among its constraints, which conserves momentum; `average` "
           "takes the mean of the corrections, which does not."),
       field("acceleration", choice({"none", "chebyshev"}), "none",
             "Chebyshev semi-iteration, useful from about 20 iterations per substep; rejected with `natural`."),
       field("plain_iterations", integer(1, 10000), SweepOptions{}.plain_iterations,
             "Iterations of a substep before acceleration starts; at least 2 if the spectral radius is estimated. A "
             "substep with no "
             "more iterations than these is not accelerated."),
       field("spectral_radius", number("-", 0, 1), SweepOptions{}.spectral_radius,
             "Spectral radius of the sweep, below 1; 0: estimated in every substep."),
       field("tethers", boolean(), SweepOptions{}.tethers,
             "Limit every particle's distance from the pins to that along the mesh (long-range attachments)."),
       field("tether_slack", number("-", 0, 1000), SweepOptions{}.tether_slack,
             "Share by which tether lengths may be exceeded, for cloth that is meant to stretch."),
       field("chain_softness", number("-", 0, 1000), SweepOptions{}.chain_softness,
             "For `chains`: regularises straight rows between two pins; a link stretches by about this times g h^2."),
       field("most_overstretch", number("-", 0, 1000), SweepOptions{}.most_overstretch,
             "For `chains` and `multigrid`: the greatest share by which a distance may stay longer than its force "
             "explains; 0: "
             "no limit."),
       field("multigrid_cycles", integer(1, 100), SweepOptions{}.multigrid_cycles,
             "For `multigrid`: W-cycles per substep, each a conjugate gradient step.")},
      {}};
  return result;
}

const Record& sleep_record() {
  static const Record result{
      "sleep",
      "When rigid bodies sleep (docs/guide/bodies.md). They do if `on` is true.",
      {field("on", boolean(), SleepOptions{}.on, "Islands of bodies that have been slow for `time` sleep."),
       field("speed", positive("m/s", 1000), SleepOptions{}.speed, "Slow: the centre of mass moves by less than this."),
       field("spin", positive("rad/s", 1000), SleepOptions{}.spin, "Slow: the body turns by less than this, too."),
       field("time", number("s", 0, 1e6), SleepOptions{}.time,
             "For how long all bodies of an island have to be slow.")},
      {}};
  return result;
}

const Record& settings_record() {
  static const Record result{
      "settings",
      "How constraints are solved. `threads`, `isa` and the measuring options do not change the result.",
      {field("substeps", integer(0, 10000), Settings{}.substeps,
             "Substeps per frame; 0: they follow strain and motion where chains solve an object; 5 for objects that "
             "`multigrid` solves, 10 if they can touch surfaces, are in wind or a force field, or have pins that move "
             "or lie "
             "together; 80 to 160 for volumes that chains solve; 20 for all others."),
       field("iterations", integer(1, 10000), Settings{}.iterations, "Iterations per substep."),
       field("tolerance", number("m", 0, largest_place), Settings{}.tolerance,
             "A substep ends its iterations when the root mean square error of its distance constraints falls below "
             "this; "
             "0: never."),
       field("threads", integer(0, 1024), Settings{}.threads, "Number of threads; 0: all hardware threads."),
       field("sweep", choice(sweep_names()), "automatic",
             "The method that projects constraints (docs/internals/sweeps.md), unless an object has its own. "
             "`automatic` chooses for each object of 32 particles or more: `tethered_chains` for regular cloth and "
             "rope that "
             "hang from pins, `chains` for others that can touch others or themselves, `multigrid` for irregular ones "
             "that "
             "can meet no collider, and `tiled` for volumes at a pressure that their edges resist, PBD stiffness, or "
             "several "
             "iterations. "
             "`sequential` is the slow scalar reference with the bits of `tiled`."),
       field("sweep_options", record(sweep_options_record()), "the defaults", "Options of sweeps."),
       field("contact_filter", boolean(), Settings{}.contact_filter,
             "Truncate steps so that colliding surfaces never cross (docs/guide/contact.md). Without it only contacts "
             "keep "
             "them apart."),
       field("most_substeps", integer(0, 10000),
             "100 (ropes 200) where substeps follow the State, or what a volume that they can meet needs; else eight "
             "times "
             "`substeps`",
             "Maximum number of substeps of a frame: where they follow the State (in multiples of four), and where a "
             "mesh "
             "collider moves fast (docs/guide/contact.md)."),
       field("least_substeps", integer(0, 10000), "12; 8 for cloth that only hangs by `tethered_chains`",
             "Minimum number of substeps of a frame where they follow the State, rounded up to a multiple of four."),
       field(
           "integrator", choice({"pbd", "energy"}), "pbd",
           "How elastic constraints move matter: `pbd` by their forces at the substep's end, which takes (omega h)^2 / "
           "2 "
           "of the amplitude of a mode in a substep; `energy` by a mean of forces of three times, which takes 1/200 of "
           "that (docs/guide/choosing_settings.md)."),
       field("initial_intersections", choice({"leave", "untangle", "refuse"}), "leave",
             "Treatment of surfaces that intersect at the start: leave them, move them apart, or refuse the scene."),
       field("untangling_speed", positive("m/s", 1000), Settings{}.untangling_speed, "Speed limit of depenetration."),
       field("sleep", record(sleep_record()), "off", "When rigid bodies and grains sleep."),
       field("measure", boolean(), Settings{}.measure, "Measure residuals and stretch each frame."),
       field("record_residuals", boolean(), Settings{}.record_residuals,
             "Measure both residuals after every iteration of each frame's last substep; slow."),
       field("record_multipliers", boolean(), Settings{}.record_multipliers,
             "Store multipliers for reading even if the solver does not need them."),
       field("isa", choice({"x86-64-v2", "x86-64-v3", "x86-64-v4", "generic", "sequential"}),
             "the best that the machine supports",
             "Forces an instruction set that the build holds (PLIANT_LEVELS): the same bits at another speed.")},
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
      "The root object of a scene file.",
      {field("$schema", string(), "none", "The JSON Schema with which editors check the file; Pliant ignores it."),
       field("description", text(), "none", "What the scene shows; Pliant ignores it."),
       field("gravity", vector("m/s^2", 1e5), Scene{}.gravity, "Gravitational acceleration."),
       field("wind", record(wind_record()), "no air", "Moving air."),
       field("frame_time", positive("s", 10), Scene{}.frame_time, "Duration of a frame."),
       field("frames", integer(0, 10000000), Scene{}.frames, "Default number of frames of a run."),
       field("settings", record(settings_record()), "the defaults", "Solver settings."),
       needed("objects", list(record(object_record())), "The objects, which move."),
       field("colliders", list(record(collider_record())), "none", "The colliders, which objects cannot push."),
       field("pairs", list(record(pair_record())), "none", "Contact properties of single pairs of objects."),
       field("gauges", list(record(gauge_record())), "none", "Measurements of liquids; they change nothing."),
       field("camera", record(camera_record()), "shows the whole scene", "From where pictures show it.")},
      {}};
  return result;
}

std::vector<const Record*> all_records() {
  std::vector<const Record*> found;
  collect(scene_record(), found);
  return found;
}

}  // namespace pliant::scene_file
