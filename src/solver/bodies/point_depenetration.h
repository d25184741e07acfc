// Moves surfaces and ropes out of the solids of bodies in which they start, or into which they are teleported.
// The way is that of ways_out.h.
//
// Whether something is deep inside depends on positions at the substep's start alone, so a State need not keep it.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "collision/narrow/contact.h"
#include "geometry/convex_shape.h"
#include "solver/bodies/body_solids.h"
#include "solver/ways_out.h"

namespace pliant {

struct Substep;

class PointDepenetration {
 public:
  PointDepenetration() = default;
  explicit PointDepenetration(const std::vector<ConvexShape>& shapes) : shapes_(shapes) {}

  /// What is deep inside of a solid in the last substep.
  struct Inside {
    WayOut way;
    std::vector<int> points;  ///< of the State, ascending
  };

  /// Replaces the contacts of points that are deep inside of a solid, and removes those of their objects with it that
  /// would hold them back.
  void replace(const Substep& s, const BodySolids& solids, std::vector<Contact>& contacts);
  /// True if a contact would hold back what is led out of the contact's solid (holds_back of ways_out.h).
  bool leads_out(const Substep& s, const BodySolids& solids, const Contact& contact) const;
  /// By object, then by solid.
  const std::vector<Inside>& inside() const { return inside_; }
  /// Adds a warning for each object and body.
  void warn(const Substep& s, const BodySolids& solids, std::vector<std::string>& warnings) const;

 private:
  TouchedSolid solid_of(const BodySolids& solids, int solid) const;
  void find(const Substep& s, const BodySolids& solids, const std::vector<Contact>& contacts);

  std::vector<ConvexShape> shapes_;  ///< of solids
  std::vector<Inside> inside_;
};

}  // namespace pliant
