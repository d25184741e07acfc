// States: copies of all that changes with time.
#include <cstddef>

#include "memory.h"
#include "pliant/save.h"
#include "world_handle.h"

namespace pliant::c {

struct StateHandle {
  State state;
};

}  // namespace pliant::c

using namespace pliant;
using namespace pliant::c;

pliant_status pliant_state_copy(const pliant_world* world, pliant_state** state) {
  return guarded([&] {
    const auto of = at(world);
    require(state, "state");
    give_handle(std::make_shared<StateHandle>(StateHandle{of->world.state()}), state);
  });
}

pliant_status pliant_state_restore(pliant_world* world, const pliant_state* state) {
  return guarded([&] {
    const auto of = at(world);
    of->world.restore(at(state)->state);
    of->report = {};
  });
}

pliant_status pliant_state_hash(const pliant_state* state, char* into, size_t capacity, size_t* length) {
  return guarded([&] { give_text(hash(at(state)->state), {into, capacity, length}); });
}

pliant_status pliant_state_bytes(const pliant_state* state, void* into, size_t capacity, size_t* count) {
  return guarded([&] {
    const std::vector<std::byte> bytes = save_bytes(at(state)->state);
    give_list<std::byte>(bytes, {static_cast<std::byte*>(into), capacity, count}, "bytes");
  });
}

pliant_status pliant_state_from_bytes(const void* bytes, size_t count, pliant_state** state) {
  return guarded([&] {
    require(bytes, "bytes");
    require(state, "state");
    const std::span<const std::byte> given(static_cast<const std::byte*>(bytes), count);
    give_handle(std::make_shared<StateHandle>(StateHandle{load_state_bytes(given)}), state);
  });
}

pliant_status pliant_state_free(pliant_state* state) { return free_handle(state); }
