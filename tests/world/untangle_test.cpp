// Tests surfaces that intersect at the start: moved apart at limited speed, left, or rejected.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "apps/validate/sweep_table.h"
#include "collision/untangle/intersections.h"
#include "math/vector.h"
#include "pliant/error.h"
#include "world/surface_support.h"

namespace pliant {
namespace {

using namespace testing_support;
using validate::sweep_ways;
using validate::SweepWay;
using Intersections = Settings::Intersections;

/// A fixed level sheet, and one that stands across it, most of it above.
Scene crossed(Intersections what) {
  Scene scene;
  scene.gravity = {};
  scene.settings = settings_of(10);
  scene.settings.initial_intersections = what;
  Object flat = named_cloth(grid_mesh(10, 10, 0.4f, 0.4f), "flat");
  flat.masses.assign(100, std::numeric_limits<float>::infinity());
  scene.add(flat);
  TriangleMesh upright = grid_mesh(9, 9, 0.31f, 0.31f);
  for (Vec3f& p : upright.positions) p = {p.x + 0.007f, p.z + 0.1f, 0.012f};
  scene.add(named_cloth(upright, "upright"));
  return scene;
}

/// A sheet through the middle of a ball of triangles.
Scene pierced(Intersections what) {
  Scene scene;
  scene.gravity = {};
  scene.settings = settings_of(10);
  scene.settings.initial_intersections = what;
  MeshCollider ball;
  ball.name = "ball";
  ball.mesh = sphere_mesh(2);
  for (Vec3f& p : ball.mesh.positions) p = p * 0.1f + Vec3f{0, -0.02f, 0};
  scene.add(ball);
  Object sheet = named_cloth(grid_mesh(16, 16, 0.4f, 0.4f), "sheet");
  scene.add(sheet);
  return scene;
}

std::size_t crossings(const World& world, const Scene& scene) {
  std::vector<Triangle> triangles;
  std::vector<Vec3f> places;
  const auto add = [&](const std::vector<std::array<int, 3>>& of, const std::vector<Vec3f>& at) {
    const int first = static_cast<int>(places.size());
    for (const auto& t : of) triangles.push_back({first + t[0], first + t[1], first + t[2]});
    places.insert(places.end(), at.begin(), at.end());
  };
  for (int o = 0; o < world.object_count(); ++o) add(world.object(o).mesh().triangles, world.object(o).positions());
  for (std::size_t i = 0; i < scene.mesh_colliders.size(); ++i)
    add(scene.mesh_colliders[i].mesh.triangles, world.mesh_collider(static_cast<int>(i)).positions());
  return IntersectionFinder(triangles, static_cast<int>(places.size())).find(places).size();
}

/// The number of crossings that are left after some frames, and the largest speed in these frames.
std::size_t left_after(const Scene& scene, int frames, float& fastest) {
  World world(scene);
  EXPECT_GT(crossings(world, scene), 5U);
  fastest = 0;
  for (int frame = 0; frame < frames; ++frame) {
    std::vector<std::vector<Vec3f>> before;
    for (int o = 0; o < world.object_count(); ++o) before.push_back(world.object(o).positions());
    const Report report = world.step(dt);
    EXPECT_TRUE(report.ok()) << report.explain();
    for (int o = 0; o < world.object_count(); ++o) {
      const std::vector<Vec3f> after = world.object(o).positions();
      for (std::size_t i = 0; i < after.size(); ++i)
        fastest = std::max(fastest, length(after[i] - before[static_cast<std::size_t>(o)][i]) / dt);
    }
  }
  return crossings(world, scene);
}

TEST(Untangle, DrawsPiecesBack) {
  float fastest = 0;
  EXPECT_EQ(left_after(crossed(Intersections::untangle), 60, fastest), 0U);
  EXPECT_LT(fastest, 3.f);
  EXPECT_GT(left_after(crossed(Intersections::leave), 60, fastest), 5U) << "nothing else draws them apart";
}

TEST(Untangle, BringsOutWhatIsInsideABody) {
  float fastest = 0;
  Scene scene = pierced(Intersections::untangle);
  EXPECT_EQ(left_after(scene, 60, fastest), 0U);
  EXPECT_LT(fastest, 6.f) << "it does not explode";
  World world(scene);
  EXPECT_GT(world.step(dt).pairs.inside, 20);
  for (int frame = 0; frame < 60; ++frame) world.step(dt);
  EXPECT_EQ(world.step(dt).pairs.inside, 0);
  for (const Vec3f& p : world.object(0).positions()) EXPECT_GT(length(p - Vec3f{0, -0.02f, 0}), 0.09f);
  EXPECT_GT(left_after(pierced(Intersections::leave), 60, fastest), 5U);
}

/// What keeps an inflated object from turning by itself must not take this motion back.
TEST(Untangle, BringsOutAnInflatedBall) {
  Scene scene;
  scene.settings.initial_intersections = Intersections::untangle;
  TriangleMesh mesh = sphere_mesh(2);
  for (Vec3f& p : mesh.positions) p = p * 0.2f + Vec3f{0, 0.1f, 0};
  ClothOptions options;
  options.volume = Volume{1.4f, Stiffness::rigid()};
  options.material = fabric("rubber sheet");
  Object ball = make_cloth(mesh, options);
  ball.collides = true;
  ball.thickness = 0.005f;
  scene.add(ball);
  MeshCollider shell;
  shell.mesh = sphere_mesh(2);
  for (Vec3f& p : shell.mesh.positions) p = {p.x * 0.6f, p.y * 0.3f, p.z * 0.6f};
  scene.add(shell);
  World world(scene);
  for (int frame = 0; frame < 60; ++frame) ASSERT_TRUE(world.step(scene.frame_time).ok());
  double height = 0;
  const std::vector<Vec3f> places = world.object(0).positions();
  for (const Vec3f& p : places) height += double(p.y) / double(places.size());
  EXPECT_GT(height, 0.25);
}

TEST(Untangle, KeepsToItsSpeed) {
  Scene scene = pierced(Intersections::untangle);
  scene.settings.untangling_speed = 0.05f;
  World world(scene);
  std::vector<Vec3f> before = world.object(0).positions();
  world.step(dt);
  const std::vector<Vec3f> after = world.object(0).positions();
  float most = 0;
  for (std::size_t i = 0; i < after.size(); ++i) most = std::max(most, length(after[i] - before[i]));
  EXPECT_GT(most, 0.5f * 0.05f * dt);
  EXPECT_LT(most, 3 * 0.05f * dt);
}

/// A sheet at rest through a ball, at height `height` above the ball's centre.
Scene sheet_in_a_ball(float height, Sweep sweep) {
  Scene scene = pierced(Intersections::untangle);
  scene.settings.sweep = sweep;
  for (Vec3f& p : scene.mesh_colliders[0].mesh.positions) p.y += 0.02f - height;
  return scene;
}

/// The largest speed in frames that start with an intersection, and in all frames [m/s].
struct Fastest {
  float while_tangled = 0, ever = 0;
};

Fastest watch_speeds(World& world, int frames) {
  Fastest fastest;
  for (int frame = 0; frame < frames; ++frame) {
    const PairReport pairs = world.step(dt).pairs;
    for (int o = 0; o < world.object_count(); ++o)
      for (const Vec3f& v : world.object(o).velocities()) fastest.ever = std::max(fastest.ever, length(v));
    if (pairs.inside > 0 || pairs.initially_intersecting > 0) fastest.while_tangled = fastest.ever;
  }
  return fastest;
}

/// With any sweep, vertices that are moved apart must keep the speed limit; after that, stretched links may cause at
/// most some metres per second. With a relaxation of 1.3 this cloth would become infinite by itself.
TEST(Untangle, ThrowsNothingAndEndsClearByAnySweep) {
  Scene scenes[] = {crossed(Intersections::untangle), sheet_in_a_ball(0, Sweep::tiled),
                    sheet_in_a_ball(0.02f, Sweep::tiled)};
  for (Scene& scene : scenes)
    for (const SweepWay& way : sweep_ways()) {
      if (way.name == "over_relaxed") continue;
      SCOPED_TRACE(scene.objects[0].name + " by " + way.name);
      scene.settings.sweep = way.sweep;
      scene.settings.sweep_options = way.options;
      World world(scene);
      Watch watch(world, scene);
      const Fastest fastest = watch_speeds(world, 40);
      EXPECT_EQ(watch.crossings(world), 0U);
      EXPECT_LE(fastest.while_tangled, 1.001f * scene.settings.untangling_speed);
      EXPECT_LT(fastest.ever, 2.5f);
    }
}

TEST(Untangle, GoesOnInTheSameBitsFromAState) {
  const Scene scene = pierced(Intersections::untangle);
  World world(scene), another(scene);
  std::vector<State> states{world.state()};
  for (int frame = 0; frame < 24; ++frame) {
    world.step(dt);
    states.push_back(world.state());
  }
  for (const std::size_t from : {3U, 11U}) {
    another.restore(states[from]);
    for (std::size_t frame = from + 1; frame <= from + 12; ++frame) {
      another.step(dt);
      ASSERT_EQ(another.state_hash(), hash(states[frame])) << "from frame " << from << ", frame " << frame;
    }
  }
}

TEST(Untangle, MayBeRefused) {
  try {
    World world(crossed(Intersections::refuse));
    FAIL() << "was made";
  } catch (const Error& error) {
    const std::string said = error.what();
    EXPECT_NE(said.find("passes through triangle"), std::string::npos) << said;
    EXPECT_NE(said.find("initial_intersections"), std::string::npos) << said;
  }
  Scene apart = crossed(Intersections::refuse);
  for (Vec3f& p : apart.objects[1].positions) p.y += 0.2f;
  EXPECT_NO_THROW(World{apart});
}

/// A ball of triangles of radius half a metre about the origin, with a small sheet and two particles in it, and one
/// outside.
Scene shut_up(MeshCollider::As as) {
  Scene scene;
  scene.settings = settings_of(4);
  scene.settings.initial_intersections = Intersections::refuse;
  MeshCollider ball;
  ball.name = "ball";
  ball.mesh = sphere_mesh(2);
  for (Vec3f& p : ball.mesh.positions) p = p * 0.5f;
  ball.as = as;
  if (as == MeshCollider::As::distance_grid) ball.field = measure_distances(ball.mesh, 0.1f);
  scene.add(ball);
  scene.add(named_cloth(sheet(4, 0.2f, 0.03f), "sheet"));
  Object grains = loose_particles({{0, 2, 0}, {0.1f, 0.2f, 0.05f}, {0, -0.3f, 0}});
  grains.name = "grains";
  scene.add(grains);
  return scene;
}

TEST(Untangle, RefusesWhatIsShutUpInACollider) {
  for (const auto as : {MeshCollider::As::triangles, MeshCollider::As::distance_grid}) {
    Scene scene = shut_up(as);
    const std::string name = as == MeshCollider::As::triangles ? "closed collider 'ball'" : "distance grid 'ball'";
    EXPECT_NE(refusal_of(scene).find("object 'sheet', particle 0 and 15 more: is inside of " + name), std::string::npos)
        << refusal_of(scene);
    for (Vec3f& p : scene.objects[0].positions) p.y += 1;
    EXPECT_NE(refusal_of(scene).find("object 'grains', particle 1 and 1 more: is inside of " + name), std::string::npos)
        << refusal_of(scene);
    scene.objects[1].mask = 2;
    EXPECT_EQ(refusal_of(scene), "") << "what does not meet may be anywhere";
    scene.objects[1].mask = ~0u;
    scene.settings.initial_intersections = Intersections::leave;
    EXPECT_EQ(refusal_of(scene), "");
  }
}

TEST(Untangle, RefusesWhatIsShutUpInClosedClothAndNotWhatIsInAnOpenOne) {
  Scene scene;
  scene.settings.initial_intersections = Intersections::refuse;
  scene.add(named_cloth(sheet(4, 0.2f, 0.03f), "sheet"));
  scene.add(named_cloth(sphere_mesh(2), "balloon"));
  EXPECT_NE(refusal_of(scene).find("object 'sheet', particle 0 and 15 more: is inside of closed object 'balloon'"),
            std::string::npos)
      << refusal_of(scene);
  Scene open = scene;
  TriangleMesh torn = sphere_mesh(2);
  torn.triangles.pop_back();
  open.objects[1] = named_cloth(torn, "balloon");
  EXPECT_EQ(refusal_of(open), "");
  for (Vec3f& p : scene.objects[0].positions) p.x += 1.2f;
  EXPECT_EQ(refusal_of(scene), "") << "beside it";
}

/// A skirt whose folds become deeper towards the hem, 0.3 m wide at the hip.
TriangleMesh skirt(float radius, float folds, float phase) {
  constexpr int around = 64, rows = 16;
  TriangleMesh mesh;
  for (int row = 0; row < rows; ++row)
    for (int k = 0; k < around; ++k) {
      const float down = static_cast<float>(row) / (rows - 1), angle = 2 * 3.14159265f * static_cast<float>(k) / around;
      const float r = radius + 0.1f * down + 0.04f * down * std::cos(folds * angle + phase);
      mesh.positions.push_back({r * std::cos(angle), -0.5f * down, r * std::sin(angle)});
    }
  for (int row = 0; row + 1 < rows; ++row)
    for (int k = 0; k < around; ++k) {
      const int a = row * around + k, b = row * around + (k + 1) % around;
      mesh.triangles.push_back({a, b, a + around});
      mesh.triangles.push_back({b, b + around, a + around});
    }
  return mesh;
}

TriangleMesh both(const TriangleMesh& first, const TriangleMesh& second) {
  TriangleMesh mesh = first;
  const int vertices = static_cast<int>(first.positions.size());
  mesh.positions.insert(mesh.positions.end(), second.positions.begin(), second.positions.end());
  for (const auto& t : second.triangles) mesh.triangles.push_back({vertices + t[0], vertices + t[1], vertices + t[2]});
  return mesh;
}

/// Two skirts pinned at the hip whose folds intersect, as one object or as two.
Scene nested_skirts(bool as_one) {
  const TriangleMesh inner = skirt(0.15f, 6, 0);
  TriangleMesh outer = skirt(0.158f, 5, 1);
  // Rotated and raised a little, so that no edges touch exactly: such pairs cross only after something has moved.
  for (Vec3f& p : outer.positions) p = {p.x * 0.9999f + p.z * 0.013f, p.y + 0.0031f, p.z * 0.9999f - p.x * 0.013f};
  Scene scene;
  scene.settings = settings_of(10);
  scene.settings.initial_intersections = Intersections::untangle;
  std::vector<int> hip;
  for (int k = 0; k < 64; ++k) hip.push_back(k);
  if (as_one) {
    scene.pin(scene.add(named_cloth(both(inner, outer), "skirts")), hip);
    for (int& k : hip) k += static_cast<int>(inner.positions.size());
    scene.pin(0, hip);
  } else {
    scene.pin(scene.add(named_cloth(inner, "inner")), hip);
    scene.pin(scene.add(named_cloth(outer, "outer")), hip);
  }
  return scene;
}

/// The number of crossings that are left after each of some frames.
std::vector<std::size_t> crossings_of_frames(const Scene& scene, int frames) {
  World world(scene);
  std::vector<std::size_t> counts{crossings(world, scene)};
  for (int frame = 0; frame < frames; ++frame) {
    world.step(dt);
    counts.push_back(crossings(world, scene));
  }
  return counts;
}

/// The components of one mesh are parts of their own: they are moved apart as two objects are, and crossings never
/// increase.
TEST(Untangle, LeadsComponentsOfOneMeshApart) {
  for (const bool as_one : {false, true}) {
    const std::vector<std::size_t> counts = crossings_of_frames(nested_skirts(as_one), 20);
    EXPECT_GT(counts.front(), 500U);
    EXPECT_EQ(counts.back(), 0U) << (as_one ? "one object" : "two objects");
    for (std::size_t frame = 1; frame < counts.size(); ++frame)
      EXPECT_LE(counts[frame], counts[frame - 1]) << (as_one ? "one object" : "two objects") << ", frame " << frame;
  }
}

/// A leg, of two that part from a common hip inside the skirts.
TriangleMesh leg(float side) {
  TriangleMesh mesh = sphere_mesh(2);
  for (Vec3f& p : mesh.positions) {
    p = {0.15f * p.x, 0.4f * p.y - 0.5f, 0.15f * p.z + 0.0123f};
    p.x += side * (0.07f - 0.12f * p.y);
    p.z += 0.05f * p.x;
  }
  return mesh;
}

/// Crossings of a mesh with itself.
std::size_t own_crossings(const TriangleMesh& mesh) {
  std::vector<Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) triangles.push_back({t[0], t[1], t[2]});
  return IntersectionFinder(triangles, static_cast<int>(mesh.positions.size())).find(mesh.positions).size();
}

/// Garments around a body that intersects itself come apart and out of it, be they one object or two.
TEST(Untangle, LeadsGarmentsOutOfABodyThatIntersectsItself) {
  for (const bool as_one : {false, true}) {
    Scene scene = nested_skirts(as_one);
    MeshCollider body;
    body.name = "body";
    body.mesh = both(leg(1), leg(-0.95f));
    const std::size_t of_body = own_crossings(body.mesh);
    EXPECT_GT(of_body, 20U);
    scene.add(body);
    const std::vector<std::size_t> counts = crossings_of_frames(scene, 24);
    const std::string what = as_one ? "one object" : "two objects";
    EXPECT_GT(counts.front(), of_body + 800) << what;
    EXPECT_LT(counts[8], of_body + (counts.front() - of_body) / 2) << what;
    EXPECT_EQ(counts.back(), of_body) << what;
    for (std::size_t frame = 4; frame < counts.size(); ++frame)
      EXPECT_LE(counts[frame], counts[frame - 4]) << what << ", frame " << frame;
  }
}

/// Two sheets slotted into each other halfway: neither is cut into pieces.
TEST(Untangle, SaysWhatItDoesNotLeadApart) {
  Scene scene = crossed(Intersections::untangle);
  for (Vec3f& p : scene.objects[1].positions) p.x += 0.11f;
  World world(scene);
  std::string said = world.step(dt).explain();
  EXPECT_NE(said.find("are not moved apart in this frame, because they cut no piece off"), std::string::npos) << said;
  EXPECT_EQ(said.find("did not reduce"), std::string::npos) << said;
  said = world.step(dt).explain();
  EXPECT_NE(said.find("untangling did not reduce their number in the previous frame"), std::string::npos) << said;
  World leaves(crossed(Intersections::leave));
  said = leaves.step(dt).explain() + leaves.step(dt).explain();
  EXPECT_EQ(said.find("moved apart"), std::string::npos) << said;
  EXPECT_EQ(said.find("did not reduce"), std::string::npos) << said;
}

}  // namespace
}  // namespace pliant
