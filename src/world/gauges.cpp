// Checks gauges against a scene, and reads them.
#include "pliant/gauges.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "math/vector.h"
#include "pliant/error.h"
#include "world/gauge_formulas.h"

namespace pliant {

namespace {

[[noreturn]] void refuse(const Gauge& gauge, const std::string& problem, const std::string& advice) {
  throw Error({.element = "gauge '" + gauge.name + "'"}, problem, advice);
}

void check_direction(const Gauge& gauge, const Vec3f& direction) {
  if (!is_finite(direction) || !(length_squared(convert<double>(direction)) > 0))
    refuse(gauge, "has a direction of no length", "give a direction such as [1, 0, 0]");
}

void check(const Gauge& gauge, const HeightGauge& height) {
  const Vec3f &low = height.low, &high = height.high;
  if (!is_finite(low) || !is_finite(high) || !(low.x < high.x) || !(low.y < high.y) || !(low.z < high.z))
    refuse(gauge, "has a box without a volume",
           "each coordinate of its low corner must be less than that of its high one");
  if (height.axis < 0 || height.axis > 2)
    refuse(gauge, "has the axis " + std::to_string(height.axis), "give 0 for x, 1 for y or 2 for z");
}

void check(const Gauge& gauge, const FlowGauge& flow) {
  const Vec3d normal = cross(convert<double>(flow.side_a), convert<double>(flow.side_b));
  if (!is_finite(flow.corner) || !is_finite(flow.side_a) || !is_finite(flow.side_b) || !(length_squared(normal) > 0))
    refuse(gauge, "has sides that span no area", "give two sides that are neither zero nor parallel");
}

void check(const Gauge& gauge, const FrontGauge& front) {
  check_direction(gauge, front.direction);
  if (!(front.share > 0 && front.share < 1))
    refuse(gauge, "has the share " + std::to_string(front.share), "give a share between 0 and 1, such as 0.99");
}

void check(const Gauge& gauge, const ForceGauge& force) { check_direction(gauge, force.direction); }

std::vector<int> measured_by(const Gauge& gauge, const std::vector<std::string>& liquids) {
  if (liquids.empty()) refuse(gauge, "finds no liquid in the scene", "add a liquid, or remove the gauge");
  std::vector<int> found;
  for (std::size_t i = 0; i < liquids.size(); ++i)
    if (gauge.liquids.empty() ||
        std::find(gauge.liquids.begin(), gauge.liquids.end(), liquids[i]) != gauge.liquids.end())
      found.push_back(static_cast<int>(i));
  for (const std::string& name : gauge.liquids)
    if (std::find(liquids.begin(), liquids.end(), name) == liquids.end())
      refuse(gauge, "measures '" + name + "', but no liquid of that name exists",
             "use the name of a liquid of the scene");
  return found;
}

/// What a gauge of a force names.
Thing pressed_by(const Gauge& gauge, const std::string& name, const Scene& scene, const World& world) {
  std::vector<Thing> found;
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    if (scene.objects[i].name == name && !scene.objects[i].fluid) found.emplace_back(world.objects()[i]);
  for (std::size_t i = 0; i < scene.colliders.size(); ++i)
    if (scene.colliders[i].name == name) found.emplace_back(world.colliders()[i]);
  for (std::size_t i = 0; i < scene.mesh_colliders.size(); ++i)
    if (scene.mesh_colliders[i].name == name) found.emplace_back(world.mesh_colliders()[i]);
  if (found.empty())
    refuse(gauge, "measures the force on '" + name + "', which does not exist or is a liquid",
           "use the name of a collider, or of an object that is no liquid");
  if (found.size() > 1)
    refuse(gauge, "measures the force on '" + name + "', which is not unique", "give them other names");
  return found.front();
}

void require_fitting(const Scene& scene, const World& world) {
  if (world.objects().size() == scene.objects.size() && world.colliders().size() == scene.colliders.size() &&
      world.mesh_colliders().size() == scene.mesh_colliders.size())
    return;
  throw Error({.element = "gauges"}, "the scene has another number of objects or colliders than the World",
              "pass the scene from which the World was made");
}

double height_of(const HeightGauge& gauge, double volume) {
  const Vec3d size = convert<double>(gauge.high) - convert<double>(gauge.low);
  const double base = gauge.axis == 0 ? size.y * size.z : gauge.axis == 1 ? size.x * size.z : size.x * size.y;
  return volume / base;
}

}  // namespace

std::string unit_of(const Gauge& gauge) {
  if (std::holds_alternative<FlowGauge>(gauge.measures)) return "m^3/s";
  return std::holds_alternative<ForceGauge>(gauge.measures) ? "N" : "m";
}

Gauges::Gauges(std::vector<Gauge> gauges, const Scene& scene, World& world) : gauges_(std::move(gauges)) {
  require_fitting(scene, world);
  std::vector<std::string> liquids;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (!scene.objects[i].fluid) continue;
    liquids.push_back(scene.objects[i].name);
    liquids_.push_back({world.objects()[i], static_cast<double>(scene.objects[i].fluid->spacing), {}, {}, {}});
  }
  std::set<std::string> names;
  for (const Gauge& gauge : gauges_) {
    if (gauge.name.empty()) refuse(gauge, "has no name", "give it one");
    if (!names.insert(gauge.name).second) refuse(gauge, "has the name of another gauge", "give it another");
    std::visit([&](const auto& one) { check(gauge, one); }, gauge.measures);
    measured_.push_back(measured_by(gauge, liquids));
    const auto* force = std::get_if<ForceGauge>(&gauge.measures);
    pressed_.push_back(force == nullptr ? Thing{} : pressed_by(gauge, force->on, scene, world));
    if (force != nullptr) world.record_contact_events(true);
  }
}

std::vector<double> Gauges::read(const World& world) {
  duration_ = is_first_ ? 0 : world.state().time - time_;
  for (Liquid& liquid : liquids_) {
    liquid.before = std::move(liquid.positions);
    liquid.positions.clear();
    liquid.ages.clear();
    if (world.has(liquid.object)) {
      liquid.positions = world.object(liquid.object).positions();
      if (world.object(liquid.object).flows()) liquid.ages = world.object(liquid.object).ages();
    }
    if (liquid.before.size() != liquid.positions.size()) liquid.before = liquid.positions;  // edited, or the first call
  }
  std::vector<double> values;
  for (std::size_t i = 0; i < gauges_.size(); ++i) values.push_back(value(world, i));
  time_ = world.state().time;
  is_first_ = false;
  return values;
}

template <class Body>
void Gauges::for_present(const Liquid& liquid, const Body& body) {
  for (std::size_t p = 0; p < liquid.positions.size(); ++p)
    if (liquid.ages.empty() || liquid.ages[p] >= 0) body(liquid.positions[p], liquid.spacing);
}

double Gauges::value(const World& world, std::size_t gauge) const {
  const std::vector<int>& of = measured_[gauge];
  const auto& measures = gauges_[gauge].measures;
  if (const auto* through = std::get_if<FlowGauge>(&measures)) return flow(*through, of);
  if (const auto* on = std::get_if<ForceGauge>(&measures)) return force(world, *on, of, pressed_[gauge]);
  if (const auto* box = std::get_if<HeightGauge>(&measures)) {
    double volume = 0;
    for (const int i : of)
      for_present(liquids_[static_cast<std::size_t>(i)],
                  [&](const Vec3f& place, double spacing) { volume += common_volume(*box, place, spacing); });
    return height_of(*box, volume);
  }
  const FrontGauge& front = std::get<FrontGauge>(measures);
  const Vec3d direction = convert<double>(front.direction) * (1 / length(convert<double>(front.direction)));
  std::vector<LiquidInterval> intervals;
  for (const int i : of)
    for_present(liquids_[static_cast<std::size_t>(i)], [&](const Vec3f& place, double side) {
      intervals.push_back({dot(convert<double>(place), direction), side, side * side * side});
    });
  return front_of(intervals, static_cast<double>(front.share));
}

double Gauges::flow(const FlowGauge& through, const std::vector<int>& of) const {
  if (!(duration_ > 0)) return std::numeric_limits<double>::quiet_NaN();
  double volume = 0;
  for (const int i : of) {
    const Liquid& liquid = liquids_[static_cast<std::size_t>(i)];
    const double of_particle = liquid.spacing * liquid.spacing * liquid.spacing;
    for (std::size_t p = 0; p < liquid.positions.size(); ++p) {
      if (!liquid.ages.empty() && !(liquid.ages[p] > duration_ * (1 + 1e-9))) continue;  // it was not there before
      volume += of_particle * passed_share(through, liquid.before[p], liquid.positions[p], liquid.spacing);
    }
  }
  return volume / duration_;
}

double Gauges::force(const World& world, const ForceGauge& force, const std::vector<int>& of, const Thing& on) const {
  if (!(duration_ > 0)) return std::numeric_limits<double>::quiet_NaN();
  Vec3d push{};
  for (const ContactEvent& event : world.contact_events())
    for (const int i : of) {
      const Thing liquid = liquids_[static_cast<std::size_t>(i)].object;
      if (event.first == on && event.second == liquid) push += event.push;
      if (event.second == on && event.first == liquid) push = push - event.push;
    }
  const Vec3d direction = convert<double>(force.direction);
  return dot(push, direction) / (length(direction) * duration_);
}

}  // namespace pliant
