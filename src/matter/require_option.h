// Checks of the numbers that describe particles.
#pragma once

#include <cmath>
#include <string>

#include "pliant/error.h"

namespace pliant {

/// Throws an Error, which names the object and the element, unless the value is finite and `is_good`. `what` is what to
/// give instead.
inline void require_option(bool is_good, const std::string& name, const char* element, float value, const char* what) {
  if (!is_good || !std::isfinite(value))
    throw Error({.object = name, .element = element}, "is " + std::to_string(value), std::string("give a ") + what);
}

}  // namespace pliant
