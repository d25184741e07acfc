// The table of the scene format: what objects are made of. Liquids and grains share how they fill and flow.
#include "pliant/grains.h"
#include "pliant/liquid.h"
#include "pliant/scene.h"
#include "scene_grammar_parts.h"
#include "scene_grammar_words.h"

namespace pliant::scene_file {

const Record& cloth_record() {
  static const Record result{
      "cloth",
      "A surface that resists stretching and bending; with `volume`, a balloon.",
      {needed("mesh", record(mesh_record()),
              "The surface, flat or curved, which is also the rest shape. Any triangle mesh; edges with three or more "
              "triangles get no bending constraint."),
       field("material", any_of({choice(fabric_names()), record(fabric_record())}), "the defaults of fabric",
             "The material: the name of a built-in fabric, or a fabric."),
       field("stretch", stiffness(), "from the material", "Stiffness of every edge; overrides the material's."),
       field("bending", stiffness(), "from the material", "Stiffness of every inner edge; overrides the material's."),
       field("bending_model", choice({"none", "dihedral", "isometric"}), "dihedral",
             "Bending by dihedral angles, or by the isometric bending energy."),
       field("stretch_model", choice({"springs", "woven"}), "springs",
             "What resists stretching: edges, alike in all directions, or triangles, by warp, weft and shear of the "
             "material."),
       field("warp", vector("-", largest_place), ClothOptions{}.warp,
             "Of woven cloth: direction of the warp in the rest shape; each triangle has its projection."),
       field("strain_limit", record(strain_limit_record()), "none", "How far its edges may stretch."),
       field("bending_plasticity", record(plasticity_record()), "none",
             "Folds beyond an angle stay, as in paper or sheet metal; of dihedral bending only."),
       field("volume", record(volume_record()), "none", "Makes the cloth a balloon; its surface must be closed.")},
      {}};
  return result;
}

const Record& line_record() {
  static const Record result{"line",
                             "Points in a straight line, evenly spaced.",
                             {needed("from", place(), "First point."), needed("to", place(), "Last point."),
                              needed("points", integer(2, 1000000), "Number of points, including both ends.")},
                             {}};
  return result;
}

const Record& rope_record() {
  static const Record result{
      "rope",
      "A line of particles at fixed distances.",
      {either("points", list(place(), 2), "Positions of the particles."),
       either("line", record(line_record()), "Positions in a straight line."),
       field("linear_density", positive("kg/m"), RopeOptions{}.linear_density, "Mass per length."),
       field("stretch", stiffness(), "\"rigid\"", "Stiffness of the distances between neighbours."),
       field("bending", stiffness(), "none", "Stiffness of the distances between second neighbours.")},
      {"points", "line"}};
  return result;
}

namespace {

std::vector<std::string> constraint_names() {
  std::vector<std::string> names;
  for (const ConstraintType& type : constraint_types()) names.push_back(type.name);
  return names;
}

const Record& constraint_record() {
  static const Record result{
      "constraints",
      "Constraints of one type, built-in or registered. constraints.md lists the particles and rest data of each type.",
      {needed("type", choice(&constraint_names, "a type of constraints.md"), "The constraint type."),
       needed("particles", list(list(particle_index(), 1)),
              "The particles of each constraint; for a frame slot, the index of a frame."),
       field("rest", list(list(number("depends on the type", -largest_quantity))), "measured from the positions",
             "Rest data of each constraint."),
       field("stiffness", stiffness(), "\"rigid\"", "Stiffness of all of these constraints."),
       field("compliances", list(number("depends on the type", 0)), "none",
             "One compliance per constraint; overrides the one in `stiffness`."),
       field(
           "plasticity", record(plasticity_record()), "none",
           "Deformation that becomes permanent, of tetrahedron_shear, corotational_strain, green_strain, green_trace, "
           "dihedral_bending and rod_joint."),
       field("keyframes", list(record(rest_keyframe_record()), 1), "none",
             "Factors of the rest data of distance, distance_limit, tetrahedron_volume or fibre, linear between."),
       field(
           "break_force", number("N", 0, largest_quantity), 0.f,
           "Force at which one of them breaks, of distance, distance_limit, point_on_triangle and point_in_tetrahedron "
           "with a "
           "compliance; 0: they hold.")},
      {}};
  return result;
}

const Record& frame_record() {
  static const Record result{
      "frame",
      "An orientation with inertia, for constraints that have frame slots: a rigid body is a particle and a frame.",
      {field("orientation", record(rotation_record()), "none", "Rotation of the principal axes at the start."),
       field("angular_velocity", vector("rad/s", largest_velocity), Vec3f{},
             "Angular velocity at the start, in world axes."),
       needed("inertia", any_of({vector("kg m^2", largest_quantity), choice({"fixed"})}),
              "Moments of inertia about the principal axes, above 0; \"fixed\" for a frame that never rotates.")},
      {}};
  return result;
}

}  // namespace

const Record& particles_record() {
  static const Record result{
      "particles",
      "Particles with constraints of any type.",
      {needed("positions", places(), "Positions at the start, which are also the rest shape."),
       needed("masses", any_of({positive("kg"), list(any_of({positive("kg"), choice({"fixed"})}), 1)}),
              "One mass for all particles, or one per particle; \"fixed\" for a particle that never moves."),
       field("velocities", list(vector("m/s", largest_velocity)), "at rest", "One velocity per particle."),
       field("frames", list(record(frame_record())), "none",
             "Orientations that constraints connect with the particles."),
       field("constraints", list(record(constraint_record())), "none", "Constraints between the particles."),
       field("triangles", list(list(particle_index(), 3, 3)), "none",
             "The surface for air, volume and pictures, counter-clockwise seen from outside."),
       field("volume", record(volume_record()), "none", "Pressure inside the surface, which must be closed.")},
      {}};
  return result;
}

const Record& fill_record() {
  static const Record result{
      "fill",
      "Particles on a cubic lattice that fills an axis-aligned box, from `min` to `max`, or a closed mesh.",
      {either("min", place(), "Corner of the box with the smallest coordinates."),
       either("mesh", record(mesh_record()), "A closed mesh, with its placement."),
       field("max", place(), "none",
             "Corner of the box with the largest coordinates; only with `min`, which needs it."),
       field("clearance", number("m", 0, largest_place), 0.f,
             "Only for a mesh: distance of particles from its surface. Half the spacing if it is a vessel's wall."),
       field("jitter", number("-", 0, 0.25), 0.f,
             "Displaces each particle along each axis by a random length up to this many spacings, and widens the "
             "lattice "
             "by twice as much, so "
             "that none overlap. 0.05 lets grains that fall mix; a block that stands by itself needs 0.2 to collapse."),
       field("seed", integer(0, 2147483647), 0, "Of the jitter: the same seed gives the same places."),
       field("leave_out_solids", boolean(), true,
             "Leaves out particles that would overlap colliders, rigid bodies, soft bodies or other closed surfaces of "
             "the "
             "scene. A closed surface that encloses the whole fill is its vessel.")},
      {"min", "mesh"}};
  return result;
}

const Record& emitter_record() {
  static const Record result{
      "emitter",
      "Emits layers of particles through a flat opening. It holds two layers behind the opening, where there must be "
      "room.",
      {field("name", string(), "emitter", "Name."), field("position", place(), Vec3f{}, "Centre of the opening."),
       field("direction", vector("-", largest_place), Emitter{}.direction, "Of what it emits; any length but zero."),
       field("across", vector("-", largest_place), "level", "Along the width of a rectangle."),
       either("radius", positive("m", largest_place), "Radius of a round opening."),
       either("size", list(positive("m", largest_place), 2, 2), "Width and height of a rectangle."),
       field("speed", positive("m/s", 1e4), "that of `flow`", "Speed through the opening. Give it or `flow`."),
       field("flow", positive("m^3/s", 1e6), "that of `speed`", "Volume of particles a second."),
       field("start", number("s", 0), Emitter{}.start, "When it begins."),
       field("end", number("s", 0), "never", "When it ends."),
       field("motion", record(motion_record()), "none", "Motion of the opening; its velocity adds to the speed.")},
      {"radius", "size"}};
  return result;
}

const Record& drain_record() {
  static const Record result{
      "drain",
      "A solid that takes away the particles of its own object whose centre is in it when a frame begins.",
      {field("name", string(), "drain", "Name."), either("plane", record(plane_record()), "A half-space."),
       either("sphere", record(sphere_record()), "A ball."), either("capsule", record(capsule_record()), "A capsule."),
       either("box", record(box_record()), "A box."), field("position", place(), Vec3f{}, "Position of its frame."),
       field("rotation", record(rotation_record()), "none", "Rotation of its frame.")},
      {"plane", "sphere", "capsule", "box"}};
  return result;
}

namespace {

std::vector<std::string> liquid_names() { return names_of(liquids()); }

std::vector<std::string> grain_names() { return names_of(grain_kinds()); }

}  // namespace

const Record& liquid_record() {
  static const Record result{
      "liquid",
      "A liquid of particles. Liquids with the same spacing, speed of sound, groups and mask mix; others touch as "
      "spheres "
      "do.",
      {field("fill", record(fill_record()), "none", "The box or mesh that it fills at the start."),
       field("positions", places(), "none",
             "Instead of `fill`: positions of the particles at the start, about a spacing apart."),
       field("spacing", positive("m", largest_place), Fluid{}.spacing, "Distance of particles at rest."),
       field("kind", choice(liquid_names()), "none", "A real liquid, whose density and viscosity are the defaults."),
       field("density", positive("kg/m^3"), "that of `kind`, else 1000", "Density at rest."),
       field("speed_of_sound", number("m/s", 0, largest_velocity), Fluid{}.speed_of_sound,
             "By which it yields to a pressure p: by p / (density c^2). 0: it does not yield."),
       field("viscosity", number("Pa s", 0, 1e6), "that of `kind`, else 0",
             "Dynamic viscosity: water 0.001, honey 10. 0: none. A liquid with viscosity does not slip along colliders "
             "and "
             "bodies."),
       field("surface_tension", number("N/m", 0, 1e6), 0.f,
             "Surface tension towards air: water 0.072, oil 0.03. 0: none. It needs substeps of at most about 0.05 "
             "sqrt(density spacing^3 / surface_tension)."),
       field("contact_angle", number("degrees", 0, 180), Fluid{}.contact_angle,
             "Contact angle on colliders and rigid bodies, if there is surface tension. 180: no adhesion."),
       field("vorticity", number("m/s", 0, 1e6), Fluid{}.vorticity,
             "Vorticity confinement: accelerates by this times N x omega, so that swirls last. 0: none."),
       field(
           "clarity", positive("m", largest_place), "by the size of the picture",
           "In pictures: the way in the liquid that leaves a third of the light that is not of its colour. Water some "
           "metres, honey 0.02."),
       field("capacity", integer(1, 1 << 26), "those at the start", "Most particles that are there at a time."),
       field("emitters", list(record(emitter_record())), "none", "What adds particles; needs a `capacity`."),
       field("drains", list(record(drain_record())), "none", "Solids that take particles away, as each frame begins."),
       field("lifetime", positive("s"), "for ever", "How long each particle stays.")},
      {}};
  return result;
}

const Record& grains_record() {
  static const Record result{
      "grains",
      "Sand or gravel: spheres with friction, which do not turn. Those whose objects meet by groups and masks touch.",
      {field("fill", record(fill_record()), "none", "The box or mesh that it fills at the start, a diameter apart."),
       field("positions", places(), "none",
             "Instead of `fill`: centres of the grains at the start, a diameter or more apart."),
       field("radius", positive("m", largest_place), Grains{}.radius, "Radius of each grain."),
       field("kind", choice(grain_names()), "none",
             "A real material, whose density, friction and cohesion are the defaults."),
       field("density", positive("kg/m^3"), "that of `kind`, else 2650",
             "Density of the solid, not of the bulk with its voids."),
       field(
           "friction", number("-", 0, 1000), "that of `kind`, else 0.6",
           "Coefficient of friction of the bulk: tangent of the angle of repose. It is also the default friction with "
           "colliders."),
       field("cohesion", number("Pa", 0, 1e9), "that of `kind`, else 0",
             "Tensile stress at which the bulk parts: each contact of two grains bears a pull of 0.87 diameter^2 times "
             "this."),
       field("mass_scaling", number("1/m", 0, 1000), Grains{}.mass_scaling,
             "In contacts with others, a grain counts as lighter by exp(-mass_scaling * height): high piles need fewer "
             "substeps, but momentum is lost."),
       field("capacity", integer(1, 1 << 26), "those at the start", "Most particles that are there at a time."),
       field("emitters", list(record(emitter_record())), "none", "What adds particles; needs a `capacity`."),
       field("drains", list(record(drain_record())), "none", "Solids that take particles away, as each frame begins."),
       field("lifetime", positive("s"), "for ever", "How long each particle stays.")},
      {}};
  return result;
}

}  // namespace pliant::scene_file
