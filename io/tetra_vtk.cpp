// Reads legacy VTK unstructured grids whose numbers are text (Kitware, "VTK file formats"): POINTS, CELLS and
// CELL_TYPES, in the layout of version 2 to 4 and in that of 5.1. Data of points and cells, which follow, are not read.
// tetra_vtk_binary.cpp reads those of bytes.
#include <vector>

#include "tetra_builder.h"
#include "tetra_formats.h"
#include "tetra_text.h"
#include "tetra_vtk.h"

namespace pliant {

namespace {

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
  if (word != "ASCII") words.fail(in_quotes(word) + " is where 'ASCII' should be", "the file is no legacy VTK file");
  words.expect("DATASET");
  word = words.word();
  if (word != "UNSTRUCTURED_GRID") words.fail(in_quotes(word) + " has no tetrahedra", "write an UNSTRUCTURED_GRID");
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

void add_cell(WordReader& words, std::int64_t corners, VtkCells& cells) {
  if (corners < 1 || corners > 1000000)
    words.fail("a cell has " + std::to_string(corners) + " corners", "the file is damaged");
  std::vector<std::int64_t> all;
  for (std::int64_t i = 0; i < corners; ++i) all.push_back(words.integer("a corner"));
  cells.add(std::move(all), words.line());
}

/// Version 5.1: where the corners of each cell begin, then all corners.
void read_offsets(WordReader& words, std::int64_t offsets, std::int64_t size, VtkCells& cells) {
  words.word();  // vtktypeint64
  std::vector<std::int64_t> at;
  for (std::int64_t i = 0; i < offsets; ++i) add_vtk_offset(words, words.integer("an offset"), size, at);
  words.expect("CONNECTIVITY");
  words.word();
  for (std::size_t i = 1; i < at.size(); ++i) add_cell(words, at[i] - at[i - 1], cells);
}

/// Versions up to 4: each cell is the number of its corners, and then these. `corners` is the first number.
void read_counted(WordReader& words, std::int64_t corners, std::int64_t count, std::int64_t size, TetraBuilder& builder,
                  VtkCells& cells) {
  std::int64_t found = 0;
  for (std::int64_t i = 0; i < count; ++i) {
    if (i > 0) corners = words.integer("a number of corners");
    add_cell(words, corners, cells);
    found += corners + 1;
  }
  if (found != size)
    builder.note("its cells have " + std::to_string(found) + " integers, where it says " + std::to_string(size));
}

void read_cells(WordReader& words, TetraBuilder& builder, VtkCells& cells) {
  const std::int64_t count = words.count("the number of cells"), size = words.integer("the number of integers");
  if (count == 0) return;
  const std::string_view first = words.word();
  if (first == "OFFSETS") return read_offsets(words, count, size, cells);
  std::int64_t corners = 0;
  if (!parse_integer(first, corners)) words.fail(in_quotes(first) + " is no number of corners", "the file is damaged");
  read_counted(words, corners, count, size, builder, cells);
}

void add_tetrahedra(WordReader& words, const VtkCells& cells, TetraBuilder& builder) {
  const std::int64_t count = words.count("the number of cell types");
  add_vtk_tetrahedra(
      words, cells, count, [&] { return words.integer("the type of a cell"); }, builder);
}

}  // namespace

TetrahedralMeshFile read_vtk(std::string_view bytes, const std::string& name) {
  WordReader words(bytes, name, 0);
  TetraBuilder builder(name);
  VtkCells cells;
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
