// What the golden hashes are of: every scene of scenes/, and one scene by each sweep. Without GoogleTest, so that a plain program
// (tests/portable) can run them on machines for which nothing but the engine is built.
#pragma once

#include <string>
#include <vector>

#include "apps/validate/sweep_table.h"
#include "pliant/pliant.h"

namespace pliant::golden {

/// Names of the files of scenes/, in order.
std::vector<std::string> scene_names();
/// Names of sweeps in hashes.txt: "sweep_tiled".
std::vector<std::string> sweep_names();

/// One scene for all sweeps, small but for a cloth of two tiles, with whatever a sweep may meet: rigid and compliant lengths,
/// bending, a volume, a rope, moving pins and contacts.
Scene scene_of(const validate::SweepWay& way);

/// Long enough for what falls to land: the bits of a frame depend on all before it.
inline constexpr int scene_frames = 40;
inline constexpr int sweep_frames = 4;

/// A line of hashes.txt.
struct Case {
  std::string name;
  Scene scene;
  int frames;
};
std::vector<std::string> case_names();
Case make_case(const std::string& name);

}  // namespace pliant::golden
