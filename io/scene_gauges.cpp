// Builds the gauges of a scene.
#include <algorithm>
#include <set>

#include "scene_build.h"
#include "scene_values.h"

namespace pliant::scene_file {

namespace {

HeightGauge height_of(const JsonDocument& document, const JsonValue& at) {
  HeightGauge height;
  set(at, "min", height.low);
  set(at, "max", height.high);
  std::string axis = "y";
  set(at, "axis", axis);
  height.axis = axis == "x" ? 0 : axis == "y" ? 1 : 2;
  const Vec3f size = height.high - height.low;
  if (!(size.x > 0) || !(size.y > 0) || !(size.z > 0))
    document.fail(*at.find("max"), "is not above 'min' in each coordinate", "give a box with a volume");
  return height;
}

FlowGauge flow_of(const JsonDocument& document, const JsonValue& at) {
  FlowGauge flow;
  set(at, "corner", flow.corner);
  set(at, "side_a", flow.side_a);
  set(at, "side_b", flow.side_b);
  if (!(length_squared(cross(flow.side_a, flow.side_b)) > 0))
    document.fail(*at.find("side_b"), "spans no area with 'side_a'",
                  "give two sides that are neither zero nor parallel");
  return flow;
}

void set_direction(const JsonDocument& document, const JsonValue& at, Vec3f& direction) {
  set(at, "direction", direction);
  if (!(length_squared(direction) > 0))
    document.fail(*at.find("direction"), "is a direction of no length", "give a direction such as [1, 0, 0]");
}

FrontGauge front_of(const JsonDocument& document, const JsonValue& at) {
  FrontGauge front;
  set_direction(document, at, front.direction);
  set(at, "share", front.share);
  if (!(front.share > 0 && front.share < 1))
    document.fail(*at.find("share"), "is not between 0 and 1", "give a share such as 0.99");
  return front;
}

ForceGauge force_of(const JsonDocument& document, const JsonValue& at, const Scene& scene) {
  ForceGauge force;
  set(at, "on", force.on);
  set_direction(document, at, force.direction);
  const auto is_named = [&](const auto& one) { return one.name == force.on; };
  const auto is_pressed = [&](const Object& one) { return is_named(one) && !one.fluid; };
  const auto count = std::count_if(scene.objects.begin(), scene.objects.end(), is_pressed) +
                     std::count_if(scene.colliders.begin(), scene.colliders.end(), is_named) +
                     std::count_if(scene.mesh_colliders.begin(), scene.mesh_colliders.end(), is_named);
  const std::string name = "'" + printable(force.on) + "'";
  if (count == 0)
    document.fail(*at.find("on"), name + " does not exist, or is a liquid",
                  "use the name of a collider, or of an object that is no liquid");
  if (count > 1) document.fail(*at.find("on"), name + " is an object and a collider", "give them different names");
  return force;
}

std::vector<std::string> liquids_of(const JsonDocument& document, const JsonValue& at, const Scene& scene) {
  std::vector<std::string> names;
  const auto is_liquid = [](const Object& one) { return one.fluid.has_value(); };
  if (std::none_of(scene.objects.begin(), scene.objects.end(), is_liquid))
    document.fail(at, "the scene has no liquid to measure", "add one, or remove the gauge");
  for (const JsonValue& name : elements(at, "liquids")) {
    const auto is_it = [&](const Object& one) { return one.fluid && one.name == name.text; };
    if (std::none_of(scene.objects.begin(), scene.objects.end(), is_it))
      document.fail(name, "there is no liquid '" + printable(name.text) + "'", "use the name of a liquid of the scene");
    names.push_back(name.text);
  }
  return names;
}

}  // namespace

std::vector<Gauge> build_gauges(const JsonDocument& document, const JsonValue& root, const Scene& scene) {
  std::vector<Gauge> gauges;
  std::set<std::string> names;
  for (const JsonValue& item : elements(root, "gauges")) {
    Gauge gauge;
    set(item, "name", gauge.name);
    if (!names.insert(gauge.name).second)
      document.fail(*item.find("name"), "is taken by another gauge", "names differ");
    if (const JsonValue* height = item.find("height")) gauge.measures = height_of(document, *height);
    if (const JsonValue* flow = item.find("flow")) gauge.measures = flow_of(document, *flow);
    if (const JsonValue* front = item.find("front")) gauge.measures = front_of(document, *front);
    if (const JsonValue* force = item.find("force")) gauge.measures = force_of(document, *force, scene);
    gauge.liquids = liquids_of(document, item, scene);
    gauges.push_back(std::move(gauge));
  }
  return gauges;
}

}  // namespace pliant::scene_file
