// Moves surfaces and ropes out of the solids of bodies in which they start, or into which they are teleported.
//
// Contact moves each point to the side of the solid that is nearest to it. What begins deep inside of a solid would be
// torn to all sides, and what it stores in stretch would throw it out: a cloth of 10 cm in the middle of a box flew off
// with 455 m/s. So what is deep inside moves along one direction, at 1 m/s. All its points keep their distances, and
// contact takes back the speed along the normal. There is no friction.
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

namespace pliant {

struct Substep;

class PointDepenetration {
 public:
  PointDepenetration() = default;
  explicit PointDepenetration(const std::vector<ConvexShape>& shapes) : shapes_(shapes) {}

  /// What is deep inside of a solid in the last substep.
  struct Inside {
    int object = 0, solid = 0;
    std::vector<int> points;  ///< of the State, ascending
  };

  /// Replaces the contacts of points that are deep inside of a solid, and of elements with such points.
  void replace(const Substep& s, const BodySolids& solids, std::vector<Contact>& contacts);
  /// By object, then by solid.
  const std::vector<Inside>& inside() const { return inside_; }
  /// Adds a warning for each object and body.
  void warn(const Substep& s, const BodySolids& solids, std::vector<std::string>& warnings) const;

 private:
  void find(const Substep& s, const BodySolids& solids, const std::vector<Contact>& contacts);

  std::vector<ConvexShape> shapes_;  ///< of solids
  std::vector<Inside> inside_;
  std::vector<Vec3f> directions_;  ///< of inside_, in the frame of the solid
};

}  // namespace pliant
