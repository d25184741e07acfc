// Meshes, tetrahedra and robots from bytes in memory, and frame writers of a World alone.
#include <gtest/gtest.h>

#include "pliant/body.h"
#include "pliant/error.h"
#include "pliant/parse.h"
#include "pliant/save.h"
#include "support/paths.h"
#include "write_support.h"

namespace pliant {
namespace {

std::string parse_error(const auto& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

bool has_words(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

const std::string square_obj = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 4 3 2 1\n";
const std::string two_tetrahedra =
    "Vertex 0 0 0 0\nVertex 1 1 0 0\nVertex 2 0 1 0\nVertex 3 0 0 1\nVertex 4 0 0 -2\nTet 0 0 1 2 3\nTet 1 0 1 2 4\n";

TEST(ParseBytes, GivesTheMeshOfTheFile) {
  const test::Folder folder;
  const TriangleMesh mesh = grid_mesh(4, 3, 1, 2);
  for (const std::string name : {"a.obj", "a.ply"}) {
    write_mesh(folder / name, mesh);
    const MeshFile file = parse_mesh(test::read(folder / name), name);
    EXPECT_EQ(file.mesh.positions, mesh.positions) << name;
    EXPECT_EQ(file.mesh.triangles, mesh.triangles) << name;
    EXPECT_TRUE(file.repairs.empty()) << name;
  }
  EXPECT_EQ(parse_mesh(square_obj, "square.OBJ").mesh.triangles.size(), 2u);
  EXPECT_TRUE(has_words(parse_error([] { parse_mesh("", "none.stl"); }), "none.stl: is empty"));
  EXPECT_TRUE(has_words(parse_error([] { parse_mesh(square_obj + "f 1 2 9\n", "from a database.obj"); }),
                        "from a database.obj:6:"));
}

TEST(ParseBytes, GivesTetrahedraByTheSuffixOfTheName) {
  const TetrahedralMesh mesh = parse_tetrahedral_mesh(two_tetrahedra, "two.t").mesh;
  EXPECT_EQ(mesh.positions.size(), 5u);
  EXPECT_EQ(mesh.tetrahedra.size(), 2u);
  EXPECT_TRUE(has_words(parse_error([] { parse_tetrahedral_mesh(two_tetrahedra, "two"); }),
                        "which no format of tetrahedra has"));
  EXPECT_TRUE(has_words(parse_error([] { parse_tetrahedral_mesh("", "two.msh"); }), "two.msh: is empty"));
  EXPECT_TRUE(has_words(parse_error([] { parse_tetrahedral_mesh("1", "two.node"); }), "parse_tetgen"));
}

TEST(ParseBytes, GivesTheTwoFilesOfTetgen) {
  const std::string nodes = "5 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 0 0 -2\n";
  const TetrahedralMesh mesh = parse_tetgen(nodes, "2 4 0\n1 1 2 3 4\n2 1 2 3 5\n").mesh;
  EXPECT_EQ(mesh.positions, parse_tetrahedral_mesh(two_tetrahedra, "two.t").mesh.positions);
  EXPECT_EQ(mesh.tetrahedra, parse_tetrahedral_mesh(two_tetrahedra, "two.t").mesh.tetrahedra);
  EXPECT_TRUE(has_words(parse_error([&] { parse_tetgen(nodes, "1 4 0\n1 1 2 3 9\n", "part"); }), "part.ele:2"));
}

TEST(ParseBytes, GivesTheRobotOfTheFile) {
  const std::string path = test::in_tree("scenes/bodies/arm.urdf");
  Scene from_file, from_text;
  from_file.add(read_urdf(path));
  from_text.add(parse_urdf(test::read(path)));
  EXPECT_EQ(fingerprint(from_text).scene, fingerprint(from_file).scene);
  EXPECT_TRUE(has_words(parse_error([] { parse_urdf("<robot name='r'>", "r.urdf"); }), "r.urdf:1"));
}

TEST(ParseBytes, ARobotTakesMeshesInMemory) {
  const std::string text =
      "<robot name='r'><link name='base'><inertial><mass value='1'/>"
      "<inertia ixx='1' iyy='1' izz='1'/></inertial><collision><geometry>"
      "<mesh filename='package://arm/tip.stl' scale='2 1 1'/></geometry></collision></link></robot>";
  UrdfOptions options;
  options.z_up = false;
  std::vector<std::string> warnings;
  EXPECT_TRUE(parse_urdf(text, "r.urdf", ".", options, &warnings).bodies.at(0).solids.empty());
  ASSERT_FALSE(warnings.empty());
  EXPECT_TRUE(has_words(warnings[0], "r.urdf:1: mesh 'package://arm/tip.stl'")) << warnings[0];
  options.meshes["package://arm/tip.stl"] =
      parse_mesh("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n", "tip.obj").mesh;
  options.allow_outside = false;
  warnings.clear();
  const Object robot = parse_urdf(text, "r.urdf", ".", options, &warnings);
  EXPECT_TRUE(warnings.empty()) << warnings[0];
  ASSERT_EQ(robot.bodies.at(0).solids.size(), 1u);
  const auto& hull = std::get<Hull>(robot.bodies[0].solids[0].shape);
  EXPECT_EQ(hull.points.size(), 4u);
  float widest = 0;
  for (const Vec3f& p : hull.points) widest = std::max(widest, p.x);
  EXPECT_EQ(widest, 2) << "the scale of the file";
}

TEST(FrameWriterOfAWorld, NeedsNoScene) {
  const test::Folder folder;
  Scene scene;
  scene.add_cloth(grid_mesh(4, 3, 1, 1));
  World world(scene, KeepDescription{});
  const auto write = [&](const std::string& name, std::unique_ptr<FrameWriter> writer) {
    writer->add(world);
    writer->finish();
    return test::read(folder / name);
  };
  const std::string with_scene = write("a.pc2", make_frame_writer(folder / "a.pc2", scene, world));
  EXPECT_EQ(write("b.pc2", make_frame_writer(folder / "b.pc2", world)), with_scene);
  world.remove(world.add(scene.objects[0]));
  world.add(scene.objects[0]);
  EXPECT_GT(write("c.pc2", make_frame_writer(folder / "c.pc2", world)).size(), with_scene.size());
  EXPECT_TRUE(has_words(parse_error([&] { make_frame_writer(folder / "d.pc2", World(scene)); }), "KeepDescription"));
}

}  // namespace
}  // namespace pliant
