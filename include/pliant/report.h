// The result of a step of a World.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pliant/state.h"

namespace pliant {

/// Time spent in one phase of a step [ms].
struct PhaseTime {
  std::string name;
  double milliseconds = 0;
};

/// The error of all constraints of one type at the end of a frame: |C + alpha~ lambda|.
struct Residual {
  std::string type;
  std::int64_t constraints = 0;
  double rms = 0, largest = 0;  ///< root mean square and maximum, in the unit of C
};

/// How far the last substep of a step had converged after one iteration.
///
/// Primal: |C + alpha~ lambda| by type, as in Residual. Dual: |x - x~ - w grad C^T lambda| of a particle, the part of
/// its displacement that multipliers do not explain [m]; it belongs to the other half of XPBD's equations (Macklin et
/// al. 2016, eq. 8). Particles in contact or with a PBD constraint are left out, because these have no multipliers.
struct IterationResidual {
  int iteration = 0;  ///< number of iterations made; 0: the prediction
  std::vector<Residual> primal;
  double dual_rms = 0, dual_largest = 0;  ///< root mean square and maximum over dynamic particles [m]
};

/// The ratio of length to rest length, over all distance constraints with a positive rest length.
struct Stretch {
  double mean = 1, p99 = 1, largest = 1;
};

/// By how much distance constraints are longer than their force explains, (C + alpha~ lambda) / L: the error that a
/// step leaves. More substeps or iterations, or another sweep, reduce it. For a rigid constraint it is the stretch, for
/// a compliant one the stretch beyond that of its tension. Constraints with PBD stiffness are left out, because they
/// have no multiplier, and those between two fixed particles, because no solve changes them.
struct Overstretch {
  double p99 = 0, largest = 0;  ///< 99th percentile and maximum, shares of the rest length; 0 if not too long [-]
  int object = -1;              ///< slot of the object that has the maximum; -1: no constraint is too long
  std::array<int, 2> particles{{-1, -1}};  ///< particles of the constraint with the maximum, in the object's own order
  std::int64_t constraints = 0;            ///< number of constraints that were measured
  int generation = 0;                      ///< generation of that object's id
};

/// The overstretch that the default settings keep to in any frame: 99th percentile and maximum [-].
inline constexpr double tolerated_p99 = 0.02, tolerated_overstretch = 0.1;

/// True if both are within these limits.
inline bool is_tolerable(const Overstretch& found) {
  return found.p99 <= tolerated_p99 && found.largest <= tolerated_overstretch;
}

/// The worst overstretch of all complete frames since the World was made or a State was restored.
struct WorstOverstretch {
  /// The largest 99th percentile and the largest maximum of any frame, which may be different frames. The object is -1
  /// after it was removed or edited.
  Overstretch overstretch;
  std::int64_t frame_of_p99 = 0, frame_of_largest = 0;  ///< Report::frame of each; 0: none was too long
};

/// What resists, of which a ConvergenceEstimate is.
enum class Resistance { stretching, bending, shear, volume, joints, density };
inline constexpr std::size_t resistance_count = 6;

/// How far the solve of one kind of resistance is from converged, of the object where it is farthest: an estimate from
/// what the last substep of a frame leaves. The error falls about as the square of the substeps, so twice as many take
/// off three quarters of it (docs/internals/convergence.md).
struct ConvergenceEstimate {
  /// Of bending and shear: by what share of the right deformation the object yields too much; below 0 in fast motion,
  /// where forces are ahead of it. Of the others the error as a share: of lengths (Overstretch::p99), of the volumes of
  /// tetrahedra (root mean square), of the size of the bodies at a joint (root mean square), of the density at rest
  /// (Compression::mean) [-].
  double excess = 0;
  double strain = 0;  ///< of bending and shear: the same as an angle or a strain, weighted by force [rad or -]
  ObjectId object;    ///< empty if there is no estimate, and of density
  int substeps = 0;   ///< of that object in the frame
  std::int64_t constraints = 0;  ///< sampled in this frame and those before, which count less and less; 0: no estimate
};

/// One for each Resistance, in its order.
using ConvergenceEstimates = std::array<ConvergenceEstimate, resistance_count>;

/// The name of a Resistance: "stretching".
const char* name_of(Resistance kind);

/// True if an estimate is so small that it need not be told: bending within a quarter or 0.001 rad, shear within a
/// tenth or 0.002, stretching as Overstretch::p99, volume within a twentieth, joints and density within a hundredth.
bool is_tolerable(Resistance kind, const ConvergenceEstimate& estimate);

/// The estimates that were farthest from converged since the World was made or a State was restored. They follow those
/// of the frames up by a twentieth of the way each and down at once, so that an impact of a few frames does not count.
struct WorstEstimates {
  ConvergenceEstimates estimates;
  std::array<std::int64_t, resistance_count> frames{};  ///< Report::frame of each; 0: none
};

/// Where the first value that is not finite arose.
struct NonFinite {
  /// "distance constraint 17 (particles 3, 4)", "particle 12"; no object: see World::step.
  std::string object, element;
  std::int64_t frame = 0;  ///< number of complete frames before the error
  int substep = 0;         ///< index of the substep within the frame, from 0
};

/// Iterations per substep in a step. They differ only if Settings::tolerance ends some substeps early.
struct IterationCount {
  int smallest = 0, largest = 0;
  double mean = 0;
};

/// How many particles of liquids and grains came and went in a step (Flow).
struct FlowReport {
  std::int64_t emitted = 0;
  std::int64_t drained = 0;
  std::int64_t expired = 0;  ///< their lifetime was over
  std::int64_t refused = 0;  ///< not emitted, because all particles of the object were there
  std::int64_t blocked = 0;  ///< not emitted, because a particle of the object was in the way
  std::int64_t soaked = 0;   ///< soaked into a surface (Absorbency)
  std::int64_t seeped = 0;   ///< passed through a full one
  std::int64_t dripped = 0;  ///< came as drops from one
  std::int64_t present = 0;  ///< particles that are there at the step's end, of objects whose particles come or go

  /// Adds a later step: sums what came and went, and takes over who is present.
  void add(const FlowReport& later) {
    emitted += later.emitted;
    drained += later.drained;
    expired += later.expired;
    refused += later.refused;
    blocked += later.blocked;
    soaked += later.soaked;
    seeped += later.seeped;
    dripped += later.dripped;
    present = later.present;
  }
};

/// Statistics of contact between surfaces, including mesh colliders and, in `contacts`, rigid bodies.
struct PairReport {
  std::int64_t candidates = 0;    ///< pairs of primitives in lists: mesh neighbours, and pairs found near
  std::int64_t contacts = 0;      ///< active in the last substep, also of points and surfaces with rigid bodies
  std::int64_t truncated = 0;     ///< steps of vertices that the filter truncated, over all substeps
  std::int64_t unresolvable = 0;  ///< pairs that no step limit keeps apart, as in cloth pinched by colliders
  std::int64_t initially_intersecting = 0;  ///< edges that intersect a triangle since the start; no contact until apart
  std::int64_t rebuilds = 0;                ///< number of broad-phase rebuilds
  std::int64_t inside = 0;                  ///< vertices inside a closed mesh collider, which are being moved out
  double deepest = 0;  ///< largest penetration that the last substep left: thickness minus distance, or 0 [m]
};

/// A participant of a contact: an object, a collider or a mesh collider.
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

/// The contacts between two things in a frame. Only active contacts count. A liquid also presses on what is near it
/// without touching it.
struct ContactEvent {
  enum class Change { begin, persist, end };
  Change change = Change::begin;
  Thing first, second;  ///< first < second; equal for self-contact
  int contacts = 0;     ///< largest number of active contacts in a substep; can be 0 for a liquid
  /// Sum of the magnitudes of their normal impulses over the frame, with those of restitution [N s]
  double impulse = 0;
  Vec3f position{};  ///< mean position of the contacts, weighted by impulse [m]
  Vec3f normal{};    ///< unit vector: mean direction of the push on `first`; zero if pushes cancel
  Vec3d push{};      ///< sum of their normal impulses on `first` over the frame [N s]
};

/// A side of a BodyTouch.
struct TouchSide {
  Thing thing;
  int body = -1;  ///< index in Object::bodies; -1: a collider, or particles of an object
  friend bool operator==(const TouchSide&, const TouchSide&) = default;
  friend auto operator<=>(const TouchSide&, const TouchSide&) = default;  // NOLINT(modernize-use-nullptr)
};

/// The contacts between a rigid body and another one, a collider or particles in a frame. `push` over the duration of
/// the frame is the mean force between them. The pressure of liquids is in it; friction is not.
struct BodyTouch {
  TouchSide first, second;  ///< first < second
  int contacts = 0;         ///< largest number of active contacts in a substep; can be 0 for a liquid
  double impulse = 0;       ///< sum of the magnitudes of their normal impulses over the frame [N s]
  Vec3f position{};         ///< mean position of the contacts, weighted by impulse [m]
  Vec3d push{};             ///< sum of their normal impulses on `first` [N s]
};

/// A joint that broke: it carried more than its break_force or break_torque, or its rod tore or was cut.
struct JointBreak {
  ObjectId object;
  int joint = -1;    ///< index in Object::joints
  std::string name;  ///< of the joint
};

/// An object that tore or was cut at the end of a step (Object::tearing, Object::cuts). Its particles keep their
/// indices; new ones follow.
struct Torn {
  ObjectId object;
  int new_particles = 0;     ///< particles that were split off
  int lost_constraints = 0;  ///< links of ropes and hinges of cloth that are gone
};

/// The rigid tie of a particle to a body (attach()) that is open farthest: the error that a step leaves. Ties with
/// compliance or PBD stiffness are left out, because these open by design.
struct TieGap {
  double gap = 0;  ///< distance of the particle from its place on the body [m]
  /// Mean length of the edges at the particle, or without edges its distance from the centre of mass [m]
  double length = 0;
  ObjectId object;
  int particle = -1,
      body = -1;  ///< in the object's own order, and an index in Object::bodies; -1: no rigid tie is open
};

/// True if a tie is open by no more than an edge may be too long.
inline bool is_tolerable(const TieGap& tie) { return tie.gap <= tolerated_overstretch * tie.length; }

/// How much denser than at rest liquids are, in the last substep: density over that at rest, minus 1, where that is
/// above 0 [-].
struct Compression {
  double mean = 0, largest = 0;  ///< over all particles of liquids
  int crowded = 0;               ///< particles with over 256 neighbours, of which the rest was left out
};

/// How the solves for the viscosity of liquids went in a frame (docs/guide/liquids.md).
struct ViscositySolves {
  int iterations = 0;   ///< the most of any solve
  int unfinished = 0;   ///< solves that the limit of 200 iterations ended; a warning says so
  double residual = 0;  ///< of those, the largest residual over that at the start of its solve [-]

  ViscositySolves& operator+=(const ViscositySolves& other) {
    iterations = iterations > other.iterations ? iterations : other.iterations;
    unfinished += other.unfinished;
    residual = residual > other.residual ? residual : other.residual;
    return *this;
  }
};

/// How much of the surface tension of liquids acts, as the least of any liquid and substep of a frame
/// (docs/guide/liquids.md).
struct TensionActs {
  /// Of Fluid::surface_tension; below 1 where substeps are too long for it, and a warning says so [-]
  float share = 1;

  TensionActs& operator+=(const TensionActs& other) {
    share = other.share < share ? other.share : share;
    return *this;
  }
};

/// Linear momentum that a frame took from objects beyond what forces, constraints and contacts did. Of each substep and
/// group of objects the length of the sum over particles, added up [kg m/s].
struct LostMomentum {
  double filter = 0;  ///< by truncated steps, where something fixed acts on the objects: elsewhere they take none
  double guards = 0;  ///< by the guards of energy, which turn a share of the corrections into velocity
  double sleep = 0;   ///< by rigid bodies that fall asleep

  LostMomentum& operator+=(const LostMomentum& other) {
    filter += other.filter;
    guards += other.guards;
    sleep += other.sleep;
    return *this;
  }
};

/// The result of a step. A step never throws, except for exceptions of the user's force fields.
struct Report {
  std::int64_t frame = 0;
  double time = 0;
  double milliseconds = 0;
  /// Substeps of this frame, with those that Settings::most_substeps permits; the most of any object.
  int substeps = 0;
  std::vector<PhaseTime> phases;  ///< of sets that ran side by side the sum, which can exceed `milliseconds`
  std::int64_t contacts = 0;      ///< contacts with colliders and rigid bodies that were active in the last substep
  PairReport pairs;
  std::vector<Residual> residuals;         ///< filled if Settings::measure is set
  std::optional<Stretch> stretch;          ///< filled if Settings::measure is set
  IterationCount iterations;               ///< iterations per substep
  std::optional<Overstretch> overstretch;  ///< of this frame; empty if it was not completed; see Measurements::advice
  WorstOverstretch worst_overstretch;      ///< of this and earlier frames
  TieGap widest_tie;                       ///< of this frame, by gap / length; a warning says so if not tolerable
  std::vector<IterationResidual> convergence;  ///< last substep by iteration, if Settings::record_residuals is set
  Compression compression;                     ///< of liquids
  ViscositySolves viscosity;                   ///< of liquids
  TensionActs tension;                         ///< of liquids
  FlowReport flow;                             ///< of liquids and grains whose particles come and go
  LostMomentum lost_momentum;
  int sleeping_bodies = 0;                ///< rigid bodies that sleep at the end of the step (SleepOptions)
  int sleeping_grains = 0;                ///< grains that do
  std::vector<Torn> torn;                 ///< objects that tore or were cut, by object
  std::vector<JointBreak> broken_joints;  ///< joints that broke in this step, by object and index
  std::optional<NonFinite> nonfinite;
  bool stopped = false;  ///< true if World::stop_when ended the step before the frame was complete
  std::vector<std::string> warnings;
  ConvergenceEstimates estimates;  ///< by Resistance; of no kind if the frame was not completed
  WorstEstimates worst_estimates;  ///< of this and earlier frames

  bool ok() const { return !nonfinite; }
  std::string explain() const;  ///< problems and warnings as text; also says if nothing moved, as for an invalid dt
};

}  // namespace pliant
