// Cuts soft bodies along faces of their tetrahedra.
#pragma once

#include <array>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "pliant/edit.h"

namespace pliant {

/// Three particles, ascending.
using Face = std::array<int, 3>;

/// A face between two tetrahedra.
struct InnerFace {
  Face face{};
  int a = 0, b = 0;  ///< the tetrahedra; a < b
};

/// The tetrahedra of an object. Throws an Error, with this advice, if it has none, or if one uses a particle that does
/// not exist.
std::vector<std::array<int, 4>> required_tetrahedra(
    const Object& object, const std::string& advice = "use cut or part_triangles for surfaces");

/// The faces between tetrahedra, ascending: those whose corners all have 1 in `at`, or all if that is empty, and that
/// are `wanted`.
std::vector<InnerFace> inner_faces(
    const std::vector<std::array<int, 4>>& tetrahedra, const std::vector<char>& at,
    const std::function<bool(const Face&)>& wanted = [](const Face&) { return true; });

/// The Edit that opens a soft body along these faces. A particle of them is split into one for each fan of tetrahedra
/// around it that share other faces, unless it has 1 in `whole`.
Edit cut_faces(const Object& object, const std::set<Face>& faces, const std::vector<char>& whole = {});

}  // namespace pliant
