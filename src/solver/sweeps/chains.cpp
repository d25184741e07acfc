#include "solver/sweeps/chains.h"

#include <algorithm>

namespace pliant {

void ChainScratch::prepare(const SweepSetup& setup, int object) {
  std::size_t room = 0;
  for (const ChainBatch& batch : setup.model.objects[object].chains)
    room = std::max(room, static_cast<std::size_t>(batch.steps) * chain_scratch_floats);
  of_thread.resize(setup.threads);
  for (auto& scratch : of_thread) scratch.resize(std::max(scratch.size(), room));
}

}  // namespace pliant
