// Reads the header of a PLY file. Every number in it is validated before memory is allocated for it.
#include "mesh_ply_header.h"

#include <limits>
#include <utility>

#include "pliant/error.h"
#include "text_lines.h"

namespace pliant {

namespace {

struct TypeName {
  std::string_view name;
  PlyType type;
};

/// Names of types: those of the original format, and later ones.
constexpr TypeName type_names[] = {
    {"char", PlyType::int8},       {"int8", PlyType::int8},       {"uchar", PlyType::uint8},
    {"uint8", PlyType::uint8},     {"short", PlyType::int16},     {"int16", PlyType::int16},
    {"ushort", PlyType::uint16},   {"uint16", PlyType::uint16},   {"int", PlyType::int32},
    {"int32", PlyType::int32},     {"uint", PlyType::uint32},     {"uint32", PlyType::uint32},
    {"float", PlyType::float32},   {"float32", PlyType::float32}, {"double", PlyType::float64},
    {"float64", PlyType::float64},
};

/// Largest number of elements in a file, and of properties in an element: names are searched linearly.
constexpr std::size_t most_names = 1000;

class HeaderParser {
 public:
  HeaderParser(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name), lines_(bytes) {}

  PlyHeader parse() {
    std::string_view rest = lines_.next() ? lines_.line() : std::string_view();
    if (take_word(rest) != "ply") fail("does not start with 'ply'", "this is not a PLY file");
    const std::size_t end_of_first = lines_.line().size();
    const bool lone_return =
        end_of_first + 1 < bytes_.size() && bytes_[end_of_first] == '\r' && bytes_[end_of_first + 1] != '\n';
    while (!done_) {
      if (!lines_.next()) fail("the header has no 'end_header'", "the file is truncated");
      header_line();
    }
    if (!has_format_) fail("the header has no 'format' line");
    header_.data_line = lines_.number() + 1;
    header_.data_offset = lines_.offset();
    // If lines end in \r alone, a
    //  after the header is the first byte of data.
    if (lone_return)
      header_.data_offset = static_cast<std::size_t>(lines_.line().data() - bytes_.data()) + lines_.line().size() + 1;
    if (header_.data_offset > bytes_.size()) header_.data_offset = bytes_.size();
    check_claims();
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(std::string problem, std::string advice = {}, int line = 0) const {
    throw Error({.file = name_, .line = line > 0 ? line : lines_.number(), .object = {}, .element = {}},
                std::move(problem), std::move(advice));
  }

  void header_line() {
    std::string_view rest = lines_.line();
    const std::string_view keyword = take_word(rest);
    if (keyword.empty() || keyword == "comment" || keyword == "obj_info") return;
    if (keyword == "format") return format(rest);
    if (keyword == "element") return element(rest);
    if (keyword == "property") return property(rest);
    if (keyword == "end_header") {
      done_ = true;
      return;
    }
    fail("unknown keyword " + in_quotes(keyword) + " in the header", "the header is damaged");
  }

  void format(std::string_view rest) {
    const std::string_view format = take_word(rest);
    const std::string_view version = take_word(rest);
    if (has_format_) fail("a second 'format' line");
    has_format_ = true;
    if (version != "1.0") fail("version " + in_quotes(version) + " is not known", "export it as PLY 1.0");
    if (format == "ascii")
      header_.format = PlyHeader::Format::ascii;
    else if (format == "binary_little_endian")
      header_.format = PlyHeader::Format::little_endian;
    else if (format == "binary_big_endian")
      header_.format = PlyHeader::Format::big_endian;
    else
      fail("format " + in_quotes(format) + " is not known", "use ascii, binary_little_endian or binary_big_endian");
  }

  void element(std::string_view rest) {
    const std::string_view element_name = take_word(rest);
    const std::string_view count = take_word(rest);
    std::int64_t value = 0;
    if (element_name.empty() || !parse_integer(count, value) || value < 0)
      fail("an element needs a name and a count, and " + in_quotes(count) + " is not a count");
    if (value > std::numeric_limits<int>::max())
      fail("claims " + std::to_string(value) + " elements " + in_quotes(element_name) + ", more than the limit");
    if (header_.find(element_name) != nullptr) fail("a second element " + in_quotes(element_name));
    if (header_.elements.size() == most_names) fail("more than " + std::to_string(most_names) + " elements");
    PlyElement made;
    made.name = std::string(element_name);
    made.count = static_cast<std::uint64_t>(value);
    made.line = lines_.number();
    header_.elements.push_back(std::move(made));
  }

  PlyType type(std::string_view type_name) const {
    for (const TypeName& known : type_names)
      if (known.name == type_name) return known.type;
    fail("unknown type " + in_quotes(type_name) + " in the header");
  }

  void property(std::string_view rest) {
    if (header_.elements.empty()) fail("a property before any element");
    PlyElement& element = header_.elements.back();
    if (element.properties.size() == most_names) fail("more than " + std::to_string(most_names) + " properties");
    PlyProperty made;
    std::string_view word = take_word(rest);
    made.is_list = word == "list";
    if (made.is_list) {
      made.count_type = type(take_word(rest));
      if (!is_integer(made.count_type)) fail("the length of a list must be of an integer type");
      word = take_word(rest);
    }
    made.type = type(word);
    made.name = std::string(take_word(rest));
    if (made.name.empty()) fail("a property without a name");
    if (element.find(made.name) >= 0)
      fail("a second property " + in_quotes(made.name) + " of element " + in_quotes(element.name));
    element.properties.push_back(std::move(made));
  }

  void check_claims() const {
    std::uint64_t room = bytes_.size() - header_.data_offset;
    const bool binary = header_.format != PlyHeader::Format::ascii;
    if (!binary) ++room;  // the last line may have no line end
    for (const PlyElement& element : header_.elements) {
      if (element.count > 0 && element.properties.empty())
        fail("element " + in_quotes(element.name) + " has no properties", {}, element.line);
      const std::uint64_t least = element.count * element.least_row_size(binary);  // < 2^31 * 1000 * 8
      if (least > room)
        fail("claims " + std::to_string(element.count) + " elements " + in_quotes(element.name) + ", at least " +
                 std::to_string(least) + " bytes, but " + std::to_string(room) + " bytes are left",
             "the file is truncated, or its header is wrong", element.line);
      room -= least;
    }
  }

  std::string_view bytes_;
  const std::string& name_;
  LineReader lines_;
  PlyHeader header_;
  bool has_format_ = false, done_ = false;
};

}  // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    case PlyType::float64:
      return 8;
  }
  return 8;
}

bool is_integer(PlyType type) { return type != PlyType::float32 && type != PlyType::float64; }

int PlyElement::find(std::string_view property) const {
  for (std::size_t i = 0; i < properties.size(); ++i)
    if (properties[i].name == property) return static_cast<int>(i);
  return -1;
}

std::size_t PlyElement::least_row_size(bool binary) const {
  constexpr std::size_t digit_and_separator = 2;
  std::size_t size = 0;
  for (const PlyProperty& property : properties)
    size += !binary ? digit_and_separator : size_of(property.is_list ? property.count_type : property.type);
  return size;
}

const PlyElement* PlyHeader::find(std::string_view element) const {
  for (const PlyElement& one : elements)
    if (one.name == element) return &one;
  return nullptr;
}

PlyHeader parse_ply_header(std::string_view bytes, const std::string& name) {
  return HeaderParser(bytes, name).parse();
}

}  // namespace pliant
