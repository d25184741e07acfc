// Handles are numbers in the guise of pointers: a slot of a table, its generation and a kind. A stale handle is
// recognised without touching the memory of what was freed, and gives a status.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>

#include "errors.h"

namespace pliant::c {

enum class Kind : std::uint8_t { none, scene, world, state, writer };

/// What a slot of the table holds, and the flag that stops it if it is a World. The flag lives as long as the process,
/// so that signal handlers can set it without a lock.
struct Kept {
  std::shared_ptr<void> what;
  std::atomic<bool>* stop = nullptr;
};

/// Puts something into the table and returns its handle. Throws std::bad_alloc if the table is full.
void* put(std::shared_ptr<void> what, Kind kind);
/// Finds it again. It stays until the caller lets it go, even if another thread frees its handle. Throws a StatusError
/// if the handle is null, stale or of another kind.
Kept find(const void* handle, Kind kind);
/// Takes it out of the table, so that the handle is stale. Throws as find() does.
std::shared_ptr<void> take(const void* handle, Kind kind);
/// The flag of a World, without lock or exception; null if the handle is stale.
std::atomic<bool>* stop_flag(const void* handle) noexcept;

struct SceneHandle;
struct WorldHandle;
struct StateHandle;
struct WriterHandle;

/// What handles of a C type refer to, and their kind.
template <class What, Kind of_kind>
struct Refers {
  using Type = What;
  static constexpr Kind kind = of_kind;
};

template <class Handle>
struct HandleOf;
template <>
struct HandleOf<pliant_scene> : Refers<SceneHandle, Kind::scene> {};
template <>
struct HandleOf<pliant_world> : Refers<WorldHandle, Kind::world> {};
template <>
struct HandleOf<pliant_state> : Refers<StateHandle, Kind::state> {};
template <>
struct HandleOf<pliant_writer> : Refers<WriterHandle, Kind::writer> {};

/// What a handle refers to.
template <class Handle>
std::shared_ptr<typename HandleOf<Handle>::Type> at(const Handle* handle) {
  return std::static_pointer_cast<typename HandleOf<Handle>::Type>(find(handle, HandleOf<Handle>::kind).what);
}

/// Makes a handle and gives it to the caller.
template <class Handle>
void give_handle(std::shared_ptr<typename HandleOf<Handle>::Type> what, Handle** into) {
  *into = static_cast<Handle*>(put(std::move(what), HandleOf<Handle>::kind));
}

/// Frees a handle; null is accepted.
template <class Handle>
pliant_status free_handle(Handle* handle) noexcept {
  return guarded([&] {
    if (handle != nullptr) take(handle, HandleOf<Handle>::kind);
  });
}

}  // namespace pliant::c
