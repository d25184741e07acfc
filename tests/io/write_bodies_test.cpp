// Reads what every format has of rigid bodies, and compares with the poses that were written.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "glb_support.h"
#include "pliant/body.h"
#include "pliant/error.h"
#include "write_support.h"

namespace pliant {
namespace {

using nlohmann::json;
using test::Folder;
using test::Glb;
using test::value_at;

/// Two boxes and a ball that fall and spin, beside a rope.
Scene tumbling() {
  Scene scene;
  scene.add(make_rope({{0, 1, 0}, {0.1f, 1, 0}, {0.2f, 1, 0}}));
  Object heap;
  heap.name = "heap";
  BodyOptions options;
  options.position = {0, 2, 0};
  options.angular_velocity = {0, 30, 0};
  options.name = "a";
  add_body(heap, {{Box{{0.1f, 0.2f, 0.3f}}}}, options);
  options.position = {2, 2, 0};
  options.name = "b";
  add_body(heap, {{Box{{0.1f, 0.2f, 0.3f}}}}, options);
  options.name = "pole";
  options.position = {4, 2, 0};
  options.mass = std::numeric_limits<float>::infinity();
  add_body(heap, {{Sphere{0.5f}}}, options);
  scene.add(heap);
  scene.settings.substeps = 2;
  scene.settings.threads = 1;
  return scene;
}

/// Writes frames of the scene to a path, and returns the World at the end.
World written(const Scene& scene, const std::string& path, int frames) {
  World world(scene);
  const auto writer = make_frame_writer(path, scene, world);
  for (int frame = 0; frame < frames; ++frame) {
    if (frame > 0) {
      EXPECT_TRUE(world.step(scene.frame_time).ok());
    }
    writer->add(world);
  }
  writer->finish();
  return world;
}

float error_of(const Vec3f& a, const Vec3f& b) { return std::sqrt(length_squared(a - b)); }

/// v rotated by a unit quaternion, by its matrix.
Vec3f rotated(const Quatf& q, const Vec3f& v) {
  const Vec3f x{1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y - q.z * q.w), 2 * (q.x * q.z + q.y * q.w)};
  const Vec3f y{2 * (q.x * q.y + q.z * q.w), 1 - 2 * (q.x * q.x + q.z * q.z), 2 * (q.y * q.z - q.x * q.w)};
  const Vec3f z{2 * (q.x * q.z - q.y * q.w), 2 * (q.y * q.z + q.x * q.w), 1 - 2 * (q.x * q.x + q.y * q.y)};
  return {dot(x, v), dot(y, v), dot(z, v)};
}

/// All vertices of the heap's bodies, moved.
std::vector<Vec3f> moved(const Scene& scene, const World& world) {
  std::vector<Vec3f> result;
  const Object& heap = scene.objects[1];
  for (const ObjectBody& body : heap.bodies)
    for (const Vec3f& p : mesh_of(body.solids).positions)
      result.push_back(world.object(1).positions()[static_cast<std::size_t>(body.particle)] +
                       rotated(world.object(1).orientations()[static_cast<std::size_t>(body.frame)], p));
  return result;
}

TEST(WriteBodies, AsSurfacesThatMove) {
  const Folder folder;
  const Scene scene = tumbling();
  const World world = written(scene, folder / "run.obj", 4);
  const std::vector<Vec3f> expected = moved(scene, world);
  std::istringstream file(test::read(folder / "run_0003.obj"));
  std::vector<Vec3f> vertices;
  int faces = 0, objects = 0;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string kind;
    Vec3f v;
    words >> kind >> v.x >> v.y >> v.z;
    if (kind == "v") vertices.push_back(v);
    faces += kind == "f";
    objects += kind == "o";
  }
  EXPECT_EQ(objects, 2);
  ASSERT_EQ(vertices.size(), 3 + expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_LT(error_of(vertices[3 + i], expected[i]), 1e-6f) << i;
  EXPECT_LT(vertices[3].y, 2) << "nothing fell";
  std::size_t triangles = 0;
  for (const ObjectBody& body : scene.objects[1].bodies) triangles += mesh_of(body.solids).triangles.size();
  EXPECT_EQ(static_cast<std::size_t>(faces), triangles);
}

TEST(WriteBodies, AsSurfacesInEveryFormatWithoutBodies) {
  const Folder folder;
  const Scene scene = tumbling();
  const std::size_t vertices = moved(scene, World(scene)).size();
  static_cast<void>(written(scene, folder / "run.pc2", 2));
  EXPECT_EQ(value_at<int>(test::read(folder / "run.pc2"), 16), static_cast<int>(3 + vertices));
  static_cast<void>(written(scene, folder / "run.ply", 1));
  EXPECT_NE(test::read(folder / "run_0000.ply").find("element vertex " + std::to_string(3 + vertices)),
            std::string::npos);
  static_cast<void>(written(scene, folder / "run.pvd", 1));
  EXPECT_NE(test::read(folder / "run/heap_0000.vtp").find("NumberOfPoints=\"" + std::to_string(vertices) + '"'),
            std::string::npos);
}

TEST(WriteBodies, AsNodesOfGltfThatShareAMesh) {
  const Folder folder;
  const Scene scene = tumbling();
  const World world = written(scene, folder / "run.glb", 5);
  const Glb glb(folder / "run.glb");
  EXPECT_EQ(glb.document["meshes"].size(), 3U) << "the rope, a box and a ball";
  EXPECT_EQ(glb.node("a")["mesh"], glb.node("b")["mesh"]);
  EXPECT_NE(glb.node("a")["mesh"], glb.node("pole")["mesh"]);
  EXPECT_EQ(glb.node("heap")["children"].size(), 3U);
  EXPECT_EQ(glb.document["scenes"][0]["nodes"].size(), 2U);
  EXPECT_EQ(glb.node("b")["translation"][0], 2);
  // The mesh's vertices lie on the box; each triangle's normals are perpendicular to it.
  const json& primitive = glb.document["meshes"][glb.node("a")["mesh"].get<std::size_t>()]["primitives"][0];
  EXPECT_EQ(glb.document["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()]["count"], 24)
      << "three vertices at each corner";
  EXPECT_EQ(glb.document["accessors"][primitive["indices"].get<std::size_t>()]["count"], 36);
  for (std::size_t i = 0; i < 24; ++i) {
    const auto p = glb.element<Vec3f>(primitive["attributes"]["POSITION"], i);
    const auto n = glb.element<Vec3f>(primitive["attributes"]["NORMAL"], i);
    EXPECT_NEAR(p.x * n.x / 0.1f + p.y * n.y / 0.2f + p.z * n.z / 0.3f, 1, 1e-5) << "a face's normal points outward";
  }
}

TEST(WriteBodies, AsAnimatedTransformsOfGltf) {
  const Folder folder;
  const Scene scene = tumbling();
  const World world = written(scene, folder / "run.glb", 5);
  const Glb glb(folder / "run.glb");
  const json& animation = glb.document["animations"][0];
  int found = 0;
  for (const json& channel : animation["channels"]) {
    const json& target = channel["target"];
    if (target["path"] == "weights") continue;
    ++found;
    const std::string name = glb.document["nodes"][target["node"].get<std::size_t>()]["name"];
    ASSERT_TRUE(name == "a" || name == "b") << name << ": what is fixed has no channel";
    const std::size_t body = name == "a" ? 0 : 1;
    const int output = animation["samplers"][channel["sampler"].get<std::size_t>()]["output"];
    if (target["path"] == "translation") {
      EXPECT_EQ(glb.element<Vec3f>(output, 4), world.object(1).positions()[body]);
    } else {
      const auto q = glb.element<Quatf>(output, 4), last = world.object(1).orientations()[body];
      EXPECT_NEAR(std::fabs(q.x * last.x + q.y * last.y + q.z * last.z + q.w * last.w), 1, 1e-6);
      for (std::size_t k = 1; k < 5; ++k) {
        const auto here = glb.element<Quatf>(output, k), before = glb.element<Quatf>(output, k - 1);
        EXPECT_GT(here.x * before.x + here.y * before.y + here.z * before.z + here.w * before.w, 0.9f) << k;
      }
    }
  }
  EXPECT_EQ(found, 4);
}

TEST(WriteBodies, AsSmallFilesOfGltf) {
  const Folder folder;
  Scene scene = tumbling();
  scene.objects.erase(scene.objects.begin());
  static_cast<void>(written(scene, folder / "short.glb", 1));
  static_cast<void>(written(scene, folder / "long.glb", 101));
  const std::size_t frames = test::read(folder / "long.glb").size() - test::read(folder / "short.glb").size();
  EXPECT_LT(frames, 101 * (2 * 28 + 4) + 2000U) << "a frame of a body is a translation and a rotation";
}

TEST(WriteBodies, AsPrimsOfUsdThatInheritAMesh) {
  const Folder folder;
  const Scene scene = tumbling();
  const World world = written(scene, folder / "run.usda", 3);
  const std::string text = test::read(folder / "run.usda");
  const auto count = [&](const std::string& what) {
    std::size_t found = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++found;
    return found;
  };
  EXPECT_EQ(count("class Mesh \""), 2U);
  EXPECT_EQ(count("inherits = </World/heap/solid>"), 2U);
  EXPECT_EQ(count("inherits = </World/heap/solid_2>"), 1U);
  EXPECT_EQ(count("xformOp:translate.timeSamples"), 2U) << "a and b";
  EXPECT_EQ(count("double3 xformOp:translate = (4, 2, 0)"), 1U) << "the pole";
  const std::size_t b = text.find("def Mesh \"b\""), sample = text.find("2: (", text.find("translate.timeSamples", b));
  std::istringstream numbers(text.substr(sample + 4));
  Vec3f p;
  char comma = 0;
  numbers >> p.x >> comma >> p.y >> comma >> p.z;
  EXPECT_EQ(p, world.object(1).positions()[1]);
  const std::size_t turn = text.find("2: (", text.find("orient.timeSamples", b));
  std::istringstream real(text.substr(turn + 4));
  float w = 0;
  real >> w;
  EXPECT_NEAR(std::fabs(w), std::fabs(world.object(1).orientations()[1].w), 1e-6) << "the real part comes first";
}

TEST(WriteBodies, RefusesFramesThatDoNotFit) {
  const Folder folder;
  const Scene scene = tumbling();
  const World world(scene);
  const output::Objects objects = output::describe(scene);
  for (const std::string suffix : {"obj", "glb", "usda", "pvd"}) {
    const auto writer = output::make_format_writer(folder / ("run." + suffix), objects, 1. / 60);
    output::Frame frame{0, {world.object(0).positions(), world.object(1).positions()}, {}, 0};
    EXPECT_THROW(writer->add(frame), Error) << suffix << ": no bodies";
    frame.bodies = {{}, output::body_motions(scene.objects[1], world.object(1))};
    frame.bodies[1][1].pose.rotation.x = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(writer->add(frame), Error) << suffix << ": not finite";
    frame.bodies[1][1].pose.rotation.x = 0;
    EXPECT_NO_THROW(writer->add(frame)) << suffix;
    writer->finish();
  }
}

}  // namespace
}  // namespace pliant
