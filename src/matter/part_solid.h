// Parts soft bodies at some of their particles.
#pragma once

#include <array>
#include <set>
#include <vector>

#include "matter/cut_faces.h"
#include "pliant/edit.h"

namespace pliant {

/// How a soft body comes apart.
struct SolidParting {
  std::vector<std::array<int, 4>> tetrahedra;  ///< of the object
  std::vector<char> removed;  ///< by tetrahedron: 1 if it goes; empty: none goes. Its corners are `reached`
  std::set<Face> open;        ///< faces along which tetrahedra come apart
  std::vector<char> reached;  ///< by particle: 1 if it may split
};

/// The Edit of a soft body that comes apart.
Edit part_solid(const Object& object, SolidParting parting);

}  // namespace pliant
