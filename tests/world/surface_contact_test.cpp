// Surfaces that touch surfaces, as a World moves them: cloth with itself, with other cloth, with what is shot at it and with
// meshes. Whatever is promised not to cross is looked at with exact signs in every frame.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "collision/intersections.h"
#include "math/vector.h"
#include "support/kernels.h"
#include "world/surface_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// Finds what crosses among the objects of a World, and meshes that are carried along.
class Watch {
 public:
  Watch(const World& world, const Scene& scene) : scene_(scene), objects_(world.object_count()) {
    std::vector<Triangle> triangles;
    int vertices = 0;
    const auto add = [&](const TriangleMesh& mesh) {
      for (const auto& t : mesh.triangles) triangles.push_back({vertices + t[0], vertices + t[1], vertices + t[2]});
      vertices += static_cast<int>(mesh.positions.size());
    };
    for (int o = 0; o < objects_; ++o) add(world.mesh(o));
    for (const MeshCollider& collider : scene.mesh_colliders) add(collider.mesh);
    finder_ = std::make_unique<IntersectionFinder>(triangles, vertices);
  }

  /// `carried`: how far mesh colliders have come.
  std::size_t crossings(const World& world, const Vec3f& carried = {}) {
    std::vector<Vec3f> places;
    for (int o = 0; o < objects_; ++o) {
      const std::vector<Vec3f> more = world.positions(o);
      places.insert(places.end(), more.begin(), more.end());
    }
    for (const MeshCollider& collider : scene_.mesh_colliders)
      for (const Vec3f& p : collider.mesh.positions) places.push_back(p + carried);
    return finder_->find(places).size();
  }

 private:
  const Scene& scene_;
  int objects_;
  std::unique_ptr<IntersectionFinder> finder_;
};

Collider floor_at(float height) {
  Collider floor;
  floor.position = {0, height, 0};
  return floor;
}

// ------------------------------------------------------------------------------------------------ scenes

/// A sheet folded back over itself in a half circle, dropped onto a floor.
Scene folded_cloth() {
  TriangleMesh mesh = sheet(24, 0.5f, 0);
  constexpr float pi = 3.14159265f, radius = 0.03f, flat = 0.25f - pi / 2 * radius;
  for (Vec3f& p : mesh.positions) {
    const float along = p.x + 0.25f, angle = std::clamp((along - flat) / radius, 0.f, pi);
    const float back = std::max(0.f, along - flat - pi * radius);
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

/// Two ends turned against each other, two turns in a second and a half.
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

/// Over a ball of triangles.
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

struct Named {
  const char* name;
  Scene (*make)();
  int frames;
};
void PrintTo(const Named& named, std::ostream* out) { *out << named.name; }

class Surfaces : public testing::TestWithParam<Named> {};
INSTANTIATE_TEST_SUITE_P(Scenes, Surfaces,
                         testing::Values(Named{"folded", folded_cloth, 50}, Named{"layers", layers, 50},
                                         Named{"twisted", twisted_cloth, 96}, Named{"on_a_mesh", cloth_on_a_mesh, 60}),
                         [](const auto& named) { return named.param.name; });

TEST_P(Surfaces, CrossNothing) {
  const Scene scene = GetParam().make();
  World world(scene);
  Watch watch(world, scene);
  std::int64_t contacts = 0;
  for (int frame = 0; frame < GetParam().frames; ++frame) {
    const Report report = world.step(dt);
    ASSERT_TRUE(report.ok()) << report.explain();
    ASSERT_EQ(report.pairs.hopeless, 0) << "frame " << frame;
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

// ------------------------------------------------------------------------------------------------ shots

/// A small tetrahedron that holds its shape.
Object pebble(const Vec3f& at, const Vec3f& velocity) {
  TriangleMesh mesh;
  const float s = 0.006f;
  mesh.positions = {at + Vec3f{s, s, s}, at + Vec3f{-s, -s, s}, at + Vec3f{-s, s, -s}, at + Vec3f{s, -s, -s}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  Object object = cloth(mesh, 0.0005f);
  object.self_collision = false;
  object.velocities.assign(4, velocity);
  object.masses.assign(4, 1e-5f);
  return object;
}

/// Pebbles at 1 to 1000 m/s against cloth that is held at its border; how many went through.
int shot_through(bool filter, std::size_t& crossings) {
  Scene scene = scene_of(10);
  scene.gravity = {};
  scene.settings.contact_filter = filter;
  const TriangleMesh mesh = sheet(16, 0.4f, 0);
  const int target = scene.add(cloth(mesh, 0.0005f));
  std::vector<int> border;
  for (int i = 0; i < 256; ++i)
    if (i < 16 || i >= 240 || i % 16 == 0 || i % 16 == 15) border.push_back(i);
  scene.pin(target, border);
  for (int k = 0; k < 16; ++k) {
    const float speed = std::pow(10.f, static_cast<float>(k) / 5), x = 0.08f * static_cast<float>(k % 4) - 0.113f;
    const Vec3f direction{0.2f, -0.97f, 0.1f}, aim{x, 0, 0.08f * static_cast<float>(k / 4) - 0.127f};
    scene.add(pebble(aim - direction * (0.02f + std::min(1.f, 0.05f * speed)), direction * speed));
  }
  World world(scene);
  Watch watch(world, scene);
  for (int frame = 0; frame < 20; ++frame) {
    EXPECT_TRUE(world.step(dt).ok());
    crossings += watch.crossings(world);
  }
  float lowest = 0;
  for (const Vec3f& p : world.positions(target)) lowest = std::min(lowest, p.y);
  int through = 0;
  for (int k = 0; k < 16; ++k) {
    const std::vector<Vec3f> at = world.positions(1 + k);
    if (at[0].y < lowest - 0.02f) ++through;
  }
  return through;
}

TEST(Shot, DoesNotPassThroughClothAtAnySpeed) {
  std::size_t crossings = 0;
  EXPECT_EQ(shot_through(true, crossings), 0);
  EXPECT_EQ(crossings, 0u);
}

TEST(Shot, PassesWithoutTheFilter) {
  std::size_t crossings = 0;
  EXPECT_GT(shot_through(false, crossings) + static_cast<int>(crossings), 0);
}

/// A ball of triangles that nothing stops, through where a loose sheet lies.
struct Passage {
  std::size_t crossings = 0;
  std::int64_t hopeless = 0;
  int most_substeps = 0;
  bool warned = false;
};

Passage ball_through(float speed, int most_substeps) {
  Scene scene = scene_of(20);
  scene.settings.most_substeps = most_substeps;
  scene.gravity = {};
  scene.add(cloth(sheet(14, 0.4f, 0)));
  MeshCollider ball;
  ball.mesh = sphere_mesh(2);
  for (Vec3f& p : ball.mesh.positions) p = p * 0.1f + Vec3f{0.011f, 0.12f, 0.007f};
  ball.motion = straight({0, -speed, 0}, 1);
  scene.add(ball);
  World world(scene);
  Watch watch(world, scene);
  Passage passage;
  for (int frame = 1; frame <= 10; ++frame) {
    const Report report = world.step(dt);
    EXPECT_TRUE(report.ok()) << report.explain();
    passage.hopeless += report.pairs.hopeless;
    passage.crossings += watch.crossings(world, {0, -speed * static_cast<float>(world.state().time), 0});
    passage.most_substeps = std::max(passage.most_substeps, report.substeps);
    passage.warned = passage.warned || report.explain().find("most_substeps") != std::string::npos;
  }
  return passage;
}

TEST(Shot, OfABallCarriesTheSheetAlong) {
  // 20 substeps of 1/1200 s: at 1 m/s already 0.83 mm of the 1 mm, half the pair's thickness, that it may go in one.
  for (const auto& [speed, substeps] : {std::pair{1.f, 20}, {3.f, 50}, {10.f, 167}, {30.f, 500}}) {
    const Passage passage = ball_through(speed, 2000);
    EXPECT_EQ(passage.crossings, 0u) << speed << " m/s";
    EXPECT_EQ(passage.hopeless, 0) << speed << " m/s";
    EXPECT_NEAR(passage.most_substeps, substeps, 1) << speed << " m/s";
    EXPECT_FALSE(passage.warned) << speed << " m/s";
  }
}

TEST(Shot, OfABallThatOverrunsTheSheetIsSaidToBe) {
  // What nothing pushes and goes farther in a substep than the gap to what it meets can't be kept from it by shortening moves.
  for (const float speed : {10.f, 100.f, 1000.f}) {
    const Passage passage = ball_through(speed, 20);
    EXPECT_TRUE(passage.crossings == 0 || passage.hopeless > 0) << speed << " m/s";
    EXPECT_TRUE(passage.warned) << speed << " m/s";
    EXPECT_EQ(passage.most_substeps, 20) << speed << " m/s";
  }
}

TEST(Shot, OfABallThatMissesCostsNoSubsteps) {
  Scene scene = scene_of(20);
  scene.gravity = {};
  scene.add(cloth(sheet(14, 0.4f, 0)));
  MeshCollider ball;
  ball.mesh = sphere_mesh(2);
  for (Vec3f& p : ball.mesh.positions) p = p * 0.1f + Vec3f{0.011f, 0.4f, 0.007f};
  ball.motion = straight({10, 0, 0}, 1);
  scene.add(ball);
  World world(scene);
  for (int frame = 0; frame < 10; ++frame) EXPECT_EQ(world.step(dt).substeps, 20);
}

// ------------------------------------------------------------------------------------------------ who meets whom

/// How far a sheet that falls onto another, which is held, comes below it.
float sinks(const std::function<void(Object& held, Object& falling)>& change) {
  Scene scene = scene_of(10);
  Object held = cloth(sheet(10, 0.4f, 0)), falling = cloth(sheet(9, 0.2f, 0.02f));
  change(held, falling);
  const int object = scene.add(held);
  scene.add(falling);
  std::vector<int> all(100);
  for (int i = 0; i < 100; ++i) all[static_cast<std::size_t>(i)] = i;
  scene.pin(object, all);
  World world(scene);
  for (int frame = 0; frame < 30; ++frame) world.step(dt);
  float lowest = 1;
  for (const Vec3f& p : world.positions(1)) lowest = std::min(lowest, p.y);
  return -lowest;
}

TEST(Groups, SayWhoMeetsWhom) {
  EXPECT_LT(sinks([](Object&, Object&) {}), 0.f);
  EXPECT_GT(sinks([](Object& held, Object&) { held.collides = false; }), 0.5f);
  EXPECT_GT(sinks([](Object& held, Object&) { held.groups = 2; }) + sinks([](Object& held, Object& falling) {
              held.groups = 2;
              falling.mask = 1;
            }),
            0.5f);
  EXPECT_GT(sinks([](Object&, Object& falling) { falling.mask = 2; }), 0.5f);
  EXPECT_GT(sinks([](Object& held, Object&) { held.mask = 0; }), 0.5f);
  EXPECT_LT(sinks([](Object& held, Object& falling) {
              held.groups = 4;
              held.mask = 2;
              falling.groups = 2;
              falling.mask = 4;
            }),
            0.f);
}

// ------------------------------------------------------------------------------------------------ rest and friction

TEST(Layers, ComeToRestAtTheirThickness) {
  Scene scene = scene_of(10);
  for (int i = 0; i < 3; ++i) scene.add(cloth(sheet(8, 0.2f, 0.004f + 0.005f * static_cast<float>(i)), 0.002f));
  scene.add(floor_at(0));
  World world(scene);
  std::int64_t shortened = 0;
  for (int frame = 0; frame < 120; ++frame) {
    const Report report = world.step(dt);
    if (frame < 60) continue;
    shortened += report.pairs.shortened;
    ASSERT_LT(world.kinetic_energy(), 1e-6) << "frame " << frame;
  }
  EXPECT_LT(shortened, 60 * 10 * 192 / 100) << "moves at rest are not shortened";
  for (int i = 0; i < 3; ++i)
    for (const Vec3f& p : world.positions(i))
      EXPECT_NEAR(p.y, 0.002f + 0.004f * static_cast<float>(i), 2e-4f) << "layer " << i;
}

/// How far a patch of cloth slides in a second down two triangles that lie askew.
float slid(float degrees, float friction) {
  Scene scene = scene_of(10);
  const double angle = double(degrees) * 3.14159265358979 / 180;
  const auto turned = [&](const Vec3f& p) {
    const double c = std::cos(angle), s = std::sin(angle);
    return convert<float>(Vec3d{c * double(p.x) + s * double(p.y), c * double(p.y) - s * double(p.x), double(p.z)});
  };
  MeshCollider slope;
  slope.mesh = grid_mesh(2, 2, 8, 2);
  slope.static_friction = slope.kinetic_friction = friction;
  TriangleMesh patch = sheet(5, 0.2f, 0.002f);
  for (Vec3f& p : slope.mesh.positions) p = turned(p);
  for (Vec3f& p : patch.positions) p = turned(p);
  const Vec3f start = patch.positions[12];
  scene.add(slope);
  Object object = cloth(patch);
  object.static_friction = object.kinetic_friction = friction;
  scene.add(object);
  World world(scene);
  for (int frame = 0; frame < 60; ++frame) world.step(dt);
  return length(world.positions(0)[12] - start);
}

TEST(Slope, HoldsClothBelowTheAngleOfFriction) {
  EXPECT_LT(slid(25.6f, 0.5f), 0.002f);  // tan 26.565 degrees is 0.5
  EXPECT_GT(slid(27.5f, 0.5f), 0.02f);
  const double angle = 40 * 3.14159265358979 / 180, expected = 0.5 * 9.81 * (std::sin(angle) - 0.5 * std::cos(angle));
  EXPECT_NEAR(double(slid(40, 0.5f)), expected, 0.03 * expected);
}

// ------------------------------------------------------------------------------------------------ tangles

TEST(Tangle, IsCountedDoesNotExplodeAndIsForgottenOnceApart) {
  Scene scene = scene_of(10);
  scene.gravity = {};
  std::vector<int> border;
  for (int i = 0; i < 100; ++i)
    if (i < 10 || i >= 90 || i % 10 == 0 || i % 10 == 9) border.push_back(i);
  scene.pin(scene.add(cloth(sheet(10, 0.4f, 0))), border);
  TriangleMesh upright = grid_mesh(9, 9, 0.31f, 0.31f);  // stands across it, its lower edge below
  for (Vec3f& p : upright.positions) p = {p.x + 0.007f, p.z + 0.1f, 0.012f};
  Object object = cloth(upright);
  object.velocities.assign(object.positions.size(), Vec3f{0, 0.5f, 0});
  scene.add(object);
  World world(scene);
  Watch watch(world, scene);
  ASSERT_GT(watch.crossings(world), 5u);
  Report report = world.step(dt);
  EXPECT_GT(report.pairs.tangled, 5);
  for (int frame = 0; frame < 40; ++frame) {
    report = world.step(dt);
    ASSERT_TRUE(report.ok()) << report.explain();
    for (int o = 0; o < 2; ++o)
      for (const Vec3f& v : world.velocities(o)) ASSERT_LT(length(v), 3.f) << "frame " << frame;
  }
  EXPECT_EQ(watch.crossings(world), 0u);
  EXPECT_EQ(report.pairs.tangled, 0);
}

}  // namespace
}  // namespace pliant
