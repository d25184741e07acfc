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
#include "apps/render/camera.h"

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
  std::string scene;         ///< or a .glb file
  Overrides overrides;       ///< `frames` is not used
  std::optional<int> frame;  ///< frame to draw, or length of a movie; default: the scene's last frame
  std::string out;           ///< file, .png or .mp4
  std::string size;          ///< WxH in pixels; empty: 1280x720, of a draft half of it
  SceneCamera camera;        ///< overrides that of the scene
  std::vector<int> strip;    ///< frames drawn side by side in one picture; empty: one frame
  std::string resume;        ///< checkpoint of the scene to draw, or from which to go on; empty: none
  bool draft = false;        ///< smaller, and of a movie some 15 pictures a second
  bool quiet = false;
};

/// Draws a scene after some frames, or a movie of all frames; or the frames of a .glb file.
int render(const RenderOptions& options);

struct StudyOptions {
  std::string scene;
  Overrides overrides;
  std::vector<std::string> vary;      ///< "pointer=a,b,c": the members of the scene to vary, and their values
  std::vector<std::string> measures;  ///< JSON pointers into the report of a run; each is a column of the table
  std::string out;                    ///< file for the table as CSV; rows that it has are kept
  std::string pictures;               ///< file (.png) for a picture of the last frame of each variant; empty: none
  int jobs = 0;                       ///< how many variants run side by side; 0: as many as there are hardware threads
  bool quiet = false;
};

/// Simulates a scene once for each combination of values. Returns 1 if a variant failed.
int study(const StudyOptions& options);

struct CheckOptions {
  std::string path;                 ///< a scene (.json) or a mesh file
  double seconds = 3;               ///< approximate time for trial runs [s]; 0: none
  std::vector<std::string> values;  ///< Overrides::values
};

/// Prints errors and warnings of a scene or mesh. Returns 1 if there are errors.
int check(const CheckOptions& options);

/// Prints the JSON Schema of the scene format.
int schema();

/// Prints the version.
int version();

}  // namespace pliant::command
