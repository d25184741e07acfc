// Reads VTK unstructured grids in XML files (.vtu; Kitware, "VTK file formats"): Points and Cells of all pieces, as
// text, base64 or raw bytes, whole or compressed. Data of points and cells are not read. Pieces of a parallel run
// touch: points of several pieces that are equal become one, and points of one piece stay as they are.
#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "pliant/error.h"
#include "tetra_builder.h"
#include "tetra_formats.h"
#include "tetra_vtk.h"
#include "text_lines.h"
#include "vtu_data.h"

#ifdef PLIANT_XML
#include <tinyxml2.h>
#endif

namespace pliant {

#ifdef PLIANT_XML

namespace {

using Element = tinyxml2::XMLElement;
using Position = std::array<float, 3>;

/// What follows the XML at the end of a file, to which arrays refer by offsets.
struct Appended {
  std::string_view bytes;
  bool is_base64 = false;
};

class VtuReader {
 public:
  VtuReader(std::string_view bytes, const std::string& name) : name_(name), builder_(name) {
    std::string text = take_appended(bytes);
    if (document_.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS)
      fail(document_.ErrorLineNum(), "is not valid XML", "the file is damaged: export it again");
  }

  TetrahedralMeshFile read() {
    const Element* root = document_.FirstChildElement("VTKFile");
    if (root == nullptr) fail(1, "has no element 'VTKFile'", "give a .vtu file of VTK");
    const Element* grid = root->FirstChildElement("UnstructuredGrid");
    if (grid == nullptr)
      fail(root->GetLineNum(), "has no UnstructuredGrid", "write tetrahedra as an unstructured grid");
    read_encoding(*root);
    const Element* first = grid->FirstChildElement("Piece");
    has_several_ = first != nullptr && first->NextSiblingElement("Piece") != nullptr;
    for (const Element* piece = first; piece != nullptr; piece = piece->NextSiblingElement("Piece")) read_piece(*piece);
    if (merged_ > 0)
      builder_.note("merged " + std::to_string(merged_) + (merged_ == 1 ? " point" : " points") +
                    " with others of another piece at the same position");
    return builder_.result();
  }

 private:
  [[noreturn]] void fail(int line, const std::string& problem, const std::string& advice) const {
    throw Error({.file = name_, .line = line}, problem, advice);
  }

  /// The text without what is appended to it, which need not be XML.
  std::string take_appended(std::string_view bytes) {
    const std::size_t start = bytes.find("<AppendedData");
    if (start == std::string_view::npos) return std::string(bytes);
    const std::string_view rest = bytes.substr(start);
    const std::size_t end = rest.find('>');
    const std::size_t first = end == std::string_view::npos ? end : rest.find('_', end);
    if (first == std::string_view::npos)
      fail(0, "has an AppendedData without '_'", "the file is cut off: export it again");
    appended_.is_base64 = rest.substr(0, end).find("raw") == std::string_view::npos;
    appended_.bytes = rest.substr(first + 1);
    if (appended_.is_base64) appended_.bytes = appended_.bytes.substr(0, appended_.bytes.find('<'));
    return std::string(bytes.substr(0, start)) + "</VTKFile>";
  }

  static std::string attribute(const Element& at, const char* name) {
    const char* value = at.Attribute(name);
    return value == nullptr ? "" : value;
  }

  void read_encoding(const Element& root) {
    encoding_.has_big_end_first = attribute(root, "byte_order") == "BigEndian";
    encoding_.has_long_headers = attribute(root, "header_type") == "UInt64";
    const std::string compressor = attribute(root, "compressor");
    encoding_.is_compressed = !compressor.empty();
    if (encoding_.is_compressed && compressor != "vtkZLibDataCompressor")
      fail(root.GetLineNum(), "is compressed by " + in_quotes(compressor), "compress by zlib, or not");
  }

  std::int64_t count(const Element& piece, const char* name) const {
    const std::string word = attribute(piece, name);
    std::int64_t value = 0;
    if (!parse_integer(word, value) || value < 0)
      fail(piece.GetLineNum(), std::string(name) + " is " + in_quotes(word), "give how many there are");
    return value;
  }

  const Element& array(const Element& piece, const char* part, const char* name) const {
    const Element* parent = piece.FirstChildElement(part);
    const Element* at = parent == nullptr ? nullptr : parent->FirstChildElement("DataArray");
    while (at != nullptr && name != nullptr && attribute(*at, "Name") != name) at = at->NextSiblingElement("DataArray");
    if (at == nullptr)
      fail(piece.GetLineNum(), std::string("has no ") + part + (name == nullptr ? "" : std::string(", ") + name),
           "the file is damaged");
    return *at;
  }

  /// The bytes of an array whose format is not ASCII.
  std::string bytes_of(const Element& at) const {
    const VtuFail refuse = [&](const std::string& problem, const std::string& advice) {
      fail(at.GetLineNum(), problem, advice);
    };
    VtuEncoding encoding = encoding_;
    if (attribute(at, "format") == "appended") {
      const std::string word = attribute(at, "offset");
      std::int64_t offset = 0;
      if (!parse_integer(word, offset) || offset < 0 || static_cast<std::size_t>(offset) > appended_.bytes.size())
        fail(at.GetLineNum(), "an array has the offset " + in_quotes(word), "the file is cut off: export it again");
      encoding.is_base64 = appended_.is_base64;
      return vtu_array(appended_.bytes.substr(static_cast<std::size_t>(offset)), encoding, refuse);
    }
    const char* text = at.GetText();
    return vtu_array(text == nullptr ? std::string_view() : text, encoding, refuse);
  }

  template <class To, class From>
  static To widened(From value) {
    if constexpr (sizeof(From) == 1) return static_cast<To>(static_cast<int>(value));
    return static_cast<To>(value);
  }

  template <class From, class To>
  std::vector<To> converted(const std::string& bytes) const {
    std::vector<To> out(bytes.size() / sizeof(From));
    for (std::size_t i = 0; i < out.size(); ++i) {
      char raw[sizeof(From)];
      std::memcpy(raw, bytes.data() + i * sizeof(From), sizeof(From));
      if (encoding_.has_big_end_first) std::reverse(raw, raw + sizeof raw);
      From value{};
      std::memcpy(&value, raw, sizeof raw);
      out[i] = widened<To>(value);
    }
    return out;
  }

  std::vector<std::int64_t> integers(const Element& at) const {
    if (attribute(at, "format") == "ascii") {
      std::vector<std::int64_t> out;
      for_words(at, [&](std::string_view word) {
        if (!parse_integer(word, out.emplace_back()))
          fail(at.GetLineNum(), in_quotes(word) + " is no integer", "the file is damaged");
      });
      return out;
    }
    const std::string type = attribute(at, "type");
    if (type == "Int8") return converted<std::int8_t, std::int64_t>(bytes_of(at));
    if (type == "UInt8") return converted<std::uint8_t, std::int64_t>(bytes_of(at));
    if (type == "Int16") return converted<std::int16_t, std::int64_t>(bytes_of(at));
    if (type == "UInt16") return converted<std::uint16_t, std::int64_t>(bytes_of(at));
    if (type == "Int32") return converted<std::int32_t, std::int64_t>(bytes_of(at));
    if (type == "UInt32") return converted<std::uint32_t, std::int64_t>(bytes_of(at));
    if (type == "Int64" || type == "UInt64") return converted<std::int64_t, std::int64_t>(bytes_of(at));
    fail(at.GetLineNum(), "has integers of type " + in_quotes(type), "write Int32 or Int64");
  }

  std::vector<float> reals(const Element& at) const {
    std::vector<float> out;
    const std::string type = attribute(at, "type");
    if (attribute(at, "format") == "ascii") {
      for_words(at, [&](std::string_view word) {
        if (const NumberProblem problem = parse_float(word, out.emplace_back()); problem != NumberProblem::none)
          fail(at.GetLineNum(), in_quotes(word) + " " + describe(problem), "give finite coordinates");
      });
      return out;
    }
    if (type != "Float32" && type != "Float64")
      fail(at.GetLineNum(), "has points of type " + in_quotes(type), "write Float32 or Float64");
    out = type == "Float32" ? converted<float, float>(bytes_of(at)) : narrowed(converted<double, double>(bytes_of(at)));
    for (const float number : out)
      if (!(number - number == 0))
        fail(at.GetLineNum(), "has a coordinate that is not finite", "give finite coordinates");
    return out;
  }

  static std::vector<float> narrowed(const std::vector<double>& from) {
    std::vector<float> out;
    out.reserve(from.size());
    for (const double number : from)
      out.push_back(number > 3e38 || number < -3e38 ? std::numeric_limits<float>::infinity()
                                                    : static_cast<float>(number));
    return out;
  }

  template <class Body>
  void for_words(const Element& at, const Body& body) const {
    LineReader lines(at.GetText() == nullptr ? "" : at.GetText());
    while (lines.next()) {
      std::string_view rest = lines.line();
      for (std::string_view word = take_word(rest); !word.empty(); word = take_word(rest)) body(word);
    }
  }

  template <class T>
  void require(const Element& at, const std::vector<T>& found, std::int64_t wanted) const {
    if (static_cast<std::int64_t>(found.size()) != wanted)
      fail(at.GetLineNum(),
           "has " + std::to_string(found.size()) + " numbers, where " + std::to_string(wanted) + " belong",
           "the file is damaged");
  }

  void read_piece(const Element& piece) {
    const std::int64_t points = count(piece, "NumberOfPoints"), cells = count(piece, "NumberOfCells");
    if (cells == 0) return;
    constexpr std::int64_t most = 1 << 30;
    if (points > most || cells > most)
      fail(piece.GetLineNum(), "has more points or cells than fit", "give a coarser mesh");
    const Element &at = array(piece, "Points", nullptr), &corners_at = array(piece, "Cells", "connectivity"),
                  &ends_at = array(piece, "Cells", "offsets"), &types_at = array(piece, "Cells", "types");
    const std::vector<float> x = reals(at);
    require(at, x, 3 * points);
    const std::vector<std::int64_t> numbers = add_points(x, at.GetLineNum());
    const std::vector<std::int64_t> corners = integers(corners_at), ends = integers(ends_at),
                                    types = integers(types_at);
    require(ends_at, ends, cells);
    require(types_at, types, cells);
    add_cells(corners, ends, types, numbers, piece.GetLineNum());
  }

  /// Returns the number of each point. Where a piece has several at one position, the first goes with the first of
  /// another piece there, and so on: a crack stays open.
  std::vector<std::int64_t> add_points(const std::vector<float>& x, int line) {
    std::map<Position, std::size_t> of_piece;
    std::vector<std::int64_t> numbers;
    for (std::size_t i = 0; i < x.size(); i += 3) {
      numbers.push_back(next_);
      if (has_several_) {
        const Position at{x[i], x[i + 1], x[i + 2]};
        std::vector<std::int64_t>& there = seen_[at];
        const std::size_t nth = of_piece[at]++;
        if (nth == there.size()) there.push_back(next_);
        numbers.back() = there[nth];
      }
      if (numbers.back() == next_)
        builder_.add_node(next_++, {x[i], x[i + 1], x[i + 2]}, line);
      else
        ++merged_;
    }
    return numbers;
  }

  void add_cells(const std::vector<std::int64_t>& corners, const std::vector<std::int64_t>& ends,
                 const std::vector<std::int64_t>& types, const std::vector<std::int64_t>& numbers, int line) {
    const auto points = static_cast<std::int64_t>(numbers.size());
    VtkCells cells;
    std::int64_t begin = 0;
    for (std::size_t i = 0; i < ends.size(); begin = ends[i], ++i) {
      if (ends[i] < begin || ends[i] > static_cast<std::int64_t>(corners.size()))
        fail(line, "offset " + std::to_string(i) + " is " + std::to_string(ends[i]),
             "offsets ascend to the number of corners, " + std::to_string(corners.size()));
      std::vector<std::int64_t> cell(corners.begin() + begin, corners.begin() + ends[i]);
      for (std::int64_t& corner : cell) {
        if (corner < 0 || corner >= points)
          fail(line, "cell " + std::to_string(i) + " has the corner " + std::to_string(corner),
               "points run from 0 to " + std::to_string(points - 1));
        corner = numbers[static_cast<std::size_t>(corner)];
      }
      cells.add(std::move(cell), line);
    }
    std::size_t next = 0;
    const Place place{*this, line};
    add_vtk_tetrahedra(
        place, cells, static_cast<std::int64_t>(types.size()), [&] { return types[next++]; }, builder_);
  }

  struct Place {
    const VtuReader& reader;
    int line;
    [[noreturn]] void fail(const std::string& problem, const std::string& advice) const {
      reader.fail(line, problem, advice);
    }
  };

  std::string name_;
  TetraBuilder builder_;
  tinyxml2::XMLDocument document_;
  Appended appended_;
  VtuEncoding encoding_;
  bool has_several_ = false;                            ///< pieces
  std::map<Position, std::vector<std::int64_t>> seen_;  ///< the points at each position, if there are several pieces
  std::int64_t next_ = 0, merged_ = 0;
};

}  // namespace

TetrahedralMeshFile read_vtu(std::string_view bytes, const std::string& name) { return VtuReader(bytes, name).read(); }

#else

TetrahedralMeshFile read_vtu(std::string_view, const std::string& name) {
  throw Error({.file = name}, "cannot be read: this build has no XML reader",
              "install Debian's libtinyxml2-dev and build again, or write a legacy .vtk file");
}

#endif

}  // namespace pliant
