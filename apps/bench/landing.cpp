// The two landings: their scenes, Pliant's engine for them, and the measurement.
#include "apps/bench/landing.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>

#include "apps/bench/bench.h"
#include "apps/bench/timing.h"
#include "pliant/error.h"
#include "pliant/queries.h"
#include "pliant/world.h"

namespace pliant::bench {
namespace {

constexpr float cloth_width = 1, thickness_of_edge = 0.1f;
constexpr float damping =
    6;  // rate of damping [1/s]; without it Bullet's positions become infinite within 20 frames at N = 64

Object cloth_at(int size, float height, float degrees, const std::string& name) {
  TriangleMesh mesh = grid_mesh(size, size, cloth_width, cloth_width);
  const float angle = degrees * 3.14159265f / 180, c = std::cos(angle), s = std::sin(angle);
  for (Vec3f& p : mesh.positions) p = {c * p.x + s * p.z, p.y + height, c * p.z - s * p.x};
  ClothOptions options;
  options.name = name;
  options.material = fabric("cotton");
  options.stretch = Stiffness::rigid();
  options.bending_model = ClothOptions::Bending::none;
  Object object = make_cloth(mesh, options);
  object.thickness = thickness_of_edge * cloth_width / static_cast<float>(size - 1);
  object.self_collision = object.collides = true;
  object.damping = damping;
  return object;
}

class PliantLanding final : public LandingEngine {
 public:
  PliantLanding(const Landing& landing, Steps steps) : world_(scene_of(landing, steps)) {}
  void step(float dt) override { world_.step(dt); }
  std::vector<Vec3f> positions(int cloth) const override { return world_.object(cloth).positions(); }

 private:
  static Scene scene_of(const Landing& landing, Steps steps) {
    Scene scene;
    scene.settings.substeps = steps.substeps;
    scene.settings.iterations = steps.iterations;
    scene.settings.sweep = Sweep::tiled;  // makes as many projections as Bullet
    scene.settings.threads = 1;
    for (const Object& cloth : landing.cloths) scene.add(cloth);
    if (landing.radius > 0) {
      Collider ball;
      ball.shape = Sphere{landing.radius};
      ball.position = landing.ball;
      scene.add(ball);
    }
    return scene;
  }

  World world_;
};

double inclusive_quantile(std::vector<double> values, double q) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// ---------------------------------------------------------------- the state at the end

std::size_t crossings_of(const Landing& landing, const LandingEngine& engine) {
  TriangleMesh all;
  for (int c = 0; c < static_cast<int>(landing.cloths.size()); ++c) {
    const int first = static_cast<int>(all.positions.size());
    for (const auto& [i, j, k] : landing.cloths[static_cast<std::size_t>(c)].triangles)
      all.triangles.push_back({first + i, first + j, first + k});
    const std::vector<Vec3f> more = engine.positions(c);
    all.positions.insert(all.positions.end(), more.begin(), more.end());
  }
  return find_crossings(all).size();
}

void measure_stretch(const Landing& landing, const LandingEngine& engine, LandingRow& row) {
  std::vector<double> ratios;
  for (int c = 0; c < static_cast<int>(landing.cloths.size()); ++c) {
    const std::vector<Vec3f> x = engine.positions(c);
    for (const Edge& edge : landing.edges[static_cast<std::size_t>(c)])
      ratios.push_back(std::sqrt(double(length_squared(x[edge.b] - x[edge.a]))) / double(edge.rest_length));
  }
  row.stretch_mean = row.stretch_p99 = std::numeric_limits<double>::quiet_NaN();
  double sum = 0;
  for (const double ratio : ratios) sum += ratio;
  if (!std::isfinite(sum)) return;
  row.stretch_mean = sum / static_cast<double>(ratios.size());
  row.stretch_p99 = inclusive_quantile(ratios, 0.99);
}

/// Simulates frames until all are done or the time limit is reached. Returns the time of each frame [ms].
std::vector<double> run_frames(LandingEngine& engine, const LandingOptions& options) {
  std::vector<double> times;
  double sum = 0;
  while (static_cast<int>(times.size()) < options.frames && sum < options.limit * 1e3) {
    const std::clock_t start = std::clock();
    engine.step(frame_time);
    times.push_back(static_cast<double>(std::clock() - start) * 1e3 / CLOCKS_PER_SEC);
    sum += times.back();
  }
  return times;
}

LandingRow measure(const Landing& landing, const LandingOptions& options, const char* name, Steps steps,
                   LandingEngine& engine) {
  LandingRow row;
  row.on = landing.on;
  row.size = landing.size;
  row.engine = name;
  row.substeps = steps.substeps;
  row.iterations = steps.iterations;
  const std::vector<double> times = run_frames(engine, options);
  row.frames = static_cast<int>(times.size());
  row.in_time = row.frames == options.frames;
  for (const double time : times) row.mean_ms += time / row.frames;
  row.median_ms = inclusive_quantile(times, 0.5);
  row.largest_ms = inclusive_quantile(times, 1);
  measure_stretch(landing, engine, row);
  if (std::isfinite(row.stretch_mean)) row.crossings = crossings_of(landing, engine);
  return row;
}

std::vector<LandingRow> measure_all(const Landing& landing, const LandingOptions& options) {
  constexpr Steps steps{10, 1}, more_steps{20, 1};
  constexpr int clusters_of_examples = 64;
  std::vector<LandingRow> rows;
  const auto add = [&](const char* name, Steps taken, const std::unique_ptr<LandingEngine>& engine) {
    LandingRow row = measure(landing, options, name, taken, *engine);
    row.ratio = rows.empty() ? 1 : rows.front().mean_ms / row.mean_ms;
    if (options.on_row) options.on_row(row);
    rows.push_back(std::move(row));
  };
  if (options.against_bullet) {
    add("bullet, fine", steps, make_bullet_landing(landing, steps, 0));
    add("bullet", steps, make_bullet_landing(landing, steps, clusters_of_examples));
  }
  add("pliant", steps, make_pliant_landing(landing, steps));
  add("pliant", more_steps, make_pliant_landing(landing, more_steps));
  return rows;
}

}  // namespace

Landing make_landing(const std::string& on, int size) {
  Landing landing{on, size, {}, {}, {}, 0};
  if (on == "ball") {
    landing.radius = 0.25f;
    landing.cloths.push_back(cloth_at(size, 0.26f, 0, "cloth"));
  } else if (on == "cloth") {
    Object held = cloth_at(size, 0, 0, "held");
    for (const int corner : {0, size - 1, size * (size - 1), size * size - 1}) held.pins.push_back({corner, {}});
    landing.cloths = {held, cloth_at(size, 0.03f, 30, "falling")};
  } else {
    throw Error({}, "there is no landing on a '" + on + "'", "choose ball or cloth");
  }
  for (const Object& cloth : landing.cloths) landing.edges.push_back(edges_of(cloth));
  return landing;
}

std::unique_ptr<LandingEngine> make_pliant_landing(const Landing& landing, Steps steps) {
  return std::make_unique<PliantLanding>(landing, steps);
}

std::vector<LandingRow> measure_landings(const LandingOptions& options) {
  if (options.frames < 1 || !(options.limit > 0))
    throw Error({}, "there are no frames to measure", "measure at least 1");
  for (const int size : options.sizes)
    if (size < 2 || size > 4096)
      throw Error({}, "a cloth of " + std::to_string(size) + " vertices per side cannot be measured",
                  "choose a size in 2..4096");
  if (options.against_bullet && !has_bullet())
    throw Error({}, "this program was built without Bullet", "install libbullet-dev and configure again");
  std::vector<LandingRow> rows;
  for (const std::string& on : options.on)
    for (const int size : options.sizes) {
      const std::vector<LandingRow> more = measure_all(make_landing(on, size), options);
      rows.insert(rows.end(), more.begin(), more.end());
    }
  return rows;
}

}  // namespace pliant::bench
