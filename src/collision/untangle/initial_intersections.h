// Edges and triangles that intersect though they should not: where a frame begins so, contact and filter leave them out until they
// are apart.
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

  /// Finds all between bodies that meet. `forget`: the positions do not follow those of the call before.
  void find(const Record* positions, bool forget);
  const std::vector<Intersection>& found() const { return found_; }
  /// Whether two bodies, the lower one first, had intersections at the call before too, and no more than now.
  bool are_no_fewer(std::pair<int, int> bodies) const;
  /// Whether a pair belongs to an edge and a triangle that intersect.
  bool hold(const PairStencil& pair) const;

 private:
  void exempt(const Intersection& found, const IntLists& triangles_at);

  const PairModel& model_;
  IntersectionFinder finder_;
  std::vector<Intersection> found_;
  std::map<std::pair<int, int>, std::size_t> counts_, counts_before_;  ///< by bodies, the lower one first
  std::vector<std::array<std::int32_t, 5>> exempt_;  ///< stencils, with the number of their first side; ascending
};

}  // namespace pliant
