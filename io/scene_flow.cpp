// Builds emitters and drains, and the shapes of drains and colliders.
#include "scene_build.h"
#include "scene_values.h"

namespace pliant::scene_file {

namespace {

Emitter emitter_of(const JsonDocument& document, const JsonValue& at) {
  Emitter emitter;
  set(at, "name", emitter.name);
  set(at, "position", emitter.position);
  set(at, "direction", emitter.direction);
  if (!(length_squared(emitter.direction) > 1e-12f))
    document.fail(*at.find("direction"), "is a direction of no length", "give a direction such as [0, -1, 0]");
  set(at, "across", emitter.across);
  set(at, "radius", emitter.radius);
  if (const std::vector<JsonValue>& size = elements(at, "size"); !size.empty()) {
    emitter.width = static_cast<float>(size[0].number);
    emitter.height = static_cast<float>(size[1].number);
  }
  const bool has_speed = set(at, "speed", emitter.speed), has_flow = set(at, "flow", emitter.flow);
  if (has_speed == has_flow)
    document.fail(at, has_speed ? "has a speed and a flow" : "has neither a speed nor a flow", "give one of them");
  set(at, "start", emitter.start);
  set(at, "end", emitter.end);
  if (emitter.end < emitter.start)
    document.fail(*at.find("end"), "is before its start, " + std::to_string(emitter.start) + " s", "give a later time");
  set(document, at, "motion", emitter.motion);
  return emitter;
}

Drain drain_of(const JsonDocument& document, const JsonValue& at) {
  Drain drain;
  set(at, "name", drain.name);
  for (const char* kind : {"plane", "sphere", "capsule", "box"})
    if (const JsonValue* shape = at.find(kind)) drain.shape = shape_of(*shape);
  set(at, "position", drain.position);
  set(document, at, "rotation", drain.rotation);
  return drain;
}

}  // namespace

Shape shape_of(const JsonValue& at) {
  if (at.key == "plane") return Plane{};
  if (at.key == "sphere") {
    Sphere sphere;
    set(at, "radius", sphere.radius);
    return sphere;
  }
  if (at.key == "capsule") {
    Capsule capsule;
    set(at, "radius", capsule.radius);
    set(at, "half_length", capsule.half_length);
    return capsule;
  }
  Box box;
  set(at, "half_extents", box.half_extents);
  return box;
}

Flow particle_flow(const JsonDocument& document, const JsonValue& at) {
  Flow flow;
  for (const JsonValue& item : elements(at, "emitters")) flow.emitters.push_back(emitter_of(document, item));
  for (const JsonValue& item : elements(at, "drains")) flow.drains.push_back(drain_of(document, item));
  set(at, "lifetime", flow.lifetime);
  return flow;
}

}  // namespace pliant::scene_file
