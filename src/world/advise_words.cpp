// What trials came to, in words.
#include <cstdio>
#include <utility>

#include "world/advice.h"
#include "world/advice_settings.h"

namespace pliant {

namespace {

/// "40 substeps", "20 substeps of the sweep 'chains' with tethers".
std::string setting_in_words(const Trial& trial, const Settings& own) {
  std::string text = std::to_string(trial.settings.substeps) + (trial.settings.substeps == 1 ? " substep" : " substeps");
  if (trial.settings.sweep != own.sweep) text += " of the sweep '" + name_of(trial.settings.sweep) + "'";
  if (trial.settings.sweep_options.tethers && !own.sweep_options.tethers) text += " with tethers";
  return text;
}

std::string cost_in_words(const Trial& trial) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g ms a frame", trial.milliseconds);
  return text;
}

/// The cheapest good trial of another kind than the best, or -1.
int runner_up(const Advice& advice) {
  const auto kind = [](const Trial& t) { return std::make_pair(t.settings.sweep, t.settings.sweep_options.tethers); };
  int found = -1;
  for (int i = 0; i < static_cast<int>(advice.others.size()); ++i) {
    const Trial& trial = advice.others[i];
    if (!is_good(trial) || kind(trial) == kind(advice.others[advice.best])) continue;
    if (found < 0 || trial.milliseconds < advice.others[found].milliseconds) found = i;
  }
  return found;
}

std::string setting_and_cost(const Advice& advice, int trial) {
  const Trial& of = advice.others[trial];
  return setting_in_words(of, advice.own.settings) + " (" + cost_in_words(of) + ")";
}

std::string remedy_in_words(const Advice& advice) {
  const std::string tried = advice.cut_short ? " in the time there was" : "";
  if (advice.best < 0) {
    if (advice.others.empty()) return "no other setting could be tried" + tried;
    return "none of " + std::to_string(advice.others.size()) + " other settings tried" + tried +
           " brings it down: what holds it or pushes it may leave it no other way, or it needs more substeps still";
  }
  const Trial& best = advice.others[advice.best];
  const std::string setting = setting_and_cost(advice, advice.best), before = cost_in_words(advice.own);
  const std::string settings = "add to the scene's \"settings\": " + in_json(best.settings, advice.own.settings);
  if (!is_good(best)) {
    return "the best found" + tried + ", " + setting + ", brings it to " + percent(best.worst.largest) +
           ", 1 edge in 100 to " + percent(best.worst.p99) + "; as it is it takes " + before + "; " + settings;
  }
  const int other = runner_up(advice);
  const std::string alternative = other < 0 ? "" : " or " + setting_and_cost(advice, other);
  return setting + alternative + (other < 0 && best.settings.substeps == 1 ? " brings" : " bring") + " it under " +
         percent(tolerated_overstretch) + "; as it is it takes " + before +
         (advice.cut_short ? "; there was no time to look for cheaper ones" : "") +
         (other < 0 ? "; " : "; for the first ") + settings;
}

}  // namespace

std::string remedy(const Advice& advice) {
  // A verdict on the first frames says nothing of the others.
  const bool knows_all = advice.own.complete || !advice.cut_short;
  const std::string frames = advice.own.frames == 1 ? "frame" : std::to_string(advice.own.frames) + " frames";
  return (knows_all ? ""
                    : "only its first " + frames + " could be run in the time there was and later ones may be worse; ") +
         remedy_in_words(advice);
}

}  // namespace pliant
