// Trial runs of a scene: tests whether its solve is accurate, and finds the cheapest settings that make it so.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant {

/// Limits of the trials.
struct AdviseOptions {
  double seconds = 3;             ///< computing time, approximate: a frame that was begun is completed [s]
  int frames = 120;               ///< frames of a trial at most; never more than the scene has
  std::function<bool()> stops{};  ///< called after every frame; true ends the trials as if time were up
};

/// Settings, and the result of a run with them from the scene's start.
struct Trial {
  Settings settings;
  int frames = 0;           ///< frames completed
  bool complete = false;    ///< false if it was stopped as worse, or for lack of time
  bool worse = false;       ///< worse than the best trial before it
  double milliseconds = 0;  ///< mean of a frame
  Overstretch worst;        ///< overstretch: p99 and largest of any frame, and the place of the largest
  std::int64_t frame = 0;   ///< frame of the largest overstretch, from 1
};

/// The result of all trials.
struct Advice {
  Trial own;                  ///< the scene with its own settings
  int frames = 0;             ///< frames planned; if `own` completed fewer, the advice covers only those
  std::vector<Trial> others;  ///< further trials in order, if `own` is not good
  /// Index in `others` of the cheapest good trial; else of the one nearest to good whose largest overstretch is clearly below
  /// that of `own` and whose p99 is not above it; -1: none.
  int best = -1;
  bool cut_short = false;  ///< time ran out
  std::string words;       ///< the finding in one sentence; empty if there is none in `own.frames` frames
  std::string what_to_do;  ///< the advice for that finding
};

/// True if no overstretch exceeded tolerated_overstretch.
bool is_good(const Trial& trial);

/// Runs the scene. If it is not good (see is_good), runs it again with more substeps,
/// tethers and sweeps that may do better. Each trial starts from the scene's start,
/// because a stretched state would only show how a better setting repairs it.
/// The bits of a trial depend on its settings alone; the number of trials
/// depends on the machine's speed. Throws an Error where a World would.
Advice advise(const Scene& scene, const AdviseOptions& options = {});

}  // namespace pliant
