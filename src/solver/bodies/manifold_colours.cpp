#include "solver/bodies/manifold_colours.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace pliant {

namespace {

/// The colours beyond the last one are taken everywhere, so the first free bit of a full mask is that of the tail.
constexpr std::uint32_t tail_bit = std::uint32_t{1} << manifold_colours;

}  // namespace

void ManifoldColours::colour(std::span<const std::pair<int, int>> bodies_of, std::span<const char> is_fixed) {
  taken_.assign(is_fixed.size(), 0);
  colour_.resize(bodies_of.size());
  order_.resize(bodies_of.size());
  start_.assign(manifold_colours + 2, 0);
  for (std::size_t i = 0; i < bodies_of.size(); ++i) {
    const auto a = static_cast<std::size_t>(bodies_of[i].first), b = static_cast<std::size_t>(bodies_of[i].second);
    const std::uint32_t taken = (taken_[a] | taken_[b]) & (tail_bit - 1);
    const int colour = __builtin_ctz(~taken);
    const std::uint32_t bit = (std::uint32_t{1} << colour) & (tail_bit - 1);
    colour_[i] = static_cast<std::uint8_t>(colour);
    ++start_[static_cast<std::size_t>(colour) + 1];
    if (is_fixed[a] == 0) taken_[a] |= bit;
    if (is_fixed[b] == 0) taken_[b] |= bit;
  }
  for (std::size_t c = 0; c <= manifold_colours; ++c) start_[c + 1] += start_[c];
  std::array<int, manifold_colours + 1> next{};
  std::copy(start_.begin(), start_.end() - 1, next.begin());
  for (std::size_t i = 0; i < colour_.size(); ++i)
    order_[static_cast<std::size_t>(next[colour_[i]]++)] = static_cast<int>(i);
}

}  // namespace pliant
