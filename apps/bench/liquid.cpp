#include "apps/bench/liquid.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <memory>
#include <nlohmann/json.hpp>

#include "pliant/error.h"
#include "pliant/liquid.h"
#include "pliant/world.h"

namespace pliant::bench {

namespace {

constexpr float frame_time = 1.f / 60;

double processor_ms() { return 1000. * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

Scene splash(int particles) {
  const auto across = static_cast<float>(std::lround(std::cbrt(particles / 2.)));
  Scene scene;
  scene.settings.threads = 1;
  scene.add(make_liquid(fill_box({}, {1, 2, 1}, 1 / across), {.fluid = {.spacing = 1 / across}}));
  const auto add = [&](const Vec3f& at, const Vec3f& axis, float degrees) {
    Collider plane;
    plane.position = at;
    plane.rotation = rotation(axis, degrees);
    plane.static_friction = plane.kinetic_friction = 0;
    scene.add(plane);
  };
  add({}, {0, 0, 1}, 0);
  add({}, {0, 0, 1}, -90);
  add({3, 0, 0}, {0, 0, 1}, 90);
  add({}, {1, 0, 0}, 90);
  add({0, 0, 1}, {1, 0, 0}, -90);
  return scene;
}

/// One of the ways to step the same splash.
class Splash {
 public:
  Splash(Scene scene, const std::string& engine, const std::string& isa) : world_(with(std::move(scene), isa)) {
    row_.engine = engine;
    row_.isa = isa.empty() ? world_.isa() : isa;
    row_.particles = world_.object(ObjectId(0)).info().particles;
  }

  void step() {
    const double before = processor_ms();
    const Report report = world_.step(frame_time);
    times_.push_back(processor_ms() - before);
    row_.substeps = report.substeps;
    row_.compression = std::max(row_.compression, report.compression.mean);
  }

  LiquidRow row() {
    std::sort(times_.begin(), times_.end());
    row_.median_ms = times_[times_.size() / 2];
    row_.largest_ms = times_.back();
    row_.ns_per_particle = 1e6 * row_.median_ms / (static_cast<double>(row_.particles) * row_.substeps);
    return row_;
  }

  std::string hash() const { return world_.state_hash(); }

 private:
  static Scene with(Scene scene, const std::string& isa) {
    scene.settings.isa = isa;
    return scene;
  }

  World world_;
  LiquidRow row_;
  std::vector<double> times_;
};

}  // namespace

std::vector<LiquidRow> measure_liquids(const LiquidOptions& options) {
  std::vector<LiquidRow> rows;
  for (const int size : options.sizes) {
    if (size < 100 || size > 10000000)
      throw Error({}, "a liquid of " + std::to_string(size) + " particles", "give 100 to 10000000");
    const Scene scene = splash(size);
    std::vector<Splash> splashes;
    splashes.emplace_back(scene, "plain loop", "sequential");
    splashes.emplace_back(scene, "pliant", "");
    for (int frame = 0; frame < options.frames; ++frame)
      for (Splash& one : splashes) one.step();
    if (splashes.front().hash() != splashes.back().hash())
      throw Error({}, "the plain loop and the lanes give other bits", "report this as a bug");
    double of_plain = 0;
    for (Splash& one : splashes) {
      LiquidRow row = one.row();
      if (of_plain == 0) of_plain = row.median_ms;
      row.ratio = of_plain / row.median_ms;
      rows.push_back(row);
      if (options.on_row) options.on_row(row);
    }
  }
  return rows;
}

std::string to_json(const std::vector<LiquidRow>& rows) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const LiquidRow& row : rows)
    list.push_back({{"particles", row.particles},
                    {"engine", row.engine},
                    {"isa", row.isa},
                    {"substeps", row.substeps},
                    {"median_ms", row.median_ms},
                    {"largest_ms", row.largest_ms},
                    {"ns_per_particle", row.ns_per_particle},
                    {"compression", row.compression},
                    {"ratio", row.ratio}});
  return list.dump(2) + "\n";
}

}  // namespace pliant::bench
