// What of a World changes as time passes, and the ids of what it holds.
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

/// Names one thing of a World for as long as it exists. A slot is used again after its thing was removed, with the next
/// generation: an id of what was removed is refused with an Error and never names what came after it.
/// What a Scene was compiled with has generation 0, so the index that Scene::add returned is its id.
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

/// Four floats in one 16-byte record, moved by whole loads.
struct alignas(16) Record {
  float x = 0, y = 0, z = 0, w = 0;
};

/// Allocates at the start of a cache line, so that four records are one line.
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

/// Where the particles of an object or mesh collider stand in a State.
struct StateBlock {
  int first = 0, particles = 0;  ///< no particles: it was removed
  int generation = 0;            ///< grows whenever the World compiles something new in its place
  friend bool operator==(const StateBlock&, const StateBlock&) = default;
};

/// Where World::set_poses has left a collider that no keyframes move.
struct HeldPose {
  bool is_mesh = false;  ///< of a mesh collider, else of a primitive one
  int slot = 0, generation = 0;
  Vec3f position{};  ///< [m]
  Quatf rotation{};
  friend bool operator==(const HeldPose&, const HeldPose&) = default;
};

/// What is known of the orientations of a State, one record a frame.
struct FrameRecords {
  Records orientations;        ///< unit quaternion from the frame's principal axes to the world
  Records angular_velocities;  ///< along the frame's own axes [rad/s], w zero
  Records inverse_inertias;    ///< about the frame's own axes [1/(kg m^2)], w zero; never changes

  std::size_t size() const { return orientations.size(); }
};

/// A number or a vector for every particle that a kind of matter owns, such as a temperature.
struct Channel {
  std::string name;
  int components = 1;         ///< of each particle
  std::vector<float> values;  ///< components x particles, in the order of the State
};

/// All that changes as time passes, a plain value: copy it, hash it, put it back, and the next step gives the same bits.
/// Each object has a block of particles, in the order of the compiled model and not of the user: World::storage_order tells
/// which is which. Between blocks there are zeros where objects were removed.
struct State {
  double time = 0;                 ///< [s]
  std::int64_t frame = 0;          ///< steps taken
  std::vector<StateBlock> blocks;  ///< one an object or mesh collider, in the order in which they were added
  Records positions;               ///< (x, y, z) [m], w the inverse mass [1/kg]
  Records remainders;              ///< what a float position could not hold of the motion so far [m]
  Records velocities;              ///< [m/s]
  FrameRecords frames;             ///< object after object, as the particles are; mostly empty
  std::vector<Channel> channels;   ///< mostly none
  std::vector<HeldPose> held_poses;
};

/// SHA-256 over every member of a State, as 64 hexadecimal digits. Blocks count where something was removed or edited; those
/// that simply follow one another are told by the particles alone. Frames, channels and held poses count where there are any.
std::string hash(const State& state);

}  // namespace pliant
