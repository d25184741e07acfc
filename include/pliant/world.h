// A World is a Scene compiled, with the State that moves. Data runs one way: step, then read.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "pliant/mesh.h"
#include "pliant/scene.h"

namespace pliant {

/// Four floats in one 16-byte record, moved by whole loads.
struct alignas(16) Record {
  float x = 0, y = 0, z = 0, w = 0;
};

/// Allocates at the start of a cache line, so that four records are one line.
template <class T>
struct CacheLineAllocator {
  using value_type = T;
  CacheLineAllocator() = default;
  template <class U>
  CacheLineAllocator(const CacheLineAllocator<U>&) {}  // NOLINT(google-explicit-constructor): as allocators must
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new (n * sizeof(T), std::align_val_t{64})); }
  void deallocate(T* p, std::size_t) { ::operator delete (p, std::align_val_t{64}); }
  friend bool operator==(const CacheLineAllocator&, const CacheLineAllocator&) { return true; }
};

using Records = std::vector<Record, CacheLineAllocator<Record>>;

/// What is known of the orientations of a State, one record a frame.
struct FrameRecords {
  Records orientations;        ///< unit quaternion from the frame's principal axes to the world
  Records angular_velocities;  ///< along the frame's own axes [rad/s], w zero
  Records inverse_inertias;    ///< about the frame's own axes [1/(kg m^2)], w zero; never changes

  std::size_t size() const { return orientations.size(); }
};

/// A number or a vector for every particle that a kind of matter owns, such as a temperature.
struct Channel {
  std::string name;
  int components = 1;         ///< of each particle
  std::vector<float> values;  ///< components x particles, in the order of the State
};

/// All that changes as time passes, a plain value: copy it, hash it, put it back, and the next step gives the same bits.
/// Particles stand in the order of the compiled model, not of the user; read places through World.
struct State {
  double time = 0;                ///< [s]
  std::int64_t frame = 0;         ///< steps taken
  Records positions;              ///< (x, y, z) [m], w the inverse mass [1/kg]
  Records remainders;             ///< what a float position could not hold of the motion so far [m]
  Records velocities;             ///< [m/s]
  FrameRecords frames;            ///< object after object, as the particles are; mostly empty
  std::vector<Channel> channels;  ///< mostly none
};

/// SHA-256 over every member of a State, as 64 hexadecimal digits. Frames and channels count where there are any.
std::string hash(const State& state);

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
  int object = -1;                         ///< with the largest; -1: there are no such constraints
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

/// What was compiled for one object.
struct ObjectInfo {
  std::string name;
  int particles = 0;
  std::vector<std::pair<std::string, std::int64_t>> constraints;  ///< by type, "volume" included
};

/// A solve is called good where no distance is longer than its force explains by more than this [-].
inline constexpr double tolerated_overstretch = 0.01;

/// More than thirty members: it is the one object that a user steps and reads.
class World {
 public:
  /// Compiles a scene. Throws Error naming the object, the element and what to do where it can't be simulated.
  explicit World(const Scene& scene);
  World(const Scene& scene, const Settings& settings);
  ~World();
  World(World&&) noexcept;
  World& operator=(World&&) noexcept;

  /// Advances by dt seconds (finite, > 0, substeps of 1e-12 s or more; else nothing moves and the Report says so). After a
  /// non-finite value the World stops in the midst of the frame, its state made finite, and refuses to step (a Report whose
  /// `nonfinite` names no object) until it is restored; so it does where a force field throws. Keep dt even: constraints
  /// leave an error that belongs to their step, and a much shorter one after it turns what it mends into speed.
  Report step(float dt);

  /// From now on a step looks at the flag after each substep, and ends there where it is true, with Report::stopped: the State
  /// is that at the end of the substep, `time` with it, and the frame does not count. A flag that is true before a step lets
  /// nothing move. Another thread or a signal handler may set it. It must outlive the World or be taken back by nullptr.
  void stop_when(const std::atomic<bool>* flag);

  const State& state() const;
  /// Puts a state of this World back. Throws Error where it does not fit. Multipliers read as zero until the next step.
  void restore(const State& state);
  std::string state_hash() const { return hash(state()); }

  int object_count() const;
  ObjectInfo info(int object) const;
  const Settings& settings() const;
  std::string isa() const;  ///< the code path in use: "x86-64-v2", "-v3", "-v4" or "generic"
  int threads() const;

  /// In the object's own numbering.
  std::vector<Vec3f> positions(int object) const;
  std::vector<Vec3f> velocities(int object) const;
  /// Of the object's frames, in the order of Object::frames.
  std::vector<Quatf> orientations(int object) const;
  std::vector<Vec3f> angular_velocities(int object) const;  ///< in world axes [rad/s]
  TriangleMesh mesh(int object) const;
  /// Where a collider is now.
  Vec3f collider_position(int collider) const;
  Quatf collider_rotation(int collider) const;
  /// Where the vertices of a mesh collider are now, in its own numbering [m]. Throws Error where there is no such collider.
  std::vector<Vec3f> mesh_collider_positions(int collider) const;

  /// Multipliers of the last substep in the order of the object's constraint groups of that type, row by row; empty where they were not
  /// kept. The force is lambda / h^2 along the gradient (XPBD, eq. 17).
  std::vector<float> multipliers(int object, const std::string& type) const;

  /// Kinetic and gravitational energy of all free particles [J]; heights from the origin.
  double kinetic_energy() const;
  double potential_energy() const;
  std::vector<Residual> residuals() const;
  Stretch stretch() const;
  /// Compliant constraints count in full where their multipliers are kept, as Settings::measure has it.
  Overstretch overstretch() const;
  /// "object 'sheet': stretched 14 % too far at its pins (edge 12-13), 1 edge in 100 by 3 % or more"; empty without object.
  std::string describe(const Overstretch& found) const;
  /// Where the solve fell short in the step of a Report with Settings::measure, by how much, and what to do; empty where
  /// it did not, by no more than `tolerated_overstretch`. `advise` tries what helps.
  std::string advice(const Report& report) const;
  double enclosed_volume(int object) const;  ///< of its triangles [m^3]

 private:
  struct Implementation;
  std::unique_ptr<Implementation> self_;
};

}  // namespace pliant
