// What VTK unstructured grids as text and as bytes have in common. `From` is the reader, whose fail() throws an Error
// at its place.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tetra_builder.h"

namespace pliant {

/// The corners of cells, of which those of type 10 are linear tetrahedra, and the lines where they stand; 0 of bytes.
struct VtkCells {
  std::vector<std::vector<std::int64_t>> corners;
  std::vector<int> lines;

  void add(std::vector<std::int64_t> cell, int line) {
    corners.push_back(std::move(cell));
    lines.push_back(line);
  }
};

/// Adds the next of the offsets at which cells begin (version 5.1).
template <class From>
void add_vtk_offset(const From& from, std::int64_t next, std::int64_t corners, std::vector<std::int64_t>& offsets) {
  if (next < (offsets.empty() ? 0 : offsets.back()) || next > corners || (offsets.empty() && next != 0))
    from.fail("offset " + std::to_string(offsets.size()) + " is " + std::to_string(next),
              "offsets ascend from 0 to the number of corners, " + std::to_string(corners));
  offsets.push_back(next);
}

/// Adds the cells that are tetrahedra, of as many types as there are cells; next() reads one. Points, lines and
/// polygons are passed over.
template <class From, class Next>
void add_vtk_tetrahedra(const From& from, const VtkCells& cells, std::int64_t types, const Next& next,
                        TetraBuilder& builder) {
  constexpr std::int64_t tetrahedron = 10, highest_flat = 9;
  if (static_cast<std::size_t>(types) != cells.corners.size())
    from.fail(std::to_string(types) + " types for " + std::to_string(cells.corners.size()) + " cells",
              "the file is damaged");
  for (std::size_t i = 0; i < cells.corners.size(); ++i) {
    const std::int64_t type = next();
    if (type >= 1 && type <= highest_flat) continue;
    const std::vector<std::int64_t>& c = cells.corners[i];
    if (type != tetrahedron || c.size() != 4)
      from.fail("cell " + std::to_string(i) + " has type " + std::to_string(type) + " and " + std::to_string(c.size()) +
                    " corners, which is no linear tetrahedron (10)",
                "write linear tetrahedra alone");
    builder.add_tetrahedron({c[0], c[1], c[2], c[3]}, cells.lines[i]);
  }
}

}  // namespace pliant
