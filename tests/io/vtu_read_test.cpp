// Reads .vtu files in all encodings. The base64 and the compressed blocks were made by Python's base64 and zlib, from
// the numbers of `as_text`.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "pliant/error.h"
#include "pliant/io.h"
#include "tetra_support.h"

namespace pliant {
namespace {

using test::replaced;
using test::tetrahedra_message;

std::string write_vtu(const std::string& name, const std::string& text) {
  return test::write_temporary("vtu", name, text);
}

/// A triangle, and two tetrahedra of volumes 1/6 and 1/3; the second is inside out. The last point is in none.
const std::string as_text =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\">\n<UnstructuredGrid>\n"
    "<Piece NumberOfPoints=\"6\" NumberOfCells=\"3\">\n<Points>\n"
    "<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n0 0 0 1 0 0\n0 1 0 0 0 1 0 0 -2 9 9 "
    "9\n</DataArray>\n"
    "</Points>\n<Cells>\n<DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 2 0 1 2 3 0 1 2 "
    "4</DataArray>\n"
    "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">3 7 11</DataArray>\n"
    "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">5 10 "
    "10</DataArray>\n</Cells>\n</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
const std::string inline_base64 =
    "<?xml version=\"1.0\"?>\n"
    "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt32\">\n"
    "<UnstructuredGrid>\n"
    "<Piece NumberOfPoints=\"6\" NumberOfCells=\"3\">\n"
    "<PointData/>\n"
    "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"binary\">\n"
    "SAAAAAAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAwAAAEEEAABBBAAAQQQ==\n"
    "</DataArray></Points>\n"
    "<Cells><DataArray type=\"Int32\" Name=\"connectivity\" format=\"binary\">\n"
    "LAAAAAAAAAABAAAAAgAAAAAAAAABAAAAAgAAAAMAAAAAAAAAAQAAAAIAAAAEAAAA\n"
    "</DataArray><DataArray type=\"Int32\" Name=\"offsets\" format=\"binary\">\n"
    "DAAAAAMAAAAHAAAACwAAAA==\n"
    "</DataArray><DataArray type=\"UInt8\" Name=\"types\" format=\"binary\">\n"
    "AwAAAAUKCg==\n"
    "</DataArray></Cells>\n"
    "</Piece>\n"
    "</UnstructuredGrid>\n"
    "</VTKFile>\n";
const std::string compressed =
    "<?xml version=\"1.0\"?>\n"
    "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt32\" "
    "compressor=\"vtkZLibDataCompressor\">\n"
    "<UnstructuredGrid>\n"
    "<Piece NumberOfPoints=\"6\" NumberOfCells=\"3\">\n"
    "<PointData/>\n"
    "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"binary\">\n"
    "BQAAABAAAAAIAAAADQAAAA0AAAANAAAAEAAAAA4AAAA="
    "eJxjYEAGDfYAAU8AwHicY2BABg32AAFPAMB4nGNgQAYN9gABTwDAeJxjYICDAwwMAo4ABDEBEnicY2AQcGQAYgACDgCj\n"
    "</DataArray></Points>\n"
    "<Cells><DataArray type=\"Int32\" Name=\"connectivity\" format=\"binary\">\n"
    "AwAAABAAAAAMAAAAEgAAABIAAAARAAAAeJxjYGBgYARiJgYIAAAALAAEeJxjZGBgYAJiZgYIAAAAUAAHeJxjZGBgYAJiFiAGAAA4AAg=\n"
    "</DataArray><DataArray type=\"Int32\" Name=\"offsets\" format=\"binary\">\n"
    "AQAAABAAAAAMAAAAEQAAAA==eJxjZmBgYAdibiAGAACUABY=\n"
    "</DataArray><DataArray type=\"UInt8\" Name=\"types\" format=\"binary\">\n"
    "AQAAABAAAAADAAAACwAAAA==eJxj5eICAAAwABo=\n"
    "</DataArray></Cells>\n"
    "</Piece>\n"
    "</UnstructuredGrid>\n"
    "</VTKFile>\n";
const std::string big_end_first =
    "<?xml version=\"1.0\"?>\n"
    "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"BigEndian\" header_type=\"UInt64\">\n"
    "<UnstructuredGrid>\n"
    "<Piece NumberOfPoints=\"6\" NumberOfCells=\"3\">\n"
    "<PointData/>\n"
    "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"binary\">\n"
    "AAAAAAAAAEgAAAAAAAAAAAAAAAA/gAAAAAAAAAAAAAAAAAAAP4AAAAAAAAAAAAAAAAAAAD+AAAAAAAAAAAAAAMAAAABBEAAAQRAAAEEQAAA=\n"
    "</DataArray></Points>\n"
    "<Cells><DataArray type=\"Int64\" Name=\"connectivity\" format=\"binary\">\n"
    "AAAAAAAAAFgAAAAAAAAAAAAAAAAAAAABAAAAAAAAAAIAAAAAAAAAAAAAAAAAAAABAAAAAAAAAAIAAAAAAAAAAwAAAAAAAAAAAAAAAAAAAAEAAAAAAA"
    "AAAg"
    "AAAAAAAAAE\n"
    "</DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"binary\">\n"
    "AAAAAAAAABgAAAAAAAAAAwAAAAAAAAAHAAAAAAAAAAs=\n"
    "</DataArray><DataArray type=\"UInt8\" Name=\"types\" format=\"binary\">\n"
    "AAAAAAAAAAMFCgo=\n"
    "</DataArray></Cells>\n"
    "</Piece>\n"
    "</UnstructuredGrid>\n"
    "</VTKFile>\n";
const std::string appended_compressed =
    "<?xml version=\"1.0\"?>\n"
    "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\" "
    "compressor=\"vtkZLibDataCompressor\">\n"
    "<UnstructuredGrid>\n"
    "<Piece NumberOfPoints=\"6\" NumberOfCells=\"3\">\n"
    "<PointData/>\n"
    "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/></Points>\n"
    "<Cells><DataArray type=\"Int64\" Name=\"connectivity\" format=\"appended\" offset=\"180\"/><DataArray "
    "type=\"Int64\" "
    "Name=\"offsets\" format=\"appended\" offset=\"376\"/><DataArray type=\"UInt8\" Name=\"types\" format=\"appended\" "
    "offset=\"468\"/></Cells>\n"
    "</Piece>\n"
    "</UnstructuredGrid>\n"
    "<AppendedData encoding=\"base64\">\n"
    "_BQAAAAAAAAAQAAAAAAAAAAgAAAAAAAAADQAAAAAAAAANAAAAAAAAAA0AAAAAAAAAEAAAAAAAAAAOAAAAAAAAAA=="
    "eJxjYEAGDfYAAU8AwHicY2BABg32AAFPAMB4nGNgQAYN9gABTwDAeJxjYICDAwwMAo4ABDEBEnicY2AQcGQAYgACDgCjBgAAAAAAAAAQAAAAAAAAAA"
    "gAAA"
    "AAAAAADgAAAAAAAAALAAAAAAAAAA4AAAAAAAAACwAAAAAAAAAOAAAAAAAAAAsAAAAAAAAAeJxjYIAARigNAAAYAAJ4nGNiQAUAADAAA3icY2SAACYo"
    "DQAA"
    "MAAEeJxjZkAFAABAAAR4nGNkgAAmKA0AADAABHicY2GAAAAAKAAFAgAAAAAAAAAQAAAAAAAAAAgAAAAAAAAADgAAAAAAAAALAAAAAAAAAA=="
    "eJxjZoAAdigNAAB4AAt4nONmgAAAAGAADA==AQAAAAAAAAAQAAAAAAAAAAMAAAAAAAAACwAAAAAAAAA=eJxj5eICAAAwABo=\n"
    "</AppendedData>\n"
    "</VTKFile>\n";

template <class T>
std::string bytes_of(const std::vector<T>& values) {
  std::string out(values.size() * sizeof(T), '\0');
  std::memcpy(out.data(), values.data(), out.size());
  return out;
}

/// Arrays as raw bytes behind the XML, each after its size.
std::string raw() {
  const std::vector<std::string> arrays{bytes_of<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -2, 9, 9, 9}),
                                        bytes_of<std::int32_t>({0, 1, 2, 0, 1, 2, 3, 0, 1, 2, 4}),
                                        bytes_of<std::int32_t>({3, 7, 11}), bytes_of<std::uint8_t>({5, 10, 10})};
  std::string data,
      text =
          "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\" header_type=\"UInt32\"><UnstructuredGrid>"
          "<Piece NumberOfPoints=\"6\" NumberOfCells=\"3\">";
  const char* const heads[] = {
      "<Points><DataArray type=\"Float32\"", "<Cells><DataArray type=\"Int32\" Name=\"connectivity\"",
      "<DataArray type=\"Int32\" Name=\"offsets\"", "<DataArray type=\"UInt8\" Name=\"types\""};
  for (std::size_t i = 0; i < arrays.size(); ++i) {
    text += std::string(heads[i]) + " format=\"appended\" offset=\"" + std::to_string(data.size()) + "\"/>";
    if (i == 0) text += "</Points>";
    data += bytes_of<std::uint32_t>({static_cast<std::uint32_t>(arrays[i].size())}) + arrays[i];
  }
  return text + "</Cells></Piece></UnstructuredGrid><AppendedData encoding=\"raw\">_" + data +
         "</AppendedData></VTKFile>";
}

/// Medit's binary format, of each version: places and counts of 32 or 64 bits, floats or doubles.
std::string binary_medit(int version) {
  std::string text = bytes_of<std::int32_t>({1, version});
  const auto place = [&](std::int64_t at) {
    return version >= 3 ? bytes_of<std::int64_t>({at}) : bytes_of<std::int32_t>({static_cast<std::int32_t>(at)});
  };
  const auto integers = [&](const std::vector<std::int64_t>& values) {
    return version >= 4 ? bytes_of(values) : bytes_of(std::vector<std::int32_t>(values.begin(), values.end()));
  };
  const auto block = [&](std::int32_t code, const std::string& body) {
    const std::size_t head = version >= 3 ? 12 : 8;
    text += bytes_of<std::int32_t>({code}) + place(static_cast<std::int64_t>(text.size() + head + body.size())) + body;
  };
  block(3, bytes_of<std::int32_t>({3}));
  std::string vertices = integers({6});
  for (const std::vector<double>& at :
       {std::vector<double>{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -2}, {9, 9, 9}})
    vertices += (version >= 2 ? bytes_of(at) : bytes_of(std::vector<float>(at.begin(), at.end()))) + integers({0});
  block(4, vertices);
  block(6, integers({1, 1, 2, 3, 0}));
  block(8, integers({2, 1, 2, 3, 4, 0, 1, 2, 3, 5, 0}));
  return text + bytes_of<std::int32_t>({54}) + place(0);
}

void expect_corners_of_two(const std::string& path) {
  const TetrahedralMeshFile file = read_tetrahedral_mesh(path);
  ASSERT_EQ(file.mesh.positions.size(), 5u) << path;
  ASSERT_EQ(file.mesh.tetrahedra.size(), 2u) << path;
  EXPECT_EQ(file.mesh.positions[4], (Vec3f{0, 0, -2})) << path;
  EXPECT_EQ(file.mesh.tetrahedra[0], (std::array<int, 4>{0, 1, 2, 3})) << path;
  EXPECT_EQ(file.mesh.tetrahedra[1], (std::array<int, 4>{0, 1, 4, 2})) << path;  // turned
}

TEST(VtkXmlFiles, OfEachEncodingGiveTheSameMesh) {
  expect_corners_of_two(write_vtu("text.vtu", as_text));
  expect_corners_of_two(write_vtu("base64.vtu", inline_base64));
  expect_corners_of_two(write_vtu("compressed.vtu", compressed));
  expect_corners_of_two(write_vtu("big_end_first.vtu", big_end_first));
  expect_corners_of_two(write_vtu("appended.vtu", appended_compressed));
  expect_corners_of_two(write_vtu("raw.vtu", raw()));
}

/// `as_text` with a second piece, of the same cells and other points.
std::string two_pieces(const std::string& points) {
  const std::string of_first = "0 0 0 1 0 0\n0 1 0 0 0 1 0 0 -2 9 9 9";
  const std::size_t begin = as_text.find("<Piece"), end = as_text.find("</UnstructuredGrid>");
  std::string piece = as_text.substr(begin, end - begin), text = as_text;
  return text.insert(end, piece.replace(piece.find(of_first), of_first.size(), points));
}

TEST(VtkXmlFiles, MayHaveSeveralPieces) {
  const TetrahedralMeshFile file =
      read_tetrahedral_mesh(write_vtu("apart.vtu", two_pieces("5 0 0 6 0 0 5 1 0 5 0 1 5 0 -2 9 9 9")));
  EXPECT_EQ(file.mesh.positions.size(), 10u);
  EXPECT_EQ(file.mesh.tetrahedra.size(), 4u);
}

/// The second piece has a face in common with the first: (0, 0, 0), (0, 1, 0), (0, 0, 1).
TEST(VtkXmlFiles, AreOneBodyWherePiecesTouch) {
  const TetrahedralMeshFile file =
      read_tetrahedral_mesh(write_vtu("touch.vtu", two_pieces("0 -0 0 0 1 0 -1 0 0 0 0 1 -1 0 -1 9 9 9")));
  EXPECT_EQ(file.mesh.positions.size(), 7u);
  EXPECT_EQ(file.mesh.tetrahedra.size(), 4u);
  ASSERT_FALSE(file.repairs.empty());
  EXPECT_EQ(file.repairs[0], "merged 4 points with others of another piece at the same position");
  EXPECT_EQ(border_triangles(file.mesh).size(), 10u) << "two faces inside of it";
}

/// A crack has two points at one position of one piece. They stay two, and each goes with one of the other piece.
TEST(VtkXmlFiles, KeepCracksOfAPieceOpen) {
  const std::string cracked = "0 0 0 1 0 0 0 1 0 0 0 1 0 0 1 9 9 9";
  std::string text = two_pieces(cracked);
  text.replace(text.find("0 0 0 1 0 0\n0 1 0 0 0 1 0 0 -2 9 9 9"), 37, cracked);
  const TetrahedralMeshFile file = read_tetrahedral_mesh(write_vtu("crack.vtu", text));
  EXPECT_EQ(file.mesh.positions.size(), 5u);
}

TEST(MeditFiles, OfEachBinaryVersionGiveTheSameMesh) {
  for (int version = 1; version <= 4; ++version)
    expect_corners_of_two(write_vtu("v" + std::to_string(version) + ".meshb", binary_medit(version)));
}

TEST(VtkXmlFiles, ThatAreDamagedAreRefusedWithTheirLine) {
  for (const auto& [text, expected] : std::vector<std::pair<std::string, std::string>>{
           {"<VTKFile>", "is not valid XML"},
           {"<VTKFile></VTKFile>", "has no UnstructuredGrid"},
           {"<a/>", "has no element 'VTKFile'"},
           {replaced(as_text, "5 10 10", "5 10 12"), "cell 2 has type 12"},
           {replaced(as_text, "5 10 10", "5 10 24"), "cell 2 has type 24"},
           {replaced(as_text, "3 7 11", "3 7 12"), "offset 2 is 12"},
           {replaced(as_text, "3 7 11", "3 7"), "has 2 numbers, where 3 belong"},
           {replaced(as_text, "0 1 2 4", "0 1 2 6"), "cell 2 has the corner 6"},
           {replaced(as_text, "9 9 9", "9 nan 9"), ":6: 'nan' is not finite"},
           {replaced(as_text, "NumberOfCells=\"3\"", "NumberOfCells=\"-3\""), "NumberOfCells is '-3'"},
           {replaced(as_text, "connectivity", "corners"), "has no Cells, connectivity"},
           {replaced(compressed, "vtkZLib", "vtkLZ4"), "is compressed by 'vtkLZ4DataCompressor'"},
           {replaced(compressed, "eJx", "eJy"), "zlib cannot read"},
           {replaced(inline_base64, "AAA", "A*A"), "none of base64"},
           {replaced(appended_compressed, "offset=\"468\"", "offset=\"46800\""), "has the offset '46800'"}}) {
    const std::string found = tetrahedra_message(write_vtu("damaged.vtu", text));
    EXPECT_NE(found.find(expected), std::string::npos) << text << "\n" << found;
  }
}

TEST(MeditFiles, ThatAreDamagedAreRefused) {
  EXPECT_NE(tetrahedra_message(write_vtu("a.meshb", "x")).find("byte"), std::string::npos);
  EXPECT_NE(tetrahedra_message(write_vtu("a.meshb", bytes_of<std::int32_t>({7, 2}))).find("is no binary Medit file"),
            std::string::npos);
  EXPECT_NE(tetrahedra_message(write_vtu("a.meshb", bytes_of<std::int32_t>({1, 2, 10, 28, 1, 0, 0})))
                .find("no linear tetrahedra"),
            std::string::npos);
}

// Each byte that is changed or cut off gives a mesh or an Error, and nothing else; the sanitizers look on.
TEST(VtkXmlFiles, NeverCrash) {
  for (const auto& [name, text] : {std::pair<std::string, std::string>{"x.vtu", as_text},
                                   {"x1.vtu", compressed},
                                   {"x2.vtu", appended_compressed},
                                   {"x3.vtu", raw()},
                                   {"x.meshb", binary_medit(2)},
                                   {"x4.meshb", binary_medit(4)}})
    for (std::size_t i = 0; i < text.size(); i += 2) {
      std::string changed = text;
      changed[i] = static_cast<char>(changed[i] ^ (i % 4 == 0 ? 0x10 : 0x7f));
      for (const std::string& one : {changed, text.substr(0, i)}) tetrahedra_message(write_vtu(name, one));
    }
}

}  // namespace
}  // namespace pliant
