// The part of the table for records that others use: stiffness, rotations, motions, meshes, fabrics.
#include "scene_grammar_parts.h"

#include "pliant/scene.h"
#include "scene_grammar_words.h"

namespace pliant::scene_file {

namespace {

// ------------------------------------------------------------------------------------------------ used by several records

const Record& stiffness_record() {
  static const Record result{
      "stiffness",
      "How strongly constraints are enforced. Prefer `compliance`: its effect is independent of time step, substeps "
      "and "
      "iterations.",
      {either("compliance", number("inverse of stiffness; m/N for a distance", 0),
              "XPBD: the inverse stiffness alpha in the unit of the constraint's type; 0 is rigid."),
       either("stiffness", share(),
              "PBD: the share k of the error that a step removes. The result depends on the time step and the masses."),
       field("damping", number("N s/m for a distance", 0), Stiffness{}.damping,
             "XPBD damping beta; only together with `compliance`. A damping time beta * compliance below a "
             "substep acts as one.")},
      {"compliance", "stiffness"}};
  return result;
}

}  // namespace

Type stiffness() { return any_of({choice({"rigid"}), record(stiffness_record())}); }

const Record& rotation_record() {
  static const Record result{
      "rotation",
      "A rotation about an axis.",
      {needed("axis", vector("-", largest_place), "Direction of the axis; any length but zero."),
       needed("degrees", number("degree", -1e6, 1e6), "Angle, counter-clockwise seen against the axis.")},
      {}};
  return result;
}

namespace {

const Record& keyframe_record() {
  static const Record result{
      "keyframe",
      "A rigid pose at a time.",
      {needed("time", number("s", 0, 1e9), "Time of the pose; increases along the list."),
       field("position", place(), Keyframe{}.position, "Translation from the rest position."),
       field(
           "rotation", record(rotation_record()), "none",
           "Rotation about the motion's `pivot`. From one keyframe to the next about the same axis it turns by all the "
           "degrees between them, so 0 to 720 are two turns; about another one by the shorter arc.")},
      {}};
  return result;
}

}  // namespace

const Record& motion_record() {
  static const Record result{
      "motion",
      "A rigid motion by keyframes: linear between them, constant before the first and after the last.",
      {needed("keyframes", list(record(keyframe_record()), 1), "The poses."),
       field("pivot", place(), Motion{}.pivot, "Centre of rotation."),
       field("repeat", boolean(), Motion{}.repeat, "Restart after the last keyframe.")},
      {}};
  return result;
}

namespace {

const Record& pressure_record() {
  static const Record result{"pressure keyframe",
                             "The pressure of a volume at a time.",
                             {needed("time", number("s", 0, 1e9), "Time; times increase."),
                              needed("pressure", number("-", 0, 1000), "The pressure then.")},
                             {}};
  return result;
}

}  // namespace

const Record& plasticity_record() {
  static const Record result{
      "plasticity",
      "How a deformation becomes permanent. It is a strain of tetrahedra and of rods at their surface, and an angle in "
      "radians of hinges.",
      {needed("yield", number("-", 0), "Elastic deformation that does not become permanent."),
       field("rate", number("1/s", 0), Plasticity{}.rate,
             "How fast what is beyond `yield` flows: exp(-rate t) of it is left. 0: at once. With a `yield` of 0 it "
             "creeps."),
       field("most", number("-", 0), "no limit",
             "Greatest permanent deformation; beyond it the matter is elastic again.")},
      {}};
  return result;
}

const Record& rest_keyframe_record() {
  static const Record result{"rest keyframe",
                             "A factor of rest data at a time.",
                             {needed("time", number("s", 0, 1e9), "Time; times increase."),
                              needed("factor", number("-", 0, 1e6), "What rest data are multiplied by then.")},
                             {}};
  return result;
}

const Record& volume_record() {
  static const Record result{
      "volume",
      "A volume constraint: holds the volume inside a closed surface, as in a balloon.",
      {field("pressure", number("-", 0, 1000), Volume{}.pressure,
             "Rest volume over the volume of the given mesh: above 1 inflates, below 1 deflates."),
       field("stiffness", stiffness(), "\"rigid\"", "Compliance of the constraint on six times the volume, in m^5/N."),
       field("lift", number("kg/m^3", -1e6, 1e6), Volume{}.lift,
             "By how much the air outside is denser than the gas inside, which bears the surface up by this times g "
             "times "
             "the "
             "volume: 1.04 for helium."),
       field("keyframes", list(record(pressure_record()), 1), "none",
             "The pressure follows them instead of `pressure`, linear between."),
       field("leak", number("1/s", 0, 1000), Volume{}.leak,
             "The share of what the pressure is above 1 that leaks out in a second: exp(-leak t) of it is left.")},
      {}};
  return result;
}

// ------------------------------------------------------------------------------------------------ meshes and fabrics

namespace {

const Record& grid_record() {
  static const Record result{
      "grid",
      "A flat rectangle in the xz-plane about the origin, facing +y. Vertex (row r, column c) has "
      "index r * columns + c; columns "
      "run along x, rows along z.",
      {needed("columns", integer(2, largest_grid), "Vertices along x."),
       needed("rows", integer(2, largest_grid), "Vertices along z."),
       needed("width", positive("m", largest_place), "Size along x."),
       needed("depth", positive("m", largest_place), "Size along z.")},
      {}};
  return result;
}

const Record& sphere_mesh_record() {
  static const Record result{"sphere mesh",
                             "A closed sphere about the origin: a subdivided icosahedron.",
                             {needed("subdivisions", integer(0, 7), "How often each triangle is divided into four."),
                              field("radius", positive("m", largest_place), 1.f, "Radius.")},
                             {}};
  return result;
}

const Record& tube_record() {
  static const Record result{
      "tube",
      "An open tube around the y-axis, its upper rim at y = 0 and its lower one at y = -length: a "
      "sleeve, a skirt. Vertex (row r, "
      "column c) has index r * columns + c, row 0 being the upper rim.",
      {needed("columns", integer(3, largest_grid), "Vertices around."),
       needed("rows", integer(2, largest_grid), "Vertices along the length, both rims included."),
       needed("length", positive("m", largest_place), "Height."),
       needed("top_radius", positive("m", largest_place), "Radius of the upper rim."),
       needed("bottom_radius", positive("m", largest_place), "Radius of the lower rim."),
       field("folds", integer(0, 256), 0, "Waves around the tube; 0 for none."),
       field("fold_depth", number("-", 0, 0.9), 0.f,
             "Height of the waves at the lower rim as a share of its radius; it decreases linearly to 0 at the upper "
             "rim.")},
      {}};
  return result;
}

const Record& box_mesh_record() {
  static const Record result{
      "box mesh",
      "A closed box about the origin with sides along the axes.",
      {needed("size", positive_vector("m", largest_place), "Sizes along x, y and z."),
       field("segments", integer(1, 256), 1, "Squares along each edge; a square is two triangles.")},
      {}};
  return result;
}

const Record& rabbit_record() {
  static const Record result{
      "rabbit",
      "A closed animal shape to drape things over, sitting on y = 0 and looking along +z.",
      {field("height", positive("m", largest_place), 0.3f, "Height from the ground to the tips of the ears."),
       field("cells", integer(16, 128), 40, "Resolution: grid cells along the height.")},
      {}};
  return result;
}

const Record& waves_record() {
  static const Record result{"waves",
                             "Heights h = height sin(2 pi along_x x / width) sin(2 pi along_z z / depth).",
                             {needed("height", number("m", 0, largest_place), "Amplitude of the waves."),
                              field("along_x", number("-", 0, 1000), 1.f, "Waves along x."),
                              field("along_z", number("-", 0, 1000), 1.f, "Waves along z.")},
                             {}};
  return result;
}

const Record& heightfield_record() {
  static const Record result{
      "heightfield",
      "Terrain: a grid with a height at every vertex.",
      {needed("columns", integer(2, largest_grid), "Vertices along x."),
       needed("rows", integer(2, largest_grid), "Vertices along z."),
       needed("width", positive("m", largest_place), "Size along x."),
       needed("depth", positive("m", largest_place), "Size along z."),
       either("heights", list(number("m", -largest_place, largest_place), 4),
              "Height of each vertex, row after row: vertex (row r, column c) has index r * columns + c."),
       either("waves", record(waves_record()), "Heights by a formula.")},
      {"heights", "waves"}};
  return result;
}

}  // namespace

const Record& mesh_record() {
  static const Record result{
      "mesh",
      "The source of a surface and its placement: fitted, then scaled, then rotated, then moved. The result is also "
      "the "
      "rest shape.",
      {either("file", string(),
              "Path of an .obj, .ply or .stl file, relative to the folder of the scene. URLs, devices and pipes are "
              "refused."),
       either("array", string(),
              "Name of a mesh in memory that the program gives with the scene (SceneReadOptions::arrays)."),
       either("grid", record(grid_record()), "A rectangle."),
       either("sphere", record(sphere_mesh_record()), "A closed sphere."),
       either("tube", record(tube_record()), "An open tube."),
       either("box", record(box_mesh_record()), "A closed box."),
       either("heightfield", record(heightfield_record()), "Terrain."),
       either("rabbit", record(rabbit_record()), "A closed animal shape."),
       field("fit", positive("m", largest_place), "none",
             "Scales and moves the mesh so that its longest side has this length, its centre lies above the origin and "
             "its "
             "lowest point at y = 0. For meshes in unknown units."),
       field("scale", any_of({positive("-", 1e6), positive_vector("-", 1e6)}), 1,
             "Scale factor, one for all axes or one per axis."),
       field("rotate", record(rotation_record()), "none", "Rotation about the origin."),
       field("translate", place(), Vec3f{}, "Translation.")},
      {"file", "array", "grid", "sphere", "tube", "box", "heightfield", "rabbit"}};
  return result;
}

Type places() {
  static const Record points{
      "points",
      "Points in memory.",
      {needed("array", string(), "Name of points that the program gives with the scene (SceneReadOptions::arrays).")},
      {}};
  return any_of({list(place(), 1), record(points)});
}

std::vector<std::string> fabric_names() { return names_of(fabrics()); }

const Record& fabric_record() {
  static const Record result{
      "fabric",
      "A fabric in SI units, independent of the mesh. Missing members come from `base`, or else from the defaults.",
      {field("base", choice(fabric_names()), "none", "A built-in fabric to start from."),
       field("name", string(), "none", "Its name."), field("source", text(), "none", "Source of the numbers."),
       field("area_density", positive("kg/m^2"), Fabric{}.area_density, "Mass per area."),
       field("thickness", positive("m", largest_place), Fabric{}.thickness,
             "Thickness; also the distance kept from colliders."),
       field("stretch_stiffness", any_of({choice({"inextensible"}), positive("N/m")}), Fabric{}.stretch_stiffness,
             "Membrane stiffness: force per width and strain; of woven cloth along the warp."),
       field("weft_stiffness", number("N/m", 0), "0: that of `stretch_stiffness`", "Of woven cloth across the warp."),
       field("shear_stiffness", number("N/m", 0), Fabric{}.shear_stiffness,
             "Of woven cloth: shear force per width, over the shear angle in radians; 0: a hundredth of "
             "`stretch_stiffness`."),
       field("bending_stiffness", number("N m", 0), Fabric{}.bending_stiffness, "Flexural rigidity per width."),
       field("bending_damping", share(), Fabric{}.bending_damping, "Fraction of critical damping of bending."),
       field("static_friction", number("-", 0, 1000), Fabric{}.static_friction, "Coefficient of static friction."),
       field("kinetic_friction", number("-", 0, 1000), "0.3; at most the static one",
             "Coefficient of kinetic friction, at most the static one.")},
      {}};
  return result;
}

const Record& strain_limit_record() {
  static const Record result{
      "strain limit",
      "How far edges may become shorter or longer: the object yields freely until there, and hardly beyond.",
      {field("least", number("-", 0, 1), StrainLimit{}.least, "Least length over that at rest."),
       field("most", number("-", 1, 1e6), StrainLimit{}.most, "Greatest length over that at rest.")},
      {}};
  return result;
}

}  // namespace pliant::scene_file
