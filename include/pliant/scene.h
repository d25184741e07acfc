// A Scene is a description: plain data that a World compiles. It does not change over time.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "pliant/formula.h"
#include "pliant/material.h"
#include "pliant/mesh.h"
#include "pliant/motion.h"
#include "pliant/vec3.h"

namespace pliant {

// ---------------------------------------------------------------- deformable objects

/// Constraints of one type among the particles of one object. `type` is a name from constraint_types().
struct ConstraintGroup {
  std::string type;            ///< "distance", "dihedral_bending", "isometric_bending", ...
  std::vector<int> particles;  ///< stencil after stencil: slots x number of constraints; a frame slot holds a frame's index
  std::vector<float> rest;     ///< rest data, fields x number of constraints; empty: measured from the positions
  Stiffness stiffness{};       ///< stiffness of every constraint in the group
  std::vector<float> compliances;  ///< one alpha per constraint instead of stiffness.value; empty: all equal
};

/// The description of a constraint type.
struct ConstraintType {
  std::string name;
  int stencil_size;                      ///< number of slots
  std::vector<std::string> rest_fields;  ///< names of its rest data, with units in docs/reference/constraints.md
  std::vector<SlotKind> slots;           ///< what each index of a stencil refers to: a particle, or one of Object::frames
  int rows;                              ///< components of C
};

/// Every constraint type that a ConstraintGroup may name: built-in types, then registered ones (pliant/constraint.h).
const std::vector<ConstraintType>& constraint_types();

/// The volume of a closed mesh, held at `pressure` times its rest volume: C = sum (x1 x x2) . x3 - pressure * 6 V0.
/// Mueller et al. 2007, section 4.4.2.
struct Volume {
  float pressure = 1;     ///< k_pressure >= 0 [-]
  Stiffness stiffness{};  ///< compliance in m^5/N for C as written, which is six volumes
};

/// A kinematic particle: it has infinite mass and follows `motion` from its rest position.
struct Pin {
  int particle = 0;
  Motion motion{};
};

/// Ties a particle to a moving target by a distance constraint of rest length 0.
struct Attachment {
  int particle = 0;
  Vec3f target{};  ///< position of the target at time 0 [m]
  Motion motion{};
  Stiffness stiffness{};
};

/// The method that projects constraints: the order in which it visits them, and what it solves at once.
enum class Sweep {
  automatic,   ///< the default: the sweep that measured best on scenes of this kind, see chosen_sweep
  tiled,       ///< coloured Gauss-Seidel in tiles, sixteen constraints at a time, on all threads
  sequential,  ///< the scalar reference of `tiled`: one constraint at a time in the same order, with the same bits
  symmetric,   ///< `tiled` forward, then backward: one iteration projects every constraint twice
  jacobi,      ///< all constraints from the same positions; the corrections of each particle are then combined
  natural,     ///< Gauss-Seidel in the user's order, one constraint at a time: slow, for comparison
  chains,      ///< direct solves along paths of distance constraints; all other constraints as in `tiled`
  multigrid,   ///< a multigrid correction of all distances, then `tiled` twice: for fine meshes
};

/// An orientation with inertia. A particle and a frame make a rigid body; constraints join frames by their frame slots.
struct ObjectFrame {
  Quatf orientation{};       ///< rotation from the principal axes to the world, of unit length
  Vec3f angular_velocity{};  ///< initial angular velocity in world axes [rad/s]
  Vec3f inertia{1, 1, 1};    ///< moments about its principal axes, > 0; infinity locks that axis [kg m^2]
};

/// Particles with their constraints. Over fifteen members: an object's whole description. See make_cloth, make_rope.
struct Object {
  std::string name;
  std::vector<Vec3f> positions;     ///< also the rest shape [m]
  std::vector<Vec3f> velocities;    ///< empty: at rest [m/s]
  std::vector<float> masses;        ///< one per particle, > 0, or infinity for a fixed one [kg]
  std::vector<ObjectFrame> frames;  ///< for constraints with frame slots
  std::vector<ConstraintGroup> constraints;
  std::vector<std::array<int, 3>> triangles;  ///< the surface, for air, volume and pictures; may be empty
  std::optional<Volume> volume;               ///< needs a closed surface
  std::vector<Pin> pins;
  std::vector<Attachment> attachments;
  float thickness = 0.001f;        ///< distance kept from colliders; two surfaces keep the sum of both [m]
  bool self_collision = false;     ///< the surface does not pass through itself; without triangles, the links do not
  bool collides = false;           ///< the surface does not pass through other objects with `collides`
  std::uint32_t groups = 1;        ///< bit mask of the groups that it belongs to
  std::uint32_t mask = ~0u;        ///< groups that it meets: each one's mask must contain a group of the other
  float static_friction = 0.4f;    ///< [-]
  float kinetic_friction = 0.3f;   ///< [-], <= static_friction
  float restitution = 0;           ///< 0..1 [-]
  float drag = 1.2f;               ///< drag coefficient of a triangle perpendicular to the wind [-]
  float lift = 0.8f;               ///< [-]
  Sweep sweep = Sweep::automatic;  ///< the sweep of its constraints; automatic: see chosen_sweep
  float damping = 0;               ///< each substep divides velocities by 1 + h damping, about exp(-damping) a second [1/s]
  Vec3f colour{0.75f, 0.35f, 0.30f};  ///< linear RGB, 0..1
};

/// Options of make_cloth.
struct ClothOptions {
  std::string name = "cloth";
  Fabric material{};
  std::optional<Stiffness> stretch{};  ///< overrides the material's
  std::optional<Stiffness> bending{};  ///< overrides the material's
  enum class Bending { none, dihedral, isometric } bending_model = Bending::dihedral;
  std::optional<Volume> volume{};  ///< makes it a balloon; needs a closed mesh
  Vec3f velocity{};                ///< initial [m/s]
};

/// Cloth from any triangle mesh, flat or curved, which is its rest shape: a distance constraint per edge, a bending
/// constraint per inner edge, a third of each triangle's mass per corner. Without overrides the compliance of an edge is
/// L^2 / (Y (A1 + A2)) (Van Gelder 1998), that of a hinge (A1 + A2) / (|e|^2 B) or, isometric, 3/B: independent of the
/// mesh. Throws an Error that names the unusable triangle or edge.
Object make_cloth(const TriangleMesh& mesh, const ClothOptions& options = {});

/// Options of make_rope.
struct RopeOptions {
  std::string name = "rope";
  float linear_density = 0.05f;  ///< [kg/m]
  Stiffness stretch{};
  Stiffness bending = Stiffness::compliance(1);  ///< distance between second neighbours; used if `bends`
  bool bends = false;
  float thickness = 0.005f;  ///< radius [m]
};

/// A rope through `points` (two or more, adjacent ones distinct). Each end of a link gets half of its mass.
Object make_rope(const std::vector<Vec3f>& points, const RopeOptions& options = {});

// ---------------------------------------------------------------- colliders

struct Plane {};  ///< the half-space y <= 0 of its frame is solid
struct Sphere {
  float radius = 0.5f;
};  ///< [m]
struct Capsule {
  float radius = 0.25f, half_length = 0.5f;
};  ///< a solid capsule along the y-axis of its frame; half_length excludes the caps [m]
struct Box {
  Vec3f half_extents{0.5f, 0.5f, 0.5f};
};  ///< [m]
using Shape = std::variant<Plane, Sphere, Capsule, Box>;

/// A static solid, or a kinematic one that follows keyframes.
struct Collider {
  std::string name = "collider";
  Shape shape = Plane{};
  Vec3f position{};  ///< [m]
  Quatf rotation{};
  Motion motion{};               ///< applied after position and rotation
  float thickness = 0;           ///< added to the thickness of objects [m]
  float static_friction = 0.4f;  ///< a pair has the geometric mean of both
  float kinetic_friction = 0.3f;
  float restitution = 0;  ///< a pair has the larger of both
  Vec3f colour{0.45f, 0.48f, 0.52f};
};

/// The vertices of a deforming mesh at one time.
struct MeshFrame {
  float time = 0;                ///< [s], increasing along a list of frames
  std::vector<Vec3f> positions;  ///< one per vertex of the mesh [m]
};

/// Signed distances to a closed mesh, negative inside, at the nodes of a grid. Plain
/// data: it can be stored and shared by any number of colliders of the same mesh.
struct DistanceField {
  Vec3f low{};                   ///< position of the first node [m]
  float spacing = 0;             ///< between nodes [m]
  std::array<int, 3> nodes{};    ///< along x, y, z
  std::vector<float> distances;  ///< of node (x, y, z) at (z nodes[1] + y) nodes[0] + x [m]
};

/// A static or kinematic triangle mesh, closed or open. As triangles it is two-sided and collides with all objects that its
/// groups and mask permit, by vertices, edges and triangles.
struct MeshCollider {
  /// `triangles`: the mesh itself. `distance_grid`: a DistanceField of the mesh, which must be closed. `heightfield`: the mesh must be
  /// a regular grid, rows along z, columns along x, two triangles a cell; solid below. The last two collide with particles only, not
  /// with edges and triangles, of the objects that groups and mask permit. Their cost does not depend on the mesh; they cannot deform.
  enum class As { triangles, distance_grid, heightfield };

  std::string name = "mesh";
  TriangleMesh mesh;              ///< [m]
  Motion motion{};                ///< motion of the whole mesh
  std::vector<MeshFrame> frames;  ///< deformation, linear between frames, constant outside; `motion` is applied after it
  bool repeat_frames = false;     ///< restart after the last frame
  As as = As::triangles;
  float grid_spacing = 0;                        ///< of a distance grid; 0: a 48th of the longest side [m]
  std::shared_ptr<const DistanceField> field{};  ///< of a distance grid, from measure_distances; null: measured at compile
  float thickness = 0;                           ///< added to the thickness of objects [m]
  float static_friction = 0.4f;                  ///< a pair has the geometric mean of both
  float kinetic_friction = 0.3f;
  float restitution = 0;                 ///< a pair has the larger of both
  std::uint32_t groups = 1, mask = ~0u;  ///< as in Object
  Vec3f colour{0.45f, 0.48f, 0.52f};
};

/// Samples the distances of a closed mesh at nodes `spacing` apart [m] (0: a 48th of its longest side) over its box grown
/// by two nodes. Throws an Error if an edge has not two triangles or more than 2^27 nodes would result.
std::shared_ptr<const DistanceField> measure_distances(const TriangleMesh& mesh, float spacing = 0);

/// Overrides contact properties of one pair of objects or mesh colliders (as triangles).
struct PairProperties {
  std::string first, second;       ///< names; the same name twice: self-collision of that object
  std::optional<float> thickness;  ///< distance kept between the two [m]
  std::optional<float> static_friction, kinetic_friction, restitution;  ///< [-]
};

/// Moving air: a uniform wind with a gust of given period along it.
struct Wind {
  Vec3f velocity{};       ///< [m/s]
  float gust = 0;         ///< 0..1: amplitude of the gust as a share of the wind [-]
  float gust_period = 2;  ///< [s]
  float air_density = 0;  ///< density of the air; 0: no air; 1.2 at sea level [kg/m^3]
};

/// A force on a particle [N] from its position [m], velocity [m/s], mass [kg] and the time [s]. It must not use libm if a
/// run must give the same bits on other machines.
struct ForceField {
  using Function = std::function<Vec3f(const Vec3f& position, const Vec3f& velocity, float mass, float time)>;
  Function function;
  /// True if it may be called concurrently and in any order: it depends on its arguments alone. If all fields of a scene
  /// permit it, they run on all threads with the same bits; otherwise on one thread in particle order.
  bool on_all_threads = false;

  ForceField() = default;
  template <class F>
  requires(!std::same_as<std::remove_cvref_t<F>, ForceField> && std::constructible_from<Function, F>)
      ForceField(F&& f, bool may_run_on_all_threads = false)  // NOLINT: any callable is one, `requires` excludes copies
      : function(std::forward<F>(f)), on_all_threads(may_run_on_all_threads) {}
  explicit operator bool() const { return static_cast<bool>(function); }
  Vec3f operator()(const Vec3f& position, const Vec3f& velocity, float mass, float time) const {
    return function(position, velocity, mass, time);
  }
};

// ---------------------------------------------------------------- solver settings

/// A sweep and its name in scene files.
struct NamedSweep {
  std::string name;
  Sweep sweep;
};

/// All sweeps except `automatic`.
const std::vector<NamedSweep>& sweeps();

/// The name in scene files, also of `automatic`.
std::string sweep_name(Sweep sweep);

/// Options of sweeps.
struct SweepOptions {
  /// How `jacobi` combines the n corrections of a particle. `split`: each constraint acts on an n-th of the mass (Tonge et
  /// al. 2012), which conserves momentum. `average`: the mean of the corrections (Macklin et al. 2014), which does not.
  enum class Sharing { split, average };
  /// Chebyshev semi-iteration over any sweep but `natural` (Wang 2015); off for particles in contact.
  enum class Acceleration { none, chebyshev };

  float relaxation = 1;  ///< omega in (0, 2): factor of every multiplier change [-]
  Sharing sharing = Sharing::split;
  Acceleration acceleration = Acceleration::none;
  int plain_iterations = 10;  ///< per substep, before Chebyshev starts, 1..10000; at least 2 if rho is estimated
  float spectral_radius = 0;  ///< rho of the sweep in (0, 1); 0: estimated in each substep from the plain iterations [-]
  bool tethers = false;  ///< limit every particle's distance from the pins to that along the mesh (long-range attachments)
  float tether_slack =
      0;  ///< share by which tether lengths may be exceeded, for cloth that is meant to stretch, 0..1000 [-]
  /// Of `chains`, 0..1000: regularises the solve of a straight path between two pins, as a share of its inverse mass; a link
  /// stretches by about this times g h^2 [-].
  float chain_softness = 0.1f;
  int multigrid_cycles = 2;  ///< of `multigrid`: W-cycles per substep, each a conjugate gradient step, 1..100
};

struct Settings {
  int substeps = 0;    ///< 1..10000 per frame; 0: as many as each set of objects needs, see chosen_substeps
  int iterations = 1;  ///< 1..10000 per substep
  /// A substep stops iterating when the root mean square |C + alpha~ lambda| of distance constraints and attachments falls
  /// below this [m]; 0: never. No other type counts; a scene without distance constraints makes all iterations. PBD
  /// stiffness is converted for the full number of iterations.
  float tolerance = 0;
  int threads = 0;  ///< 0: all hardware threads
  Sweep sweep = Sweep::automatic;
  SweepOptions sweep_options{};
  bool contact_filter = true;  ///< truncate steps so that colliding surfaces never cross
  /// When a mesh collider comes near an object, the frame gets up to this many substeps, so that the collider moves at most
  /// half the pair's thickness in each: the filter cannot limit kinematic colliders. The Report warns of the cost.
  /// 1..10000; 0: eight times `substeps`; at most `substeps`: off.
  int most_substeps = 0;
  /// What to do about initially intersecting surfaces.
  enum class Intersections {
    leave,     ///< leave them; contact ignores them until they are apart
    untangle,  ///< move them apart, and vertices out of closed mesh colliders, at `untangling_speed`
    refuse,    ///< throw an Error that names the first when a World is made
  } initial_intersections = Intersections::leave;
  float untangling_speed = 0.5f;  ///< speed limit of depenetration [m/s]
  /// Times update, predict and the search for non-finite values separately in Report::phases. By default they are fused
  /// with the sweeps, tile by tile. Same bits, slower.
  bool separate_phases = false;
  bool measure = false;  ///< fill Report::residuals, stretch and overstretch each frame (costs about one more iteration)
  bool record_residuals = false;    ///< fill Report::convergence (slow: every iteration of the last substep is measured)
  bool record_multipliers = false;  ///< store multipliers for World::multipliers even if the solver does not need them
  std::string
      isa;  ///< "", or "x86-64-v2", "-v3", "-v4", "generic", "sequential" to force a code path (same bits, other speed)
};

/// The complete description of a simulation.
struct Scene {
  Vec3f gravity{0, -9.81f, 0};  ///< [m/s^2]
  Wind wind;
  std::vector<ForceField> forces;
  Settings settings;
  float frame_time = 1.f / 60;  ///< duration of one frame [s]
  int frames = 120;             ///< the default length of a run
  std::vector<Object> objects;
  std::vector<Collider> colliders;
  std::vector<MeshCollider> mesh_colliders;
  std::vector<PairProperties> pairs;

  /// Adds an object and returns its index. Its contents are checked when a World is made.
  int add(Object object);
  int add(Collider collider);
  int add(MeshCollider collider);
  int add_cloth(const TriangleMesh& mesh, const ClothOptions& options = {});

  /// Fixes particles in place, or moves them. Throws an Error if the object or a particle does not exist.
  void pin(int object, const std::vector<int>& particles, const Motion& motion = {});
};

/// The sweep of one object: its own; else that of the settings; else the one that measured best on such objects. That is
/// `multigrid` for cloth and rope of 32 particles or more. It is `tiled` where multigrid does not help: a volume, a bending
/// length (B / rho g)^(1/3) above a quarter of the sheet's size, PBD stiffness of bending or all distances, several
/// iterations, or a surface that can touch others or itself. Smaller objects use multigrid if all others do. `reason`
/// receives the deciding fact if both leave the sweep open.
Sweep chosen_sweep(const Scene& scene, int object, std::string* reason = nullptr);

/// The substeps per frame of each object: those of the settings, or, if they are 0, those of its set. Objects and mesh
/// colliders (as triangles) form a set if their surfaces can touch, by groups, masks and `collides`, directly or through
/// others; an object that touches nothing is a set of its own. A set has 10 substeps if all its objects use `multigrid`,
/// without PBD stiffness between 0 and 1, else 20 (docs/internals/convergence.md). With a tolerance or recorded residuals all
/// objects are one set.
std::vector<int> chosen_substeps(const Scene& scene);

/// The settings of a World of this scene, with defaults chosen by its content. `Sweep::automatic`
/// becomes the common sweep of all objects (see chosen_sweep), or stays if they differ. 0
/// substeps become those of all objects (see chosen_substeps), or stay if these differ.
/// `reason` receives the deciding fact if the sweep was left open.
Settings chosen_settings(const Scene& scene, std::string* reason = nullptr);

/// All errors for which a World rejects the scene (grave findings), and warnings.
std::vector<Finding> inspect(const Scene& scene);

}  // namespace pliant
