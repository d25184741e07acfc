// Elastic rods: wires, cables, springs, whips, stalks. A rod resists stretching, shearing, bending and twisting.
//
//   std::vector<Vec3f> points;
//   for (int i = 0; i <= 20; ++i) points.push_back({0.05f * i, 1, 0});
//   scene.objects.push_back(make_rod(points, {.material = rod_material("steel wire"), .radius = 0.001f, .start = {.kind = RodEnd::Kind::clamped}}));
//
// Between each two points is a rigid body, a segment, which is a capsule; a joint joins each two neighbours. This is
// the Cosserat rod in the form of Deul, Kugelstadt, Weiler and Bender 2018: joints whose stiffness follows from the
// material, all of them solved directly along the rod, so a stiff rod costs as much as a soft one. Segments touch
// whatever bodies touch.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pliant/scene.h"

namespace pliant {

/// Properties of what a rod is made of. They do not depend on its radius or its points.
struct RodMaterial {
  std::string name;
  float density = 1000;           ///< mass per volume, > 0 [kg/m^3]
  float youngs_modulus = 1e7f;    ///< stress per strain of stretching and bending, > 0 [Pa]
  float shear_modulus = 3.5e6f;   ///< stress per strain of twisting and shearing, > 0 [Pa]
  float damping = 0;              ///< stress over elastic modulus and rate of strain [s]
  float static_friction = 0.4f;   ///< coefficient of friction at rest [-]
  float kinetic_friction = 0.3f;  ///< coefficient of friction while sliding [-]
  std::string source;             ///< where the numbers come from
  /// Strain at the surface of a bent or twisted rod beyond which it stays so, and how fast that flows; none: elastic.
  std::optional<Plasticity> plasticity{};
  /// Its resistance to bending and twisting over that of a solid rod: less in a rope or cable, whose strands slide on
  /// each other, 0..1 [-]
  float bending_share = 1;
};

/// Returns a built-in material: "steel wire", "copper wire", "nylon line", "hair", "rubber cord", "bamboo" or "rope".
/// For any other name throws an Error that lists the names.
const RodMaterial& rod_material(std::string_view name);

/// All built-in materials of rods.
const std::vector<RodMaterial>& rod_materials();

/// Stiffness of a cross-section. stiffness_of computes that of a round one.
struct RodStiffness {
  float stretch = 0;    ///< E A: force per strain [N]
  float shear = 0;      ///< force per angle of shear [N]
  float bending = 0;    ///< E I: moment per curvature, about the first axis across [N m^2]
  float bending_2 = 0;  ///< about the second axis across, which is perpendicular to the first; 0: as `bending` [N m^2]
  float twist = 0;      ///< G J: torque per rate of twist [N m^2]
};

/// Returns the stiffness of a round cross-section: E pi r^2, 0.9 G pi r^2, and bending_share times E pi r^4 / 4 and G
/// pi r^4 / 2. The factor of shear is Timoshenko's.
RodStiffness stiffness_of(const RodMaterial& material, float radius);

/// How an end of a rod is held.
struct RodEnd {
  enum class Kind {
    free,
    ball,     ///< its position is held; it rotates freely
    clamped,  ///< its position and direction are held, and it does not twist
  } kind = Kind::free;
  int body = -1;  ///< index in Object::bodies of what holds it; -1: the world
};

/// Options of make_rod and add_rod.
struct RodOptions {
  std::string name = "rod";  ///< segments are called "rod 0", "rod 1", ...; the joint between them "rod 0-1"
  RodMaterial material{};
  float radius = 0.005f;  ///< > 0 [m]
  float end_radius = 0;   ///< at the last point, if the rod tapers from `radius` at the first one; 0: it does not [m]
  /// Instead of that of the material and the radius: of a flat, hollow or stranded cross-section. Not for a rod that
  /// tapers.
  std::optional<RodStiffness> stiffness{};
  /// Direction across the rod about which `bending` acts at its start; from there it follows the rod without twisting.
  /// Any, if bending is the same about both.
  std::optional<Vec3f> across{};
  /// True: the rest shape is straight, whatever the points. False: the points are the rest shape.
  bool straight = false;
  RodEnd start{}, end{};
  Vec3f velocity{};        ///< at the start [m/s]
  float break_force = 0;   ///< it breaks where it carries most, if that is a greater force; 0: never [N]
  float break_torque = 0;  ///< or a greater torque; 0: never [N m]
};

/// Adds a rod through three points or more to an object, and returns the index of its first segment in Object::bodies;
/// the others follow. Throws an Error that names a point or an option that is out of range. Points that are nearer to
/// each other than 2.25 radii are refused, since segments would touch where they do not meet.
int add_rod(Object& object, const std::vector<Vec3f>& points, const RodOptions& options = {});

/// Makes an object of one rod.
Object make_rod(const std::vector<Vec3f>& points, const RodOptions& options = {});

/// Points of a helix about the y-axis, from the origin's height upwards: a coil spring.
std::vector<Vec3f> helix(float radius, float height, float turns, int segments);

}  // namespace pliant
