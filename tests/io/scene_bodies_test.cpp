// Tests rigid bodies in scene files: every field, copies, and what is refused.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <vector>

#include "pliant/body.h"
#include "scene_support.h"

namespace pliant {
namespace {

/// The object "heap" of the scene that has every field.
class Heap : public testing::Test {
 protected:
  const Scene scene = parse_scene(test::full_scene(), "every_field.json", ".");
  const Object& heap = scene.objects.at(7);
};

float distance(const Vec3f& a, const Vec3f& b) { return std::sqrt(length_squared(a - b)); }

/// The first body of a name that begins so.
std::size_t body_named(const Object& object, const std::string& start) {
  std::size_t i = 0;
  while (i < object.bodies.size() && object.bodies[i].name.rfind(start, 0) != 0) ++i;
  return i;
}

/// Without a velocity of its own a body has the object's, as the format's table says.
TEST(SceneBodies, HaveTheVelocityOfTheObjectUnlessTheyHaveTheirOwn) {
  const Scene scene = parse_scene(R"({"objects": [{"velocity": [1, 0, 0], "bodies": [
      {"name": "own", "solids": [{"sphere": {}}], "velocity": [0, 1, 0], "repeat": {"grid": {"counts": [2, 1, 1], "spacing": [5, 5, 5]}}},
      {"name": "rests", "solids": [{"sphere": {}}], "position": [0, 3, 0], "velocity": [0, 0, 0]},
      {"name": "fixed", "solids": [{"sphere": {}}], "position": [0, 6, 0], "mass": "fixed"},
      {"name": "follows", "solids": [{"sphere": {}}], "position": [0, 9, 0]}],
      "parts": [{"rope": {"points": [[0, 20, 0], [1, 20, 0]]}}]}]})",
                                  "x.json", ".");
  const Vec3f own{0, 1, 0}, rests{}, objects{1, 0, 0};
  EXPECT_EQ(scene.objects[0].velocities, (std::vector<Vec3f>{own, own, rests, rests, objects, objects, objects}));
  EXPECT_NE(
      test::scene_message(R"({"objects": [{"velocity": [1, 0, 0], "bodies": [{"solids": [{"sphere": {}}]}], "parts": [
      {"particles": {"positions": [[0, 9, 0]], "masses": 1, "velocities": [[0, 0, 1]]}}]}]})")
          .find("/objects/0/velocity: this object already has a velocity per particle"),
      std::string::npos);
}

TEST_F(Heap, HasItsProperties) {
  EXPECT_EQ(heap.name, "heap");
  EXPECT_EQ(heap.bodies.size(), 5U + 6 + 5 + 40);
  EXPECT_EQ(heap.positions.size(), heap.bodies.size() + 5 + 4 + 1) << "and those of its parts";
  EXPECT_EQ(heap.thickness, 0.25f);
  EXPECT_EQ(heap.static_friction, 0.75f);
  EXPECT_EQ(heap.kinetic_friction, 0.5f);
  EXPECT_EQ(heap.restitution, 0.125f);
  EXPECT_EQ(heap.rolling_friction, 0.5f);
  EXPECT_EQ(heap.spinning_friction, 0.75f);
  EXPECT_EQ(heap.groups, 8U);
  EXPECT_EQ(heap.mask, 8U);
  EXPECT_EQ(heap.colour, (Vec3f{0.125f, 0.25f, 0.5f}));
  EXPECT_TRUE(heap.collides);
  EXPECT_TRUE(heap.self_collision);
}

/// The constraint group of a type and compliance.
const ConstraintGroup& group_of(const Object& object, const std::string& type, float compliance) {
  for (const ConstraintGroup& group : object.constraints)
    if (group.type == type && group.stiffness.value == compliance) return group;
  throw std::runtime_error("no group of " + type);
}

TEST_F(Heap, HasAConcaveSolidInPieces) {
  ASSERT_EQ(heap.bodies[4].solids.size(), 3U) << "a box is one piece";
  const Solid& piece = heap.bodies[4].solids[2];
  EXPECT_EQ(std::get<Hull>(piece.shape).points.size(), 8U);
  EXPECT_FLOAT_EQ(piece.density, 500);
}

/// A body of one mesh has the mesh's inertia: that of a box of 2 x 1 x 1 m and 1 t, or of a given mass.
TEST(SceneBodies, OfOneConcaveSolidHaveItsInertia) {
  const std::string start = R"({"objects": [{"bodies": [{"solids": [{"concave": {"mesh": {"box": {"size": [2, 1, 1]}}},
    "density": 500}])";
  const Object by_density = parse_scene(start + "}]}]}", "x.json", ".").objects.at(0),
               by_mass = parse_scene(start + R"(, "mass": 12}]}]})", "x.json", ".").objects.at(0);
  const auto largest = [](const Vec3f& v) { return std::max({v.x, v.y, v.z}); };
  EXPECT_NEAR(by_density.masses[0], 1000, 1e-3);
  EXPECT_NEAR(largest(by_density.frames[0].inertia), 1000 * 5. / 12, 1e-2);
  EXPECT_NEAR(by_mass.masses[0], 12, 1e-5);
  EXPECT_NEAR(largest(by_mass.frames[0].inertia), 12 * 5. / 12, 1e-4);
}

TEST_F(Heap, HasPartsThatAreTiedToItsBodies) {
  const int first = static_cast<int>(heap.bodies.size());
  EXPECT_EQ(heap.positions.at(std::size_t(first) + 4), (Vec3f{0, 4, 0}));
  ASSERT_EQ(heap.pins.size(), 1U);
  EXPECT_EQ(heap.pins[0].particle, first);
  ASSERT_EQ(heap.attachments.size(), 4U);
  EXPECT_EQ(heap.attachments[0].particle, first + 5);
  EXPECT_EQ(heap.attachments[0].target, heap.positions.at(std::size_t(first) + 5));
  const ObjectBody &hammer = heap.bodies[0], &shard = heap.bodies[4];
  EXPECT_EQ(group_of(heap, "body_anchor", 0.5f).particles,
            (std::vector<int>{hammer.particle, hammer.frame, first + 4}));
  EXPECT_EQ(group_of(heap, "body_anchor", 0).particles, (std::vector<int>{shard.particle, shard.frame, first + 9}));
  EXPECT_EQ(heap.triangles.size(), 2U);
}

TEST_F(Heap, HasTheBodyThatTheSameOptionsMake) {
  BodyOptions options;
  options.name = "hammer";
  options.position = {0, 4, 0};
  options.rotation = rotation({0, 0, 1}, 90);
  options.velocity = {1, 2, 3};
  options.angular_velocity = {4, 5, 6};
  options.mass = 3;
  const Box box{{0.5f, 0.5f, 0.5f}};
  const Object same = make_body({{box, {-1, 0, 0}, {}, 100}, {box, {1, 0, 0}, rotation({0, 1, 0}, 90), 300}}, options);
  EXPECT_EQ(heap.bodies[0].name, "hammer");
  EXPECT_EQ(heap.positions[0], same.positions[0]);
  EXPECT_EQ(heap.velocities[0], same.velocities[0]);
  EXPECT_EQ(heap.masses[0], 3.f);
  EXPECT_EQ(heap.frames[0].orientation, same.frames[0].orientation);
  EXPECT_EQ(heap.frames[0].angular_velocity, same.frames[0].angular_velocity);
  EXPECT_EQ(heap.frames[0].inertia, same.frames[0].inertia);
  EXPECT_EQ(heap.bodies[0].solids.size(), 2U);
  EXPECT_EQ(heap.bodies[0].solids[1].position, same.bodies[0].solids[1].position);
}

/// The body "lift" of the object "rig" of the same scene.
TEST_F(Heap, HasAKinematicBodyAsTheSameOptionsMakeIt) {
  const Object& rig = scene.objects.at(8);
  BodyOptions options;
  options.name = "lift";
  options.position = {0, 40, 0};
  options.kinematic = true;
  options.motion = {{{0}, {1, {0, 1, 0}, rotation({0, 1, 0}, 90)}}, {1, 40, 0}};
  const Object same = make_body({{Box{}}}, options);
  const ObjectBody& lift = rig.bodies.at(14);
  EXPECT_EQ(lift.name, "lift");
  ASSERT_EQ(rig.pins.size(), 1U);
  EXPECT_EQ(rig.pins[0].particle, lift.particle);
  EXPECT_EQ(rig.pins[0].motion.pivot, same.pins.at(0).motion.pivot);
  ASSERT_EQ(rig.pins[0].motion.keyframes.size(), 2U);
  EXPECT_EQ(rig.pins[0].motion.keyframes[1].position, (Vec3f{0, 1, 0}));
  EXPECT_EQ(rig.pins[0].motion.keyframes[1].rotation, same.pins.at(0).motion.keyframes[1].rotation);
  EXPECT_EQ(lift.surface_velocity, (Vec3f{0, 0, 3}));
  EXPECT_TRUE(std::isinf(rig.masses.at(static_cast<std::size_t>(lift.particle))));
  EXPECT_TRUE(std::isinf(rig.frames.at(static_cast<std::size_t>(lift.frame)).inertia.y));
}

TEST_F(Heap, HasEveryShape) {
  EXPECT_EQ(std::get<Sphere>(heap.bodies[1].solids.at(0).shape).radius, 0.25f);
  EXPECT_EQ(heap.bodies[1].name, "body");
  EXPECT_TRUE(std::isinf(heap.masses[1]));
  EXPECT_EQ(heap.bodies[2].name, "body_2");
  EXPECT_EQ(std::get<Capsule>(heap.bodies[2].solids.at(0).shape).half_length, 1.f);
  EXPECT_EQ(std::get<Capsule>(heap.bodies[2].solids.at(0).shape).radius, 0.5f);
  EXPECT_EQ(std::get<Cylinder>(heap.bodies[2].solids.at(1).shape).half_length, 2.f);
  EXPECT_EQ(std::get<Cone>(heap.bodies[3].solids.at(0).shape).half_length, 3.f);
  const Hull& shard = std::get<Hull>(heap.bodies[4].solids.at(0).shape);
  EXPECT_EQ(shard.points.size(), 4U);
  EXPECT_EQ(shard.margin, 0.125f);
  EXPECT_EQ(std::get<Hull>(heap.bodies[4].solids.at(1).shape).points.size(), 8U) << "the corners of the mesh alone";
}

TEST_F(Heap, HasAGridOfTumbledCopies) {
  const std::size_t first = body_named(heap, "brick");
  float turned = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(heap.bodies[first + i].name, "brick_" + std::to_string(i));
    const auto x = static_cast<float>(i % 2), y = static_cast<float>(i / 2);
    const Vec3f away = heap.positions[first + i] - Vec3f{10 + 2 * x, y, 0};
    EXPECT_LE(std::fmax(std::fabs(away.x), std::fmax(std::fabs(away.y), std::fabs(away.z))), 0.125f);
    EXPECT_GT(length_squared(away), 0);
    turned += 1 - std::fabs(heap.frames[first + i].orientation.w);
  }
  EXPECT_GT(turned, 0.5f);
}

TEST_F(Heap, HasAPyramid) {
  const std::size_t first = body_named(heap, "layer");
  const std::vector<Vec3f> expected{
      {19.25f, 0.5f, -0.75f}, {20.75f, 0.5f, -0.75f}, {19.25f, 0.5f, 0.75f}, {20.75f, 0.5f, 0.75f}, {20, 1.5f, 0}};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(heap.positions[first + i], expected[i]) << i;
  EXPECT_EQ(heap.bodies[first + 5].name, "domino_0");
}

TEST_F(Heap, HasASpiralWhoseCopiesFaceAlongIt) {
  const std::size_t first = body_named(heap, "domino");
  double turned = 0;
  for (std::size_t i = 0; i + 1 < 40; ++i) {
    const Vec3f here = heap.positions[first + i], next = heap.positions[first + i + 1];
    EXPECT_NEAR(distance(here, next), 2, 0.1) << i;
    const Vec3f ahead = (next - here) * (1 / distance(here, next)), back{0, 0, -1};
    const Quatf& q = heap.frames[first + i].orientation;
    const Vec3f axis{q.x, q.y, q.z}, half = cross(axis, back), faces = back + (q.w * half + cross(axis, half)) * 2.f;
    EXPECT_GT(dot(faces, ahead), 0.97f) << i;
    turned += 2 / std::hypot(here.x - 40, here.z);
  }
  const double pitch = 3, radius = std::hypot(heap.positions[first + 39].x - 40, heap.positions[first + 39].z);
  EXPECT_NEAR(radius, 5 + pitch * turned / 6.28318531, 0.1);
}

// ------------------------------------------------------------------------------------------------ other

std::string bodies(const std::string& list, const std::string& members = "") {
  return "{\"objects\": [{\"bodies\": [\n" + list + "]" + members + "}]}";
}

TEST(SceneBodies, AreNamedInErrors) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {R"({"name": "flat", "solids": [{"sphere": {}}, {"hull": {"points": [[0,0,0],[1,0,0],[0,1,0],[1,1,0]]}}]})",
       "x.json:2:1: object 'bodies', /objects/0/bodies/0, body 'flat', solid 1: has 4 points, all in one plane"},
      {R"({"name": "pill", "solids": [{"capsule": {"half_length": 0}}]})",
       "x.json:2:1: object 'bodies', /objects/0/bodies/0, body 'pill', solid 0: half_length is 0"},
      {R"({"name": "a", "solids": [{"box": {}}]}, {"name": "a", "solids": [{"box": {}}]})",
       "/objects/0/bodies/1/name: the name 'a' is taken"},
      {R"({"name": "a_1", "solids": [{"box": {}}]},
          {"name": "a", "solids": [{"box": {}}], "repeat": {"grid": {"counts": [2, 1, 1], "spacing": [2, 0, 0]}}})",
       "/objects/0/bodies/1/name: the name 'a_1' is taken"},
      {R"({"solids": [{"box": {}}], "mass": "fixed", "velocity": [1, 0, 0]})",
       "/objects/0/bodies/0/velocity: a fixed body has no velocity; remove it, or give the body a mass"},
      {R"({"solids": [{"box": {}}], "kinematic": true, "velocity": [1, 0, 0]})",
       "/objects/0/bodies/0/velocity: a kinematic body has the velocity of its motion; remove it, or give a motion"},
      {R"({"solids": [{"box": {}}], "kinematic": true, "mass": 3})",
       "/objects/0/bodies/0/mass: a kinematic body has infinite mass; remove the mass, or \"kinematic\""},
      {R"({"solids": [{"box": {}}], "motion": {"keyframes": [{"time": 0}]}})",
       "/objects/0/bodies/0/motion: only a kinematic body follows a motion; add \"kinematic\": true"},
      {R"({"solids": [{"box": {}}], "repeat": {"grid": {"counts": [1024, 1024, 2], "spacing": [2, 2, 2]}}})",
       "/objects/0/bodies/0/repeat/grid: more than 1048576 copies of a body; make fewer"},
      {R"({"solids": []})", "/objects/0/bodies/0/solids: "},
      {R"({"solids": [{"density": 3}]})", "the kind of this solid is missing"},
      {R"({"solids": [{"box": {"half_extents": [1, 0, 1]}}]})", "/objects/0/bodies/0/solids/0/box/half_extents/1: "}};
  for (const auto& [list, message] : cases) {
    const std::string found = test::scene_message(bodies(list));
    EXPECT_NE(found.find(message), std::string::npos) << list << "\n" << found;
  }
  EXPECT_NE(test::scene_message(bodies("")).find("/objects/0/bodies: "), std::string::npos);
}

TEST(SceneBodies, TakeTheVelocityOfTheirObjectUnlessTheyAreFixed) {
  const Scene scene = parse_scene(bodies(R"({"solids": [{"box": {}}]}, {"solids": [{"box": {}}], "mass": "fixed"})",
                                         R"(, "velocity": [0, 0, 7], "collides": false, "self_collision": false)"),
                                  "x.json", ".");
  EXPECT_EQ(scene.objects[0].name, "bodies");
  EXPECT_EQ(scene.objects[0].velocities, (std::vector<Vec3f>{{0, 0, 7}, {0, 0, 0}}));
  EXPECT_FALSE(scene.objects[0].collides);
  EXPECT_FALSE(scene.objects[0].self_collision);
}

TEST(SceneBodies, OfOneSeedAreTheSame) {
  const auto heap = [](const std::string& seed) {
    const std::string grid = R"({"counts": [3, 3, 3], "spacing": [2, 2, 2], "jitter": 0.5, "tumbled": true, "seed": )";
    return parse_scene(bodies(R"({"solids": [{"box": {}}], "repeat": {"grid": )" + grid + seed + "}}}"), "x.json", ".")
        .objects[0];
  };
  const Object a = heap("1"), b = heap("1"), c = heap("2");
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_NE(a.positions, c.positions);
  EXPECT_EQ(a.frames[13].orientation, b.frames[13].orientation);
}

TEST(SceneBodies, AreHullsOfMeshFiles) {
  std::string folder = testing::TempDir() + "/pliant_hull_XXXXXX";
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  // A tetrahedron with a dent: its fifth vertex lies inside.
  std::ofstream(folder + "/a.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0.2 0.2 0.2\n"
                                   << "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 5\nf 3 4 5\nf 4 2 5\n";
  const Scene scene = parse_scene(
      bodies(R"({"solids": [{"hull": {"mesh": {"file": "a.obj", "scale": 6}}, "density": 1}]})"), "x.json", folder);
  EXPECT_EQ(std::get<Hull>(scene.objects[0].bodies[0].solids[0].shape).points.size(), 4U);
  EXPECT_NEAR(scene.objects[0].masses[0], 36, 1e-3);
  std::filesystem::remove_all(folder);
}

TEST(SceneBodies, NameTheFileOfAnOpenMesh) {
  std::string folder = testing::TempDir() + "/pliant_open_XXXXXX";
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  std::ofstream(folder + "/open.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n";
  const auto message = [&](const std::string& body) {
    try {
      (void)parse_scene(bodies(body), "x.json", folder);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string text = message(R"({"name": "chair", "solids": [{"concave": {"mesh": {"file": "open.obj"}}}]})");
  EXPECT_NE(text.find("object 'bodies', /objects/0/bodies/0, body 'chair', mesh 'open.obj', edge "), std::string::npos)
      << text;
  EXPECT_NE(text.find("the mesh is not closed"), std::string::npos) << text;
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace pliant
