// The subcommands of `pliant` as functions of plain options. Only main.cpp parses the command line.
//
// Each returns the exit status: 0 done; 1 done, with a negative result that it has printed. If it fails, it throws
// pliant::Error or Interrupted. Standard output is for results, standard error for a one-line error and, on a terminal,
// for progress.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/command_line/overrides.h"

namespace pliant::command {

struct RunOptions {
  std::string scene;
  Overrides overrides;
  std::vector<std::string> out;  ///< files for the geometry of each frame; the suffix selects the format
  bool liquid_surfaces = false;  ///< true: these have the surfaces of liquids instead of their particles
  std::string report;            ///< file for the report as JSON; empty: none
  std::string gauges;            ///< file for the readings of the scene's gauges as CSV; empty: none
  std::string checkpoint;        ///< file for the State, saved every `every` frames and at the end; empty: none
  int every = 60;                ///< frames between checkpoints
  std::string resume;            ///< checkpoint from which to continue; empty: none
  bool hash_frames = false;      ///< true: the report has a hash of the State after each frame
  bool quiet = false;            ///< no output but errors
};

/// Simulates a scene.
int run(const RunOptions& options);

struct RenderOptions {
  std::string scene;
  Overrides overrides;                 ///< `frames` is not used
  std::optional<int> frame;            ///< frame to draw, or length of a movie; default: the scene's last frame
  std::string out;                     ///< file, .png or .mp4
  std::string size = "1280x720";       ///< WxH in pixels
  float azimuth = 28, elevation = 18;  ///< camera direction [degrees]
  std::vector<int> strip;              ///< frames drawn side by side in one picture; empty: one frame
  bool quiet = false;
};

/// Draws a scene after some frames, or a movie of all frames.
int render(const RenderOptions& options);

struct CheckOptions {
  std::string path;    ///< a scene (.json) or a mesh file
  double seconds = 3;  ///< approximate time for trial runs [s]; 0: none
};

/// Prints errors and warnings of a scene or mesh. Returns 1 if there are errors.
int check(const CheckOptions& options);

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
  std::string workload;       ///< name of a workload; empty: all
  std::string against;        ///< "bullet" to measure it too; empty: not
  std::vector<int> sizes;     ///< numbers of vertices along a side; empty: 64, 128, 256, 512
  std::optional<int> frames;  ///< frames measured, after 20 that are not (not of `default`); none: 120, or those of a scene
  double limit = 120;         ///< time limit of a row of W3 [s]
  int threads = 0;            ///< threads of the second run; the first one uses one; 0: all hardware threads
  std::string json;           ///< file for the rows as JSON; empty: none
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

/// Prints the JSON Schema of the scene format.
int schema();

/// Prints the version.
int version();

}  // namespace pliant::command
