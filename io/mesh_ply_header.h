// The header of a PLY file: its elements, their counts and properties.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace pliant {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t size_of(PlyType type);
bool is_integer(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;  ///< type of the value, or of list entries
  bool is_list = false;
  PlyType count_type = PlyType::uint8;  ///< type of the list's length
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
  int line = 0;  ///< line of its declaration in the header

  int find(std::string_view property) const;  ///< index, or -1

  /// The smallest size of one row in bytes; claimed counts are checked against it.
  std::size_t least_row_size(bool binary) const;
};

struct PlyHeader {
  enum class Format { ascii, little_endian, big_endian };
  Format format = Format::ascii;
  std::vector<PlyElement> elements;
  std::size_t data_offset = 0;  ///< byte offset of the first row
  int data_line = 0;            ///< line number of the first row

  const PlyElement* find(std::string_view element) const;
};

/// Parses and validates the header: known types and formats, unique names, counts
/// that fit into the rest of the file. Throws an Error with `name` and the line.
PlyHeader parse_ply_header(std::string_view bytes, const std::string& name);

}  // namespace pliant
