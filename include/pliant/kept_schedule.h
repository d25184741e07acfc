// The schedule of an object whose constraints an edit left in their places.
#pragma once

#include <array>
#include <vector>

namespace pliant {

/// In which order the constraints of an object are projected, and where its particles are stored. Whoever adds an
/// object need not know: it follows from the description. After an edit of a large object it also follows from the
/// schedule before, because only what the edit reached is scheduled again. So WorldLayout has it.
struct KeptSchedule {
  /// Constraints that share no particle and are projected together.
  struct Colour {
    int type = 0, law = 0;         ///< number of the constraint type and of its law (Law)
    int tile = -1;                 ///< the tile that has all their particles; -1: they are between tiles
    int runs = 0;                  ///< bit s: slot s is contiguous in groups of four
    bool is_added = false;         ///< of constraints that were changed or added by edits; without runs
    std::vector<int> constraints;  ///< number of each among the constraints of the type
  };
  /// Tetrahedra around an edge that keep their volume together (constraint type volume_around_edge). Tetrahedron i has
  /// the corners a, b, ring[i] and the next of the ring.
  struct Fan {
    int a = 0, b = 0;  ///< ends of the edge
    int ring_size = 0, count = 0;
    std::array<int, 6> ring{}, tetrahedra{};  ///< particles; numbers among the constraints of type tetrahedron_volume
    bool closes() const { return count == ring_size; }
  };

  std::vector<int> order;      ///< order[place in storage] = user's index, of particles, then of targets of attachments
  std::vector<int> tile_ends;  ///< one past the last particle of each tile
  int first_added = 0;         ///< particles from this place on were added by edits; one of the tile ends
  std::vector<Colour> colours;
  std::vector<Fan> fans;

  bool is_used() const { return !order.empty(); }
};

}  // namespace pliant
