// A closed membrane with a volume constraint must enclose pressure times its rest volume, while its skin can stretch.
#include <cmath>

#include "apps/validate/rows.h"

namespace pliant::validate {
namespace {

struct Balloon {
  double volume = 0, roundness = 1;  // ratios: volume to rest volume, smallest to largest radius
};

Balloon blow_up(double pressure, plot::Series& curve) {
  ClothOptions options;
  options.stretch = Stiffness::compliance(0.02f);
  options.bending_model = ClothOptions::Bending::none;
  Volume volume;
  volume.pressure = static_cast<float>(pressure);
  volume.stiffness = Stiffness::rigid();
  options.volume = volume;
  Object object = make_cloth(sphere_mesh(3), options);
  object.damping = 4;
  World world(scene_with(std::move(object), 0, 20, 2));
  const double rest = world.object(0).enclosed_volume();
  for (int i = 0; i < 180; ++i) {
    world.step(1.f / 60);
    curve.x.push_back((i + 1) / 60.0);
    curve.y.push_back(world.object(0).enclosed_volume() / rest);
  }
  double smallest = 1e30, largest = 0;
  for (const Vec3f& x : world.object(0).positions()) {
    const double radius = std::sqrt(static_cast<double>(length_squared(x)));
    smallest = std::min(smallest, radius);
    largest = std::max(largest, radius);
  }
  return {curve.y.back(), smallest / largest};
}

}  // namespace

void balloon_rows(Result& result, bool) {
  plot::Chart chart{"Balloons fill to their pressure", "time [s]", "V / V0", false, false, {}};
  const double rest = World(scene_with(make_cloth(sphere_mesh(3)), 0, 1, 1)).object(0).enclosed_volume();
  result.rows.push_back(relative("balloon: engine, volume of the rest shape", 4 * pi / 3, rest, 0.02, "m^3",
                                 "a sphere of 1280 triangles"));
  for (double pressure : {0.5, 1.0, 1.5, 3.0}) {
    plot::Series curve;
    curve.name = "k = " + brief(pressure);
    const Balloon balloon = blow_up(pressure, curve);
    const std::string name = "balloon: engine, V / V0 at k = " + brief(pressure);
    result.rows.push_back(relative(name, pressure, balloon.volume, 0.01, "", "rigid volume, elastic skin, after 3 s"));
    if (pressure >= 1)
      result.rows.push_back(absolute("balloon: engine, roundness at k = " + brief(pressure), 1, balloon.roundness, 0.02,
                                     "", "smallest over largest radius"));
    chart.series.push_back(curve);
  }
  result.charts.push_back(chart);
}

}  // namespace pliant::validate
