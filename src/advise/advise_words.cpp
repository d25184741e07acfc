// Puts the result of the trials into words.
#include <algorithm>
#include <cmath>
#include <utility>

#include "matter/advice_settings.h"
#include "world/advice.h"

namespace pliant {

namespace {

/// True if the trial leaves sweep, substeps and their bounds open.
bool is_default(const Trial& trial) {
  const Settings& of = trial.settings;
  return of.sweep == Sweep::automatic && of.substeps == 0 && of.least_substeps == 0 && of.most_substeps == 0;
}

/// Describes the settings of a trial: "40 substeps", or "20 substeps of the sweep 'chains' with tethers".
std::string setting_in_words(const Trial& trial, const Settings& own) {
  if (is_default(trial)) return "the default";
  const bool by_state = trial.settings.substeps == 0;
  const int substeps = by_state ? trial.settings.least_substeps : trial.settings.substeps;
  std::string text =
      (by_state ? "at least " : "") + std::to_string(substeps) + (substeps == 1 ? " substep" : " substeps");
  if (trial.settings.sweep != own.sweep) text += " of the sweep '" + sweep_name(trial.settings.sweep) + "'";
  if (trial.settings.sweep_options.tethers && !own.sweep_options.tethers) text += " with tethers";
  return text;
}

std::string cost_in_words(const Trial& trial) { return two_digits(trial.milliseconds) + " ms a frame"; }

/// The index of the cheapest good trial whose sweep or tethers differ from those of the best; -1: none.
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

/// True if the trial of the scene's own settings ran through all planned frames, or until a value was not finite.
/// Otherwise its result says nothing about later frames.
bool knows_all(const Advice& advice) { return advice.own.complete || !std::isfinite(advice.own.worst.largest); }

std::string json_of_best(const Advice& advice, const Departures& departs) {
  const Trial& best = advice.others[advice.best];
  const std::string lead = knows_all(advice) ? "" : "to try it, ";
  const std::string of_objects = departs.objects.empty() ? "" : "remove \"sweep\" from " + departs.objects;
  const std::string both = of_objects.empty() ? "" : " and " + of_objects;
  if (is_default(best) && departs.settings.empty()) return lead + of_objects;
  if (is_default(best)) return lead + "remove " + departs.settings + " from the scene's \"settings\"" + both;
  return lead + "add to the scene's \"settings\": " + in_json(best.settings, advice.own.settings) + both;
}

/// True if a trial measured lengths, which it does in each complete frame.
bool has_lengths(const Advice& advice) {
  const auto measured = [](const Trial& trial) { return trial.worst.constraints > 0; };
  return measured(advice.own) || std::any_of(advice.others.begin(), advice.others.end(), measured);
}

/// What a good trial does, after "keep" or "keeps".
std::string tolerance_in_words(const Advice& advice) {
  if (!has_lengths(advice)) return " all values finite and no tetrahedron inside out";
  return " all edges within " + percent(tolerated_overstretch) + " and 99 in 100 within " + percent(tolerated_p99) +
         " of the length that their force explains";
}

/// The number of trials that time did not cut short, so that their result is known.
int judged(const Advice& advice) {
  const auto is_judged = [](const Trial& trial) { return trial.complete || trial.worse; };
  return static_cast<int>(std::count_if(advice.others.begin(), advice.others.end(), is_judged));
}

/// The advice if no settings are good: those that come nearest.
std::string of_the_nearest(const Advice& advice, const Departures& departs) {
  const std::string in_time = advice.cut_short ? " within the time limit" : "";
  if (judged(advice) == 0) return "no other setting was tried" + in_time;
  const int count = judged(advice);
  const std::string tried = std::to_string(count) + " other setting" + (count == 1 ? "" : "s") + " tried" + in_time;
  if (advice.best < 0 && !has_lengths(advice))
    return "of " + tried + " none keeps" + tolerance_in_words(advice) +
           ": pins or colliders may force this, or it needs even more substeps";
  if (advice.best < 0)
    return "of " + tried +
           " none is clearly better: pins or colliders may force this stretch, or it needs even more substeps";
  const Trial& best = advice.others[advice.best];
  return "of " + tried + " none keeps" + tolerance_in_words(advice) + "; the best of them, " +
         setting_and_cost(advice, advice.best) + ", leaves at most " + percent(best.worst.largest) +
         ", and 1 edge in 100 " + percent(best.worst.p99) + " or more; the present settings take " +
         cost_in_words(advice.own) + "; " + json_of_best(advice, departs);
}

/// The advice if some settings are good: the cheapest, and the cheapest of another family.
std::string of_the_good(const Advice& advice, const Departures& departs) {
  const int other = runner_up(advice);
  const bool one = other < 0 && advice.others[advice.best].settings.substeps == 1;
  const std::string keep = one || (other < 0 && is_default(advice.others[advice.best])) ? " keeps" : " keep";
  return setting_and_cost(advice, advice.best) + (other < 0 ? "" : " or " + setting_and_cost(advice, other)) + keep +
         tolerance_in_words(advice) + "; the present settings take " + cost_in_words(advice.own) +
         (advice.cut_short ? "; there was no time to search for cheaper ones" : "") +
         (other < 0 ? "; " : "; for the first, ") + json_of_best(advice, departs);
}

}  // namespace

std::string remedy(const Advice& advice, const Departures& departs) {
  const int ran = advice.own.frames;
  const std::string first = ran == 1 ? "first" : "first " + std::to_string(ran);
  const std::string part = "only the " + first + " of " + std::to_string(advice.frames) +
                           " frames were run within the time limit: the following holds for " +
                           (ran == 1 ? "that one" : "those") + ", and later ones may be worse, with any settings; ";
  const bool good = advice.best >= 0 && is_good(advice.others[advice.best]);
  return (knows_all(advice) ? "" : part) + (good ? of_the_good(advice, departs) : of_the_nearest(advice, departs));
}

}  // namespace pliant
