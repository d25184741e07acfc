// Trial runs of a scene: they test whether its solve is accurate, and find the cheapest settings that make it so.
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant {

/// Collects the warnings of several frames: of each kind the first one, with its frame ("frame 3: ..."). Warnings that
/// differ only in numbers outside quoted names are of one kind.
class WarningLog {
 public:
  void add(const Report& report);
  const std::vector<std::string>& lines() const { return lines_; }

 private:
  /// Texts of warnings that have occurred, without those numbers.
  std::set<std::string> kinds_;
  std::vector<std::string> lines_;
};

/// A line for each kind of resistance that was not converged in its worst frame (is_tolerable): the object, by how
/// much, and the substeps that should mend it. Density is left out, and so are objects of which a line of `said` tells
/// that they yield too far.
std::vector<std::string> unconverged(const World& world, const WorstEstimates& worst,
                                     const std::vector<std::string>& said);

/// Limits of the trial runs.
struct AdviseOptions {
  double seconds = 3;             ///< approximate limit of computing time [s]: a frame that was begun is completed
  int frames = 120;               ///< largest number of frames of a trial; the scene's own number if that is smaller
  std::function<bool()> stops{};  ///< called after every frame; if it returns true, trials end as if time were up
};

/// Settings, and the result of a trial run with them. Of other settings than the scene's own, `worst` is infinite if
/// tetrahedra are inside out at the end.
struct Trial {
  Settings settings;
  int frames = 0;           ///< number of frames that the trial completed
  bool complete = false;    ///< false if it ended early: worse than another trial, or out of time
  bool worse = false;       ///< true if it ended early because another trial was better
  double milliseconds = 0;  ///< mean computing time of a frame [ms]
  Overstretch worst;        ///< largest 99th percentile of any frame; largest overstretch, and where it was
  std::int64_t frame = 0;   ///< number of the frame with the largest overstretch; the first frame is 1
};

/// The result of all trials.
struct Advice {
  Trial own;       ///< trial with the scene's own settings
  int frames = 0;  ///< frames planned; if `own` completed fewer, the advice covers only those
  /// Further trials in the order in which they ran; none if `own` is good, or if pins are farther apart than the object
  /// between them is long, so that no settings help.
  std::vector<Trial> others;
  /// Index in `others` of the advised settings: the default (Settings{}) if the scene names others and it is good; else
  /// the cheapest good trial; if none is good, the best one that is clearly better than `own`; -1: none.
  int best = -1;
  bool cut_short = false;  ///< true if time ran out before all trials were done
  /// Warnings of the frames of `own`, of each kind the first (WarningLog). One more for each object without
  /// self-collision whose triangles pass through one another at the end of `own`, and did not at the start; and one if
  /// two objects that may meet by groups and masks, but do not both have `collides`, pass through each other in one of
  /// the frames.
  std::vector<std::string> warnings;
  std::string words;       ///< what is wrong, in one sentence; empty if nothing was found in `own.frames` frames
  std::string what_to_do;  ///< what to do about the overstretch
};

/// True if a trial was complete and its overstretch never exceeded what is tolerable (is_tolerable).
bool is_good(const Trial& trial);

/// Runs the scene with its own settings. If the result is not good (is_good), runs it with the default sweep and
/// substeps; if the scene has these or they are not good either, with more substeps, tethers, and other sweeps. Each
/// trial starts at the scene's start, because a stretched state would only show how other settings repair it. The bits
/// of a trial depend on its settings alone; how many trials there are depends on the machine's speed. Throws an Error
/// for scenes that a World rejects.
Advice advise(const Scene& scene, const AdviseOptions& options = {});

}  // namespace pliant
