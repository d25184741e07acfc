// What solving chains again (stages/solve_again.cpp) shares with other stages.
#pragma once

#include <string>
#include <vector>

namespace pliant {

struct Model;
struct State;
struct Substep;

/// The share of their thickness by which contacts among surfaces may overlap after their first projection, where chains
/// pull them together. The filter keeps surfaces apart by a twentieth (near/neighbourhood.h).
inline constexpr float overlap_left = 0.3f;

/// Closes rigid stitches that the chains have pulled open.
void close_stitches(Substep& s);

/// Names the rigid stitch that is open farthest in each object, beyond 1 mm at the end of a frame. Threads that
/// keyframes will shorten further are left out.
void warn_of_stitches(const Model& model, const State& state, std::vector<std::string>& warnings);

}  // namespace pliant
