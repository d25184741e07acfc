// A compiled object: particles in storage order, constraints in pools, and the schedule in which a sweep visits them.
//
// Schedules are independent of other objects, so the cost of adding an object depends on that object alone.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "model/carrier.h"
#include "model/multigrid.h"
#include "model/phase.h"
#include "model/pool.h"
#include "pliant/scene.h"
#include "pliant/state.h"

namespace pliant {

/// A set of particles that fits one core's cache, and the constraints among them.
struct Tile {
  int first_particle = 0, last_particle = 0;  ///< half open
  int first_segment = 0, last_segment = 0;
};

/// Up to sixteen paths of distance constraints without a common particle, one per lane, longest first. Link k of all
/// paths is one batch and one segment, so the paths advance in step and memory is read sequentially. Where a path has
/// ended, its lane repeats its last particle as a link of length zero, which is read but never written.
struct ChainBatch {
  int pool = 0;
  int first_segment = 0;
  int steps = 0;  ///< links of the longest path
};

/// Upper bounds of the distances to pins (long-range attachments: Kim, Chentanez, Mueller-Fischer 2012). Sixteen
/// consecutive particles are a batch; lane 4 L + j holds particle 4 j + L of it, as in find_near.
struct Tethers {
  /// One tether of each particle of a batch.
  struct Row {
    std::int32_t anchor = 0;  ///< index in `anchors` for all lanes; -1 if they differ
    std::int32_t lanes = 0;   ///< if they differ: offset of the sixteen indices in `lane_anchors`
  };
  int slots = 0;             ///< maximum number of tethers per particle
  std::vector<int> anchors;  ///< particles of zero inverse mass
  std::vector<Row> rows;     ///< slots x batches
  std::vector<std::int32_t> lane_anchors;
  AlignedVector<float> lengths;  ///< sixteen per row [m]; `no_tether` for a particle without one
};
inline constexpr float no_tether = 1e30f;

/// A particle that follows a given motion.
struct Kinematic {
  int particle = 0;  ///< in storage order
  Vec3f rest{};      ///< at time 0 [m]
  Motion motion;
};

/// The triangles of an object in storage order, and the triangles incident to each particle, as volume and air need them.
struct Surface {
  std::vector<std::array<int, 3>> triangles;
  std::vector<int>
      corner_begin;  ///< particle p has corners corner_begin[p] .. corner_begin[p + 1]; empty without air and volume
  std::vector<int> corners;  ///< 3 * triangle + which corner, ascending
};

/// The global volume constraint of one object.
struct CompiledVolume {
  double target = 0;  ///< pressure times six rest volumes [m^3]
  double mass = 0;    ///< total mass of the surface's dynamic particles [kg]
  Law law = Law::compliant;
  float response = 0;  ///< alpha or k'
  float damping = 0;
};

/// The output of compile(). It has over thirty members, because each stage of a step reads a few of them.
struct CompiledObject {
  std::string name;
  Sweep sweep = Sweep::tiled;                 ///< the sweep that it is compiled for; never automatic
  int particles = 0;                          ///< including the targets of attachments
  int user_particles = 0;                     ///< excluding the targets of attachments
  std::vector<int> order;                     ///< order[storage] = user's number
  std::vector<int> place;                     ///< place[user's number] = storage
  std::vector<Record> positions, velocities;  ///< at the start; velocities are empty if all are zero
  FrameRecords frames;                        ///< at the start, in the order of Object::frames
  std::vector<Pool> pools;
  std::vector<Segment>
      segments;  ///< of tiles, then inter-tile constraints, then links of chains, then constraints projected one at a time
  std::vector<Tile> tiles;
  std::vector<ObjectPhase> phases;  ///< sorted by driver; those of one driver by colour
  std::vector<ChainBatch> chains;
  AlignedVector<float> chain_softness;  ///< sixteen per chain batch: regularisation added to the diagonal [1/kg]
  Tethers tethers;
  Multigrid multigrid;
  std::vector<Kinematic> kinematics;  ///< particles with keyframes
  Carrier carrier;                    ///< of a mesh collider: the motion of all its particles
  Surface surface;
  std::vector<std::array<int, 2>> lines;  ///< distance constraints of an object without triangles, for contacts
  bool has_volume = false;
  CompiledVolume volume;
  bool self_collision = false, collides = false, is_collider = false;
  int own_substeps = 0;  ///< own_substeps() of model/object_sets.h; 0 for a collider
  std::uint32_t groups = 1, mask = 0xffffffffu;
  float thickness = 0, static_friction = 0, kinetic_friction = 0, restitution = 0, drag = 0, lift = 0, damping = 0;
};

/// What the schedule depends on besides the object.
struct CompileOptions {
  int passes = 1;           ///< projections of each constraint per frame (substeps x iterations), from which k' follows
  int largest_tile = 2048;  ///< in particles; a tile of this size fits the shared memory of a thread block on any GPU
  /// `chains` and `multigrid` add data of their own. `natural` has one tile and keeps the given order: by type, then
  /// law, then index. All other sweeps have the same layout.
  Sweep sweep = Sweep::tiled;
  bool tethers = false;
  float chain_softness = 0.1f;  ///< as in SweepOptions
  float tether_slack = 0;
  bool air = true;    ///< prepare the data for aerodynamic forces
  float gravity = 0;  ///< magnitude, from which multigrid estimates the load on an object [m/s^2]
};

/// Compiles a mesh collider to an object of kinematic particles, so that contact treats it like any other object.
CompiledObject compile(const MeshCollider& collider);

/// Compiles an object for which inspect() reports nothing grave. Throws an Error that names an unknown constraint type,
/// or a stencil or rest data of the wrong size.
CompiledObject compile(const Object& object, const CompileOptions& options);
/// The same in less memory: the object may lose its constraints.
CompiledObject compile(Object&& object, const CompileOptions& options);

}  // namespace pliant
