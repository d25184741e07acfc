// The time-dependent part of a World, and the ids of its contents.
#pragma once

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

/// Identifies one thing of a World during its existence. A slot is reused after a removal
/// with the next generation, so a stale id is an Error and never names a later thing. Things
/// compiled from a Scene have generation 0, so the index returned by Scene::add is their id.
template <class Kind>
struct Id {
  int slot = -1;
  int generation = 0;

  Id() = default;
  Id(int slot_number, int slot_generation = 0)  // NOLINT(google-explicit-constructor): an index of a Scene is an id
      : slot(slot_number), generation(slot_generation) {}
  friend bool operator==(const Id&, const Id&) = default;
  friend auto operator<=>(const Id&, const Id&) = default;
};
using ObjectId = Id<Object>;
using ColliderId = Id<Collider>;
using MeshColliderId = Id<MeshCollider>;

/// Four floats in one 16-byte record, loaded and stored as a whole.
struct alignas(16) Record {
  float x = 0, y = 0, z = 0, w = 0;
};

/// Allocates at cache line boundaries, so that four records fill a line.
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

/// The particle range of an object or mesh collider in a State.
struct StateBlock {
  int first = 0, particles = 0;  ///< no particles: removed
  int generation = 0;            ///< increases whenever the World compiles another object into the block
  friend bool operator==(const StateBlock&, const StateBlock&) = default;
};

/// The pose that World::set_poses gave to a collider without keyframes.
struct HeldPose {
  bool is_mesh = false;  ///< true for a mesh collider, false for a primitive
  int slot = 0, generation = 0;
  Vec3f position{};  ///< [m]
  Quatf rotation{};
  friend bool operator==(const HeldPose&, const HeldPose&) = default;
};

/// The orientation data of a State, one record per frame.
struct FrameRecords {
  Records orientations;        ///< unit quaternion from the frame's principal axes to the world
  Records angular_velocities;  ///< in the frame's principal axes [rad/s], w zero
  Records inverse_inertias;    ///< about the frame's principal axes [1/(kg m^2)], w zero; constant

  std::size_t size() const { return orientations.size(); }
};

/// A number or vector per particle that a kind of matter owns, such as a temperature.
struct Channel {
  std::string name;
  int components = 1;         ///< numbers per particle
  std::vector<float> values;  ///< components x particles, in the order of the State
};

/// The complete time-dependent data, as a plain value: copy, hash or restore it, and the next
/// step gives the same bits. Each object has a block of particles in storage order, which
/// World::storage_order maps to the user's order. Zeros fill blocks of removed objects.
struct State {
  double time = 0;                 ///< [s]
  std::int64_t frame = 0;          ///< steps taken
  std::vector<StateBlock> blocks;  ///< one per object or mesh collider, in the order of addition
  Records positions;               ///< (x, y, z) [m], w the inverse mass [1/kg]
  Records remainders;              ///< rounding residues: the part of the motion below float precision [m]
  Records velocities;              ///< [m/s]
  FrameRecords frames;             ///< frames by object, as particles are; mostly none
  std::vector<Channel> channels;   ///< mostly none
  std::vector<HeldPose> held_poses;
};

/// SHA-256 of a State, as 64 hexadecimal digits. Blocks are included only after a removal or an edit, because contiguous
/// blocks follow from the particles. Frames, channels and held poses are included if there are any.
std::string hash(const State& state);

}  // namespace pliant
