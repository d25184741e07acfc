// The subcommands of `pliant-measure` as functions of plain options, as apps/pliant/command.h has those of `pliant`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/command_line/overrides.h"

namespace pliant::command {

struct ValidateOptions {
  std::string group;    ///< name of a group of rows; empty: all
  bool slow = false;    ///< true: also rows that take minutes
  std::string queries;  ///< folder of query sets for continuous collision tests; empty: none
  std::string json;     ///< file for the rows as JSON; "-": standard output instead of the table; empty: none
  std::string plot;     ///< PNG file for the charts; empty: none
};

/// Compares results with known answers, and prints a table. Throws an Error if a row fails.
int validate(const ValidateOptions& options);

struct BenchOptions {
  std::string workload;    ///< name of a workload; empty: all
  std::string against;     ///< "bullet" to measure it too; empty: not
  std::vector<int> sizes;  ///< numbers of vertices along a side; empty: 64, 128, 256, 512
  /// Frames measured, after 20 that are not (not of `default`); none: 120, or those of a scene.
  std::optional<int> frames;
  double limit = 120;  ///< time limit of a row of W3 [s]
  int threads = 0;     ///< threads of the second run; the first one uses one; 0: all hardware threads
  std::string json;    ///< file for the rows as JSON; empty: none
  std::vector<std::string> scenes, settings;  ///< of workload `default`: scene files, and settings beside the default
  std::string meshes;  ///< of workload `default`: a folder of meshes, over each of which a sheet falls; empty: none
};

/// Measures workloads, and prints a table.
int bench(const BenchOptions& options);

struct CompareOptions {
  std::string scene;
  Overrides overrides;              ///< only `frames` and `threads` are used
  std::vector<std::string> sweeps;  ///< names such as "tiled+chebyshev"; empty: all that suit the scene
  std::optional<int> frame;         ///< frames before the substep that is compared; default: half of the scene's
  int substeps = 0;                 ///< substeps per frame, which set the length of that substep; 0: the scene's own
  int iterations = 100;             ///< largest number of iterations
  double budget = 0;                ///< time per frame [ms]; 0: measure only the curves
  std::vector<std::string> out;     ///< files for the results: a .png, a .json, or both
};

/// Shows how fast each sweep reduces the residual of one substep, and the stretch that it reaches in a given time per
/// frame.
int compare(const CompareOptions& options);

}  // namespace pliant::command
