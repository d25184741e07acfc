// Measures how long a running World of 1000 small objects takes to add and remove one.
#include <benchmark/benchmark.h>

#include <vector>

#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant {
namespace {

constexpr int count = 1000;
constexpr float dt = 1e-4f;  // so short that nothing moves far, and substeps cost little

/// A cloth of 36 particles at a place of its own. `contact`: 0 none, 1 with other sheets, 2 also with itself.
Object small_sheet(int number, int contact) {
  Object sheet = make_cloth(grid_mesh(6, 6, 0.1f, 0.1f));
  for (Vec3f& p : sheet.positions)
    p += {0.2f * static_cast<float>(number % 10), 0.2f * static_cast<float>(number / 100),
          0.2f * static_cast<float>(number / 10 % 10)};
  sheet.collides = contact > 0;
  sheet.self_collision = contact > 1;
  return sheet;
}

World many_sheets(int contact) {
  Scene scene;
  scene.settings.sweep = Sweep::tiled;
  scene.settings.substeps = 1;
  scene.settings.threads = 1;
  for (int i = 0; i < count; ++i) scene.add(small_sheet(i, contact));
  return World(scene);
}

/// Measures the two calls alone.
void add_and_remove(benchmark::State& loop) {
  const int contact = static_cast<int>(loop.range(0));
  World world = many_sheets(contact);
  const Object sheet = small_sheet(500, contact);
  ObjectId id(500);
  for (auto _ : loop) {
    world.remove(id);
    id = world.add(sheet);
  }
}

/// Measures the calls with the step that follows, which updates contact between surfaces; compare with `step`.
void add_remove_and_step(benchmark::State& loop) {
  const int contact = static_cast<int>(loop.range(0));
  World world = many_sheets(contact);
  const Object sheet = small_sheet(500, contact);
  ObjectId id(500);
  for (auto _ : loop) {
    world.remove(id);
    id = world.add(sheet);
    world.step(dt);
  }
}

void step(benchmark::State& loop) {
  World world = many_sheets(static_cast<int>(loop.range(0)));
  for (auto _ : loop) world.step(dt);
}

BENCHMARK(add_and_remove)->ArgName("contact")->DenseRange(0, 2)->Unit(benchmark::kMicrosecond)->UseRealTime();
BENCHMARK(add_remove_and_step)->ArgName("contact")->DenseRange(0, 2)->Unit(benchmark::kMicrosecond)->UseRealTime();
BENCHMARK(step)->ArgName("contact")->DenseRange(0, 2)->Unit(benchmark::kMicrosecond)->UseRealTime();

}  // namespace
}  // namespace pliant
