// The part of the table for elastic rods.
#include "pliant/rod.h"
#include "scene_grammar_parts.h"
#include "scene_grammar_words.h"

namespace pliant::scene_file {

namespace {

std::vector<std::string> material_names() { return names_of(rod_materials()); }

const Record& material_record() {
  static const Record result{
      "rod material",
      "What a rod is made of. Missing members come from `base`, or else from the defaults.",
      {field("base", choice(material_names()), "none", "A built-in material to start from."),
       field("name", string(), "none", "Its name."), field("source", text(), "none", "Source of the numbers."),
       field("density", positive("kg/m^3"), RodMaterial{}.density, "Mass per volume."),
       field("youngs_modulus", positive("Pa"), RodMaterial{}.youngs_modulus,
             "Stress per strain of stretching and bending."),
       field("shear_modulus", positive("Pa"), RodMaterial{}.shear_modulus,
             "Stress per strain of twisting and shearing."),
       field("damping", number("s", 0), RodMaterial{}.damping, "Stress over elastic modulus and rate of strain."),
       field("static_friction", number("-", 0, 1000), RodMaterial{}.static_friction, "Coefficient of static friction."),
       field("kinetic_friction", number("-", 0, 1000), "0.3; at most the static one",
             "Coefficient of kinetic friction, at most the static one."),
       field("plasticity", record(plasticity_record()), "none",
             "Strain at the surface beyond which it stays bent or twisted."),
       field("bending_share", number("-", 1e-6, 1), RodMaterial{}.bending_share,
             "Resistance to bending and twisting over that of a solid rod: less in a rope, whose strands slide.")},
      {}};
  return result;
}

const Record& rod_stiffness_record() {
  static const Record result{"rod stiffness",
                             "Stiffness of a cross-section.",
                             {needed("stretch", positive("N"), "E A: force per strain."),
                              needed("shear", positive("N"), "Force per angle of shear."),
                              needed("bending", positive("N m^2"), "E I: moment per curvature, about `across`."),
                              field("bending_2", positive("N m^2"), "as `bending`",
                                    "About the direction perpendicular to `across` and to the rod."),
                              needed("twist", positive("N m^2"), "G J: torque per rate of twist.")},
                             {}};
  return result;
}

const Record& helix_record() {
  static const Record result{
      "helix",
      "Points of a helix about the y-axis, from y = 0 upwards.",
      {needed("radius", positive("m", largest_place), "Of the helix, to the middle of the rod."),
       needed("height", number("m", -largest_place, largest_place), "From the first point to the last."),
       needed("turns", number("-", -10000, 10000), "Number of turns; below 0: left-handed."),
       needed("segments", integer(2, 1000000), "Number of segments of the rod.")},
      {}};
  return result;
}

const Record& rod_grid_record() {
  static const Record result{"rod grid",
                             "Copies at the points of a level grid whose first point is the rod's own place: grass.",
                             {needed("counts", list(integer(1, 100000), 2, 2), "Numbers of copies along x and z."),
                              needed("spacing", list(number("m", -largest_place, largest_place), 2, 2),
                                     "Distances between neighbours along x and z.")},
                             {}};
  return result;
}

const Record& cap_record() {
  static const Record result{
      "cap",
      "Copies spread evenly over a part of a sphere about +y: hair. The rod's points are described at the origin; each "
      "copy's y-axis "
      "points outward.",
      {needed("count", integer(1, 1000000), "Number of copies."),
       field("centre", place(), Vec3f{}, "Centre of the sphere."),
       needed("radius", positive("m", largest_place), "Radius of the sphere."),
       field("degrees", number("degrees", 1, 180), 90.f, "How far from +y copies go; 180: all round.")},
      {}};
  return result;
}

const Record& rod_repeat_record() {
  static const Record result{"rod repeat",
                             "Copies of a rod, called NAME_0, NAME_1, ...",
                             {either("grid", record(rod_grid_record()), "A field of rods."),
                              either("cap", record(cap_record()), "Rods on a sphere.")},
                             {"grid", "cap"}};
  return result;
}

const Record& end_record() {
  static const Record result{
      "rod end",
      "What holds an end of a rod: a body of the object, or \"world\".",
      {either("clamped", string(), "Holds its place and its direction; it does not twist there."),
       either("ball", string(), "Holds its place; it turns freely.")},
      {"clamped", "ball"}};
  return result;
}

}  // namespace

const Record& rod_record() {
  static const Record result{
      "rod",
      "An elastic rod, which stretches, shears, bends and twists. Each segment between two points is a rigid body.",
      {field("name", string(), "the object's; of a part \"rod\", with a number if it is taken",
             "Its segments are called NAME 0, NAME 1, ..."),
       either("points", list(place(), 3), "Places along it."),
       either("line", record(line_record()), "Places in a straight line."),
       either("helix", record(helix_record()), "A coil."),
       field("translate", place(), Vec3f{}, "Moves the points, after `rotate`."),
       field("rotate", record(rotation_record()), "none", "Turns the points about the origin."),
       field("radius", positive("m", largest_place), RodOptions{}.radius, "Radius of its cross-section."),
       field("end_radius", positive("m", largest_place), "as `radius`", "Radius at the last point, if the rod tapers."),
       field("material", any_of({choice(material_names()), record(material_record())}), "the defaults of rod material",
             "The name of a built-in material, or a material."),
       field("stiffness", record(rod_stiffness_record()), "that of a round section",
             "Stiffness of a flat, hollow or stranded cross-section."),
       field("across", vector("-", largest_place), "any",
             "Direction across the rod about which `bending` acts at its start."),
       field("straight", boolean(), RodOptions{}.straight,
             "True: the rest shape is straight, whatever the points. False: the points are the rest shape."),
       field("start", record(end_record()), "free", "What holds the first point."),
       field("end", record(end_record()), "free", "What holds the last point."),
       field("repeat", record(rod_repeat_record()), "one rod", "Makes copies of the rod."),
       field("break_force", positive("N"), "unlimited", "It breaks where it carries a greater force."),
       field("break_torque", positive("N m"), "unlimited", "It breaks where it carries a greater torque.")},
      {"points", "line", "helix"}};
  return result;
}

}  // namespace pliant::scene_file
