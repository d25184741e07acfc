// One hash a sweep, whatever runs it: threads, lanes or plain floats, compiler, build type. One scene for all, small but for a
// cloth of two tiles, with whatever a sweep may meet: rigid and compliant lengths, bending, a volume, a rope, moving pins and
// contacts.
#include <gtest/gtest.h>

#include <algorithm>

#include "apps/validate/sweep_table.h"
#include "golden/golden.h"

namespace pliant::golden {

namespace {

using validate::sweep_ways;
using validate::SweepWay;

constexpr int frames = 4;

Object cloth() {
  constexpr int n = 70;  // 4900 particles: more than a tile holds
  ClothOptions options;
  options.name = "cloth";
  options.material = fabric("cotton");
  options.stretch = Stiffness::rigid();
  Object object = make_cloth(grid_mesh(n, n, 1, 1), options);
  object.pins = {{0, {}}, {n - 1, Motion{{Keyframe{0, {}, {}}, Keyframe{0.1f, {-0.05f, 0.02f, 0}, {}}}, {}, false}}};
  return object;
}

Object balloon() {
  ClothOptions options;
  options.name = "balloon";
  options.bending_model = ClothOptions::Bending::isometric;
  options.volume = Volume{1.2f, Stiffness::compliance(1e-7f)};
  TriangleMesh mesh = sphere_mesh(2);
  for (Vec3f& p : mesh.positions) p = {1.2f + 0.2f * p.x, 0.2f * p.y, 0.2f * p.z};
  return make_cloth(mesh, options);
}

Object rope() {
  std::vector<Vec3f> points;
  for (int i = 0; i < 18; ++i) points.push_back({-1.5f + 0.05f * static_cast<float>(i), 0, 0});
  RopeOptions options;
  options.stretch = Stiffness::compliance(1e-5f);
  options.bends = true;
  Object object = make_rope(points, options);
  object.pins = {{0, {}}};
  return object;
}

Scene scene_of(const SweepWay& way) {
  Scene scene;
  for (const Object& object : {cloth(), balloon(), rope()}) scene.add(object);
  Collider ball, floor;
  ball.shape = Sphere{0.2f};
  ball.position = {0, -0.206f, 0};
  floor.position = {0, -0.22f, 0};
  scene.add(ball);
  scene.add(floor);
  scene.settings.substeps = 2;
  scene.settings.iterations = 4;
  scene.settings.sweep = way.sweep;
  scene.settings.sweep_options = way.options;
  return scene;
}

std::string run_way(const SweepWay& way, int threads, const std::string& isa) {
  const Scene scene = scene_of(way);
  Settings settings = scene.settings;
  settings.threads = threads;
  settings.isa = isa;
  return run(scene, settings, frames);
}

class GoldenSweep : public testing::TestWithParam<SweepWay> {
 protected:
  void SetUp() override {
    const SweepWay& way = GetParam();
    golden_ = updating() ? run_way(way, 1, "sequential") : read_hashes()["sweep_" + way.name];
  }
  std::string golden_;
};

TEST_P(GoldenSweep, OnAnyNumberOfThreads) {
  for (const int threads : {1, 2, 3, 4, 8}) {
    for (int again = 0; again < repetitions(); ++again)
      EXPECT_EQ(run_way(GetParam(), threads, ""), golden_) << threads << " threads, run " << again;
  }
}

TEST_P(GoldenSweep, OnAnyInstructionSetAndInPlainCode) {
  int tried = 0;
  for (const char* isa : {"x86-64-v2", "x86-64-v3", "x86-64-v4", "generic", "sequential"}) {
    try {
      EXPECT_EQ(run_way(GetParam(), 2, isa), golden_) << isa;
      ++tried;
    } catch (const Error& error) {
      RecordProperty(isa, error.what());  // this machine does not have it
    }
  }
  EXPECT_GE(tried, 2);
}

TEST_P(GoldenSweep, MeetsContactsAndMoves) {
  const Scene scene = scene_of(GetParam());
  World world(scene);
  std::int64_t contacts = 0;
  for (int frame = 0; frame < frames; ++frame) contacts += world.step(scene.frame_time).contacts;
  EXPECT_GT(contacts, 0);
  EXPECT_GT(world.kinetic_energy(), 0);
}

INSTANTIATE_TEST_SUITE_P(Ways, GoldenSweep, testing::ValuesIn(sweep_ways()),
                         [](const auto& way) { return way.param.name; });

TEST(GoldenSweeps, AreAllThereAre) {
  for (const NamedSweep& sweep : sweeps()) {
    const auto is_it = [&](const SweepWay& way) { return way.sweep == sweep.sweep; };
    EXPECT_TRUE(std::any_of(sweep_ways().begin(), sweep_ways().end(), is_it)) << sweep.name << " is not in the table";
  }
}

TEST(GoldenSweeps, DifferWhereTheyShould) {
  std::map<std::string, std::string> hashes = read_hashes();
  EXPECT_EQ(hashes["sweep_tiled"], hashes["sweep_sequential"]);
  std::vector<std::string> others;
  for (const SweepWay& way : sweep_ways())
    if (way.sweep != Sweep::sequential) others.push_back(hashes["sweep_" + way.name]);
  std::sort(others.begin(), others.end());
  EXPECT_EQ(std::adjacent_find(others.begin(), others.end()), others.end()) << "two ways are one";
}

}  // namespace

std::map<std::string, std::string> sweep_hashes() {
  std::map<std::string, std::string> hashes;
  for (const SweepWay& way : sweep_ways()) hashes["sweep_" + way.name] = run_way(way, 1, "sequential");
  return hashes;
}

std::vector<std::string> sweep_names() {
  std::vector<std::string> names;
  for (const SweepWay& way : sweep_ways()) names.push_back("sweep_" + way.name);
  return names;
}

}  // namespace pliant::golden
