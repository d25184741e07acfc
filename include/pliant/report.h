// The result of a World's step.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pliant/state.h"

namespace pliant {

/// Milliseconds spent in a named phase of a step.
struct PhaseTime {
  std::string name;
  double milliseconds = 0;
};

/// The residual of the constraints of one type at the end of a frame: |C + alpha~ lambda| over all of them.
struct Residual {
  std::string type;
  std::int64_t constraints = 0;
  double rms = 0, largest = 0;  ///< in the unit of C
};

/// The convergence after an iteration of a step's last substep.
///
/// Primal: |C + alpha~ lambda| by type, as in Residual. Dual: |x - x~ - w grad C^T lambda|, the part of a particle's
/// displacement that the multipliers do not explain, as a length: the other half of XPBD's equations (Macklin et al. 2016,
/// eq. 8). Particles in contact or with a PBD constraint are excluded, because those have no multipliers.
struct IterationResidual {
  int iteration = 0;  ///< 0: the prediction, before the first
  std::vector<Residual> primal;
  double dual_rms = 0, dual_largest = 0;  ///< over particles with mass [m]
};

/// Length over rest length of every distance constraint with a rest length.
struct Stretch {
  double mean = 1, p99 = 1, largest = 1;
};

/// By how much distance constraints are longer than their force explains, (C + alpha~
/// lambda) / L: the error that a step left, which more substeps, iterations or another
/// sweep would reduce. For a rigid constraint that is its stretch, for a compliant one the
/// stretch beyond its own tension. PBD stiffness is excluded, because it has no multiplier.
struct Overstretch {
  double p99 = 0, largest = 0;             ///< shares of the rest length; negative if all are too short [-]
  int object = -1;                         ///< slot of the object with the largest; -1: no such constraints
  std::array<int, 2> particles{{-1, -1}};  ///< the ends of that constraint, in the object's own order
};

/// The origin of the first non-finite value.
struct NonFinite {
  std::string object, element;  ///< "distance constraint 17 (particles 3, 4)", "particle 12"; no object: see World::step
  std::int64_t frame = 0;       ///< complete frames before it
  int substep = 0;              ///< substep of the frame in which it occurred, from 0
};

/// The iterations of a step's substeps, which differ only if Settings::tolerance ends some early.
struct IterationCount {
  int smallest = 0, largest = 0;
  double mean = 0;
};

/// Statistics of contact between surfaces and with mesh colliders.
struct PairReport {
  std::int64_t candidates = 0;    ///< pairs in lists, vertex-triangle and edge-edge: static pairs and pairs found near
  std::int64_t contacts = 0;      ///< active in the last substep
  std::int64_t truncated = 0;     ///< steps truncated by the filter, over all substeps
  std::int64_t unresolvable = 0;  ///< pairs that no step limit separates: static or kinematic surfaces pinch the cloth
  std::int64_t initially_intersecting = 0;  ///< edges through a triangle since the start: no contact until they are apart
  std::int64_t rebuilds = 0;                ///< broad-phase rebuilds
  std::int64_t inside = 0;                  ///< vertices inside a closed mesh collider that are being moved out
  double deepest = 0;  ///< penetration left by the last substep, largest: thickness minus distance, or 0 [m]
};

/// An object, a collider or a mesh collider.
struct Thing {
  enum class Kind { object, collider, mesh_collider };
  Kind kind = Kind::object;
  int slot = -1, generation = 0;  ///< slot and generation of its id

  Thing() = default;
  Thing(ObjectId id) : slot(id.slot), generation(id.generation) {}  // NOLINT(google-explicit-constructor)
  Thing(ColliderId id)                                              // NOLINT(google-explicit-constructor)
      : kind(Kind::collider), slot(id.slot), generation(id.generation) {}
  Thing(MeshColliderId id)  // NOLINT(google-explicit-constructor)
      : kind(Kind::mesh_collider), slot(id.slot), generation(id.generation) {}
  friend bool operator==(const Thing&, const Thing&) = default;
  friend auto operator<=>(const Thing&, const Thing&) = default;  // NOLINT(modernize-use-nullptr)
};

/// A contact between two things at the end of a frame. Only active contacts count.
struct ContactEvent {
  enum class Change { begin, persist, end };
  Change change = Change::begin;
  Thing first, second;  ///< first < second; equal for self-contact of an object
  int contacts = 0;     ///< active in the last substep
  double impulse = 0;   ///< sum of the magnitudes of their normal impulses in the last substep [N s]
  Vec3f position{};     ///< impulse-weighted mean contact position [m]
  Vec3f normal{};       ///< unit; mean direction of the push on `first`; zero if pushes cancel
};

/// The result of a step. A step never throws, except for exceptions of the user's force fields.
struct Report {
  std::int64_t frame = 0;
  double time = 0;
  double milliseconds = 0;
  int substeps = 0;  ///< number of substeps of this frame (Settings::most_substeps); the largest where objects differ
  std::vector<PhaseTime> phases;
  std::int64_t contacts = 0;  ///< active in the last substep
  PairReport pairs;
  std::vector<Residual> residuals;             ///< if Settings::measure
  std::optional<Stretch> stretch;              ///< if Settings::measure
  IterationCount iterations;                   ///< iterations per substep
  std::optional<Overstretch> overstretch;      ///< if Settings::measure; World::advice describes it
  std::vector<IterationResidual> convergence;  ///< of the last substep by iteration, if Settings::record_residuals
  std::optional<NonFinite> nonfinite;
  bool stopped = false;  ///< stopped by World::stop_when before the frame was complete
  std::vector<std::string> warnings;

  bool ok() const { return !nonfinite; }
  std::string explain() const;  ///< problems and warnings in words; says so too if nothing moved, as for a refused dt
};

}  // namespace pliant
