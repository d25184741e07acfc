// Tests the readers of tetrahedral meshes: each format, what is damaged, and every file of real meshes where they are
// there.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "scene_support.h"
#include "tetra_support.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;
using test::replaced;
using test::tetrahedra_message;

std::string write(const std::string& name, const std::string& text) {
  return test::write_temporary("tetrahedra", name, text);
}

double volume_of(const TetrahedralMesh& mesh) {
  double six = 0;
  for (const auto& [a, b, c, d] : mesh.tetrahedra) {
    const auto at = [&, origin = mesh.positions[static_cast<std::size_t>(a)]](int i) {
      return mesh.positions[static_cast<std::size_t>(i)] - origin;
    };
    six += static_cast<double>(dot(cross(at(b), at(c)), at(d)));
  }
  return six / 6;
}

/// Two tetrahedra, of volumes 1/6 and 1/3; the second is inside out. Node 9 is in none.
const std::string medit =
    "MeshVersionFormatted 2\nDimension 3\n# two\nVertices 6\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 -2 0\n9 9 9 0\n"
    "Triangles 1\n1 2 3 0\nTetrahedra 2\n1 2 3 4 0\n1 2 3 5 0\nEnd\n";
const std::string vtk =
    "# vtk DataFile Version 3.0\n\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 6 float\n0 0 0 1 0 0\n0 1 0 0 0 1 0 0 -2 9 "
    "9 "
    "9\n"
    "CELLS 3 14\n3 0 1 2\n4 0 1 2 3\n4 0 1 2 4\nCELL_TYPES 3\n5\n10\n10\nPOINT_DATA 6\nSCALARS s float\n";
const std::string vtk_5 =
    "# vtk DataFile Version 5.1\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 6 double\n0 0 0 1 0 0 0 1 0 0 0 1 0 0 "
    "-2 "
    "9 9 9\n"
    "CELLS 3 8\nOFFSETS vtktypeint64\n0 4 8\nCONNECTIVITY vtktypeint64\n0 1 2 3 0 1 2 4\nCELL_TYPES 2\n10 10\n";
const std::string gmsh_2 =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"a body\"\n$EndPhysicalNames\n$Nodes\n6\n1 0 0 0\n2 "
    "1 0 "
    "0\n"
    "3 0 1 0\n4 0 0 1\n7 0 0 -2\n9 9 9 9\n$EndNodes\n$Elements\n3\n1 2 2 0 1 1 2 3\n2 4 2 0 1 1 2 3 4\n3 4 0 1 2 3 "
    "7\n$EndElements\n";
const std::string gmsh_4 =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n2 6 1 9\n2 1 1 2\n1\n2\n0 0 0 0.5 0.5\n1 0 0 0.5 0.5\n3 1 0 "
    "4\n3\n4\n7\n9\n0 1 0\n"
    "0 0 1\n0 0 -2\n9 9 9\n$EndNodes\n$Elements\n2 3 1 3\n2 1 2 1\n1 1 2 3\n3 1 4 2\n2 1 2 3 4\n3 1 2 3 "
    "7\n$EndElements\n";
const std::string vertex_tet =
    "Vertex 0 0 0 0\nVertex 1 1 0 0 {rgb=1}\nVertex 2 0 1 0\nVertex 3 0 0 1\nVertex 5 0 0 -2\nVertex 9 9 9 9\nTet 0 0 "
    "1 2 "
    "3\nTet 1 0 1 2 5\n";
const std::string node =
    "# nodes\n6 3 1 1\n1 0 0 0 7 0\n2 1 0 0 7 0\n3 0 1 0 7 0\n4 0 0 1 7 0\n5 0 0 -2 7 1\n6 9 9 9 7 1\n";
const std::string ele = "2 4 1\n1 1 2 3 4 -1\n2 1 2 3 5 -1\n# made by hand\n";

template <class T>
void put(std::string& to, T value, bool swap) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  if (swap) std::reverse(raw, raw + sizeof value);
  to.append(raw, sizeof value);
}

std::string binary_vtk(bool has_offsets) {
  const std::string head = "# vtk DataFile Version 4.2\ntitle\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 6 ";
  std::string text = head + (has_offsets ? "double\n" : "float\n");
  for (const int x : {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -2, 9, 9, 9})
    has_offsets ? put(text, static_cast<double>(x), true) : put(text, static_cast<float>(x), true);
  if (has_offsets) {
    text += "\nMETADATA\nINFORMATION 0\n\nCELLS 4 11\nOFFSETS vtktypeint64\n";
    for (const std::int64_t one : {0, 3, 7, 11}) put(text, one, true);
    text += "\nCONNECTIVITY vtktypeint64\n";
    for (const std::int64_t one : {0, 1, 2, 0, 1, 2, 3, 0, 1, 2, 4}) put(text, one, true);
  } else {
    text += "\nCELLS 3 14\n";
    for (const std::int32_t one : {3, 0, 1, 2, 4, 0, 1, 2, 3, 4, 0, 1, 2, 4}) put(text, one, true);
  }
  text += "\nCELL_TYPES 3\n";
  for (const std::int32_t one : {5, 10, 10}) put(text, one, true);
  return text + "\nPOINT_DATA 6\n";
}

std::string binary_gmsh_2(bool swap) {
  std::string text = "$MeshFormat\n2.2 1 8\n";
  const auto number = [&](std::int32_t value) { put(text, value, swap); };
  number(1);
  text += "\n$EndMeshFormat\n$Nodes\n5\n";
  const double at[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -2}};
  for (int i = 0; i < 5; ++i) {
    number(i + 1);
    for (const double x : at[i]) put(text, x, swap);
  }
  text += "\n$EndNodes\n$Elements\n2\n";
  for (const int one : {4, 2, 1, /* number, tag, nodes */ 1, 7, 1, 2, 3, 4, 2, 7, 1, 2, 3, 5}) number(one);
  return text + "\n$EndElements\n";
}

void expect_two(const std::string& path) {
  const TetrahedralMeshFile file = read_tetrahedral_mesh(path);
  EXPECT_EQ(file.mesh.positions.size(), 5u) << path;
  EXPECT_EQ(file.mesh.tetrahedra.size(), 2u) << path;
  EXPECT_NEAR(volume_of(file.mesh), 0.5, 1e-6) << path;
  ASSERT_GE(file.repairs.size(), 1u) << path;
  EXPECT_EQ(file.repairs[0], "1 tetrahedron was inside out, and was turned") << path;
}

TEST(TetrahedralFiles, OfEachFormatGiveTheSameMesh) {
  expect_two(write("binary.vtk", binary_vtk(false)));
  expect_two(write("binary_5.vtk", binary_vtk(true)));
  expect_two(write("two.mesh", medit));
  expect_two(write("two.vtk", vtk));
  expect_two(write("five.vtk", vtk_5));
  expect_two(write("two.msh", gmsh_2));
  expect_two(write("four.msh", gmsh_4));
  expect_two(write("two.t", vertex_tet));
  write("two.ELE", ele);
  expect_two(write("pair.node", (write("pair.ele", ele), node)));
  expect_two(write("pair.ele", ele));
  expect_two(write("binary.msh", binary_gmsh_2(false)));
  expect_two(write("other_order.msh", binary_gmsh_2(true)));
}

TEST(TetrahedralFiles, OfMmgHaveRequiredTetrahedra) {
  expect_two(write("mmg.mesh", replaced(medit, "End", "RequiredTetrahedra 1\n2\nEnd")));
}

TEST(TetrahedralFiles, AreNamedWhereASurfaceIsWanted) {
  for (const auto& [name, text] : {std::pair<std::string, std::string>{"a.msh", gmsh_2},
                                   {"a.vtk", vtk},
                                   {"a.ele", ele},
                                   {"a.vtu", "<?xml version=\"1.0\"?>\n<VTKFile>"}}) {
    try {
      read_mesh(write(name, text));
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_NE(error.advice().find("soft_body"), std::string::npos) << error.what();
    }
  }
}

TEST(TetrahedralFiles, NameNodesThatNoTetrahedronUses) {
  EXPECT_EQ(read_tetrahedral_mesh(write("two.mesh", medit)).repairs[1], "1 node that no tetrahedron uses was left out");
}

/// Two tetrahedra with equal corners of a face, which are nodes of their own.
TEST(TetrahedralFiles, SayWherePartsTouchThatAreNotConnected) {
  const std::string parts =
      "Vertex 0 0 0 0\nVertex 1 1 0 0\nVertex 2 0 1 0\nVertex 3 0 0 1\nVertex 4 0 0 0\nVertex 5 1 0 0\nVertex 6 0 1 0\n"
      "Vertex 7 0 0 -1\nTet 0 0 1 2 3\nTet 1 4 6 5 7\n";
  const TetrahedralMeshFile file = read_tetrahedral_mesh(write("parts.t", parts));
  EXPECT_EQ(file.mesh.positions.size(), 8u) << "they stay two";
  ASSERT_EQ(file.repairs.size(), 1u);
  EXPECT_EQ(
      file.repairs[0],
      "3 nodes are at positions of nodes of another part, but not connected to it: the parts come apart; merge equal "
      "nodes if they are one body");
  const std::string cracked = replaced(replaced(parts, "4 6 5 7", "4 6 5 3"), "Vertex 7 0 0 -1\n", "");
  for (const std::string& repair : read_tetrahedral_mesh(write("cracked.t", cracked)).repairs)
    EXPECT_EQ(repair.find("part"), std::string::npos) << "they share node 3: " << repair;
}

TEST(TetrahedralFiles, ThatAreDamagedAreRefusedWithTheirLine) {
  const std::vector<std::pair<std::pair<std::string, std::string>, std::string>> cases = {
      {{"a.mesh", ""}, "is empty"},
      {{"a.mesh", "\x7f\x45LF\xff\xfe"}, "should be"},
      {{"a.mesh", replaced(medit, "1 2 3 5 0\nEnd", "1 2 3 77 0\nEnd")},
       ":15: a tetrahedron uses node 77, which does not exist; nodes run from 1 to 6"},
      {{"a.mesh", replaced(medit, "0 1 0 0", "0 nan 0 0")}, ":7: 'nan', y, is not finite"},
      {{"a.mesh", replaced(medit, "0 1 0 0", "0 x 0 0")}, ":7: 'x', y, is not a number"},
      {{"a.mesh", replaced(medit, "Vertices 6", "Vertices 1000000000000000000")},
       ":4: the number of vertices is 1000000000000000000"},
      {{"a.mesh", replaced(medit, "Vertices 6", "Vertices -6")}, "too short"},
      {{"a.mesh", replaced(medit, "Triangles 1\n1 2 3 0", "Hexahedra 1\n1 2 3 4 5 6 1 2 0")},
       ":11: has Hexahedra; export linear tetrahedra alone"},
      {{"a.mesh", replaced(medit, "Dimension 3", "Dimension 2")}, "has 2 dimensions"},
      {{"a.mesh", replaced(medit, "Triangles", "Squares")}, "'Squares' is no keyword"},
      {{"a.mesh", medit.substr(0, medit.size() - 12)}, "ends where"},
      {{"a.mesh", medit.substr(0, medit.find("Tetra"))}, "has no tetrahedron; export the volume mesh"},
      {{"a.vtk", binary_vtk(false).substr(0, 130)}, "byte"},
      {{"a.vtk", binary_vtk(true).substr(0, 420)}, "byte"},
      {{"a.vtk", replaced(binary_vtk(false), "POINTS 6", "POINTS 60000")}, "for which the file is too short"},
      {{"a.vtk", replaced(binary_vtk(false), "UNSTRUCTURED_GRID", "POLYDATA")}, "is no UNSTRUCTURED_GRID"},
      {{"a.vtk", replaced(binary_vtk(false), "float", "int")}, "points are of type 'int'"},
      {{"a.vtk", replaced(vtk, "UNSTRUCTURED_GRID", "POLYDATA")}, "'POLYDATA' has no tetrahedra"},
      {{"a.vtk", replaced(vtk, "10\n10", "10\n12")}, "cell 2 has type 12"},
      {{"a.vtk", replaced(vtk, "10\n10", "10\n24")}, "cell 2 has type 24"},
      {{"a.vtk", replaced(vtk, "4 0 1 2 4", "900000000 0 1 2 4")}, "a cell has 900000000 corners"},
      {{"a.vtk", replaced(vtk, "CELL_TYPES 3", "CELL_TYPES 2")}, "2 types for 3 cells"},
      {{"a.vtk", vtk.substr(0, vtk.find("CELL_TYPES"))}, "ends before its CELL_TYPES"},
      {{"a.vtk", replaced(vtk_5, "0 4 8", "1 4 8")}, "offset 0 is 1"},
      {{"a.vtk", replaced(vtk_5, "0 4 8", "0 4 9")}, "offset 2 is 9"},
      {{"a.vtk", replaced(replaced(vtk, "CELLS 3 14\n3 0 1 2\n4 0 1 2 3\n4 0 1 2 4", "CELLS 0 0"),
                          "CELL_TYPES 3\n5\n10\n10", "CELL_TYPES 0")},
       "has no tetrahedron"},
      {{"a.vtk", "solid"}, "is no VTK file"},
      {{"a.vtk", replaced(vtk_5, "0 4 8", "0 9 8")},
       "offset 1 is 9; offsets ascend from 0 to the number of corners, 8"},
      {{"a.msh", replaced(gmsh_2, "2.2", "4.0")}, ":2: has version '4.0' of the format"},
      {{"a.msh", replaced(gmsh_2, "2 4 2 0 1", "2 5 2 0 1")}, ":20: has elements of type 5"},
      {{"a.msh", replaced(gmsh_2, "2 4 2 0 1", "2 11 2 0 1")}, "Mesh.ElementOrder = 1"},
      {{"a.msh", replaced(gmsh_2, "2 4 2 0 1", "2 4 9999999 0 1")}, "9999999 tags"},
      {{"a.msh", replaced(gmsh_2, "$Nodes\n6", "$Nodes\n600")}, "for which the file is too short"},
      {{"a.msh", replaced(gmsh_2, "4 0 0 1\n", "3 0 0 1\n")}, ":13: node 3 is there twice"},
      {{"a.msh", gmsh_2.substr(0, gmsh_2.find("$Elements"))}, "has no $Elements"},
      {{"a.msh", replaced(gmsh_4, "3 1 4 2", "3 1 4 200000000000")}, "too short"},
      {{"a.msh", replaced(gmsh_2, "$Elements\n3", "$Elements\n2")},
       ":21: has more in $Elements than its counts say: '3' is where $EndElements should be"},
      {{"a.msh", replaced(gmsh_2, "$Nodes\n6", "$Nodes\n5")}, ":15: has more in $Nodes than its counts say"},
      {{"a.msh", replaced(gmsh_4, "3 1 4 2", "3 1 4 1")}, "has more in $Elements than its counts say: '3' is where"},
      {{"a.msh", replaced(binary_gmsh_2(false), "$Nodes\n5", "$Nodes\n4")}, "has more in $Nodes than its counts say"},
      {{"a.msh", replaced(gmsh_2, "$EndNodes\n", "")}, "'$Elements' is where $EndNodes should be"},
      {{"a.msh", binary_gmsh_2(false).substr(0, 150)}, "byte"},
      {{"a.t", "Vertex 0 0 0\n"}, "ends where z should follow"},
      {{"a.t", "Hex 0 0 0\n"}, "'Hex' is no keyword"},
      {{"a.obj", "v 0 0 0"}, "is a surface; fill it"},
      {{"a.foo", "x"}, "which no format of tetrahedra has"},
  };
  for (const auto& [file, expected] : cases) {
    const std::string found = tetrahedra_message(write(file.first, file.second));
    EXPECT_NE(found.find(expected), std::string::npos) << file.second << "\n" << found;
  }
}

/// `vertex_tet`, moved along x.
std::string moved(const std::string& x, const std::string& next) {
  std::string text = vertex_tet;
  for (const std::string number : {"0", "2", "3", "5"})
    text = replaced(text, "Vertex " + number + " 0", "Vertex " + number + " " + x);
  return replaced(text, "Vertex 1 1", "Vertex 1 " + next);
}

/// Floats round the shape far from the origin, which `fit` cannot undo.
TEST(TetrahedralFiles, SayWhereFloatsAreTooCoarse) {
  EXPECT_EQ(read_tetrahedral_mesh(write("near.t", moved("100000", "100001"))).repairs.size(), 2u);
  const std::vector<std::string> notes = read_tetrahedral_mesh(write("far.t", moved("200000", "200001"))).repairs;
  ASSERT_EQ(notes.size(), 3u);
  EXPECT_EQ(
      notes[0],
      "lies 200001 from the origin, where floats are 0.016 apart, 1 % of its mean edge: move it to the origin before "
      "it is exported");
  EXPECT_NE(tetrahedra_message(write("farther.t", moved("5000000", "5000000.3")))
                .find("farther.t: lies 5000000 from the origin, where floats are 0.5 apart, "),
            std::string::npos);
}

TEST(TetrahedralFiles, OfGmshMayHaveBlankLinesAndOmitTheLastEnd) {
  expect_two(write("blank.msh", replaced(gmsh_2, "$EndNodes", "\n \n$EndNodes")));
  expect_two(write("no_end.msh", replaced(gmsh_4, "$EndElements\n", "")));
}

TEST(TetrahedralFiles, OfTetGenNeedBothFiles) {
  fs::remove(fs::path(testing::TempDir()) / "tetrahedra" / "alone.node");
  EXPECT_NE(tetrahedra_message(write("alone.ele", ele)).find("alone.node"), std::string::npos);
  const auto pair = [](const std::string& nodes, const std::string& elements) {
    write("bad.node", nodes);
    return tetrahedra_message(write("bad.ele", elements));
  };
  EXPECT_NE(pair(replaced(node, "6 3 1 1", "7 3 1 1"), ele).find("ends after 6 of 7 nodes"), std::string::npos);
  EXPECT_NE(pair(replaced(node, "6 3 1 1", "6 2 1 1"), ele).find("have 2 coordinates"), std::string::npos);
  EXPECT_NE(pair(node, replaced(ele, "2 4 1", "2 10 1")).find("without the option -o2"), std::string::npos);
  EXPECT_NE(pair(node, replaced(ele, "2 1 2 3 5", "2 1 2 3 0")).find("bad.ele:3: a tetrahedron uses node 0"),
            std::string::npos);
  EXPECT_NE(pair(node, replaced(ele, "2 4 1", "1 4 1")).find("bad.ele:3: has more rows than the 1 that its first line"),
            std::string::npos);
  EXPECT_NE(pair(replaced(node, "6 3 1 1", "5 3 1 1"), ele).find("bad.node:8: has more rows than the 5"),
            std::string::npos);
  EXPECT_EQ(pair(node + "\n  \n# Generated by tetgen\n\n", ele + "\n\t\n#\n"), "accepted");
  EXPECT_NE(pair(node, replaced(ele, "2 4 1", "900000000000 4 1")).find("too short"), std::string::npos);
  EXPECT_EQ(pair(replaced(node, "6 3 1 1", "6 3 1000000000000000000 1"), ele), "accepted");  // attributes are not read
}

// Each byte that is changed or cut off gives a mesh or an Error, and nothing else; the sanitizers look on.
TEST(TetrahedralFiles, NeverCrash) {
  for (const auto& [name, text] : {std::pair<std::string, std::string>{"x.mesh", medit},
                                   {"x.vtk", vtk},
                                   {"x5.vtk", vtk_5},
                                   {"x2.msh", gmsh_2},
                                   {"x4.msh", gmsh_4},
                                   {"xb.msh", binary_gmsh_2(false)},
                                   {"xb.vtk", binary_vtk(false)},
                                   {"xb5.vtk", binary_vtk(true)},
                                   {"x.t", vertex_tet}}) {
    for (std::size_t i = 0; i < text.size(); i += 3) {
      std::string changed = text;
      changed[i] = static_cast<char>(changed[i] ^ (i % 2 == 0 ? 0x10 : 0x7f));
      for (const std::string& one : {changed, text.substr(0, i)}) {
        try {
          read_tetrahedral_mesh(write(name, one));
        } catch (const Error& error) {
          EXPECT_FALSE(error.problem().empty());
        }
      }
    }
  }
}

/// Every real mesh is read. Where the meshes are not there, this says so; the tests above hold without them.
TEST(TetrahedralFiles, OfResearchCodesAreRead) {
  const fs::path folder = test::in_shared_data("tet");
  if (!fs::exists(folder)) GTEST_SKIP() << "the meshes are not there";
  int read = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string suffix = entry.path().extension().string();
    if (!entry.is_regular_file() || suffix.empty() || suffix == ".md" || suffix == ".txt") continue;
    try {
      EXPECT_GT(volume_of(read_tetrahedral_mesh(entry.path().string()).mesh), 0) << entry.path();
      ++read;
    } catch (const Error& error) {
      ADD_FAILURE() << error.what();
    }
  }
  EXPECT_GT(read, 40);
}

}  // namespace
}  // namespace pliant
