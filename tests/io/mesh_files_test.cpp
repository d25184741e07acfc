// Reads a collection of meshes of public projects, valid and invalid: each must have the counts in its manifest, or be
// rejected for the reason in the table below. A file that is not in the table must be readable.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#include "mesh_support.h"
#include "support/paths.h"

namespace pliant::test {
namespace {

namespace fs = std::filesystem;

/// For each file that must be rejected, by its path in the collection: a part of the error message.
const std::map<std::string, std::string> refused_files = {
    {"nasty_mesh/assimp/Cube.off", "is an OFF file"},
    {"nasty_mesh/assimp/box_UTF16BE.obj", "is text in UTF-16"},
    {"nasty_mesh/assimp/formatDetection", "is an OFF file"},
    {"nasty_mesh/assimp/issue623.ply", "has 24 vertices but no faces"},
    {"nasty_mesh/assimp/number_formats.obj", ":11: value 3 of vertex 8, '3.1+e2', is not a number"},
    {"nasty_mesh/assimp/point_cloud.obj", "has 3 vertices but no faces"},
    {"nasty_mesh/assimp/points.ply", "has 4 vertices but no faces"},
    {"nasty_mesh/assimp/testline.obj", "has 8 vertices but no faces (ignored 6 lines, the first on line 15)"},
    {"nasty_mesh/assimp/testpoints.obj", "has 8 vertices but no faces (ignored 6 points, the first on line 15)"},
    {"nasty_mesh/meshio-lfs-pointers/rbc_001.vtk", "is a pointer of Git LFS"},
    {"nasty_mesh/meshio-lfs-pointers/tet.ply", "is a pointer of Git LFS"},
    {"nasty_mesh/mujoco/line.obj", "has 4 vertices but no faces (ignored 2 lines"},
    {"nasty_mesh/tinyobj/invalid-face-definition.obj", ":15: a face has 1 corner"},
    {"nasty_mesh/tinyobj/invalid-relative-texture-index.obj", ":2: vertex index 1 but there are 0 vertices"},
    {"nasty_mesh/tinyobj/invalid-relative-vertex-index.obj", ":1: vertex index -4 but there are 0 vertices"},
    {"nasty_mesh/tinyobj/issue-140-zero-face-idx.obj", ":16: vertex index 0"},
    {"nasty_mesh/tinyobj/issue-356-leading-spaces-newmtl.obj", "has no vertices and no faces"},
    {"nasty_mesh/tinyobj/line-prim.obj", "has 8 vertices but no faces"},
    {"nasty_mesh/tinyobj/points-prim.obj", "has 8 vertices but no faces"},
    {"nasty_mesh/tinyobj/test-nan.obj", ":12: value 1 of vertex 1, 'nan', is not finite"},
    {"nasty_mesh/trimesh/ascii.stl.zip", "is a zip archive"},
    {"nasty_mesh/trimesh/comments.off", "is an OFF file"},
    {"nasty_mesh/trimesh/empty.obj", "has no vertices and no faces"},
    {"nasty_mesh/trimesh/empty.ply", ":11: has 0 vertices but no faces"},
    {"nasty_mesh/trimesh/empty.stl", "has no triangles"},
    {"nasty_mesh/trimesh/face_in_group_name.obj", "has 1 vertex but no faces"},
    {"nasty_mesh/trimesh/obj_empty.obj", "has no vertices and no faces"},
    {"nasty_mesh/trimesh/obj_points.obj", "has 8 vertices but no faces"},
    {"nasty_mesh/trimesh/obj_wireframe.obj", "has 8 vertices but no faces (ignored 12 lines"},
    {"nasty_mesh/trimesh/ply_empty_ascii.ply", ":11: has 0 vertices but no faces"},
    {"nasty_mesh/trimesh/ply_empty_bin.ply", ":11: has 0 vertices but no faces"},
    {"nasty_mesh/trimesh/ply_empty_header.ply", "declares no element 'vertex'"},
    {"nasty_mesh/trimesh/ply_points_ascii.ply", ":8: has 8 vertices but no faces"},
    {"nasty_mesh/trimesh/ply_points_bin.ply", ":11: has 8 vertices but no faces"},
    {"nasty_mesh/trimesh/stl_empty_ascii.stl", "has no triangles"},
    {"nasty_mesh/trimesh/stl_empty_bin.stl", "has no triangles"},
    {"nasty_mesh/trimesh/whitespace.off", "has an unknown mesh format"},
    {"nasty_mesh/warp-lfs-pointers/bunny.usd", "is a pointer of Git LFS"},
};

/// True for files with the suffixes of other readers.
bool is_of_another_kind(const fs::path& path) {
  const std::set<std::string> others = {".msh", ".md", ".usd", ".seg"};
  return others.count(path.extension()) > 0 && path.string().find("lfs-pointers") == std::string::npos;
}

std::vector<std::string> all_files() {
  std::vector<std::string> files;
  for (const char* folder : {"nasty_mesh", "surface", "cloth"}) {
    if (!fs::exists(test::in_shared_data(folder))) continue;
    for (const auto& entry : fs::recursive_directory_iterator(test::in_shared_data(folder)))
      if (entry.is_regular_file() && !is_of_another_kind(entry.path()))
        files.push_back(fs::relative(entry.path(), test::in_shared_data("")).string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

struct Row {
  std::optional<long> vertices, triangles, boundary_edges, crossings;
};

/// The counts in the manifest, which another program made from the raw files.
std::map<std::string, Row> manifest() {
  std::map<std::string, Row> rows;
  std::ifstream in(test::in_shared_data("MANIFEST.tsv"));
  for (std::string line; std::getline(in, line);) {
    std::vector<std::string> fields;
    std::stringstream cut(line);
    for (std::string field; std::getline(cut, field, '\t');) fields.push_back(field);
    fields.resize(21);
    const auto number = [&](std::size_t i) {
      return fields[i].empty() ? std::optional<long>() : std::optional<long>(std::atol(fields[i].c_str()));
    };
    if (fields[0] != "file") rows[fields[0]] = {number(7), number(8), number(11), number(18)};
  }
  return rows;
}

TEST(MeshFiles, EachIsReadAsTheManifestCountsItOrRefusedForItsReason) {
  const std::vector<std::string> files = all_files();
  if (files.empty()) GTEST_SKIP() << "the collection is not here: " << test::in_shared_data("");
  const std::map<std::string, Row> rows = manifest();
  for (const std::string& name : files) {
    SCOPED_TRACE(name);
    const auto reason = refused_files.find(name);
    try {
      const MeshFile raw = read_mesh_file(test::in_shared_data(name), as_it_is),
                     mended = read_mesh_file(test::in_shared_data(name));
      EXPECT_EQ(reason, refused_files.end()) << "was read though it should be refused";
      expect_sound(mended.mesh);
      const Row& row = rows.at(name);
      const bool is_stl = name.find(".stl") != std::string::npos;  // the manifest counts its vertices after merging
      if (row.vertices) {
        EXPECT_EQ((is_stl ? mended : raw).mesh.positions.size(), static_cast<std::size_t>(*row.vertices));
      }
      // The manifest's program divides its only polygon, which goes round several times, into 938 triangles.
      if (row.triangles && name != "nasty_mesh/assimp/box_longline.obj") {
        EXPECT_EQ(raw.mesh.triangles.size(), static_cast<std::size_t>(*row.triangles));
      }
    } catch (const Error& error) {
      if (reason == refused_files.end())
        ADD_FAILURE() << error.what();
      else
        EXPECT_TRUE(contains(error.what(), reason->second));
      EXPECT_TRUE(contains(error.what(), test::in_shared_data(name)));
    }
  }
}

TEST(MeshFiles, TableNamesNoFileThatIsGone) {
  const std::vector<std::string> files = all_files();
  if (files.empty()) GTEST_SKIP() << "the collection is not here: " << test::in_shared_data("");
  for (const auto& [name, reason] : refused_files)
    EXPECT_TRUE(std::binary_search(files.begin(), files.end(), name)) << name;
}

TEST(MeshFiles, ClothAndSurfacesHaveNothingGrave) {
  for (const std::string& name : all_files()) {
    if (name.find("nasty") == 0) continue;
    SCOPED_TRACE(name);
    for (const Finding& finding : inspect(read_mesh(test::in_shared_data(name))))
      EXPECT_FALSE(finding.grave) << finding.message;
  }
}

/// The pairs depend on how polygons are divided, so these files have triangles only.
TEST(MeshFiles, SelfIntersectionsAreThoseOfTheManifest) {
  const std::map<std::string, std::string> expected = {
      {"surface/odedstein/wingnut/wingnut.obj", "in 2 places"},
      {"nasty_mesh/trimesh/soup.stl", "in 2496 places"},
      {"surface/odedstein/penguin/penguin.obj", ""},
      {"surface/pbd/bunny_10k.obj", ""},
  };
  for (const auto& [name, places] : expected) {
    if (!fs::exists(test::in_shared_data(name)))
      GTEST_SKIP() << "the collection is not here: " << test::in_shared_data("");
    std::string found;
    for (const Finding& finding : inspect(read_mesh(test::in_shared_data(name))))
      if (finding.message.find("passes through itself") == 0) found = finding.message;
    EXPECT_EQ(found.empty(), places.empty()) << name << ": " << found;
    EXPECT_TRUE(contains(found, places)) << name;
  }
}

/// A closed surface that is stored as loose triangles, or with open seams, must be closed after reading.
TEST(MeshFiles, SeamsCloseOnReading) {
  for (const char* name : {"nasty_mesh/assimp/cube_uv.ply", "nasty_mesh/mujoco/duplicate_vertices.stl",
                           "nasty_mesh/geometry-central/stl_box_binary.stl", "surface/mujoco/cube_cup.obj",
                           "nasty_mesh/mujoco/duplicate.obj"}) {
    if (!fs::exists(test::in_shared_data(name)))
      GTEST_SKIP() << "the collection is not here: " << test::in_shared_data("");
    for (const Finding& finding : inspect(read_mesh(test::in_shared_data(name))))
      EXPECT_FALSE(contains(finding.message, "border")) << name;
  }
}

}  // namespace
}  // namespace pliant::test
