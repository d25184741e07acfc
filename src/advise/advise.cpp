// Trial runs: simulates a scene with more and more expensive settings until its overstretch is tolerable.
//
// If the scene names a sweep, substeps or bounds of these, the default is tried first, and advised if it is good. If it
// is not, the search for other settings follows.
//
// A family is a sweep with or without tethers. First come sweeps that may do better than the scene's own, the most
// promising first, then the scene's own sweep. Each family doubles its substeps until it is good or too expensive; then
// good settings are tried with fewer substeps. A trial ends as soon as it is worse than the best before it, so most are
// short.
#include "pliant/advise.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "advise/far_pins.h"
#include "advise/passed_through.h"
#include "matter/advice_settings.h"
#include "model/object_sets.h"
#include "model/soft_body_substeps.h"
#include "model/woven_substeps.h"
#include "solver/substep_law.h"
#include "world/advice.h"

namespace pliant {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int most_doublings = 6;
constexpr int most_substeps = 10000;
/// Settings count as better if their excess is below this share of that with the scene's own settings.
constexpr double clearly_better = 0.8;
/// Share of the time that the trial of the scene's own settings may take; the rest is for the others.
constexpr double own_share = 0.3;

/// The largest number of substeps that the default chooses for a soft body or woven cloth; 0: the scene has none.
int default_substeps_of_soft_bodies(const Scene& scene) {
  Scene by_default = scene;
  by_default.settings = left_open(scene.settings);
  const std::vector<int> substeps = chosen_substeps(by_default);
  int most = 0;
  for (std::size_t o = 0; o < substeps.size(); ++o)
    if (is_soft_body(scene.objects[o]) || is_woven(scene.objects[o])) most = std::max(most, substeps[o]);
  return most;
}

/// The fewest substeps that are tried. Multigrid keeps lengths with any number, so overstretch alone would advise one.
/// But long substeps damp motion: cloth of 32 x 32 that swings down from two pins reaches 60 % of the kinetic energy of
/// 20 substeps with 1 substep, 85 % with 2, and 92 % with 4. Soft bodies and woven cloth become softer with fewer than
/// `of_soft_bodies`.
int least_substeps_of(const Settings& settings, int of_soft_bodies) {
  return std::max(of_soft_bodies, settings.sweep == Sweep::multigrid ? 4 : 1);
}

/// Frames between searches for objects that pass through one another.
constexpr int frames_between_looks = 4;

Clock::time_point after(double seconds) {
  const std::chrono::duration<double> limited(seconds > 0 ? std::min(seconds, 1e6)
                                                          : 0.0);  // within the range of the clock
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(limited);
}

/// Overstretch as a multiple of what is tolerable: of the 99th percentile or the maximum, whichever is more.
double excess(const Overstretch& found) {
  return std::max(found.p99 / tolerated_p99, found.largest / tolerated_overstretch);
}

void keep_worst(const Report& report, Trial& trial) {
  trial.worst = report.worst_overstretch.overstretch;
  trial.frame = report.worst_overstretch.frame_of_largest;
  if (!report.ok()) trial.worst.largest = trial.worst.p99 = std::numeric_limits<double>::infinity();
}

/// Settings under which tetrahedra end inside out are no advice, however long the edges are.
void refuse_inverted(const World& world, Trial& trial) {
  if (trial.complete && world.measure().tetrahedra().inverted > 0)
    trial.worst.largest = trial.worst.p99 = std::numeric_limits<double>::infinity();
}

/// Runs trials of a scene, with the data that they share.
class Trials {
 public:
  /// `open` is the scene with no sweeps of objects, for the trials of other settings.
  Trials(const Scene& scene, const Scene& open, const AdviseOptions& options)
      : scene_(scene),
        open_(open),
        frames_(std::max(1, std::min(options.frames, scene.frames))),
        end_(after(options.seconds)),
        own_end_(after(own_share * options.seconds)),
        stops_(options.stops) {}

  /// Tries the scene's own settings. If its time runs out, all later trials run only as many frames as this one. Its
  /// share of the time is limited only where something was found: else no other trial follows.
  Trial run_own(Advice& found) {
    Trial trial = run(scene_.settings, std::numeric_limits<double>::infinity(), &found);
    if (std::isfinite(trial.worst.largest)) frames_ = trial.frames;
    return trial;
  }

  /// Tries other settings until all frames are done, or the excess exceeds `bound` and 1.
  Trial run_other(const Settings& settings, double bound) const { return run(settings, bound, nullptr); }

  bool out_of_time() const { return is_over(end_); }
  int frames() const { return frames_; }

 private:
  static std::string in_words(const World& world, const Trial& trial, const Report& last) {
    return last.ok() ? "in frame " + std::to_string(trial.frame) + ", " + world.measure().describe(trial.worst)
                     : last.explain();
  }

  /// `found` receives what was found in the trial of the scene's own settings; null for other trials.
  Trial run(const Settings& settings, double bound, Advice* found) const {
    Trial trial;
    trial.settings = settings;
    World world(found != nullptr ? scene_ : open_, settings);
    Report last;
    WarningLog warnings;
    PassingObjects passing(scene_);
    bool goes_on = true;
    while (goes_on && trial.frames < frames_) {
      last = world.step(scene_.frame_time);
      ++trial.frames;
      warnings.add(last);
      trial.milliseconds += (last.milliseconds - trial.milliseconds) / trial.frames;
      keep_worst(last, trial);
      const bool is_looked_at =
          found != nullptr && last.ok() && (trial.frames % frames_between_looks == 0 || trial.frames == frames_);
      if (is_looked_at) passing.look(world, [&] { return is_over(end_); });
      // Without objects there are no lengths and no warnings. Other trials must show that they remain finite.
      const bool measurable = found == nullptr || !scene_.objects.empty();
      trial.worse = excess(trial.worst) > std::max(bound, 1.);
      const bool is_own = found != nullptr && !is_tolerable(trial.worst);
      goes_on = measurable && last.ok() && !trial.worse && !is_over(is_own ? own_end_ : end_);
      trial.complete = last.ok() && (trial.frames == frames_ || !measurable);
    }
    if (found != nullptr) tell(world, trial, last, warnings.lines(), passing, *found);
    if (found == nullptr) refuse_inverted(world, trial);
    return trial;
  }

  /// Adds to `found` what the trial of the scene's own settings showed.
  void tell(const World& world, const Trial& trial, const Report& last, const std::vector<std::string>& warnings,
            const PassingObjects& passing, Advice& found) const {
    if (!is_tolerable(trial.worst)) found.words = in_words(world, trial, last);
    if (!last.ok()) return;  // its words contain the warnings, and its positions mean nothing
    found.warnings = warnings;
    std::vector<std::string> said = warnings;
    if (!found.words.empty()) said.push_back(found.words);
    const std::vector<std::string> soft = unconverged(world, last.worst_estimates, said);
    found.warnings.insert(found.warnings.end(), soft.begin(), soft.end());
    const std::vector<std::string> passed = passed_through_themselves(scene_, world);
    found.warnings.insert(found.warnings.end(), passed.begin(), passed.end());
    if (const std::string warning = passing.warning(); !warning.empty()) found.warnings.push_back(warning);
  }

  bool is_over(Clock::time_point end) const { return Clock::now() >= end || (stops_ && stops_()); }

  const Scene &scene_, &open_;
  int frames_;
  Clock::time_point end_, own_end_;
  std::function<bool()> stops_;
};

/// Trials with the same sweep and tethers, and more and more substeps.
struct Family {
  Settings settings;  ///< settings for the next trial
  int least = 1;      ///< substeps that are tried
  bool open = true;   ///< true while it is not good, but may be with more substeps
  int good = -1;      ///< index of its last good trial; -1: none

  /// True if substeps follow the State, so that their lower bound is what is doubled.
  bool by_state() const { return settings.substeps == 0; }
  int number() const { return by_state() ? settings.least_substeps : settings.substeps; }
  void set(int number) {
    if (!by_state()) {
      settings.substeps = number;
      return;
    }
    number = (number + quarters - 1) / quarters * quarters;  // so that the bounds have a multiple of four between them
    settings.least_substeps = number;
    if (settings.most_substeps > 0) settings.most_substeps = std::max(settings.most_substeps, number);
  }
};

std::vector<Family> families_of(const Scene& scene) {
  Settings own = scene.settings;
  own.substeps = most_substeps_of(own);  // a number is needed, so that it can be doubled
  const bool may = may_tether(scene);
  const int of_soft_bodies = default_substeps_of_soft_bodies(scene);
  std::vector<Family> families;
  const auto add = [&](Settings settings) {
    const int least = least_substeps_of(settings, of_soft_bodies);
    settings.substeps = std::max(settings.substeps, least);
    families.push_back({settings, least});
  };
  for (Sweep alternative : better_sweeps(scene)) {
    Settings other = own;
    other.sweep = alternative;
    other.sweep_options.tethers = own.sweep_options.tethers || may;
    add(other);
  }
  if (may && !own.sweep_options.tethers) {
    Settings tethered = own;
    tethered.sweep_options.tethers = true;
    add(tethered);
  }
  const int least = 2 * std::max(least_by_state, scene.settings.least_substeps);
  if (scene.settings.substeps == 0 && least <= most_substeps) {
    families.push_back({scene.settings});
    families.back().set(least);
  }
  if (2 * own.substeps <= most_substeps) {
    own.substeps *= 2;
    add(own);
  }
  return families;
}

/// Runs as many trials as time allows, and keeps their results.
class Search {
 public:
  Search(const Scene& scene, const Trials& trials, Advice& advice)
      : trials_(trials), advice_(advice), families_(families_of(scene)) {}

  /// Tries the default settings. Returns true if they are good.
  bool try_default() {
    Family by_default{left_open(advice_.own.settings)};
    if (!has_time() || !try_out(by_default)) return false;
    advice_.best = by_default.good;
    return true;
  }

  void run() {
    for (int round = 0; round <= most_doublings; ++round)
      for (Family& family : families_) try_next(family);
    for (Family& family : families_) try_less(family);
    advice_.best = best_of(advice_);
  }

 private:
  double bound() const {
    double bound = excess(advice_.own.worst);
    for (const Trial& trial : advice_.others)
      if (trial.complete) bound = std::min(bound, excess(trial.worst));
    return bound;
  }

  /// True if time is left. Otherwise records that it ran out.
  bool has_time() {
    if (!trials_.out_of_time()) return true;
    advice_.cut_short = true;
    return false;
  }

  bool try_out(Family& family) {
    advice_.others.push_back(trials_.run_other(family.settings, bound()));
    const Trial& trial = advice_.others.back();
    if (!trial.complete && trials_.out_of_time()) advice_.cut_short = true;
    if (!is_good(trial)) return false;
    family.good = static_cast<int>(advice_.others.size()) - 1;
    return true;
  }

  /// Tries a family with its next substeps. Twice the substeps take about twice as long, so it stops at the cost of the
  /// best trial.
  void try_next(Family& family) {
    if (!family.open || !has_time()) return;
    const bool good = try_out(family);
    const int found = best_of(advice_);
    const bool dearer = found >= 0 && is_good(advice_.others[found]) &&
                        2 * advice_.others.back().milliseconds > advice_.others[found].milliseconds;
    family.open = !good && !dearer && 2 * family.number() <= most_substeps;
    if (family.open) family.set(2 * family.number());
  }

  /// Tries half of the good substeps while that is good too, then three quarters of the least good number.
  void try_less(Family& family) {
    if (family.good < 0 || family.by_state()) return;
    const bool was_doubled = family.settings.substeps > most_substeps_of(advice_.own.settings);
    while (!was_doubled && has_time() && halve(family)) {
    }
    Settings least = advice_.others[family.good].settings;
    least.substeps = 3 * least.substeps / 4;
    family.settings = least;
    if (least.substeps >= family.least && has_time()) try_out(family);
  }

  bool halve(Family& family) {
    family.settings.substeps = advice_.others[family.good].settings.substeps / 2;
    return family.settings.substeps >= family.least && try_out(family);
  }

  const Trials& trials_;
  Advice& advice_;
  std::vector<Family> families_;
};

}  // namespace

int best_of(const Advice& advice) {
  int best = -1;
  const Overstretch& own = advice.own.worst;
  double least = clearly_better * excess(own);
  const auto is_nearer = [&](const Trial& trial) {
    return excess(trial.worst) < least && trial.worst.p99 <= own.p99 && trial.worst.largest <= own.largest;
  };
  for (int i = 0; i < static_cast<int>(advice.others.size()); ++i) {
    const Trial &trial = advice.others[i], *before = best < 0 ? nullptr : &advice.others[best];
    if (!trial.complete) continue;
    const bool good = is_good(trial), was_good = before != nullptr && is_good(*before);
    const bool better =
        good && was_good ? trial.milliseconds < before->milliseconds : good || (!was_good && is_nearer(trial));
    if (!better) continue;
    best = i;
    least = excess(trial.worst);
  }
  return best;
}

bool is_good(const Trial& trial) { return trial.complete && is_tolerable(trial.worst); }

namespace {

/// Objects that name a sweep, such as "object 'flag' and 2 more".
std::string with_own_sweep(const Scene& scene) {
  const auto has_own = [](const Object& object) { return object.sweep != Sweep::automatic; };
  const auto first = std::find_if(scene.objects.begin(), scene.objects.end(), has_own);
  if (first == scene.objects.end()) return "";
  const auto more = std::count_if(first + 1, scene.objects.end(), has_own);
  return "object '" + first->name + "'" + (more > 0 ? " and " + std::to_string(more) + " more" : "");
}

}  // namespace

Advice advise(const Scene& given, const AdviseOptions& options) {
  Scene scene = given;
  scene.settings = chosen_settings(given);
  Scene open = scene;
  for (Object& object : open.objects) object.sweep = Sweep::automatic;
  Advice advice;
  Trials trials(scene, open, options);
  advice.frames = trials.frames();
  advice.own = trials.run_own(advice);
  advice.cut_short = !advice.own.complete && std::isfinite(advice.own.worst.largest);
  if (advice.words.empty()) return advice;
  advice.what_to_do = advice_for_far_pins(scene, advice.own);
  if (!advice.what_to_do.empty()) {
    advice.cut_short = false;  // more time would change nothing
    return advice;
  }
  Search search(open, trials, advice);
  const Departures departs{departures(scene, given.settings, scene.settings), with_own_sweep(scene)};
  const bool is_default = departs.settings.empty() && departs.objects.empty();
  if (is_default || !search.try_default()) search.run();
  advice.what_to_do = remedy(advice, departs);
  return advice;
}

}  // namespace pliant
