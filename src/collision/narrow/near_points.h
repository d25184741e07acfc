// The particles of a tile that are near solids which move, in lists that are kept while neither has moved much.
//
// A list has all particles that were in a box when it was made. It still has all those in a smaller box, if no particle
// has moved by more than the gap between both boxes since. Callers test the smaller box, so lists do not change what
// they find.
#pragma once

#include <cstdint>
#include <vector>

#include "collision/broad/point_cells.h"

namespace pliant {

class NearPoints {
 public:
  /// A distance that was found at a place in the collider's frame [m].
  struct Known {
    Vec3f place{};
    float distance = -1e30f;  ///< no place is clear by this one
  };
  struct List {
    int collider = -1;
    BoxBounds box{};  ///< in which it was complete
    double travelled = 0;
    std::vector<std::int32_t> points;  ///< ascending; numbers as in the State
    std::vector<Known> known;          ///< of points
  };

  /// Starts a substep of the particles [first, last) of an array, which have moved by up to `moved` since the last one
  /// [m]: lists are forgotten if that is not finite. The array stays where it is until the next call.
  void begin_substep(const Record* positions, int first, int last, float moved);
  /// Forgets lists of other colliders than these, which ascend.
  void keep_only(const std::vector<int>& colliders);

  /// Sorts the particles at the substep's start into cells, if that is not done yet.
  void sort();
  /// The cells, after sort() in this substep.
  const PointCells& cells() const { return cells_; }
  /// A list that has all particles in `box`, and some within `slack` beside it [m].
  List& near(int collider, const BoxBounds& box, float slack);

 private:
  void make(const BoxBounds& box, List& list);

  const Record* positions_ = nullptr;
  int first_ = 0, last_ = 0;
  double travelled_ = 0;  ///< by the fastest particle of each substep, added up [m]
  bool are_sorted_ = false;
  PointCells cells_;
  std::vector<List> lists_;  ///< by collider
  std::vector<std::int32_t> points_;
  std::vector<Known> known_;
};

}  // namespace pliant
