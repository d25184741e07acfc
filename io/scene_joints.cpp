// Builds the joints of an object of rigid bodies from a scene file.
#include <algorithm>
#include <cctype>
#include <functional>
#include <map>

#include "pliant/joint.h"
#include "scene_build.h"
#include "scene_grammar.h"
#include "scene_grammar_parts.h"
#include "scene_hints.h"
#include "scene_values.h"

namespace pliant::scene_file {

namespace {

// ------------------------------------------------------------------------------------------------ values

/// Reads a range; `unit` converts its ends.
bool set_range(const JsonValue& at, const char* name, float unit, JointRange& target) {
  const JsonValue* value = at.find(name);
  if (value == nullptr) return false;
  set(*value, "low", target.low);
  set(*value, "high", target.high);
  set(*value, "compliance", target.compliance);
  target.low *= unit;
  target.high *= unit;
  return true;
}

void set_range(const JsonValue& at, const char* name, float unit, std::optional<JointRange>& target) {
  if (JointRange range; set_range(at, name, unit, range)) target = range;
}

void set_motor(const JsonDocument& document, const JsonValue& at, const char* name, float unit,
               std::optional<JointMotor>& target) {
  const JsonValue* value = at.find(name);
  if (value == nullptr) return;
  JointMotor motor;
  motor.kind = set(*value, "position", motor.target) ? JointMotor::Kind::position : JointMotor::Kind::speed;
  set(*value, "speed", motor.target);
  for (const char* torque : {"torque", "force"})
    if (set(*value, torque, motor.target)) motor.kind = JointMotor::Kind::torque;
  const float unit_of_target = motor.kind == JointMotor::Kind::torque ? 1 : unit;
  motor.target *= unit_of_target;
  motor.keyframes.reserve(elements(*value, "keyframes").size());
  for (const JsonValue& item : elements(*value, "keyframes")) {
    MotorKeyframe key;
    set(item, "time", key.time);
    set(item, "target", key.target);
    motor.keyframes.push_back({key.time, key.target * unit_of_target});
  }
  set(*value, "most", motor.most);
  set(*value, "rate", motor.rate);
  if (set(*value, "most_speed", motor.most_speed)) motor.most_speed *= unit;
  for (const char* only : {"rate", "most_speed"})
    if (const JsonValue* given = value->find(only); given != nullptr && motor.kind != JointMotor::Kind::position)
      document.fail_key(*given, "a motor that keeps a speed has no " + std::string(only),
                        "remove it, or give a position");
  if (const JsonValue* given = value->find("most"); given != nullptr && motor.kind == JointMotor::Kind::torque)
    document.fail_key(*given, "a motor of a given torque or force has no other greatest one", "remove it");
  target = motor;
}

/// Reads a spring; `unit` converts its rest.
void set_spring(const JsonValue& at, const char* name, float unit, std::optional<JointSpring>& target) {
  const JsonValue* value = at.find(name);
  if (value == nullptr) return;
  JointSpring& spring = target.emplace();
  set(*value, "rest", spring.rest);
  set(*value, "stiffness", spring.stiffness);
  set(*value, "damping", spring.damping);
  spring.rest *= unit;
}

// ------------------------------------------------------------------------------------------------ a joint

/// One joint of the list, or one of its copies.
struct JointSource {
  const JsonDocument& document;
  const JsonValue& at;  ///< the member that names the kind
  int a, b, carrier;    ///< indices of the bodies; -1: the world
  Vec3f shift;          ///< of a copy's anchors [m]
  JointOptions options;

  Vec3f place(const char* name) const {
    Vec3f result;
    set(at, name, result);
    return result + shift;
  }
  Vec3f place(const char* name, std::size_t index) const { return vector_of(at.find(name)->items[index]) + shift; }

  /// What most joints have: bodies, anchor, options.
  template <class Joint>
  Joint start() const {
    Joint joint;
    joint.a = a, joint.b = b;
    joint.anchor = place("anchor");
    joint.options = options;
    return joint;
  }
  template <class Joint>
  Joint start_with_anchors() const {
    Joint joint;
    joint.a = a, joint.b = b;
    joint.anchor_a = place("anchors", 0), joint.anchor_b = place("anchors", 1);
    joint.options = options;
    return joint;
  }
};

BallJoint ball_of(const JointSource& from) {
  auto joint = from.start<BallJoint>();
  set(from.at, "axis", joint.axis);
  set(from.at, "most_swing", joint.most_swing, radian);
  set_range(from.at, "twist", radian, joint.twist);
  set(from.at, "friction", joint.friction);
  return joint;
}

/// A hinge or slider.
template <class Joint>
Joint one_axis_of(const JointSource& from, float unit) {
  auto joint = from.start<Joint>();
  set(from.at, "axis", joint.axis);
  set_range(from.at, "limit", unit, joint.limit);
  set_motor(from.document, from.at, "motor", unit, joint.motor);
  set(from.at, "friction", joint.friction);
  set(from.at, "damping", joint.damping);
  set_spring(from.at, "spring", unit, joint.spring);
  return joint;
}

CylindricalJoint cylindrical_of(const JointSource& from) {
  auto joint = from.start<CylindricalJoint>();
  set(from.at, "axis", joint.axis);
  set_range(from.at, "slide_limit", 1, joint.slide_limit);
  set_range(from.at, "turn_limit", radian, joint.turn_limit);
  set_motor(from.document, from.at, "slide_motor", 1, joint.slide_motor);
  set_motor(from.document, from.at, "turn_motor", radian, joint.turn_motor);
  set(from.at, "slide_friction", joint.slide_friction);
  set(from.at, "turn_friction", joint.turn_friction);
  set_spring(from.at, "slide_spring", 1, joint.slide_spring);
  set_spring(from.at, "turn_spring", radian, joint.turn_spring);
  return joint;
}

UniversalJoint universal_of(const JointSource& from) {
  auto joint = from.start<UniversalJoint>();
  set(from.at, "axis_a", joint.axis_a);
  set(from.at, "axis_b", joint.axis_b);
  set_range(from.at, "limit_a", radian, joint.limit_a);
  set_range(from.at, "limit_b", radian, joint.limit_b);
  set_motor(from.document, from.at, "motor_a", radian, joint.motor_a);
  set_motor(from.document, from.at, "motor_b", radian, joint.motor_b);
  set(from.at, "friction_a", joint.friction_a);
  set(from.at, "friction_b", joint.friction_b);
  set_spring(from.at, "spring_a", radian, joint.spring_a);
  set_spring(from.at, "spring_b", radian, joint.spring_b);
  return joint;
}

PlanarJoint planar_of(const JointSource& from) {
  auto joint = from.start<PlanarJoint>();
  set(from.at, "normal", joint.normal);
  if (Vec3f axis; set(from.at, "axis_x", axis)) joint.axis_x = axis;
  set_range(from.at, "x_limit", 1, joint.x_limit);
  set_range(from.at, "y_limit", 1, joint.y_limit);
  set_range(from.at, "turn_limit", radian, joint.turn_limit);
  set_motor(from.document, from.at, "x_motor", 1, joint.x_motor);
  set_motor(from.document, from.at, "y_motor", 1, joint.y_motor);
  set_motor(from.document, from.at, "turn_motor", radian, joint.turn_motor);
  set(from.at, "slide_friction", joint.slide_friction);
  set(from.at, "turn_friction", joint.turn_friction);
  set_spring(from.at, "x_spring", 1, joint.x_spring);
  set_spring(from.at, "y_spring", 1, joint.y_spring);
  set_spring(from.at, "turn_spring", radian, joint.turn_spring);
  return joint;
}

DistanceJoint distance_of(const JointSource& from) {
  auto joint = from.start_with_anchors<DistanceJoint>();
  set(from.at, "least", joint.least);
  set(from.at, "most", joint.most);
  return joint;
}

SpringJoint spring_of(const JointSource& from) {
  auto joint = from.start_with_anchors<SpringJoint>();
  set(from.at, "rest_length", joint.rest_length);
  set(from.at, "stiffness", joint.stiffness);
  set(from.at, "damping", joint.damping);
  return joint;
}

PulleyJoint pulley_of(const JointSource& from) {
  auto joint = from.start_with_anchors<PulleyJoint>();
  joint.pulley_a = from.place("pulleys", 0), joint.pulley_b = from.place("pulleys", 1);
  set(from.at, "ratio", joint.ratio);
  joint.carrier = from.carrier;
  return joint;
}

GearJoint gear_of(const JointSource& from) {
  GearJoint joint;
  joint.a = from.a, joint.b = from.b, joint.carrier = from.carrier;
  joint.options = from.options;
  const std::vector<JsonValue>&axes = from.at.find("axes")->items, &teeth = from.at.find("teeth")->items;
  joint.axis_a = vector_of(axes[0]), joint.axis_b = vector_of(axes[1]);
  joint.teeth_a = static_cast<int>(teeth[0].number), joint.teeth_b = static_cast<int>(teeth[1].number);
  return joint;
}

RackJoint rack_of(const JointSource& from) {
  RackJoint joint;
  joint.pinion = from.a, joint.rack = from.b, joint.carrier = from.carrier;
  joint.options = from.options;
  set(from.at, "axis", joint.axis);
  set(from.at, "direction", joint.direction);
  set(from.at, "radius", joint.radius);
  return joint;
}

AxisFreedom freedom_of(const JsonDocument& document, const JsonValue& at, float unit) {
  AxisFreedom freedom;
  if (at.kind == JsonValue::Kind::string) {
    freedom.kind = at.text == "free" ? AxisFreedom::Kind::free : AxisFreedom::Kind::locked;
    return freedom;
  }
  const bool is_limited = set_range(at, "limit", unit, freedom.limit);
  freedom.kind = is_limited ? AxisFreedom::Kind::limited : AxisFreedom::Kind::free;
  set_motor(document, at, "motor", unit, freedom.motor);
  set(at, "friction", freedom.friction);
  set_spring(at, "spring", unit, freedom.spring);
  return freedom;
}

SixAxisJoint six_axis_of(const JointSource& from) {
  auto joint = from.start<SixAxisJoint>();
  set(from.document, from.at, "rotation", joint.axes);
  const std::vector<JsonValue>&linear = from.at.find("linear")->items, &angular = from.at.find("angular")->items;
  for (std::size_t k = 0; k < 3; ++k) {
    joint.linear[k] = freedom_of(from.document, linear[k], 1);
    joint.angular[k] = freedom_of(from.document, angular[k], radian);
  }
  return joint;
}

void add(Object& object, const JointSource& from) {
  using Make = std::function<int(Object&, const JointSource&)>;
  static const std::map<std::string, Make> kinds{
      {"ball", [](Object& o, const JointSource& s) { return add_joint(o, ball_of(s)); }},
      {"fixed", [](Object& o, const JointSource& s) { return add_joint(o, s.start<FixedJoint>()); }},
      {"hinge", [](Object& o, const JointSource& s) { return add_joint(o, one_axis_of<HingeJoint>(s, radian)); }},
      {"slider", [](Object& o, const JointSource& s) { return add_joint(o, one_axis_of<SliderJoint>(s, 1)); }},
      {"cylindrical", [](Object& o, const JointSource& s) { return add_joint(o, cylindrical_of(s)); }},
      {"universal", [](Object& o, const JointSource& s) { return add_joint(o, universal_of(s)); }},
      {"planar", [](Object& o, const JointSource& s) { return add_joint(o, planar_of(s)); }},
      {"distance", [](Object& o, const JointSource& s) { return add_joint(o, distance_of(s)); }},
      {"spring", [](Object& o, const JointSource& s) { return add_joint(o, spring_of(s)); }},
      {"pulley", [](Object& o, const JointSource& s) { return add_joint(o, pulley_of(s)); }},
      {"gear", [](Object& o, const JointSource& s) { return add_joint(o, gear_of(s)); }},
      {"rack", [](Object& o, const JointSource& s) { return add_joint(o, rack_of(s)); }},
      {"six_axis", [](Object& o, const JointSource& s) { return add_joint(o, six_axis_of(s)); }}};
  kinds.at(from.at.key)(object, from);
}

// ------------------------------------------------------------------------------------------------ the list

const JsonValue& kind_of(const JsonValue& joint) {
  for (const JsonValue& member : joint.items) {
    const Field* field = joint_record().find(member.key);
    const auto& kinds = joint_record().exactly_one;
    if (field != nullptr && std::find(kinds.begin(), kinds.end(), member.key) != kinds.end())
      return *joint.find(member.key.c_str());
  }
  return joint;  // not reached: check() has found exactly one
}

/// A name whose number at the end is greater by `copy`; a name without one stays.
std::string counted(const std::string& name, int copy) {
  std::size_t digits = name.size();
  while (digits > 0 && std::isdigit(static_cast<unsigned char>(name[digits - 1])) != 0) --digits;
  if (copy == 0 || digits == name.size() || name.size() - digits > 9) return name;
  return name.substr(0, digits) + std::to_string(std::stoi(name.substr(digits)) + copy);
}

class Joints {
 public:
  Joints(const JsonDocument& document, Object& object) : document_(document), object_(object) {
    for (std::size_t b = 0; b < object.bodies.size(); ++b) {
      indices_[object.bodies[b].name] = static_cast<int>(b);
      names_.push_back(object.bodies[b].name);
    }
  }

  void add_all(const JsonValue& item) {
    int count = 1;
    Vec3f step;
    if (const JsonValue* repeat = item.find("repeat")) {
      set(*repeat, "count", count);
      set(*repeat, "step", step);
      if (count > 1 && step == Vec3f{} && counted_alike(item))
        document_.fail_key(
            *repeat, "joins the same bodies at the same place " + std::to_string(count) + " times",
            "name bodies whose names end in numbers, such as 'link_0', which count up, or give a 'step'");
    }
    for (int copy = 0; copy < count; ++copy) add_copy(item, copy, static_cast<float>(copy) * step, count > 1);
  }

 private:
  /// True if the names of both bodies stay the same in all copies.
  static bool counted_alike(const JsonValue& item) {
    const std::vector<JsonValue>& names = item.find("between")->items;
    return std::all_of(names.begin(), names.end(),
                       [](const JsonValue& name) { return counted(name.text, 1) == name.text; });
  }

  void add_copy(const JsonValue& item, int copy, const Vec3f& shift, bool numbered) {
    const JsonValue &kind = kind_of(item), &between = *item.find("between");
    JointOptions options = options_of(item, kind);
    if (numbered && !options.name.empty()) options.name += "_" + std::to_string(copy);
    const int a = index_of(between.items[0], copy), b = index_of(between.items[1], copy);
    if (b < 0) document_.fail(between.items[1], "the world is the second body", "name it first");
    int carrier = -1;
    if (const JsonValue* given = item.find("carrier")) {
      carrier = index_of(*given, copy);
      if (kind.key != "pulley" && kind.key != "gear" && kind.key != "rack")
        document_.fail_key(*given, "a " + kind.key + " joint has no carrier", "remove it");
    }
    add(object_, {document_, kind, a, b, carrier, shift, options});
  }

  int index_of(const JsonValue& at, int copy) const {
    const std::string name = counted(at.text, copy);
    if (name == "world") return -1;
    const auto found = indices_.find(name);
    if (found != indices_.end()) return found->second;
    const std::string near = nearest_name(name, names_);
    document_.fail(at, "the object has no body '" + printable(name) + "'",
                   near.empty() ? "name one of its bodies, or \"world\"" : "did you mean '" + printable(near) + "'?");
  }

  JointOptions options_of(const JsonValue& item, const JsonValue& kind) const {
    JointOptions options;
    set(item, "name", options.name);
    set(item, "compliance", options.compliance);
    set(item, "damping", options.damping);
    set(item, "break_force", options.break_force);
    set(item, "break_torque", options.break_torque);
    for (const char* own : {"compliance", "damping"})
      if (const JsonValue* given = item.find(own); given != nullptr && kind.key == "spring")
        document_.fail_key(*given, "a spring joint has its own stiffness and damping", "give them in `spring`");
    return options;
  }

  const JsonDocument& document_;
  Object& object_;
  std::map<std::string, int> indices_;
  std::vector<std::string> names_;
};

}  // namespace

void set_joints(const JsonDocument& document, const JsonValue& at, Object& object) {
  const JsonValue* list = at.find("joints");
  if (list == nullptr) return;
  if (object.bodies.empty())
    document.fail_key(*list, "only an object of bodies has joints", "remove it, or give the object bodies");
  Joints joints(document, object);
  for (const JsonValue& item : list->items) {
    try {
      joints.add_all(item);
    } catch (const Error& error) {
      if (!error.where().file.empty()) throw;  // the error has a location already
      Location place = document.locate(item);
      place.object = object.name;
      if (!error.where().element.empty()) place.element += ", " + error.where().element;
      throw Error(place, error.problem(), error.advice());
    }
  }
}

}  // namespace pliant::scene_file
