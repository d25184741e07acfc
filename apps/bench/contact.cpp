// Measures the draping cloth of docs/internals/performance.md. Larger sizes consist of separate cloths, each with a
// ball of its own, so the cost per particle should not depend on their number.
#include "apps/bench/contact.h"

#include <algorithm>
#include <ctime>

#include "apps/bench/timing.h"
#include "pliant/error.h"
#include "pliant/world.h"

namespace pliant::bench {
namespace {

constexpr float edge_length = 0.01f;
constexpr int largest_cloth = 100;

/// Adds a cloth over a ball, both displaced horizontally by `beside`.
void add_drape(Scene& scene, int size, const Vec3f& beside, bool self_collision) {
  const float width = edge_length * static_cast<float>(size - 1);
  TriangleMesh mesh = grid_mesh(size, size, width, width);
  for (Vec3f& p : mesh.positions) p = p + beside + Vec3f{0, 0.42f * width, 0};
  ClothOptions options;
  options.material = fabric("cotton");
  Object cloth = make_cloth(mesh, options);
  cloth.thickness = 0.001f;
  cloth.self_collision = self_collision;
  scene.add(cloth);
  Collider ball;
  ball.shape = Sphere{0.3f * width};
  ball.position = beside + Vec3f{0, 0.1f * width, 0};
  scene.add(ball);
}

Scene drapes(int size, bool self_collision) {
  Scene scene;
  scene.settings.threads = 1;
  scene.settings.substeps = 20;
  scene.settings.sweep = Sweep::tiled;
  const int along = size % largest_cloth == 0 ? size / largest_cloth : 1, each = size / along;
  const float apart = 2 * edge_length * static_cast<float>(each);
  for (int i = 0; i < along * along; ++i)
    add_drape(scene, each, {apart * static_cast<float>(i % along), 0, apart * static_cast<float>(i / along)},
              self_collision);
  return scene;
}

double milliseconds(World& world, Report& report) {
  const std::clock_t start = std::clock();
  report = world.step(frame_time);
  return static_cast<double>(std::clock() - start) * 1e3 / CLOCKS_PER_SEC;
}

ContactRow measure(int size, int frames) {
  World without(drapes(size, false)), with(drapes(size, true));
  std::vector<double> times[2];
  ContactRow row;
  row.size = size;
  row.particles = size * size;
  std::vector<double> candidates;
  for (int frame = 0; frame < frames; ++frame) {
    Report report;
    times[0].push_back(milliseconds(without, report));
    times[1].push_back(milliseconds(with, report));
    candidates.push_back(static_cast<double>(report.pairs.candidates) / row.particles);
    row.lists += static_cast<double>(report.pairs.rebuilds) / frames;
  }
  row.without_ms = median(times[0]);
  row.with_ms = median(times[1]);
  row.largest_ms = *std::max_element(times[1].begin(), times[1].end());
  row.ratio = row.with_ms / row.without_ms;
  row.with_us_per_particle = row.with_ms * 1e3 / row.particles;
  row.candidates_per_particle = median(candidates);
  return row;
}

}  // namespace

std::vector<ContactRow> measure_contact(const ContactOptions& options) {
  if (options.frames < 1) throw Error({}, "there are no frames to measure", "measure at least 1");
  for (const int size : options.sizes)
    if (size < 2 || size > 4096)
      throw Error({}, "a cloth of " + std::to_string(size) + " vertices per side cannot be measured",
                  "choose a size in 2..4096");
  std::vector<ContactRow> rows;
  for (const int size : options.sizes) {
    rows.push_back(measure(size, options.frames));
    if (options.on_row) options.on_row(rows.back());
  }
  return rows;
}

}  // namespace pliant::bench
