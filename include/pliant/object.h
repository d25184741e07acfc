// What an object consists of: particles, constraints between them, and how it meets others.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pliant/flow.h"
#include "pliant/formula.h"
#include "pliant/material.h"
#include "pliant/motion.h"
#include "pliant/shape.h"
#include "pliant/vec3.h"

namespace pliant {

/// How a deformation becomes permanent: what is beyond `yield` flows away, in all up to `most`. Of what a constraint
/// measures: of tetrahedra ("tetrahedron_shear") and clusters the strain, of hinges ("dihedral_bending") the angle
/// [rad], of rods ("rod_joint") the strain at their surface.
struct Plasticity {
  float yield = 0;  ///< elastic deformation that does not become permanent, >= 0 [-, or rad of hinges]
  /// How fast the rest flows: exp(-rate t) of what is beyond `yield` is left after t seconds. 0: all of it flows at
  /// once, as in metal; with a `yield` of 0 it creeps, as dough does. >= 0 [1/s]
  float rate = 0;
  float most = 1e30f;  ///< greatest permanent deformation; beyond it the matter is elastic again [-, or rad of hinges]
};

/// A factor of rest data at a time.
struct RestKeyframe {
  float time = 0;    ///< [s]
  float factor = 1;  ///< >= 0 [-]
};

/// A group of constraints of one type among the particles of one object. `type` is a name in constraint_types().
struct ConstraintGroup {
  std::string type;                ///< "distance", "dihedral_bending", "isometric_bending", ...
  std::vector<int> particles;      ///< indices, stencil after stencil; for a frame slot the index of a frame
  std::vector<float> rest;         ///< rest data by constraint; empty: measured from the positions
  Stiffness stiffness{};           ///< stiffness of every constraint of the group
  std::vector<float> compliances;  ///< compliance of each constraint, instead of stiffness.value; empty: all equal
  std::optional<Plasticity> plasticity{};  ///< for types that have it; none: elastic
  /// By what the rest length of "distance", the longest one of "distance_limit", the rest volume of
  /// "tetrahedron_volume" or the rest stretch of "fibre" is multiplied: linear between keyframes, constant before the
  /// first and after the last. Their times increase. It changes in each substep.
  std::vector<RestKeyframe> keyframes{};
  /// Force at which one of them breaks, of links in a row in a step only the most loaded: World::step removes it, see
  /// Report::torn. Of "distance", "distance_limit", "point_on_triangle" and "point_in_tetrahedron" with a compliance,
  /// by which the force is known; 0: they hold [N]
  float break_force = 0;
};

/// A constraint type: its name, slots, rows and rest data.
struct ConstraintType {
  std::string name;
  int stencil_size;                      ///< number of slots of a constraint
  std::vector<std::string> rest_fields;  ///< names of the rest data; docs/reference/constraints.md has their units
  std::vector<SlotKind> slots;           ///< for each slot: a particle, or one of Object::frames
  int rows;                              ///< number of components of C
};

/// All constraint types that a ConstraintGroup may name: built-in ones, then registered ones (pliant/constraint.h).
const std::vector<ConstraintType>& constraint_types();

/// The pressure of a Volume at a time.
struct PressureKeyframe {
  float time = 0;      ///< [s]
  float pressure = 1;  ///< as Volume::pressure [-]
};

/// The volume of a closed mesh, held at `pressure` times its rest volume: C = sum (x1 x x2) . x3 - pressure * 6 V0.
/// Mueller et al. 2007, section 4.4.2.
struct Volume {
  float pressure = 1;     ///< target volume over rest volume, k_pressure >= 0 [-]
  Stiffness stiffness{};  ///< its compliance is in m^5/N, for C as written above, which is six volumes
  /// By how much the air outside is denser than the gas inside [kg/m^3]. The difference of their pressures grows with
  /// height and bears the surface up, in all by this times g V. The gas has no inertia. filled_with of pliant/gas.h
  /// sets it.
  float lift = 0;
  /// If there are any, the pressure follows them instead of `pressure`: linear between, constant before the first and
  /// after the last. Their times increase. It changes in each substep.
  std::vector<PressureKeyframe> keyframes{};
  /// The share of what the pressure is above 1 that leaks out in a second: exp(-leak t) of it is left at the World's
  /// time t, 0..1000 [1/s].
  float leak = 0;

  bool changes() const { return !keyframes.empty() || leak > 0; }
};

/// Particles that keep their shape (Mueller, Heidelberger, Teschner, Gross 2005): each is pulled to its place in the
/// rest shape, moved, turned and perhaps deformed to where the particles are. pliant/cluster.h makes clusters.
struct Cluster {
  /// What the rest shape may do to fit: move and turn; also stretch and shear at constant volume; also bend and twist.
  enum class Mode { rigid, linear, quadratic };

  std::vector<int> particles;  ///< two or more, none of them twice
  std::vector<Vec3f> rest;     ///< their rest shape [m]; empty: their initial positions
  Mode mode = Mode::rigid;
  /// Of the deformation that `linear` and `quadratic` keep, 0..1; the rest of it is pulled back [-]
  float share = 0.8f;
  /// Its compliance is per mass, alpha in s^2: particles swing about their places at 1 / (2 pi sqrt(alpha)) Hz,
  /// whatever their masses. Its damping is per mass too, in 1/s.
  Stiffness stiffness{};
  /// The rest shape takes on what it is stretched and sheared by, at constant volume; none: it springs back. Flat
  /// clusters stay elastic.
  std::optional<Plasticity> plasticity{};
};

/// How far the edges of cloth or of tetrahedra may become shorter or longer (Provot 1995, section 4): an elastic object
/// yields freely until there, and hardly beyond, as cloth does whose yarns are straight. Constraint type
/// "distance_limit".
struct StrainLimit {
  float least = 0;    ///< least length over that at rest, 0..1 [-]
  float most = 1.1f;  ///< greatest length over that at rest, >= 1 [-]
};

/// A kinematic particle: it has infinite mass and follows `motion` from its rest position. If that turns, so does a
/// body with this particle; if not, the body is free to turn, unless the inertia of its frame is infinite
/// (BodyOptions::kinematic).
struct Pin {
  int particle = 0;
  Motion motion{};
};

/// Attaches a particle to a moving target by a distance constraint of rest length 0.
struct Attachment {
  int particle = 0;
  Vec3f target{};  ///< position of the target at time 0 [m]
  Motion motion{};
  Stiffness stiffness{};
};

/// How constraints are projected: in which order, and which of them together.
enum class Sweep {
  automatic,   ///< the sweep that measured best on objects of this kind (chosen_sweep)
  tiled,       ///< Gauss-Seidel by tiles and colours, sixteen constraints at a time, on all threads
  sequential,  ///< scalar version of `tiled`: one constraint at a time, in the same order, with the same bits
  symmetric,   ///< `tiled` forwards, then backwards; an iteration projects every constraint twice
  jacobi,      ///< all constraints use the same positions; each particle combines the corrections it gets
  natural,     ///< Gauss-Seidel in the user's order, one constraint at a time: slow, for comparisons
  chains,      ///< direct solves along paths of distance constraints; all other constraints as in `tiled`
  multigrid,   ///< a multigrid correction of all distances, then `tiled` twice; for fine meshes
  /// `chains`, and no particle farther from the pins than along the mesh, while the pins keep their distances: for
  /// cloth and rope that hang
  tethered_chains,
};

/// True for `chains` and `tethered_chains`.
constexpr bool solves_chains(Sweep sweep) { return sweep == Sweep::chains || sweep == Sweep::tethered_chains; }

/// An orientation with inertia. A frame and a particle make a rigid body; constraints act on it by frame slots.
struct ObjectFrame {
  Quatf orientation{};       ///< unit quaternion from the principal axes to the world
  Vec3f angular_velocity{};  ///< initial angular velocity in world axes [rad/s]
  Vec3f inertia{1, 1, 1};    ///< moments of inertia about the principal axes, > 0 [kg m^2]; infinity locks that axis
};

/// A rigid body of an object: a particle is its centre of mass, a frame its orientation, and its solids move with both.
struct ObjectBody {
  std::string name;
  int particle = 0;           ///< index in Object::positions
  int frame = 0;              ///< index in Object::frames
  std::vector<Solid> solids;  ///< in the frame's principal axes, about the particle; may overlap, may be empty
  Vec3f origin{};  ///< of the frame in which the body was described, in its principal axes about the particle [m]
  Quatf axes{};    ///< from that frame to the principal axes
  /// Velocity in that frame with which the body's surface moves along itself, as that of a track: friction takes what
  /// it touches along, or drives the body. Its part along a contact's normal has no effect [m/s].
  Vec3f surface_velocity{};
};

/// The target of a motor at a time.
struct MotorKeyframe {
  float time = 0;    ///< increases from keyframe to keyframe [s]
  float target = 0;  ///< as the motor's kind says [rad, m, rad/s, m/s, N m or N]
};

/// A motor of a joint: one of its constraints, which ObjectHandle::set_motor can give another target.
struct ObjectJointMotor {
  std::string name;  ///< the member of the joint that describes it, as "motor" or "turn_motor"; of six axes "linear_x"
  int constraint = 0;        ///< index in ObjectJoint::constraints
  bool to_position = false;  ///< its target is an angle or a displacement; false: a speed, or a torque or force
  bool is_torque = false;    ///< its target is a torque or a force
  std::vector<MotorKeyframe> keyframes{};  ///< the target by time: linear between them, constant outside
};

/// A joint between two bodies of an object: a name for some of its constraints (add_joint of pliant/joint.h makes
/// both).
struct ObjectJoint {
  std::string name;
  std::string kind;                             ///< "ball", "hinge", ...
  int a = 0, b = 0;                             ///< indices in Object::bodies
  Vec3f anchor{};                               ///< in the frame of b's principal axes, about its centre of mass [m]
  std::vector<std::array<int, 2>> constraints;  ///< each a group of Object::constraints, and an index in it
  float break_force = 0, break_torque = 0;      ///< greatest force [N] and torque about the anchor [N m]; 0: no limit
  std::vector<ObjectJointMotor> motors;
  Vec3f anchor_a{};          ///< the same place at time 0, in the frame of a's principal axes [m]
  Quatf axes_a{}, axes_b{};  ///< axes of the joint at time 0, in the frames of a's and of b's principal axes
};

/// Where an object tears: at edges and tetrahedra that become too long. World::step splits one of their particles,
/// across the direction of the greatest stretch (Mueller et al. 2007, section 4.6), and tells in Report::torn. Of a rod
/// a joint breaks (Report::broken_joints).
struct Tearing {
  float stretch = 1.5f;  ///< greatest length over that at rest, > 1 [-]
};

/// A cut along a plane of the rest shape, along edges, faces and joints. Once World::step has made it, description()
/// has infinite times, but of rods.
struct PlaneCut {
  float start = 0, end = 0;  ///< when the blade enters the object, and when it has passed; equal: at once [s]
  Vec3f point{};             ///< of the plane [m]
  Vec3f normal{1, 0, 0};     ///< of the plane; of any length but 0
  Vec3f along{0, -1, 0};     ///< the way of the blade, at constant speed; must not be parallel to `normal`
};

/// A vertex of a Skin: the mean of four particles, with weights.
struct SkinVertex {
  std::array<int, 4> particles{};
  std::array<float, 4> weights{};  ///< their sum is 1; a vertex outside of its tetrahedron has negative ones
};

/// A surface that moves with an object's particles, finer than its own. Files and pictures show it instead; nothing
/// touches it. make_skin of pliant/soft_body.h makes one.
struct Skin {
  std::vector<SkinVertex> vertices;
  std::vector<std::array<int, 3>> triangles;  ///< indices of vertices
};

/// An object: particles and constraints. make_cloth and make_rope make one. Over fifteen members: its whole
/// description.
struct Object {
  std::string name;
  std::vector<Vec3f> positions;     ///< initial positions, which are also the rest shape [m]
  std::vector<Vec3f> velocities;    ///< initial velocities [m/s]; empty: at rest
  std::vector<float> masses;        ///< mass of each particle, > 0; infinity: fixed [kg]
  std::vector<ObjectFrame> frames;  ///< orientations, for constraints with frame slots
  std::vector<ObjectBody> bodies;   ///< rigid bodies; their particles touch nothing by themselves, their solids do
  std::vector<ConstraintGroup> constraints;
  std::vector<ObjectJoint> joints;            ///< joints of bodies, each made of some of the constraints
  std::vector<std::array<int, 3>> triangles;  ///< surface for contact, air, volume and pictures; may be empty
  std::optional<Volume> volume;               ///< keeps the enclosed volume; needs a closed surface
  std::optional<Fluid> fluid;                 ///< its particles are a liquid (pliant/liquid.h)
  std::optional<Grains> grains;               ///< its particles are grains (pliant/grains.h)
  std::vector<Cluster> clusters;              ///< particles that keep their shape (pliant/cluster.h)
  std::optional<Gas> gas;                     ///< its `fluid` is a gas (pliant/gas.h)
  std::optional<Tracers> tracers;             ///< its particles are tracers in gases (pliant/gas.h)
  std::optional<Absorbency> absorbency;       ///< none: its surface takes up no liquid
  Flow flow;                                  ///< how particles of a liquid or grains come and go (pliant/flow.h)
  std::vector<Pin> pins;
  std::vector<Attachment> attachments;
  std::optional<Tearing> tearing;     ///< none: it stretches as far as it is pulled
  std::vector<PlaneCut> cuts;         ///< cuts that are made during the simulation
  std::optional<Skin> skin;           ///< what files and pictures show instead of `triangles`
  float thickness = 0.001f;           ///< distance kept from colliders; two surfaces keep the sum of both [m]
  bool self_collision = false;        ///< the surface cannot pass through itself; without triangles: the links cannot
  bool collides = false;              ///< the surface cannot pass through other objects that also have `collides`
  std::uint32_t groups = 1;           ///< bit mask of the groups to which the object belongs
  std::uint32_t mask = ~0u;           ///< groups that it meets: each one's mask must contain a group of the other
  float static_friction = 0.4f;       ///< coefficient of friction at rest [-]
  float kinetic_friction = 0.3f;      ///< coefficient of friction while sliding, <= static_friction [-]
  float restitution = 0;              ///< ratio of speeds after and before an impact, 0..1 [-]
  float rolling_friction = 0;         ///< of its bodies: greatest torque against rolling, per normal force [m]
  float spinning_friction = 0;        ///< likewise about the contact normal, at a single point too [m]
  float drag = 1.2f;                  ///< drag coefficient of a triangle or capsule perpendicular to the wind [-]
  float lift = 0.8f;                  ///< lift coefficient of a triangle [-]
  Sweep sweep = Sweep::automatic;     ///< how its constraints are projected
  float damping = 0;                  ///< rate of decay of velocities, linear and angular: exp(-damping t) [1/s]
  Vec3f colour{0.75f, 0.35f, 0.30f};  ///< linear RGB, 0..1
  /// In pictures of a solid or a closed surface: the way in it that leaves a third of the light that is not of its
  /// colour, as Fluid::clarity; 0: opaque [m]
  float clarity = 0;
};

}  // namespace pliant
