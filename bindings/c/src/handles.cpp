// The table of all handles of the process.
#include "handles.h"

#include <array>
#include <mutex>
#include <new>
#include <vector>

namespace pliant::c {

namespace {

/// A handle, from its lowest bits: the kind, the slot, the slot's generation. Kinds begin with 1, so that none is null.
constexpr int kind_bits = 3;
constexpr int slot_bits = sizeof(void*) >= 8 ? 20 : 14;
constexpr std::uintptr_t slot_count = std::uintptr_t{1} << slot_bits;
constexpr std::uintptr_t chunk_size = 256;

struct Slot {
  std::atomic<std::uintptr_t> handle{0};  ///< 0 while it is free
  std::atomic<bool> stop{false};
  std::shared_ptr<void> what;
  std::uintptr_t generation = 0;
};
using Chunk = std::array<Slot, chunk_size>;

/// Chunks are never freed, so that a slot may be looked at at any time.
struct Table {
  std::mutex mutex;
  std::array<std::atomic<Chunk*>, slot_count / chunk_size> chunks{};
  std::uintptr_t used = 0;  ///< slots that were ever in use
  std::vector<std::uintptr_t> free;
};

/// It is never destroyed: handles may be freed while the process ends.
Table& table() {
  static Table* const made = new Table;
  return *made;
}

Slot* slot_of(const void* handle) noexcept {
  const std::uintptr_t slot = (reinterpret_cast<std::uintptr_t>(handle) >> kind_bits) % slot_count;
  Chunk* chunk = table().chunks[slot / chunk_size].load(std::memory_order_acquire);
  return chunk == nullptr ? nullptr : &(*chunk)[slot % chunk_size];
}

std::uintptr_t free_slot(Table& in) {
  if (!in.free.empty()) {
    const std::uintptr_t slot = in.free.back();
    in.free.pop_back();
    return slot;
  }
  if (in.used == slot_count) throw std::bad_alloc();
  if (in.used % chunk_size == 0) {
    in.free.reserve(in.used + chunk_size);  // so that take() needs no memory
    in.chunks[in.used / chunk_size].store(new Chunk, std::memory_order_release);
  }
  return in.used++;
}

/// The parameter that has a handle of this kind.
const char* parameter_of(Kind kind) {
  switch (kind) {
    case Kind::scene:
      return "scene";
    case Kind::world:
      return "world";
    case Kind::state:
      return "state";
    case Kind::writer:
      return "writer";
    default:
      return "handle";
  }
}

/// The slot of a handle, under the lock.
Slot& require_slot(const void* handle, Kind kind) {
  require(handle, parameter_of(kind));
  Slot* slot = slot_of(handle);
  if (slot == nullptr || slot->handle.load() != reinterpret_cast<std::uintptr_t>(handle))
    throw StatusError(PLIANT_STALE, std::string("'") + parameter_of(kind) + "' refers to nothing",
                      "it was freed, or is no handle of this library");
  if (static_cast<Kind>(reinterpret_cast<std::uintptr_t>(handle) % (1 << kind_bits)) != kind)
    throw StatusError(PLIANT_STALE, std::string("'") + parameter_of(kind) + "' is a handle of another kind",
                      "pass the one that the parameter's type names");
  return *slot;
}

}  // namespace

void* put(std::shared_ptr<void> what, Kind kind) {
  Table& in = table();
  const std::lock_guard lock(in.mutex);
  const std::uintptr_t number = free_slot(in);
  Slot& slot = (*in.chunks[number / chunk_size].load())[number % chunk_size];
  const std::uintptr_t handle =
      ((slot.generation++ << slot_bits | number) << kind_bits) | static_cast<std::uintptr_t>(kind);
  slot.what = std::move(what);
  slot.stop.store(false);
  slot.handle.store(handle);
  return reinterpret_cast<void*>(handle);
}

Kept find(const void* handle, Kind kind) {
  const std::lock_guard lock(table().mutex);
  Slot& slot = require_slot(handle, kind);
  return {slot.what, &slot.stop};
}

std::shared_ptr<void> take(const void* handle, Kind kind) {
  Table& in = table();
  const std::lock_guard lock(in.mutex);
  Slot& slot = require_slot(handle, kind);
  slot.handle.store(0);
  in.free.push_back((reinterpret_cast<std::uintptr_t>(handle) >> kind_bits) % slot_count);
  return std::move(slot.what);  // what it held is destroyed after the lock is released
}

std::atomic<bool>* stop_flag(const void* handle) noexcept {
  const auto value = reinterpret_cast<std::uintptr_t>(handle);
  if (static_cast<Kind>(value % (1 << kind_bits)) != Kind::world) return nullptr;
  Slot* slot = slot_of(handle);
  return slot == nullptr || slot->handle.load() != value ? nullptr : &slot->stop;
}

}  // namespace pliant::c
