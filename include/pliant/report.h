// What a step of a World has to say.
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

/// How far the constraints of one type are from being met, at the end of a frame: |C + alpha~ lambda| over all of them.
struct Residual {
  std::string type;
  std::int64_t constraints = 0;
  double rms = 0, largest = 0;  ///< in the unit of C
};

/// Where the solve stood after an iteration of a step's last substep.
///
/// Primal: |C + alpha~ lambda| by type, as in Residual. Dual: how far a particle is from where the multipliers alone would
/// have moved it, |x - x~ - w grad C^T lambda|, the other half of the equations that XPBD solves (Macklin et al. 2016, eq.
/// 8), as a length. Particles that touch something or have a PBD constraint are left out of it: those have no multipliers.
struct IterationResidual {
  int iteration = 0;  ///< 0: as predicted, before the first
  std::vector<Residual> primal;
  double dual_rms = 0, dual_largest = 0;  ///< over particles with mass [m]
};

/// Length over rest length of every distance constraint with a rest length.
struct Stretch {
  double mean = 1, p99 = 1, largest = 1;
};

/// By how much distance constraints are longer than the force in them makes them, (C + alpha~ lambda) / L: what a step left
/// undone and more substeps, more iterations or another sweep would do. Of a rigid one that is its stretch; of a compliant one
/// the stretch that its own tension does not explain, so that what is meant to stretch may. PBD stiffness, which has no
/// multiplier, is left out.
struct Overstretch {
  double p99 = 0, largest = 0;             ///< shares of the rest length; below 0 where all are too short [-]
  int object = -1;                         ///< slot of the one with the largest; -1: there are no such constraints
  std::array<int, 2> particles{{-1, -1}};  ///< between which it is, in the object's own numbering
};

/// Where the first non-finite value came from.
struct NonFinite {
  std::string object, element;  ///< "distance constraint 17 (particles 3, 4)", "particle 12"; no object: see World::step
  std::int64_t frame = 0;       ///< how many frames were complete before it
  int substep = 0;              ///< of the frame after those, from 0
};

/// How many iterations the substeps of a step made: all alike unless Settings::tolerance ends them early.
struct IterationCount {
  int smallest = 0, largest = 0;
  double mean = 0;
};

/// What surfaces did among one another and with mesh colliders.
struct PairReport {
  std::int64_t candidates = 0;    ///< pairs in lists: vertex-triangle and edge-edge, near in the mesh or found near
  std::int64_t contacts = 0;      ///< that pushed in the last substep
  std::int64_t truncated = 0;     ///< steps that the filter truncated so that nothing crossed, over all substeps
  std::int64_t unresolvable = 0;  ///< pairs that no step limit keeps apart: static or kinematic surfaces pinch the cloth
  std::int64_t initially_intersecting = 0;  ///< edges through a triangle since the start: no contact until they part
  std::int64_t rebuilds = 0;                ///< broad-phase rebuilds
  std::int64_t inside = 0;                  ///< vertices inside a closed mesh collider, on their way out
  double deepest = 0;  ///< what the last substep left of a contact's overlap: thickness less distance, or 0 [m]
};

/// An object, a collider or a mesh collider.
struct Thing {
  enum class Kind { object, collider, mesh_collider };
  Kind kind = Kind::object;
  int slot = -1, generation = 0;  ///< of its id

  Thing() = default;
  Thing(ObjectId id) : slot(id.slot), generation(id.generation) {}  // NOLINT(google-explicit-constructor)
  Thing(ColliderId id)                                              // NOLINT(google-explicit-constructor)
      : kind(Kind::collider), slot(id.slot), generation(id.generation) {}
  Thing(MeshColliderId id)  // NOLINT(google-explicit-constructor)
      : kind(Kind::mesh_collider), slot(id.slot), generation(id.generation) {}
  friend bool operator==(const Thing&, const Thing&) = default;
  friend auto operator<=>(const Thing&, const Thing&) = default;
};

/// What two things did to one another at the end of a frame. Only contacts that pushed count.
struct ContactEvent {
  enum class Change { begin, persist, end };
  Change change = Change::begin;
  Thing first, second;  ///< first < second; the same twice: an object and itself
  int contacts = 0;     ///< that pushed in the last substep
  double impulse = 0;   ///< sum of the sizes of their normal impulses over the last substep [N s]
  Vec3f position{};     ///< mean of where they touch, weighted by impulse [m]
  Vec3f normal{};       ///< unit; mean direction in which `first` is pushed; zero where they push it evenly to all sides
};

/// What a step has to say. A step never throws, but lets through what a force field of the user's throws.
struct Report {
  std::int64_t frame = 0;
  double time = 0;
  double milliseconds = 0;
  int substeps = 0;  ///< that the frame was divided into (Settings::most_substeps)
  std::vector<PhaseTime> phases;
  std::int64_t contacts = 0;  ///< active in the last substep
  PairReport pairs;
  std::vector<Residual> residuals;             ///< where Settings::measure
  std::optional<Stretch> stretch;              ///< where Settings::measure
  IterationCount iterations;                   ///< of each substep
  std::optional<Overstretch> overstretch;      ///< where Settings::measure; World::advice says it in words
  std::vector<IterationResidual> convergence;  ///< of the last substep, where Settings::record_residuals
  std::optional<NonFinite> nonfinite;
  bool stopped = false;  ///< by World::stop_when, before the frame was complete
  std::vector<std::string> warnings;

  bool ok() const { return !nonfinite; }
  std::string explain() const;  ///< in words, empty where all is well
};

}  // namespace pliant
