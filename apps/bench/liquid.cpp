#include "apps/bench/liquid.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "apps/bench/memory.h"
#include "apps/bench/timing.h"
#include "pliant/error.h"
#include "pliant/liquid.h"
#include "pliant/surface.h"
#include "pliant/world.h"

namespace pliant::bench {

namespace {

constexpr float splash_spacing = 0.05f, step_time = 0.005f;
constexpr int most_for_plain_loop = 400000;

/// A block about 1.26 times as high as it is wide.
Scene splash(int particles, bool has_stray) {
  const auto across = static_cast<float>(std::lround(std::cbrt(particles / 1.26)));
  const Vec3f size =
      splash_spacing * Vec3f{across, std::round(static_cast<float>(particles) / (across * across)), across};
  Scene scene;
  scene.settings.threads = 1;
  scene.settings.substeps = 5;
  std::vector<Vec3f> places = fill_box({}, size, splash_spacing);
  if (has_stray) places[places.size() / 2] = {0.5f, 1000, 0.5f};
  scene.add(make_liquid(places, {.fluid = {.spacing = splash_spacing}}));
  const auto add = [&](const Vec3f& at, const Vec3f& axis, float degrees) {
    Collider plane;
    plane.position = at;
    plane.rotation = rotation(axis, degrees);
    plane.static_friction = plane.kinetic_friction = 0;
    scene.add(plane);
  };
  add({}, {0, 0, 1}, 0);
  add({}, {0, 0, 1}, -90);
  add({5 * size.x, 0, 0}, {0, 0, 1}, 90);
  add({}, {1, 0, 0}, 90);
  add({0, 0, size.z}, {1, 0, 0}, -90);
  return scene;
}

/// One of the ways to step the same splash.
class Splash {
 public:
  Splash(const Scene& scene, const std::string& engine) : world_(for_engine(scene, engine)) {
    row_.engine = engine;
    row_.isa = engine == "plain loop" ? "sequential" : world_.isa();
    row_.particles = world_.object(ObjectId(0)).info().particles;
  }

  void step() {
    const double before = processor_ms(), wall_before = wall_ms();
    const Report report = world_.step(row_.engine == "1/60 s" ? frame_time : step_time);
    times_.push_back(processor_ms() - before);
    wall_times_.push_back(wall_ms() - wall_before);
    double search = 0;
    for (const PhaseTime& phase : report.phases)
      if (phase.name.rfind("neighbours", 0) == 0) search += phase.milliseconds;
    searches_.push_back(search / report.milliseconds);
    row_.substeps = report.substeps;
    row_.compression = std::max(row_.compression, report.compression.mean);
  }

  /// Compares the times with those of the same steps.
  LiquidRow row(const Splash& other) {
    const bool is_parallel = has_two_threads(row_.engine);
    const std::vector<double>&mine = is_parallel ? wall_times_ : times_,
          &theirs = is_parallel ? other.wall_times_ : other.times_;
    row_.median_ms = median(mine);
    row_.largest_ms = *std::max_element(mine.begin(), mine.end());
    row_.ns_per_particle = 1e6 * row_.median_ms / (static_cast<double>(row_.particles) * row_.substeps);
    row_.search = median(searches_);
    std::vector<double> ratios;
    for (std::size_t i = 0; i < mine.size(); ++i) ratios.push_back(theirs[i] / mine[i]);
    row_.ratio = median(ratios);
    return row_;
  }

  /// The median of several surfaces, as of several steps: only the first of a movie waits for memory from the system.
  void measure_surface() {
    const std::vector<Vec3f> places = world_.object(ObjectId(0)).positions();
    std::vector<double> times;
    for (int repeat = 0; repeat < 9; ++repeat) {
      const double before = processor_ms();
      liquid_surface(places, {.spacing = splash_spacing, .threads = 1});
      times.push_back(processor_ms() - before);
    }
    row_.surface = median(times) / median(times_);
  }

  LiquidRow& row() { return row_; }
  std::string hash() const { return world_.state_hash(); }

 private:
  static bool has_two_threads(const std::string& engine) { return engine == "two threads" || engine == "1/60 s"; }

  static Scene for_engine(Scene scene, const std::string& engine) {
    if (engine == "plain loop") scene.settings.isa = "sequential";
    if (has_two_threads(engine)) scene.settings.threads = 2;
    if (engine == "1/60 s") scene.settings.substeps = 0;
    return scene;
  }

  World world_;
  LiquidRow row_;
  std::vector<double> times_, wall_times_, searches_;
};

double bytes_for_each(int size) {
  return measure_bytes([&] { return splash(100, false); }, [&] { return splash(size, false); }) / size;
}

std::vector<Splash> ways_to_splash(int size) {
  std::vector<Splash> all;
  const Scene scene = splash(size, false);
  if (size < most_for_plain_loop) all.emplace_back(scene, "plain loop");
  for (const char* engine : {"pliant", "two threads", "1/60 s"}) all.emplace_back(scene, engine);
  all.emplace_back(splash(size, true), "stray");
  return all;
}

}  // namespace

std::vector<LiquidRow> measure_liquids(const LiquidOptions& options) {
  std::vector<LiquidRow> rows;
  std::vector<double> bytes;  // before there are threads
  for (const int size : options.sizes) {
    if (size < 100 || size > 10000000)
      throw Error({}, "a liquid of " + std::to_string(size) + " particles", "give 100 to 10000000");
    bytes.push_back(bytes_for_each(size));
  }
  for (std::size_t i = 0; i < options.sizes.size(); ++i) {
    const int size = options.sizes[i];
    std::vector<Splash> splashes = ways_to_splash(size);
    for (int frame = 0; frame < options.frames; ++frame)
      for (Splash& one : splashes) one.step();
    const Splash& plain = splashes.front();
    const auto pliant =
        std::find_if(splashes.begin(), splashes.end(), [](Splash& one) { return one.row().engine == "pliant"; });
    for (const Splash* other : {static_cast<const Splash*>(&plain), static_cast<const Splash*>(&pliant[1])})
      if (pliant->hash() != other->hash())
        throw Error({}, "the plain loop, the lanes and two threads do not give the same bits", "report this as a bug");
    pliant->row().bytes = bytes[i];
    pliant->measure_surface();
    for (Splash& one : splashes) {
      rows.push_back(one.row(one.row().engine == "two threads" ? *pliant : plain));
      if (options.on_row) options.on_row(rows.back());
    }
  }
  return rows;
}

}  // namespace pliant::bench
