// The constants of solving chains again (stages/solve_again.cpp).
#pragma once

namespace pliant {

/// The share of their thickness by which contacts among surfaces may overlap after their first projection, where chains
/// pull them together. The filter keeps surfaces apart by a twentieth (near/neighbourhood.h).
inline constexpr float overlap_left = 0.3f;

}  // namespace pliant
