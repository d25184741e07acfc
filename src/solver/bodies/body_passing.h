// Keeps bodies and surfaces from passing one another in a substep, in rounds: what the filter finds gets contacts,
// which are projected, and what is moved by that is looked at again. The Report says where it does not succeed.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "solver/bodies/passing_filter.h"
#include "solver/bodies/point_depenetration.h"
#include "solver/bodies/point_impulses.h"
#include "solver/bodies/surface_tiles.h"
#include "solver/bodies/swept_contacts.h"

namespace pliant {

struct Substep;

class BodyPassing {
 public:
  BodyPassing() = default;
  explicit BodyPassing(const BodySolids& solids) : filter_(solids.convex_shapes()) {}

  /// What BodyPoints has for it.
  struct Parts {
    BodySolids& solids;
    SurfaceTiles& surfaces;
    SweptContacts& swept;
    PointImpulses& impulses;
    const std::vector<BodyMotion>& motions;  ///< inverse masses and inertias of bodies
    const PointDepenetration& led_out;       ///< what may pass, as it is being led out
  };

  void begin_frame() { filter_.begin_frame(); }
  /// After the iterations: keeps solids and triangles from passing one another on the way which these have given them.
  void stop_passing(Substep& s, const Parts& parts);
  /// The same after surfaces were kept apart, by moving bodies alone.
  void hold_bodies(Substep& s, const Parts& parts);
  /// After that: bodies and surfaces have been moved on by at most so far [m].
  void note_shift(float farthest) { filter_.note_shift(farthest); }
  /// What warnings of overlaps need to know.
  struct Found {
    const BodySolids& solids;
    const std::vector<Contact>& contacts;
    const std::vector<PointDepenetration::Inside>& inside;  ///< has warnings of its own
  };
  /// Adds a warning for each body that surfaces overlap at a substep's end, after hold_bodies.
  void warn_of_overlaps(const Substep& s, const Found& found, std::vector<std::string>& warnings) const;

 private:
  /// How a round stops what would pass: by impulses on both sides or on bodies alone, or by taking back their motion in
  /// the substep.
  enum class Stop { both_sides, bodies, back, bodies_back };

  bool stop_once(Substep& s, const Parts& parts, bool is_first, Stop by);
  void begin_alone(const Substep& s, const BodySolids& solids);
  void end_alone(Substep& s, const BodySolids& solids);
  void note_moved(const Substep& s, const Parts& parts, std::size_t first);
  bool has_moved(const Substep& s, const SurfaceTiles& surfaces) const;

  PassingFilter filter_;
  std::vector<char> moved_vertices_, moved_solids_;  ///< by the last round
  std::vector<int> listed_vertices_;                 ///< the former as a list
  float farthest_ = 0;                               ///< largest displacement of these [m]
  /// Where bodies were before they were moved alone, by displacement and correction of their rotation.
  std::vector<std::pair<Record, Record>> before_alone_;
  std::vector<Record> kept_;  ///< displacements of tiles near solids after stop_passing
  bool is_done_ = false;      ///< stop_passing has left nothing that would pass
};

}  // namespace pliant
