// The part of the table for rigid bodies: their solids, and how one is repeated.
#include "pliant/body.h"
#include "pliant/decompose.h"
#include "scene_grammar_parts.h"
#include "scene_grammar_words.h"

namespace pliant::scene_file {

namespace {

const Record& cylinder_record() {
  static const Record result{
      "cylinder",
      "A cylinder along the y-axis of its frame, about its middle.",
      {field("radius", positive("m", largest_place), Cylinder{}.radius, "Radius."),
       field("half_length", positive("m", largest_place), Cylinder{}.half_length, "Half the length.")},
      {}};
  return result;
}

const Record& cone_record() {
  static const Record result{
      "cone",
      "A cone along the y-axis of its frame: its base at -half_length, its apex at half_length.",
      {field("radius", positive("m", largest_place), Cone{}.radius, "Radius of the base."),
       field("half_length", positive("m", largest_place), Cone{}.half_length, "Half the height.")},
      {}};
  return result;
}

const Record& hull_record() {
  static const Record result{"hull",
                             "The convex hull of points, or of the vertices of a mesh.",
                             {either("points", list(place(), 4), "Points that do not lie in one plane."),
                              either("mesh", record(mesh_record()), "The mesh; its hollows are filled."),
                              field("margin", number("m", 0, largest_place), Hull{}.margin,
                                    "Distance by which the hull is grown; it has no mass.")},
                             {"points", "mesh"}};
  return result;
}

const Record& concave_record() {
  static const Record result{
      "concave",
      "What a closed mesh encloses, divided into convex pieces.",
      {needed("mesh", record(mesh_record()), "The mesh."),
       field("tolerance", positive("m", largest_place), "2 % of the mesh's longest side",
             "By how much pieces may fill hollows of the mesh."),
       field("most_pieces", integer(1, 1024), DecomposeOptions{}.most_pieces,
             "Greatest number of pieces; where more would be needed, hollows are filled further."),
       field("most_corners", integer(8, 1024), DecomposeOptions{}.most_corners,
             "Greatest number of a piece's corners.")},
      {}};
  return result;
}

const Record& solid_record() {
  static const Record result{
      "solid",
      "A solid of a rigid body.",
      {either("sphere", record(sphere_record()), "A ball."), either("capsule", record(capsule_record()), "A capsule."),
       either("box", record(box_record()), "A box."), either("cylinder", record(cylinder_record()), "A cylinder."),
       either("cone", record(cone_record()), "A cone."), either("hull", record(hull_record()), "A convex hull."),
       either("concave", record(concave_record()), "A concave solid; a hull takes less time."),
       field("position", place(), Solid{}.position, "Position of the solid's frame in that of the body."),
       field("rotation", record(rotation_record()), "none", "Rotation of the solid's frame in that of the body."),
       field("density", positive("kg/m^3"), Solid{}.density, "Density.")},
      {"sphere", "capsule", "box", "cylinder", "cone", "hull", "concave"}};
  return result;
}

const Record& body_grid_record() {
  static const Record result{
      "body grid",
      "Copies at the points of a grid; a tower is a grid of counts [1, n, 1]. Copy (x, y, z) has index (z counts[1] + "
      "y) "
      "counts[0] + x.",
      {needed("counts", list(integer(1, 1000000), 3, 3), "Numbers of copies along x, y and z."),
       needed("spacing", vector("m", largest_place), "Distances between neighbours along x, y and z."),
       field("jitter", number("m", 0, largest_place), 0.f, "Largest random displacement along each axis."),
       field("tumbled", boolean(), false, "Gives each copy a random rotation."),
       field("seed", integer(0, 2147483647), 0, "Seed of jitter and rotations: the same seed gives the same bodies.")},
      {}};
  return result;
}

const Record& pyramid_record() {
  static const Record result{
      "pyramid",
      "Copies in rows along x, each with one fewer than the row below and over its gaps.",
      {needed("base", integer(1, 1000), "Number of copies in the lowest row; also the number of rows."),
       needed("spacing", positive("m", largest_place), "Distance between the centres of neighbours in a row."),
       needed("rise", positive("m", largest_place), "Distance between rows along y."),
       field("square", boolean(), false, "Layers of base x base copies along x and z instead of rows.")},
      {}};
  return result;
}

const Record& spiral_record() {
  static const Record result{
      "spiral",
      "Copies on a circle or spiral about the y-axis through the body's position; the -z axis of each points along the "
      "line.",
      {needed("count", integer(1, 1000000), "Number of copies."),
       needed("radius", positive("m", largest_place),
              "Radius at the first copy, which lies on the +x side of the axis."),
       needed("spacing", positive("m", largest_place), "Distance between neighbours along the line."),
       field("pitch", number("m", 0, largest_place), 0.f, "Growth of the radius in each turn; 0: a circle.")},
      {}};
  return result;
}

const Record& repeat_record() {
  static const Record result{"repeat",
                             "Copies of a body, named NAME_0, NAME_1, ...",
                             {either("grid", record(body_grid_record()), "A grid, tower, row or heap."),
                              either("pyramid", record(pyramid_record()), "A pyramid."),
                              either("spiral", record(spiral_record()), "A spiral.")},
                             {"grid", "pyramid", "spiral"}};
  return result;
}

}  // namespace

const Record& body_record() {
  static const Record result{
      "body",
      "A rigid body. Its position and rotation are those of the frame in which its solids are described; its particle "
      "is "
      "its "
      "centre of mass.",
      {field("name", string(), "\"body\", with a number if it is taken",
             "Unique in the object, used in messages and files."),
       needed("solids", list(record(solid_record()), 1),
              "Its solids, which may overlap: each counts with its own mass."),
       field("position", place(), BodyOptions{}.position, "Position at the start."),
       field("rotation", record(rotation_record()), "none", "Rotation at the start."),
       field("velocity", vector("m/s", largest_velocity), "the object's",
             "Velocity of its centre of mass at the start."),
       field("angular_velocity", vector("rad/s", largest_velocity), BodyOptions{}.angular_velocity,
             "Angular velocity at the start, in world axes."),
       field("mass", any_of({positive("kg"), choice({"fixed"})}), "from the densities",
             "Replaces the mass that the densities give; \"fixed\" for a body that never moves."),
       field("kinematic", boolean(), BodyOptions{}.kinematic,
             "True: infinite mass. Nothing pushes or turns the body; it carries what lies on it, and follows `motion`, "
             "or "
             "the "
             "poses that a program sets."),
       field("motion", record(motion_record()), "none",
             "Motion of a kinematic body from that pose; as everywhere about a `pivot` in the world. Copies share it."),
       field("surface_velocity", vector("m/s", largest_velocity), BodyOptions{}.surface_velocity,
             "Velocity in the body's frame with which its surface moves along itself, as that of a belt or track: "
             "friction "
             "takes along what it touches, or drives the body."),
       field("repeat", record(repeat_record()), "one body", "Makes copies of the body.")},
      {}};
  return result;
}

}  // namespace pliant::scene_file
