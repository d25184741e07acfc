// Reads STL: triangles whose corners are not shared, as text or binary.
//
// Some binary files begin with "solid" like text, so the length is tested first: that of a binary file is exact
// (80 bytes of any content, a count, 50 bytes per triangle). Normals are ignored: they follow from the corners,
// and files often contradict themselves. It is written here, like the other readers, so that errors have a
// position.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include "mesh_polygons.h"
#include "pliant/error.h"
#include "text_lines.h"

namespace pliant {

namespace {

constexpr std::size_t head_size = 84;
constexpr std::size_t triangle_size = 50;

std::uint32_t read_u32(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

float read_f32(std::string_view bytes, std::size_t at) {
  const std::uint32_t bits = read_u32(bytes, at);
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

std::uint64_t claimed_size(std::string_view bytes) {
  return head_size + triangle_size * std::uint64_t{read_u32(bytes, 80)};
}

/// Compares keywords, in which case does not matter.
bool same_word(std::string_view word, std::string_view lower_case) {
  if (word.size() != lower_case.size()) return false;
  for (std::size_t i = 0; i < word.size(); ++i) {
    const char c = word[i] >= 'A' && word[i] <= 'Z' ? static_cast<char>(word[i] - 'A' + 'a') : word[i];
    if (c != lower_case[i]) return false;
  }
  return true;
}

bool is_text(std::string_view bytes) {
  if (bytes.size() >= head_size && claimed_size(bytes) == bytes.size()) return false;
  LineReader lines(bytes);
  while (lines.next()) {
    std::string_view rest = lines.line();
    const std::string_view word = take_word(rest);
    if (!word.empty())
      return same_word(word, "solid") && bytes.substr(0, head_size).find('\0') == std::string_view::npos;
  }
  return false;
}

void add_corner(PolygonMesh& mesh, const Vec3f& position) {
  mesh.corners.push_back(static_cast<int>(mesh.positions.size()));
  mesh.positions.push_back(position);
}

class TextStl {
 public:
  TextStl(std::string_view bytes, const std::string& name) : lines_(bytes), name_(name) {}

  PolygonMesh parse() {
    mesh_.is_soup = true;
    while (next_line()) {
      expect("solid");
      solid();
    }
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(std::string problem, std::string advice = {}) const {
    throw Error({.file = name_, .line = lines_.number(), .object = {}, .element = {}}, std::move(problem),
                std::move(advice));
  }

  /// Advances to the next line that is not empty, and takes its first word.
  bool next_line() {
    while (lines_.next()) {
      rest_ = lines_.line();
      keyword_ = take_word(rest_);
      if (!keyword_.empty()) return true;
    }
    return false;
  }

  void need_line(const char* inside) {
    if (!next_line()) fail(std::string("the file ends inside a ") + inside, "it is truncated");
  }

  void expect(std::string_view word) const {
    if (!same_word(keyword_, word))
      fail(in_quotes(keyword_) + " where '" + std::string(word) + "' should stand", "the file is damaged");
  }

  void solid() {
    for (need_line("solid"); !same_word(keyword_, "endsolid"); need_line("solid")) {
      expect("facet");
      facet();
    }
  }

  void facet() {
    need_line("facet");
    expect("outer");
    for (int corner = 0; corner < 3; ++corner) {
      need_line("facet");
      expect("vertex");
      vertex();
    }
    need_line("facet");
    expect("endloop");
    need_line("facet");
    expect("endfacet");
    mesh_.close_polygon();
  }

  void vertex() {
    float values[3] = {};
    for (float& value : values) {
      const std::string_view word = take_word(rest_);
      if (word.empty()) fail("a vertex has fewer than 3 coordinates");
      const NumberProblem problem = parse_float(word, value);
      if (problem != NumberProblem::none)
        fail(in_quotes(word) + " " + describe(problem), "give three finite coordinates");
    }
    if (const std::string_view word = take_word(rest_); !word.empty())
      fail("a vertex continues with " + in_quotes(word));
    add_corner(mesh_, {values[0], values[1], values[2]});
  }

  LineReader lines_;
  const std::string& name_;
  std::string_view rest_, keyword_;
  PolygonMesh mesh_;
};

[[noreturn]] void fail_at(const std::string& name, std::size_t byte, std::string problem, std::string advice) {
  throw Error({.file = name, .line = 0, .object = {}, .element = "byte " + std::to_string(byte)}, std::move(problem),
              std::move(advice));
}

float coordinate(std::string_view bytes, std::size_t at, const std::string& name) {
  const float value = read_f32(bytes, at);
  if (!std::isfinite(value))
    fail_at(name, at, "a coordinate of triangle " + std::to_string((at - head_size) / triangle_size) + " is not finite",
            "give finite coordinates");
  return value;
}

PolygonMesh parse_binary(std::string_view bytes, const std::string& name) {
  if (bytes.size() < head_size)
    fail_at(name, bytes.size(),
            "is neither a text STL (it does not begin with 'solid') nor long enough for a binary one",
            "the file is truncated or not STL");
  const std::uint64_t claimed = claimed_size(bytes);
  if (claimed > bytes.size())
    fail_at(name, 80,
            "claims " + std::to_string(read_u32(bytes, 80)) + " triangles, " + std::to_string(claimed) +
                " bytes, but holds " + std::to_string(bytes.size()) + " bytes",
            "the file is truncated or not STL");
  PolygonMesh mesh;
  mesh.is_soup = true;
  const std::size_t count = read_u32(bytes, 80);
  mesh.positions.reserve(3 * count);
  mesh.corners.reserve(3 * count);
  mesh.ends.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t corners = head_size + i * triangle_size + 12;  // the corners of a triangle follow its normal
    for (std::size_t at = corners; at < corners + 36; at += 12)
      add_corner(mesh, {coordinate(bytes, at, name), coordinate(bytes, at + 4, name), coordinate(bytes, at + 8, name)});
    mesh.close_polygon();
  }
  if (claimed < bytes.size())
    mesh.notes.push_back("ignored " + std::to_string(bytes.size() - claimed) + " bytes after the last triangle");
  return mesh;
}

}  // namespace

PolygonMesh parse_stl(std::string_view bytes, const std::string& name) {
  PolygonMesh mesh = is_text(bytes) ? TextStl(bytes, name).parse() : parse_binary(bytes, name);
  if (mesh.ends.empty())
    throw Error({.file = name, .line = 0, .object = {}, .element = {}}, "has no triangles",
                "export the mesh with its faces");
  return mesh;
}

}  // namespace pliant
