#include "model/model.h"

#include <utility>

namespace pliant {

void Model::add(CompiledObject object) {
  const int number = static_cast<int>(objects.size());
  if (first.empty()) first.push_back(0);
  first.push_back(first.back() + object.particles);
  for (int tile = 0; tile < static_cast<int>(object.tiles.size()); ++tile) tiles.push_back({number, tile});
  for (std::size_t colour = 0; colour < object.straddlers.size(); ++colour) {
    if (straddlers.size() <= colour) straddlers.emplace_back();
    StraddlerPhase& phase = straddlers[colour];
    for (int s = object.straddlers[colour].first_segment; s < object.straddlers[colour].last_segment; ++s) {
      phase.tasks.push_back({number, s});
      phase.batches += object.segments[s].batches;
    }
  }
  for (std::size_t colour = 0; colour < object.chain_colours.size(); ++colour) {
    if (chains.size() <= colour) chains.emplace_back();
    for (int b = object.chain_colours[colour].first_batch; b < object.chain_colours[colour].last_batch; ++b) {
      chains[colour].tasks.push_back({number, b});
      chains[colour].steps += object.chains[b].steps;
    }
  }
  objects.push_back(std::move(object));
}

State initial_state(const Model& model) {
  State state;
  state.positions.reserve(model.particles());
  for (const CompiledObject& object : model.objects) {
    state.positions.insert(state.positions.end(), object.positions.begin(), object.positions.end());
    state.velocities.insert(state.velocities.end(), object.velocities.begin(), object.velocities.end());
  }
  state.remainders.resize(state.positions.size());
  return state;
}

}  // namespace pliant
