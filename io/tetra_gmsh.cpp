// Reads Gmsh .msh 2.2 and 4.1, as text and binary (Geuzaine and Remacle, Gmsh's reference manual, "MSH file format"):
// nodes and linear tetrahedra. Points, lines, triangles and quadrangles are passed over, and so are all other sections.
#include <algorithm>

#include "tetra_builder.h"
#include "tetra_bytes.h"
#include "tetra_formats.h"
#include "tetra_text.h"

namespace pliant {

namespace {

/// An element type that may stand in a mesh of linear tetrahedra, and how many nodes it has.
struct ElementType {
  std::int64_t number;
  int nodes;
};
constexpr std::int64_t gmsh_tetrahedron = 4;
constexpr ElementType gmsh_types[] = {{15, 1}, {1, 2}, {2, 3},  {3, 4}, {gmsh_tetrahedron, 4},
                                      {8, 3},  {9, 6}, {10, 9}, {16, 8}};

/// Numbers of a file, as words or as bytes.
class Source {
 public:
  Source(std::string_view bytes, const std::string& name) : words_(bytes, name), bytes_(bytes, name) {}

  void read_format();
  bool is_version_2() const { return is_version_2_; }
  bool is_binary() const { return is_binary_; }

  /// Goes to the next section, and returns its name without the '$'; empty at the end.
  std::string section();
  /// Throws an Error if anything but the end of a section follows, where its count is too small.
  void expect_end(const std::string& section);

  std::int64_t tag(const char* what);    ///< an int
  std::int64_t index(const char* what);  ///< a size_t; in version 2 an int
  float real(const char* what);
  std::int64_t count(const char* what);

  int line() const { return is_binary_ ? 0 : words_.line(); }
  [[noreturn]] void fail(const std::string& problem, const std::string& advice) const;

 private:
  WordReader words_;
  ByteReader bytes_;
  bool is_binary_ = false, is_version_2_ = false;
};

void Source::fail(const std::string& problem, const std::string& advice) const {
  if (!is_binary_) words_.fail(problem, advice);
  bytes_.fail(problem, advice);
}

std::int64_t Source::tag(const char* what) {
  return is_binary_ ? bytes_.value<std::int32_t>(what) : words_.integer(what);
}

std::int64_t Source::index(const char* what) {
  if (!is_binary_) return words_.integer(what);
  return is_version_2_ ? bytes_.value<std::int32_t>(what) : bytes_.value<std::int64_t>(what);
}

float Source::real(const char* what) { return is_binary_ ? bytes_.coordinate<double>(what) : words_.real(what); }

std::int64_t Source::count(const char* what) {
  if (!is_binary_) return words_.count(what);
  std::int64_t number = -1;
  if (!is_version_2_) {
    number = index(what);
  } else if (const std::string_view line = bytes_.line(); !parse_integer(line, number)) {  // text even in binary files
    fail(in_quotes(line) + " is no integer, but " + what + " should be here", "the file is damaged: export it again");
  }
  return bytes_.checked(number, sizeof(std::int32_t), what);
}

void Source::read_format() {
  words_.expect("$MeshFormat");
  const std::string_view version = words_.word();
  is_version_2_ = version == "2.2" || version == "2.1" || version == "2";
  if (!is_version_2_ && version != "4.1")
    fail("has version " + in_quotes(version) + " of the format",
         "save it as version 2.2 or 4.1: gmsh -save -format msh41");
  const bool is_binary = words_.integer("the kind of file") == 1;
  if (words_.integer("the size of numbers") != 8)
    fail("has numbers of other than 8 bytes", "save it by a present version of Gmsh");
  if (!is_binary) return words_.expect("$EndMeshFormat");
  bytes_.go_to(words_.offset());
  is_binary_ = true;
  const auto one = bytes_.value<std::int32_t>("the number 1");
  if (one != 1 && one != 0x01000000) fail("has no number 1 after its format", "the file is damaged: export it again");
  bytes_.swap_bytes(one != 1);
}

std::string Source::section() {
  while (is_binary_ && bytes_.remaining() > 0) {
    const std::string_view line = bytes_.line();
    if (!line.empty() && line.front() == '$' && line.substr(0, 4) != "$End") return std::string(line.substr(1));
  }
  if (is_binary_) return {};
  for (;;) {
    const std::string_view word = words_.word();
    if (word.empty()) return {};
    if (word.front() == '$' && word.substr(0, 4) != "$End") return std::string(word.substr(1));
    words_.skip_line();
  }
}

void Source::expect_end(const std::string& section) {
  std::string_view found;
  if (is_binary_)
    while (found.empty() && bytes_.remaining() > 0) found = bytes_.line();
  else
    found = words_.word();
  if (found.empty() || found.substr(0, 4) == "$End") return;
  fail("has more in $" + section + " than its counts say: " + in_quotes(found) + " is where $End" + section +
           " should be",
       "correct the counts, or export it again");
}

// ------------------------------------------------------------------------------------------------ sections

const ElementType* type_of(const Source& from, std::int64_t number) {
  const auto* found = std::find_if(std::begin(gmsh_types), std::end(gmsh_types),
                                   [&](const ElementType& one) { return one.number == number; });
  if (found == std::end(gmsh_types))
    from.fail("has elements of type " + std::to_string(number) + ", which are no linear tetrahedra (4)",
              "mesh with linear tetrahedra alone: Mesh.ElementOrder = 1, no recombination");
  return found;
}

void read_nodes_2(Source& from, TetraBuilder& builder) {
  const std::int64_t count = from.count("the number of nodes");
  for (std::int64_t i = 0; i < count; ++i) {
    const std::int64_t number = from.tag("the number of a node");
    const float x = from.real("x"), y = from.real("y"), z = from.real("z");
    builder.add_node(number, {x, y, z}, from.line());
  }
}

void read_nodes_4(Source& from, TetraBuilder& builder) {
  const std::int64_t blocks = from.count("the number of blocks of nodes");
  for (const char* what : {"the number of nodes", "the least number of a node", "the largest number of a node"})
    from.index(what);
  for (std::int64_t block = 0; block < blocks; ++block) {
    const std::int64_t dimension = from.tag("the dimension of a block");
    from.tag("the number of an entity");
    const bool is_parametric = from.tag("whether nodes have parameters") != 0;
    const std::int64_t count = from.count("the number of nodes of a block");
    std::vector<std::int64_t> numbers;
    for (std::int64_t i = 0; i < count; ++i) numbers.push_back(from.index("the number of a node"));
    for (const std::int64_t number : numbers) {
      const float x = from.real("x"), y = from.real("y"), z = from.real("z");
      for (std::int64_t i = 0; is_parametric && i < std::min<std::int64_t>(dimension, 3); ++i) from.real("a parameter");
      builder.add_node(number, {x, y, z}, from.line());
    }
  }
}

void read_element(Source& from, const ElementType& type, bool is_long, TetraBuilder& builder) {
  std::array<std::int64_t, 9> nodes{};
  for (int i = 0; i < type.nodes; ++i)
    nodes[static_cast<std::size_t>(i)] = is_long ? from.index("a node") : from.tag("a node");
  if (type.number == gmsh_tetrahedron) builder.add_tetrahedron({nodes[0], nodes[1], nodes[2], nodes[3]}, from.line());
}

/// As text, each element has its type; as bytes, elements of one type follow a header.
void read_elements_2(Source& from, TetraBuilder& builder) {
  const std::int64_t count = from.count("the number of elements");
  for (std::int64_t i = 0; i < count;) {
    if (!from.is_binary()) from.tag("the number of an element");
    const ElementType* type = type_of(from, from.tag("the type of an element"));
    const std::int64_t together = from.is_binary() ? from.tag("how many elements follow") : 1;
    const std::int64_t tags = from.tag("the number of tags");
    if (together < 1 || together > count - i || tags < 0 || tags > 1000)
      from.fail("has " + std::to_string(together) + " elements with " + std::to_string(tags) + " tags",
                "the file is damaged");
    for (std::int64_t k = 0; k < together; ++k) {
      if (from.is_binary()) from.tag("the number of an element");
      for (std::int64_t tag = 0; tag < tags; ++tag) from.tag("a tag");
      read_element(from, *type, false, builder);
    }
    i += together;
  }
}

void read_elements_4(Source& from, TetraBuilder& builder) {
  const std::int64_t blocks = from.count("the number of blocks of elements");
  for (const char* what :
       {"the number of elements", "the least number of an element", "the largest number of an element"})
    from.index(what);
  for (std::int64_t block = 0; block < blocks; ++block) {
    from.tag("the dimension of a block");
    from.tag("the number of an entity");
    const ElementType* type = type_of(from, from.tag("the type of elements"));
    const std::int64_t count = from.count("the number of elements of a block");
    for (std::int64_t i = 0; i < count; ++i) {
      from.index("the number of an element");
      read_element(from, *type, true, builder);
    }
  }
}

}  // namespace

TetrahedralMeshFile read_gmsh(std::string_view bytes, const std::string& name) {
  Source from(bytes, name);
  TetraBuilder builder(name);
  from.read_format();
  bool has_elements = false;
  for (std::string section = from.section(); !section.empty(); section = from.section()) {
    const bool is_read = section == "Nodes" || section == "Elements";
    if (section == "Nodes") from.is_version_2() ? read_nodes_2(from, builder) : read_nodes_4(from, builder);
    if (section == "Elements") from.is_version_2() ? read_elements_2(from, builder) : read_elements_4(from, builder);
    if (is_read) from.expect_end(section);
    has_elements = has_elements || section == "Elements";
  }
  if (!has_elements) from.fail("has no $Elements", "export the mesh with its elements");
  return builder.result();
}

}  // namespace pliant
