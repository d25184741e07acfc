// Trying a scene out: does its solve keep up, and if not, what is the cheapest setting that does?
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant {

/// What to try and how long.
struct AdviseOptions {
  double seconds = 3;             ///< of computing, about: the frame under way is finished [s]
  int frames = 120;               ///< tried at most, and never more than the scene has
  std::function<bool()> stops{};  ///< asked after every frame: true ends it as if its time were out
};

/// A setting, and what a run with it from the scene's start gave.
struct Trial {
  Settings settings;
  int frames = 0;           ///< that it was run for
  bool complete = false;    ///< all frames that were to be tried; false where it was given up as worse, or for lack of time
  bool worse = false;       ///< than the best before it, whether it was given up for that or got to its end
  double milliseconds = 0;  ///< a frame, the mean
  Overstretch worst;        ///< p99 and largest of any frame, and where the largest was
  std::int64_t frame = 0;   ///< in which the largest was, from 1
};

/// What came of it.
struct Advice {
  Trial own;                  ///< the scene as it is
  int frames = 0;             ///< that were to be tried; where `own` has fewer, all is about those alone
  std::vector<Trial> others;  ///< in the order of trying, where `own` is not good enough
  /// Of `others`: the cheapest that is good, else the nearest to it whose largest is clearly below that of `own` and whose p99 is
  /// not above; -1: there is none.
  int best = -1;
  bool cut_short = false;  ///< time ran out
  std::string words;  ///< the finding in a sentence; empty where nothing was found in `own.frames` frames: see cut_short
  std::string what_to_do;  ///< the advice that belongs to it
};

/// Whether no distance was longer than its force explains by more than tolerated_overstretch.
bool is_good(const Trial& trial);

/// Runs the scene, and where it is not good (see is_good) runs it again from the start with more substeps, tethers and the
/// sweeps that may do better on it. From the start, since a state that a poor setting has stretched would only show how a
/// better one mends it.
/// The bits of a trial do not depend on anything but its settings; how many trials there is time for does. Throws Error
/// where a World would.
Advice advise(const Scene& scene, const AdviseOptions& options = {});

}  // namespace pliant
