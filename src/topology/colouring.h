// Colours constraints so that those of one colour share no particle and can be projected together.
#pragma once

#include <cstdint>
#include <vector>

#include "topology/fours.h"

namespace pliant {

/// Constraints that share no particle. If bit s of `runs` is set, slot s is contiguous in each group q of four members:
/// stencil[4 q + l][slot] = stencil[4 q][slot] + l. If only some slots are contiguous, the groups come in fours.
struct Colour {
  int runs = 0;              ///< bit s is set if slot s is contiguous in groups of four
  std::vector<int> members;  ///< indices of constraints
};

/// The share, 0..1, of constraints (`size` particles each) in contiguous groups of four; 1 if there are no constraints.
double share_in_runs(const std::vector<int>& stencils, int size);

/// Stores which colours each particle has. It is made once for an object and used for all of its tiles.
class Colouring {
 public:
  explicit Colouring(int particles) : used_(particles, 0), next_(particles, 0) {}

  /// Colours the constraints `members`; constraint m has the particles stencils[size * m] to stencils[size * m + size -
  /// 1]. Groups of four that are contiguous in all slots come first, each coloured as a whole; then, if many
  /// constraints remain, groups that are contiguous in some slots; then single constraints. Constraints of more than
  /// four particles are always coloured singly. The result depends on the arguments alone.
  std::vector<Colour> colour(const std::vector<int>& stencils, int size, const std::vector<int>& members);

  /// Adds constraints to colours that have no runs: each to the first in which its particles are free, or to a new one.
  void extend(const std::vector<int>& stencils, int size, const std::vector<int>& members,
              std::vector<Colour>& colours);

  /// Colours each constraint singly, by first fit in the order of `members`.
  std::vector<Colour> colour_singly(const std::vector<int>& stencils, int size, const std::vector<int>& members);

 private:
  void append(const std::vector<int>& stencils, int size, const std::vector<Four>& fours,
              const std::vector<int>& singles, std::vector<Colour>& colours);
  int first_free(const int* particles, int count);
  void use(const int* particles, int count, int colour);
  void reset(const std::vector<int>& stencils, int size, const std::vector<int>& members);

  std::vector<std::uint64_t> used_;  // bit c: the particle has a constraint of colour c
  std::vector<int> next_;            // beyond 64 colours: the lowest colour that is free at the particle
};

}  // namespace pliant
