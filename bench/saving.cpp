// Measures how long it takes to hash, save and load the State of a million particles, 48 MB, in a temporary folder.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <filesystem>
#include <string>

#include "pliant/save.h"

namespace pliant {
namespace {

constexpr std::size_t particles = 1000000;

State large_state() {
  State state;
  state.positions.resize(particles);
  for (std::size_t i = 0; i < particles; ++i) {
    const float x = static_cast<float>(i) * 1e-3f;
    state.positions[i] = {x, 1 - x, x * x, 1};
  }
  state.velocities = state.remainders = Records(particles);
  return state;
}

std::string path() { return (std::filesystem::temp_directory_path() / "pliant_bench_state").string(); }

void hash_state(benchmark::State& loop) {
  const State state = large_state();
  for (auto _ : loop) benchmark::DoNotOptimize(hash(state));
}

void save_state(benchmark::State& loop) {
  const State state = large_state();
  for (auto _ : loop) save(path(), state);
  std::remove(path().c_str());
}

void load_saved_state(benchmark::State& loop) {
  save(path(), large_state());
  for (auto _ : loop) benchmark::DoNotOptimize(load_state(path()));
  std::remove(path().c_str());
}

BENCHMARK(hash_state)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(save_state)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(load_saved_state)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace pliant
