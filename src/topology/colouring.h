// Colouring constraints so that those of one colour share no particle and may be projected together.
#pragma once

#include <cstdint>
#include <vector>

#include "topology/fours.h"

namespace pliant {

/// Constraints that share no particle. Where slots are in runs, members come in fours whose particles there follow one another:
/// stencil[4 q + l][slot] = stencil[4 q][slot] + l for every such slot; where only some are, in four times four.
struct Colour {
  int runs = 0;              ///< bit s: slot s is in runs
  std::vector<int> members;  ///< numbers of constraints
};

/// The share, 0..1, of constraints (`size` particle numbers each) that are in runs of four; 1 where there are none.
double share_in_runs(const std::vector<int>& stencils, int size);

/// Keeps which colours a particle has met already. Made once for an object and used for all of its tiles.
class Colouring {
 public:
  explicit Colouring(int particles) : used_(particles, 0), next_(particles, 0) {}

  /// Colours the constraints `members` of stencils (`size` particle numbers each, at stencils[size * member]). Fours that are in runs
  /// with all slots are found first and coloured as wholes; then, if much is left, fours that are with some slots; then single ones.
  /// The same input gives the same colours on any machine.
  /// Stencils of more than four are coloured singly.
  std::vector<Colour> colour(const std::vector<int>& stencils, int size, const std::vector<int>& members);

  /// The same, none in runs: first fit in the order of `members`.
  std::vector<Colour> colour_singly(const std::vector<int>& stencils, int size, const std::vector<int>& members);

 private:
  void append(const std::vector<int>& stencils, int size, const std::vector<Four>& fours, const std::vector<int>& singles,
              std::vector<Colour>& colours);
  int first_free(const int* particles, int count);
  void reset(const std::vector<int>& stencils, int size, const std::vector<int>& members);

  std::vector<std::uint64_t> used_;  // bit c: the particle has a constraint of colour c
  std::vector<int> next_;            // beyond 64 colours: the next colour that the particle may take
};

}  // namespace pliant
