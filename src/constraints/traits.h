// What the library may ask of a constraint type, instead of which type it is.
#pragma once

#include "pliant/formula.h"

namespace pliant {

template <class T>
inline constexpr int slot_count = T::slots::count;

/// Numbers of rest data, after which a pool's rows hold the response and the damping.
template <class T>
inline constexpr int rest_fields = static_cast<int>(T::fields.size());

/// Whether a type is projected sixteen at a time: one row over points. Every other goes one by one (solver/stencil.cpp).
template <class T>
inline constexpr bool in_lanes = T::slots::frames == 0 && T::rows == 1;

/// Whether every gradient has length one wherever it is not zero, so that the driver need not compute its norm.
template <class T>
inline constexpr bool has_unit_gradients = [] {
  if constexpr (requires { T::unit_gradients; })
    return T::unit_gradients;
  else
    return false;
}();

}  // namespace pliant
