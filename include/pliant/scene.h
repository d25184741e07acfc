// A Scene is a description: plain data that a World compiles. Nothing here moves.
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

#include "pliant/material.h"
#include "pliant/mesh.h"
#include "pliant/motion.h"
#include "pliant/vec3.h"

namespace pliant {

// ---------------------------------------------------------------- what deforms

/// Constraints of one type among the particles of one object. `type` is a name from constraint_types().
struct ConstraintGroup {
  std::string type;                ///< "distance", "dihedral_bending", "isometric_bending", ...
  std::vector<int> particles;      ///< stencil after stencil: size of the stencil x number of constraints
  std::vector<float> rest;         ///< rest data, fields x number of constraints; empty: measured from the positions
  Stiffness stiffness{};           ///< of every constraint in the group
  std::vector<float> compliances;  ///< one alpha a constraint instead of stiffness.value; empty: all the same
};

/// What the library knows about a constraint type.
struct ConstraintType {
  std::string name;
  int stencil_size;                      ///< number of particles
  std::vector<std::string> rest_fields;  ///< names of its rest data, with units in docs/reference/constraints.md
};

/// Every constraint type that a ConstraintGroup may name.
const std::vector<ConstraintType>& constraint_types();

/// The volume of a closed mesh, held at `pressure` times its rest volume: C = sum (x1 x x2) . x3 - pressure * 6 V0.
/// Mueller et al. 2007, section 4.4.2.
struct Volume {
  float pressure = 1;     ///< k_pressure >= 0 [-]
  Stiffness stiffness{};  ///< compliance in m^5/N for C as written, which is six volumes
};

/// A particle whose place is given: it has no free mass and follows `motion` from its rest place.
struct Pin {
  int particle = 0;
  Motion motion{};
};

/// A particle drawn to a target that moves: a distance constraint of rest length 0.
struct Attachment {
  int particle = 0;
  Vec3f target{};  ///< at time 0 [m]
  Motion motion{};
  Stiffness stiffness{};
};

/// Anything made of particles. Cloth, balloons and ropes are ways to make one.
struct Object {
  std::string name;
  std::vector<Vec3f> positions;   ///< also the rest shape [m]
  std::vector<Vec3f> velocities;  ///< empty: at rest [m/s]
  std::vector<float> masses;      ///< one a particle, > 0, or infinity for a fixed one [kg]
  std::vector<ConstraintGroup> constraints;
  std::vector<std::array<int, 3>> triangles;  ///< the surface, for air, volume and pictures; may be empty
  std::optional<Volume> volume;               ///< needs a closed surface
  std::vector<Pin> pins;
  std::vector<Attachment> attachments;
  float thickness = 0.001f;       ///< distance kept from colliders; two surfaces keep the sum of theirs [m]
  bool self_collision = false;    ///< its surface, or its links where it has none, does not pass through itself
  bool collides = false;          ///< nor through other objects of which this holds
  std::uint32_t groups = 1;       ///< bits: what it belongs to. Two things meet where each one's groups
  std::uint32_t mask = ~0u;       ///< have a bit in the other's mask
  float static_friction = 0.4f;   ///< [-]
  float kinetic_friction = 0.3f;  ///< [-], <= static_friction
  float restitution = 0;          ///< 0..1 [-]
  float drag = 1.2f;              ///< coefficient of a triangle square to the wind [-]
  float lift = 0.8f;              ///< [-]
  float damping = 0;  ///< of velocity: each substep divides it by 1 + h damping, about exp(-damping) a second [1/s]
  Vec3f colour{0.75f, 0.35f, 0.30f};  ///< linear RGB, 0..1
};

/// How a mesh becomes cloth.
struct ClothOptions {
  std::string name = "cloth";
  Fabric material{};
  std::optional<Stiffness> stretch{};  ///< overrides the material's
  std::optional<Stiffness> bending{};  ///< overrides the material's
  enum class Bending { none, dihedral, isometric } bending_model = Bending::dihedral;
  std::optional<Volume> volume{};  ///< makes it a balloon; needs a closed mesh
  Vec3f velocity{};                ///< initial [m/s]
};

/// Cloth from any triangle mesh; its rest shape is the mesh as given, flat or curved: a distance constraint an
/// edge, a bending constraint an inner edge, a third of each triangle's mass to each corner. Without overrides the
/// compliance of an edge is L^2 / (Y (A1 + A2)) (Van Gelder 1998) and that of a hinge (A1 + A2) / (|e|^2 B) or, isometric,
/// 3/B, so that stiffness does not depend on the mesh. Throws Error naming the triangle or edge that can't be cloth.
Object make_cloth(const TriangleMesh& mesh, const ClothOptions& options = {});

/// How a line of points becomes a rope.
struct RopeOptions {
  std::string name = "rope";
  float linear_density = 0.05f;  ///< [kg/m]
  Stiffness stretch{};
  Stiffness bending = Stiffness::compliance(1);  ///< distance between second neighbours; used where `bends`
  bool bends = false;
  float thickness = 0.005f;  ///< radius [m]
};

/// A rope through `points` (two or more, no two neighbours in one place). Each link's mass goes half to either end.
Object make_rope(const std::vector<Vec3f>& points, const RopeOptions& options = {});

// ---------------------------------------------------------------- what it meets

struct Plane {};  ///< the half-space y <= 0 of its frame is solid
struct Sphere {
  float radius = 0.5f;
};  ///< [m]
struct Capsule {
  float radius = 0.25f, half_length = 0.5f;
};  ///< along the y-axis of its frame; half_length without caps [m]
struct Box {
  Vec3f half_extents{0.5f, 0.5f, 0.5f};
};  ///< [m]
using Shape = std::variant<Plane, Sphere, Capsule, Box>;

/// A solid that nothing pushes: it stands still or follows keyframes.
struct Collider {
  std::string name = "collider";
  Shape shape = Plane{};
  Vec3f position{};  ///< [m]
  Quatf rotation{};
  Motion motion{};               ///< applied after position and rotation
  float thickness = 0;           ///< added to the particle's [m]
  float static_friction = 0.4f;  ///< a pair has the geometric mean of both sides'
  float kinetic_friction = 0.3f;
  float restitution = 0;  ///< a pair has the larger of both sides'
  Vec3f colour{0.45f, 0.48f, 0.52f};
};

/// Where the vertices of a mesh that deforms are at a moment.
struct MeshFrame {
  float time = 0;                ///< [s], increasing along a list of frames
  std::vector<Vec3f> positions;  ///< one a vertex of the mesh [m]
};

/// Signed distances to a closed mesh, negative inside, at the nodes of a grid. Plain data: it may be kept, and given to any
/// number of colliders of the same mesh.
struct DistanceField {
  Vec3f low{};                   ///< first node [m]
  float spacing = 0;             ///< between nodes [m]
  std::array<int, 3> nodes{};    ///< along x, y, z
  std::vector<float> distances;  ///< of node (x, y, z) at (z nodes[1] + y) nodes[0] + x [m]
};

/// A triangle mesh that nothing pushes, closed or open. As triangles it is met from both sides by every object whose groups and
/// mask allow: its vertices, edges and triangles all take part.
struct MeshCollider {
  /// What stands for it. `triangles`: itself. `distance_grid`: a DistanceField of it, which must be closed; `heightfield`: its
  /// heights over a regular grid in x and z, solid below. Those two are met by particles alone, as primitive colliders
  /// are, by all objects, at a cost that does not depend on the mesh, and do not deform.
  enum class As { triangles, distance_grid, heightfield };

  std::string name = "mesh";
  TriangleMesh mesh;              ///< [m]
  Motion motion{};                ///< of the whole mesh
  std::vector<MeshFrame> frames;  ///< deforms, linear between frames, held before the first and after the last; then moves
  bool repeat_frames = false;     ///< start again after the last frame
  As as = As::triangles;
  float grid_spacing = 0;                        ///< of a distance grid; 0: a 48th of the longest side [m]
  std::shared_ptr<const DistanceField> field{};  ///< of a distance grid, as measure_distances makes it; none: it is made
  float thickness = 0;                           ///< added to the object's [m]
  float static_friction = 0.4f;                  ///< a pair has the geometric mean of both sides'
  float kinetic_friction = 0.3f;
  float restitution = 0;                 ///< a pair has the larger of both sides'
  std::uint32_t groups = 1, mask = ~0u;  ///< as of Object
  Vec3f colour{0.45f, 0.48f, 0.52f};
};

/// The distances of a closed mesh at nodes `spacing` apart [m] (0: a 48th of its longest side) over its box grown by two of them.
/// Throws Error where an edge has not two triangles or there would be more than 2^27 nodes.
std::shared_ptr<const DistanceField> measure_distances(const TriangleMesh& mesh, float spacing = 0);

/// What two things, objects or mesh colliders as triangles, are to one another where it is not what their own numbers make it.
struct PairProperties {
  std::string first, second;                                            ///< names; both the same: of an object with itself
  std::optional<float> thickness;                                       ///< distance kept between the two [m]
  std::optional<float> static_friction, kinetic_friction, restitution;  ///< [-]
};

/// Moving air: a uniform wind with a gust of given period along it.
struct Wind {
  Vec3f velocity{};       ///< [m/s]
  float gust = 0;         ///< 0..1: the wind's strength swings by this share [-]
  float gust_period = 2;  ///< [s]
  float air_density = 0;  ///< 0: no air at all; 1.2 at sea level [kg/m^3]
};

/// A force on a particle [N] from its position [m], velocity [m/s], mass [kg] and the time [s]. Use no libm in it if the run must
/// give the same bits elsewhere.
struct ForceField {
  using Function = std::function<Vec3f(const Vec3f& position, const Vec3f& velocity, float mass, float time)>;
  Function function;
  /// Whether it may be called from several threads at once, in any order: it must depend on its arguments alone. Where all
  /// fields of a scene say so they run on all threads, with the same bits; else on one thread, in the particles' order.
  bool on_all_threads = false;

  ForceField() = default;
  template <class F>
  requires(!std::same_as<std::remove_cvref_t<F>, ForceField> && std::constructible_from<Function, F>)
      ForceField(F&& f, bool may_run_on_all_threads = false)  // NOLINT(google-explicit-constructor): any callable is one
      : function(std::forward<F>(f)), on_all_threads(may_run_on_all_threads) {}
  explicit operator bool() const { return static_cast<bool>(function); }
  Vec3f operator()(const Vec3f& position, const Vec3f& velocity, float mass, float time) const {
    return function(position, velocity, mass, time);
  }
};

// ---------------------------------------------------------------- how it is solved

/// How constraints are visited; all give the same bits where they say so.
enum class Sweep {
  automatic,  ///< the one that measured best on scenes of the kind: see chosen_settings; the default
  tiled,      ///< coloured Gauss-Seidel in tiles, sixteen lanes, all threads
  sequential,  ///< the same order, one constraint at a time in plain scalar code: the readable reference, bit-equal to `tiled`
  symmetric,  ///< `tiled` there and back: one iteration visits every constraint twice, in one order and in the reverse
  jacobi,     ///< all constraints at once from the same positions, each particle's corrections then shared out
  natural,    ///< Gauss-Seidel in the order in which the constraints were given, one at a time: for comparison, slow
  chains,     ///< rigid and compliant distances laid out as paths, each path solved exactly; the rest as `tiled` has it
  multigrid,  ///< one correction of all distances at once on a hierarchy of levels, then `tiled` twice: for fine meshes
};

/// A sweep and what scenes call it.
struct NamedSweep {
  std::string name;
  Sweep sweep;
};

/// Every sweep there is, but for the choice among them: the one list that scene files, `pliant compare` and tests go by.
const std::vector<NamedSweep>& sweeps();

/// What scenes call it; "automatic" too.
std::string sweep_name(Sweep sweep);

/// What the sweeps can be told besides.
struct SweepOptions {
  /// How `jacobi` shares a particle among its n constraints. `split`: each has an n-th of its mass (Tonge et al. 2012), which
  /// keeps momentum. `average`: each sees all of it and the n corrections are averaged (Macklin et al. 2014), which does not.
  enum class Sharing { split, average };
  /// Chebyshev semi-iteration over any sweep but `natural` (Wang 2015), off while a particle touches something.
  enum class Acceleration { none, chebyshev };

  float relaxation = 1;  ///< omega: every change of a multiplier is multiplied by it, above 0, below 2 [-]
  Sharing sharing = Sharing::split;
  Acceleration acceleration = Acceleration::none;
  int plain_iterations = 10;  ///< of each substep before Chebyshev begins, 1..10000; 2 or more where rho is estimated
  float spectral_radius = 0;  ///< rho of the sweep in (0, 1), or 0: estimated in each substep from the plain iterations [-]
  bool tethers = false;  ///< hold every particle within its distance along the mesh to the pins (long-range attachments)
  float tether_slack =
      0;  ///< share by which that distance may be exceeded, for cloth that is meant to stretch, 0..1000 [-]
  /// Of `chains`, 0..1000: times the inverse mass of a path, what keeps a straight row between two pins from being singular; a
  /// link stretches by about this times g h^2 [-].
  float chain_softness = 0.1f;
  int multigrid_cycles = 2;  ///< of `multigrid`: W-cycles a substep, each a step of conjugate gradients, 1..100
};

struct Settings {
  int substeps = 0;    ///< 1..10000 a frame; 0: as many as the sweep needs, see chosen_settings
  int iterations = 1;  ///< 1..10000 a substep
  /// Root mean square of |C + alpha~ lambda| over the distance constraints, the attachments among them, below which a substep
  /// makes no more iterations, so that `iterations` is only the most that it may make; 0 or more, 0: always all of them [m].
  /// Nothing else is judged, and a scene without distance constraints makes all. PBD stiffness is shared out as if all were made.
  float tolerance = 0;
  int threads = 0;  ///< 0: as many as the machine has
  Sweep sweep = Sweep::automatic;
  SweepOptions sweep_options{};
  bool contact_filter = true;  ///< shorten moves so that nothing that collides passes through anything else
  /// A frame in which a mesh collider comes near an object is divided into more substeps, up to so many, until the collider moves
  /// no more than half the pair's thickness in one: what nothing pushes can't be stopped by shortening moves. 1..10000; no
  /// more than `substeps`: never.
  int most_substeps = 2000;
  /// What is done about surfaces that pass through one another before anything has moved.
  enum class Intersections {
    leave,     ///< they may stay; contact leaves them out until they happen to be apart
    untangle,  ///< they are drawn apart, and vertices inside a closed mesh collider out of it, at `untangling_speed`
    refuse,    ///< making a World throws Error naming the first
  } initial_intersections = Intersections::leave;
  float untangling_speed = 0.5f;  ///< at most [m/s]
  bool measure = false;  ///< fill Report::residuals, stretch and overstretch each frame (costs about one more iteration)
  bool record_residuals = false;    ///< fill Report::convergence (slow: every iteration of the last substep is measured)
  bool record_multipliers = false;  ///< keep multipliers readable even where not needed (one iteration, or rigid)
  std::string
      isa;  ///< "", or "x86-64-v2", "-v3", "-v4", "generic", "sequential" to force a code path (same bits, other speed)
};

/// Everything that a World is made from.
struct Scene {
  Vec3f gravity{0, -9.81f, 0};  ///< [m/s^2]
  Wind wind;
  std::vector<ForceField> forces;
  Settings settings;
  float frame_time = 1.f / 60;  ///< of one frame [s]
  int frames = 120;             ///< how many a run lasts unless told otherwise
  std::vector<Object> objects;
  std::vector<Collider> colliders;
  std::vector<MeshCollider> mesh_colliders;
  std::vector<PairProperties> pairs;

  /// Adds an object and returns its index. Its contents are checked when a World is made.
  int add(Object object);
  int add(Collider collider);
  int add(MeshCollider collider);
  int add_cloth(const TriangleMesh& mesh, const ClothOptions& options = {});

  /// Fixes particles where they are, or moves them. Throws Error where the object or a particle does not exist.
  void pin(int object, const std::vector<int>& particles, const Motion& motion = {});
};

/// The settings that a World of this scene runs by: its own, with what they leave open decided by what the scene holds.
/// `Sweep::automatic` becomes `multigrid` for cloth and rope of 32 particles or more, and `tiled` where that would do harm or no
/// good: an object with a volume, a sheet so stiff that its bending length (B / rho g)^(1/3) is more than a quarter of its size, PBD
/// stiffness of bending or of all distances, more than one iteration, surfaces that can touch others or themselves. 0 substeps become 10 of `multigrid` and 20 of any
/// other (docs/internals/convergence.md). `reason` is told what it is that decides, in words, where the sweep was left open.
Settings chosen_settings(const Scene& scene, std::string* reason = nullptr);

/// Checks everything that a World would refuse, and says what is doubtful besides.
std::vector<Finding> inspect(const Scene& scene);

}  // namespace pliant
