// Reads legacy VTK unstructured grids whose numbers are bytes, big end first (Kitware, "VTK file formats").
#include <vector>

#include "tetra_builder.h"
#include "tetra_bytes.h"
#include "tetra_formats.h"
#include "tetra_vtk.h"
#include "text_lines.h"

namespace pliant {

namespace {

class BinaryVtk {
 public:
  BinaryVtk(std::string_view bytes, std::size_t offset, const std::string& name) : from_(bytes, name), builder_(name) {
    from_.go_to(offset);
    from_.swap_bytes(true);  // the machines that it runs on have the little end first
  }

  TetrahedralMeshFile read();

 private:
  std::int64_t integer(std::string_view& rest, const char* what);
  void points(std::string_view rest);
  void cells(std::string_view rest);
  void offset_cells(std::int64_t offsets, std::int64_t size, std::string_view type);
  void counted_cells(std::int64_t count);
  void types(std::string_view rest);
  std::int64_t of_type(std::string_view type, const char* what);

  ByteReader from_;
  TetraBuilder builder_;
  VtkCells cells_;
};

std::int64_t BinaryVtk::integer(std::string_view& rest, const char* what) {
  const std::string_view word = take_word(rest);
  std::int64_t value = 0;
  if (!parse_integer(word, value))
    from_.fail(in_quotes(word) + " is no integer, but " + what + " should be here", "the file is damaged");
  return value;
}

void BinaryVtk::points(std::string_view rest) {
  const std::int64_t count = integer(rest, "the number of points");
  const std::string_view type = take_word(rest);
  if (type != "float" && type != "double")
    from_.fail("points are of type " + in_quotes(type), "write them as float or double");
  const bool is_double = type == "double";
  from_.checked(count, is_double ? 24 : 12, "the number of points");
  const auto next = [&](const char* what) {
    return is_double ? from_.coordinate<double>(what) : from_.coordinate<float>(what);
  };
  for (std::int64_t i = 0; i < count; ++i) {
    const float x = next("x"), y = next("y"), z = next("z");
    builder_.add_node(i, {x, y, z}, 0);
  }
}

std::int64_t BinaryVtk::of_type(std::string_view type, const char* what) {
  return type == "vtktypeint64" ? from_.value<std::int64_t>(what) : from_.value<std::int32_t>(what);
}

void BinaryVtk::offset_cells(std::int64_t offsets, std::int64_t size, std::string_view type) {
  from_.checked(offsets, 4, "the number of offsets");
  std::vector<std::int64_t> at;
  for (std::int64_t i = 0; i < offsets; ++i) add_vtk_offset(from_, of_type(type, "an offset"), size, at);
  std::string_view line = from_.line();
  while (line.empty() && from_.remaining() > 0) line = from_.line();
  if (take_word(line) != "CONNECTIVITY") from_.fail("has no CONNECTIVITY after its offsets", "the file is damaged");
  const std::string_view corners = take_word(line);
  for (std::size_t i = 1; i < at.size(); ++i) {
    std::vector<std::int64_t> cell;
    for (std::int64_t k = at[i - 1]; k < at[i]; ++k) cell.push_back(of_type(corners, "a corner"));
    cells_.add(std::move(cell), 0);
  }
}

void BinaryVtk::counted_cells(std::int64_t count) {
  from_.checked(count, 4, "the number of cells");
  for (std::int64_t i = 0; i < count; ++i) {
    const std::int64_t corners =
        from_.checked(from_.value<std::int32_t>("a number of corners"), 4, "a number of corners");
    std::vector<std::int64_t> cell;
    for (std::int64_t k = 0; k < corners; ++k) cell.push_back(from_.value<std::int32_t>("a corner"));
    cells_.add(std::move(cell), 0);
  }
}

void BinaryVtk::cells(std::string_view rest) {
  const std::int64_t count = integer(rest, "the number of cells"), size = integer(rest, "the number of integers");
  if (ByteReader ahead = from_; count > 0) {
    std::string_view line = ahead.line();
    if (take_word(line) == "OFFSETS") {
      from_ = ahead;
      return offset_cells(count, size, take_word(line));
    }
  }
  counted_cells(count);
}

void BinaryVtk::types(std::string_view rest) {
  const std::int64_t count = integer(rest, "the number of cell types");
  add_vtk_tetrahedra(
      from_, cells_, count, [&] { return from_.value<std::int32_t>("the type of a cell"); }, builder_);
}

TetrahedralMeshFile BinaryVtk::read() {
  while (from_.remaining() > 0) {
    std::string_view line = from_.line();
    const std::string_view keyword = take_word(line);
    if (keyword == "DATASET" && take_word(line) != "UNSTRUCTURED_GRID")
      from_.fail("is no UNSTRUCTURED_GRID", "write its tetrahedra as an UNSTRUCTURED_GRID");
    if (keyword == "POINTS") points(line);
    if (keyword == "CELLS") cells(line);
    if (keyword != "CELL_TYPES") continue;
    types(line);
    return builder_.result();
  }
  from_.fail("ends before its CELL_TYPES", "the file is cut off: export it again");
}

}  // namespace

TetrahedralMeshFile read_binary_vtk(std::string_view bytes, std::size_t offset, const std::string& name) {
  return BinaryVtk(bytes, offset, name).read();
}

}  // namespace pliant
