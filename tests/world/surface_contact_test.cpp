// Tests contact between surfaces in a World: cloth with itself, with other cloth and with meshes. Exact signs check in
// every frame that nothing crosses that must not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/kernels.h"
#include "world/surface_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// A sheet folded over itself in a half circle, dropped on a floor.
Scene folded_cloth() {
  TriangleMesh mesh = sheet(24, 0.5f, 0);
  constexpr float radius = 0.03f, flat = 0.25f - float_pi / 2 * radius;
  for (Vec3f& p : mesh.positions) {
    const float along = p.x + 0.25f, angle = std::clamp((along - flat) / radius, 0.f, float_pi);
    const float back = std::max(0.f, along - flat - float_pi * radius);
    p.x = std::min(along, flat) + radius * std::sin(angle) - back;
    p.y = 0.1f + radius * (1 - std::cos(angle));
  }
  Scene scene = scene_of(10);
  scene.add(cloth(mesh));
  scene.add(floor_at(0));
  return scene;
}

Scene layers() {
  Scene scene = scene_of(10);
  for (int i = 0; i < 4; ++i) scene.add(cloth(sheet(14, 0.4f, 0.32f + 0.01f * static_cast<float>(i))));
  Collider ball;
  ball.shape = Sphere{0.15f};
  ball.position = {0.01f, 0.15f, 0.02f};
  scene.add(ball);
  scene.add(floor_at(0));
  return scene;
}

/// A sheet whose ends rotate against each other, two turns in a second and a half.
Scene twisted_cloth() {
  Scene scene = scene_of(10);
  const TriangleMesh mesh = sheet(20, 0.4f, 0);
  const int object = scene.add(cloth(mesh, 0.001f));
  std::vector<int> ends[2];
  for (int i = 0; i < static_cast<int>(mesh.positions.size()); ++i) {
    if (mesh.positions[static_cast<std::size_t>(i)].x < -0.199f) ends[0].push_back(i);
    if (mesh.positions[static_cast<std::size_t>(i)].x > 0.199f) ends[1].push_back(i);
  }
  for (int end = 0; end < 2; ++end) {
    Motion motion;
    for (int k = 0; k <= 16; ++k)
      motion.keyframes.push_back(
          {static_cast<float>(k) * 0.1f, {}, rotation({1, 0, 0}, static_cast<float>(end == 0 ? 22 * k : -22 * k))});
    scene.pin(object, ends[end], motion);
  }
  return scene;
}

/// A sheet that falls on a ball of triangles.
Scene cloth_on_a_mesh() {
  Scene scene = scene_of(10);
  scene.add(cloth(sheet(20, 0.5f, 0.35f)));
  MeshCollider ball;
  ball.mesh = sphere_mesh(2);
  for (Vec3f& p : ball.mesh.positions) p = p * 0.15f + Vec3f{0.01f, 0.15f, 0.02f};
  scene.add(ball);
  scene.add(floor_at(0));
  return scene;
}

struct NamedScene {
  const char* name;
  Scene (*make)();
  int frames;
};
void PrintTo(const NamedScene& named, std::ostream* out) { *out << named.name; }

class Surfaces : public testing::TestWithParam<NamedScene> {};
INSTANTIATE_TEST_SUITE_P(Scenes, Surfaces,
                         testing::Values(NamedScene{"folded", folded_cloth, 50}, NamedScene{"layers", layers, 50},
                                         NamedScene{"twisted", twisted_cloth, 96},
                                         NamedScene{"on_a_mesh", cloth_on_a_mesh, 60}),
                         [](const auto& named) { return named.param.name; });

TEST_P(Surfaces, CrossNothing) {
  const Scene scene = GetParam().make();
  World world(scene);
  Watch watch(world, scene);
  std::int64_t contacts = 0;
  for (int frame = 0; frame < GetParam().frames; ++frame) {
    const Report report = world.step(dt);
    ASSERT_TRUE(report.ok()) << report.explain();
    ASSERT_EQ(report.pairs.unresolvable, 0) << "frame " << frame;
    ASSERT_EQ(watch.crossings(world), 0u) << "frame " << frame;
    contacts = std::max(contacts, report.pairs.contacts);
  }
  EXPECT_GT(contacts, 20);
}

TEST_P(Surfaces, GiveTheSameBitsOnAnyThreadsAndLanes) {
  const Scene scene = GetParam().make();
  const int frames = 18;
  const auto run = [&](int threads, const std::string& isa) {
    Settings settings = scene.settings;
    settings.threads = threads;
    settings.isa = isa;
    World world(scene, settings);
    for (int frame = 0; frame < frames; ++frame) world.step(dt);
    return world.state_hash();
  };
  const std::string expected = run(1, "");
  for (const int threads : {2, 3, 4}) EXPECT_EQ(run(threads, ""), expected) << threads << " threads";
  for (const std::string& isa : available_isas()) EXPECT_EQ(run(1, isa), expected) << isa;
  EXPECT_EQ(run(2, "sequential"), expected);
}

TEST_P(Surfaces, GoOnInTheSameBitsFromAState) {
  const Scene scene = GetParam().make();
  World world(scene);
  std::vector<State> states{world.state()};
  for (int frame = 0; frame < 40; ++frame) {
    world.step(dt);
    states.push_back(world.state());
  }
  World another(scene);
  for (const std::size_t from : {13u, 22u, 31u}) {
    another.restore(states[from]);
    for (std::size_t frame = from + 1; frame <= from + 4; ++frame) {
      another.step(dt);
      ASSERT_EQ(another.state_hash(), hash(states[frame])) << "from frame " << from;
    }
  }
}

TEST(Surface, CrossesItselfWhereItIsNotAskedToCollide) {
  Scene scene = twisted_cloth();
  scene.objects[0].self_collision = false;
  World world(scene);
  Watch watch(world, scene);
  std::size_t most = 0;
  for (int frame = 0; frame < 96; ++frame) {
    const Report report = world.step(dt);
    EXPECT_EQ(report.pairs.candidates, 0);
    most = std::max(most, watch.crossings(world));
  }
  EXPECT_GT(most, 50u);
}

}  // namespace
}  // namespace pliant
