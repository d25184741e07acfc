// Intersecting edges and triangles at a frame's start.
// Contact and filter ignore them until they are apart.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "collision/proxies/pair_model.h"
#include "collision/untangle/intersections.h"

namespace pliant {

class InitialIntersections {
 public:
  explicit InitialIntersections(const PairModel& model) : model_(model) {}

  /// Call it after bodies came or went.
  void change(const std::vector<int>& removed, const std::vector<int>& added);

  /// Finds all intersections between bodies that meet. `forget`: the positions do not continue those of the previous call.
  void find(const Record* positions, bool forget);
  /// Finds only those of bodies that are new since the last call of either. Call it if no others intersect.
  void find_of_new(const Record* positions);
  const std::vector<Intersection>& found() const { return found_; }
  /// True if two bodies, the lower one first, had intersections at the previous call, and no more than now.
  bool are_no_fewer(std::pair<int, int> bodies) const;
  /// True if a pair belongs to an intersecting edge and triangle.
  bool hold(const PairStencil& pair) const;

 private:
  void keep(std::vector<Intersection> found);
  void exempt(const Intersection& found);

  const PairModel& model_;
  std::unique_ptr<IntersectionFinder> finder_;  ///< of all triangles in use; null: not made since bodies changed
  std::vector<int> triangles_;                  ///< their numbers
  std::vector<int> new_bodies_;                 ///< ascending
  std::vector<Intersection> found_;
  std::map<std::pair<int, int>, std::size_t> counts_, counts_before_;  ///< by bodies, the lower one first
  std::vector<std::array<std::int32_t, 5>> exempt_;  ///< stencils, with the size of their first side; ascending
};

}  // namespace pliant
