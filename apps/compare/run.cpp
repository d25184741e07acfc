// Makes all measurements in order.
#include <algorithm>
#include <cmath>

#include "apps/compare/compare.h"
#include "pliant/error.h"

namespace pliant::compare {

namespace {

constexpr int turns = 3;  // number of rounds in which all curves are timed

/// A World at the frame from which curves start, and the substeps of the frame before it; of the first frame if it is
/// at the start.
struct Start {
  World world;
  int substeps = 0;
};

/// Simulates the scene with its own settings up to the frame from which curves start.
Start run_to(const Scene& scene, int frames, const Options& options) {
  Settings settings = scene.settings;
  settings.measure = settings.record_residuals = settings.record_multipliers = false;
  Start start{World(scene, settings)};
  const State at_start = start.world.state();
  for (int frame = 0; frame < std::max(frames, 1); ++frame) {
    if (options.pause) options.pause();
    const Report report = start.world.step(scene.frame_time);
    if (!report.ok()) throw Error({}, report.explain());
    start.substeps = report.substeps;
  }
  if (frames == 0) start.world.restore(at_start);
  return start;
}

double mass_of(const Scene& scene) {
  double mass = 0;
  for (const Object& object : scene.objects)
    for (const float m : object.masses) mass += std::isfinite(m) ? static_cast<double>(m) : 0;
  return mass;
}

std::vector<Method> methods_of(const Scene& scene, const Options& options) {
  std::vector<Method> methods;
  std::vector<std::string> names = options.methods;
  std::erase(names, default_name);  // its curve would be that of its sweep
  for (const std::string& name : names.empty() ? default_methods(scene) : names) {
    const bool again = std::any_of(methods.begin(), methods.end(), [&](const Method& m) { return m.name == name; });
    if (again) throw Error({}, "'" + name + "' is named twice", "name every sweep once");
    methods.push_back(method_of(name, scene.settings.sweep_options));
  }
  return methods;
}

/// Sweep, substeps and iterations left open.
Scene left_open(Scene scene) {
  scene.settings.sweep = Sweep::automatic;
  scene.settings.substeps = 0;
  scene.settings.iterations = 1;
  return scene;
}

bool has_default(const Options& options) {
  const std::vector<std::string>& names = options.methods;
  return names.empty() || std::find(names.begin(), names.end(), default_name) != names.end();
}

std::string default_in_words(const Scene& scene) {
  const Settings settings = chosen_settings(left_open(scene));
  const bool has_one = settings.sweep != Sweep::automatic;
  return (has_one ? "the sweep '" + sweep_name(settings.sweep) + "'" : "a sweep for each object") + ", " +
         (settings.substeps > 0 ? std::to_string(settings.substeps) + " substeps" : "substeps that follow the State");
}

void add_default(const Scene& scene, const Options& options, Result& result) {
  if (!(options.budget > 0) || scene.frames < 1 || !has_default(options)) return;
  try {
    result.budgeted.push_back(run_default(left_open(scene), options));
  } catch (const Error& error) {
    result.refused.push_back({default_name, error.what()});
  }
}

std::string type_of(const std::vector<Curve>& curves) {
  const std::vector<Residual>& primal = curves.front().record.front().primal;
  for (const Residual& residual : primal)
    if (residual.type == "distance") return residual.type;
  return primal.empty() ? "none" : primal.front().type;
}

/// The substeps of the curves, where all objects have the same substep: the most of any object. Where they follow the
/// State, those that the scene had in the frame before.
int substeps_of_curves(const Scene& given, const Start& start) {
  const int named = chosen_settings(given).substeps;
  if (named > 0) return named;
  const std::vector<int> substeps = chosen_substeps(given);
  const bool follow = std::find(substeps.begin(), substeps.end(), 0) != substeps.end();
  return follow ? start.substeps : *std::max_element(substeps.begin(), substeps.end());
}

}  // namespace

Result run(const Scene& given, const Options& options) {
  Scene scene = given;
  scene.settings = chosen_settings(given);
  const std::vector<Method> methods = methods_of(scene, options);
  Result result;
  result.frame = options.frame < 0 ? scene.frames / 2 : options.frame;
  result.iterations = options.iterations;
  result.frames = scene.frames;
  result.budget = options.budget;
  result.by_default = default_in_words(given);
  Start start = run_to(scene, result.frame, options);
  result.speed = std::sqrt(2 * start.world.measure().kinetic_energy() / std::max(mass_of(scene), 1e-30));
  scene.settings.substeps = substeps_of_curves(given, start);
  result.substep = substep_of(scene, options);
  add_default(given, options, result);
  std::vector<Method> measured;
  for (const Method& method : methods) {
    if (options.pause) options.pause();
    try {
      result.curves.push_back(measure_curve(scene, start.world, method, options));
      measured.push_back(method);
      if (options.budget > 0 && scene.frames > 0) result.budgeted.push_back(fit_budget(scene, method, options));
    } catch (const Error& error) {
      result.refused.push_back({method.name, error.what()});
    }
  }
  for (int turn = 1; turn < turns; ++turn)
    for (std::size_t i = 0; i < measured.size(); ++i)
      time_again(scene, start.world, measured[i], options, result.curves[i]);
  if (result.curves.empty())
    throw Error({}, "every sweep was rejected, the first, " + result.refused.front().name + ": " +
                        result.refused.front().reason);
  result.residual_type = type_of(result.curves);
  return result;
}

}  // namespace pliant::compare
