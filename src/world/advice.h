// What an overstretched distance looks like, and what to do about it, in words.
#pragma once

#include <string>

#include "model/compiled_object.h"
#include "pliant/advise.h"
#include "pliant/world.h"

namespace pliant {

/// "14 %", "0.8 %": two digits.
std::string percent(double share);

/// "object 'sheet': stretched 14 % too far at its pins (edge 12-13), 1 edge in 100 by 3 % or more".
std::string words_of(const Overstretch& found, const CompiledObject& object);

/// What to do, from what was tried: the setting found and its cost, another kind if there is one, and the JSON to paste.
std::string remedy(const Advice& advice);

}  // namespace pliant
