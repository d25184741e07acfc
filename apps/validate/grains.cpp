// Grains: a silo whose walls bear a part of the weight (Janssen 1895), and the flow through holes (Beverloo 1961).
// Both need a packing without order: grains that fall from a lattice of small jitter stand in columns, which neither
// push on walls nor flow on.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "apps/validate/rows.h"
#include "pliant/grains.h"
#include "pliant/liquid.h"

namespace pliant::validate {
namespace {

constexpr float radius_of_grain = 0.01f, diameter_of_grain = 2 * radius_of_grain;  // [m]

/// Grains that fall from a block of a size [m] into a loose packing without order, a third as high.
Scene loose_grains(const Vec3f& size, float friction) {
  constexpr float wide = 1.4f, jitter = 0.19f;  // in diameters
  Scene scene;
  scene.gravity = {0, -static_cast<float>(standard_gravity), 0};
  scene.frame_time = frame_time;
  scene.settings.threads = 1;
  const std::vector<Vec3f> places = jittered(fill_box({}, size, wide * diameter_of_grain), jitter * diameter_of_grain);
  scene.add(make_grains(places, {.name = "sand", .grains = {.radius = radius_of_grain, .friction = friction}}));
  return scene;
}

/// A box as rough as the grains.
void add_rough_box(Scene& scene, const char* name, const Vec3f& low, const Vec3f& high) {
  Collider box;
  box.name = name;
  box.shape = Box{(high - low) * 0.5f};
  box.position = (low + high) * 0.5f;
  box.static_friction = box.kinetic_friction = scene.objects.front().static_friction;
  scene.add(box);
}

/// Four walls around a square, and 0.3 m beyond it downwards.
void add_rough_walls(Scene& scene, float side, float height) {
  constexpr float thick = 0.2f, below = -0.3f;
  add_rough_box(scene, "wall", {-thick, below, -thick}, {0, height, side + thick});
  add_rough_box(scene, "wall", {side, below, -thick}, {side + thick, height, side + thick});
  add_rough_box(scene, "wall", {0, below, -thick}, {side, height, 0});
  add_rough_box(scene, "wall", {0, below, side}, {side, height, side + thick});
}

// ------------------------------------------------------------------------------------------------ a silo

/// Means over the last frames.
struct Silo {
  double floor = 0;   ///< push on the floor over the weight
  double walls = 0;   ///< sum of the pushes on the walls over the weight
  double height = 0;  ///< of the grains, over the width

  double friction() const { return (1 - floor) / walls; }
  /// The pressure ratio K by Janssen: floor / weight = (1 - exp(-x)) / x, x = 4 K friction height / width.
  double pressure_ratio() const {
    double low = 1e-9, high = 100;
    for (int i = 0; i < 60; ++i) {
      const double x = (low + high) / 2;
      ((1 - std::exp(-x)) / x > floor ? low : high) = x;
    }
    return low / (4 * friction() * height);
  }
};

/// The floor is lowered at 4 cm/s for the last second: only then do the walls' friction and the weight act against one
/// another in full.
Silo measure_silo(float side, float filled, float friction) {
  constexpr int frames = 150, lowered = 60, averaged = 40;
  constexpr float speed = 0.04f, half = 0.1f;
  Scene scene = loose_grains({side, filled, side}, friction);
  add_rough_walls(scene, side, 2 * filled);
  add_rough_box(scene, "floor", {-side / 2, -2 * half, -side / 2}, {1.5f * side, 0, 1.5f * side});
  World world(scene);
  world.record_contact_events(true);
  const ColliderId floor = world.colliders().back();
  const Thing grains = world.objects().front();
  const double number = static_cast<double>(scene.objects[0].positions.size());
  const double weight = number * static_cast<double>(scene.objects[0].masses[0]) * standard_gravity;
  Silo silo;
  float top = 0;
  for (int i = 0; i < frames; ++i) {
    if (i >= frames - lowered) {
      top -= speed * frame_time;
      world.collider(floor).set_pose({{side / 2, top - half, side / 2}, {0, 0, 0, 1}});
    }
    world.step(frame_time);
    if (i < frames - averaged) continue;
    const double share = 1 / (weight * averaged * static_cast<double>(frame_time));
    for (const ContactEvent& event : world.contact_events()) {
      const bool is_floor = event.first == Thing(floor) || event.second == Thing(floor);
      if (is_floor) silo.floor += std::abs(event.push.y) * share;
      if (!is_floor && (event.first == grains) != (event.second == grains)) silo.walls += length(event.push) * share;
    }
    double sum = 0;
    for (const Vec3f& p : world.object(0).positions()) sum += static_cast<double>(p.y - top);
    silo.height += 2 * sum / (number * averaged * static_cast<double>(side));
  }
  return silo;
}

void silo_rows(Result& result, float friction, float filled_widths, double tolerance) {
  constexpr float side = 8 * diameter_of_grain;
  const Silo silo = measure_silo(side, filled_widths * side, friction);
  const double t = static_cast<double>(friction), sine_squared = t * t / (1 + t * t);
  const std::string name = "grains: silo, " + brief(std::round(10 * silo.height) / 10) + " widths high, friction " +
                           brief(std::round(100 * t) / 100) + ", ";
  const std::string how = "8 diameters wide, the floor is lowered at 4 cm/s; ";
  result.rows.push_back(relative(name + "friction of walls", t, silo.friction(), 0.03, "",
                                 how + "weight that they bear over their pressure"));
  // Walls as rough as the bulk: the stress at the wall is at the bound of the bulk.
  result.rows.push_back(relative(name + "pressure ratio K", (1 - sine_squared) / (1 + sine_squared),
                                 silo.pressure_ratio(), tolerance, "",
                                 how + "Janssen, by the load of the floor; (1 - sin^2) / (1 + sin^2)"));
}

// ------------------------------------------------------------------------------------------------ an hourglass

/// Grains a second through a square hole in the floor of a bin, while from a tenth to three tenths of them flow out.
double flow_through(float hole) {
  constexpr float side = 18 * diameter_of_grain, filled = 60 * diameter_of_grain, thick = diameter_of_grain / 4,
                  end = 0.2f;
  constexpr int settling = 50, most_frames = 300;
  Scene scene = loose_grains({side, filled, side}, 0.6f);
  add_rough_walls(scene, side, 2 * filled);
  const float low = (side - hole) / 2, high = (side + hole) / 2;
  add_rough_box(scene, "floor", {-end, -thick, -end}, {low, 0, side + end});
  add_rough_box(scene, "floor", {high, -thick, -end}, {side + end, 0, side + end});
  add_rough_box(scene, "floor", {low, -thick, -end}, {high, 0, low});
  add_rough_box(scene, "floor", {low, -thick, high}, {high, 0, side + end});
  add_rough_box(scene, "lid", {low - thick, -thick - end, low - thick}, {high + thick, -thick, high + thick});
  World world(scene);
  for (int i = 0; i < settling; ++i) world.step(frame_time);
  world.remove(world.colliders().back());
  const double number = static_cast<double>(scene.objects[0].positions.size());
  double first = 0, first_out = 0;
  for (int i = 1; i <= most_frames; ++i) {
    world.step(frame_time);
    const std::vector<Vec3f> places = world.object(0).positions();
    const auto out =
        static_cast<double>(std::count_if(places.begin(), places.end(), [](const Vec3f& p) { return p.y < -thick; }));
    if (first == 0 && out > 0.1 * number) first = i, first_out = out;
    if (out > 0.3 * number) return (out - first_out) / ((i - first) * static_cast<double>(frame_time));
  }
  return 0;
}

/// Beverloo, Leniger and van de Velde (1961): 0.58 of the bulk's density for a circle; by area for a square [1/s].
double flow_by_beverloo(double diameters) {
  constexpr double d = diameter_of_grain, in_bulk = 0.55 / (pi / 6);  // grains in the cube of a diameter
  return 0.58 * (4 / pi) * in_bulk * std::sqrt(standard_gravity / d) * std::pow(diameters - 1.4, 2.5);
}

void hourglass_rows(Result& result) {
  constexpr float narrow = 6, wide = 10;  // diameters
  const double through_narrow = flow_through(narrow * diameter_of_grain),
               through_wide = flow_through(wide * diameter_of_grain);
  const std::string how = "square holes in a bin 18 diameters wide, filled to 20; Beverloo, (D - 1.4 d)^2.5";
  result.rows.push_back(relative("grains: flow through holes of 10 and 6 diameters, ratio",
                                 flow_by_beverloo(wide) / flow_by_beverloo(narrow), through_wide / through_narrow, 0.05,
                                 "", how));
  result.rows.push_back(
      relative("grains: flow through a hole of 10 diameters", flow_by_beverloo(wide), through_wide, 0.15, "1/s", how));
}

}  // namespace

void grain_rows(Result& result, bool slow) {
  silo_rows(result, 0.8f, 6, 0.1);
  silo_rows(result, 0.6f, 6, 0.35);
  if (!slow) return;
  silo_rows(result, 0.8f, 12, 0.1);
  hourglass_rows(result);
}

}  // namespace pliant::validate
