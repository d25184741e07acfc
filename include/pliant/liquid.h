// Liquids as particles.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pliant/scene.h"

namespace pliant {

/// What a real liquid is like at about 20 degrees Celsius.
struct LiquidKind {
  std::string name;
  float density = 1000;       ///< [kg/m^3]
  float viscosity = 0;        ///< dynamic [Pa s]
  float surface_tension = 0;  ///< towards air [N/m]
  std::string source;         ///< where the numbers come from
};

/// Returns a built-in liquid: "water", "oil", "glycerine" or "honey". For any other name throws an Error that lists the
/// names.
const LiquidKind& liquid(std::string_view name);

/// All built-in liquids.
const std::vector<LiquidKind>& liquids();

/// Options of make_liquid.
struct LiquidOptions {
  std::string name = "liquid";
  Fluid fluid{};
  Vec3f velocity{};  ///< at the start [m/s]
  Flow flow{};       ///< how particles come and go; `spare` follows from the capacity
  int capacity = 0;  ///< most particles that are there at a time, up to 2^26; 0: those at the start
};

/// The points of a cubic lattice that fill a box: as many as fit, centred, half a spacing from its faces.
/// Throws an Error if a size or the spacing is not positive and finite, or if there would be over 2^26 points.
std::vector<Vec3f> fill_box(const Vec3f& low, const Vec3f& high, float spacing);

/// The points of the lattice with which fill_box fills the mesh's box that lie inside a closed mesh, `clearance` or
/// more from its surface [m]. Without clearance there are as many as the enclosed volume holds, to a lattice's
/// rounding, and the outermost lie closer to the surface than half a spacing: for a vessel whose wall is the mesh, give
/// half the spacing. The inside is decided exactly. Throws an Error if the mesh is not closed or not finite, if no
/// point is inside, if a number is out of range, or if the box would have over 2^26 points.
std::vector<Vec3f> fill_mesh(const TriangleMesh& mesh, float spacing, float clearance = 0);

/// Displaces each point along each axis by a random length up to `most` [m]; the same seed gives the same points. The
/// columns of a lattice of grains stand on one another, and fall in layers; with a lattice 1.1 diameters apart and 0.05
/// diameters as `most` they do not, and none overlap. Throws an Error if `most` is negative or not finite.
std::vector<Vec3f> jittered(std::vector<Vec3f> points, float most, int seed = 0);

/// The particles for which leave_out_solids makes room.
struct LeaveOutOptions {
  float radius = 0;  ///< of a particle: half the spacing of a liquid or gas, the radius of grains [m]
  std::uint32_t groups = 1, mask = ~0u;  ///< bit masks of their object, as in Object
  bool collides = true;                  ///< Object::collides of their object; false: they meet colliders alone
};

/// How many places were left out, because they lie in an object or collider.
struct PlacesInSolid {
  std::string in;  ///< its name
  int places = 0;
};

/// Removes the places at which the ball of a particle would overlap what is solid in a scene at the start: colliders,
/// rigid bodies, soft bodies, distance grids, terrain, and what other closed surfaces enclose, unless all places lie
/// inside such a surface, which is then their vessel. What groups, masks and `collides` let them pass is not solid.
/// Overlaps below a hundredth of the radius are kept, so that a lattice may touch a wall. Returns what was left out, in
/// the order of the places; a place in several solids counts once. Throws an Error if the radius is not positive and
/// finite.
std::vector<PlacesInSolid> leave_out_solids(std::vector<Vec3f>& places, const Scene& scene,
                                            const LeaveOutOptions& options);

/// Makes a liquid of particles at given places, about a spacing apart. Each has the mass of a cube of that side, and
/// touches colliders at half the spacing, without friction. Throws an Error that names an option that is out of range.
Object make_liquid(const std::vector<Vec3f>& positions, const LiquidOptions& options = {});

}  // namespace pliant
