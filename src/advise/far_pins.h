// Pins that are farther apart than the object between them is long.
#pragma once

#include <string>

#include "pliant/advise.h"

namespace pliant {

/// What to do if, in the frame of a trial's largest overstretch, two pins or firm attachments of that object are
/// farther apart than the object between them is long, by over 2 %: no settings can keep its lengths then. Empty if
/// they are not.
std::string advice_for_far_pins(const Scene& scene, const Trial& trial);

}  // namespace pliant
