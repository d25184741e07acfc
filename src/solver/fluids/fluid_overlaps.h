// Limits how fast particles of a liquid separate that overlap at the start.
//
// A particle whose density is far above that at rest is pushed out of the others within a few substeps, and what a
// substep corrects becomes velocity: 216 particles within 5 mm flew 58 m. So a particle that overlaps since it was
// placed, and each that has such a neighbour, moves in a substep no farther than predicted, or than the parting speed
// leads. So no correction makes it faster than that. Impacts are not limited: which particles overlap since they were
// placed is a channel of the State, which exists only while some do.
#pragma once

#include <cstdint>
#include <vector>

#include "pliant/state.h"

namespace pliant {

struct FluidPool;
struct Substep;

/// The channel of the State: 1 for particles that overlap others since they were placed, else 0.
inline constexpr const char* overlap_channel = "overlap";

/// A particle that is placed where the density is above this overlaps; it no longer does below the other [-].
inline constexpr float overlapping_density = 1.2f, parted_density = 1.05f;

/// Particles nearer than this share of the spacing have no direction in which to part.
inline constexpr float coincident_share = 1e-3f;

/// The speed at which particles that overlap separate [m/s]; `spacing` in m.
float parting_speed(float spacing);

class FluidOverlaps {
 public:
  /// Starts a frame with the particles of a pool.
  void begin_frame(const State& state, const std::vector<std::int32_t>& points);
  /// After neighbours were found: finds which slots are limited, and displaces coincident particles.
  void find(Substep& s, const FluidPool& pool);
  /// Before the first projection of a substep: how far each may move.
  void begin_substep(const Substep& s, const FluidPool& pool);
  /// After a projection: shortens displacements, and the multipliers by which particles push bodies (`weighted`).
  void limit(Substep& s, const FluidPool& pool, Records& weighted) const;
  /// After the last projection: particles that have parted are no longer limited.
  void end_substep(State& state, const FluidPool& pool);

 private:
  struct Limited {
    std::int32_t slot = 0;
    float most = 0;  ///< of its displacement [m]
  };

  bool is_used_ = false;  ///< some particles of the pool overlap
  std::vector<Limited> limited_;
  std::vector<char> overlaps_;  ///< by slot, with one behind the last
};

}  // namespace pliant
