// The length of a frame, clocks, and the median of what they measured.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <ctime>
#include <vector>

namespace pliant::bench {

inline constexpr float frame_time = 1.f / 60;  ///< [s]

/// Processor time of all threads of the process [ms].
inline double processor_ms() { return 1000. * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

inline double wall_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The upper one of two in the middle; 0 of none.
inline double median(std::vector<double> of) {
  if (of.empty()) return 0;
  const auto middle = of.begin() + static_cast<std::ptrdiff_t>(of.size() / 2);
  std::nth_element(of.begin(), middle, of.end());
  return *middle;
}

}  // namespace pliant::bench
