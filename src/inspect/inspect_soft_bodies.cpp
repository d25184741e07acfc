// Soft bodies whose numbers are probably in another unit, and those that their substeps leave softer than their modulus
// says.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "inspect/inspect_scene.h"
#include "inspect/problems.h"
#include "matter/advice_settings.h"
#include "model/soft_body_substeps.h"

namespace pliant {

namespace {

/// A soft body that yields far more than its modulus says.
struct TooSoft {
  const Object* object = nullptr;
  std::string problem, advice;  ///< "are 20, so few that ..."
};

/// How many times as much a body yields as with enough substeps, in substeps that are `longer` times as long as those.
/// `damping`: its time over a substep. Fitted to bars in tension and bent, of a Poisson's ratio of 0.3 to 0.49, with up
/// to seven times too few (docs/internals/solids.md). With more iterations than one the compliance is not lowered
/// (solver/project.h).
double yield_over_right_one(double longer, double damping, int iterations) {
  constexpr double slope = 0.09, harmless = 1.2, slope_of_more = 0.1;
  // As h^2 max(1, time / h): linear in h where a body is damped by more than a substep does it.
  const double error = longer * longer * std::max(1., damping) / std::max(1., damping * longer);
  if (iterations > 1) return 1 + slope_of_more * error / iterations;
  return 1 + slope * std::max(error - harmless, 0.);
}

TooSoft words_of_too_soft(const Object& object, int substeps, double needed, double times, bool are_named) {
  const std::string wanted = std::to_string(std::llround(std::ceil(std::min(needed, 1e9))));
  const std::string yields = "'" + object.name + "' will yield about " + words(std::round(10 * times) / 10) +
                             " times as much as its modulus says";
  if (!are_named && substeps >= most_soft_substeps)
    return {&object, "are " + std::to_string(substeps) + ", the most by default, so that " + yields,
            "give \"substeps\": " + wanted + ", or use larger tetrahedra, a smaller modulus or a rigid body"};
  return {&object, "are " + std::to_string(substeps) + ", so few that " + yields,
          are_named ? "give " + wanted + (needed > most_soft_substeps ? "" : ", or leave substeps out")
                    : "it needs " + wanted +
                          ": use larger tetrahedra, a smaller modulus or a rigid body, and no PBD "
                          "stiffness in what it meets"};
}

std::vector<TooSoft> find_too_soft(const Scene& scene, const Settings& settings) {
  constexpr double tolerated = 1.1;
  std::vector<TooSoft> found;
  if (std::none_of(scene.objects.begin(), scene.objects.end(), is_soft_body)) return found;
  const std::vector<int> all = chosen_substeps(scene, settings);
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    if (!is_soft_body(scene.objects[o]) || all[o] <= 0)
      continue;  // 0: they follow the State, and are as many as it needs
    const double needed = needed_substeps_of_soft_body(scene.objects[o], static_cast<double>(scene.frame_time));
    const double damping = numbers_of_soft_body(scene.objects[o], scene.gravity).damping_time * all[o] /
                           static_cast<double>(scene.frame_time);
    const double times = yield_over_right_one(needed / all[o], damping, settings.iterations);
    if (times <= tolerated) continue;
    found.push_back(words_of_too_soft(scene.objects[o], all[o], needed, times, settings.substeps > 0));
  }
  return found;
}

}  // namespace

/// Says which soft bodies have numbers that are probably in another unit.
void doubt_soft_bodies(Problems& problems, const Scene& scene) {
  constexpr double most_strain = 1, most_damping = 0.1;  // [-], [s]
  for (const Object& object : scene.objects) {
    if (!is_soft_body(object)) continue;
    const SoftBodyNumbers found = numbers_of_soft_body(object, scene.gravity);
    problems.at(object.name);
    if (object.restitution > 0)
      problems.doubtful("restitution",
                        "hardly acts: a soft body rebounds by its elasticity, and stops its vertices one by one",
                        "leave it out; the damping of the material makes a body rebound less");
    if (found.strain_by_weight > most_strain)
      problems.doubtful("material, youngs_modulus",
                        "is so low that the weight of the body presses its lowest layer to nothing: strain " +
                            words(std::round(10 * found.strain_by_weight) / 10),
                        "Young's modulus is in Pa, lengths are in metres, densities in kg/m^3");
    if (found.damping_time > most_damping)
      problems.doubtful("material, damping", "is " + words(found.damping_time) + " s: the body resists like tar",
                        "it is a time, 0.002 s of gelatine; that of the object is a rate in 1/s");
  }
  problems.at("");
}

void doubt_substeps_of_soft_bodies(Problems& problems, const Scene& scene) {
  for (const TooSoft& one : find_too_soft(scene, scene.settings))
    problems.doubtful("settings, substeps", one.problem, one.advice);
}

std::vector<std::string> warnings_of_soft_bodies(const Scene& scene, const Settings& settings) {
  std::vector<std::string> warnings;
  for (const TooSoft& one : find_too_soft(scene, settings))
    warnings.push_back("settings, substeps " + one.problem + "; " + one.advice);
  return warnings;
}

}  // namespace pliant
