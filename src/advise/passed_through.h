// Surfaces that passed through one another in a trial run, because nothing makes contact between them.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "pliant/world.h"

namespace pliant {

/// A warning for each object without self-collision whose triangles pass through one another now, and did not at the
/// start.
std::vector<std::string> passed_through_themselves(const Scene& scene, const World& world);

/// Watches objects that groups and masks let meet, of which one at least has no `collides`. Objects that cross at the
/// start, and pairs in which nothing is free to move, are left out.
class PassingObjects {
 public:
  explicit PassingObjects(const Scene& scene) : scene_(scene) {}

  /// Looks for crossings now; between pairs it asks whether to stop.
  void look(const World& world, const std::function<bool()>& stops);

  /// A warning for the first pair that crossed, with the number of further pairs; empty if none did.
  std::string warning() const;

 private:
  const Scene& scene_;
  std::string first_;
  std::size_t found_ = 0;
  std::set<std::pair<std::size_t, std::size_t>> done_;  ///< pairs that crossed, at the start or later
};

}  // namespace pliant
