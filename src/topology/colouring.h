// Colouring constraints so that those of one colour share no particle and may be projected together.
#pragma once

#include <cstdint>
#include <vector>

namespace pliant {

/// One colour: constraints that share no particle. In a colour of runs, members come in fours whose stencils follow one another:
/// stencil[4 q + l][slot] = stencil[4 q][slot] + l for every slot.
struct Colour {
  bool runs = false;
  std::vector<int> members;  ///< numbers of constraints
};

/// Keeps which colours a particle has met already. Made once for an object and used for all of its tiles.
class Colouring {
 public:
  explicit Colouring(int particles) : used_(particles, 0), next_(particles, 0) {}

  /// Colours the constraints `members` of stencils (`size` particle numbers each, at stencils[size * member]). Runs of four are
  /// found first and coloured as wholes, then what is left. The same input gives the same colours on any machine.
  std::vector<Colour> colour(const std::vector<int>& stencils, int size, const std::vector<int>& members);

 private:
  int first_free(const int* particles, int count);
  void reset(const std::vector<int>& stencils, int size, const std::vector<int>& members);

  std::vector<std::uint64_t> used_;  // bit c: the particle has a constraint of colour c
  std::vector<int> next_;            // beyond 64 colours: the next colour that the particle may take
};

}  // namespace pliant
