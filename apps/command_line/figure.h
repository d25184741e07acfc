// Numbers for readers.
#pragma once

#include <string>

namespace pliant::command {

/// A number with at least `digits` significant digits and all digits before the point: "0.00834", "118", "12345"; no
/// exponent below 1e15.
std::string figure(double value, int digits);

}  // namespace pliant::command
