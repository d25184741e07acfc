// The overstretch, energy and cost of scene files under their own and other settings (`pliant bench default`).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pliant/report.h"
#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant::bench {

/// A scene, with the name under which the table lists it.
struct NamedScene {
  std::string name;
  Scene scene;
  /// What has moved over what should have, at rest [-]; empty: not known.
  std::function<double(const World&)> yield{};
};

/// Figures of one scene under one setting, over all frames of a run.
struct SceneRow {
  std::string scene, settings;  ///< "default", "own", or a sweep and its substeps such as "chains 40"
  int particles = 0, frames = 0;
  double p99 = 0, largest = 0;  ///< the worst overstretch of any frame [-]
  int frame_of_p99 = 0, frame_of_largest = 0;
  double gain = 0;               ///< most by which kinetic + gravitational energy rises above an earlier minimum [J/kg]
  double gain_with_bending = 0;  ///< the same of kinetic + gravitational + bending energy, which a rebound leaves alone
  double moved = 0;              ///< mean displacement of a particle in each of the last 30 frames [m]
  double milliseconds = 0;       ///< mean per frame
  double substeps = 0;           ///< mean per frame
  double yield = 0;              ///< NamedScene::yield at the end; 0: not known
  int crossings = -1;  ///< most edges that pass through a triangle in any frame, by exact signs; -1: not counted
  bool finite = true;  ///< false: the run ended at a non-finite value
  /// Of the default's row: the cheapest setting of a sweep and substeps whose row holds the bounds, empty if none does,
  /// and the cost of the default as a multiple of its cost.
  std::string cheapest{};
  double ratio = 0;
};

struct SceneTableOptions {
  /// Settings besides the default: those of the file ("own"), or a sweep and optionally its substeps ("multigrid 6").
  std::vector<std::string> against{"chains 20", "chains 40", "tethered_chains 10", "multigrid 6", "tiled 20"};
  int frames = 0;  ///< 0: those of the scene
  int threads = 1;
  bool counts_crossings = false;                ///< true: fills SceneRow::crossings
  std::function<void(const SceneRow&)> on_row;  ///< called when all rows of a scene are known
};

/// True if no frame exceeded the bounds of the default, and no surfaces crossed as far as that was counted.
bool holds(const SceneRow& row);

/// Throws an Error for the first of them that is not understood (SceneTableOptions::against).
void refuse_unknown_settings(const std::vector<std::string>& settings);

/// Sets `cheapest` and `ratio` of the first of a scene's rows, which is the default's.
void compare_costs(std::vector<SceneRow>& rows);

/// Throws an Error if a scene cannot be simulated or a setting is not understood.
std::vector<SceneRow> measure_scenes(const std::vector<NamedScene>& scenes, const SceneTableOptions& options);

std::string to_json(const std::vector<SceneRow>& rows);

}  // namespace pliant::bench
