// Threads that sew particles together, constraints that break by their force, and particles that are welded.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "pliant/body.h"
#include "pliant/error.h"
#include "pliant/mesh.h"
#include "pliant/soft_body.h"
#include "pliant/stitch.h"
#include "pliant/world.h"
#include "support/refusal.h"
#include "support/run.h"

namespace pliant {
namespace {

using testing_support::refusal;

constexpr float earth_gravity = 9.81f;

Scene scene_of(Object object, bool falls) {
  Scene scene;
  if (!falls) scene.gravity = {};
  scene.settings.threads = 1;
  scene.settings.substeps = 20;
  scene.add(std::move(object));
  return scene;
}

using testing_support::run;

double distance_of(const World& world, const std::array<int, 2>& pair) {
  const std::vector<Vec3f> x = world.object(0).positions();
  const Vec3f d = x[static_cast<std::size_t>(pair[0])] - x[static_cast<std::size_t>(pair[1])];
  return std::sqrt(static_cast<double>(dot(d, d)));
}

/// Two squares of 5 x 5 particles one above the other, 0.1 m apart, as one object.
Object panels(bool self_collides = false) {
  TriangleMesh mesh = grid_mesh(5, 5, 0.2f, 0.2f);
  const TriangleMesh other = mesh;
  for (Vec3f p : other.positions) mesh.positions.push_back(p + Vec3f{0, 0.1f, 0});
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({a + 25, b + 25, c + 25});
  ClothOptions options;
  options.material = fabric("cotton");
  Object object = make_cloth(mesh, options);
  object.self_collision = self_collides;
  return object;
}

std::vector<std::array<int, 2>> seam_of(const Object& object) {
  std::vector<int> low, high;
  for (int i = 0; i < 25; ++i)
    if (i % 5 == 4) low.push_back(i), high.push_back(i + 25);
  return nearest_pairs(object, low, high);
}

TEST(Stitches, BringPanelsTogether) {
  Object object = panels();
  const std::vector<std::array<int, 2>> seam = seam_of(object);
  ASSERT_EQ(seam.size(), 5u);
  EXPECT_EQ(seam[2], (std::array<int, 2>{14, 39}));
  add_stitches(object, seam, {.closing_time = 0.5f});
  World world(scene_of(object, false));
  run(world, 15);
  for (const auto& pair : seam) EXPECT_LT(distance_of(world, pair), 0.053);  // half of the time; nothing brakes
  run(world, 30);
  for (const auto& pair : seam) EXPECT_LT(distance_of(world, pair), 5e-4);
  double moment = 0, mass = 0;
  for (std::size_t i = 0; i < 50; ++i) {
    moment += static_cast<double>(object.masses[i]) * static_cast<double>(world.object(0).positions()[i].y);
    mass += static_cast<double>(object.masses[i]);
  }
  EXPECT_NEAR(moment / mass, 0.05, 1e-6);  // nothing acts from outside
}

/// A thread that closes pulls at its own speed, at any number of substeps.
TEST(Stitches, CloseAtTheSpeedAsked) {
  for (const int substeps : {5, 40, 160}) {
    Object object;
    object.name = "points";
    object.positions = {{0, 0, 0}, {1, 0, 0}};
    object.masses = {0.001f, 0.001f};
    const std::array<int, 2> pair{0, 1};
    add_stitches(object, std::span(&pair, 1), {.closing_time = 1});
    Scene scene = scene_of(object, false);
    scene.settings.substeps = substeps;
    World world(scene);
    for (int frame = 1; frame <= 30; ++frame) {
      run(world, 1);
      EXPECT_NEAR(distance_of(world, pair), 1 - frame / 60., 3e-4) << substeps << " " << frame;
    }
  }
}

/// Contact keeps the seam open by what both sides keep apart.
TEST(Stitches, HoldBesideContact) {
  Object object = panels(true);
  add_stitches(object, seam_of(object), {.closing_time = 0.5f});
  Scene scene = scene_of(object, true);
  scene.add(Collider{.name = "floor", .shape = Plane{}, .position = {0, -0.01f, 0}});
  World world(scene);
  run(world, 180);
  for (const auto& pair : seam_of(object))
    EXPECT_LT(distance_of(world, pair), 4 * static_cast<double>(object.thickness));
  double fastest = 0;
  for (const Vec3f& v : world.object(0).velocities())
    fastest = std::max(fastest, std::sqrt(static_cast<double>(dot(v, v))));
  EXPECT_LT(fastest, 0.2);
}

Object two_points(float mass) {
  Object object;
  object.name = "points";
  object.positions = {{0, 0, 0}, {0, -1, 0}};
  object.masses = {INFINITY, mass};
  object.damping = 400;  // the weight comes to rest without swinging
  return object;
}

TEST(Stitches, NeverPush) {
  Object object = two_points(1);
  object.damping = 0;
  const std::array<int, 2> pair{0, 1};
  add_stitches(object, std::span(&pair, 1));
  object.constraints[0].keyframes = {{0, 1}};
  object.velocities = {{}, {0, 0.5f, 0}};
  World world(scene_of(object, false));
  run(world, 60);
  EXPECT_NEAR(distance_of(world, pair), 0.5, 1e-4);
}

/// A weight m g tears a thread that breaks below it, and no other.
TEST(BreakForce, IsTheForceThatAThreadBears) {
  for (const float share : {0.98f, 1.02f}) {
    Object object = two_points(2);
    const std::array<int, 2> pair{0, 1};
    add_stitches(object, std::span(&pair, 1),
                 {.stiffness = Stiffness::compliance(1e-4f), .break_force = share * 2 * earth_gravity});
    object.constraints[0].keyframes = {{0, 1}};
    World world(scene_of(object, true));
    int lost = 0;
    for (int i = 0; i < 120; ++i)
      for (const Torn& torn : world.step(1.f / 60).torn) lost += torn.lost_constraints;
    EXPECT_EQ(lost, share < 1 ? 1 : 0);
    EXPECT_EQ(distance_of(world, pair) > 1.01, share < 1);
  }
}

/// How many constraints a weight of 1 kg breaks that hangs at height y from one that is so stiff.
int broken_by_a_weight(float y, const std::string& type, float alpha, float break_force) {
  Object object;
  object.positions = {{0, y, 0}, {0, y - 0.5f, 0}};
  object.masses = {INFINITY, 1};
  object.damping = 5;
  ConstraintGroup group;
  group.type = type;
  group.particles = {0, 1};
  if (type == "distance_limit") group.rest = {0.5f, 0};
  group.stiffness = Stiffness::compliance(alpha);
  group.break_force = break_force;
  object.constraints = {group};
  World world(scene_of(object, true));
  int lost = 0;
  for (int i = 0; i < 120; ++i)
    for (const Torn& torn : world.step(1.f / 60).torn) lost += torn.lost_constraints;
  return lost;
}

/// Elongations that are less than a position's rounding, and far from the origin.
TEST(BreakForce, OfAStiffThreadIsNotHiddenByRounding) {
  for (const std::string type : {"distance", "distance_limit"})
    for (const float y : {0.f, 10.f, 100.f})
      for (const float alpha : {1e-6f, 1e-7f, 1e-8f, 1e-9f}) {
        EXPECT_EQ(broken_by_a_weight(y, type, alpha, 0.98f * earth_gravity), 1)
            << type << " at " << y << " m, " << alpha << " m/N";
        EXPECT_EQ(broken_by_a_weight(y, type, alpha, 1.02f * earth_gravity), 0)
            << type << " at " << y << " m, " << alpha << " m/N";
        EXPECT_EQ(broken_by_a_weight(y, type, alpha, 0.5f * earth_gravity), 1)
            << type << " at " << y << " m, " << alpha << " m/N";
      }
}

/// Of a rope the link breaks that bears most: the uppermost.
TEST(BreakForce, TakesTheUppermostLinkOfARope) {
  RopeOptions options;
  options.stretch = Stiffness::compliance(1e-5f);
  std::vector<Vec3f> points;
  for (int i = 0; i < 6; ++i) points.push_back({0, -0.1f * static_cast<float>(i), 0});
  Object rope = make_rope(points, options);
  rope.masses.assign(6, 0.1f);
  rope.pins = {{0}};
  rope.damping = 100;
  for (ConstraintGroup& group : rope.constraints)
    if (group.type == "distance") group.break_force = 4.5f * 0.1f * earth_gravity;  // five hang from the first link
  World world(scene_of(rope, true));
  run(world, 120);
  const std::vector<Vec3f> x = world.object(0).positions();
  EXPECT_LT(x[1].y, -0.3f);
  for (std::size_t i = 2; i < 6; ++i) EXPECT_NEAR(x[i - 1].y - x[i].y, 0.1f, 0.003f);
}

/// How many constraints are lost in a run of 60 frames: in the first frame with any, and in all.
std::pair<int, int> losses_of(const Object& object) {
  World world(scene_of(object, true));
  std::pair<int, int> lost{};
  for (int i = 0; i < 60; ++i) {
    for (const Torn& torn : world.step(1.f / 60).torn) {
      if (lost.second == 0) lost.first = torn.lost_constraints;
      lost.second += torn.lost_constraints;
    }
  }
  return lost;
}

/// A rope whose links break beyond a force.
Object breakable_rope(const std::vector<Vec3f>& points, float alpha, float break_force, float mass) {
  Object rope;
  rope.name = "rope";
  rope.positions = points;
  rope.masses.assign(points.size(), mass);
  ConstraintGroup links;
  links.type = "distance";
  for (int i = 0; i + 1 < static_cast<int>(points.size()); ++i)
    links.particles.insert(links.particles.end(), {i, i + 1});
  links.stiffness = Stiffness::compliance(alpha);
  links.break_force = break_force;
  rope.constraints = {links};
  return rope;
}

/// One iteration in two colours leaves every second link twice as long as its force would: multipliers tell the force.
TEST(BreakForce, IsNoErrorOfTheSolve) {
  std::vector<Vec3f> points;
  for (int i = 0; i < 6; ++i) points.push_back({0, -0.1f * static_cast<float>(i), 0});
  Object rope = breakable_rope(points, 1e-5f, 8, 0.1f);  // 4.9 N at the first link
  rope.pins = {{0}};
  rope.damping = 100;
  EXPECT_EQ(losses_of(rope), std::pair(0, 0));
}

/// All links of a taut rope bear one load: that one breaks relieves the others.
TEST(BreakForce, TakesOneLinkOfARopeWithAWeight) {
  std::vector<Vec3f> points;
  for (int i = 0; i < 8; ++i) points.push_back({0, -0.2f * static_cast<float>(i), 0});
  Object rope = breakable_rope(points, 1e-5f, 40, 0.02f);
  rope.masses[7] = 5;  // 49 N
  rope.pins = {{0}};
  EXPECT_EQ(losses_of(rope), std::pair(1, 1));
}

/// A long straight rope rings like a bar: its links resist pressure, so the pull returns after four frames, and may
/// break another.
TEST(BreakForce, TakesOneLinkOfARopeTiedToABody) {
  for (const int links : {4, 10, 40}) {
    Object object = make_body({{Box{{0.1f, 0.1f, 0.1f}}}}, {.position = {0, -1.1f, 0}, .mass = 5});
    std::vector<Vec3f> points;
    for (int i = 0; i <= links; ++i) points.push_back({0, -static_cast<float>(i) / static_cast<float>(links), 0});
    const int first = append(object, breakable_rope(points, 1e-5f, 40, 0.02f));
    object.pins = {{first}};
    attach(object, {first + links}, 0);
    const auto [at_first, in_all] = losses_of(object);
    EXPECT_EQ(at_first, 1) << links << " links";
    if (links < 40) {
      EXPECT_EQ(in_all, 1) << links << " links";
    }
  }
}

/// The body swings on the half of the rope that is left, which may break later.
TEST(BreakForce, TakesOneLinkAtATimeOfARopeWithABodyInTheMiddle) {
  Object object = make_body({{Box{{0.15f, 0.15f, 0.15f}}}}, {.position = {0, 1.84f, 0}, .mass = 27});
  std::vector<Vec3f> points;
  for (int i = 0; i <= 40; ++i) points.push_back({-2 + 0.1f * static_cast<float>(i), 2, 0});
  const int first = append(object, breakable_rope(points, 1e-6f, 300, 0.05f));
  object.pins = {{first}, {first + 40}};
  attach(object, {first + 20}, 0);
  EXPECT_EQ(losses_of(object).first, 1);
}

/// A rope is no strut: what presses it breaks nothing.
TEST(BreakForce, IsNoneOfWhatIsPressed) {
  Object object;
  object.positions = {{0, 0, 0}, {0, 1, 0}};
  object.masses = {INFINITY, 1};
  object.velocities = {{}, {0, -0.1f, 0}};
  ConstraintGroup link;
  link.type = "distance";
  link.particles = {0, 1};
  link.stiffness = Stiffness::compliance(1e-4f);
  link.break_force = 5;  // of 9.8 N
  object.constraints = {link};
  object.damping = 400;
  EXPECT_EQ(losses_of(object), std::pair(0, 0));
}

/// Threads side by side bear a part of the load each: all of them break at once.
TEST(BreakForce, TakesAllThreadsSideBySide) {
  Object object;
  object.positions = {{0, 0, 0}, {0, -1, 0}, {1, 0, 0}, {1, -1, 0}};
  object.masses = {INFINITY, 1, INFINITY, 1};
  ConstraintGroup links;
  links.type = "distance";
  links.particles = {0, 1, 2, 3};
  links.stiffness = Stiffness::compliance(1e-4f);
  links.break_force = 5;
  object.constraints = {links};
  EXPECT_EQ(losses_of(object), std::pair(2, 2));
  object.constraints[0].particles = {1, 0, 0, 3};
  object.positions[3] = {0.1f, -1, 0};
  EXPECT_EQ(losses_of(object), std::pair(2, 2)) << "two threads on one nail";
}

/// A button on a shirt.
TEST(BreakForce, TakesATieOffATriangle) {
  for (const float share : {0.98f, 1.02f}) {
    Object object;
    object.name = "button";
    object.positions = {{0, 0, 0}, {-1, 0, -1}, {1, 0, -1}, {0, 0, 1}};
    object.masses = {0.5f, INFINITY, INFINITY, INFINITY};
    object.triangles = {{1, 2, 3}};
    object.damping = 400;
    ConstraintGroup tie;
    tie.type = "point_on_triangle";
    tie.particles = {0, 1, 2, 3};
    tie.stiffness = Stiffness::compliance(1e-4f);
    tie.break_force = share * 0.5f * earth_gravity;
    object.constraints = {tie};
    World world(scene_of(object, true));
    run(world, 120);
    EXPECT_EQ(world.object(0).positions()[0].y < -0.01f, share < 1);
  }
}

TEST(BreakForce, FollowsFromTheState) {
  const auto made = [](int threads) {
    Object object = panels();
    add_stitches(object, seam_of(object),
                 {.closing_time = 0.3f, .stiffness = Stiffness::compliance(1e-4f), .break_force = 0.05f});
    object.pins = {{0}, {4}};
    Scene scene = scene_of(object, true);
    scene.settings.threads = threads;
    return scene;
  };
  World one(made(1)), three(made(3));
  int lost = 0;
  for (int i = 0; i < 60; ++i) {
    for (const Torn& torn : one.step(1.f / 60).torn) lost += torn.lost_constraints;
    three.step(1.f / 60);
  }
  EXPECT_GT(lost, 0);
  EXPECT_EQ(hash(one.state()), hash(three.state()));
}

TEST(BreakForce, NeedsAComplianceAndATypeWithForces) {
  Object object = two_points(1);
  const std::array<int, 2> pair{0, 1};
  add_stitches(object, std::span(&pair, 1), {.break_force = 5});
  EXPECT_NE(refusal([&] { World world(scene_of(object, true)); }).find("break_force"), std::string::npos);
  object.constraints[0] = {};
  object.constraints[0].type = "tetrahedron_volume";
  object.constraints[0].break_force = 5;
  EXPECT_NE(refusal([&] { World world(scene_of(object, true)); }).find("break_force"), std::string::npos);
}

/// Of two threads between the same particles the weak one breaks alone.
TEST(BreakForce, LeavesAStrongerThread) {
  Object object = two_points(1);
  const std::array<int, 2> pair{0, 1};
  for (const float force : {0.5f * earth_gravity, 5 * earth_gravity}) {
    add_stitches(object, std::span(&pair, 1), {.stiffness = Stiffness::compliance(1e-4f), .break_force = force});
    object.constraints.back().keyframes = {{0, 1}};
  }
  World world(scene_of(object, true));
  int lost = 0;
  for (int i = 0; i < 120; ++i)
    for (const Torn& torn : world.step(1.f / 60).torn) lost += torn.lost_constraints;
  EXPECT_LE(lost, 1);
  EXPECT_LT(distance_of(world, pair), 1.01);
}

/// Two halves of a cloth, welded along their border, are that cloth.
TEST(Weld, MakesOneOfTwoHalves) {
  ClothOptions options;
  options.material = fabric("cotton");
  options.bending_model = ClothOptions::Bending::none;
  const TriangleMesh whole_mesh = grid_mesh(5, 9, 0.2f, 0.4f), half = grid_mesh(5, 5, 0.2f, 0.2f);
  TriangleMesh mesh;
  for (const float z : {-0.1f, 0.1f}) {
    const int first = static_cast<int>(mesh.positions.size());
    for (const Vec3f& p : half.positions) mesh.positions.push_back(p + Vec3f{0, 0, z});
    for (const auto& [a, b, c] : half.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
  }
  const Object apart = make_cloth(mesh, options);
  const std::vector<int> above{20, 21, 22, 23, 24}, below{25, 26, 27, 28, 29};
  const std::vector<std::array<int, 2>> seam = nearest_pairs(apart, above, below);
  Object welded = weld(apart, seam).object, whole = make_cloth(whole_mesh, options);
  ASSERT_EQ(welded.positions.size(), 45u);
  EXPECT_EQ(welded.positions, whole.positions);
  for (std::size_t i = 0; i < 45; ++i) EXPECT_NEAR(welded.masses[i], whole.masses[i], 1e-7f);
  for (Object* object : {&welded, &whole}) {
    object->pins = {{0}, {4}};
    object->damping = 2;
  }
  World a(scene_of(welded, true)), b(scene_of(whole, true));
  run(a, 240);
  run(b, 240);
  const std::vector<Vec3f> x = a.object(0).positions(), y = b.object(0).positions();
  for (std::size_t i = 0; i < 45; ++i) EXPECT_LT(length_squared(x[i] - y[i]), 0.002f * 0.002f) << i;
}

TEST(Weld, MayFollowStitchesInAWorld) {
  Object object = panels();
  const std::vector<std::array<int, 2>> seam = seam_of(object);
  add_stitches(object, seam, {.closing_time = 0.5f});
  World world(scene_of(object, false));
  run(world, 60);
  world.edit(ObjectId(0), weld(object, seam));
  EXPECT_EQ(world.object(0).positions().size(), 45u);
  run(world, 120);
  const Stretch stretch = world.measure().stretch();
  EXPECT_LT(stretch.largest, 1.05f);  // rest lengths are those of both panels
}

TEST(Weld, LeavesWhatIsPinnedInPlace) {
  Object object = panels();
  const std::vector<std::array<int, 2>> seam = seam_of(object);
  object.masses[14] *= 2;  // of the other side
  object.pins = {{39}};
  const Object welded = weld(object, seam).object;
  ASSERT_EQ(welded.pins.size(), 1u);
  EXPECT_EQ(welded.positions[static_cast<std::size_t>(welded.pins[0].particle)], object.positions[39]);
}

TEST(Weld, JoinsSoftBodies) {
  TetrahedralMesh mesh = box_tetrahedra({0.1f, 0.1f, 0.1f}, {2, 2, 2});
  const TetrahedralMesh other = mesh;
  const int first = static_cast<int>(mesh.positions.size());
  for (const Vec3f& p : other.positions) mesh.positions.push_back(p + Vec3f{0, -0.1f, 0});
  for (const auto& [a, b, c, d] : other.tetrahedra)
    mesh.tetrahedra.push_back({a + first, b + first, c + first, d + first});
  const Object apart = make_soft_body(mesh, {.material = elastic_solid("rubber")});
  std::vector<int> low, high;
  for (int i = 0; i < first; ++i) {
    if (mesh.positions[static_cast<std::size_t>(i)].y < -0.049f) low.push_back(i);
    if (mesh.positions[static_cast<std::size_t>(i)].y > 0.049f) high.push_back(first + i);
  }
  Object bar = weld(apart, nearest_pairs(apart, low, high)).object;
  EXPECT_EQ(bar.positions.size(), apart.positions.size() - 9);
  EXPECT_EQ(tetrahedra_of(bar).size(), mesh.tetrahedra.size());
  for (std::size_t i = 0; i < bar.positions.size(); ++i)
    if (bar.positions[i].y > 0.049f) bar.pins.push_back({static_cast<int>(i)});
  World world(scene_of(bar, true));
  run(world, 60);
  for (const Vec3f& x : world.object(0).positions()) EXPECT_GT(x.y, -0.16f);
}

TEST(Weld, NamesWhatItCannotJoin) {
  const Object object = panels();
  const auto words = [&](std::array<int, 2> pair) { return refusal([&] { weld(object, std::span(&pair, 1)); }); };
  EXPECT_NE(words({0, 1}).find("become one"), std::string::npos) << words({0, 1});
  EXPECT_NE(words({0, 77}).find("particle 77"), std::string::npos);
  EXPECT_NE(words({3, 3}).find("twice"), std::string::npos);
  const std::vector<int> alone{3};
  EXPECT_NE(refusal([&] { nearest_pairs(object, alone, alone); }).find("no other"), std::string::npos);
}

}  // namespace
}  // namespace pliant
