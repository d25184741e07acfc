// What an overstretched distance looks like, and what to do about it, in words.
#pragma once

#include <string>

#include "model/compiled_object.h"
#include "pliant/advise.h"
#include "pliant/world.h"

namespace pliant {

/// "0.83", "14", "118": two digits or all of those before the point, and no powers of ten.
std::string two_digits(double value);

/// "14 %", "0.8 %".
std::string percent(double share);

/// "object 'sheet': stretched 14 % too far at its pins (edge 12-13), 1 edge in 100 by 3 % or more".
std::string words_of(const Overstretch& found, const CompiledObject& object);

/// Of `others`: the cheapest good trial; without one the one whose largest is least, and clearly below that of `own`, of those
/// whose p99 is not above its own: what gets better at its worst place and worse at others is no advice. -1: there is none.
int best_of(const Advice& advice);

/// What to do, from what was tried: the setting found and its cost, another kind if there is one, and the JSON to paste.
std::string remedy(const Advice& advice);

}  // namespace pliant
