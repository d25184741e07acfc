// Properties of constraint types. The library queries them, so that no other code needs to name a type.
#pragma once

#include "pliant/formula.h"

namespace pliant {

template <class T>
inline constexpr int slot_count = T::slots::count;

/// The number of rest fields of a type. In a pool's rows the response and the damping follow them.
template <class T>
inline constexpr int rest_fields = static_cast<int>(T::fields.size());

/// True if sixteen constraints are projected at once: one row, points only. Others go one at a time
/// (solver/stencil.cpp).
template <class T>
inline constexpr bool in_lanes = T::slots::frames == 0 && T::rows == 1;

/// True if a type computes so much that how its points are loaded does not count: it is compiled for fewer cases.
template <class T>
inline constexpr bool is_arithmetic = requires {
  T::is_arithmetic;
};

/// True if constraints of the type make up an elastic solid, which gives way too far by a known share where one pass
/// solves it (solver/project.h).
template <class T>
inline constexpr bool is_of_solid = requires {
  T::is_of_solid;
};

/// True if one pass a substep leaves constraints of the type too soft by a known share, which a projection takes off:
/// those of solids, and of the triangles of woven cloth.
template <class T>
inline constexpr bool is_led = is_of_solid<T> || requires {
  T::is_of_woven;
};

/// True if C is the length of a strain of a tetrahedron, whose direction it does not see
/// (constraints/tetrahedron_strain.h).
template <class T>
inline constexpr bool measures_strain = [] {
  if constexpr (requires { T::is_length_of_strain; })
    return T::is_length_of_strain;
  else
    return false;
}();

/// True if C^2 is the sum of the squares of two parts and a constant, and a projection along the gradient of C fails
/// where T::needs_split says so.
template <class T>
inline constexpr bool can_split = requires {
  T::template needs_split<float>;
};

/// True if every gradient has length one unless it vanishes, so the driver skips its norm.
template <class T>
inline constexpr bool has_unit_gradients = [] {
  if constexpr (requires { T::unit_gradients; })
    return T::unit_gradients;
  else
    return false;
}();

}  // namespace pliant
