// Fibres in an elastic solid: muscles (pliant/soft_body.h).
#pragma once

#include <array>
#include <vector>

#include "pliant/soft_body.h"

namespace pliant {

/// Upper limits of moduli [Pa], and of compliances and dampings: over the square of a substep, a larger one would
/// overflow.
inline constexpr double largest_modulus = 1e15, largest_response = 1e26;

/// Adds a "fibre" constraint for each of a body's tetrahedra that has one. Their damping over their stiffness is
/// `damping_time` [s]; a group has one damping, so with damping there is a group for each size of tetrahedra, each with
/// the same keyframes. Throws an Error that names a tetrahedron whose direction cannot be used, or a number that is out
/// of range.
void add_fibres(const Fibres& fibres, double damping_time, const std::vector<std::array<int, 4>>& tetrahedra,
                Object& body);

}  // namespace pliant
