// Tests that liquids are written as points, and as surfaces that are another mesh in each frame.
#include <gtest/gtest.h>

#include "pliant/body.h"
#include "pliant/error.h"
#include "pliant/io.h"
#include "pliant/liquid.h"
#include "pliant/surface.h"
#include "write_support.h"

namespace pliant {
namespace {

using test::occurrences;

constexpr float spacing = 0.05f;

/// Two drops that part, so that their surface changes, beside a cube that is an object of bodies.
Scene drops() {
  Scene scene;
  scene.gravity = {};
  scene.settings.threads = 1;
  std::vector<Vec3f> places = fill_box({0, 0, 0}, {0.2f, 0.2f, 0.2f}, spacing);
  const std::size_t half = places.size() / 2;
  Object water = make_liquid(places, {.name = "water", .fluid = {.spacing = spacing}});
  water.velocities.assign(places.size(), {0, -2, 0});
  for (std::size_t i = half; i < places.size(); ++i) water.velocities[i] = {0, 2, 0};
  scene.add(water);
  Solid cube;
  cube.shape = Box{{0.1f, 0.1f, 0.1f}};
  BodyOptions options;
  options.position = {2, 0, 0};
  scene.add(make_body({cube}, options));
  return scene;
}

/// The surfaces of the first frames, and these frames written to `path`.
std::vector<TriangleMesh> write_surfaces(const std::string& path, const Scene& scene, int frames) {
  World world(scene);
  FrameWriterOptions options;
  options.liquid_surfaces = true;
  const auto writer = make_frame_writer(path, scene, world, options);
  std::vector<TriangleMesh> surfaces;
  for (int frame = 0; frame < frames; ++frame) {
    if (frame > 0) world.step(scene.frame_time);
    writer->add(world);
    surfaces.push_back(liquid_surface(world.object(0).positions(), {.spacing = spacing, .threads = 1}));
  }
  writer->finish();
  return surfaces;
}

/// The lines between `attribute` and the next brace.
std::string samples(const std::string& text, const std::string& attribute) {
  const std::size_t begin = text.find(attribute + ".timeSamples = {");
  return begin == std::string::npos ? "" : text.substr(begin, text.find('}', begin) - begin);
}

TEST(WriteLiquid, SurfacesReadBackInEachFrame) {
  Scene scene = drops();
  scene.objects.pop_back();
  for (const std::string suffix : {"obj", "ply"}) {
    const test::Folder folder;
    const std::vector<TriangleMesh> surfaces = write_surfaces(folder / ("run." + suffix), scene, 3);
    EXPECT_NE(surfaces[0].positions.size(), surfaces[2].positions.size()) << "the mesh does not change";
    MeshReadOptions as_it_is;
    as_it_is.merge_duplicates = as_it_is.drop_degenerate = as_it_is.drop_isolated = false;
    for (std::size_t frame = 0; frame < 3; ++frame) {
      const TriangleMesh read =
          read_mesh_file(folder / ("run_000" + std::to_string(frame) + "." + suffix), as_it_is).mesh;
      EXPECT_EQ(read.positions, surfaces[frame].positions) << suffix << ", frame " << frame;
      EXPECT_EQ(read.triangles, surfaces[frame].triangles) << suffix << ", frame " << frame;
    }
  }
}

TEST(WriteLiquid, SurfacesBesideBodies) {
  const test::Folder folder;
  const std::vector<TriangleMesh> surfaces = write_surfaces(folder / "run.ply", drops(), 2);
  const TriangleMesh read = read_mesh(folder / "run_0001.ply");
  EXPECT_GT(read.triangles.size(), surfaces[1].triangles.size()) << "the cube is not there";
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(read.positions[i], surfaces[1].positions[i]);
}

TEST(WriteLiquid, SurfacesAsPolygonsOfParaView) {
  const test::Folder folder;
  const std::vector<TriangleMesh> surfaces = write_surfaces(folder / "run.pvd", drops(), 2);
  for (std::size_t frame = 0; frame < 2; ++frame) {
    const std::string text = test::read(folder / ("run/water_000" + std::to_string(frame) + ".vtp"));
    EXPECT_EQ(occurrences(text, "NumberOfPoints=\"" + std::to_string(surfaces[frame].positions.size()) + "\""), 1);
    EXPECT_EQ(occurrences(text, "NumberOfPolys=\"" + std::to_string(surfaces[frame].triangles.size()) + "\""), 1);
    EXPECT_EQ(occurrences(text, "NumberOfVerts=\"0\""), 1);
    EXPECT_EQ(text.find("velocity"), std::string::npos) << "vertices of a surface have none";
  }
}

TEST(WriteLiquid, SurfacesAsMeshOfUsdWithSamplesOfItsTriangles) {
  const test::Folder folder;
  const std::vector<TriangleMesh> surfaces = write_surfaces(folder / "run.usda", drops(), 2);
  const std::string text = test::read(folder / "run.usda");
  const std::size_t prim = text.find("def Mesh \"water\"");
  ASSERT_NE(prim, std::string::npos) << text.substr(0, 400);
  const std::string water = text.substr(prim, text.find("\n    }\n", prim) - prim);
  const int triangles = static_cast<int>(surfaces[0].triangles.size() + surfaces[1].triangles.size());
  const int vertices = static_cast<int>(surfaces[0].positions.size() + surfaces[1].positions.size());
  EXPECT_EQ(
      occurrences(samples(water, "faceVertexCounts"), "3, ") + occurrences(samples(water, "faceVertexCounts"), "3]"),
      triangles);
  // One comma after each number, and one after each sample, less those at the end of a list.
  EXPECT_EQ(occurrences(samples(water, "faceVertexIndices"), ","), 3 * triangles);
  EXPECT_EQ(occurrences(samples(water, "points"), "("), vertices);
  EXPECT_EQ(occurrences(samples(water, "extent"), "("), 4);
}

TEST(WriteLiquid, SurfacesAreRefusedWhereAMeshMustNotChange) {
  const test::Folder folder;
  for (const std::string suffix : {"glb", "pc2"}) {
    try {
      write_surfaces(folder / ("run." + suffix), drops(), 1);
      FAIL() << suffix;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("is the surface of a liquid"), std::string::npos) << error.what();
    }
  }
  EXPECT_TRUE(folder.names().empty());
}

TEST(WriteLiquid, ParticlesAsPoints) {
  const test::Folder folder;
  const Scene scene = drops();
  World world(scene);
  const std::size_t count = world.object(0).positions().size();
  for (const std::string suffix : {"ply", "pvd", "usda"}) {
    const auto writer = make_frame_writer(folder / ("run." + suffix), scene, world);
    writer->add(world);
    writer->finish();
  }
  const std::string ply = test::read(folder / "run_0000.ply"), vtp = test::read(folder / "run/water_0000.vtp");
  const std::string usda = test::read(folder / "run.usda");
  const std::size_t first = ply.find("end_header\n") + 11, stride = 3 * 4 + 3 + 4;  // position, colour, object
  const std::vector<Vec3f> places = world.object(0).positions();
  for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(test::value_at<Vec3f>(ply, first + i * stride), places[i]);
  EXPECT_EQ(occurrences(vtp, "NumberOfVerts=\"" + std::to_string(count) + "\""), 1);
  const std::size_t prim = usda.find("def Points \"water\"");
  ASSERT_NE(prim, std::string::npos);
  EXPECT_EQ(occurrences(samples(usda.substr(prim), "points"), "("), static_cast<int>(count));
}

}  // namespace
}  // namespace pliant
