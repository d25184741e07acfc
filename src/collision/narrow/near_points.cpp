#include "collision/narrow/near_points.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace pliant {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

bool encloses(const BoxBounds& outer, const BoxBounds& inner) {
  return outer.low.x <= inner.low.x && outer.low.y <= inner.low.y && outer.low.z <= inner.low.z &&
         outer.high.x >= inner.high.x && outer.high.y >= inner.high.y && outer.high.z >= inner.high.z;
}

}  // namespace

void NearPoints::begin_substep(const Record* positions, int first, int last, float moved) {
  positions_ = positions;
  first_ = first;
  last_ = last;
  if (moved < infinity) {
    travelled_ += static_cast<double>(moved);
  } else {
    lists_.clear();
  }
  are_sorted_ = false;
}

void NearPoints::keep_only(const std::vector<int>& colliders) {
  std::erase_if(
      lists_, [&](const List& list) { return !std::binary_search(colliders.begin(), colliders.end(), list.collider); });
}

void NearPoints::sort() {
  if (are_sorted_) return;
  cells_.build(positions_, first_, last_);
  are_sorted_ = true;
}

/// Lists the points in a box, with what was known of those that were listed before.
void NearPoints::make(const BoxBounds& box, List& list) {
  points_.clear();
  known_.clear();
  sort();
  cells_.query(box, points_);
  std::size_t inside = 0, old = 0;
  for (const std::int32_t i : points_) {
    const Record& p = positions_[i];
    if (!(p.x >= box.low.x && p.y >= box.low.y && p.z >= box.low.z && p.x <= box.high.x && p.y <= box.high.y &&
          p.z <= box.high.z))
      continue;
    points_[inside++] = i;
    while (old < list.points.size() && list.points[old] < i) ++old;
    known_.push_back(old < list.points.size() && list.points[old] == i ? list.known[old] : Known{});
  }
  points_.resize(inside);
  list.points.swap(points_);
  list.known.swap(known_);
  list.box = box;
  list.travelled = travelled_;
}

NearPoints::List& NearPoints::near(int collider, const BoxBounds& box, float slack) {
  auto list = std::lower_bound(lists_.begin(), lists_.end(), collider,
                               [](const List& a, int number) { return a.collider < number; });
  const bool is_new = list == lists_.end() || list->collider != collider;
  if (is_new) list = lists_.insert(list, List{collider, {}, 0, {}, {}});
  const auto moved = static_cast<float>(1.00001 * (travelled_ - list->travelled));
  if (is_new || !encloses(list->box, box.grown(moved))) make(box.grown(slack), *list);
  return *list;
}

}  // namespace pliant
