// Reads the rows of a PLY file that follow its header: text, or bytes of either byte order.
//
// One loop over rows serves all three encodings: a "source" yields the next number and knows its position. No PLY
// library in Debian validates sizes, but no memory may be allocated because of a header's number alone.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>

#include "mesh_ply_header.h"
#include "mesh_polygons.h"
#include "pliant/error.h"
#include "text_lines.h"

namespace pliant {

namespace {

/// Source of numbers for rows of text, one row per line.
class TextSource {
 public:
  TextSource(std::string_view bytes, const PlyHeader& header, const std::string& name)
      : lines_(bytes.substr(header.data_offset), header.data_line), name_(name) {}

  [[noreturn]] void fail(std::string problem, std::string advice = {}) const {
    throw Error({.file = name_, .line = lines_.number(), .object = {}, .element = {}}, std::move(problem),
                std::move(advice));
  }

  void begin_row() {
    std::string_view word;
    do {
      if (!lines_.next()) fail("the file ends before its last row", "it is truncated, or its header is wrong");
      row_ = word = lines_.line();
      word = take_word(word);
    } while (word.empty());
  }

  void end_row() {
    std::string_view rest = row_;
    const std::string_view word = take_word(rest);
    if (!word.empty()) fail("a row continues with " + in_quotes(word) + " beyond the properties in the header");
  }

  void skip(PlyType) { word(); }

  /// Returns the next number. NaN is allowed here, so that the caller can name the vertex.
  double real(PlyType) {
    float value = 0;
    const std::string_view text = word();
    const NumberProblem problem = parse_float(text, value);
    if (problem != NumberProblem::none) fail(in_quotes(text) + " " + describe(problem), "give finite coordinates");
    return value;
  }

  std::int64_t integer(PlyType) {
    std::int64_t value = 0;
    const std::string_view text = word();
    if (!parse_integer(text, value)) fail(in_quotes(text) + " is not an integer");
    return value;
  }

  std::size_t left_behind() {
    std::size_t lines = 0;
    while (lines_.next()) {
      std::string_view rest = lines_.line();
      if (!take_word(rest).empty()) ++lines;
    }
    return lines;
  }
  static const char* unit() { return "lines"; }

 private:
  std::string_view word() {
    const std::string_view text = take_word(row_);
    if (text.empty()) fail("a row is shorter than the header says");
    return text;
  }

  LineReader lines_;
  const std::string& name_;
  std::string_view row_;
};

/// Source of numbers for rows of bytes.
class BinarySource {
 public:
  BinarySource(std::string_view bytes, const PlyHeader& header, const std::string& name)
      : bytes_(bytes),
        position_(header.data_offset),
        big_(header.format == PlyHeader::Format::big_endian),
        name_(name) {}

  [[noreturn]] void fail(std::string problem, std::string advice = {}) const {
    throw Error({.file = name_, .line = 0, .object = {}, .element = "byte " + std::to_string(start_)},
                std::move(problem), std::move(advice));
  }

  void begin_row() {}
  void end_row() {}
  void skip(PlyType type) { raw(type); }

  double real(PlyType type) {
    const std::uint64_t bits = raw(type);
    if (type == PlyType::float64) return as<double>(bits);
    if (type == PlyType::float32) return static_cast<double>(as<float>(static_cast<std::uint32_t>(bits)));
    return static_cast<double>(extended(bits, type));
  }

  std::int64_t integer(PlyType type) { return extended(raw(type), type); }

  std::size_t left_behind() const { return bytes_.size() - position_; }
  static const char* unit() { return "bytes"; }

 private:
  template <class To, class From>
  static To as(From bits) {
    static_assert(sizeof(To) == sizeof(From));
    To value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }

  std::uint64_t raw(PlyType type) {
    const std::size_t size = size_of(type);
    start_ = position_;
    if (bytes_.size() - position_ < size) fail("the file ends inside a row", "it is truncated, or its header is wrong");
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t at = big_ ? i : size - 1 - i;
      bits = bits << 8 | static_cast<unsigned char>(bytes_[position_ + at]);
    }
    position_ += size;
    return bits;
  }

  static std::int64_t extended(std::uint64_t bits, PlyType type) {
    switch (type) {
      case PlyType::int8:
        return as<std::int8_t>(static_cast<std::uint8_t>(bits));
      case PlyType::int16:
        return as<std::int16_t>(static_cast<std::uint16_t>(bits));
      case PlyType::int32:
        return as<std::int32_t>(static_cast<std::uint32_t>(bits));
      default:
        return static_cast<std::int64_t>(bits);
    }
  }

  std::string_view bytes_;
  std::size_t position_, start_ = 0;
  bool big_;
  const std::string& name_;
};

/// Which properties of an element are coordinates or lists of corners; -1: the element has no such property.
struct Roles {
  int coordinates[3] = {-1, -1, -1};
  int polygon = -1;
};

template <class Source>
class RowReader {
 public:
  RowReader(std::string_view bytes, const PlyHeader& header, const std::string& name)
      : header_(header),
        source_(bytes, header, name),
        vertex_count_(static_cast<std::int64_t>(header.find("vertex")->count)) {}

  PolygonMesh read(const Roles& vertex_roles, const Roles& face_roles) {
    mesh_.positions.reserve(static_cast<std::size_t>(vertex_count_));
    for (const PlyElement& element : header_.elements) {
      const bool is_vertex = element.name == "vertex";
      const Roles roles = is_vertex ? vertex_roles : element.name == "face" ? face_roles : Roles{};
      for (std::uint64_t i = 0; i < element.count; ++i) row(element, roles, is_vertex);
    }
    const std::size_t left = source_.left_behind();
    if (left > 0)
      mesh_.notes.push_back("ignored " + std::to_string(left) + " " + Source::unit() + " after the last element");
    return std::move(mesh_);
  }

 private:
  void row(const PlyElement& element, const Roles& roles, bool is_vertex) {
    source_.begin_row();
    Vec3f position;
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      const int index = static_cast<int>(i);
      if (index == roles.polygon)
        polygon(property);
      else if (property.is_list)
        skip_list(property);
      else if (index == roles.coordinates[0])
        position.x = coordinate(property);
      else if (index == roles.coordinates[1])
        position.y = coordinate(property);
      else if (index == roles.coordinates[2])
        position.z = coordinate(property);
      else
        source_.skip(property.type);
    }
    source_.end_row();
    if (is_vertex) mesh_.positions.push_back(position);
  }

  float coordinate(const PlyProperty& property) {
    const double value = source_.real(property.type);
    if (!(std::fabs(value) <= static_cast<double>(std::numeric_limits<float>::max())))
      source_.fail("coordinate " + property.name + " of vertex " + std::to_string(mesh_.positions.size()) +
                       (std::isfinite(value) ? " is too large for single precision" : " is not finite"),
                   "give finite coordinates");
    return static_cast<float>(value);
  }

  std::int64_t length(const PlyProperty& property) {
    const std::int64_t count = source_.integer(property.count_type);
    if (count < 0) source_.fail("a list of " + std::to_string(count) + " entries");
    return count;
  }

  void skip_list(const PlyProperty& property) {
    for (std::int64_t i = length(property); i > 0; --i) source_.skip(property.type);
  }

  void polygon(const PlyProperty& property) {
    const std::int64_t count = length(property);
    if (count < 3)
      source_.fail("face " + std::to_string(mesh_.ends.size()) + " has " + std::to_string(count) +
                   " corners instead of 3 or more");
    for (std::int64_t i = 0; i < count; ++i) {
      const std::int64_t index = source_.integer(property.type);
      if (index < 0 || index >= vertex_count_)
        source_.fail("face " + std::to_string(mesh_.ends.size()) + " uses vertex " + std::to_string(index) +
                         " but there are " + std::to_string(vertex_count_) + " vertices, counted from 0",
                     "the file is damaged");
      mesh_.corners.push_back(static_cast<int>(index));
    }
    mesh_.close_polygon();
  }

  const PlyHeader& header_;
  Source source_;
  std::int64_t vertex_count_;
  PolygonMesh mesh_;
};

[[noreturn]] void refuse_header(const std::string& name, int line, std::string problem, std::string advice) {
  throw Error({.file = name, .line = line, .object = {}, .element = {}}, std::move(problem), std::move(advice));
}

Roles find_coordinates(const PlyHeader& header, const std::string& name) {
  const PlyElement* const vertex = header.find("vertex");
  if (vertex == nullptr) refuse_header(name, 0, "the header declares no element 'vertex'", "this is not a mesh");
  Roles roles;
  constexpr std::string_view axes[] = {"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    roles.coordinates[axis] = vertex->find(axes[axis]);
    if (roles.coordinates[axis] < 0 || vertex->properties[static_cast<std::size_t>(roles.coordinates[axis])].is_list)
      refuse_header(name, vertex->line, "the vertices have no coordinate '" + std::string(axes[axis]) + "'",
                    "export it with x, y and z");
  }
  return roles;
}

Roles find_polygons(const PlyHeader& header, const std::string& name) {
  const PlyElement* const face = header.find("face");
  if (const PlyElement* const strips = header.find("tristrips"); face == nullptr && strips != nullptr)
    refuse_header(name, strips->line, "holds triangle strips instead of faces", "export it with faces");
  if (face == nullptr || face->count == 0)
    refuse_header(name, face == nullptr ? 0 : face->line,
                  "has " + std::to_string(header.find("vertex")->count) + " vertices but no faces",
                  "export the mesh with its faces");
  Roles roles;
  roles.polygon = face->find("vertex_indices");
  if (roles.polygon < 0) roles.polygon = face->find("vertex_index");
  if (roles.polygon < 0)
    refuse_header(name, face->line, "the faces have no list 'vertex_indices'", "export it with that name");
  const PlyProperty& list = face->properties[static_cast<std::size_t>(roles.polygon)];
  if (!list.is_list || !is_integer(list.type))
    refuse_header(name, face->line, "'" + list.name + "' of the faces is not a list of integers",
                  "export it as a list of integers");
  return roles;
}

}  // namespace

PolygonMesh parse_ply(std::string_view bytes, const std::string& name) {
  const PlyHeader header = parse_ply_header(bytes, name);
  const Roles vertex_roles = find_coordinates(header, name);
  const Roles face_roles = find_polygons(header, name);
  if (header.format == PlyHeader::Format::ascii)
    return RowReader<TextSource>(bytes, header, name).read(vertex_roles, face_roles);
  return RowReader<BinarySource>(bytes, header, name).read(vertex_roles, face_roles);
}

}  // namespace pliant
