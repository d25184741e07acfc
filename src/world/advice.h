// What an overstretched distance looks like in words.
#pragma once

#include <string>

#include "model/compiled_object.h"
#include "pliant/world.h"

namespace pliant {

/// "14 %", "0.8 %": two digits.
std::string percent(double share);

/// "object 'sheet': stretched 14 % too far at its pins (edge 12-13), 1 edge in 100 by 3 % or more".
std::string words_of(const Overstretch& found, const CompiledObject& object);

}  // namespace pliant
