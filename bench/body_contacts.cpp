// Measures the passes over contacts of rigid bodies: a pyramid of unit boxes, 100 at its base, which is 5 050 bodies
// and 14 950 manifolds of four points. Times are for all of them; items_per_second counts manifolds.
#include <benchmark/benchmark.h>

#include <ctime>
#include <string>
#include <utility>
#include <vector>

#include "levels/compiled.h"
#include "pliant/error.h"
#include "solver/bodies/manifold_blocks.h"
#include "solver/kernels.h"

namespace pliant {
namespace {

constexpr int base = 100;
constexpr float h = 1.f / 480;

struct Pyramid {
  std::vector<BodyMotion> motions = std::vector<BodyMotion>(1);  ///< the ground is first
  std::vector<char> is_fixed{1};
  std::vector<std::pair<int, int>> bodies_of;
  std::vector<Manifold> manifolds;
  ManifoldColours colours;
};

/// Contact of two boxes whose centres are `apart`, over `width` times the whole depth.
void touch(int a, int b, const Vec3f& normal, const Vec3f& arm_a, const Vec3f& arm_b, float width, Pyramid& pyramid) {
  Manifold m;
  m.a = a;
  m.b = b;
  m.count = 4;
  m.normal = normal;
  m.tangent1 = {0, 0, 1};
  m.tangent2 = cross(m.normal, m.tangent1);
  m.arm_a = arm_a;
  m.arm_b = arm_b;
  m.x = {-0.5f, 0.5f, 0.5f, -0.5f};
  m.y = {-0.5f * width, -0.5f * width, 0.5f * width, 0.5f * width};
  m.gap = {-1e-4f, -1e-4f, -1e-4f, -1e-4f};
  m.friction = 0.6f;
  pyramid.bodies_of.emplace_back(a, b);
  pyramid.manifolds.push_back(m);
}

Pyramid make_pyramid() {
  Pyramid pyramid;
  const Vec3f up{0, 1, 0}, right{1, 0, 0};
  BodyMotion box;
  box.inverse_mass = 1;
  box.inverse_inertia = {6, 6, 6, 0, 0, 0};
  int below = 1, first = 1;
  for (int row = 0; row < base; below = first, first += base - row, ++row)
    for (int i = 0; i < base - row; ++i) {
      const int body = first + i;
      pyramid.motions.push_back(box);
      pyramid.is_fixed.push_back(0);
      if (row == 0) touch(0, body, up, {static_cast<float>(i), 0, 0}, up * -0.5f, 1, pyramid);
      if (row > 0) touch(below + i, body, up, {0.25f, 0.5f, 0}, {-0.25f, -0.5f, 0}, 0.5f, pyramid);
      if (row > 0) touch(below + i + 1, body, up, {-0.25f, 0.5f, 0}, {0.25f, -0.5f, 0}, 0.5f, pyramid);
      if (i > 0) touch(body - 1, body, right, right * 0.5f, right * -0.5f, 1, pyramid);
    }
  pyramid.colours.colour(pyramid.bodies_of, pyramid.is_fixed);
  return pyramid;
}

/// Processor time of this thread, which other programs disturb less than they disturb the clock.
double seconds_of_thread() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

enum class Part { colours, fill, prepare, warm_start, position_pass, velocity_pass, take };

/// Runs substeps of which the time of one part counts, so that the numbers stay those of a pile at rest.
class Run {
 public:
  Run(Part part, const std::string& isa) : part_(part), kernels_(pick_kernels(isa).manifolds) {}

  void frame(benchmark::State& state) {
    for (BodyMotion& m : pyramid_.motions) m.displacement = m.rotation = {};
    const double before = seconds_;
    time(Part::colours, [&] { pyramid_.colours.colour(pyramid_.bodies_of, pyramid_.is_fixed); });
    time(Part::fill, [&] {
      blocks_.fill(
          executor_, pyramid_.colours, pyramid_.is_fixed, [](int) {},
          [&](int i) { return pyramid_.manifolds[static_cast<std::size_t>(i)]; });
    });
    time(Part::prepare, [&] { blocks_.prepare(executor_, kernels_, pyramid_.motions); });
    for (int substep = 0; substep < 8; ++substep) this->substep();
    time(Part::take, [&] {
      blocks_.take(
          executor_, pyramid_.colours, [](int) {},
          [&](int i, const Manifold& m) {
            Manifold& to = pyramid_.manifolds[static_cast<std::size_t>(i)];
            to.impulse = m.impulse;
            to.friction_impulse = m.friction_impulse;
            to.twist_impulse = m.twist_impulse;
          });
    });
    state.SetIterationTime((seconds_ - before) / (part_ >= Part::warm_start && part_ <= Part::velocity_pass ? 8 : 1));
  }
  std::int64_t manifolds() const { return static_cast<std::int64_t>(pyramid_.manifolds.size()); }

 private:
  template <class Work>
  void time(Part part, const Work& work) {
    const double start = seconds_of_thread();
    work();
    if (part == part_) seconds_ += seconds_of_thread() - start;
  }
  void substep() {
    for (BodyMotion& m : pyramid_.motions)
      if (m.inverse_mass > 0) m.velocity.y -= 9.81f * h;
    time(Part::warm_start, [&] { blocks_.warm_start(executor_, kernels_, pyramid_.motions); });
    time(Part::position_pass, [&] { blocks_.position_pass(executor_, kernels_, pyramid_.motions, h, {}); });
    for (BodyMotion& m : pyramid_.motions) {
      m.displacement += m.velocity * h;
      m.rotation += m.spin * h;
    }
    time(Part::velocity_pass, [&] { blocks_.velocity_pass(executor_, kernels_, pyramid_.motions, h); });
  }

  Part part_;
  const ManifoldKernels& kernels_;
  Executor executor_{1};
  Pyramid pyramid_ = make_pyramid();
  ManifoldBlocks blocks_;
  double seconds_ = 0;
};

void measure(benchmark::State& state, Part part, const std::string& isa) {
  try {
    Run run(part, isa);
    std::int64_t frames = 0;
    for (auto _ : state) {
      run.frame(state);
      ++frames;
    }
    state.SetItemsProcessed(frames * run.manifolds());
  } catch (const Error& error) {
    state.SkipWithError(error.what());
  }
}

void add(const std::string& name, Part part, const std::string& isa) {
  benchmark::RegisterBenchmark(("body_contacts/" + name + (isa.empty() ? "" : "/" + isa)).c_str(),
                               [part, isa](benchmark::State& state) { measure(state, part, isa); })
      ->UseManualTime();
}

#define PLIANT_LEVEL_NAME(suffix, isa, ...) isa,
const bool added = [] {
  add("colours", Part::colours, "");
  add("fill", Part::fill, "");
  add("take", Part::take, "");
  for (const char* isa : {PLIANT_FOR_EACH_COMPILED_LEVEL(PLIANT_LEVEL_NAME, ) "sequential"}) {
    add("prepare", Part::prepare, isa);
    add("warm_start", Part::warm_start, isa);
    add("position_pass", Part::position_pass, isa);
    add("velocity_pass", Part::velocity_pass, isa);
  }
  return true;
}();
#undef PLIANT_LEVEL_NAME

}  // namespace
}  // namespace pliant
