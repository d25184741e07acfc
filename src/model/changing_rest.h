// Rest data that change while a World runs: those of plastic constraints, and those that keyframes or calls multiply.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "model/pool.h"
#include "pliant/scene.h"

namespace pliant {

struct CompiledObject;

/// The constraints of a pool that are plastic.
struct PlasticPool {
  int pool = 0;                    ///< index in CompiledObject::pools
  std::vector<Plasticity> kinds;   ///< those of the groups in it
  std::vector<std::int32_t> kind;  ///< for each lane of each batch: index in `kinds`; -1: it is elastic, or padding
  std::vector<float> start;        ///< rest data at the start, field by field for each lane
};

/// A group of constraints whose rest data a factor multiplies.
struct ScaledGroup {
  struct Place {
    int pool = 0;
    std::int64_t batch = 0;
    int lane = 0;
  };
  int group = 0;  ///< index in Object::constraints
  std::vector<RestKeyframe> keyframes;
  std::vector<Place> places;
  std::vector<float> rest;  ///< rest field 0 of each at a factor of 1
  float now = 1;            ///< the factor that the constraints have at present

  /// The factor of its keyframes at a time [s].
  float factor_at(double time) const;
};

/// The groups of an object whose rest data change, before its constraints are moved out of it: each with its type, and
/// which constraints of that type it holds.
struct ChangingGroup {
  int group = 0, type = 0;
  std::int64_t first = 0, last = 0;  ///< half-open
  std::optional<Plasticity> plasticity;
  std::vector<RestKeyframe> keyframes;
};
std::vector<ChangingGroup> find_changing_groups(const Object& object);

struct ChangingRest {
  std::vector<PlasticPool> plastic;
  std::vector<ScaledGroup> scaled;
};

/// Finds the constraints of these groups in the pools of an object that is compiled.
ChangingRest compile_changing_rest(const std::vector<ChangingGroup>& groups, const CompiledObject& object);

/// True if the particles of an object without frames are free, and joined by its constraints, so that these cannot turn
/// or move it.
bool is_one_free_piece(const CompiledObject& object);

/// The factor of a group of the object number `object` at a time [s]: the one that was set in the State, else that of
/// its keyframes.
float factor_of(const ScaledGroup& group, const State& state, int object, double time);

/// Multiplies the rest data of a group by a factor. False if they had it.
bool set_factor(CompiledObject& object, ScaledGroup& group, float factor);

/// Lets the rest data and the pressure of an object follow their keyframes to a time [s] within a frame.
void follow_keyframes(CompiledObject& object, const State& state, int number, double time);

/// The present rest data of all plastic constraints of an object, in the order of its pools, then the stretch of its
/// plastic clusters.
void append_flowed(const CompiledObject& object, std::vector<float>& flowed);
/// How many numbers that are.
std::int64_t flowed_size(const CompiledObject& object);
/// Gives the plastic constraints of an object these rest data, and returns the first number that is not one of them.
const float* take_flowed(CompiledObject& object, const float* flowed);
/// Gives them those of the start.
void forget_flow(CompiledObject& object);

}  // namespace pliant
