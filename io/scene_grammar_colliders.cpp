// The part of the table for colliders, and for contact properties of named pairs.
#include "pliant/scene.h"
#include "scene_grammar_parts.h"
#include "scene_grammar_words.h"

namespace pliant::scene_file {

const Record& plane_record() {
  static const Record result{"plane", "The half-space y <= 0 of its frame is solid.", {}, {}};
  return result;
}

namespace {

constexpr const char* mesh_meaning =
    "A static or kinematic surface, closed or open, that collides on both sides. `position` and `rotation` apply after "
    "the "
    "mesh's own placement.";

const Record& mesh_frame_record() {
  static const Record result{
      "mesh_frame",
      "The vertices of a mesh at one time.",
      {needed("time", number("s", 0, 1e9), "Time of the frame; increases along the list."),
       either("file", string(), "A mesh file with the same number and order of vertices, placed like `mesh`."),
       either("positions", places(), "Vertex positions before the placement of `mesh`.")},
      {"file", "positions"}};
  return result;
}

}  // namespace

const Record& sphere_record() {
  static const Record result{
      "sphere", "A ball.", {field("radius", positive("m", largest_place), Sphere{}.radius, "Radius.")}, {}};
  return result;
}

const Record& capsule_record() {
  static const Record result{"capsule",
                             "A cylinder along the y-axis of its frame with half a ball on either end.",
                             {field("radius", positive("m", largest_place), Capsule{}.radius, "Radius."),
                              field("half_length", number("m", 0, largest_place), Capsule{}.half_length,
                                    "Half the length of the cylinder, without the caps.")},
                             {}};
  return result;
}

const Record& box_record() {
  static const Record result{"box",
                             "A box about the origin of its frame.",
                             {field("half_extents", positive_vector("m", largest_place), Box{}.half_extents,
                                    "Half the sizes along x, y and z.")},
                             {}};
  return result;
}

const Record& pair_record() {
  static const Record result{
      "pair",
      "Overrides contact properties of one pair.",
      {needed("between", list(string(), 2, 2),
              "Names of two objects, or of an object and a mesh collider. The same name twice: self-collision of that "
              "object."),
       field("thickness", number("m", 0, largest_place), "the sum of both", "Distance kept between the two."),
       field("static_friction", number("-", 0, 1000), "the geometric mean of both", "Coefficient of static friction."),
       field("kinetic_friction", number("-", 0, 1000), "the geometric mean of both; at most the static one",
             "Coefficient of kinetic friction, at most the static one."),
       field("restitution", share(), "the larger of both",
             "Coefficient of restitution: the share of the normal speed kept in a bounce.")},
      {}};
  return result;
}

const Record& collider_record() {
  static const Record result{
      "collider",
      "A static solid, or a kinematic one that follows keyframes.",
      {field("name", string(), "the shape, with a number if it is taken", "Unique name."),
       either("plane", record(plane_record()), "A half-space."),
       either("sphere", record(sphere_record()), "A ball."),
       either("capsule", record(capsule_record()), "A capsule."),
       either("box", record(box_record()), "A box."),
       either("mesh", record(mesh_record()), mesh_meaning),
       field("position", place(), Collider{}.position, "Position of the collider's frame."),
       field("rotation", record(rotation_record()), "none", "Rotation of the collider's frame."),
       field("motion", record(motion_record()), "none", "Motion from that pose."),
       field("thickness", number("m", 0, largest_place), Collider{}.thickness,
             "Added to the thickness of objects that touch it."),
       field("static_friction", number("-", 0, 1000), Collider{}.static_friction,
             "Coefficient of static friction; a pair has the geometric mean of both."),
       field("kinetic_friction", number("-", 0, 1000), "0.3; at most the static one",
             "Coefficient of kinetic friction, at most the static one."),
       field("restitution", share(), Collider{}.restitution,
             "Coefficient of restitution: the share of the normal speed kept in a bounce. A pair has the larger one."),
       field("rolling_friction", number("m", 0, largest_place), Collider{}.rolling_friction,
             "For bodies: greatest torque against rolling, per normal force. A pair has the larger one."),
       field(
           "spinning_friction", number("m", 0, largest_place), Collider{}.spinning_friction,
           "For bodies: greatest torque about the contact normal, per normal force, in addition to that of friction. A "
           "pair has "
           "the larger one."),
       field("surface_velocity", vector("m/s", largest_velocity), Collider{}.surface_velocity,
             "Velocity in the collider's frame with which its surface moves along itself while its shape stays, as "
             "that of a "
             "conveyor belt: friction takes along what touches it."),
       field("frames", list(record(mesh_frame_record())), "none",
             "Only for a mesh: its deformation, linear between frames; `motion` is applied after it."),
       field("repeat_frames", boolean(), MeshCollider{}.repeat_frames,
             "Only for a mesh: restart after the last frame."),
       field("as", choice({"triangles", "distance_grid", "heightfield"}), "triangles",
             "Only for a mesh: its collision geometry. Distance grids and heightfields are cheap and solid, and meet "
             "bodies and particles, not edges of surfaces (docs/guide/contact.md)."),
       field("grid_spacing", positive("m", largest_place), "a 48th of the longest side",
             "Only for a distance grid: the distance between its nodes."),
       field("groups", bits(), "[0]", "Only for a mesh: indices of its groups, 0 to 31."),
       field("mask", bits(), "all", "Only for a mesh: indices of the groups that it collides with."),
       field("colour", colour(), Collider{}.colour, "Colour as linear red, green and blue.")},
      {"plane", "sphere", "capsule", "box", "mesh"}};
  return result;
}

}  // namespace pliant::scene_file
