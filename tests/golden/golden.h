// The file of hashes, and the run that a hash is of.
#pragma once

#include <cstdlib>
#include <fstream>
#include <map>
#include <string>

#include "pliant/pliant.h"

namespace pliant::golden {

inline const char* const hash_file = PLIANT_SOURCE_DIR "/tests/golden/hashes.txt";

/// PLIANT_UPDATE_GOLDEN=1 rewrites hashes.txt.
inline bool updating() { return std::getenv("PLIANT_UPDATE_GOLDEN") != nullptr; }

/// PLIANT_THOROUGH=1 runs everything three times, in case threads give the same bits only mostly.
inline int repetitions() { return std::getenv("PLIANT_THOROUGH") != nullptr ? 3 : 1; }

inline std::map<std::string, std::string> read_hashes() {
  std::map<std::string, std::string> hashes;
  std::ifstream file(hash_file);
  std::string name, hash;
  while (file >> name >> hash) hashes[name] = hash;
  return hashes;
}

/// The hash after `frames`, or why there is none.
inline std::string run(const Scene& scene, const Settings& settings, int frames) {
  World world(scene, settings);
  for (int frame = 0; frame < frames; ++frame) {
    const Report report = world.step(scene.frame_time);
    if (!report.ok()) return report.explain();
  }
  return world.state_hash();
}

/// The hash of each way of apps/validate/sweep_table.h over the scene of the sweeps.
std::map<std::string, std::string> sweep_hashes();

}  // namespace pliant::golden
