// Finds the edges and triangles that intersect at a frame's start. Contact and filter ignore them until they no longer
// do.
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

  /// Updates the bodies; call it after bodies were added or removed.
  void change(const std::vector<int>& removed, const std::vector<int>& added);

  /// Finds all intersections between bodies that meet. `forget`: the positions do not continue those of the last call.
  void find(const Record* positions, bool forget);
  /// Finds only the intersections of bodies added since the last search; call it if no other bodies intersect.
  void find_of_new(const Record* positions);
  const std::vector<Intersection>& found() const { return found_; }
  /// True if two bodies (lower index first) had intersections at the previous search, and have at least as many now.
  bool are_no_fewer(std::pair<int, int> bodies) const;
  /// True if a pair of primitives is exempt, because it belongs to an intersecting edge and triangle.
  bool hold(const PairStencil& pair) const;

 private:
  void make_finder();
  void keep(std::vector<Intersection> found);
  void exempt(const Intersection& found);

  const PairModel& model_;
  std::unique_ptr<IntersectionFinder> finder_;  ///< search over all triangles in use; null after bodies changed
  std::vector<int> triangles_, vertices_;       ///< indices in the model of the triangles and vertices of finder_
  std::vector<int> new_bodies_;                 ///< bodies added since the last search, ascending
  std::vector<Intersection> found_;
  std::map<std::pair<int, int>, std::size_t> counts_, counts_before_;  ///< counts by two bodies, the lower index first
  std::vector<std::array<std::int32_t, 5>> exempt_;  ///< exempt pairs: four vertices, size of the first side; ascending
};

}  // namespace pliant
