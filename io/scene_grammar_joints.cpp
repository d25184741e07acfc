// The part of the table for joints between rigid bodies.
#include "pliant/io.h"
#include "pliant/joint.h"
#include "scene_grammar_parts.h"
#include "scene_grammar_words.h"

namespace pliant::scene_file {

namespace {

constexpr double largest_angle = 360;  // of a limit [degree]

Type axis() { return vector("-", largest_place); }
Type two_places() { return list(place(), 2, 2); }

constexpr const char* anchor_meaning = "The point that both bodies share, in the world at the start.";
constexpr const char* anchors_meaning = "A point of each body, in the world at the start.";

// ------------------------------------------------------------------------------------------------ limits and motors

const Record& turn_range_record() {
  static const Record result{
      "angle range",
      "Stops of an angle. At the start, the angle is 0.",
      {needed("low", number("degree", -largest_angle, largest_angle), "Lower end."),
       needed("high", number("degree", -largest_angle, largest_angle),
              "Upper end, at most a turn above the lower one."),
       field("compliance", number("rad/(N m)", 0), JointRange{}.compliance, "Compliance of the stops; 0: rigid.")},
      {}};
  return result;
}

const Record& slide_range_record() {
  static const Record result{
      "displacement range",
      "Stops of a displacement. At the start, the displacement is 0.",
      {needed("low", number("m", -largest_place, largest_place), "Lower end."),
       needed("high", number("m", -largest_place, largest_place), "Upper end."),
       field("compliance", number("m/N", 0), JointRange{}.compliance, "Compliance of the stops; 0: rigid.")},
      {}};
  return result;
}

const Record& turn_keyframe_record() {
  static const Record result{"keyframe of a rotary motor",
                             "The target of a motor at a time: linear between keyframes, constant outside.",
                             {needed("time", number("s", 0, 1e9), "Time, after that of the keyframe before."),
                              needed("target", number("degree, degree/s or N m", -1e30, 1e30), "Target.")},
                             {}};
  return result;
}

const Record& slide_keyframe_record() {
  static const Record result{"keyframe of a linear motor",
                             "The target of a motor at a time: linear between keyframes, constant outside.",
                             {needed("time", number("s", 0, 1e9), "Time, after that of the keyframe before."),
                              needed("target", number("m, m/s or N", -1e30, 1e30), "Target.")},
                             {}};
  return result;
}

const Record& turn_spring_record() {
  static const Record result{
      "rotary spring",
      "Pulls an angle towards its rest.",
      {field("rest", number("degree", -180, 180), JointSpring{}.rest, "Angle at which it has no torque."),
       needed("stiffness", positive("N m/rad", 1e20), "Torque over angle."),
       field("damping", number("N m s/rad", 0), JointSpring{}.damping, "Torque over angular velocity.")},
      {}};
  return result;
}

const Record& slide_spring_record() {
  static const Record result{
      "linear spring",
      "Pulls a displacement towards its rest.",
      {field("rest", number("m", -largest_place, largest_place), JointSpring{}.rest, "Displacement without force."),
       needed("stiffness", positive("N/m", 1e20), "Force over displacement."),
       field("damping", number("N s/m", 0), JointSpring{}.damping, "Force over speed.")},
      {}};
  return result;
}

const Record& turn_motor_record() {
  static const Record result{
      "rotary motor",
      "Drives an angle, at a speed, to a position, or by a torque.",
      {either("speed", number("degree/s", -1e6, 1e6), "Speed to keep."),
       either("position", number("degree", -1e6, 1e6), "Angle to move to, at the remaining angle times `rate`."),
       either("torque", number("N m", -1e30, 1e30), "Torque."),
       field("keyframes", list(record(turn_keyframe_record())), "none",
             "The target by time, instead of the one above."),
       field("most", positive("N m"), JointMotor{}.most, "Greatest torque, without `torque`."),
       field("rate", positive("1/s"), JointMotor{}.rate, "Only with `position`: speed over remaining angle."),
       field("most_speed", positive("degree/s"), "no limit", "Only with `position`: greatest speed.")},
      {"speed", "position", "torque"}};
  return result;
}

const Record& slide_motor_record() {
  static const Record result{
      "linear motor",
      "Drives a displacement, at a speed, to a position, or by a force.",
      {either("speed", number("m/s", -largest_velocity, largest_velocity), "Speed to keep."),
       either("position", number("m", -largest_place, largest_place),
              "Displacement to move to, at the remaining displacement times `rate`."),
       either("force", number("N", -1e30, 1e30), "Force."),
       field("keyframes", list(record(slide_keyframe_record())), "none",
             "The target by time, instead of the one above."),
       field("most", positive("N"), JointMotor{}.most, "Greatest force, without `force`."),
       field("rate", positive("1/s"), JointMotor{}.rate, "Only with `position`: speed over remaining displacement."),
       field("most_speed", positive("m/s"), "no limit", "Only with `position`: greatest speed.")},
      {"speed", "position", "force"}};
  return result;
}

// ------------------------------------------------------------------------------------------------ kinds of joints

const Record& ball_record() {
  static const Record result{
      "ball joint",
      "The two bodies share a point and rotate freely about it.",
      {needed("anchor", place(), anchor_meaning),
       field("axis", axis(), BallJoint{}.axis, "An axis of both bodies: its angle between them is the swing."),
       field("most_swing", number("degree", 0, 171), "no limit", "Greatest swing."),
       field("twist", record(turn_range_record()), "no limit", "Range of the rotation about the axis."),
       field("friction", number("N m", 0), BallJoint{}.friction, "Greatest torque of friction about each axis.")},
      {}};
  return result;
}

const Record& fixed_record() {
  static const Record result{
      "fixed joint", "The two bodies move as one.", {needed("anchor", place(), anchor_meaning)}, {}};
  return result;
}

const Record& hinge_record() {
  static const Record result{
      "hinge joint",
      "The second body rotates about one axis of the first.",
      {needed("anchor", place(), anchor_meaning),
       field("axis", axis(), HingeJoint{}.axis, "The axis, in the world at the start."),
       field("limit", record(turn_range_record()), "no limit", "Range of the angle."),
       field("motor", record(turn_motor_record()), "none", "Drives the angle."),
       field("friction", number("N m", 0), HingeJoint{}.friction, "Greatest torque of friction."),
       field("damping", number("N m s/rad", 0), HingeJoint{}.damping, "Torque over angular velocity."),
       field("spring", record(turn_spring_record()), "none", "Pulls the angle towards its rest.")},
      {}};
  return result;
}

const Record& slider_record() {
  static const Record result{"slider joint",
                             "The second body slides along one axis of the first.",
                             {needed("anchor", place(), anchor_meaning),
                              field("axis", axis(), SliderJoint{}.axis, "The axis, in the world at the start."),
                              field("limit", record(slide_range_record()), "no limit", "Range of the displacement."),
                              field("motor", record(slide_motor_record()), "none", "Drives the displacement."),
                              field("friction", number("N", 0), SliderJoint{}.friction, "Greatest force of friction."),
                              field("damping", number("N s/m", 0), SliderJoint{}.damping, "Force over speed."),
                              field("spring", record(slide_spring_record()), "none", "Pulls the displacement.")},
                             {}};
  return result;
}

const Record& cylindrical_record() {
  static const Record result{
      "cylindrical joint",
      "The second body slides along one axis of the first, and rotates about it.",
      {needed("anchor", place(), anchor_meaning),
       field("axis", axis(), CylindricalJoint{}.axis, "The axis, in the world at the start."),
       field("slide_limit", record(slide_range_record()), "no limit", "Range of the displacement."),
       field("turn_limit", record(turn_range_record()), "no limit", "Range of the angle."),
       field("slide_motor", record(slide_motor_record()), "none", "Drives the displacement."),
       field("turn_motor", record(turn_motor_record()), "none", "Drives the angle."),
       field("slide_friction", number("N", 0), CylindricalJoint{}.slide_friction, "Greatest force of friction."),
       field("turn_friction", number("N m", 0), CylindricalJoint{}.turn_friction, "Greatest torque of friction."),
       field("slide_spring", record(slide_spring_record()), "none", "Pulls the displacement towards its rest."),
       field("turn_spring", record(turn_spring_record()), "none", "Pulls the angle towards its rest.")},
      {}};
  return result;
}

const Record& universal_record() {
  static const Record result{
      "universal joint",
      "Two axes, one of each body, that cross at the anchor and stay perpendicular.",
      {needed("anchor", place(), anchor_meaning),
       field("axis_a", axis(), UniversalJoint{}.axis_a, "The axis fixed in the first body."),
       field("axis_b", axis(), UniversalJoint{}.axis_b, "The axis fixed in the second body."),
       field("limit_a", record(turn_range_record()), "no limit", "Range of the angle about axis_a."),
       field("limit_b", record(turn_range_record()), "no limit", "Range of the angle about axis_b."),
       field("motor_a", record(turn_motor_record()), "none", "Drives the angle about axis_a."),
       field("motor_b", record(turn_motor_record()), "none", "Drives the angle about axis_b."),
       field("friction_a", number("N m", 0), UniversalJoint{}.friction_a, "Greatest torque of friction about axis_a."),
       field("friction_b", number("N m", 0), UniversalJoint{}.friction_b, "Greatest torque of friction about axis_b."),
       field("spring_a", record(turn_spring_record()), "none", "Pulls the angle about axis_a towards its rest."),
       field("spring_b", record(turn_spring_record()), "none", "Pulls the angle about axis_b towards its rest.")},
      {}};
  return result;
}

const Record& planar_record() {
  static const Record result{
      "planar joint",
      "The second body slides in a plane of the first, and rotates about its normal.",
      {needed("anchor", place(), anchor_meaning), field("normal", axis(), PlanarJoint{}.normal, "Normal of the plane."),
       field("axis_x", axis(), "none",
             "Direction x in the plane; y is the normal times x. Needed for limits, motors and springs of "
             "displacements."),
       field("x_limit", record(slide_range_record()), "no limit", "Range of the displacement along x."),
       field("y_limit", record(slide_range_record()), "no limit", "Range of the displacement along y."),
       field("turn_limit", record(turn_range_record()), "no limit", "Range of the angle about the normal."),
       field("x_motor", record(slide_motor_record()), "none", "Drives the displacement along x."),
       field("y_motor", record(slide_motor_record()), "none", "Drives the displacement along y."),
       field("turn_motor", record(turn_motor_record()), "none", "Drives the angle about the normal."),
       field("slide_friction", number("N", 0), PlanarJoint{}.slide_friction,
             "Greatest force of friction along x, and along y."),
       field("turn_friction", number("N m", 0), PlanarJoint{}.turn_friction, "Greatest torque of friction."),
       field("x_spring", record(slide_spring_record()), "none", "Pulls the displacement along x."),
       field("y_spring", record(slide_spring_record()), "none", "Pulls the displacement along y."),
       field("turn_spring", record(turn_spring_record()), "none", "Pulls the angle about the normal.")},
      {}};
  return result;
}

const Record& distance_record() {
  static const Record result{
      "distance joint",
      "Two points keep their distance, as with a rod, or stay in a range of distances, as with a rope.",
      {needed("anchors", two_places(), anchors_meaning),
       field("least", number("m", 0, largest_place), "without `most` that at the start, else 0", "Least distance."),
       field("most", number("m", 0, largest_place), "without `least` that at the start, else no limit",
             "Greatest distance.")},
      {}};
  return result;
}

const Record& spring_record() {
  static const Record result{"spring joint",
                             "A spring between two points, with a damper beside it.",
                             {needed("anchors", two_places(), anchors_meaning),
                              field("rest_length", number("m", 0, largest_place), "the distance at the start",
                                    "Length at which it exerts no force."),
                              field("stiffness", positive("N/m"), SpringJoint{}.stiffness, "Force over extension."),
                              field("damping", number("N s/m", 0), SpringJoint{}.damping, "Force over speed.")},
                             {}};
  return result;
}

const Record& pulley_record() {
  static const Record result{"pulley joint",
                             "A rope from the first body over two pulleys to the second one. Its length does not grow.",
                             {needed("anchors", two_places(), anchors_meaning),
                              needed("pulleys", two_places(), "The two pulleys, at the start."),
                              field("ratio", positive("-"), PulleyJoint{}.ratio,
                                    "Of a tackle: the force on the second body over that on the first.")},
                             {}};
  return result;
}

const Record& gear_record() {
  static const Record result{
      "gear joint",
      "Two bodies rotate about axes fixed in a third, the carrier: one angle times its teeth plus "
      "the other times its teeth is "
      "constant. The hinges are joints of their own.",
      {needed("axes", list(axis(), 2, 2), "The axis of each body, in the world at the start."),
       needed("teeth", list(integer(-1e6, 1e6), 2, 2),
              "Number of teeth of each; different signs for an inner gear or a belt, which turn the "
              "second body like the first.")},
      {}};
  return result;
}

const Record& rack_record() {
  static const Record result{
      "rack joint",
      "A pinion, the first body, that rotates about an axis moves a rack, the second one. Hinge and slider are joints "
      "of "
      "their own.",
      {field("axis", axis(), RackJoint{}.axis, "Axis of the pinion, in the world at the start."),
       field("direction", axis(), RackJoint{}.direction, "Direction in which the rack moves as the angle grows."),
       field("radius", positive("m", largest_place), RackJoint{}.radius, "Radius of the pinion.")},
      {}};
  return result;
}

const Record& slide_freedom_record() {
  static const Record result{"displacement freedom",
                             "Freedom along one axis.",
                             {field("limit", record(slide_range_record()), "no limit", "Range of the displacement."),
                              field("motor", record(slide_motor_record()), "none", "Drives the displacement."),
                              field("friction", number("N", 0), AxisFreedom{}.friction, "Greatest force of friction."),
                              field("spring", record(slide_spring_record()), "none", "Pulls the displacement.")},
                             {}};
  return result;
}

const Record& turn_freedom_record() {
  static const Record result{
      "angle freedom",
      "Freedom about one axis.",
      {field("limit", record(turn_range_record()), "no limit", "Range of the angle."),
       field("motor", record(turn_motor_record()), "none", "Drives the angle."),
       field("friction", number("N m", 0), AxisFreedom{}.friction, "Greatest torque of friction."),
       field("spring", record(turn_spring_record()), "none", "Pulls the angle.")},
      {}};
  return result;
}

const Record& six_axis_record() {
  static const auto freedom = [](const Record& some) {
    return list(any_of({choice({"free", "locked"}), record(some)}), 3, 3);
  };
  static const Record result{
      "six-axis joint",
      "The freedom along, and about, each of three axes is chosen.",
      {needed("anchor", place(), anchor_meaning),
       field("rotation", record(rotation_record()), "none", "Rotation of the joint's axes at the start."),
       needed("linear", freedom(slide_freedom_record()), "Displacements along x, y and z."),
       needed("angular", freedom(turn_freedom_record()), "Rotations about x, y and z.")},
      {}};
  return result;
}

const Record& copies_record() {
  static const Record result{"joint copies",
                             "Copies of a joint along a row of bodies: in copy k, the numbers at the ends of the "
                             "bodies' names are greater by k.",
                             {needed("count", integer(1, 1000000), "Number of joints, the first included."),
                              needed("step", place(), "Displacement of the anchors from copy to copy.")},
                             {}};
  return result;
}

}  // namespace

namespace {

const Record& joint_target_record() {
  static const Record result{
      "joint target",
      "Where the motor of a joint moves it.",
      {needed("joint", string(), "Name of a joint in the file."),
       either("angle", number("degree", -1e6, 1e6), "Angle of a revolute or continuous joint."),
       either("displacement", number("m", -largest_place, largest_place), "Displacement of a prismatic joint.")},
      {"angle", "displacement"}};
  return result;
}

}  // namespace

const Record& urdf_record() {
  static const Record result{
      "urdf",
      "Rigid bodies and joints from a robot description in URDF. `pliant check` names what the reader ignores.",
      {needed("file", string(), "Path of the .urdf file, relative to the folder of the scene."),
       field("position", place(), UrdfOptions{}.position, "Position of the root link."),
       field("rotation", record(rotation_record()), "none", "Rotation of the root link."),
       field("z_up", boolean(), UrdfOptions{}.z_up, "The file's z-axis points up."),
       field("fixed_base", boolean(), UrdfOptions{}.fixed_base, "Joins a root link with mass to the world."),
       field("motors", boolean(), UrdfOptions{}.motors, "Joints with an effort limit hold their position."),
       field("targets", list(record(joint_target_record())), "none", "Positions to which motors move joints.")},
      {}};
  return result;
}

const Record& joint_record() {
  static const Record result{
      "joint",
      "A joint between two bodies of the object, or a body and the world. The two do not collide with each other.",
      {field("name", string(), "the kind, with its number", "Name, used in messages and reports."),
       needed("between", list(string(), 2, 2), "Names of the two bodies; \"world\" as the first one for the world."),
       either("ball", record(ball_record()), "A shared point."),
       either("fixed", record(fixed_record()), "No freedom."),
       either("hinge", record(hinge_record()), "Rotation about an axis."),
       either("slider", record(slider_record()), "Displacement along an axis."),
       either("cylindrical", record(cylindrical_record()), "Both."),
       either("universal", record(universal_record()), "Rotation about two axes."),
       either("planar", record(planar_record()), "Motion in a plane."),
       either("distance", record(distance_record()), "A rod or a rope."),
       either("spring", record(spring_record()), "A spring with a damper."),
       either("pulley", record(pulley_record()), "A rope over two pulleys."),
       either("gear", record(gear_record()), "A ratio of two rotations."),
       either("rack", record(rack_record()), "A ratio of a rotation and a displacement."),
       either("six_axis", record(six_axis_record()), "Freedom chosen for each axis."),
       field("carrier", string(), "the world",
             "Only for pulley, gear and rack: the body that has the pulleys or axes."),
       field("compliance", number("m/N and rad/(N m)", 0), JointOptions{}.compliance,
             "Compliance of locked directions; 0: rigid."),
       field("damping", number("N s/m and N m s/rad", 0), JointOptions{}.damping,
             "Damping of locked directions; only together with `compliance`."),
       field("break_force", positive("N"), "unbreakable", "The joint breaks when it carries a greater force."),
       field("break_torque", positive("N m"), "unbreakable", "The joint breaks when it carries a greater torque."),
       field("repeat", record(copies_record()), "one joint", "Makes copies of the joint.")},
      {"ball", "fixed", "hinge", "slider", "cylindrical", "universal", "planar", "distance", "spring", "pulley", "gear",
       "rack", "six_axis"}};
  return result;
}

}  // namespace pliant::scene_file
