// Converts checked JSON values; scene_values.h describes the functions.
#include "scene_values.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pliant::scene_file {

Vec3f vector_of(const JsonValue& value) {
  return {static_cast<float>(value.items[0].number), static_cast<float>(value.items[1].number),
          static_cast<float>(value.items[2].number)};
}

bool set(const JsonValue& at, const char* name, bool& target) {
  const JsonValue* value = at.find(name);
  if (value != nullptr) target = value->truth;
  return value != nullptr;
}

bool set(const JsonValue& at, const char* name, int& target) {
  const JsonValue* value = at.find(name);
  if (value != nullptr) target = static_cast<int>(value->number);
  return value != nullptr;
}

bool set(const JsonValue& at, const char* name, float& target) {
  const JsonValue* value = at.find(name);
  if (value != nullptr) target = static_cast<float>(value->number);
  return value != nullptr;
}

bool set(const JsonValue& at, const char* name, std::string& target) {
  const JsonValue* value = at.find(name);
  if (value != nullptr) target = value->text;
  return value != nullptr;
}

bool set(const JsonValue& at, const char* name, Vec3f& target) {
  const JsonValue* value = at.find(name);
  if (value != nullptr) target = vector_of(*value);
  return value != nullptr;
}

bool set(const JsonValue& at, const char* name, std::optional<float>& target, float unit) {
  float value = 0;
  const bool given = set(at, name, value);
  if (given) target = value * unit;
  return given;
}

bool set(const JsonValue& at, const char* name, std::uint32_t& target) {
  const JsonValue* value = at.find(name);
  if (value == nullptr) return false;
  target = 0;
  for (const JsonValue& bit : value->items) target |= std::uint32_t{1} << static_cast<unsigned>(bit.number);
  return true;
}

const std::vector<JsonValue>& elements(const JsonValue& at, const char* name) {
  static const std::vector<JsonValue> none;
  const JsonValue* value = at.find(name);
  return value != nullptr ? value->items : none;
}

namespace {

/// The axis of a rotation, scaled so that its largest component is 1, because the square of a tiny axis underflows.
Vec3f axis_of(const JsonDocument& document, const JsonValue& turn) {
  Vec3f axis;
  set(turn, "axis", axis);
  const float largest = std::max({axis.x, -axis.x, axis.y, -axis.y, axis.z, -axis.z});
  if (largest < std::numeric_limits<float>::min())
    document.fail(*turn.find("axis"), "this axis has length 0", "[0, 1, 0] is upright");
  return {axis.x / largest, axis.y / largest, axis.z / largest};
}

}  // namespace

bool set(const JsonDocument& document, const JsonValue& at, const char* name, Quatf& target) {
  const JsonValue* value = at.find(name);
  if (value == nullptr) return false;
  float degrees = 0;
  set(*value, "degrees", degrees);
  target = rotation(axis_of(document, *value), degrees);
  return true;
}

bool set(const JsonDocument& document, const JsonValue& at, const char* name, Stiffness& target) {
  const JsonValue* value = at.find(name);
  if (value == nullptr) return false;
  target = Stiffness::rigid();
  if (value->kind == JsonValue::Kind::string) return true;  // the check allows only the word "rigid"
  set(*value, "compliance", target.value);
  set(*value, "damping", target.damping);
  if (!set(*value, "stiffness", target.value)) return true;
  target.kind = Stiffness::Kind::pbd;
  if (const JsonValue* damping = value->find("damping"))
    document.fail_key(*damping, "damping needs a compliance; a PBD stiffness has none",
                      "remove it, or give a compliance instead of the stiffness");
  return true;
}

namespace {

/// Of one motion, with those that are inserted: so that a small file cannot fill the memory.
constexpr std::size_t most_keyframes = 1000000;

/// A rotation as the file gives it. Without one the degrees are 0, about any axis.
struct Turn {
  Vec3f axis{};
  double degrees = 0;
};

Turn turn_of(const JsonDocument& document, const JsonValue& keyframe) {
  const JsonValue* turn = keyframe.find("rotation");
  return turn == nullptr ? Turn{} : Turn{axis_of(document, *turn), turn->find("degrees")->number};
}

Vec3d in_double(const Vec3f& v) { return {v.x, v.y, v.z}; }

/// The degrees from one rotation to another about the axis of both; 0 if they have none in common. Sets that axis in
/// `from`.
double degrees_between(Turn& from, const Turn& to) {
  if (from.degrees == 0) from.axis = to.axis;
  if (to.degrees == 0) return -from.degrees;
  const Vec3d a = in_double(from.axis), b = in_double(to.axis);
  constexpr double parallel = 1e-12;  // the square of an angle: axes are in single precision
  if (length_squared(cross(a, b)) > parallel * length_squared(a) * length_squared(b)) return 0;
  return (dot(a, b) < 0 ? -to.degrees : to.degrees) - from.degrees;
}

/// Appends keyframes up to `next` that turn by a quarter turn each, where it turns by half a turn or more: between two
/// keyframes a Motion takes the shorter arc. They are evenly spaced, and share in position and angle what their rounded
/// times do.
void append_turns(const JsonDocument& document, const JsonValue& at, Turn from, const Turn& to, const Keyframe& next,
                  std::vector<Keyframe>& keys) {
  const double degrees = degrees_between(from, to);
  if (std::fabs(degrees) < 180) return;
  const Keyframe start = keys.back();
  const double time = start.time, duration = static_cast<double>(next.time) - time;
  const Vec3d place = in_double(start.position), way = in_double(next.position) - place;
  const int steps = static_cast<int>(std::ceil(std::fabs(degrees) / 90));
  for (int i = 1; i < steps; ++i) {
    Keyframe key;
    key.time = static_cast<float>(time + duration * i / steps);
    if (!(key.time > keys.back().time && key.time < next.time) || keys.size() >= most_keyframes)
      document.fail(at, "this turns by too many degrees since the keyframe before", "turn less, or give it more time");
    const double share = (static_cast<double>(key.time) - time) / duration;
    const Vec3d position = place + way * share;
    key.position = {static_cast<float>(position.x), static_cast<float>(position.y), static_cast<float>(position.z)};
    key.rotation = rotation(from.axis, static_cast<float>(std::fmod(from.degrees + degrees * share, 360)));
    keys.push_back(key);
  }
}

}  // namespace

bool set(const JsonDocument& document, const JsonValue& at, const char* name, Motion& target) {
  const JsonValue* value = at.find(name);
  if (value == nullptr) return false;
  Turn before;
  for (const JsonValue& item : elements(*value, "keyframes")) {
    Keyframe keyframe;
    set(item, "time", keyframe.time);
    set(item, "position", keyframe.position);
    set(document, item, "rotation", keyframe.rotation);
    const Turn turn = turn_of(document, item);
    if (!target.keyframes.empty()) {
      if (!(keyframe.time > target.keyframes.back().time))
        document.fail(*item.find("time"), "this time is not after the previous one", "times must increase");
      append_turns(document, item, before, turn, keyframe, target.keyframes);
    }
    target.keyframes.push_back(keyframe);
    before = turn;
  }
  set(*value, "pivot", target.pivot);
  set(*value, "repeat", target.repeat);
  return true;
}

bool set(const JsonValue& at, const char* name, std::optional<Plasticity>& target) {
  const JsonValue* value = at.find(name);
  if (value == nullptr) return false;
  target.emplace();
  set(*value, "yield", target->yield);
  set(*value, "rate", target->rate);
  set(*value, "most", target->most);
  return true;
}

bool set(const JsonDocument& document, const JsonValue& at, const char* name, std::vector<RestKeyframe>& target) {
  for (const JsonValue& item : elements(at, name)) {
    RestKeyframe key;
    set(item, "time", key.time);
    set(item, "factor", key.factor);
    if (!target.empty() && !(key.time > target.back().time))
      document.fail(*item.find("time"), "this time is not after the previous one", "times must increase");
    target.push_back(key);
  }
  return !target.empty();
}

bool set(const JsonDocument& document, const JsonValue& at, const char* name, std::optional<Volume>& target) {
  const JsonValue* value = at.find(name);
  if (value == nullptr) return false;
  target.emplace();
  set(*value, "pressure", target->pressure);
  set(document, *value, "stiffness", target->stiffness);
  set(*value, "lift", target->lift);
  set(*value, "leak", target->leak);
  for (const JsonValue& item : elements(*value, "keyframes")) {
    PressureKeyframe key;
    set(item, "time", key.time);
    set(item, "pressure", key.pressure);
    if (!target->keyframes.empty() && !(key.time > target->keyframes.back().time))
      document.fail(*item.find("time"), "this time is not after the previous one", "times must increase");
    target->keyframes.push_back(key);
  }
  return true;
}

bool set(const JsonDocument& document, const JsonValue& at, const char* name, Fabric& target) {
  const JsonValue* value = at.find(name);
  if (value == nullptr) return false;
  if (value->kind == JsonValue::Kind::string) return target = fabric(value->text), true;
  if (const JsonValue* base = value->find("base")) target = fabric(base->text);
  set(*value, "name", target.name);
  set(*value, "source", target.source);
  set(*value, "area_density", target.area_density);
  set(*value, "thickness", target.thickness);
  set(*value, "bending_stiffness", target.bending_stiffness);
  set(*value, "weft_stiffness", target.weft_stiffness);
  set(*value, "shear_stiffness", target.shear_stiffness);
  set(*value, "bending_damping", target.bending_damping);
  set_friction(document, *value, target.static_friction, target.kinetic_friction);
  const JsonValue* stretch = value->find("stretch_stiffness");
  if (stretch == nullptr) return true;
  const bool inextensible = stretch->kind == JsonValue::Kind::string;
  target.stretch_stiffness =
      inextensible ? std::numeric_limits<float>::infinity() : static_cast<float>(stretch->number);
  return true;
}

bool set(const JsonValue& at, const char* name, std::optional<StrainLimit>& target) {
  const JsonValue* value = at.find(name);
  if (value == nullptr) return false;
  target.emplace();
  set(*value, "least", target->least);
  set(*value, "most", target->most);
  return true;
}

void set_friction(const JsonDocument& document, const JsonValue& at, float& static_friction, float& kinetic_friction) {
  const bool has_static = set(at, "static_friction", static_friction);
  if (has_static) kinetic_friction = std::min(kinetic_friction, static_friction);
  const bool has_kinetic = set(at, "kinetic_friction", kinetic_friction);
  if (!has_kinetic || kinetic_friction <= static_friction) return;
  document.fail(*at.find("kinetic_friction"), "kinetic friction is larger than static friction",
                has_static ? "reduce it to the static one or less" : "give static_friction too");
}

Vec3f rotated(const Quatf& q, const Vec3f& v) {
  const Vec3f imaginary{q.x, q.y, q.z};
  const Vec3f half = cross(imaginary, v);
  return v + 2.f * (q.w * half + cross(imaginary, half));
}

}  // namespace pliant::scene_file
