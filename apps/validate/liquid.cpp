// Liquids: the dam break of Martin and Moyce (1952), a column at rest, and the momentum of liquid that nothing touches.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "apps/validate/rows.h"
#include "apps/validate/tank.h"
#include "pliant/gauges.h"
#include "pliant/liquid.h"

namespace pliant::validate {
namespace {

constexpr const char* source = "J. C. Martin and W. J. Moyce, Phil. Trans. R. Soc. A 244 (1952), 312-324, n^2 = 2";

/// Points of a measured curve.
using Curve = std::vector<std::pair<double, double>>;

/// The front x / a against t sqrt(2 g / a).
const Curve measured_front{{.41, 1.11},    {.84, 1.22},    {1.19, 1.44},   {1.43, 1.67},    {1.63, 1.89},
                           {1.83, 2.11},   {1.98, 2.33},   {2.20, 2.56},   {2.32, 2.78},    {2.51, 3.00},
                           {2.65, 3.22},   {2.83, 3.44},   {2.98, 3.67},   {3.11, 3.89},    {3.33, 4.11},
                           {4.034, 4.944}, {5.091, 6.980}, {6.306, 8.966}, {8.031, 11.977}, {9.237, 13.970}};
/// The height of the column h / (2 a) against t sqrt(g / a).
const Curve measured_height{{.56, .94},  {.93, .83},  {1.28, .72}, {1.66, .61},
                            {2.00, .50}, {2.45, .39}, {3.06, .28}, {4.20, .17}};

/// The points of this curve at which the column is at least a high.
constexpr std::size_t thick_points = 5;

/// The value of a curve of samples `step` apart from 0, between them linear.
double value_at(const std::vector<double>& samples, double step, double at) {
  const double place = at / step;
  const auto before = std::min(static_cast<std::size_t>(place), samples.size() - 2);
  const double share = place - static_cast<double>(before);
  return samples[before] * (1 - share) + samples[before + 1] * share;
}

/// The relative error of samples at each point of a curve.
std::vector<double> errors_of(const std::vector<double>& samples, double step, const Curve& expected) {
  std::vector<double> errors;
  for (const auto& [x, y] : expected) errors.push_back(value_at(samples, step, x) / y - 1);
  return errors;
}

/// The largest magnitude of the first `count` errors.
double largest_of(const std::vector<double>& errors, std::size_t count) {
  double largest = 0;
  for (std::size_t i = 0; i < count; ++i) largest = std::max(largest, std::abs(errors[i]));
  return largest;
}

double mean_of(const std::vector<double>& errors) {
  double sum = 0;
  for (const double error : errors) sum += std::abs(error) / static_cast<double>(errors.size());
  return sum;
}

std::string percent(double share) { return brief(std::round(10000 * share) / 100) + " %"; }

plot::Series series_of(const std::string& name, const std::vector<double>& samples, double step) {
  plot::Series series;
  series.name = name;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    series.x.push_back(step * static_cast<double>(i));
    series.y.push_back(samples[i]);
  }
  return series;
}

plot::Series series_of(const Curve& curve) {
  plot::Series series;
  series.name = "measured";
  for (const auto& [x, y] : curve) series.x.push_back(x), series.y.push_back(y);
  return series;
}

/// A dam of width a and height 2 a, with `across` particles over its width and six over its depth.
void dam_rows(Result& result, int across, plot::Chart& fronts, plot::Chart& heights) {
  constexpr float a = 0.5f;
  const float spacing = a / static_cast<float>(across);
  const Scene scene = tank_scene({a, 2 * a, 6 * spacing}, spacing, 16 * a);
  World world(scene);
  const float cell = 2 * spacing;
  Gauges gauges(
      {{"front", FrontGauge{{1, 0, 0}, 0.99f}}, {"height", HeightGauge{{0, 0, 0}, {cell, 4 * a, 6 * spacing}}}}, scene,
      world);
  std::vector<double> front, height;
  const double unit = std::sqrt(static_cast<double>(a) / (2 * static_cast<double>(gravity_in_float)));
  const int frames = static_cast<int>(measured_front.back().first * unit / static_cast<double>(frame_time)) + 2;
  double compression = 0;
  for (int i = 0; i <= frames; ++i) {
    const std::vector<double> values = gauges.read(world);
    front.push_back(values[0] / static_cast<double>(a));
    height.push_back(values[1] / (2 * static_cast<double>(a)));
    compression = std::max(compression, world.step(frame_time).compression.mean);
  }
  const double step = static_cast<double>(frame_time) / unit;
  const std::string size = std::to_string(across) + " particles over its width";
  const std::vector<double> of_front = errors_of(front, step, measured_front);
  const std::vector<double> of_height = errors_of(height, step / std::sqrt(2.0), measured_height);
  result.rows.push_back(
      at_most("liquids: dam break, front, largest error, " + size, 0.1, largest_of(of_front, of_front.size()), "",
              "mean " + percent(mean_of(of_front)) + "; 99 % of the liquid is behind the front; compressed by " +
                  percent(compression) + " at most; " + source));
  result.rows.push_back(
      at_most("liquids: dam break, height at the wall down to h / (2 a) = 0.5, largest error, " + size, 0.1,
              largest_of(of_height, thick_points), "", "by volume over two spacings"));
  // An exception: where the column is thin, the known answer is not reached.
  std::string missed;
  bool is_missed = true;
  for (std::size_t i = thick_points; i < of_height.size(); ++i) {
    missed += (missed.empty() ? "" : ", ") + brief(measured_height[i].second) + " by " + percent(of_height[i]);
    is_missed = is_missed && std::abs(of_height[i]) > 0.1;
  }
  result.rows.push_back(relative("liquids: dam break, height at the wall below that, " + size + ": missed", 1,
                                 is_missed ? 1 : 0, 0, "", "not within 10 %: the water stands too high, at " + missed));
  fronts.series.push_back(series_of(size, front, step));
  heights.series.push_back(series_of(size, height, step / std::sqrt(2.0)));
}

void add_dam_rows(Result& result) {
  plot::Chart fronts{"Dam break: the front", "t sqrt(2 g / a)", "x / a", false, false, {}};
  plot::Chart heights{"Dam break: the column", "t sqrt(g / a)", "h / (2 a)", false, false, {}};
  for (const int across : {11, 22, 32}) dam_rows(result, across, fronts, heights);
  fronts.series.push_back(series_of(measured_front));
  heights.series.push_back(series_of(measured_height));
  result.charts.push_back(fronts);
  result.charts.push_back(heights);
}

/// The height of a column whose particles are spread evenly from the floor: twice that of their centre.
double height_of(const World& world) {
  const std::vector<Vec3f> places = world.object(0).positions();
  double sum = 0;
  for (const Vec3f& p : places) sum += static_cast<double>(p.y);
  return 2 * sum / static_cast<double>(places.size());
}

void column_rows(Result& result) {
  constexpr float spacing = 0.05f, height = 2, side = 0.2f;
  constexpr int frames = 3600, averaged = 60;
  const Scene scene = tank_scene({side, height, side}, spacing, side);
  World world(scene);
  Gauges gauges({{"weight", ForceGauge{"floor"}}}, scene, world);
  gauges.read(world);
  plot::Series curve;
  curve.name = "2 m";
  double force = 0;
  Compression compression;
  for (int i = 0; i < frames; ++i) {
    compression = world.step(frame_time).compression;
    const double reading = gauges.read(world).front();
    if (i >= frames - averaged) force += reading / averaged;
    curve.x.push_back(world.state().time);
    curve.y.push_back(height_of(world) / static_cast<double>(height));
  }
  const double weight = 1000 * static_cast<double>(height * side * side * gravity_in_float);
  const std::string how = "2 m of 640 particles at rest for 60 s, default substeps";
  result.rows.push_back(at_most("liquids: column, mean compression", 0.01, compression.mean, "", how));
  result.rows.push_back(at_most("liquids: column, largest compression", 0.05, compression.largest, "", how));
  result.rows.push_back(
      relative("liquids: column, force on the floor", weight, force, 0.02, "N", "mean of the last second"));
  result.rows.push_back(relative("liquids: column, volume after 60 s", 1, curve.y.back(), 0.02, "",
                                 "by the height of the centre of mass, over that at the start"));
  result.charts.push_back({"A column of liquid keeps its volume", "time [s]", "V / V0", false, false, {curve}});
}

/// Linear and angular momentum over the mass of a particle.
struct LiquidMomentum {
  Vec3d linear{}, angular{};
  double size = 0;          ///< sum of |v|
  double angular_size = 0;  ///< sum of |x| |v|
};

LiquidMomentum momentum_of(const World& world) {
  LiquidMomentum sum;
  const std::vector<Vec3f> places = world.object(0).positions(), velocities = world.object(0).velocities();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Vec3d v = to_double(velocities[i]), x = to_double(places[i]);
    sum.linear += v;
    sum.angular += cross(x, v);
    sum.size += length(v);
    sum.angular_size += length(x) * length(v);
  }
  return sum;
}

void momentum_rows_of_liquid(Result& result) {
  constexpr float spacing = 0.05f;
  std::vector<Vec3f> places = fill_box({-0.5f, -0.3f, -0.3f}, {-0.01f, 0.2f, 0.2f}, spacing);
  const std::size_t first = places.size();
  for (const Vec3f& p : fill_box({0.05f, -0.2f, -0.2f}, {0.55f, 0.3f, 0.3f}, spacing)) places.push_back(p);
  Object liquid = make_liquid(places, {.fluid = {.spacing = spacing}});
  liquid.velocities.assign(places.size(), {1, 0, 0});
  for (std::size_t i = first; i < places.size(); ++i) liquid.velocities[i] = {-3, 0.5f, 0};
  Scene scene;
  scene.gravity = {};
  scene.settings.threads = 1;
  scene.add(liquid);
  World world(scene);
  const LiquidMomentum before = momentum_of(world);
  for (int i = 0; i < 60; ++i) world.step(frame_time);
  const LiquidMomentum after = momentum_of(world);
  const std::string how = "two blocks that meet at 4 m/s, 60 frames";
  result.rows.push_back(absolute("liquids: linear momentum", 0, length(after.linear - before.linear) / before.size,
                                 1e-6, "", how + "; change over the sum of the magnitudes of m v"));
  result.rows.push_back(absolute("liquids: angular momentum", 0,
                                 length(after.angular - before.angular) / before.angular_size, 0.01, "",
                                 how + "; change over that of arm times momentum, of the first order of the substep"));
}

}  // namespace

void liquid_rows(Result& result, bool) {
  add_dam_rows(result);
  column_rows(result);
  momentum_rows_of_liquid(result);
  overlapping_liquid_rows(result);
  liquid_under_gravity_rows(result);
  viscous_liquid_rows(result);
}

}  // namespace pliant::validate
