// Describes overstretched distances and remedies in words.
#pragma once

#include <string>

#include "model/compiled_object.h"
#include "pliant/advise.h"
#include "pliant/world.h"

namespace pliant {

/// "0.83", "14", "118": two digits, or all digits before the point, without an exponent.
std::string two_digits(double value);

/// "14 %", "0.8 %".
std::string percent(double share);

/// "object 'sheet': stretched 14 % too far at its pins (edge 12-13), 1 edge in 100 by 3 % or more".
std::string words_of(const Overstretch& found, const CompiledObject& object);

/// The index in `others` of the cheapest good trial; else of the one with the least largest overstretch, clearly below that
/// of `own`, and a p99 not above its own, because improving only the worst place is no advice. -1: none.
int best_of(const Advice& advice);

/// The remedy from the trials: the settings found and their cost, an alternative if there is one, and the JSON to paste.
std::string remedy(const Advice& advice);

}  // namespace pliant
