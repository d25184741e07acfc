// The subcommands of `pliant` as functions of plain options; only main.cpp parses the command line.
//
// Each returns the exit status: 0 done; 1 done, with a negative result that it has
// printed. Each throws pliant::Error, or Interrupted, if it fails. Standard output is for
// results, standard error for a one-line error message and, on a terminal, for progress.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace pliant::command {

/// Changes to a scene's settings for run, render and other commands that simulate.
struct Overrides {
  std::optional<int> frames, threads, substeps, iterations;
  std::string sweep;                ///< name of a sweep with options, "chains+tethers"; empty: the scene's own
  std::string isa;                  ///< empty: the best available
  bool sequential = false;          ///< the scalar reference sweep
  std::vector<std::string> meshes;  ///< "name=path": mesh files for objects and colliders
  std::string cache;                ///< folder for cached distance grids; empty: none
};

struct RunOptions {
  std::string scene;
  Overrides overrides;
  std::vector<std::string> out;  ///< geometry files; the suffix selects the format
  std::string report;            ///< JSON file, empty: none
  std::string checkpoint;        ///< file for the State, saved every `every` frames and at the end; empty: none
  int every = 60;                ///< frames
  std::string resume;            ///< checkpoint to resume from, empty: none
  bool hash_frames = false;      ///< hash the State of every frame in the report
  bool quiet = false;            ///< no standard output, no progress
};

/// Simulates a scene.
int run(const RunOptions& options);

struct RenderOptions {
  std::string scene;
  Overrides overrides;                 ///< all except `frames`
  std::optional<int> frame;            ///< frame of a picture, or length of a movie; default: the scene's last
  std::string out;                     ///< .png or .mp4
  std::string size = "1280x720";       ///< WxH in pixels
  float azimuth = 28, elevation = 18;  ///< camera direction [degrees]
  std::vector<int> strip;              ///< frames side by side in one picture; empty: the last alone
  bool quiet = false;
};

/// Draws a scene after some frames, or a movie of all frames.
int render(const RenderOptions& options);

struct CheckOptions {
  std::string path;    ///< a scene (.json) or a mesh
  double seconds = 3;  ///< approximate time for trial runs; 0: none [s]
};

/// Prints errors and warnings; returns 1 if there are errors.
int check(const CheckOptions& options);

struct ValidateOptions {
  std::string group;    ///< empty: all
  bool slow = false;    ///< include rows that take minutes
  std::string queries;  ///< folder of query sets for continuous collision tests, empty: none
  std::string json;     ///< file for the rows as JSON, empty: none; "-": standard output instead of the table
  std::string plot;     ///< PNG file for the curves, empty: none
};

/// Compares with known answers and prints a table; throws an Error if a row fails.
int validate(const ValidateOptions& options);

struct BenchOptions {
  std::string workload;    ///< empty: all
  std::string against;     ///< "bullet", or empty
  std::vector<int> sizes;  ///< empty: 64, 128, 256, 512
  int frames = 120;        ///< measured, after 20 unmeasured ones
  double limit = 120;      ///< time limit of a row of W3 [s]
  int threads = 0;         ///< threads of the second run; the first run has one; 0: all
  std::string json;        ///< file for the rows as JSON, empty: none
};

/// Measures and prints a table.
int bench(const BenchOptions& options);

struct CompareOptions {
  std::string scene;
  Overrides overrides;              ///< only `frames` and `threads` are used
  std::vector<std::string> sweeps;  ///< names such as "tiled+chebyshev"; empty: all that the scene permits
  std::optional<int> frame;         ///< frames before the curves' substep; default: half of the scene's
  int substeps = 0;                 ///< substeps per frame, for the curves' substep; 0: the scene's own
  int iterations = 100;             ///< maximum of the curves
  double budget = 0;                ///< milliseconds per frame; 0: curves only
  std::vector<std::string> out;     ///< a .png, a .json, or both
};

/// Shows how fast each sweep reduces the error of one substep, and its result within a time budget.
int compare(const CompareOptions& options);

/// Prints the JSON Schema of the scene format.
int schema();

/// Prints the version.
int version();

}  // namespace pliant::command
