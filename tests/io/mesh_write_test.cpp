// Tests write_mesh: what is written reads back with the same bits; if writing fails, the old file stays unchanged.
#include <random>

#include "mesh_support.h"
#include "write_support.h"

namespace pliant::test {
namespace {

/// Floats of every size, of both signs, and at the ends of the range.
TriangleMesh varied_mesh() {
  std::mt19937 random(3);
  TriangleMesh mesh;
  for (int i = 0; i < 3000; ++i) {
    float p[3];
    for (float& value : p) {
      do {
        const auto bits = static_cast<std::uint32_t>(random());
        std::memcpy(&value, &bits, sizeof value);
      } while (!std::isfinite(value));
    }
    mesh.positions.push_back({p[0], p[1], p[2]});
  }
  mesh.positions[0] = {0, -0.0f, 1e-45f};
  mesh.positions[1] = {3.4028235e38f, -3.4028235e38f, 0.1f};
  for (int i = 0; i + 2 < 3000; ++i) mesh.triangles.push_back({i, i + 1, i + 2});
  return mesh;
}

TEST(MeshWrite, ReadsBackToTheSameBits) {
  const Folder folder;
  const TriangleMesh mesh = varied_mesh();
  for (const char* name : {"mesh.obj", "mesh.ply", "MESH.PLY"}) {
    const std::string path = folder / name;
    write_mesh(path, mesh);
    const TriangleMesh again = read_mesh_file(path, as_it_is).mesh;
    ASSERT_EQ(again.positions.size(), mesh.positions.size());
    EXPECT_EQ(std::memcmp(again.positions.data(), mesh.positions.data(), mesh.positions.size() * sizeof(Vec3f)), 0)
        << name;
    EXPECT_EQ(again.triangles, mesh.triangles);
  }
}

TEST(MeshWrite, RefusesWhatNobodyCouldReadAndKeepsTheOldFile) {
  const Folder folder;
  const std::string path = folder / "mesh.obj";
  put(path, "old");
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  const auto error_of_writing = [&](const std::string& to) -> std::string {
    try {
      write_mesh(to, mesh);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  mesh.triangles[0][2] = 3;
  EXPECT_TRUE(contains(error_of_writing(path), path + ": triangle 0: uses vertex 3 but there are 3"));
  mesh.triangles[0][2] = -1;
  EXPECT_TRUE(contains(error_of_writing(path), "uses vertex -1"));
  mesh.triangles[0][2] = 2;
  mesh.positions[1].y = NAN;
  EXPECT_TRUE(contains(error_of_writing(path), path + ": vertex 1: is not finite"));
  mesh.positions[1].y = 0;
  EXPECT_TRUE(contains(error_of_writing(folder / "mesh.stl"), "name it .obj or .ply"));
  EXPECT_TRUE(contains(error_of_writing(folder / "obj"), "name it .obj or .ply"));
  EXPECT_TRUE(contains(error_of_writing(folder / "none/mesh.obj"), folder / "none/mesh.obj"));
  EXPECT_EQ(read(path), "old");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"mesh.obj"}) << "nothing is left behind";
  EXPECT_EQ(error_of_writing(path), "");
  EXPECT_EQ(read(path), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
}

}  // namespace
}  // namespace pliant::test
