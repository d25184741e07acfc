// An object compiled: particles in storage order, constraints in pools, and the schedule in which a sweep visits them.
//
// The schedule of one object knows nothing of another's, so that adding an object costs what that object costs.
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

/// Particles that one core holds in its own cache, and the constraints that are all among them.
struct Tile {
  int first_particle = 0, last_particle = 0;  ///< half open
  int first_segment = 0, last_segment = 0;
};

/// Up to sixteen paths of distance constraints, one a lane, longest first, that share no particle. Link k of every path is
/// a batch of the pool and a segment of its own: the paths walk in step, and memory is read forwards. Lanes whose path has
/// ended stay at its last particle: a link of length zero from it to itself, which is read and never written.
struct ChainBatch {
  int pool = 0;
  int first_segment = 0;
  int steps = 0;  ///< links of the longest path
};

/// Upper bounds of the distances to pins (long-range attachments: Kim, Chentanez, Mueller-Fischer 2012): sixteen particles
/// that follow one another are a batch; lane 4 L + j is particle 4 j + L of it, as in find_near.
struct Tethers {
  /// One tether of each particle of a batch.
  struct Row {
    std::int32_t anchor = 0;  ///< number in `anchors` for all lanes, or -1 where they differ
    std::int32_t lanes = 0;   ///< then: where its sixteen numbers stand in `lane_anchors`
  };
  int slots = 0;             ///< tethers a particle, at most
  std::vector<int> anchors;  ///< particles of zero inverse mass
  std::vector<Row> rows;     ///< slots x batches
  std::vector<std::int32_t> lane_anchors;
  AlignedVector<float> lengths;  ///< sixteen a row [m]; `no_tether` where a particle has none
};
inline constexpr float no_tether = 1e30f;

/// A particle whose place is given.
struct Kinematic {
  int particle = 0;  ///< in storage order
  Vec3f rest{};      ///< at time 0 [m]
  Motion motion;
};

/// The triangles of an object in storage order, and for each particle the triangles around it: what volume and air need.
struct Surface {
  std::vector<std::array<int, 3>> triangles;
  std::vector<int>
      corner_begin;  ///< particle p has corners corner_begin[p] .. corner_begin[p + 1]; empty without air and volume
  std::vector<int> corners;  ///< 3 * triangle + which corner, ascending
};

/// The global volume constraint of one object.
struct CompiledVolume {
  double target = 0;  ///< pressure times six rest volumes [m^3]
  double mass = 0;    ///< of the surface's free particles [kg]
  Law law = Law::compliant;
  float response = 0;  ///< alpha or k'
  float damping = 0;
};

/// A record of what compile() makes of one object, more than thirty members because each stage of a step reads a few of them.
struct CompiledObject {
  std::string name;
  Sweep sweep = Sweep::tiled;                 ///< that it is laid out for and solved by; never automatic
  int particles = 0;                          ///< targets of attachments included
  int user_particles = 0;                     ///< as the Object had
  std::vector<int> order;                     ///< order[storage] = user's number
  std::vector<int> place;                     ///< place[user's number] = storage
  std::vector<Record> positions, velocities;  ///< at the start; no velocities where all are at rest
  FrameRecords frames;                        ///< at the start, in the order of Object::frames
  std::vector<Pool> pools;
  std::vector<Segment>
      segments;  ///< tile after tile, then the inter-tile constraints, then the links of chains, then what is not in lanes
  std::vector<Tile> tiles;
  std::vector<ObjectPhase> phases;  ///< by driver, of each colour after colour
  std::vector<ChainBatch> chains;
  AlignedVector<float> chain_softness;  ///< sixteen a chain batch: added to the diagonal [1/kg]
  Tethers tethers;
  Multigrid multigrid;
  std::vector<Kinematic> kinematics;  ///< those that move
  Carrier carrier;                    ///< of a mesh collider: of all its particles
  Surface surface;
  std::vector<std::array<int, 2>> lines;  ///< distance constraints of an object without triangles, for contacts
  bool has_volume = false;
  CompiledVolume volume;
  bool self_collision = false, collides = false, is_collider = false;
  std::uint32_t groups = 1, mask = 0xffffffffu;
  float thickness = 0, static_friction = 0, kinetic_friction = 0, restitution = 0, drag = 0, lift = 0, damping = 0;
};

/// What the schedule depends on besides the object.
struct CompileOptions {
  int passes = 1;           ///< projections of a constraint in a frame: substeps x iterations, for k'
  int largest_tile = 2048;  ///< particles: as many as fit the shared memory of a thread block on any GPU
  /// `chains` and `multigrid` need data of their own; `natural` is one tile, one constraint after another: type by type, law by
  /// law, as they were given. All others are laid out alike.
  Sweep sweep = Sweep::tiled;
  bool tethers = false;
  float chain_softness = 0.1f;  ///< as in SweepOptions
  float tether_slack = 0;
  bool air = true;    ///< what forces of air need is made
  float gravity = 0;  ///< its magnitude, from which multigrid tells what an object carries [m/s^2]
};

/// A mesh collider as an object of particles without mass that follow its motion: to contacts it is one like any other.
CompiledObject compile(const MeshCollider& collider);

/// Compiles an object that inspect() finds nothing grave in. Throws Error naming an unknown constraint type or a stencil or
/// rest data of the wrong size.
CompiledObject compile(const Object& object, const CompileOptions& options);

}  // namespace pliant
