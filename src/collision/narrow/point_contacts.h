// Contacts of free particles with one another: spheres of their thickness, found by their swept boxes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "collision/broad/bounds.h"
#include "collision/broad/tree.h"
#include "collision/narrow/pair_contact.h"
#include "collision/proxies/pair_kernels.h"
#include "collision/proxies/pair_model.h"
#include "parallel/executor.h"

namespace pliant {

/// The contact of points `i` and `j`, both of the State; false where the way of one relative to the other stays clear of it. The normal
/// is that where the distance first falls to the thickness, so that a fast point that passes by is not held up.
bool find_point_contact(int i, int j, const PairMaterial& material, const PairParticles& particles, Contact& contact);

class PointContacts {
 public:
  explicit PointContacts(const PairModel& model) : model_(model) {}

  /// Appends those of all of model.free_points that meet, in ascending order of their points.
  void detect(Executor& executor, const PairParticles& particles, std::vector<Contact>& contacts);

 private:
  const PairModel& model_;
  std::vector<BoxBounds> boxes_;
  Tree<BoxBounds> tree_;
  struct Task {
    std::vector<int> packs, hits;
    std::vector<std::array<std::int32_t, 2>> pairs;
  };
  std::vector<Task> tasks_;
  std::vector<std::array<std::int32_t, 2>> pairs_;
};

}  // namespace pliant
