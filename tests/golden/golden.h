// Reads and writes the file of golden hashes, and runs a scene to get its hash.
#pragma once

#include <cstdlib>
#include <fstream>
#include <map>
#include <string>

#include "pliant/pliant.h"
#include "support/paths.h"

namespace pliant::golden {

inline const std::string hash_file = test::in_tree("tests/golden/hashes.txt");

/// True if the environment has PLIANT_UPDATE_GOLDEN=1, which rewrites hashes.txt.
inline bool updating() { return std::getenv("PLIANT_UPDATE_GOLDEN") != nullptr; }

inline std::map<std::string, std::string> read_hashes() {
  std::map<std::string, std::string> hashes;
  std::ifstream file(hash_file);
  std::string name, hash;
  while (file >> name >> hash) hashes[name] = hash;
  return hashes;
}

/// The hash of the State after `frames` frames, or the reason why there is none.
inline std::string run(const Scene& scene, const Settings& settings, int frames) {
  World world(scene, settings);
  for (int frame = 0; frame < frames; ++frame) {
    const Report report = world.step(scene.frame_time);
    if (!report.ok()) return report.explain();
  }
  return world.state_hash();
}

/// The hash of the sweeps' scene for each variant in apps/validate/sweep_table.h.
std::map<std::string, std::string> sweep_hashes();

}  // namespace pliant::golden
