// Describes in words which distances are overstretched, and the remedy.
#pragma once

#include <string>

#include "model/compiled_object.h"
#include "pliant/advise.h"
#include "pliant/world.h"

namespace pliant {

/// The value with two digits, or with all digits before the point, without an exponent: "0.83", "14", "118".
std::string two_digits(double value);

/// The share in percent: "14 %", "0.8 %".
std::string percent(double share);

/// For example: "object 'sheet': stretched 14 % too far at its pins (edge 12-13), 1 edge in 100 by 3 % or more".
std::string words_of(const Overstretch& found, const CompiledObject& object);

/// For example: "object 'bridge': particle 10 is 12 mm away from its place on body 0 ('box') of 'bridge', 24 % of the
/// edges there; ..."
std::string words_of(const TieGap& tie, const CompiledObject& object);

/// Returns the index in `others` of the cheapest good trial; if none is good, of the one that exceeds what is tolerable
/// by the smallest factor, clearly smaller than that of `own`, with neither figure above that of `own`. -1: none.
int best_of(const Advice& advice);

/// By what a scene departs from the default.
struct Departures {
  std::string settings;  ///< departures() of its settings
  std::string objects;   ///< the objects that name a sweep of their own, in words; empty: none
};

/// The remedy that the trials found: settings and their cost, an alternative if there is one, and the JSON to paste.
std::string remedy(const Advice& advice, const Departures& departs);

}  // namespace pliant
