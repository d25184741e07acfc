// Rest data that change while a World runs: what keyframes and calls multiply, and what has flowed
// (model/changing_rest.h).
#pragma once

#include <map>
#include <vector>

#include "world/world_data.h"

namespace pliant {

/// Multiplies rest data by the factors of a time [s]: those that were set, else those of the keyframes.
void follow_rest_factors(WorldData& world, double time);

/// The present factor of a group's rest data; 1 if it has no keyframes.
float rest_factor_of(const WorldData& world, int object, int group);

/// Keeps what has flowed in the State.
void keep_flowed(WorldData& world);

/// Throws an Error unless a State has the factors and the flowed rest data of the World's objects.
void require_rest(const Model& model, const State& state);
/// Gives all constraints the rest data of the State.
void take_rest_of_state(WorldData& world);

/// True if rest data or pressures of an object may change in a step: then that changes its compiled form.
bool changes_in_substeps(const Model& model);

/// The rest data of a constraint at the start, and what flow has made of them.
struct FlowedData {
  std::vector<float> start, now;
};
/// Those of an object that have flowed, by type and slots (storage indices; frames after all particles).
using FlowedRest = std::map<std::vector<int>, FlowedData>;
FlowedRest flowed_rest(const CompiledObject& object);
/// Gives the plastic constraints of an edited object what those had that had their slots, unless the edit has changed
/// the rest data that flowed. `slot_before` is the slot of the object before it, or -1.
void carry_flowed(const FlowedRest& flowed, const std::vector<int>& slot_before, CompiledObject& object);

}  // namespace pliant
