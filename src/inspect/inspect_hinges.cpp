// Hinges that one sweep a substep leaves too soft: those of a sheet with short edges that does not bend as a whole.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "inspect/inspect_scene.h"
#include "inspect/problems.h"
#include "matter/advice_settings.h"
#include "model/sheet_bending.h"
#include "model/sheet_choice.h"

namespace pliant {

namespace {

/// Hinges that bend too far by more than this share are told; the advice is for `wanted_excess`.
constexpr double tolerated_excess = 0.25, wanted_excess = 0.05;
/// By what share hinges bend too far, of h^2 B / (rho e^4) (excess_of_hinges).
constexpr double error_of_hinges = 2.3;
/// The substeps of an object whose substeps follow the State, as compile() assumes for those that do not.
constexpr int substeps_by_state = 20;

/// Two digits, or more in front of the point: "1.3", "240".
std::string digits_of_bend(double value) {
  char text[32];
  std::snprintf(text, sizeof text, value < 100 ? "%.2g" : "%.0f", value);
  return text;
}

struct SoftHinges {
  const Object* object = nullptr;
  std::string problem, advice;
};

SoftHinges words_of_hinges(const Object& object, double excess, int substeps) {
  const double factor = std::sqrt(excess / wanted_excess), needed = std::ceil(factor * substeps);
  const std::string first = needed > most_substeps_of_frame
                                ? "give it less bending stiffness"
                                : "use " + std::to_string(std::llround(needed)) + " substeps";
  return {&object,
          "its hinges bend about " + digits_of_bend(1 + excess) + " times as far as their stiffness says, with " +
              std::to_string(substeps) + " substeps a frame",
          first + ", or edges " + digits_of_bend(std::sqrt(factor)) +
              " times as long; a flat rest shape without plasticity needs neither"};
}

std::vector<SoftHinges> find_soft_hinges(const Scene& scene, const Settings& settings) {
  std::vector<SoftHinges> found;
  const std::vector<int> substeps_of = chosen_substeps(scene, settings);
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    if (object.volume) continue;
    const int substeps = substeps_of[o] > 0 ? substeps_of[o] : substeps_by_state;
    const double h = static_cast<double>(scene.frame_time) /
                     (substeps * std::sqrt(static_cast<double>(std::max(1, settings.iterations))));
    const double gravity = std::sqrt(static_cast<double>(length_squared(scene.gravity)));
    const double excess = has_long_edges(object, gravity) ? error_of_hinges * h * h * facts_of_sheet(object).stiffness
                                                          : excess_of_hinges(object, h);
    if (excess > tolerated_excess) found.push_back(words_of_hinges(object, excess, substeps));
  }
  return found;
}

}  // namespace

void doubt_substeps_of_hinges(Problems& problems, const Scene& scene) {
  for (const SoftHinges& found : find_soft_hinges(scene, scene.settings)) {
    problems.at(found.object->name);
    problems.doubtful("", found.problem, found.advice);
  }
  problems.at("");
}

std::vector<std::string> warnings_of_hinges(const Scene& scene, const Settings& settings) {
  std::vector<std::string> warnings;
  for (const SoftHinges& found : find_soft_hinges(scene, settings))
    warnings.push_back("object '" + found.object->name + "': " + found.problem + "; " + found.advice);
  return warnings;
}

}  // namespace pliant
