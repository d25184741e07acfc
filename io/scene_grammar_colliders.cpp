// Part of the table: colliders, and contact parameters of named pairs.
#include "pliant/scene.h"
#include "scene_grammar_parts.h"
#include "scene_grammar_words.h"

namespace pliant::scene_file {

namespace {

const Record& plane_record() {
  static const Record result{"plane", "The half-space y <= 0 of its frame is solid.", {}, {}};
  return result;
}

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
  static const Record result{
      "box",
      "A box about the origin of its frame.",
      {field("half_extents", positive_vector("m", largest_place), Box{}.half_extents, "Half its sizes.")},
      {}};
  return result;
}

constexpr const char* mesh_meaning =
    "A static or kinematic surface, closed or open, that collides on both sides. `position` and `rotation` apply to the "
    "mesh as "
    "placed.";

const Record& mesh_frame_record() {
  static const Record result{
      "mesh_frame",
      "The vertices of a mesh at one time.",
      {needed("time", number("s", 0, 1e9), "Increases along the frames."),
       either("file", string(), "A mesh file with as many vertices, in the same order; placed as `mesh` is."),
       either("positions", list(place(), 1), "The vertices' positions before `mesh` places them.")},
      {"file", "positions"}};
  return result;
}

}  // namespace

const Record& pair_record() {
  static const Record result{
      "pair",
      "Overrides contact properties of one pair.",
      {needed("between", list(string(), 2, 2),
              "Names of two objects, or of an object and a mesh collider; one name twice: an object with itself."),
       field("thickness", number("m", 0, largest_place), "the sum of both", "Distance kept between them."),
       field("static_friction", number("-", 0, 1000), "the geometric mean of both", "Coefficient of friction at rest."),
       field("kinetic_friction", number("-", 0, 1000), "the geometric mean of both, or the static one where that is less",
             "Coefficient of friction in motion; at most the static one."),
       field("restitution", share(), "the larger of both", "Share of the speed kept in a bounce.")},
      {}};
  return result;
}

const Record& collider_record() {
  static const Record result{
      "collider",
      "A static solid, or a kinematic one that follows keyframes.",
      {field("name", string(), "the shape, and a number where that is taken", "A name of its own."),
       either("plane", record(plane_record()), "A half-space."),
       either("sphere", record(sphere_record()), "A ball."),
       either("capsule", record(capsule_record()), "A capsule."),
       either("box", record(box_record()), "A box."),
       either("mesh", record(mesh_record()), mesh_meaning),
       field("position", place(), Collider{}.position, "Where its frame is."),
       field("rotation", record(rotation_record()), "none", "How its frame is turned."),
       field("motion", record(motion_record()), "none", "How it moves from there."),
       field("thickness", number("m", 0, largest_place), Collider{}.thickness,
             "Added to the thickness of what touches it."),
       field("static_friction", number("-", 0, 1000), Collider{}.static_friction,
             "Coefficient of friction at rest; a pair has the geometric mean of both."),
       field("kinetic_friction", number("-", 0, 1000), "0.3, or the static one where that is less",
             "Coefficient of friction in motion; at most the static one."),
       field("restitution", share(), Collider{}.restitution,
             "Share of the speed kept in a bounce; a pair has the larger one."),
       field("frames", list(record(mesh_frame_record())), "none",
             "Of a mesh alone: how it deforms, linear between frames, before `motion` moves it."),
       field("repeat_frames", boolean(), MeshCollider{}.repeat_frames,
             "Of a mesh alone: start again after the last frame."),
       field(
           "as", choice({"triangles", "distance_grid", "heightfield"}), "triangles",
           "Of a mesh alone: its collision geometry. The latter two are cheap and solid, and collide with particles alone "
           "(docs/guide/contact.md)."),
       field("grid_spacing", positive("m", largest_place), "a 48th of the longest side",
             "Of a distance grid alone: between its nodes."),
       field("groups", bits(), "[0]", "Of a mesh alone: numbers of its groups, 0 to 31."),
       field("mask", bits(), "all", "Of a mesh alone: the groups that it collides with."),
       field("colour", colour(), Collider{}.colour, "Linear red, green and blue.")},
      {"plane", "sphere", "capsule", "box", "mesh"}};
  return result;
}

}  // namespace pliant::scene_file
