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
  std::string problem{}, advice{};
};

/// The substeps with which a sheet that is too stiff for floats in its substeps bends as a whole; 0: it never does.
double substeps_to_bend_as_sheet(const Object& object, const Scene& scene, double share) {
  const auto frame_time = static_cast<double>(scene.frame_time) * share;
  const double needed =
      std::ceil(frame_time * std::sqrt(facts_of_sheet(object).stiffness / most_stiffness_of_sheets) + 1e-6);
  const bool would =
      needed + 1 <= most_substeps_of_frame && bends_as_sheet(object, frame_time / std::max(needed + 1, 1.));
  return would ? needed + 1 : 0;
}

/// What hinges do, and what helps. `as_sheet`: substeps_to_bend_as_sheet; `keeps_energy`: they are hinges because of
/// the integrator alone.
SoftHinges words_of_hinges(const Object& object, double excess, int substeps, double as_sheet, bool keeps_energy) {
  const double factor = std::sqrt(excess / wanted_excess), needed = std::ceil(factor * substeps);
  const std::string few = std::to_string(std::llround(needed)) + " substeps";
  const std::string cause = keeps_energy ? "bends by hinges, since the integrator is \"energy\": " : "";
  SoftHinges out{&object, cause + "its hinges bend about " + digits_of_bend(1 + excess) +
                              " times as far as their stiffness says, with " + std::to_string(substeps) +
                              " substeps a frame"};
  if (keeps_energy) {
    out.problem += ", and by up to 1.5 times more on coarse meshes";
    const std::string more = excess <= tolerated_excess || needed > most_substeps_of_frame ? "" : ", or " + few;
    out.advice = "use the integrator \"pbd\", by which the sheet bends as a whole" + more;
  } else if (as_sheet > 0) {
    out.advice = "use " + std::to_string(std::llround(as_sheet)) +
                 " substeps, with which it bends as a whole and as far as its stiffness says";
  } else {
    out.advice = (needed > most_substeps_of_frame ? "give it less bending stiffness" : "use " + few) + ", or edges " +
                 digits_of_bend(std::sqrt(factor)) +
                 " times as long; a flat rest shape without plasticity needs neither";
  }
  return out;
}

std::vector<SoftHinges> find_soft_hinges(const Scene& scene, const Settings& settings) {
  std::vector<SoftHinges> found;
  const std::vector<int> substeps_of = chosen_substeps(scene, settings);
  const double gravity = std::sqrt(static_cast<double>(length_squared(scene.gravity)));
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const Object& object = scene.objects[o];
    if (object.volume) continue;
    const int substeps = substeps_of[o] > 0 ? substeps_of[o] : substeps_by_state;
    const double share = 1 / std::sqrt(static_cast<double>(std::max(1, settings.iterations)));
    const double h = static_cast<double>(scene.frame_time) / substeps * share;
    const bool is_coarse = has_long_edges(object, gravity);
    const bool keeps_energy =
        settings.integrator == Settings::Integrator::energy && !is_coarse && bends_as_sheet(object, h);
    const double excess = is_coarse || keeps_energy ? error_of_hinges * h * h * facts_of_sheet(object).stiffness
                                                    : excess_of_hinges(object, h);
    if (excess > (keeps_energy ? 0 : tolerated_excess))
      found.push_back(words_of_hinges(object, excess, substeps,
                                      is_coarse ? 0 : substeps_to_bend_as_sheet(object, scene, share), keeps_energy));
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
