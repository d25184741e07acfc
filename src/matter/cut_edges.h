// Cuts surfaces along edges of their triangles.
#pragma once

#include <array>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "matter/around.h"
#include "pliant/edit.h"

namespace pliant {

/// The two particles of an edge, the lower one first.
using EdgeEnds = std::pair<int, int>;
inline EdgeEnds edge_of(int a, int b) { return a < b ? EdgeEnds{a, b} : EdgeEnds{b, a}; }

inline bool has_corner(const std::array<int, 3>& t, int particle) {
  return t[0] == particle || t[1] == particle || t[2] == particle;
}

/// Throws an Error if a triangle uses a particle that does not exist.
void require_triangles(const Object& object);

/// The triangles of a stencil: those that contain both of its two particles, or for larger stencils those with all
/// corners in it. Slots below 0 are none. `around` knows of all of its particles.
std::vector<int> triangles_of(const std::vector<int>& stencil, const Object& object, const Around& around);

/// The edges between triangles of different `part`, one number for each triangle. Throws an Error if a triangle uses a
/// particle that does not exist.
std::set<EdgeEnds> edges_between(const Object& object, std::span<const int> part);

/// The Edit that opens a surface along these edges (pliant/edit.h: cut). Particles that have 1 in `whole` are not
/// split.
Edit cut_edges(const Object& object, const std::set<EdgeEnds>& edges, const std::vector<char>& whole = {});

}  // namespace pliant
