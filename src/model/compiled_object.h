// An object compiled: particles in storage order, constraints in pools, and the schedule in which a sweep visits them.
//
// The schedule of one object knows nothing of another's, so that adding an object costs what that object costs.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "model/pool.h"
#include "pliant/scene.h"
#include "pliant/world.h"

namespace pliant {

/// Particles that one core holds in its own cache, and the constraints that are all among them.
struct Tile {
  int first_particle = 0, last_particle = 0;  ///< half open
  int first_segment = 0, last_segment = 0;
};

/// A stretch of segments that share no particle: those of one colour that straddle tiles.
struct StraddlerColour {
  int first_segment = 0, last_segment = 0;
};

/// A particle whose place is given.
struct Kinematic {
  int particle = 0;  ///< in storage order
  Vec3f rest{};      ///< at time 0 [m]
  Motion motion;
};

/// The triangles of an object in storage order, and for each particle the triangles around it: what volume and air need.
struct Surface {
  std::vector<std::array<int, 3>> triangles;
  std::vector<int> corner_begin;  ///< particle p has corners corner_begin[p] .. corner_begin[p + 1]
  std::vector<int> corners;       ///< 3 * triangle + which corner, ascending
};

/// The global volume constraint of one object.
struct CompiledVolume {
  double target = 0;  ///< pressure times six rest volumes [m^3]
  double mass = 0;    ///< of the surface's free particles [kg]
  Law law = Law::compliant;
  float response = 0;  ///< alpha or k'
  float damping = 0;
};

struct CompiledObject {
  std::string name;
  int particles = 0;       ///< targets of attachments included
  int user_particles = 0;  ///< as the Object had
  std::vector<int> order;  ///< order[storage] = user's number
  std::vector<int> place;  ///< place[user's number] = storage
  std::vector<Record> positions, velocities;
  std::vector<Pool> pools;
  std::vector<Segment> segments;  ///< tile after tile, then the straddlers
  std::vector<Tile> tiles;
  std::vector<StraddlerColour> straddlers;
  std::vector<Kinematic> kinematics;  ///< those that move
  Surface surface;
  bool has_volume = false;
  CompiledVolume volume;
  float thickness = 0, static_friction = 0, kinetic_friction = 0, restitution = 0, drag = 0, lift = 0, damping = 0;
};

/// What the schedule depends on besides the object.
struct CompileOptions {
  int passes = 1;           ///< projections of a constraint in a frame: substeps x iterations, for k'
  int largest_tile = 4096;  ///< particles
};

/// Compiles an object that inspect() finds nothing grave in. Throws Error naming an unknown constraint type or a stencil or
/// rest data of the wrong size.
CompiledObject compile(const Object& object, const CompileOptions& options);

}  // namespace pliant
