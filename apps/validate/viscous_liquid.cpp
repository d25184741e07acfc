// Viscous liquids: flow between two plates (Poiseuille).
#include <algorithm>
#include <cmath>
#include <string>

#include "apps/validate/rows.h"
#include "pliant/liquid.h"

namespace pliant::validate {
namespace {

constexpr double liquid_density = 1000;
constexpr float liquid_spacing = 0.01f, liquid_depth = 16 * liquid_spacing;

enum class Wall { holds, slips };

void add_wall(Scene& scene, const Vec3f& at, const Vec3f& axis, float degrees, Wall wall) {
  Collider plane;
  plane.position = at;
  plane.rotation = rotation(axis, degrees);
  plane.static_friction = plane.kinetic_friction = wall == Wall::slips ? 0 : 0.4f;
  scene.add(plane);
}

/// Liquid in a box between planes of symmetry at z = 0 and z = depth.
Scene sheet(const Vec3f& size, float viscosity, int substeps) {
  Scene scene;
  scene.frame_time = frame_time;
  scene.settings.threads = 1;
  scene.settings.substeps = substeps;
  scene.add(
      make_liquid(fill_box({}, size, liquid_spacing), {.fluid = {.spacing = liquid_spacing, .viscosity = viscosity}}));
  add_wall(scene, {}, {1, 0, 0}, 90, Wall::slips);
  add_wall(scene, {0, 0, size.z}, {1, 0, 0}, -90, Wall::slips);
  return scene;
}

/// Places before a frame, and velocities by the way that particles go in it.
struct Flow {
  std::vector<Vec3f> places;
  std::vector<Vec3d> velocities;
};

Flow next_frame(World& world) {
  Flow flow{world.object(0).positions(), {}};
  world.step(frame_time);
  const std::vector<Vec3f> after = world.object(0).positions();
  for (std::size_t i = 0; i < after.size(); ++i)
    flow.velocities.push_back(to_double(after[i] - flow.places[i]) * (1 / static_cast<double>(frame_time)));
  return flow;
}

/// The mean over the middle third of an extent, of places for which `counts` is true.
template <class Value, class Counts>
double mean_in_the_middle(const Flow& flow, float Vec3f::*along, const Value& value, const Counts& counts) {
  const auto less = [&](const Vec3f& a, const Vec3f& b) { return a.*along < b.*along; };
  const auto [low, high] = std::minmax_element(flow.places.begin(), flow.places.end(), less);
  const float third = ((*high).*along - (*low).*along) / 3, from = (*low).*along + third, to = (*high).*along - third;
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < flow.places.size(); ++i) {
    const Vec3f& p = flow.places[i];
    if (p.*along < from || p.*along > to || !counts(p)) continue;
    sum += value(flow.velocities[i]);
    ++count;
  }
  return sum / count;
}

void plates_rows(Result& result, float viscosity, int substeps) {
  constexpr float width = 12 * liquid_spacing;
  Scene scene = sheet({width, 3 * width, liquid_depth}, viscosity, substeps);
  scene.gravity = {0, static_cast<float>(-standard_gravity), 0};
  add_wall(scene, {}, {0, 0, 1}, -90, Wall::holds);
  add_wall(scene, {width, 0, 0}, {0, 0, 1}, 90, Wall::holds);
  World world(scene);
  for (int i = 0; i < 12; ++i) world.step(frame_time);
  const Flow flow = next_frame(world);
  const auto down = [](const Vec3d& v) { return -v.y; };
  const double mean = mean_in_the_middle(flow, &Vec3f::y, down, [](const Vec3f&) { return true; });
  const double expected =
      liquid_density * standard_gravity * static_cast<double>(width * width) / (12 * static_cast<double>(viscosity));
  result.rows.push_back(relative("liquids: falls between two plates, " + brief(static_cast<double>(viscosity)) +
                                     " Pa s, " + std::to_string(substeps) + " substeps",
                                 expected, mean, 0.15, "m/s",
                                 "12 particles across; mean velocity in the middle third, rho g d^2 / (12 mu)"));
}

}  // namespace

void viscous_liquid_rows(Result& result) {
  for (const float viscosity : {100.f, 1000.f, 10000.f}) plates_rows(result, viscosity, 10);
  plates_rows(result, 100, 40);
}

}  // namespace pliant::validate
