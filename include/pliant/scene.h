// A Scene is a description: plain data that a World compiles. It does not change over time.
#pragma once

#include <array>
#include <concepts>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
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
#include "pliant/object.h"
#include "pliant/shape.h"
#include "pliant/vec3.h"

namespace pliant {

// ---------------------------------------------------------------- objects

/// Options of make_cloth.
struct ClothOptions {
  std::string name = "cloth";
  Fabric material{};
  std::optional<Stiffness> stretch{};  ///< replaces the stretch stiffness of the material
  std::optional<Stiffness> bending{};  ///< replaces the bending stiffness of the material
  enum class Bending { none, dihedral, isometric } bending_model = Bending::dihedral;
  /// What resists stretching. `springs`: the edges, alike in all directions. `woven`: each triangle, by the warp, weft
  /// and shear stiffness of the material (constraint types triangle_stretch and triangle_shear).
  enum class Stretching { springs, woven } stretch_model = Stretching::springs;
  /// Of `woven`: direction of the warp in the rest shape, of any length but 0. Each triangle has its projection, or
  /// that of y or z if none.
  Vec3f warp{0, 0, 1};
  std::optional<Volume> volume{};  ///< makes a balloon; needs a closed mesh
  Vec3f velocity{};                ///< initial velocity [m/s]
  /// Of dihedral bending: folds beyond an angle stay, as in paper or sheet metal.
  std::optional<Plasticity> bending_plasticity{};
  std::optional<StrainLimit> strain_limit{};  ///< of its edges; none: it stretches as far as it is pulled
};

/// Makes cloth of any triangle mesh, flat or curved, which becomes its rest shape: a distance constraint for each edge,
/// a bending constraint for each inner edge, a third of a triangle's mass at each corner. From the material, the
/// compliance of an edge is L^2 / (Y (A1 + A2)) (Van Gelder 1998), less by a factor of irregular meshes, that of a hinge
/// (A1 + A2) / (|e|^2 B) or, isometric, 3/B: alike on all meshes. Throws an Error with the triangle or edge at fault.
Object make_cloth(const TriangleMesh& mesh, const ClothOptions& options = {});

/// Options of make_rope.
struct RopeOptions {
  std::string name = "rope";
  float linear_density = 0.05f;  ///< mass per length [kg/m]
  Stiffness stretch{};
  /// Stiffness between particles two links apart; used if `bends` is set.
  Stiffness bending = Stiffness::compliance(1);
  bool bends = false;
  float thickness = 0.005f;  ///< radius [m]; two ropes keep the sum of their radii
};

/// Makes a rope through two or more different points. Each end of a link gets half of its mass.
Object make_rope(const std::vector<Vec3f>& points, const RopeOptions& options = {});

// ---------------------------------------------------------------- colliders

/// A static solid, or a kinematic one that follows keyframes or is moved by the user.
struct Collider {
  std::string name = "collider";
  Shape shape = Plane{};
  Vec3f position{};  ///< position of its frame [m]
  Quatf rotation{};
  Motion motion{};               ///< keyframes, applied after position and rotation
  float thickness = 0;           ///< distance that it adds to the thickness of objects [m]
  float static_friction = 0.4f;  ///< a contact uses the geometric mean of both sides
  float kinetic_friction = 0.3f;
  float restitution = 0;  ///< a contact uses the larger value of both sides
  float rolling_friction = 0,
        spinning_friction = 0;  ///< as in Object; a contact uses the larger value of both sides [m]
  /// Velocity in the collider's frame with which its surface moves along itself while its shape stays, as that of a
  /// conveyor belt: friction takes bodies and particles along. Its part along a contact's normal has no effect [m/s].
  Vec3f surface_velocity{};
  Vec3f colour{0.45f, 0.48f, 0.52f};
};

/// The vertex positions of a deforming mesh at one time.
struct MeshFrame {
  float time = 0;                ///< time [s]; increases from frame to frame
  std::vector<Vec3f> positions;  ///< one per vertex of the mesh [m]
};

/// Signed distances to a closed mesh, negative inside, at the nodes of a grid. It is plain data, so it can be stored
/// and shared by any number of colliders that have the same mesh.
struct DistanceField {
  Vec3f low{};                   ///< position of the first node [m]
  float spacing = 0;             ///< distance between neighbouring nodes [m]
  std::array<int, 3> nodes{};    ///< number of nodes along x, y, z
  std::vector<float> distances;  ///< that of node (x, y, z) is at index (z nodes[1] + y) nodes[0] + x [m]
};

/// A static or kinematic triangle mesh, closed or open. As `triangles` it has two sides, and collides by vertices,
/// edges and triangles with all objects that groups and masks permit.
struct MeshCollider {
  /// How objects collide with it. `triangles`: with the mesh. `distance_grid`: with a DistanceField of the mesh, which
  /// must be closed. `heightfield`: with the mesh as terrain: a regular grid, rows along z, columns along x, two
  /// triangles a cell. The last two cannot deform, cost the same for any mesh, and touch only particles of objects that
  /// groups and masks permit.
  enum class As { triangles, distance_grid, heightfield };

  std::string name = "mesh";
  TriangleMesh mesh;              ///< vertex positions in metres
  Motion motion{};                ///< rigid motion of the whole mesh
  std::vector<MeshFrame> frames;  ///< deformation: linear between frames, constant outside; then `motion` is applied
  bool repeat_frames = false;     ///< true: restart at the first frame after the last
  As as = As::triangles;
  float grid_spacing = 0;                        ///< spacing of a distance grid [m]; 0: a 48th of the longest side
  std::shared_ptr<const DistanceField> field{};  ///< the field of a distance grid; null: measured when a World is made
  float thickness = 0;                           ///< distance that it adds to the thickness of objects [m]
  float static_friction = 0.4f;                  ///< a contact uses the geometric mean of both sides
  float kinetic_friction = 0.3f;
  float restitution = 0;  ///< a contact uses the larger value of both sides
  float rolling_friction = 0,
        spinning_friction = 0;           ///< as in Object; a contact uses the larger value of both sides [m]
  std::uint32_t groups = 1, mask = ~0u;  ///< bit masks, as in Object
  Vec3f surface_velocity{};  ///< as that of a Collider, in axes that turn with `motion` or the pose that is set [m/s]
  Vec3f colour{0.45f, 0.48f, 0.52f};
};

/// Measures the distances to a closed mesh at nodes `spacing` apart [m] (0: a 48th of its longest side), in its box
/// grown by two nodes. Throws an Error if an edge does not have two triangles, or if there would be more than 2^27
/// nodes.
std::shared_ptr<const DistanceField> measure_distances(const TriangleMesh& mesh, float spacing = 0);

/// Contact properties of one pair of objects or mesh colliders (as triangles), instead of those that follow from each.
struct PairProperties {
  std::string first, second;       ///< names of both; twice the same name: self-collision of that object
  std::optional<float> thickness;  ///< distance that the two keep [m]
  /// Coefficients of friction and restitution [-]
  std::optional<float> static_friction, kinetic_friction, restitution;
};

/// Moving air: a uniform wind whose speed varies periodically in gusts. It blows on triangles, and on bodies that are
/// one capsule, as rods are.
struct Wind {
  Vec3f velocity{};       ///< mean velocity [m/s]
  float gust = 0;         ///< amplitude of gusts as a share of the wind, 0..1 [-]
  float gust_period = 2;  ///< period of gusts [s]
  float air_density = 0;  ///< density of the air [kg/m^3]; 0: no air; 1.2 at sea level
};

/// A force on each particle [N], computed from its position [m], velocity [m/s], mass [kg] and the time [s]. Use no
/// function of libm if a run must give the same bits on other machines.
///
/// Or a force on all particles of an object at once (on_arrays).
struct ForceField {
  using Function = std::function<Vec3f(const Vec3f& position, const Vec3f& velocity, float mass, float time)>;
  Function function;

  /// What a force on arrays gets, in the order in which the user described the particles, and gives.
  struct Arrays {
    std::string_view object;                       ///< its name
    std::span<const Vec3f> positions, velocities;  ///< [m], [m/s]
    std::span<const float> masses;                 ///< infinite for kinematic particles, whose force has no effect [kg]
    double time = 0;                               ///< [s]
    std::span<Vec3f> forces;                       ///< to be set; zero at the call [N]
  };
  using ArrayFunction = std::function<void(const Arrays&)>;
  /// Called once for each object and substep. Arrays are valid during the call.
  ArrayFunction array_function{};

  /// A force on arrays.
  static ForceField on_arrays(ArrayFunction f, bool may_run_on_all_threads = false) {
    ForceField field;
    field.array_function = std::move(f);
    field.on_all_threads = may_run_on_all_threads;
    return field;
  }

  /// True if calls may be concurrent and in any order, because the force depends on the arguments alone. If all fields
  /// of a scene are so, they run on all threads, with the same bits; otherwise on one thread in particle order.
  bool on_all_threads = false;

  ForceField() = default;
  template <class F>
  requires(!std::same_as<std::remove_cvref_t<F>, ForceField> && std::constructible_from<Function, F>)
      ForceField(F&& f, bool may_run_on_all_threads = false)  // NOLINT: any callable is one, `requires` excludes copies
      : function(std::forward<F>(f)), on_all_threads(may_run_on_all_threads) {}
  /// True if there is a function.
  explicit operator bool() const { return function != nullptr || array_function != nullptr; }
  /// Calls the function on particles, which must be there.
  Vec3f operator()(const Vec3f& position, const Vec3f& velocity, float mass, float time) const {
    return function(position, velocity, mass, time);
  }
};

// ---------------------------------------------------------------- solver settings

/// A sweep, and its name in scene files.
struct NamedSweep {
  std::string name;
  Sweep sweep;
};

/// All sweeps but `automatic`.
const std::vector<NamedSweep>& sweeps();

/// The name of a sweep in scene files; also of `automatic`.
std::string sweep_name(Sweep sweep);

/// Parameters of the sweeps.
struct SweepOptions {
  /// How `jacobi` combines a particle's n corrections. `split`: each constraint acts on an n-th of the mass, which
  /// conserves momentum (Tonge et al. 2012). `average`: it moves by their mean, which does not (Macklin et al. 2014).
  enum class Sharing { split, average };
  /// Chebyshev acceleration (Wang 2015) of any sweep but `natural`. Particles in contact are not accelerated.
  enum class Acceleration { none, chebyshev };

  float relaxation = 1;  ///< omega in (0, 2), a factor of every multiplier change [-]
  Sharing sharing = Sharing::split;
  Acceleration acceleration = Acceleration::none;
  /// Iterations of a substep before Chebyshev starts, 1..10000; at least 2 if rho is estimated. A substep with no more
  /// iterations than these is not accelerated.
  int plain_iterations = 10;
  float spectral_radius = 0;  ///< spectral radius rho of the sweep in (0, 1); 0: estimated in each substep [-]
  bool tethers = false;  ///< limit the distance of particles from pins to that along the mesh (long-range attachments)
  /// Share by which tether lengths may be exceeded, 0..1000, for cloth that is meant to stretch [-]
  float tether_slack = 0;
  /// For `chains`, 0..1000: regularisation of the solve of a straight path between two pins, as a share of the inverse
  /// of its mass. A link stretches by about this times g h^2 [-].
  float chain_softness = 0.1f;
  /// For `chains` and `multigrid`, 0..1000: no distance stays longer than its force explains by more than this share of
  /// its rest length, unless contact or the filter demands it; 0: no limit. Does not apply to PBD stiffness [-].
  float most_overstretch = 0.05f;
  int multigrid_cycles = 2;  ///< for `multigrid`: conjugate gradient steps per substep, each with a W-cycle, 1..100
};

/// When rigid bodies and grains sleep. An island of bodies that touch or are jointed, all of which have been slow for
/// some time, rests until something acts on it (docs/guide/bodies.md, grains.md).
struct SleepOptions {
  bool on = false;
  float speed = 0.02f;  ///< slow: the centre of mass moves by less than this, > 0 [m/s]
  float spin = 0.04f;   ///< and the body turns by less than this, > 0 [rad/s]
  float time = 0.5f;    ///< for how long the bodies of an island have to be slow, >= 0 [s]
};

struct Settings {
  int substeps = 0;    ///< substeps per frame, 1..10000; 0: as many as each set of objects needs (chosen_substeps)
  int iterations = 1;  ///< iterations per substep, 1..10000
  /// Iterations of a substep end when the root mean square |C + alpha~ lambda| of distance constraints and attachments
  /// is below this [m]; 0: never. Other types do not count; without distance constraints all iterations are made. PBD
  /// stiffness is converted for the full number of iterations.
  float tolerance = 0;
  int threads = 0;  ///< number of threads; 0: all hardware threads
  Sweep sweep = Sweep::automatic;
  SweepOptions sweep_options{};
  bool contact_filter = true;  ///< truncate steps that would make colliding surfaces cross
  /// The largest number of substeps of a frame, 1..10000. Where they follow the State, 0 means 100, or 200 for ropes
  /// alone, and below four it is their fixed number. Elsewhere a frame gets more, so that no mesh collider near an
  /// object moves more than half the thickness in each, as the filter cannot limit it; the Report warns. 0: eight times
  /// `substeps`; up to `substeps`: never more.
  int most_substeps = 0;
  /// The least number of substeps of a frame where they follow the State, rounded up to a multiple of four; up to
  /// most_substeps. 0: 12, or 8 for cloth that only hangs by tethers. No effect elsewhere.
  int least_substeps = 0;
  /// What happens to surfaces that intersect initially. Those that only touch, at a distance of 0, are held on the side
  /// of the normals of colliders, of closed surfaces, or of the earlier object, unless they are refused.
  enum class Intersections {
    leave,     ///< nothing: contact ignores them until they are apart
    untangle,  ///< they, and vertices inside closed mesh colliders, are moved apart at `untangling_speed`
    refuse,    ///< making a World throws an Error that names the first intersection
  } initial_intersections = Intersections::leave;
  /// How elastic constraints move matter. `pbd`: by their forces at the substep's end (implicit Euler), which takes
  /// (omega h)^2 / 2 of the amplitude of a mode of frequency omega in each substep h. `energy`: by a mean of forces of
  /// three times, which takes 1/200 of that, more in solids (docs/guide/choosing_settings.md); springs of joints have
  /// it by both. Contact, friction and rigid constraints are the same.
  enum class Integrator { pbd, energy } integrator = Integrator::pbd;
  float untangling_speed = 0.5f;  ///< largest speed at which surfaces are moved apart [m/s]
  SleepOptions sleep{};
  /// Times update, predict and the search for non-finite values separately in Report::phases. By default they run
  /// together with sweeps, tile by tile. Bits are the same; speed is lower.
  bool separate_phases = false;
  bool measure = false;           ///< fill Report::residuals and stretch; costs about one more iteration a frame
  bool record_residuals = false;  ///< fill Report::convergence; slow: measures each iteration of the last substep
  /// Keep multipliers for ObjectView::multipliers even if the solver does not need them.
  bool record_multipliers = false;
  /// "" for the fastest, or one that the build holds: "x86-64-v2", "-v3", "-v4", "generic"; or "sequential". The bits
  /// are the same.
  std::string isa;
};

/// The complete description of a simulation.
struct Scene {
  Vec3f gravity{0, -9.81f, 0};  ///< acceleration of gravity [m/s^2]
  Wind wind;
  std::vector<ForceField> forces;
  Settings settings;
  float frame_time = 1.f / 60;  ///< duration of one frame [s]
  int frames = 120;             ///< default number of frames of a run
  std::vector<Object> objects;
  std::vector<Collider> colliders;
  std::vector<MeshCollider> mesh_colliders;
  std::vector<PairProperties> pairs;

  /// Adds an object and returns its index. The object is validated when a World is made.
  int add(Object object);
  int add(Collider collider);
  int add(MeshCollider collider);
  int add_cloth(const TriangleMesh& mesh, const ClothOptions& options = {});

  /// Pins particles: fixes them in place, or moves them. Throws an Error if the object or a particle does not exist.
  void pin(int object, const std::vector<int>& particles, const Motion& motion = {});
};

/// Returns the sweep of one object: its own, else that of the settings, else the one that measured best on such
/// objects. Cloth and rope of 32 particles or more is solved by `tethered_chains` if it is regular, hangs from pins (or
/// attachments that hardly yield) that rest or move as one, is not meant to stretch, and has a bending length (B / rho
/// g)^(1/3) up to a quarter of its size (no PBD stiffness of bending). Irregular cloth that can touch no surface and no
/// collider, and bends as easily, is solved by `multigrid`, and the rest by `chains`. It is `tiled` where none of these
/// helps: a volume inflated against stiff edges, PBD stiffness of all distances, or several iterations. Smaller objects
/// use the sweep of all others. If the sweep was left open, `reason` receives the deciding fact.
Sweep chosen_sweep(const Scene& scene, int object, std::string* reason = nullptr);

/// Returns the substeps per frame of each object: those of the settings, or, if they are 0, those of its set. A set
/// consists of objects and mesh colliders (as triangles) whose surfaces can touch, by groups, masks and `collides`,
/// directly or through others, as if all were near; in a World distances divide sets further (ObjectInfo::substeps has
/// what an object gets). An object that touches nothing is a set of its own. 0 stands for substeps that follow
/// the State: they are decided in each quarter of a frame by strain and motion. They do so if an object of the set is
/// solved by chains and not meant to stretch,
/// and none has PBD stiffness between 0 and 1. Other sets have 80 to 160 with a volume; 5 if all use `multigrid`, 10 if
/// one can touch, is in wind or a force field, or has pins that move or lie together; up to 160 with a sheet that is
/// meant to stretch and hangs from few of its particles; woven cloth up to 160; rigid bodies 8, 40 with what deforms;
/// else 20. A tolerance makes one set.
std::vector<int> chosen_substeps(const Scene& scene);

/// Returns the settings of a World of this scene; what the scene leaves open is chosen by its content.
/// `Sweep::automatic` becomes the sweep of all objects (chosen_sweep), or stays if they differ. 0 substeps become those
/// of all objects (chosen_substeps), or stay if they differ. If the sweep was left open, `reason` receives the deciding
/// fact.
Settings chosen_settings(const Scene& scene, std::string* reason = nullptr);

/// Inspects a scene: grave findings, for which a World rejects it, and warnings.
std::vector<Finding> inspect(const Scene& scene);

}  // namespace pliant
