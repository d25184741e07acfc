// Colours of manifolds: those of one colour share no dynamic body, so threads and SIMD lanes may solve them together.
//
// In the order given, each manifold gets the first colour that none of its dynamic bodies has yet. Fixed bodies are
// never written, so they limit nothing. Colours depend on the manifolds alone, never on threads or instruction set.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace pliant {

/// Number of colours. Piles need about thirteen; a body that touches more than this many others leaves a tail.
inline constexpr int manifold_colours = 24;

class ManifoldColours {
 public:
  /// Colours manifold i, which has the bodies `bodies_of[i]`. `is_fixed` is by body: nonzero where a body is fixed.
  void colour(std::span<const std::pair<int, int>> bodies_of, std::span<const char> is_fixed);

  /// Indices of manifolds by colour, in the given order within each colour. Those without a free colour, the tail, are
  /// last.
  const std::vector<int>& order() const { return order_; }

  /// The start of each colour in order(), then that of the tail, then the number of manifolds: manifold_colours + 2
  /// entries.
  const std::vector<int>& start() const { return start_; }

  /// The start of the tail, which is solved one by one.
  int tail() const { return start_[manifold_colours]; }

 private:
  /// Bit mask of the colours taken at each body.
  std::vector<std::uint32_t> taken_;
  std::vector<std::uint8_t> colour_;  ///< of each manifold
  std::vector<int> order_, start_ = std::vector<int>(manifold_colours + 2, 0);
};

}  // namespace pliant
