// Tests cached distance grids: equal to measured ones, never those of another mesh, never damaged.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "pliant/error.h"
#include "pliant/io.h"
#include "write_support.h"

namespace pliant {
namespace {

using test::Folder;

bool same(const DistanceField& a, const DistanceField& b) {
  return a.low.x == b.low.x && a.low.y == b.low.y && a.low.z == b.low.z && a.spacing == b.spacing &&
         a.nodes == b.nodes && a.distances == b.distances;
}

std::string only_file(const Folder& folder) { return folder / folder.names().at(0); }

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_bytes(const std::string& path, const std::string& bytes) { std::ofstream(path, std::ios::binary) << bytes; }

TEST(DistanceCache, GivesWhatWasMeasured) {
  const Folder folder;
  const TriangleMesh mesh = sphere_mesh(1);
  const std::string inner = folder / "made/on/the/way";
  const auto measured = measure_distances(mesh, 0.2f), first = cached_distances(mesh, 0.2f, inner),
             again = cached_distances(mesh, 0.2f, inner);
  EXPECT_TRUE(same(*measured, *first));
  EXPECT_TRUE(same(*measured, *again));
  EXPECT_NE(first, again) << "read, not remembered";
}

TEST(DistanceCache, TakesWhatIsThere) {
  const Folder folder;
  const TriangleMesh mesh = sphere_mesh(1);
  cached_distances(mesh, 0.3f, folder.path());
  const auto before = std::filesystem::last_write_time(only_file(folder));
  cached_distances(mesh, 0.3f, folder.path());
  EXPECT_EQ(std::filesystem::last_write_time(only_file(folder)), before) << "not made again";
  EXPECT_EQ(folder.names().size(), 1u);
}

TEST(DistanceCache, TellsMeshesAndSpacingsApart) {
  const Folder folder;
  TriangleMesh mesh = sphere_mesh(1);
  cached_distances(mesh, 0.3f, folder.path());
  cached_distances(mesh, 0.31f, folder.path());
  mesh.positions[5].y += 1e-3f;
  EXPECT_TRUE(same(*cached_distances(mesh, 0.3f, folder.path()), *measure_distances(mesh, 0.3f)));
  std::swap(mesh.triangles[0], mesh.triangles[1]);
  cached_distances(mesh, 0.3f, folder.path());
  EXPECT_EQ(folder.names().size(), 4u);
}

TEST(DistanceCache, MakesAnewWhatIsDamaged) {
  const Folder folder;
  const TriangleMesh mesh = sphere_mesh(1);
  const auto measured = cached_distances(mesh, 0.4f, folder.path());
  const std::string path = only_file(folder), whole = bytes_of(path);
  ASSERT_GT(whole.size(), 500u);
  std::vector<std::string> damaged{"", "pliant distances 1\n", whole.substr(0, whole.size() - 1), whole + "x"};
  for (std::size_t at = 0; at < whole.size(); at += 1 + whole.size() / 31) {
    damaged.push_back(whole);
    damaged.back()[at] = static_cast<char>(damaged.back()[at] ^ 4);
    damaged.push_back(whole.substr(0, at));
  }
  for (const std::string& bytes : damaged) {
    write_bytes(path, bytes);
    EXPECT_TRUE(same(*cached_distances(mesh, 0.4f, folder.path()), *measured));
    EXPECT_EQ(bytes_of(path), whole) << "mended on the disk too";
  }
}

TEST(DistanceCache, NamesAFolderThatIsNone) {
  const Folder folder;
  write_bytes(folder / "file", "x");
  try {
    cached_distances(sphere_mesh(1), 0.4f, folder / "file");
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("file"), std::string::npos) << error.what();
  }
}

TEST(DistanceCache, ServesTheGridsOfAScene) {
  const Folder folder;
  Scene scene;
  for (const auto as : {MeshCollider::As::distance_grid, MeshCollider::As::triangles}) {
    MeshCollider collider;
    collider.name = as == MeshCollider::As::triangles ? "plain" : "grid";
    collider.mesh = sphere_mesh(1);
    collider.as = as;
    collider.grid_spacing = 0.25f;
    scene.add(collider);
  }
  use_cached_distances(scene, folder.path());
  ASSERT_TRUE(scene.mesh_colliders[0].field);
  EXPECT_TRUE(same(*scene.mesh_colliders[0].field, *measure_distances(sphere_mesh(1), 0.25f)));
  EXPECT_FALSE(scene.mesh_colliders[1].field);
  EXPECT_EQ(folder.names().size(), 1u);
}

}  // namespace
}  // namespace pliant
