// Creates contacts for pairs that may come within their thickness in a substep.
#pragma once

#include <cstdint>
#include <vector>

#include "collision/narrow/covered_pairs.h"
#include "collision/narrow/pair_contact.h"
#include "collision/near/neighbourhood.h"

namespace pliant {

class ContactDetector {
 public:
  explicit ContactDetector(const PairModel& model) : covered_(model.elements, model.triangles_around) {}

  /// Finds the contacts of the substep: those of static neighbour pairs first, then all others, each ordered by
  /// clusters. Returns the number of the former. Pairs for which `is_exempt` returns true are skipped.
  std::size_t detect(Executor& executor, Neighbourhood& near, const PairParticles& particles,
                     FunctionRef<bool(const PairStencil&)> is_exempt, std::vector<Contact>& contacts);

 private:
  /// Scratch memory of one thread.
  struct Scratch {
    std::vector<std::int32_t> near;
    std::vector<Contact> of_groups, of_lists;
  };

  CoveredPairs covered_;
  std::vector<Scratch> scratch_;
};

}  // namespace pliant
