// What is left of the contacts of the frame before, for the search of those of this one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <tuple>
#include <vector>

#include "collision/bodies/body_part.h"
#include "math/vector.h"
#include "pliant/state.h"

namespace pliant {

/// ContactPart::piece of b: contact is that of a solid, of the ball inside of that of b, or of the ball inside of that
/// of a.
inline constexpr int of_solids = 0, of_ball_b = 1, of_ball_a = 2;

inline auto solids_of(const BodyContact& c) { return std::tuple{c.a.owner, c.a.solid, c.b.owner, c.b.solid}; }

/// Finds the contacts of two parts in the frame before. Pairs are mostly asked for in ascending order, so the search
/// begins where the last one ended.
class ContactsBefore {
 public:
  explicit ContactsBefore(const std::vector<BodyContact>& before) : all_(before) {}

  std::span<const BodyContact> find(const ContactPart& a, const ContactPart& b) {
    const std::tuple wanted{a.owner, a.solid, b.owner, b.solid};
    const auto is_before = [&](const BodyContact& c) { return solids_of(c) < wanted; };
    std::size_t first = next_, steps = 0;
    while (first < all_.size() && steps < most_steps && is_before(all_[first])) ++first, ++steps;
    const bool is_found = steps < most_steps && first > 0 && is_before(all_[first - 1]);
    if (!is_found)
      first = static_cast<std::size_t>(std::partition_point(all_.begin(), all_.end(), is_before) - all_.begin());
    std::size_t last = first;
    while (last < all_.size() && solids_of(all_[last]) == wanted) ++last;
    next_ = last;
    return std::span(all_).subspan(first, last - first);
  }

 private:
  /// Beyond, a binary search is faster.
  static constexpr std::size_t most_steps = 8;

  const std::vector<BodyContact>& all_;
  std::size_t next_ = 0;
};

/// The contacts of the solids themselves, of those of two convex parts.
inline std::span<const BodyContact> of_solids_in(std::span<const BodyContact> contacts) {
  const auto end =
      std::find_if(contacts.begin(), contacts.end(), [](const BodyContact& c) { return c.b.piece != of_solids; });
  return contacts.first(static_cast<std::size_t>(end - contacts.begin()));
}

/// The contact of the frame before with the same piece, or else the one whose normal agrees best; null if none is
/// similar.
inline const BodyContact* like(const BodyContact& c, std::span<const BodyContact> before) {
  const BodyContact* best = nullptr;
  float closest = 0.9f;
  for (const BodyContact& old : before) {
    if (old.b.piece != c.b.piece) continue;
    const float agreement = old.a.piece == c.a.piece ? 2 : dot(old.normal, c.normal);
    if (!(agreement > closest)) continue;
    closest = agreement;
    best = &old;
  }
  return best;
}

}  // namespace pliant
