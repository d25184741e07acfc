// The header of a PLY file: which elements follow, how many, made of what.
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
  PlyType type = PlyType::float32;  ///< of the value, or of a list's entries
  bool is_list = false;
  PlyType count_type = PlyType::uint8;  ///< of a list's length
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
  int line = 0;  ///< where the header declares it

  int find(std::string_view property) const;  ///< index, or -1

  /// The least that one row can take, in bytes, and so what a claimed count is checked against.
  std::size_t least_row_size(bool binary) const;
};

struct PlyHeader {
  enum class Format { ascii, little_endian, big_endian };
  Format format = Format::ascii;
  std::vector<PlyElement> elements;
  std::size_t data_offset = 0;  ///< byte where the rows start
  int data_line = 0;            ///< and line

  const PlyElement* find(std::string_view element) const;
};

/// Reads and checks the header: known types and formats, no name twice, no counts that the rest of the file cannot hold.
/// Throws Error with `name` and the line.
PlyHeader parse_ply_header(std::string_view bytes, const std::string& name);

}  // namespace pliant
