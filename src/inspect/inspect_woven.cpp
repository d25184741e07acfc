// Woven cloth whose triangles yield more than their stiffness says, because it has too few substeps for its mesh.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "inspect/inspect_scene.h"
#include "inspect/problems.h"
#include "matter/advice_settings.h"
#include "model/woven_substeps.h"
#include "solver/substep_law.h"

namespace pliant {

namespace {

/// A yield of triangles beyond this, over what their stiffness says, is told.
constexpr double tolerated_yield = 1.1;

struct SoftWoven {
  const Object* object = nullptr;
  std::string problem, advice;
};

/// True if a substep projects each constraint once in Gauss-Seidel's way, as solver/substep.cpp asks.
bool leads(Sweep sweep, const Settings& settings) {
  const bool is_other = sweep == Sweep::jacobi || sweep == Sweep::symmetric || sweep == Sweep::multigrid;
  return !is_other && settings.iterations == 1 && settings.sweep_options.relaxation == 1;
}

/// The number of substeps that the settings give each object; the least, where they follow the State.
std::vector<int> substeps_of_all(const Scene& scene, const Settings& settings) {
  std::vector<int> all = chosen_substeps(scene, settings);
  for (int& substeps : all)
    if (substeps <= 0) substeps = std::max(least_by_state, settings.least_substeps);
  return all;
}

std::string advice_for(const Object& object, double frame_time, bool is_led, const WovenYield& yield) {
  const std::string needed =
      std::to_string(std::llround(std::min(std::ceil(needed_substeps_of_woven(object, frame_time, is_led)), 1e9)));
  const std::string mesh = yield.is_of_yarns ? ", larger triangles, or edges along the yarns" : ", or larger triangles";
  return "give " + needed + " substeps" + mesh;
}

std::vector<SoftWoven> find_soft_woven(const Scene& scene, const Settings& settings) {
  std::vector<SoftWoven> all;
  if (std::none_of(scene.objects.begin(), scene.objects.end(), is_woven)) return all;
  const auto frame_time = static_cast<double>(scene.frame_time);
  const std::vector<int> substeps_of = substeps_of_all(scene, settings);
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    if (!is_woven(object)) continue;
    const int substeps = substeps_of[o];
    const bool is_led = leads(object.sweep == Sweep::automatic ? settings.sweep : object.sweep, settings);
    const WovenYield yield =
        yield_of_woven(object, frame_time, {static_cast<double>(substeps), settings.iterations, is_led});
    if (yield.ratio <= tolerated_yield) continue;
    all.push_back({&object,
                   "is woven so finely that with " + std::to_string(substeps) + " substeps " +
                       (yield.is_of_yarns ? "yarns that no edge lies along" : "it") +
                       (yield.is_of_yarns ? " stretch about " : " shears about ") +
                       words(std::round(10 * yield.ratio) / 10) + " times as much as their stiffness says, " +
                       words(std::round(1000 * yield.strain) / 10) + " % of strain too much under its weight",
                   advice_for(object, frame_time, is_led, yield)});
  }
  return all;
}

}  // namespace

void doubt_substeps_of_woven(Problems& problems, const Scene& scene) {
  for (const SoftWoven& found : find_soft_woven(scene, scene.settings)) {
    problems.at(found.object->name);
    problems.doubtful("", found.problem, found.advice);
  }
  problems.at("");
}

std::vector<std::string> warnings_of_woven(const Scene& scene, const Settings& settings) {
  std::vector<std::string> warnings;
  for (const SoftWoven& found : find_soft_woven(scene, settings))
    warnings.push_back("object '" + found.object->name + "' " + found.problem + "; " + found.advice);
  return warnings;
}

}  // namespace pliant
