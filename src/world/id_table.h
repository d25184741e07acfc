// A table of the ids of one kind of thing (objects, colliders) and the World's internal numbers for them.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "pliant/error.h"
#include "pliant/world.h"

namespace pliant {

/// Maps valid ids to internal numbers. An id has a generation, by which the id of a removed thing is known to be stale.
template <class Kind>
class IdTable {
 public:
  explicit IdTable(std::string kind) : kind_(std::move(kind)) {}

  using LayoutSlot = WorldLayout::Slot;

  /// Replaces the table by slots that layout() returned.
  void restore(const std::vector<LayoutSlot>& slots) {
    slots_.clear();
    free_.clear();
    for (int slot = 0; slot < static_cast<int>(slots.size()); ++slot) {
      slots_.push_back({slots[slot].number < 0 ? none : slots[slot].number, slots[slot].generation});
      if (slots_.back().number == none) free_.insert(slot);
    }
  }
  std::vector<LayoutSlot> layout() const {
    std::vector<LayoutSlot> slots;
    for (const Slot& slot : slots_) slots.push_back({slot.number, slot.generation});
    return slots;
  }

  /// Makes an id for an internal number, in the lowest free slot.
  Id<Kind> add(int number) {
    if (free_.empty()) {
      slots_.push_back({number, 0});
      return Id<Kind>(static_cast<int>(slots_.size()) - 1, 0);
    }
    const int slot = *free_.begin();
    free_.erase(free_.begin());
    slots_[slot].number = number;
    return Id<Kind>(slot, slots_[slot].generation);
  }

  void remove(Id<Kind> id) {
    (void)number(id);  // throws an Error if the id is stale
    slots_[id.slot].number = none;
    ++slots_[id.slot].generation;
    free_.insert(id.slot);
  }

  bool has(Id<Kind> id) const {
    return id.slot >= 0 && id.slot < static_cast<int>(slots_.size()) && slots_[id.slot].number != none &&
           slots_[id.slot].generation == id.generation;
  }

  /// The internal number of an id. Throws an Error if the id is unknown or stale.
  int number(Id<Kind> id) const {
    if (has(id)) return slots_[id.slot].number;
    const bool existed =
        id.slot >= 0 && id.slot < static_cast<int>(slots_.size()) && id.generation < slots_[id.slot].generation;
    throw Error({}, "there is no " + kind_ + " " + words(id) + (existed ? " any more" : ""),
                !existed ? "use an id that this World returned"
                : slots_[id.slot].number == none
                    ? "it was removed; use the id of one that exists"
                    : "it was removed, and its slot has generation " + std::to_string(slots_[id.slot].generation) +
                          " now; use the id that add returned for that one");
  }

  /// The id of an internal number.
  Id<Kind> id_of(int number) const {
    for (int slot = 0; slot < static_cast<int>(slots_.size()); ++slot)
      if (slots_[slot].number == number) return Id<Kind>(slot, slots_[slot].generation);
    return {};
  }

  /// The first id, by slot, whose internal number passes; empty if none does.
  template <class Passes>
  std::optional<Id<Kind>> first(Passes passes) const {
    for (int slot = 0; slot < static_cast<int>(slots_.size()); ++slot)
      if (slots_[slot].number != none && passes(slots_[slot].number)) return Id<Kind>(slot, slots_[slot].generation);
    return std::nullopt;
  }

  std::vector<Id<Kind>> all() const {
    std::vector<Id<Kind>> ids;
    for (int slot = 0; slot < static_cast<int>(slots_.size()); ++slot)
      if (slots_[slot].number != none) ids.push_back(Id<Kind>(slot, slots_[slot].generation));
    return ids;
  }
  int count() const { return static_cast<int>(slots_.size() - free_.size()); }

  /// Call it after an internal number was removed: larger numbers decrease by one.
  void close_gap(int number) {
    for (Slot& slot : slots_) slot.number -= slot.number > number ? 1 : 0;
  }

 private:
  static constexpr int none = -1;
  struct Slot {
    int number, generation;
  };
  static std::string words(Id<Kind> id) {
    return std::to_string(id.slot) + (id.generation == 0 ? "" : " of generation " + std::to_string(id.generation));
  }

  std::string kind_;
  std::vector<Slot> slots_;
  std::set<int> free_;
};

}  // namespace pliant
