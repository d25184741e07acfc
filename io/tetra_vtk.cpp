// Reads legacy VTK unstructured grids; tetra_vtk_binary.cpp those whose numbers are bytes (Kitware, "VTK file formats"): POINTS, CELLS and CELL_TYPES, in the layout of version 2 to 4
// and in that of 5.1. Data of points and cells, which follow, are not read.
#include <vector>

#include "tetra_builder.h"
#include "tetra_formats.h"
#include "tetra_text.h"

namespace pliant {

namespace {

struct Cells {
  std::vector<std::vector<std::int64_t>> corners;
  std::vector<int> lines;
};

/// The first line, the title, which may be empty, and the word that says whether text or bytes follow.
std::string_view read_head(WordReader& words) {
  if (!words.next_line() || words.here() != "#")
    words.fail("is no VTK file", "its first line is '# vtk DataFile Version ...'");
  words.skip_line();
  const std::string_view first = words.word();
  if (first == "ASCII" || first == "BINARY") return first;
  words.skip_line();
  return words.word();
}

/// True if numbers follow as bytes.
bool read_format(WordReader& words) {
  std::string_view word = read_head(words);
  if (word == "BINARY") return true;
  if (word != "ASCII") words.fail(quoted(word) + " is where 'ASCII' should be", "the file is no legacy VTK file");
  words.expect("DATASET");
  word = words.word();
  if (word != "UNSTRUCTURED_GRID") words.fail(quoted(word) + " has no tetrahedra", "write an UNSTRUCTURED_GRID");
  return false;
}

void read_points(WordReader& words, TetraBuilder& builder) {
  const std::int64_t count = words.count("the number of points");
  words.word();  // float or double
  for (std::int64_t i = 0; i < count; ++i) {
    const float x = words.real("x"), y = words.real("y"), z = words.real("z");
    builder.add_node(i, {x, y, z}, words.line());
  }
}

void add_cell(WordReader& words, std::int64_t corners, Cells& cells) {
  if (corners < 1 || corners > 1000000)
    words.fail("a cell has " + std::to_string(corners) + " corners", "the file is damaged");
  std::vector<std::int64_t> all;
  for (std::int64_t i = 0; i < corners; ++i) all.push_back(words.integer("a corner"));
  cells.corners.push_back(std::move(all));
  cells.lines.push_back(words.line());
}

/// Version 5.1: where the corners of each cell begin, then all corners.
void read_offsets(WordReader& words, std::int64_t offsets, std::int64_t size, Cells& cells) {
  words.word();  // vtktypeint64
  std::vector<std::int64_t> at;
  for (std::int64_t i = 0; i < offsets; ++i) {
    at.push_back(words.integer("an offset"));
    if (at.front() != 0 || at.back() < (i == 0 ? 0 : at[at.size() - 2]) || at.back() > size)
      words.fail("offset " + std::to_string(i) + " is " + std::to_string(at.back()),
                 "offsets ascend from 0 to the number of corners, " + std::to_string(size));
  }
  words.expect("CONNECTIVITY");
  words.word();
  for (std::size_t i = 1; i < at.size(); ++i) add_cell(words, at[i] - at[i - 1], cells);
}

/// Versions up to 4: each cell is the number of its corners, and then these. `corners` is the first number.
void read_counted(WordReader& words, std::int64_t corners, std::int64_t count, std::int64_t size, TetraBuilder& builder,
                  Cells& cells) {
  std::int64_t found = 0;
  for (std::int64_t i = 0; i < count; ++i) {
    if (i > 0) corners = words.integer("a number of corners");
    add_cell(words, corners, cells);
    found += corners + 1;
  }
  if (found != size)
    builder.note("its cells have " + std::to_string(found) + " integers, where it says " + std::to_string(size));
}

void read_cells(WordReader& words, TetraBuilder& builder, Cells& cells) {
  const std::int64_t count = words.count("the number of cells"), size = words.integer("the number of integers");
  if (count == 0) return;
  const std::string_view first = words.word();
  if (first == "OFFSETS") return read_offsets(words, count, size, cells);
  std::int64_t corners = 0;
  if (!parse_integer(first, corners)) words.fail(quoted(first) + " is no number of corners", "the file is damaged");
  read_counted(words, corners, count, size, builder, cells);
}

void add_tetrahedra(WordReader& words, const Cells& cells, TetraBuilder& builder) {
  const std::int64_t count = words.count("the number of cell types");
  if (static_cast<std::size_t>(count) != cells.corners.size())
    words.fail(std::to_string(count) + " types for " + std::to_string(cells.corners.size()) + " cells",
               "the file is damaged");
  for (std::size_t i = 0; i < cells.corners.size(); ++i) {
    const std::int64_t type = words.integer("the type of a cell");
    if (type >= 1 && type <= vtk_highest_flat) continue;
    if (type != vtk_tetrahedron)
      words.fail(
          "cell " + std::to_string(i) + " has type " + std::to_string(type) + ", which is no linear tetrahedron (10)",
          "write linear tetrahedra alone");
    const std::vector<std::int64_t>& c = cells.corners[i];
    if (c.size() != 4)
      words.fail("tetrahedron " + std::to_string(i) + " has " + std::to_string(c.size()) + " corners",
                 "the file is damaged");
    builder.add_tetrahedron({c[0], c[1], c[2], c[3]}, cells.lines[i]);
  }
}

}  // namespace

TetrahedralMeshFile read_vtk(std::string_view bytes, const std::string& name) {
  WordReader words(bytes, name, 0);
  TetraBuilder builder(name);
  Cells cells;
  if (read_format(words)) return read_binary_vtk(bytes, words.offset(), name);
  for (;;) {
    const std::string_view keyword = words.word();
    if (keyword == "POINTS") {
      read_points(words, builder);
    } else if (keyword == "CELLS") {
      read_cells(words, builder, cells);
    } else if (keyword == "CELL_TYPES") {
      add_tetrahedra(words, cells, builder);
      return builder.result();
    } else if (keyword.empty()) {
      words.fail("ends before its CELL_TYPES", "the file is cut off: export it again");
    } else {
      words.skip_line();
    }
  }
}

}  // namespace pliant
