// Which triangles or tetrahedra are at each of some particles.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace pliant {

/// The numbers of the triangles or tetrahedra at each of some particles, ascending; nothing at others.
class Around {
 public:
  Around() = default;

  /// `at` has 1 for each of the particles, 0 for others.
  template <std::size_t n>
  Around(const std::vector<std::array<int, n>>& elements, const std::vector<char>& at) : first_(at.size() + 2) {
    std::vector<std::pair<int, int>> found;  // particle, and element there
    for (std::size_t e = 0; e < elements.size(); ++e) {
      char any = 0;
      for (const int corner : elements[e]) any |= at[static_cast<std::size_t>(corner)];
      if (any == 0) continue;
      for (const int corner : elements[e])
        if (at[static_cast<std::size_t>(corner)] != 0) found.emplace_back(corner, static_cast<int>(e));
    }
    fill(found);
  }

  std::span<const int> operator[](int particle) const {
    const auto p = static_cast<std::size_t>(particle);
    return {elements_.data() + first_[p], elements_.data() + first_[p + 1]};
  }

 private:
  /// A counting sort by particle. While it runs, entry p + 1 of `first_` is where the next one of particle p goes.
  void fill(const std::vector<std::pair<int, int>>& found) {
    for (const auto& [particle, element] : found) ++first_[static_cast<std::size_t>(particle) + 2];
    for (std::size_t i = 2; i < first_.size(); ++i) first_[i] += first_[i - 1];
    elements_.resize(found.size());
    for (const auto& [particle, element] : found) elements_[first_[static_cast<std::size_t>(particle) + 1]++] = element;
  }

  std::vector<std::size_t> first_;  ///< by particle: of its elements in `elements_`
  std::vector<int> elements_;
};

/// The particles at which elements of different parts meet; 1 for each of them. `part` has one number for each element.
template <std::size_t n>
std::vector<char> where_parts_meet(const std::vector<std::array<int, n>>& elements, std::span<const int> part,
                                   std::size_t particles) {
  std::vector<int> part_at(particles);
  std::vector<char> is_seen(particles), meet(particles);
  for (std::size_t e = 0; e < elements.size(); ++e)
    for (const int corner : elements[e]) {
      const auto p = static_cast<std::size_t>(corner);
      if (is_seen[p] == 0) {
        is_seen[p] = 1;
        part_at[p] = part[e];
      } else if (part_at[p] != part[e]) {
        meet[p] = 1;
      }
    }
  return meet;
}

}  // namespace pliant
