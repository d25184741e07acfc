// What the stages between steps ask of objects and their particles.
#pragma once

#include <cstddef>
#include <cstdint>

#include "model/model.h"

namespace pliant {

/// True if the masks of two objects let them meet.
inline bool masks_meet(const CompiledObject& a, const CompiledObject& b) {
  return (a.mask & b.groups) != 0 && (b.mask & a.groups) != 0;
}

/// The inverse mass that a particle of the State has while nothing holds it, and without what it has taken up [1/kg].
/// `number` is that of its object.
inline float own_inverse_mass(const Model& model, int number, std::int64_t particle) {
  const auto object = static_cast<std::size_t>(number);
  return model.objects[object].positions[static_cast<std::size_t>(particle - model.first[object])].w;
}

}  // namespace pliant
