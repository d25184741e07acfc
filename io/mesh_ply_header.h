// The header of a PLY file: its elements, their numbers of rows, and their properties.
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
  PlyType type = PlyType::float32;  ///< type of the value, or of a list's entries
  bool is_list = false;
  PlyType count_type = PlyType::uint8;  ///< type of the list's length
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
  int line = 0;  ///< line of the header that declares it

  int find(std::string_view property) const;  ///< index of a property; -1: there is none

  /// The smallest size of a row [bytes]. It limits the number of rows that a file of given size can have.
  std::size_t least_row_size(bool binary) const;
};

struct PlyHeader {
  enum class Format { ascii, little_endian, big_endian };
  Format format = Format::ascii;
  std::vector<PlyElement> elements;
  std::size_t data_offset = 0;  ///< offset of the first row [bytes]
  int data_line = 0;            ///< line number of the first row

  const PlyElement* find(std::string_view element) const;
};

/// Parses and validates a header: known types and formats, unique names, numbers of rows for which the rest of the file
/// has room. Throws an Error with `name` and the line.
PlyHeader parse_ply_header(std::string_view bytes, const std::string& name);

}  // namespace pliant
