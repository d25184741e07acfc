// Colouring constraints so that those of one colour share no particle and may be projected together.
#pragma once

#include <cstdint>
#include <vector>

#include "topology/fours.h"

namespace pliant {

/// Constraints that share no particle. If bit s of `runs` is set, members come in contiguous groups of four in slot s:
/// stencil[4 q + l][slot] = stencil[4 q][slot] + l. If only some slots are contiguous, they come in four times four.
struct Colour {
  int runs = 0;              ///< bit s: slot s is contiguous in groups of four
  std::vector<int> members;  ///< constraint indices
};

/// The share, 0..1, of constraints (`size` particles each) in contiguous groups of four; 1 if there are no constraints.
double share_in_runs(const std::vector<int>& stencils, int size);

/// Remembers which colours each particle has. Made once for an object and used for all of its tiles.
class Colouring {
 public:
  explicit Colouring(int particles) : used_(particles, 0), next_(particles, 0) {}

  /// Colours the constraints `members` of stencils (`size` particles each, at stencils[size *
  /// member]). Groups of four that are contiguous in all slots come first, each coloured as a
  /// whole; if many remain, groups contiguous in some slots; then single constraints. Stencils
  /// of more than four particles are coloured singly. The result depends on the input alone.
  std::vector<Colour> colour(const std::vector<int>& stencils, int size, const std::vector<int>& members);

  /// The same without groups: first fit in the order of `members`.
  std::vector<Colour> colour_singly(const std::vector<int>& stencils, int size, const std::vector<int>& members);

 private:
  void append(const std::vector<int>& stencils, int size, const std::vector<Four>& fours, const std::vector<int>& singles,
              std::vector<Colour>& colours);
  int first_free(const int* particles, int count);
  void reset(const std::vector<int>& stencils, int size, const std::vector<int>& members);

  std::vector<std::uint64_t> used_;  // bit c: the particle has a constraint of colour c
  std::vector<int> next_;            // beyond 64 colours: the next colour available to the particle
};

}  // namespace pliant
