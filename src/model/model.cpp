#include "model/model.h"

#include <utility>

namespace pliant {

namespace {

void append_colours(const CompiledObject& object, int number, const std::vector<InterTileColour>& colours,
                    std::vector<InterTilePhase>& phases) {
  for (std::size_t colour = 0; colour < colours.size(); ++colour) {
    if (phases.size() <= colour) phases.emplace_back();
    InterTilePhase& phase = phases[colour];
    for (int s = colours[colour].first_segment; s < colours[colour].last_segment; ++s) {
      phase.tasks.push_back({number, s});
      phase.batches += object.segments[s].batches;
    }
  }
}

void append(const Records& from, Records& to) { to.insert(to.end(), from.begin(), from.end()); }

}  // namespace

void Model::add(CompiledObject object) {
  const int number = static_cast<int>(objects.size());
  if (first.empty()) first.push_back(0);
  if (first_frame.empty()) first_frame.push_back(0);
  first.push_back(first.back() + object.particles);
  first_frame.push_back(first_frame.back() + static_cast<int>(object.frames.size()));
  for (int tile = 0; tile < static_cast<int>(object.tiles.size()); ++tile) tiles.push_back({number, tile});
  append_colours(object, number, object.inter_tile, inter_tile);
  append_colours(object, number, object.stencil_colours, stencils);
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
    state.velocities.resize(state.positions.size());
    append(object.frames.orientations, state.frames.orientations);
    append(object.frames.angular_velocities, state.frames.angular_velocities);
    append(object.frames.inverse_inertias, state.frames.inverse_inertias);
  }
  state.remainders.resize(state.positions.size());
  return state;
}

}  // namespace pliant
