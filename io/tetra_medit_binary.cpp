// Reads binary Medit files (.meshb), as libMeshb writes them (Marechal, "The libMeshb library"): blocks, each with a
// code, the place of the next one, a count and rows. Versions 1 to 4 have floats or doubles, and places and counts of
// 32 or 64 bits.
#include "tetra_builder.h"
#include "tetra_bytes.h"
#include "tetra_formats.h"

namespace pliant {

namespace {

constexpr std::int32_t dimension_code = 3, vertices_code = 4, tetrahedra_code = 8, end_code = 54;
/// Prisms, hexahedra, pyramids, and tetrahedra and hexahedra of higher order.
constexpr std::int32_t refused_codes[] = {9, 10, 30, 33, 49, 82, 83, 85};

class BinaryMedit {
 public:
  BinaryMedit(std::string_view bytes, const std::string& name)
      : size_(bytes.size()), from_(bytes, name), builder_(name) {}

  TetrahedralMeshFile read() {
    read_head();
    while (from_.remaining() >= 4) {
      const auto code = from_.value<std::int32_t>("the code of a block");
      if (code == end_code) break;
      const std::int64_t next = version_ >= 3 ? from_.value<std::int64_t>("the place of the next block")
                                              : from_.value<std::int32_t>("the place of the next block");
      if (code == dimension_code) read_dimension();
      if (code == vertices_code) read_vertices();
      if (code == tetrahedra_code) read_tetrahedra();
      for (const std::int32_t refused : refused_codes)
        if (code == refused && count("the number of elements", 1) > 0)
          from_.fail("has elements that are no linear tetrahedra", "export linear tetrahedra alone");
      if (next == 0) break;
      const auto at = static_cast<std::int64_t>(size_ - from_.remaining());
      if (next < at || static_cast<std::uint64_t>(next) > size_)
        from_.fail("has a next block at byte " + std::to_string(next), "the file is damaged");
      from_.go_to(static_cast<std::size_t>(next));
    }
    return builder_.result();
  }

 private:
  void read_head() {
    const auto one = from_.value<std::int32_t>("the byte order");
    if (one == 16777216) from_.swap_bytes(true);
    if (one != 1 && one != 16777216) from_.fail("is no binary Medit file", "its first number is 1");
    version_ = from_.value<std::int32_t>("the version");
    if (version_ < 1 || version_ > 4) from_.fail("has version " + std::to_string(version_), "write versions 1 to 4");
  }

  void read_dimension() {
    if (const auto dimension = from_.value<std::int32_t>("the dimension"); dimension != 3)
      from_.fail("has " + std::to_string(dimension) + " dimensions", "give a mesh in space");
  }

  std::int64_t integer(const char* what) {
    return version_ >= 4 ? from_.value<std::int64_t>(what) : from_.value<std::int32_t>(what);
  }
  std::int64_t count(const char* what, std::size_t bytes) { return from_.checked(integer(what), bytes, what); }

  float coordinate(const char* what) {
    return version_ >= 2 ? from_.coordinate<double>(what) : from_.coordinate<float>(what);
  }

  void read_vertices() {
    const std::int64_t vertices = count("the number of vertices", 16);
    for (std::int64_t i = 1; i <= vertices; ++i) {
      const float x = coordinate("x"), y = coordinate("y"), z = coordinate("z");
      builder_.add_node(i, {x, y, z}, 0);
      integer("a reference");
    }
  }

  void read_tetrahedra() {
    const std::int64_t tetrahedra = count("the number of tetrahedra", 20);
    for (std::int64_t i = 0; i < tetrahedra; ++i) {
      std::array<std::int64_t, 4> corners{};
      for (std::int64_t& corner : corners) corner = integer("a corner");
      builder_.add_tetrahedron(corners, 0);
      integer("a reference");
    }
  }

  std::size_t size_;
  ByteReader from_;
  TetraBuilder builder_;
  std::int32_t version_ = 1;
};

}  // namespace

TetrahedralMeshFile read_binary_medit(std::string_view bytes, const std::string& name) {
  return BinaryMedit(bytes, name).read();
}

}  // namespace pliant
