// Liquids under gravity, with the default settings: force on a wall, sloshing, a jet from a hole
// (docs/internals/liquids.md).
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "apps/validate/rows.h"
#include "apps/validate/tank.h"
#include "pliant/gauges.h"

namespace pliant::validate {
namespace {

constexpr double water_density = 1000;  // [kg/m^3]

Vec3d centre_of(const std::vector<Vec3f>& places) {
  Vec3d sum{};
  for (const Vec3f& p : places) sum += to_double(p);
  return sum * (1 / static_cast<double>(places.size()));
}

// ------------------------------------------------------------------------------------------------ walls

/// Forces on two walls over what is expected if the level is that of the fill, and the level over that.
struct WallForce {
  double end = 0, level = 0;
};

WallForce wall_force(int layers, float spacing) {
  constexpr int frames = 180, averaged = 60;
  const float height = static_cast<float>(layers) * spacing, width = 6 * spacing;
  const Scene scene = tank_scene({12 * spacing, height, width}, spacing, 12 * spacing);
  World world(scene);
  Gauges gauges({{"end", ForceGauge{"right", {1, 0, 0}}}}, scene, world);
  gauges.read(world);
  WallForce force;
  for (int i = 0; i < frames; ++i) {
    world.step(frame_time);
    const double reading = gauges.read(world).front();
    if (i < frames - averaged) continue;
    force.end += reading / averaged;
    force.level += 2 * centre_of(world.object(0).positions()).y / (static_cast<double>(height) * averaged);
  }
  const double h = static_cast<double>(height);
  force.end /= water_density * standard_gravity * h * h / 2 * static_cast<double>(width);
  return force;
}

void wall_rows(Result& result) {
  constexpr int layers = 16;
  const WallForce force = wall_force(layers, 0.025f);
  const std::string how = "a tank of 1 152 particles, 16 layers, at rest";
  result.rows.push_back(relative("liquids: force on a wall over rho g H^2 / 2", 1, force.end, 0.03, "", how));
  // Without them in the lowest layer, c1 / c = 0.1524 of its force along the floor is missing.
  constexpr double missing = 2 * 0.1524;
  result.rows.push_back(relative("liquids: the same, where the level and the lowest layer's lack of neighbours count",
                                 force.level * (1 - missing / layers), force.end, 0.006, "",
                                 how + "; level of the centre of mass; 0.30 spacings / H less"));
}

// ------------------------------------------------------------------------------------------------ sloshing

/// The mean period of the first `halves` half periods, over that of linear waves, after a start with a tilted surface.
double sloshing_period(double degrees, std::size_t halves) {
  constexpr float spacing = 0.025f, length = 0.8f, depth = 0.4f, width = 3 * spacing;
  const float slope = static_cast<float>(std::tan(degrees * pi / 180));
  std::vector<Vec3f> places = fill_box({}, {length, 2 * depth, width}, spacing);
  std::erase_if(places, [&](const Vec3f& p) { return !(p.y < depth + (p.x - length / 2) * slope); });
  Scene scene = water_scene(places, spacing);
  add_tank(scene, {length, depth, width});
  World world(scene);
  std::vector<double> crossings;
  double before = 1, level = 0;
  int frame = 0;
  for (; crossings.size() < halves + 1 && frame < 300; ++frame) {
    world.step(frame_time);
    const Vec3d centre = centre_of(world.object(0).positions());
    const double x = centre.x - static_cast<double>(length) / 2;
    if (x * before < 0) crossings.push_back((frame + before / (before - x)) * static_cast<double>(frame_time));
    before = x;
    level += 2 * centre.y;
  }
  if (crossings.size() < halves + 1) return infinity;
  const double k = pi / static_cast<double>(length),
               period = 2 * (crossings.back() - crossings.front()) / static_cast<double>(halves);
  return period * std::sqrt(standard_gravity * k * std::tanh(k * level / frame)) / (2 * pi);
}

void sloshing_rows(Result& result) {
  const std::string how = "0.8 m of water, 0.4 m deep, 1 536 particles; ";
  result.rows.push_back(relative("liquids: sloshing, period over that of linear waves, 10 degrees", 1,
                                 sloshing_period(10, 3), 0.03, "", how + "g k tanh(k H), first three half periods"));
  // An exception: particles at rest resist small shear, by their pressure, as a jammed packing does.
  const double small = sloshing_period(3, 4);
  result.rows.push_back(relative("liquids: sloshing, period, 3 degrees: missed", 0.92, small, 0.03, "",
                                 how + "small waves are too fast: packings of particles have a shear modulus"));
}

// ------------------------------------------------------------------------------------------------ a jet

void add_slab(Scene& scene, const Vec3f& low, const Vec3f& high) {
  Collider box;
  box.name = "floor";
  box.shape = Box{(high - low) * 0.5f};
  box.position = (low + high) * 0.5f;
  box.static_friction = box.kinetic_friction = 0;
  scene.add(box);
}

/// A tank with a square hole in the middle of its floor, and a lid below it as the last collider.
Scene tank_with_hole(float side, float depth, float hole, float spacing) {
  constexpr float thickness = 0.02f, beyond = 0.2f;
  Scene scene = water_scene(fill_box({}, {side, depth, side}, spacing), spacing);
  add_tank(scene, {side, depth, side}, false);
  const float low = (side - hole) / 2, high = (side + hole) / 2, end = side + beyond;
  add_slab(scene, {-beyond, -thickness, -beyond}, {low, 0, end});
  add_slab(scene, {high, -thickness, -beyond}, {end, 0, end});
  add_slab(scene, {low, -thickness, -beyond}, {high, 0, low});
  add_slab(scene, {low, -thickness, high}, {high, 0, end});
  add_slab(scene, {low, -2 * thickness, low}, {high, -thickness, high});
  return scene;
}

/// The speed of a jet one hole below the floor over that by Bernoulli, from the level and how fast it falls.
double speed_of_jet(float side, float hole) {
  constexpr float spacing = 0.02f, depth = 0.4f;
  constexpr int settling = 60, starting = 15, frames = 30;
  const Scene scene = tank_with_hole(side, depth, hole, spacing);
  World world(scene);
  for (int i = 0; i < settling; ++i) world.step(frame_time);
  world.remove(world.colliders().back());
  const double of_particle = std::pow(static_cast<double>(spacing), 3) / std::pow(static_cast<double>(side), 2);
  double before = static_cast<double>(depth), sum = 0, count = 0;
  for (int i = 0; i < frames; ++i) {
    world.step(frame_time);
    const std::vector<Vec3f> places = world.object(0).positions(), velocities = world.object(0).velocities();
    const auto in_tank = std::count_if(places.begin(), places.end(), [](const Vec3f& p) { return p.y > 0; });
    const double level = static_cast<double>(in_tank) * of_particle,
                 falls = (before - level) / static_cast<double>(frame_time);
    before = level;
    for (std::size_t k = 0; i >= starting && k < places.size(); ++k) {
      if (std::abs(places[k].y + hole) > hole / 4) continue;
      const double head = level - static_cast<double>(places[k].y);
      sum += -static_cast<double>(velocities[k].y) / std::sqrt(2 * standard_gravity * head + falls * falls);
      ++count;
    }
  }
  return sum / count;
}

void jet_rows(Result& result) {
  const std::string how = "0.4 m of water over a square hole in the floor, one hole below it; ";
  result.rows.push_back(relative("liquids: speed of a jet from a hole 8 spacings wide (Torricelli)", 1,
                                 speed_of_jet(0.32f, 0.16f), 0.04, "", how + "5 120 particles"));
  // An exception: where few particles are side by side, the liquid that converges loses energy.
  result.rows.push_back(relative("liquids: speed of a jet from a hole 5 spacings wide: missed", 0.91,
                                 speed_of_jet(0.32f, 0.1f), 0.03, "", how + "a narrow jet is too slow"));
}

}  // namespace

void liquid_under_gravity_rows(Result& result) {
  wall_rows(result);
  sloshing_rows(result);
  jet_rows(result);
}

}  // namespace pliant::validate
