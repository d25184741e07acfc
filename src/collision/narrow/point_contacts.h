// Contacts of free particles with one another and with lines (ropes): spheres and capsules with the radius of their
// thickness, found by swept boxes.
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

/// The contact of points `i` and `j` of the State; false if their relative path stays clear. The normal is taken where
/// the distance first reaches the thickness, so that a fast point that passes by is not stopped.
bool find_point_contact(int i, int j, const PairMaterial& material, const PairParticles& particles, Contact& contact);

/// The contact of point `i` with the line between points `a` and `b`, at the place that is nearest at the substep's
/// start; false if their relative path stays clear.
bool find_line_contact(int i, const std::array<int, 2>& line, const PairMaterial& material,
                       const PairParticles& particles, Contact& contact);

class PointContacts {
 public:
  explicit PointContacts(const PairModel& model) : model_(model) {}

  /// Appends the contacts between all model.free_points, in ascending order of points, then those with lines.
  void detect(Executor& executor, const PairParticles& particles, std::vector<Contact>& contacts);

 private:
  /// Finds the pairs of points and lines: numbers of the point and, in model.lines, of the line.
  void detect_lines(Executor& executor, const PairParticles& particles, std::vector<Contact>& contacts);
  void detect_points(Executor& executor, const PairParticles& particles, std::vector<Contact>& contacts);
  PairMaterial material_of(int i, int j) const;
  /// Those of `points` that are there.
  const std::vector<int>& present(const std::vector<int>& points, const PairParticles& particles);
  bool meet(int i, int j) const;

  const PairModel& model_;
  std::vector<int> present_;
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
