// How the particles of a compiled object come and go.
#pragma once

#include "model/compiled_object.h"

namespace pliant {

/// Fills what the object's Flow gives; after its particles are numbered.
void compile_flow(const Object& object, CompiledObject& out);

/// True if a particle, by its place in storage order, is not there at the start.
inline bool is_spare(const CompiledObject& object, int storage) {
  const int user = object.order[static_cast<std::size_t>(storage)];
  return user < object.user_particles && user >= object.user_particles - object.flow.spare;
}

}  // namespace pliant
