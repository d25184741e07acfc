// W1 with inextensible edges, on which engines have diverged: values must stay finite, speeds low, and energy must not
// rise.
#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/validate/rows.h"

namespace pliant::validate {
namespace {

constexpr int first_swing = 60;  // number of frames of the first swing
constexpr double speed_limit = 20;

struct SheetSwing {
  double fastest = 0;      // largest speed after the first swing [m/s]
  double energy_gain = 0;  // largest energy above the initial one [J]
  bool finite = true;
  double mean_stretch = 1, largest_stretch = 1;
  plot::Series energy;
};

Scene w1(int side) {
  ClothOptions options;
  options.material.area_density = 0.2f;
  options.stretch = Stiffness::rigid();
  Scene scene = scene_with(make_cloth(grid_mesh(side, side, 1, 1), options), 9.81, 10, 1);
  scene.settings.threads = 0;
  scene.pin(0, {0, side - 1});
  return scene;
}

double fastest_of(const std::vector<Vec3f>& velocities) {
  float fastest = 0;
  for (const Vec3f& v : velocities) {
    const float squared = length_squared(v);
    if (!std::isfinite(squared)) return std::numeric_limits<double>::infinity();
    fastest = std::max(fastest, squared);
  }
  return std::sqrt(static_cast<double>(fastest));
}

SheetSwing swing(int side, int frames) {
  World world(w1(side));
  const double start = world.measure().kinetic_energy() + world.measure().potential_energy();
  SheetSwing result;
  result.energy.name = brief(side) + " x " + brief(side);
  for (int i = 0; i < frames && result.finite; ++i) {
    const Report report = world.step(1.f / 60);
    const double speed = fastest_of(world.object(0).velocities()),
                 energy = world.measure().kinetic_energy() + world.measure().potential_energy();
    result.finite = report.ok() && std::isfinite(speed) && std::isfinite(energy);
    if (i >= first_swing) result.fastest = std::max(result.fastest, speed);
    result.energy_gain = std::max(result.energy_gain, energy - start);
    result.energy.x.push_back((i + 1) / 60.0);
    result.energy.y.push_back(energy);
  }
  const Stretch stretch = world.measure().stretch();
  result.mean_stretch = stretch.mean;
  result.largest_stretch = stretch.largest;
  return result;
}

}  // namespace

void steadiness_rows(Result& result, bool slow) {
  const int frames = slow ? 3000 : 300;
  plot::Chart chart{"Energy of the inextensible hanging cloth", "time [s]", "energy [J]", false, false, {}};
  for (int side : slow ? std::vector<int>{64, 128, 256, 512} : std::vector<int>{64, 128}) {
    const SheetSwing swung = swing(side, frames);
    const std::string name = "steadiness: engine, " + brief(side) + " x " + brief(side) + ", ";
    const std::string note = brief(frames) + " frames, compliance 0, 10 substeps of 1 iteration";
    result.rows.push_back(
        absolute(name + "finite", 1, swung.finite ? 1 : 0, 0, "",
                 note + "; stretch mean " + brief(swung.mean_stretch) + ", largest " + brief(swung.largest_stretch)));
    result.rows.push_back(at_most(name + "fastest particle", speed_limit, swung.finite ? swung.fastest : INFINITY,
                                  "m/s", note + ", after the first 60"));
    result.rows.push_back(
        at_most(name + "energy above the start's", 0, swung.finite ? swung.energy_gain : INFINITY, "J", note));
    chart.series.push_back(swung.energy);
  }
  result.charts.push_back(chart);
}

}  // namespace pliant::validate
