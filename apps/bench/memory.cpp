#include "apps/bench/memory.h"

#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <utility>

#include "apps/bench/cloth.h"
#include "pliant/error.h"
#include "pliant/world.h"

namespace pliant::bench {

namespace {

/// A number of /proc/self/status [bytes]: `name` is for example "VmHWM", whose line is "VmHWM:   123 kB"; 0 if there is
/// none.
double resident(const std::string& name) {
  std::ifstream status("/proc/self/status");
  std::string key;
  for (double kilobytes = 0; status >> key; status.ignore(1 << 20, '\n'))
    if (key == name + ":" && status >> kilobytes) return kilobytes * 1024;
  return 0;
}

Scene scene_of(int size, Sweep sweep) {
  ClothOptions cotton;
  cotton.material = fabric("cotton");
  Scene scene;
  scene.settings.sweep = sweep;
  scene.settings.threads = 1;
  scene.add(make_cloth(grid_mesh(size, size, 1, 1), cotton));
  scene.pin(0, {0, size - 1});
  return scene;
}

void step_twice(World& world) {
  for (int frame = 0; frame < 2; ++frame) world.step(1.f / 60);
}

MemoryRow measure_here(int size, Sweep sweep, bool is_given_away) {
  World small(scene_of(4, sweep));
  step_twice(small);  // loads code and starts threads, whose memory is not that of a cloth
  const double before = resident("VmRSS"), particles = static_cast<double>(size) * size;
  const auto now = [&](const std::string& name) { return (resident(name) - before) / particles; };
  MemoryRow row{size, sweep};
  Scene scene = scene_of(size, sweep);
  row.scene = now("VmRSS");
  row.scene_peak = now("VmHWM");
  World world = is_given_away ? World(std::move(scene)) : World(scene);
  step_twice(world);
  row.world = now("VmRSS") - (is_given_away ? 0 : row.scene);
  (is_given_away ? row.peak_given_away : row.peak) = now("VmHWM");
  return row;
}

/// Calls measure_here() in a process of its own, so that the high-water mark is that of what it makes.
template <class Row, class Measure>
Row measure_apart(const Measure& measure_here) {
  int ends[2];
  if (pipe(ends) != 0) throw Error({}, "cannot start a process in which to measure memory");
  const pid_t child = fork();
  if (child == 0) {
    const Row row = measure_here();
    const bool is_written = write(ends[1], &row, sizeof row) == static_cast<ssize_t>(sizeof row);
    _exit(is_written ? 0 : 1);
  }
  close(ends[1]);
  Row row{};
  const bool is_read = child > 0 && read(ends[0], &row, sizeof row) == static_cast<ssize_t>(sizeof row);
  close(ends[0]);
  int status = 0;
  if (child > 0) waitpid(child, &status, 0);
  if (!is_read) throw Error({}, "the measuring process did not finish", "try a smaller size");
  return row;
}

MemoryRow measure(int size, Sweep sweep, bool is_given_away) {
  return measure_apart<MemoryRow>([&] { return measure_here(size, sweep, is_given_away); });
}

}  // namespace

double measure_bytes(const std::function<Scene()>& small, const std::function<Scene()>& scene) {
  return measure_apart<double>([&] {
    World first(small());
    step_twice(first);  // loads code, as above
    const double before = resident("VmRSS");
    World world(scene());
    step_twice(world);
    return resident("VmRSS") - before;
  });
}

std::vector<MemoryRow> measure_memory(const MemoryOptions& options) {
  if (resident("VmHWM") == 0)
    throw Error({}, "this system does not report the memory of a process", "measure on Linux");
  std::vector<MemoryRow> rows;
  for (const int size : options.sizes) {
    if (size < 2 || size > 4096)
      throw Error({}, "a cloth of " + std::to_string(size) + " vertices per side cannot be measured",
                  "choose a size in 2..4096");
    for (const Sweep sweep : options.sweeps) {
      rows.push_back(measure(size, sweep, false));
      rows.back().peak_given_away = measure(size, sweep, true).peak_given_away;
      if (options.on_row) options.on_row(rows.back());
    }
  }
  return rows;
}

}  // namespace pliant::bench
