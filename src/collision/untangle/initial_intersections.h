// Intersecting edges and triangles at a frame's start.
// Contact and filter ignore them until they are apart.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "collision/proxies/pair_model.h"
#include "collision/untangle/intersections.h"

namespace pliant {

class InitialIntersections {
 public:
  explicit InitialIntersections(const PairModel& model);

  /// Finds all intersections between bodies that meet. `forget`: the positions do not continue those of the previous call.
  void find(const Record* positions, bool forget);
  const std::vector<Intersection>& found() const { return found_; }
  /// True if two bodies, the lower one first, had intersections at the previous call, and no more than now.
  bool are_no_fewer(std::pair<int, int> bodies) const;
  /// True if a pair belongs to an intersecting edge and triangle.
  bool hold(const PairStencil& pair) const;

 private:
  void exempt(const Intersection& found, const IntLists& triangles_at);

  const PairModel& model_;
  IntersectionFinder finder_;
  std::vector<Intersection> found_;
  std::map<std::pair<int, int>, std::size_t> counts_, counts_before_;  ///< by bodies, the lower one first
  std::vector<std::array<std::int32_t, 5>> exempt_;  ///< stencils, with the size of their first side; ascending
};

}  // namespace pliant
