// The workloads: which engines run on which cloth, and how frames are timed.
#include "apps/bench/bench.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>

#include "apps/bench/cloth.h"
#include "apps/bench/quality.h"
#include "apps/bench/timing.h"
#include "pliant/error.h"

namespace pliant::bench {
namespace {

constexpr Steps small_steps{10, 1}, bullets_best{1, 10};
constexpr int frames_of_phases = 20;
constexpr int smallest_size = 2, largest_size = 4096;

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

// The quantile `rank` of the values; the argument is a copy, because values are reordered.
double quantile(std::vector<double> values, double rank) {
  if (values.empty()) return 0;
  const auto index = static_cast<std::ptrdiff_t>(
      std::min(rank * static_cast<double>(values.size()), static_cast<double>(values.size() - 1)));
  std::nth_element(values.begin(), values.begin() + index, values.end());
  return values[static_cast<std::size_t>(index)];
}

void measure_stretch(const Cloth& cloth, const std::vector<Vec3f>& x, Row& row) {
  std::vector<double> ratios;
  double sum = 0;
  bool finite = true;
  for (const Edge& edge : cloth.edges) {
    const Vec3f d = x[edge.b] - x[edge.a];
    const double dx = d.x, dy = d.y, dz = d.z;
    ratios.push_back(std::sqrt(dx * dx + dy * dy + dz * dz) / edge.rest_length);
    sum += ratios.back();
    finite = finite && std::isfinite(ratios.back());
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  row.stretch_mean = finite ? sum / static_cast<double>(ratios.size()) : nan;
  row.stretch_p99 = finite ? quantile(ratios, 0.99) : nan;
  row.stretch_max = finite ? *std::max_element(ratios.begin(), ratios.end()) : nan;
}

class Bench {
 public:
  explicit Bench(const Options& options) : options_(options) {}

  void run(const std::string& workload, int size) {
    first_ms_ = 0;
    const std::string suffix = "-alternating";
    const bool alternates =
        workload.size() > suffix.size() && workload.substr(workload.size() - suffix.size()) == suffix;
    const Diagonals diagonals = alternates ? Diagonals::alternating : Diagonals::uniform;
    const std::string kind = alternates ? workload.substr(0, workload.size() - suffix.size()) : workload;
    if (kind == "W1-stretching") run_w1(workload, make_w1(size, false, diagonals), size);
    if (kind == "W1-bending") run_w1(workload, make_w1(size, true, diagonals), size);
    if (kind == "W1-1x10") run_1x10(workload, make_w1(size, false, diagonals), size);
    if (workload == "W1-set-up") run_set_up(workload, size);
    for (const QualityWorkload& quality : quality_workloads())
      if (workload == quality.as.name) run_quality(quality, size);
  }

  std::vector<Row> take_rows() { return std::move(rows_); }

 private:
  void run_w1(const std::string& workload, const Cloth& cloth, int size) {
    measure({workload, size, "plain loop"}, cloth, small_steps, [&] { return make_plain_loop(cloth, small_steps); });
    measure_pliant(workload, cloth, size, small_steps);
  }

  void run_1x10(const std::string& workload, const Cloth& cloth, int size) {
    if (options_.against_bullet) {
      for (BulletOrder order : {BulletOrder::spread, BulletOrder::shuffled})
        measure({workload, size, order == BulletOrder::spread ? "bullet" : "bullet, links shuffled"}, cloth,
                bullets_best, [&] { return make_bullet(cloth, bullets_best, order); });
    }
    measure({workload, size, "plain loop"}, cloth, bullets_best, [&] { return make_plain_loop(cloth, bullets_best); });
    measure_pliant(workload, cloth, size, bullets_best);
    measure_pliant(workload, cloth, size,
                   small_steps);  // the same number of projections as small steps, as recommended
  }

  void run_set_up(const std::string& workload, int size) {
    const auto start = std::chrono::steady_clock::now();
    Cloth cloth;
    cloth.object = make_w1_object(size, true);
    const auto engine = make_pliant(cloth, small_steps, options_.threads);
    Row row{workload, size, "pliant"};
    row.ms_per_frame = milliseconds_since(start);
    row.threads = engine->threads();
    const double cells = static_cast<double>(size - 1) * (size - 1), border = 4.0 * (size - 1);
    const double edges = 3 * cells + border / 2;
    finish(row, edges + (edges - border));
  }

  void run_quality(const QualityWorkload& workload, int size) {
    for (const Row& row : measure_quality(workload, size, options_.frames)) {
      rows_.push_back(row);
      if (options_.on_row) options_.on_row(row);
    }
  }

  void measure_pliant(const std::string& workload, const Cloth& cloth, int size, Steps steps) {
    measure({workload, size, "pliant"}, cloth, steps, [&] { return make_pliant(cloth, steps, 1); });
    const auto many = make_pliant(cloth, steps, options_.threads)->threads();
    if (many > 1)
      measure({workload, size, "pliant"}, cloth, steps, [&] { return make_pliant(cloth, steps, options_.threads); });
  }

  template <class Make>
  void measure(Row row, const Cloth& cloth, Steps steps, const Make& make) {
    const std::unique_ptr<Engine> engine = make();
    row.threads = engine->threads();
    row.substeps = steps.substeps;
    row.iterations = steps.iterations;
    for (int i = 0; i < options_.warm_up; ++i) engine->step(frame_time);
    std::vector<double> times;
    for (int i = 0; i < options_.frames; ++i) {
      const auto start = std::chrono::steady_clock::now();
      engine->step(frame_time);
      times.push_back(milliseconds_since(start));
    }
    row.ms_per_frame = quantile(times, 0.5);
    measure_stretch(cloth, engine->positions(), row);
    row.phases = engine->phases(frame_time, std::min(options_.frames, frames_of_phases));
    finish(row, static_cast<double>(cloth.edges.size() + cloth.hinges.size()) * steps.substeps * steps.iterations);
  }

  void finish(Row row, double projections) {
    row.ns_per_projection = row.ms_per_frame * 1e6 / projections;
    if (first_ms_ == 0) first_ms_ = row.ms_per_frame;
    row.ratio = first_ms_ / row.ms_per_frame;
    rows_.push_back(row);
    if (options_.on_row) options_.on_row(row);
  }

  const Options& options_;
  std::vector<Row> rows_;
  double first_ms_ = 0;  // time of the first row of the same workload and size [ms]
};

void check(const Options& options) {
  std::string names;
  for (const Workload& workload : workloads()) names += (names.empty() ? "" : ", ") + workload.name;
  const auto known = [&](const Workload& workload) { return workload.name == options.workload; };
  if (!options.workload.empty() && std::none_of(workloads().begin(), workloads().end(), known))
    throw Error({}, "there is no workload '" + options.workload + "'",
                "choose one of " + names + ", contact, W3, W3-ball, W3-cloth");
  for (int size : options.sizes)
    if (size < smallest_size || size > largest_size)
      throw Error({}, "a cloth of " + std::to_string(size) + " x " + std::to_string(size) + " cannot be measured",
                  "choose a size in " + std::to_string(smallest_size) + ".." + std::to_string(largest_size));
  if (options.frames < 1 || options.warm_up < 0)
    throw Error({}, "there are no frames to measure", "measure at least 1");
  if (options.against_bullet && !has_bullet())
    throw Error({}, "this program was built without Bullet", "install libbullet-dev and configure again");
}

}  // namespace

const std::vector<Workload>& workloads() {
  static const std::vector<Workload> frames{
      {"W1-stretching", "N x N cloth hung by two corners, edges only, 10 substeps of 1 iteration"},
      {"W1-bending", "the same with a dihedral bending constraint for each inner edge"},
      {"W1-stretching-alternating", "as W1-stretching, but with alternating diagonals"},
      {"W1-bending-alternating", "as W1-bending, but with alternating diagonals"},
      {"W1-1x10",
       "edges only, 1 substep of 10 iterations, at which Bullet is fastest; the last row is Pliant with 10 substeps of "
       "1"},
      {"W1-1x10-alternating", "the same with alternating diagonals"},
      {"W1-set-up", "time to make and compile the cloth with bending, once"},
  };
  static const std::vector<Workload> all = [] {
    std::vector<Workload> list = frames;
    for (const QualityWorkload& quality : quality_workloads()) list.push_back(quality.as);
    return list;
  }();
  return all;
}

bool has_bullet() { return PLIANT_HAS_BULLET != 0; }

std::vector<Row> run(const Options& options) {
  check(options);
  Bench bench(options);
  for (const Workload& workload : workloads())
    if (options.workload.empty() ? workload.name.rfind("W1-quality", 0) != 0 : options.workload == workload.name)
      for (int size : options.sizes) bench.run(workload.name, size);
  return bench.take_rows();
}

}  // namespace pliant::bench
