// Constraints that break by their force (ConstraintGroup::break_force).
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "pliant/edit.h"

namespace pliant {

/// True if C of a constraint type over its compliance is a force: lengths, limits of them, and ties to places.
bool breaks_by_force(const std::string& type);

/// True if constraints of an object can break.
bool can_break(const Object& object);

/// The Edit that removes the constraints whose force at these positions is beyond that at which they break; nothing if all hold.
/// `factor(group)` is the present factor of a group's rest data.
std::optional<Edit> break_constraints(const Object& object, std::span<const Vec3f> positions,
                                      const std::function<float(int group)>& factor);

}  // namespace pliant
