// The scenes whose hashes are golden: every scene in scenes/, and one scene for each sweep. It does not use GoogleTest,
// so that a plain program (tests/portable) can run them on machines for which only the engine is built.
#pragma once

#include <string>
#include <vector>

#include "apps/validate/sweep_table.h"
#include "pliant/pliant.h"

namespace pliant::golden {

/// The names of the files in scenes/, in alphabetical order.
std::vector<std::string> scene_names();
/// The names of sweeps in hashes.txt, such as "sweep_tiled".
std::vector<std::string> sweep_names();

/// The scene that every sweep solves. It is small but for a cloth of two tiles, and has everything that a sweep may
/// meet: rigid and compliant distances, bending, a volume, a rope, moving pins and contacts.
Scene scene_of(const validate::SweepWay& way);

/// Number of frames; what falls has landed then. The bits of a frame depend on all frames before it.
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
