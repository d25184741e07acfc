// Properties that the library queries of a constraint type, instead of its identity.
#pragma once

#include "pliant/formula.h"

namespace pliant {

template <class T>
inline constexpr int slot_count = T::slots::count;

/// The number of rest fields; in a pool's rows the response and the damping follow them.
template <class T>
inline constexpr int rest_fields = static_cast<int>(T::fields.size());

/// True if constraints are projected sixteen at a time: one row, points only. Others go singly (solver/stencil.cpp).
template <class T>
inline constexpr bool in_lanes = T::slots::frames == 0 && T::rows == 1;

/// True if every gradient has length one unless it vanishes, so the driver skips its norm.
template <class T>
inline constexpr bool has_unit_gradients = [] {
  if constexpr (requires { T::unit_gradients; })
    return T::unit_gradients;
  else
    return false;
}();

}  // namespace pliant
