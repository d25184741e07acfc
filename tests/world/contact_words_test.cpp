// Tests the messages of inspect(), World and Report about contact: invalid mesh colliders, thickness, initial
// intersections.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "pliant/pliant.h"

namespace pliant {
namespace {

std::string words_of(const Scene& scene) {
  std::string text;
  for (const Finding& finding : inspect(scene))
    text += (finding.grave ? "wrong: " : "doubtful: ") + finding.message + "; " + finding.advice + "\n";
  return text;
}

bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

Object colliding_sheet(const std::string& name, float height, bool upright = false) {
  TriangleMesh mesh = grid_mesh(5, 5, 1, 1);
  for (Vec3f& p : mesh.positions)
    p = upright ? Vec3f{p.x + 0.04f, p.z + height + 0.03f, 0.01f} : Vec3f{p.x, height, p.z};
  Object object = make_cloth(mesh);
  object.name = name;
  object.thickness = 0.01f;
  object.collides = true;
  return object;
}

Scene with_mesh(TriangleMesh mesh) {
  Scene scene;
  scene.add(colliding_sheet("sheet", 2));
  MeshCollider collider;
  collider.name = "rock";
  collider.mesh = std::move(mesh);
  scene.add(collider);
  return scene;
}

void expect_refused(const Scene& scene, const std::string& part) {
  const std::string words = words_of(scene);
  EXPECT_TRUE(says(words, "wrong: object 'rock'")) << words;
  EXPECT_TRUE(says(words, part)) << words;
  try {
    const World world(scene);
    ADD_FAILURE() << "not refused: " << part;
  } catch (const Error& error) {
    EXPECT_EQ(error.where().object, "rock");
    EXPECT_TRUE(says(error.what(), part)) << error.what();
  }
}

TEST(MeshColliders, ThatAreSoundAreTaken) { EXPECT_EQ(words_of(with_mesh(sphere_mesh(1))), ""); }

TEST(MeshColliders, ThatCannotBeAreRefusedByName) {
  expect_refused(with_mesh({}), "mesh: has no triangles");
  TriangleMesh mesh = sphere_mesh(0);
  mesh.positions[5].y = std::numeric_limits<float>::quiet_NaN();
  expect_refused(with_mesh(mesh), "vertex 5: has a position that is not finite");
  mesh = sphere_mesh(0);
  mesh.triangles[7][1] = 12;
  expect_refused(with_mesh(mesh), "triangle 7: uses a vertex that does not exist; there are 12");
  mesh.triangles[7][1] = -1;
  expect_refused(with_mesh(mesh), "triangle 7: uses a vertex that does not exist");
  mesh.triangles[7][1] = mesh.triangles[7][0];
  expect_refused(with_mesh(mesh), "triangle 7: uses a vertex twice");
  Scene scene = with_mesh(sphere_mesh(0));
  scene.mesh_colliders[0].thickness = -1;
  expect_refused(scene, "thickness: is -1");
  scene.mesh_colliders[0].thickness = 0;
  scene.mesh_colliders[0].static_friction = -1;
  expect_refused(scene, "static_friction");
}

TEST(Thickness, BeyondTheMedianEdgeIsDoubted) {
  Scene scene;
  scene.add(colliding_sheet("sheet", 0));
  scene.objects[0].collides = false;
  scene.objects[0].self_collision = true;
  EXPECT_EQ(words_of(scene), "");
  scene.objects[0].thickness = 0.15f;  // the edges are 0.25 and 0.354 long
  EXPECT_TRUE(says(words_of(scene),
                   "object 'sheet', thickness: is 0.15 m: two layers keep twice this distance, more than the "
                   "median edge, 0.25 m"))
      << words_of(scene);
  scene.objects[0].self_collision = false;
  EXPECT_FALSE(says(words_of(scene), "two layers")) << "nothing that moves is met";
  scene.objects[0].self_collision = true;
  scene.objects[0].thickness = 0;
  EXPECT_TRUE(says(words_of(scene), "thickness: is 0:"));
}

// Short links make a thick rope bend smoothly. A radius of ten links is a mistake of units.
TEST(Thickness, OfRopesMayBeMoreThanTheirLinks) {
  Scene scene;
  RopeOptions options;
  options.thickness = 0.15f;
  Object rope = make_rope({{0, 0, 0}, {0.1f, 0, 0}, {0.2f, 0, 0}}, options);
  rope.self_collision = true;
  scene.add(rope);
  EXPECT_EQ(words_of(scene), "");
  scene.objects[0].thickness = 1.1f;
  EXPECT_TRUE(says(words_of(scene), "thickness: is 1.1 m, more than the shortest edge, 0.1 m")) << words_of(scene);
}

/// A thickness of many edges makes frames expensive. inspect() must say so, and what to change, before the run.
TEST(Cost, OfAThicknessOfManyEdgesIsSaid) {
  Scene scene;
  Object cloth = make_cloth(grid_mesh(31, 31, 1, 1));
  cloth.name = "sheet";
  cloth.self_collision = true;
  cloth.thickness = 0.3f / 30;
  scene.add(cloth);
  EXPECT_FALSE(says(words_of(scene), "million pairs")) << words_of(scene);
  scene.objects[0].thickness = 3.f / 30;  // two layers keep six edges: expensive, but possible
  const std::string dear = words_of(scene);
  EXPECT_TRUE(says(dear, "doubtful: object 'sheet', thickness: is 0.1 m: about ")) << dear;
  EXPECT_TRUE(
      says(dear, "times as many as usual, and a frame takes longer by the same factor; reduce it to about 0.02"))
      << dear;
  scene.objects[0].thickness =
      4.5f / 30;  // two layers keep nine edges: 1.33 million pairs were counted at 30 x 30 vertices, 1480 per vertex
  const std::string refused = words_of(scene);
  EXPECT_TRUE(says(refused, "wrong: object 'sheet', thickness: is 0.15 m, and the median edge is 0.0333 m")) << refused;
}

TEST(Cost, OfAMeshThatIsFineInOnePlaceIsSaid) {
  Scene scene;
  TriangleMesh mesh = grid_mesh(31, 31, 1, 1);
  for (Vec3f& p : mesh.positions) {  // nearly the whole mesh within a centimetre
    p.x *= std::fabs(p.x) < 0.45f ? 0.02f : 1;
    p.z *= std::fabs(p.z) < 0.45f ? 0.02f : 1;
  }
  Object cloth = make_cloth(mesh);
  cloth.self_collision = true;
  cloth.thickness = 0.01f;
  scene.add(cloth);
  EXPECT_TRUE(says(words_of(scene), "contact would test about 3692 pairs per vertex")) << words_of(scene);
}

TEST(Start, NearerThanTheTwoKeepIsDoubted) {
  Scene scene;
  scene.add(colliding_sheet("shirt", 1));
  scene.add(colliding_sheet("coat", 1.005f));
  const std::string text = words_of(scene);
  EXPECT_TRUE(
      says(text,
           "object 'shirt', particle 0 and 24 more: starts nearer to object 'coat' than the 0.02 m that the two "
           "keep, the nearest 0.005"))
      << text;
  EXPECT_FALSE(says(text, "object 'coat', particle")) << "told once:\n" << text;
  scene.pairs.push_back({"coat", "shirt", 0.004f, std::nullopt, std::nullopt, std::nullopt});
  EXPECT_FALSE(says(words_of(scene), "starts nearer")) << words_of(scene);
  scene.pairs.clear();
  scene.objects[1] = colliding_sheet("coat", 1.02f);
  EXPECT_FALSE(says(words_of(scene), "starts nearer")) << "just so far apart:\n" << words_of(scene);
}

TEST(Start, InsideOfAClosedColliderIsDoubted) {
  Scene scene = with_mesh(sphere_mesh(2));
  EXPECT_FALSE(says(words_of(scene), "is inside of")) << words_of(scene);
  for (Vec3f& p : scene.objects[0].positions) p = p * 0.2f - Vec3f{0, 0.4f, 0};
  EXPECT_TRUE(says(words_of(scene),
                   "doubtful: object 'sheet', particle 0 and 24 more: is inside of closed collider 'rock' at the "
                   "start; move one of them, or set initial_intersections to \"untangle\""))
      << words_of(scene);
  scene.settings.initial_intersections = Settings::Intersections::untangle;
  EXPECT_TRUE(says(words_of(scene), "it will be moved out at untangling_speed")) << words_of(scene);
}

/// No warning if the object can meet another object or a mesh collider.
TEST(Company, WhatCollidesWithNobodyIsDoubted) {
  Scene scene;
  for (int i = 0; i < 2; ++i) {
    ClothOptions options;
    options.name = i == 0 ? "shirt" : "trousers";
    Object cloth = make_cloth(grid_mesh(4, 4, 1, 1), options);
    for (Vec3f& p : cloth.positions) p.y += static_cast<float>(i);
    cloth.thickness = 0.01f;
    scene.add(cloth);
  }
  const auto doubts = [&] {
    int count = 0;
    for (const Finding& found : inspect(scene))
      count += found.message.find("can collide with no other object or mesh collider") != std::string::npos ? 1 : 0;
    return count;
  };
  EXPECT_EQ(doubts(), 0) << "neither collides";
  scene.objects[0].collides = true;
  EXPECT_EQ(doubts(), 1);
  scene.objects[1].collides = true;
  EXPECT_EQ(doubts(), 0);
  scene.objects[1].mask = 2;
  EXPECT_EQ(doubts(), 2) << "masks keep them apart";
  MeshCollider body;
  body.mesh = sphere_mesh(1);
  for (Vec3f& p : body.mesh.positions) p.y -= 5;
  scene.add(body);
  EXPECT_EQ(doubts(), 1) << "the mesh is in group 1";
  scene.mesh_colliders[0].as = MeshCollider::As::distance_grid;
  EXPECT_EQ(doubts(), 2) << "solids are met by particles, whether they collide or not";
}

TEST(Thickness, ParticlesWithoutTrianglesAndLinksAreNamed) {
  Scene scene;
  Object dust;
  dust.name = "dust";
  dust.positions = {{0, 0, 0}, {1, 0, 0}};
  dust.masses = {1, 1};
  dust.collides = true;
  scene.add(dust);
  EXPECT_TRUE(says(words_of(scene), "object 'dust': has neither triangles nor links")) << words_of(scene);
}

TEST(Tangles, AreNamedBeforeAnythingMoves) {
  Scene scene;
  scene.add(colliding_sheet("table", 0));
  scene.add(colliding_sheet("wall", 0, true));
  const std::string words = words_of(scene);
  EXPECT_TRUE(says(words, "object 'table', edge ")) << words;
  EXPECT_TRUE(says(words, ") of object 'wall' at the start, one of ")) << words;
  EXPECT_EQ(std::count(words.begin(), words.end(), '\n'), 1) << "one finding a pair of objects: " << words;
  scene.objects[1].collides = false;
  EXPECT_FALSE(says(words_of(scene), "edge ")) << "they do not meet";
  scene.objects[1].collides = true;
  scene.objects[1].mask = 2;
  EXPECT_FALSE(says(words_of(scene), "edge ")) << "their masks keep them apart";
}

/// The warning must name an edge and a triangle that do intersect.
TEST(Tangles, AreNamedInTheReport) {
  Scene scene;
  scene.add(colliding_sheet("table", 0));
  scene.add(colliding_sheet("wall", 0, true));
  scene.settings.threads = 1;
  World world(scene);
  const Report report = world.step(1.f / 600);
  EXPECT_GT(report.pairs.initially_intersecting, 0);
  ASSERT_EQ(report.warnings.size(), 1U);
  const std::string& text = report.warnings[0];
  EXPECT_TRUE(says(text, "object 'table': edge ") || says(text, "object 'wall': edge ")) << text;
  EXPECT_TRUE(says(text, "have intersected since the start or a tear, and have no contact until they are apart"))
      << text;
  int a = 0, b = 0, c = 0, d = 0, e = 0;
  const std::size_t at = text.find("edge ");
  ASSERT_EQ(std::sscanf(text.c_str() + at, "edge %d-%d passes through triangle (%d, %d, %d)", &a, &b, &c, &d, &e), 5)
      << text;
  const bool first_is_table = text.find("object 'table'") < text.find("object 'wall'");
  const std::vector<Vec3f>&edges = scene.objects[first_is_table ? 0 : 1].positions,
        &faces = scene.objects[first_is_table ? 1 : 0].positions;
  const auto side = [&](int v) {
    const Vec3f p = faces[c], n = cross(faces[d] - p, faces[e] - p);
    return dot(n, edges[v] - p);
  };
  EXPECT_LT(side(a) * side(b), 0) << text;
}

TEST(Tangles, WithColliderNameThem) {
  Scene scene = with_mesh(sphere_mesh(1));
  for (Vec3f& p : scene.mesh_colliders[0].mesh.positions) p.y += 2;  // a ball of radius 1 around the sheet of width 1
  for (Vec3f& p : scene.objects[0].positions) p = p + Vec3f{0.9f, 0.013f, 0.017f};
  EXPECT_TRUE(says(words_of(scene), "collider 'rock'") || says(words_of(scene), "object 'rock', edge"))
      << words_of(scene);
  World world(scene);
  const Report report = world.step(1.f / 600);
  ASSERT_FALSE(report.warnings.empty());
  EXPECT_TRUE(says(report.warnings[0], "collider 'rock'")) << report.warnings[0];
}

TEST(Tangles, OfWhatDoesNotMeetAreNone) {
  Scene scene;
  scene.add(colliding_sheet("table", 0));
  scene.add(colliding_sheet("wall", 0, true));
  scene.objects[1].collides = false;
  scene.objects[0].self_collision = true;
  World world(scene);
  const Report report = world.step(1.f / 600);
  EXPECT_EQ(report.pairs.initially_intersecting, 0);
  EXPECT_TRUE(report.warnings.empty());
}

/// Two walls close on a sheet until there is no room for it.
TEST(Unresolvable, PinchesAreSaid) {
  Scene scene;
  scene.gravity = {};
  scene.add(colliding_sheet("sheet", 0));
  for (const float sign : {-1.f, 1.f}) {
    MeshCollider wall;
    wall.name = sign < 0 ? "floor" : "ceiling";
    wall.mesh = grid_mesh(3, 3, 2, 2);
    for (Vec3f& p : wall.mesh.positions) p.y = sign * 0.1f;
    wall.motion.keyframes = {{0, {}, {}}, {0.2f, {0, -sign * 0.12f, 0}, {}}};
    scene.add(wall);
  }
  World world(scene);
  std::string words;
  for (int frame = 0; frame < 15; ++frame) {
    const Report report = world.step(1.f / 60);
    ASSERT_TRUE(report.ok()) << report.explain();
    EXPECT_EQ(report.pairs.unresolvable > 0, says(report.explain(), "unresolvable"));
    words += report.explain();
  }
  EXPECT_TRUE(says(words, "object 'sheet' and collider 'floor': ") ||
              says(words, "collider 'floor' and object 'sheet': "))
      << words;
  EXPECT_TRUE(says(words, "unresolvable in this frame: no step limit keeps them apart")) << words;
  EXPECT_TRUE(says(words, "may pass through one another; give them more room")) << words;
}

/// The bending of a rope consists of distance constraints too, but these are no lines that could touch anything.
TEST(Ropes, DoNotTouchTheirOwnBending) {
  Scene scene;
  scene.gravity = {};
  RopeOptions options;
  options.bends = true;
  options.thickness = 0.003f;
  std::vector<Vec3f> points;
  for (int i = 0; i < 12; ++i) points.push_back({0.01f * static_cast<float>(i), 0, 0});
  Object rope = make_rope(points, options);
  rope.self_collision = true;
  rope.velocities.assign(points.size(), {0, 1, 0});
  scene.add(rope);
  World world(scene);
  for (int frame = 0; frame < 10; ++frame) {
    const Report report = world.step(1.f / 60);
    EXPECT_EQ(report.pairs.contacts, 0);
    EXPECT_EQ(report.pairs.truncated, 0);
    EXPECT_EQ(report.pairs.unresolvable, 0);
  }
}

TEST(MeshColliders, SayWhereTheyAre) {
  Scene scene = with_mesh(sphere_mesh(1));
  scene.mesh_colliders[0].motion.keyframes = {{0, {}, {}}, {1, {0, 0, -1}, {}}};
  World world(scene);
  EXPECT_EQ(world.mesh_collider(0).positions(), scene.mesh_colliders[0].mesh.positions);
  for (int frame = 0; frame < 30; ++frame) (void)world.step(1.f / 60);
  const std::vector<Vec3f> moved = world.mesh_collider(0).positions();
  for (std::size_t i = 0; i < moved.size(); ++i)
    EXPECT_LE(length_squared(moved[i] - scene.mesh_colliders[0].mesh.positions[i] - Vec3f{0, 0, -0.5f}), 1e-10f) << i;
  EXPECT_THROW((void)world.mesh_collider(1).positions(), Error);
  EXPECT_THROW((void)world.mesh_collider(-1).positions(), Error);
  EXPECT_EQ(world.object_count(), 1);
}

}  // namespace
}  // namespace pliant
