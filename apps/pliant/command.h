// The subcommands of `pliant` as plain functions of plain options: main.cpp alone knows the command line.
//
// Every one returns the exit status (0: done; 1: done, and what was asked for is not as it should be, which it has said)
// and throws pliant::Error, or Interrupted, where it can't be done. Standard output is for results, standard error for the
// one line that says what went wrong and, on a terminal, for progress.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace pliant::command {

/// What run, render and whatever else simulates a scene let the caller change of the scene's own settings.
struct Overrides {
  std::optional<int> frames, threads, substeps, iterations;
  std::string sweep;                ///< as "chains" or "chains+tethers"; empty: the scene's own
  std::string isa;                  ///< empty: the best there is
  bool sequential = false;          ///< the plain reference sweep
  std::vector<std::string> meshes;  ///< "name=path": files for the meshes of objects and colliders
  std::string cache;                ///< folder where distance grids are kept; empty: nowhere
};

struct RunOptions {
  std::string scene;
  Overrides overrides;
  std::vector<std::string> out;  ///< geometry files; the suffix picks the format
  std::string report;            ///< JSON file, empty: none
  std::string checkpoint;        ///< file that the State is saved to every `every` frames and at the end, empty: none
  int every = 60;                ///< frames
  std::string resume;            ///< checkpoint to go on from, empty: none
  bool hash_frames = false;      ///< the state's hash of every frame in the report
  bool quiet = false;            ///< nothing on standard output, no progress
};

/// Simulates a scene.
int run(const RunOptions& options);

struct RenderOptions {
  std::string scene;
  Overrides overrides;                 ///< but `frames`
  std::optional<int> frame;            ///< of a picture, and the length of a movie; the scene's last unless told
  std::string out;                     ///< .png or .mp4
  std::string size = "1280x720";       ///< WxH in pixels
  float azimuth = 28, elevation = 18;  ///< where the camera stands [degrees]
  std::vector<int> strip;              ///< frames drawn side by side in one picture; empty: the last alone
  bool quiet = false;
};

/// Draws a scene after some frames, or all of them as a movie.
int render(const RenderOptions& options);

struct CheckOptions {
  std::string path;    ///< a scene (.json) or a mesh
  double seconds = 3;  ///< for trying a scene out, about; 0: it is not [s]
};

/// Says what is wrong or doubtful; 1 where something is wrong.
int check(const CheckOptions& options);

struct ValidateOptions {
  std::string group;    ///< empty: all
  bool slow = false;    ///< also what takes minutes
  std::string queries;  ///< folder of query sets for continuous tests, empty: none
  std::string json;     ///< file for the rows as JSON, empty: none; "-": standard output instead of the table
  std::string plot;     ///< PNG file for the curves, empty: none
};

/// Compares with known answers and prints a table; throws Error where a row fails.
int validate(const ValidateOptions& options);

struct BenchOptions {
  std::string workload;    ///< empty: all
  std::string against;     ///< "bullet", or empty
  std::vector<int> sizes;  ///< empty: 64, 128, 256, 512
  int frames = 120;        ///< measured, after 20 that are not
  double limit = 120;      ///< of W3: on the time of a row [s]
  int threads = 0;         ///< of the run beside that with one thread; 0: all
  std::string json;        ///< file for the rows as JSON, empty: none
};

/// Measures and prints a table.
int bench(const BenchOptions& options);

struct CompareOptions {
  std::string scene;
  Overrides overrides;              ///< `frames` and `threads` alone
  std::vector<std::string> sweeps;  ///< as "chains" or "tiled+chebyshev"; empty: all that the scene allows
  std::optional<int> frame;         ///< before the substep of the curves; half of the scene's unless told
  int substeps = 0;                 ///< a frame, of the curves' substep; 0: the scene's own
  int iterations = 100;             ///< the most of the curves
  double budget = 0;                ///< milliseconds a frame; 0: curves alone
  std::vector<std::string> out;     ///< a .png, a .json, or both
};

/// Shows how fast each sweep brings down the error of one substep of a scene, and what it reaches in a given time.
int compare(const CompareOptions& options);

/// Prints the JSON Schema of the scene format.
int schema();

/// Prints the version.
int version();

}  // namespace pliant::command
