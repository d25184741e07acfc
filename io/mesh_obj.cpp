// Reads Wavefront OBJ: vertices and faces, without appearance.
//
// It does not use tinyobjloader. A mesh needs only two of the format's keywords; errors of that library name no line,
// it skips faces that it cannot parse, reads "nan" as a number, and has had memory errors on hostile files. A damaged
// mesh should be rejected with a line number, not silently lose faces.
//
// Read: v (extra values, a weight or colours, must be numbers and are ignored), f in all forms (v, v/vt, v//vn,
// v/vt/vn, negative indices), "\" at a line's end, comments, any line ending. Ignored with a note: points, lines,
// curves, free-form surfaces, and longer keywords that other programs add ("seam", "stitch"). Ignored silently:
// materials, groups, normals, texture coordinates. An unknown keyword of one letter, or with other characters than
// letters, is an error: as a damaged "v" it would shift the index of every later vertex.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

#include "mesh_polygons.h"
#include "pliant/error.h"
#include "text_lines.h"

namespace pliant {

namespace {

constexpr std::string_view silent_keywords[] = {
    "vt",       "vn",       "vp",     "vw",    "g",          "s",         "mg",   "o",    "usemtl",
    "mtllib",   "usemap",   "maplib", "lod",   "shadow_obj", "trace_obj", "t",    "csh",  "bevel",
    "c_interp", "d_interp", "deg",    "step",  "parm",       "trim",      "hole", "scrv", "sp",
    "con",      "end",      "ctech",  "stech", "bmat",       "cstype",    "call"};

/// Keywords of elements that are not polygons, and what messages call them.
constexpr std::pair<std::string_view, const char*> noted_keywords[] = {
    {"p", "point"}, {"l", "line"}, {"curv", "curve"}, {"curv2", "curve"}, {"surf", "surface"},
};

class ObjParser {
 public:
  ObjParser(std::string_view bytes, const std::string& name) : lines_(bytes), name_(name) {}

  PolygonMesh parse() {
    while (next_statement()) statement();
    check_forward_references();
    note_what_was_passed_over();
    if (mesh_.ends.empty()) fail(0, nothing_found(), "export the mesh with its faces");
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(int line, std::string problem, std::string advice = {}) const {
    throw Error({.file = name_, .line = line, .object = {}, .element = {}}, std::move(problem), std::move(advice));
  }

  /// True for comments. A trailing "\" does not continue them, because many end in a folder's name: "C:\\meshes\\".
  static bool is_comment(std::string_view line) {
    const std::string_view word = take_word(line);
    return !word.empty() && word.front() == '#';
  }

  /// Advances to the next statement: a line, joined with those that follow a trailing "\".
  bool next_statement() {
    if (!lines_.next()) return false;
    line_ = lines_.number();
    statement_ = lines_.line();
    if (statement_.empty() || statement_.back() != '\\' || is_comment(statement_)) return true;
    joined_.clear();
    bool more = true;
    while (more && !statement_.empty() && statement_.back() == '\\') {
      joined_.append(statement_.substr(0, statement_.size() - 1)).push_back(' ');
      more = lines_.next();
      statement_ = more ? lines_.line() : std::string_view();
    }
    joined_.append(statement_);
    statement_ = joined_;
    return true;
  }

  void statement() {
    std::string_view rest = statement_;
    const std::string_view keyword = take_word(rest);
    if (keyword.empty() || keyword.front() == '#') return;
    if (statement_.find('\0') != std::string_view::npos)
      fail(line_, "contains a zero byte, so it is not a text file", "export it again");
    if (keyword == "v") return vertex(rest);
    if (keyword == "f" || keyword == "fo") return face(rest);
    if (note(keyword)) return;
    if (std::find(std::begin(silent_keywords), std::end(silent_keywords), keyword) != std::end(silent_keywords)) return;
    if (note_unknown(keyword)) return;
    fail(line_, "unknown keyword " + in_quotes(keyword),
         "the file is not OBJ, or the line is damaged; delete the line if it is not needed");
  }

  /// Takes the next word off a statement; a comment ends the statement.
  static std::string_view next_value(std::string_view& rest) {
    const std::string_view word = take_word(rest);
    if (word.empty() || word.front() != '#') return word;
    rest = {};
    return {};
  }

  void vertex(std::string_view rest) {
    constexpr int most = 8;  // x y z, optionally a weight, and four numbers of a colour
    float values[most] = {};
    int count = 0;
    for (std::string_view word = next_value(rest); !word.empty(); word = next_value(rest)) {
      if (count == most) fail(line_, "a vertex has more than " + std::to_string(most) + " values");
      const NumberProblem problem = parse_float(word, values[count]);
      if (problem != NumberProblem::none)
        fail(line_,
             "value " + std::to_string(count + 1) + " of vertex " + std::to_string(mesh_.positions.size() + 1) + ", " +
                 in_quotes(word) + ", " + describe(problem),
             "give three finite coordinates");
      ++count;
    }
    if (count < 3) fail(line_, "a vertex has " + std::to_string(count) + " coordinates instead of 3");
    if (mesh_.positions.size() == std::numeric_limits<int>::max()) fail(line_, "there are too many vertices");
    mesh_.positions.push_back({values[0], values[1], values[2]});
  }

  void face(std::string_view rest) {
    const std::size_t begin = mesh_.corners.size();
    for (std::string_view word = next_value(rest); !word.empty(); word = next_value(rest))
      mesh_.corners.push_back(corner(word));
    const std::size_t count = mesh_.corners.size() - begin;
    if (count < 3)
      fail(line_,
           "a face has " + std::to_string(count) + (count == 1 ? " corner" : " corners") + " instead of 3 or more",
           "delete the line or complete it");
    mesh_.close_polygon();
  }

  /// The vertex index of "v", "v/vt", "v//vn" or "v/vt/vn"; other parts must be numbers or empty.
  int corner(std::string_view word) {
    const std::string_view whole = word;
    std::int64_t vertex = 0;
    for (int part = 0; part < 3; ++part) {
      const std::size_t slash = word.find('/');
      const std::string_view number = word.substr(0, slash);
      std::int64_t value = 0;
      const bool may_be_empty = part > 0;
      if (!(may_be_empty && number.empty()) && !parse_integer(number, value))
        fail(line_, in_quotes(whole) + " is not a face corner", "write V, V/VT, V//VN or V/VT/VN");
      if (part == 0) vertex = value;
      if (slash == std::string_view::npos) return resolve(vertex);
      word.remove_prefix(slash + 1);
    }
    fail(line_, in_quotes(whole) + " has more than three parts", "write V, V/VT, V//VN or V/VT/VN");
  }

  /// Converts an index of the file, which counts from 1, or backwards from the last vertex read. It may refer to a
  /// later vertex.
  int resolve(std::int64_t index) {
    const std::int64_t known = static_cast<std::int64_t>(mesh_.positions.size());
    if (index == 0) fail(line_, "vertex index 0", "OBJ counts vertices from 1");
    if (index < -known) out_of_range(line_, index, known);
    if (index < 0) return static_cast<int>(known + index);
    if (index > std::numeric_limits<int>::max()) out_of_range(line_, index, known);
    if (index > known) forward_.emplace_back(index, line_);
    return static_cast<int>(index - 1);
  }

  [[noreturn]] void out_of_range(int line, std::int64_t index, std::int64_t count) const {
    fail(line, "vertex index " + std::to_string(index) + " but there are " + std::to_string(count) + " vertices",
         "the file is truncated, or its faces belong to another mesh");
  }

  void check_forward_references() const {
    const std::int64_t count = static_cast<std::int64_t>(mesh_.positions.size());
    for (const auto& [index, line] : forward_)
      if (index > count) out_of_range(line, index, count);
  }

  bool note(std::string_view keyword) {
    for (std::size_t i = 0; i < std::size(noted_keywords); ++i) {
      if (keyword != noted_keywords[i].first) continue;
      if (passed_over_[i].count++ == 0) passed_over_[i].first_line = line_;
      return true;
    }
    return false;
  }

  /// Notes a keyword that another program may have added; it is longer than the one-letter keywords of OBJ.
  bool note_unknown(std::string_view keyword) {
    constexpr std::size_t most_letters = 40, most_keywords = 100;
    const auto is_of_a_word = [](char c) {
      return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '-';
    };
    if (keyword.size() < 2 || keyword.size() > most_letters) return false;
    if (!std::all_of(keyword.begin(), keyword.end(), is_of_a_word)) return false;
    PassedOver& of = unknown_[std::string(keyword)];
    if (of.count++ == 0) of.first_line = line_;
    return unknown_.size() <= most_keywords;  // a file with more is probably no OBJ, but prose
  }

  void note_unknown_keywords() {
    constexpr std::size_t most_named = 8;
    if (unknown_.empty()) return;
    std::string words;
    std::size_t named = 0;
    for (const auto& [keyword, of] : unknown_) {
      if (named++ == most_named) break;
      words += fmt::format("{}'{}' ({} {}, the first {})", words.empty() ? "" : ", ", keyword, of.count,
                           of.count == 1 ? "line" : "lines", of.first_line);
    }
    if (unknown_.size() > most_named) words += fmt::format(" and {} more", unknown_.size() - most_named);
    mesh_.notes.push_back(fmt::format("ignored unknown {} {}", unknown_.size() == 1 ? "keyword" : "keywords", words));
  }

  void note_what_was_passed_over() {
    note_unknown_keywords();
    for (std::size_t i = 0; i < std::size(noted_keywords); ++i)
      if (passed_over_[i].count > 0)
        mesh_.notes.push_back("ignored " + std::to_string(passed_over_[i].count) + " " + noted_keywords[i].second +
                              (passed_over_[i].count == 1 ? "" : "s") + ", the first on line " +
                              std::to_string(passed_over_[i].first_line));
  }

  std::string nothing_found() const {
    const std::size_t count = mesh_.positions.size();
    if (count == 0) return "has no vertices and no faces";
    std::string text = "has " + std::to_string(count) + (count == 1 ? " vertex" : " vertices") + " but no faces";
    for (const std::string& note : mesh_.notes) text += " (" + note + ")";
    return text;
  }

  struct PassedOver {
    std::size_t count = 0;
    int first_line = 0;
  };

  LineReader lines_;
  const std::string& name_;
  std::string_view statement_;
  std::string joined_;
  int line_ = 0;
  PolygonMesh mesh_;
  std::vector<std::pair<std::int64_t, int>> forward_;  // indices of vertices that were not read yet, with their lines
  std::map<std::string, PassedOver> unknown_;
  PassedOver passed_over_[std::size(noted_keywords)];
};

}  // namespace

PolygonMesh parse_obj(std::string_view bytes, const std::string& name) { return ObjParser(bytes, name).parse(); }

}  // namespace pliant
