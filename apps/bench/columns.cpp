#include "apps/bench/columns.h"

#include <algorithm>
#include <cmath>

#include "apps/bench/timing.h"
#include "pliant/error.h"
#include "pliant/liquid.h"
#include "pliant/world.h"

namespace pliant::bench {

namespace {

constexpr int column_width = 8, measured_frames = 60;  // particles across; frames of the last second

Scene column(float depth, float spacing, int substeps, int iterations) {
  const float side = static_cast<float>(column_width) * spacing;
  Scene scene;
  scene.settings.threads = 1;
  scene.settings.substeps = substeps;
  scene.settings.iterations = iterations;
  scene.add(make_liquid(fill_box({}, {side, depth, side}, spacing), {.fluid = {.spacing = spacing}}));
  const auto add = [&](const Vec3f& at, const Vec3f& axis, float degrees) {
    Collider plane;
    plane.position = at;
    plane.rotation = rotation(axis, degrees);
    plane.static_friction = plane.kinetic_friction = 0;
    scene.add(plane);
  };
  add({}, {0, 0, 1}, 0);
  add({}, {0, 0, 1}, -90);
  add({side, 0, 0}, {0, 0, 1}, 90);
  add({}, {1, 0, 0}, 90);
  add({0, 0, side}, {1, 0, 0}, -90);
  return scene;
}

double mean_height(const World& world) {
  double sum = 0;
  const std::vector<Vec3f> places = world.object(0).positions();
  for (const Vec3f& p : places) sum += static_cast<double>(p.y);
  return sum / static_cast<double>(places.size());
}

void add_speeds(const World& world, ColumnRow& row) {
  const std::vector<Vec3f> velocities = world.object(0).velocities();
  for (const Vec3f& v : velocities) {
    const auto speed = static_cast<double>(std::hypot(v.x, v.y, v.z));
    row.speed += speed / (static_cast<double>(velocities.size()) * measured_frames);
    row.fastest = std::max(row.fastest, speed);
  }
}

ColumnRow measure(ColumnRow row, int frames) {
  World world(column(static_cast<float>(row.depth), static_cast<float>(row.spacing), row.substeps, row.iterations));
  row.particles = world.object(0).info().particles;
  const double height = mean_height(world);
  std::vector<double> times;
  for (int frame = 0; frame < frames; ++frame) {
    const double before = processor_ms();
    const Report report = world.step(frame_time);
    times.push_back(processor_ms() - before);
    row.substeps = report.substeps;
    if (frame < frames - measured_frames) continue;
    row.mean += report.compression.mean / measured_frames;
    row.largest = std::max(row.largest, report.compression.largest);
    add_speeds(world, row);
  }
  row.height = mean_height(world) / height;
  std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2), times.end());
  row.ms_per_1000 = 1000 * times[times.size() / 2] / row.particles;
  row.ns = 1000 * row.ms_per_1000 / (row.substeps * row.iterations);
  return row;
}

/// The settings to try with one column, those of the engine first.
std::vector<ColumnRow> choices(int depth, double spacing, const ColumnOptions& options) {
  ColumnRow row;
  row.depth = depth / 100.;
  row.spacing = spacing;
  row.iterations = 1;
  row.is_default = true;
  std::vector<ColumnRow> all{row};
  row.is_default = false;
  for (const int iterations : options.iterations)
    for (const int substeps : options.substeps) {
      row.iterations = iterations;
      row.substeps = substeps;
      all.push_back(row);
    }
  return all;
}

}  // namespace

std::vector<ColumnRow> measure_columns(const ColumnOptions& options) {
  constexpr int deepest = 10000;
  constexpr double fewest_layers = 8, most_layers = 100;
  if (options.frames <= measured_frames) throw Error({}, "the last second is measured", "give at least 61 frames");
  std::vector<ColumnRow> rows;
  for (const int depth : options.depths) {
    if (depth < 1 || depth > deepest)
      throw Error({}, "a column of " + std::to_string(depth) + " cm", "give 1 to 10000");
    for (const double spacing : options.spacings) {
      const double layers = depth / 100. / spacing;
      if (layers < fewest_layers || layers > most_layers) continue;
      for (const ColumnRow& choice : choices(depth, spacing, options)) {
        rows.push_back(measure(choice, options.frames));
        if (options.on_row) options.on_row(rows.back());
      }
    }
  }
  return rows;
}

}  // namespace pliant::bench
