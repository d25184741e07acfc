// A compiled object: particles in storage order, constraints in pools, and the schedule in which a sweep visits them.
//
// The schedule of an object depends on no other object, and so does the cost of adding one.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "model/carrier.h"
#include "model/changing_rest.h"
#include "model/compiled_absorbency.h"
#include "model/compiled_bodies.h"
#include "model/compiled_clusters.h"
#include "model/compiled_joints.h"
#include "model/held_particles.h"
#include "model/multigrid.h"
#include "model/object_sets.h"
#include "model/phase.h"
#include "model/pool.h"
#include "model/sheet_bending.h"
#include "pliant/kept_schedule.h"
#include "pliant/scene.h"
#include "pliant/state.h"

namespace pliant {

/// A set of particles that fits one core's cache, with the constraints that act only on them.
struct Tile {
  int first_particle = 0, last_particle = 0;  ///< range of particles, half-open
  int first_segment = 0, last_segment = 0;
};

/// Up to sixteen paths of distance constraints that share no particle, one per lane, longest first. Link k of all paths
/// is one batch and one segment, so the paths advance together and memory is read sequentially. Where a path has ended,
/// its lane repeats its last particle as a link of length zero, which is read, but never written.
struct ChainBatch {
  int pool = 0;
  int first_segment = 0;
  int steps = 0;  ///< number of links of the longest path
};

/// Upper bounds of the distances to pins (long-range attachments: Kim, Chentanez, Mueller-Fischer 2012). A batch is
/// sixteen consecutive particles; lane 4 L + j has particle 4 j + L, as in StepKernels::find_near.
struct Tethers {
  /// One tether for each particle of a batch.
  struct Row {
    std::int32_t anchor = 0;  ///< index in `anchors` for all lanes; -1 if they differ
    std::int32_t lanes = 0;   ///< if anchors differ: offset of sixteen indices in `lane_anchors`
  };
  int slots = 0;             ///< maximum number of tethers per particle
  std::vector<int> anchors;  ///< particles of zero inverse mass, in storage order
  std::vector<Row> rows;     ///< `slots` rows for each batch
  std::vector<std::int32_t> lane_anchors;
  AlignedVector<float> lengths;  ///< sixteen lengths per row [m]; `no_tether` for a particle without one
};
inline constexpr float no_tether = 1e30f;

/// A particle that follows a given motion.
struct Kinematic {
  int particle = 0;  ///< index of the particle in storage order
  Vec3f rest{};      ///< position of the particle at time 0 [m]
  Motion motion;
};

/// The triangles of an object in storage order and the triangles at each particle, for volume and aerodynamic forces.
struct Surface {
  std::vector<std::array<int, 3>> triangles;
  /// Particle p has corners corner_begin[p] .. corner_begin[p + 1]; empty without air and volume.
  std::vector<int> corner_begin;
  std::vector<int> corners;  ///< 4 * triangle + number of the corner, ascending for each particle
};

/// The global volume constraint of one object.
struct CompiledVolume {
  double target = 0;   ///< pressure times six rest volumes [m^3]
  double at_rest = 0;  ///< six rest volumes [m^3]
  Volume described;    ///< whose pressure may change
  double mass = 0;     ///< total mass of the surface's dynamic particles [kg]
  Law law = Law::compliant;
  float response = 0;  ///< compliance alpha or PBD stiffness k'
  float damping = 0;
  float lift = 0;  ///< Volume::lift [kg/m^3]
  /// True: its own constraints may not turn or move the object as a whole (solver/momentum.h)
  bool keeps_momentum = false;

  /// The target at a time [s].
  double target_at(double time) const;
};

/// A range of segments, some of which hold distance constraints: a task of loops that only measure these.
struct LengthRange {
  int first = 0, last = 0;       ///< segments, half-open
  int batches = 0;               ///< of distances
  std::int64_t constraints = 0;  ///< with a rest length above zero, a multiplier, and a free particle
};

/// What edits added to an object whose schedule was kept (model/keep_schedule.h).
struct Additions {
  bool are_used = false;   ///< true: the schedule was kept
  int first_particle = 0;  ///< in storage; as many as there are particles if none were added
  /// 1 for each segment of constraints that were coloured by an edit; may be shorter than all.
  std::vector<char> segments;
};

/// The output of compile(). It has over thirty members, because each stage of a step reads a few of them.
struct CompiledObject {
  std::string name;
  Sweep sweep = Sweep::tiled;                 ///< sweep that it is compiled for, never `automatic`
  int particles = 0;                          ///< number of particles, with the targets of attachments
  int user_particles = 0;                     ///< number of particles, without the targets of attachments
  std::vector<int> order;                     ///< order[storage index] = user's index
  std::vector<int> place;                     ///< place[user's index] = storage index; the inverse of `order`
  std::vector<Record> positions, velocities;  ///< initial positions and velocities; no velocities if all are zero
  FrameRecords frames;                        ///< initial values of the frames, in the order of Object::frames
  CompiledBodies bodies;
  std::vector<CompiledJoint> joints;  ///< in the order of Object::joints
  std::vector<Pool> pools;
  /// Of tiles, then inter-tile constraints, then links of chains, then constraints projected one at a time.
  std::vector<Segment> segments;
  std::vector<Tile> tiles;
  std::vector<ObjectPhase> phases;  ///< phases sorted by driver; those of one driver by colour
  std::vector<ChainBatch> chains;
  AlignedVector<float> chain_softness;  ///< sixteen per ChainBatch: regularisation added to the diagonal [1/kg]
  std::vector<LengthRange> lengths;     ///< all distance constraints
  ChangingRest changing;
  CompiledClusters clusters;
  Tethers tethers;
  Multigrid multigrid;
  SheetBending sheet;                 ///< bending of a flat sheet, in place of its hinges
  std::vector<Kinematic> kinematics;  ///< particles with keyframes
  HeldParticles held;                 ///< by attachments
  Carrier carrier;                    ///< motion of all particles of a mesh collider
  Surface surface;
  std::vector<std::array<int, 2>> lines;  ///< contact lines of an object without triangles
  std::optional<Fluid> fluid;             ///< its particles are a liquid
  std::optional<Grains> grains;           ///< its particles are grains
  std::optional<Gas> gas;                 ///< its liquid is a gas
  std::optional<Tracers> tracers;         ///< its particles are tracers
  CompiledAbsorbency absorbency;
  Flow flow;                         ///< how its particles come and go
  std::vector<EmitterLayer> layers;  ///< of flow.emitters
  float emitted_size = 0;            ///< smallest distance of a particle that is emitted from others [m]
  float emitted_jitter = 0;          ///< by how much it is off its place along each axis, at most [m]
  bool has_volume = false;
  CompiledVolume volume;
  std::vector<KeptSchedule::Fan> fans;  ///< of tetrahedra whose volumes are joined, by number of their constraint
  Additions additions;
  bool self_collision = false, collides = false, is_collider = false;
  int own_substeps = 0;  ///< own_substeps() of model/object_sets.h; 0: a collider
  SubstepRule substep_rule = SubstepRule::any;
  GrainHeights grain_heights;
  std::uint32_t groups = 1, mask = 0xffffffffu;
  float thickness = 0, static_friction = 0, kinetic_friction = 0, restitution = 0, drag = 0, lift = 0, damping = 0;
  float rolling_friction = 0, spinning_friction = 0;  ///< of bodies [m]
  Vec3f surface_velocity{};                           ///< of a mesh collider [m/s]
};

/// Data apart from the object on which its schedule depends.
struct CompileOptions {
  int passes = 1;           ///< projections of each constraint per frame (substeps x iterations), which determine k'
  int largest_tile = 2048;  ///< most particles of a tile; that many fit the shared memory of a thread block on any GPU
  /// `chains` and `multigrid` need additional data. `natural` has a single tile and keeps the given order: by type,
  /// then law, then index. Other sweeps differ in nothing.
  Sweep sweep = Sweep::tiled;
  bool tethers = false;
  float chain_softness = 0.1f;  ///< SweepOptions::chain_softness
  float tether_slack = 0;
  bool air = true;               ///< true: prepare the data for aerodynamic forces
  float gravity = 0;             ///< magnitude of gravity, from which multigrid estimates the load on an object [m/s^2]
  bool is_blown = false;         ///< blows() of model/object_sets.h
  double frame_time = 1.0 / 60;  ///< Scene::frame_time [s]
  int iterations = 1;            ///< of the `passes`
  bool names_substeps = true;    ///< false: substeps may follow the State
  bool keeps_energy = false;     ///< Settings::Integrator::energy
};

/// Compiles a mesh collider to an object of kinematic particles, so that contact treats it like any other object.
CompiledObject compile(const MeshCollider& collider);

/// Compiles an object for which inspect() reports nothing grave. Throws an Error that names an unknown constraint type,
/// or a constraint group whose particles or rest data have the wrong size. With a schedule that an edit left
/// (model/keep_schedule.h) it makes only what is missing; throws an Error if that does not fit.
CompiledObject compile(const Object& object, const CompileOptions& options, const KeptSchedule* kept = nullptr);
/// Compiles an object with less memory: its constraints may be moved out of it.
CompiledObject compile(Object&& object, const CompileOptions& options);

}  // namespace pliant
