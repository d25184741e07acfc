// Random numbers that are the same on every machine.
#pragma once

#include <random>

namespace pliant::testing_support {

using Random = std::mt19937;

inline double uniform(Random& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random()) / 4294967295.0;
}

}  // namespace pliant::testing_support
