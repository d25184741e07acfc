// Tests the PLY reader: the same mesh as text and as bytes of both orders, with properties of all types in any order;
// false headers.
#include "mesh_support.h"

namespace pliant::test {
namespace {

using Triangles = std::vector<std::array<int, 3>>;

std::string header(const std::string& format, const std::string& vertex_properties, const std::string& list,
                   int vertices = 3, int faces = 1) {
  return "ply\nformat " + format + " 1.0\nelement vertex " + std::to_string(vertices) + "\n" + vertex_properties +
         "element face " + std::to_string(faces) + "\nproperty list " + list + " vertex_indices\nend_header\n";
}

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string text_ply = header("ascii", xyz, "uchar int") + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

template <class Coordinate, class Count, class Index>
std::string binary_mesh(bool big, const std::string& coordinate, const std::string& list) {
  std::string properties;
  for (const char* axis : {"x", "y", "z"}) properties += "property " + coordinate + " " + axis + "\n";
  std::string bytes = header(big ? "binary_big_endian" : "binary_little_endian", properties, list);
  for (const int value : {0, 0, 0, 1, 0, 0, 0, 1, 0}) bytes += bytes_of(static_cast<Coordinate>(value), big);
  bytes += bytes_of(static_cast<Count>(3), big);
  for (const int index : {0, 1, 2}) bytes += bytes_of(static_cast<Index>(index), big);
  return bytes;
}

void expect_the_triangle(const std::string& bytes) {
  const TriangleMesh mesh = mesh_of(bytes, "a.ply");
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}}));
  EXPECT_EQ(mesh.positions, (std::vector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST(MeshPly, ReadsTextAndBothByteOrdersOfEveryType) {
  expect_the_triangle(text_ply);
  for (const bool big : {false, true}) {
    expect_the_triangle(binary_mesh<float, std::uint8_t, std::int32_t>(big, "float", "uchar int"));
    expect_the_triangle(binary_mesh<double, std::uint32_t, std::uint32_t>(big, "double", "uint uint"));
    expect_the_triangle(binary_mesh<std::int8_t, std::int8_t, std::uint8_t>(big, "char", "char uchar"));
    expect_the_triangle(binary_mesh<std::int16_t, std::uint16_t, std::int16_t>(big, "int16", "uint16 int16"));
    expect_the_triangle(binary_mesh<std::uint16_t, std::int32_t, std::uint16_t>(big, "ushort", "int ushort"));
    expect_the_triangle(binary_mesh<float, std::int16_t, std::int8_t>(big, "float32", "short int8"));
  }
}

TEST(MeshPly, KeepsTheBitsOfAFloat) {
  std::string bytes = header("binary_big_endian", xyz, "uchar int");
  for (const float value : {1e-41f, 3.4e38f, -0.1f, 1.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f}) bytes += bytes_of(value, true);
  bytes += bytes_of(std::uint8_t{3}) + bytes_of(0, true) + bytes_of(1, true) + bytes_of(2, true);
  EXPECT_EQ(mesh_of(bytes, "a.ply").positions[0], (Vec3f{1e-41f, 3.4e38f, -0.1f}));
}

TEST(MeshPly, PassesOverWhatItDoesNotNeed) {
  const std::string text =
      "ply\r\nformat ascii 1.0\r\ncomment any\r\nobj_info thing\r\nelement edge 1\r\nproperty int vertex1\r\nproperty "
      "int "
      "vertex2\r\n"
      "element face 1\r\nproperty uchar red\r\nproperty list uchar float texcoord\r\nproperty list uchar int "
      "vertex_index\r\n"
      "element vertex 3\r\nproperty uchar red\r\nproperty double z\r\nproperty double y\r\nproperty double "
      "x\r\nproperty "
      "float nx\r\n"
      "end_header\r\n0 1\r\n255 6 0 0 1 0 0 1 3 0 1 2\r\n9 0 0 0 nan\r\n\r\n9 0 0 1 0\r\n9 0 1 0 0\r\n";
  expect_the_triangle(text);
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty uchar red\n" + xyz +
      "element junk 2\nproperty list uchar double more\nelement face 1\nproperty list uchar int vertex_indices\n"
      "property uchar flags\nend_header\n";
  const float corners[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  for (const auto& p : corners) bytes += "R" + bytes_of(p[0]) + bytes_of(p[1]) + bytes_of(p[2]);
  bytes += std::string(1, '\0') + bytes_of(std::uint8_t{2}) + bytes_of(1.0) + bytes_of(2.0);
  bytes += bytes_of(std::uint8_t{3}) + bytes_of(0) + bytes_of(1) + bytes_of(2) + "f";
  expect_the_triangle(bytes);
}

TEST(MeshPly, FindsTheFirstByteBehindTheHeader) {
  // The first byte of the first coordinate is
  //  or \r, and must be read as data.
  for (const char first : {'\n', '\r'}) {
    std::string bytes = binary_mesh<float, std::uint8_t, std::int32_t>(false, "float", "uchar int");
    const std::size_t data = bytes.find("end_header\n") + 11;
    bytes[data] = first;
    const float expected = [&] {
      float value;
      std::memcpy(&value, bytes.data() + data, sizeof value);
      return value;
    }();
    EXPECT_EQ(mesh_of(bytes, "a.ply").positions[0].x, expected);
    std::string returns = bytes.substr(0, data);
    for (char& c : returns) c = c == '\n' ? '\r' : c;
    EXPECT_EQ(mesh_of(returns + bytes.substr(data), "a.ply").positions[0].x, expected) << "lines end in \\r alone";
  }
}

TEST(MeshPly, RefusesHeadersThatLie) {
  const std::pair<std::string, const char*> cases[] = {
      {"ply\nformat ascii 1.0\nelement vertex 2147483647\n" + xyz,
       "ply:3: claims 2147483647 elements 'vertex', at least"},
      {"ply\nformat binary_little_endian 1.0\nelement vertex 2000000000\n" + xyz, "ply:3: claims 2000000000 elements"},
      {"ply\nformat ascii 1.0\nelement vertex 99999999999\n" + xyz, "ply:3: claims 99999999999"},
      {"ply\nformat ascii 1.0\nelement vertex 99999999999999999999\n" + xyz,
       "ply:3: an element needs a name and a count"},
      {"ply\nformat ascii 1.0\nelement vertex -1\n" + xyz, "ply:3: an element needs a name and a count"},
      {"ply\nformat ascii 1.0\nelement vertex 3\nelement face 1\nproperty list uchar int vertex_indices\n",
       "ply:3: element 'vertex' has no properties"},
  };
  for (const auto& [start, problem] : cases)
    EXPECT_TRUE(contains(error_of(start + "end_header\n1 2 3\n", "a.ply"), problem)) << start;
  const std::string body = "element vertex 3\n" + xyz + "element face 1\nproperty list uchar int vertex_indices\n";
  EXPECT_TRUE(contains(error_of("ply\nformat ascii 1.0\n" + body + "end_header\n", "a.ply"),
                       "ply:3: claims 3 elements 'vertex', at least 18 bytes, but 1"));
}

TEST(MeshPly, RefusesDamagedHeaders) {
  const std::string body = "element vertex 3\n" + xyz +
                           "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
                           std::string("0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  const std::pair<std::string, const char*> cases[] = {
      {"ply\nformat ascii 1.0\nelement vertex 0\n", "has no 'end_header'"},
      {"ply\n" + body, "has no 'format' line"},
      {"ply\nformat ascii 2.0\n" + body, "ply:2: version '2.0'"},
      {"ply\nformat binary_middle_endian 1.0\n" + body, "ply:2: format 'binary_middle_endian'"},
      {"ply\nformat ascii 1.0\nformat ascii 1.0\n" + body, "ply:3: a second 'format'"},
      {"ply\nformat ascii 1.0\nproperty float x\n" + body, "ply:3: a property before any element"},
      {"ply\nformat ascii 1.0\nelement vertex 3\nproperty real x\n" + body, "ply:4: unknown type 'real'"},
      {"ply\nformat ascii 1.0\nelement vertex 3\nproperty float\n" + body, "ply:4: a property without a name"},
      {"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float x\n" + body,
       "ply:5: a second property 'x'"},
      {"ply\nformat ascii 1.0\nelement face 3\nproperty list float int a\n" + body, "ply:4: the length of a list"},
      {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n" + body, "ply:5: a second element 'vertex'"},
      {"ply\nformat ascii 1.0\nfoo\n" + body, "ply:3: unknown keyword 'foo'"},
      {"ply\nformat ascii 1.0\nend_header\n", "declares no element 'vertex'"},
      {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n",
       "ply:3: the vertices have no coordinate 'z'"},
      {"ply\nformat ascii 1.0\nelement vertex 1\n" + xyz +
           "element tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n0\n",
       "holds triangle strips"},
      {"ply\nformat ascii 1.0\nelement vertex 1\n" + xyz + "end_header\n0 0 0\n", "has 1 vertices but no faces"},
      {"ply\nformat ascii 1.0\nelement vertex 1\n" + xyz +
           "element face 1\nproperty list uchar int vertices\nend_header\n0 0 0\n0\n",
       "have no list 'vertex_indices'"},
      {"ply\nformat ascii 1.0\nelement vertex 1\n" + xyz +
           "element face 1\nproperty list uchar float vertex_index\nend_header\n0 0 0\n0\n",
       "is not a list of integers"},
  };
  for (const auto& [text, problem] : cases) EXPECT_TRUE(contains(error_of(text, "a.ply"), problem)) << text;
  std::string many = "ply\nformat ascii 1.0\nelement vertex 0\n";
  for (int i = 0; i < 2000; ++i) many += "property float p" + std::to_string(i) + "\n";
  EXPECT_TRUE(contains(error_of(many, "a.ply"), "more than 1000 properties"));
}

TEST(MeshPly, RefusesDamagedRowsByLineOrByte) {
  const std::string start = header("ascii", xyz, "uchar int");
  const std::pair<const char*, const char*> cases[] = {
      {"0 0 0\n1 0\n0 1 0 0 0\n3 0 1 2\n", "ply:11: a row is shorter"},
      {"0 0 0\n1 0 0 7\n0 1 0\n3 0 1 2\n", "ply:11: a row continues with '7'"},
      {"0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", "ply:11: 'nan' is not finite"},
      {"0 0 0\n1 1e40 0\n0 1 0\n3 0 1 2\n", "ply:11: '1e40' is too large"},
      {"0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "ply:13: face 0 uses vertex 3 but there are 3"},
      {"0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "ply:13: face 0 uses vertex -1"},
      {"0 0 0\n1 0 0\n0 1 0\n3 0 1 1.5\n", "ply:13: '1.5' is not an integer"},
      {"0 0 0\n1 0 0\n0 1 0\n2 0 1 \n", "ply:13: face 0 has 2 corners"},
      {"0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n", "ply:13: a list of -3 entries"},
      {"0 0 0\n1 0 0\n0 1 0\n999999999999 0 1 2\n", "ply:13: a row is shorter"},
      {"0.0000 0.0000 0.0000\n1 0 0\n0 1 0\n", "the file ends before its last row"},
  };
  for (const auto& [rows, problem] : cases) EXPECT_TRUE(contains(error_of(start + rows, "a.ply"), problem)) << rows;

  std::string bytes = binary_mesh<float, std::uint8_t, std::int32_t>(false, "float", "uchar int");
  const std::size_t data = bytes.find("end_header\n") + 11;
  const auto with = [&](std::size_t at, const std::string& change) {
    return std::string(bytes).replace(data + at, change.size(), change);
  };
  EXPECT_TRUE(contains(error_of(with(4, bytes_of(NAN)), "a.ply"),
                       "byte " + std::to_string(data + 4) + ": coordinate y of vertex 0 is not finite"));
  EXPECT_TRUE(contains(error_of(with(37, bytes_of(7)), "a.ply"),
                       "byte " + std::to_string(data + 37) + ": face 0 uses vertex 7"));
  EXPECT_TRUE(contains(error_of(with(36, "\xff"), "a.ply"), "the file ends inside a row"));
  EXPECT_TRUE(contains(error_of(bytes.substr(0, bytes.size() - 1), "a.ply"), "the file ends inside a row"));
  const std::string wide = binary_mesh<double, std::uint8_t, std::int32_t>(true, "double", "uchar int");
  const std::size_t wide_data = wide.find("end_header\n") + 11;
  EXPECT_TRUE(contains(error_of(std::string(wide).replace(wide_data, 8, bytes_of(1e300, true)), "a.ply"),
                       "is too large for single precision"));
}

TEST(MeshPly, SaysWhatIsBehindTheLastRow) {
  EXPECT_TRUE(contains(joined(parse_mesh(text_ply + "\n1 2\n\n3 4\n", "a.ply").repairs),
                       "ignored 2 lines after the last element"));
  const std::string bytes = binary_mesh<float, std::uint8_t, std::int32_t>(false, "float", "uchar int");
  EXPECT_TRUE(contains(joined(parse_mesh(bytes + "12345", "a.ply").repairs), "ignored 5 bytes after the last element"));
}

}  // namespace
}  // namespace pliant::test
