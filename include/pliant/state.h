// The part of a World that changes with time, and the ids of its contents.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <new>
#include <string>
#include <vector>

#include "pliant/vec3.h"

namespace pliant {

struct Object;
struct Collider;
struct MeshCollider;

/// Identifies one thing of a World while it exists. After a removal, the slot is used again with the next generation,
/// so an old id causes an Error and never refers to a later thing. Things that come from the Scene have generation 0,
/// so the index that Scene::add returned is their id.
template <class Kind>
struct Id {
  int slot = -1;
  int generation = 0;

  Id() = default;
  Id(int slot_number, int slot_generation = 0)  // NOLINT(google-explicit-constructor): an index of a Scene is an id
      : slot(slot_number), generation(slot_generation) {}
  friend bool operator==(const Id&, const Id&) = default;
  friend auto operator<=>(const Id&, const Id&) = default;  // NOLINT(modernize-use-nullptr)
};
using ObjectId = Id<Object>;
using ColliderId = Id<Collider>;
using MeshColliderId = Id<MeshCollider>;

/// Four floats in one 16-byte record, loaded and stored as a whole.
struct alignas(16) Record {
  float x = 0, y = 0, z = 0, w = 0;
};

/// An allocator that aligns to cache lines, so that four records fill a line.
template <class T>
struct CacheLineAllocator {
  using value_type = T;
  CacheLineAllocator() = default;
  template <class U>
  CacheLineAllocator(const CacheLineAllocator<U>&) {}  // NOLINT(google-explicit-constructor): as allocators must
  T* allocate(std::size_t n) { return static_cast<T*>(::operator new (n * sizeof(T), std::align_val_t{64})); }
  void deallocate(T* p, std::size_t) { ::operator delete (p, std::align_val_t{64}); }
  friend bool operator==(const CacheLineAllocator&, const CacheLineAllocator&) { return true; }
};

using Records = std::vector<Record, CacheLineAllocator<Record>>;

/// The block of particles of an object or mesh collider in a State.
struct StateBlock {
  int first = 0, particles = 0;  ///< range of particles in the State; no particles: the object was removed
  int generation = 0;            ///< increases whenever another object is compiled into the block
  friend bool operator==(const StateBlock&, const StateBlock&) = default;
};

/// The pose that ColliderHandle::set_pose gave to a collider that has no keyframes.
struct HeldPose {
  bool is_mesh = false;  ///< true for a mesh collider, false for a primitive
  int slot = 0, generation = 0;
  Vec3f position{};  ///< position of the collider's frame [m]
  Quatf rotation{};
  friend bool operator==(const HeldPose&, const HeldPose&) = default;
};

/// The orientations in a State: three arrays with one record per frame.
struct FrameRecords {
  Records orientations;        ///< unit quaternion from the frame's principal axes to the world
  Records angular_velocities;  ///< angular velocities in the frames' principal axes [rad/s]; w is zero
  Records inverse_inertias;    ///< about the frame's principal axes [1/(kg m^2)]; w is zero; constant

  std::size_t size() const { return orientations.size(); }
};

/// A number or vector for each particle, such as a temperature.
struct Channel {
  std::string name;
  int components = 1;         ///< numbers for each particle
  std::vector<float> values;  ///< components x particles numbers, in the order of the State's particles
};

/// A part of a body that touches something: a solid of an object's body, or a collider.
struct ContactPart {
  int owner = 0;  ///< an object or mesh collider: its index in State::blocks; a primitive collider: -1 - its index
  int solid = 0;  ///< of an object: its solids are numbered body after body; else 0
  int piece = 0;  ///< of a mesh collider: a triangle; of b 1 or 2: the ball inside b or a touches; else 0
  friend auto operator<=>(const ContactPart&, const ContactPart&) = default;  // NOLINT(modernize-use-nullptr)
};

/// Contact of rigid bodies a and b in up to four points that share a normal. What the next step needs to know of it:
/// arms and normal stay as they were when it began, as long as the bodies hardly move against each other; impulses are
/// where the solver starts. Over fifteen members, without padding, because it is saved and hashed as it is.
struct BodyContact {
  ContactPart a, b;                             ///< a < b
  std::array<std::uint32_t, 4> feature{};       ///< what makes each point: corners and edges
  Vec3f position{};                             ///< of b in the frame of a when it began [m]
  Quatf rotation{};                             ///< likewise
  Quatf turned{};                               ///< from the frame of a to the world when it began
  std::array<Vec3f, 4> anchor_a{}, anchor_b{};  ///< the points on each surface, in the frame of each body [m]
  int count = 0;                                ///< of points, 1 to 4
  Vec3f normal{}, tangent1{}, tangent2{};       ///< unit vectors, the normal from a to b
  std::array<float, 4> gap{};                   ///< separation at each point when the last step began [m]
  Vec3f arm_a{}, arm_b{};                       ///< from the centres of mass to the centre of the points [m]
  std::array<float, 4> x{}, y{};                ///< places of the points along the tangents, from that centre [m]
  float substep = 0;                            ///< length of the substep of the impulses [s]
  std::array<float, 4> impulse{};               ///< at each point along the normal, in the last substep [N s]
  std::array<float, 2> friction_impulse{};      ///< along the tangents, at the centre [N s]
  float twist_impulse = 0;                      ///< about the normal [N m s]
  std::array<float, 2> rolling_impulse{};       ///< about the tangents [N m s]
};
static_assert(sizeof(BodyContact) == 332);

/// A joint of an object that has broken.
struct BrokenJoint {
  int block = 0;  ///< of the object: its index in State::blocks
  int joint = 0;  ///< index in Object::joints
  // NOLINTNEXTLINE(modernize-use-nullptr)
  friend auto operator<=>(const BrokenJoint&, const BrokenJoint&) = default;
};

/// What ObjectHandle::set_motor set for a motor of a joint.
struct MotorSetting {
  int block = 0;             ///< of the object: its index in State::blocks
  int joint = 0, motor = 0;  ///< indices in Object::joints and ObjectJoint::motors
  float target = 0;          ///< [rad, m, rad/s or m/s]
  float most = 0;            ///< greatest torque or force [N m or N]
  // NOLINTNEXTLINE(modernize-use-nullptr)
  friend auto operator<=>(const MotorSetting&, const MotorSetting&) = default;
};

/// What ObjectHandle::set_rest_factor set for a group of constraints.
struct RestFactor {
  int block = 0;     ///< of the object: its index in State::blocks
  int group = 0;     ///< index in Object::constraints
  float factor = 1;  ///< by which its rest data are multiplied, >= 0 [-]
  // NOLINTNEXTLINE(modernize-use-nullptr)
  friend auto operator<=>(const RestFactor&, const RestFactor&) = default;
};

/// What set_surface_velocity of a handle set for a body or collider.
struct SurfaceVelocity {
  enum class Of : std::int32_t { body, collider, mesh_collider };
  Of of = Of::body;
  std::int32_t slot = 0;  ///< of a body: the index of its object in State::blocks; else the slot of the collider's id
  std::int32_t generation = 0;  ///< of the collider's id; 0 for a body
  std::int32_t body = 0;        ///< index in Object::bodies; 0 for a collider
  Vec3f velocity{};             ///< in its own frame [m/s]
  friend bool operator==(const SurfaceVelocity&, const SurfaceVelocity&) = default;
};
static_assert(sizeof(SurfaceVelocity) == 28);

/// Two grains in contact (pliant/grains.h).
struct GrainContact {
  std::int32_t a = 0, b = 0;  ///< particles of the State, a < b
  Vec3f slip{};               ///< of a over b since they stuck, along the contact plane [m]
  friend bool operator==(const GrainContact&, const GrainContact&) = default;
};
static_assert(sizeof(GrainContact) == 20);

/// A value of State::births: the particle is not there. It has the inverse mass 0, meets nothing, and waits to be
/// emitted.
inline constexpr double not_there = 1e300;

/// How many layers an emitter has emitted.
struct EmittedLayers {
  std::int32_t block = 0;    ///< of the object: its index in State::blocks
  std::int32_t emitter = 0;  ///< index in Flow::emitters
  std::int64_t layers = 0;
  friend bool operator==(const EmittedLayers&, const EmittedLayers&) = default;
};
static_assert(sizeof(EmittedLayers) == 16);

/// The order of State::emitted.
inline bool in_order_of_emitters(const EmittedLayers& a, const EmittedLayers& b) {
  return a.block != b.block ? a.block < b.block : a.emitter < b.emitter;
}

/// A value of State::rest_times: the body sleeps.
inline constexpr float asleep = -1;

/// All data of a World that change with time, as a plain value: copy, hash or restore it, and the next step gives the
/// same bits. Each object has a block of particles in storage order, which ObjectView::storage_order relates to the
/// user's order. Blocks of removed objects are filled with zeros.
struct State {
  double time = 0;                 ///< simulated time [s]
  std::int64_t frame = 0;          ///< number of complete steps
  std::vector<StateBlock> blocks;  ///< block of each object or mesh collider, in the order of addition
  Records positions;               ///< x, y, z [m] and the inverse mass w [1/kg]
  Records remainders;              ///< rounding residues: what the float positions cannot represent [m]
  Records velocities;              ///< velocities of the particles [m/s]; w is zero
  FrameRecords frames;             ///< orientations, object after object; usually none
  std::vector<Channel> channels;   ///< channels of all objects; usually none
  std::vector<HeldPose> held_poses;
  /// For each block, the substeps per frame that its object demanded for the last quarter of a frame, if they follow
  /// the State (chosen_substeps), else 0, as before the first frame. Empty if all are 0.
  std::vector<float> substeps;
  std::vector<BrokenJoint> broken_joints;  ///< ascending; usually none
  std::vector<MotorSetting> motors;        ///< ascending by block, joint and motor; usually none
  std::vector<BodyContact> body_contacts;  ///< of rigid bodies, by owners and solids, then by pieces; usually none
  /// For each frame in `frames`, for how long its body has been slow [s], or `asleep`; 0 if it is of no body. Empty if
  /// bodies never sleep (SleepOptions), and after something was added, removed or edited: then all are awake.
  std::vector<float> rest_times;
  std::vector<GrainContact> grain_contacts;  ///< those that press, ascending by a, then b; usually none
  /// For each particle, the time at which it came [s], or `not_there`. Empty if the particles of no object come or go
  /// (Flow).
  std::vector<double> births;
  std::vector<EmittedLayers> emitted;    ///< of each emitter, by block and emitter; usually none
  std::vector<RestFactor> rest_factors;  ///< ascending by block and group; usually none
  /// The rest data of all constraints that are plastic (Plasticity), object after object, in the order of its pools;
  /// usually none.
  std::vector<float> flowed;
  std::vector<SurfaceVelocity> surface_velocities;  ///< ascending by kind, slot and body; usually none
};

/// True if a particle of the State is there (Flow).
inline bool is_there(const State& state, std::size_t particle) {
  return state.births.empty() || state.births[particle] != not_there;
}

/// The SHA-256 hash of a State as 64 hexadecimal digits. It includes blocks only after a removal or an edit, because
/// contiguous blocks follow from the particles; frames, channels, held poses, settings of motors, substeps and
/// times of rest only if there are any.
std::string hash(const State& state);

}  // namespace pliant
