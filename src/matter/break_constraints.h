// Constraints that break by their force (ConstraintGroup::break_force).
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pliant/edit.h"

namespace pliant {

/// True if C of a constraint type over its compliance is a force: lengths, limits of them, and ties to places.
bool breaks_by_force(const std::string& type);

/// True if constraints of an object can break.
bool can_break(const Object& object);

/// What the forces of an object's constraints are known from.
struct KnownForces {
  std::span<const Vec3d> positions;        ///< with what floats cannot hold [m]
  std::function<float(int group)> factor;  ///< the present factor of a group's rest data
  /// Multipliers over h^2 [N] of all constraints of a type, row by row, in the order of the groups; empty: unknown.
  std::function<std::vector<float>(const std::string& type)> multipliers;
  double h = 0;  ///< length of the last substep; 0: the multipliers are unknown [s]
};

/// By how much rounding in the solve changes the elongation of a constraint between points at most that far apart [m].
double rounding_of_elongation(double distance);

/// The Edit that removes the constraints whose force is beyond that at which they break; nothing if all hold.
/// Multipliers tell the force, or where rounding makes them coarse |C| over the compliance. Lengths break by a pull
/// alone. Of links in a row, as those of a rope, only the one with the greatest force over its limit is removed,
/// because that relieves the others.
std::optional<Edit> break_constraints(const Object& object, const KnownForces& known);

}  // namespace pliant
