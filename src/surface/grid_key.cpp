// A hash table of the cells of a grid.
#include "surface/grid_key.h"

#include <utility>

namespace pliant::surface {

KeyTable::KeyTable(std::size_t expected) {
  std::size_t slots = 16;
  while (slots < 2 * expected) slots *= 2;
  slots_.resize(slots);
}

/// The slot that has the key, or the free one where it belongs.
std::size_t KeyTable::slot_of(std::uint64_t key) const {
  std::uint64_t mixed = key * 0x9e3779b97f4a7c15U;  // Fibonacci hashing
  mixed ^= mixed >> 32;
  std::size_t slot = static_cast<std::size_t>(mixed) & (slots_.size() - 1);
  while (slots_[slot].index >= 0 && slots_[slot].key != key) slot = (slot + 1) & (slots_.size() - 1);
  return slot;
}

int KeyTable::find(std::uint64_t key) const { return slots_[slot_of(key)].index; }

bool KeyTable::insert(std::uint64_t key) {
  Slot& slot = slots_[slot_of(key)];
  if (slot.index >= 0) return false;
  slot = {key, static_cast<int>(size_++)};
  if (2 * size_ > slots_.size()) grow();
  return true;
}

void KeyTable::grow() {
  std::vector<Slot> before = std::exchange(slots_, std::vector<Slot>(2 * slots_.size()));
  for (const Slot& slot : before)
    if (slot.index >= 0) slots_[slot_of(slot.key)] = slot;
}

}  // namespace pliant::surface
