// Adds and removes one of 1000 small objects of a running World.
#include <benchmark/benchmark.h>

#include <vector>

#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant {
namespace {

constexpr int count = 1000;
constexpr float dt = 1e-4f;  // nothing moves far: the substeps themselves cost little

/// A cloth of 36 particles in a place of its own.
Object small_sheet(int number, bool collides) {
  Object sheet = make_cloth(grid_mesh(6, 6, 0.1f, 0.1f));
  for (Vec3f& p : sheet.positions)
    p += {0.2f * static_cast<float>(number % 10), 0.2f * static_cast<float>(number / 100),
          0.2f * static_cast<float>(number / 10 % 10)};
  sheet.collides = collides;
  return sheet;
}

World many_sheets(bool collide) {
  Scene scene;
  scene.settings.sweep = Sweep::tiled;
  scene.settings.substeps = 1;
  scene.settings.threads = 1;
  for (int i = 0; i < count; ++i) scene.add(small_sheet(i, collide));
  return World(scene);
}

/// The two calls alone, as a World takes them between steps.
void add_and_remove(benchmark::State& loop) {
  const bool collide = loop.range(0) != 0;
  World world = many_sheets(collide);
  const Object sheet = small_sheet(500, collide);
  ObjectId id(500);
  for (auto _ : loop) {
    world.remove(id);
    id = world.add(sheet);
  }
}

/// With the step that follows, which rebuilds surface contact where objects may collide; compare with `step`.
void add_remove_and_step(benchmark::State& loop) {
  const bool collide = loop.range(0) != 0;
  World world = many_sheets(collide);
  const Object sheet = small_sheet(500, collide);
  ObjectId id(500);
  for (auto _ : loop) {
    world.remove(id);
    id = world.add(sheet);
    world.step(dt);
  }
}

void step(benchmark::State& loop) {
  World world = many_sheets(loop.range(0) != 0);
  for (auto _ : loop) world.step(dt);
}

BENCHMARK(add_and_remove)->ArgName("collide")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond)->UseRealTime();
BENCHMARK(add_remove_and_step)->ArgName("collide")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond)->UseRealTime();
BENCHMARK(step)->ArgName("collide")->Arg(0)->Arg(1)->Unit(benchmark::kMicrosecond)->UseRealTime();

}  // namespace
}  // namespace pliant
