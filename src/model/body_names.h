// Names of rigid bodies.
#pragma once

#include <string>

#include "pliant/body.h"

namespace pliant {

/// True if a body's name is its own: neither empty, nor the default, nor that of the body for which joints to the world
/// stand.
inline bool has_own_name(const std::string& name) {
  static const std::string by_default = BodyOptions{}.name;
  return !name.empty() && name != by_default && name != "world";
}

}  // namespace pliant
