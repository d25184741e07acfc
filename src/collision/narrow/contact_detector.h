// Creates contacts for pairs that may come within their thickness in a substep.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "collision/narrow/covered_pairs.h"
#include "collision/narrow/flush_contacts.h"
#include "collision/narrow/pair_contact.h"
#include "collision/near/neighbourhood.h"

namespace pliant {

/// The contacts of one near list in the order of its blocks; scratch memory.
struct ListContacts {
  std::vector<Contact> contacts;
  std::vector<int> lane;                                    ///< of each contact in its block
  std::vector<std::pair<std::int32_t, std::int32_t>> rank;  ///< of each contact, and its index

  void clear();
};

class ContactDetector {
 public:
  explicit ContactDetector(const PairModel& model) : covered_(model.elements, model.triangles_around), flush_(model) {}

  /// Finds the contacts of the substep: those of static neighbour pairs first, then all others, each ordered by
  /// clusters. Returns the number of the former. Pairs for which `is_exempt` returns true are skipped.
  std::size_t detect(Executor& executor, Neighbourhood& near, const PairParticles& particles,
                     FunctionRef<bool(const PairStencil&)> is_exempt, std::vector<Contact>& contacts);

 private:
  /// Scratch memory of one thread.
  struct Scratch {
    ListContacts of_list;
    std::vector<Contact> of_groups, of_lists;
  };

  CoveredPairs covered_;
  FlushContacts flush_;
  std::vector<Scratch> scratch_;
};

}  // namespace pliant
