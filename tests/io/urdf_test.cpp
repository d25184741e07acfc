// Tests the reader of robot descriptions: bodies, poses, inertia, joints, and what is named as unsupported or refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "pliant/body.h"
#include "pliant/error.h"
#include "pliant/io.h"
#include "pliant/joint.h"
#include "support/paths.h"
#include "write_support.h"

namespace pliant {
namespace {

constexpr const char* arm_path = PLIANT_SOURCE_DIR "/tests/io/arm.urdf";

/// Skips where the library was built without an XML reader.
class Urdf : public testing::Test {
 protected:
  void SetUp() override {
    try {
      static_cast<void>(read_urdf(arm_path));
    } catch (const Error& error) {
      if (error.problem().find("no XML reader") != std::string::npos) GTEST_SKIP() << error.what();
      throw;
    }
  }

  static const ObjectBody& body(const Object& object, const std::string& name) {
    for (const ObjectBody& one : object.bodies)
      if (one.name == name) return one;
    ADD_FAILURE() << "no body " << name;
    return object.bodies[0];
  }
  static const ObjectJoint& joint(const Object& object, const std::string& name) {
    for (const ObjectJoint& one : object.joints)
      if (one.name == name) return one;
    ADD_FAILURE() << "no joint " << name;
    return object.joints[0];
  }
  static Vec3f centre(const Object& object, const std::string& name) {
    return object.positions[static_cast<std::size_t>(body(object, name).particle)];
  }
  static void expect_near(const Vec3f& a, const Vec3f& b) {
    EXPECT_NEAR(a.x, b.x, 1e-5);
    EXPECT_NEAR(a.y, b.y, 1e-5);
    EXPECT_NEAR(a.z, b.z, 1e-5);
  }

  /// The error that a robot of these elements causes.
  static std::string refused(const std::string& elements) {
    const test::Folder folder;
    test::put(folder / "a.urdf", "<robot name=\"r\">\n" + elements + "</robot>\n");
    try {
      static_cast<void>(read_urdf(folder / "a.urdf"));
    } catch (const Error& error) {
      return std::string(error.what()).substr(folder.path().size() + 1);
    }
    return {};
  }
};

TEST_F(Urdf, MakesABodyOfEachLinkWithMassOrShape) {
  const Object arm = read_urdf(arm_path);
  EXPECT_EQ(arm.name, "arm");
  std::vector<std::string> names;
  for (const ObjectBody& one : arm.bodies) names.push_back(one.name);
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"base", "camera", "finger", "upper", "wheel", "world"}));
  EXPECT_FLOAT_EQ(arm.masses[static_cast<std::size_t>(body(arm, "base").particle)], 4);
  EXPECT_TRUE(std::isinf(arm.masses[static_cast<std::size_t>(body(arm, "world").particle)]));
  EXPECT_NEAR(arm.masses[static_cast<std::size_t>(body(arm, "finger").particle)], 4.18879, 1e-4) << "at 1000 kg/m^3";
  EXPECT_FALSE(arm.self_collision);
  EXPECT_NEAR(arm.colour.x, 0.64f, 1e-5);
}

TEST_F(Urdf, PutsLinksWhereTheirJointsSayWithYUp) {
  const Object arm = read_urdf(arm_path);
  // (x, y, z) of the file is (x, z, -y) here.
  expect_near(centre(arm, "base"), {0, 1.05f, 0});
  expect_near(centre(arm, "upper"), {0, 1.1f, 0});
  expect_near(centre(arm, "camera"), {0, 1, -3});
  // The shoulder turns by 90 degrees about the vertical: the finger's y points along -x.
  expect_near(centre(arm, "finger"), {-0.2f, 1.6f, 0});
  UrdfOptions options;
  options.z_up = false;
  options.position = {10, 0, 0};
  expect_near(centre(read_urdf(arm_path, options), "base"), {10, 0, 1.05f});
}

TEST_F(Urdf, HasTheInertiaOfTheFile) {
  const Object arm = read_urdf(arm_path);
  const Vec3f base = arm.frames[static_cast<std::size_t>(body(arm, "base").frame)].inertia;
  EXPECT_NEAR(base.x + base.y + base.z, 0.09, 1e-6);
  // The upper link's inertia is turned by 90 degrees about z: Ixx and Iyy change places, as an oracle with the world's axes.
  const ObjectFrame& frame = arm.frames[static_cast<std::size_t>(body(arm, "upper").frame)];
  const auto about = [&](const Vec3f& world) {  // n . I n
    const Quatf q{-frame.orientation.x, -frame.orientation.y, -frame.orientation.z, frame.orientation.w};
    const Vec3f axis{q.x, q.y, q.z}, half = cross(axis, world), n = world + (q.w * half + cross(axis, half)) * 2.f;
    return n.x * n.x * frame.inertia.x + n.y * n.y * frame.inertia.y + n.z * n.z * frame.inertia.z;
  };
  EXPECT_NEAR(about({0, 1, 0}), 0.25, 1e-5) << "the file's z is up";
  EXPECT_NEAR(about({1, 0, 0}), 0.1, 1e-5) << "turned by the shoulder and by the inertial frame, x is x again";
  EXPECT_NEAR(about({0, 0, 1}), 0.2, 1e-5);
}

TEST_F(Urdf, HasTheShapesOfTheFile) {
  const test::Folder folder;
  std::filesystem::create_directory(folder / "arm");
  std::filesystem::copy_file(arm_path, folder / "arm/arm.urdf");
  test::put(folder / "arm/tetra.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  std::vector<std::string> warnings;
  const Object arm = read_urdf(folder / "arm/arm.urdf", {}, &warnings);
  ASSERT_EQ(body(arm, "wheel").solids.size(), 1U);
  const Hull& hull = std::get<Hull>(body(arm, "wheel").solids[0].shape);
  EXPECT_EQ(hull.points.size(), 4U);
  float largest = 0;
  for (const Vec3f& p : hull.points) largest = std::max({largest, p.x, p.y, p.z});
  EXPECT_EQ(largest, 2) << "scaled";
  EXPECT_EQ(std::get<Box>(body(arm, "upper").solids.at(0).shape).half_extents, (Vec3f{0.05f, 0.1f, 0.3f})) << "visual";
  ASSERT_EQ(body(arm, "base").solids.size(), 1U) << "collision alone";
  EXPECT_EQ(std::get<Cylinder>(body(arm, "base").solids[0].shape).half_length, 0.05f);
  // The cylinder stands upright: its y-axis is the file's z, which is up.
  const TriangleMesh mesh = mesh_of(body(arm, "base").solids);
  const Quatf q = arm.frames[static_cast<std::size_t>(body(arm, "base").frame)].orientation;
  for (const Vec3f& p : mesh.positions) {
    const Vec3f axis{q.x, q.y, q.z}, half = cross(axis, p), n = p + (q.w * half + cross(axis, half)) * 2.f;
    EXPECT_NEAR(std::fabs(n.y), 0.05, 1e-5);
  }
}

TEST_F(Urdf, HasTheJointsOfTheFile) {
  const Object arm = read_urdf(arm_path);
  EXPECT_EQ(joint(arm, "mount").kind, "fixed");
  EXPECT_EQ(joint(arm, "shoulder").kind, "hinge");
  EXPECT_EQ(joint(arm, "grip").kind, "slider");
  EXPECT_EQ(joint(arm, "spin").kind, "hinge");
  EXPECT_EQ(arm.joints.size(), 4U) << "the flange belongs to the upper arm, and what floats is free";
  EXPECT_EQ(arm.bodies[static_cast<std::size_t>(joint(arm, "grip").a)].name, "upper");
  EXPECT_EQ(arm.bodies[static_cast<std::size_t>(joint(arm, "grip").b)].name, "finger");
  UrdfOptions options;
  options.motors = true;
  options.targets["shoulder"] = 1;
  const Object driven = read_urdf(arm_path, options);
  EXPECT_EQ(joint(driven, "shoulder").constraints.size(), joint(arm, "shoulder").constraints.size() + 1);
  EXPECT_EQ(joint(driven, "grip").constraints.size(), joint(arm, "grip").constraints.size() + 1);
  EXPECT_EQ(joint(driven, "spin").constraints.size(), joint(arm, "spin").constraints.size()) << "no effort limit";
}

/// The elbow's axis is y of the file, which is -z here.
TEST_F(Urdf, MovesWhereItsMotorsDrive) {
  UrdfOptions options;
  options.motors = options.fixed_base = true;
  options.targets["elbow"] = 1;
  Scene scene;
  scene.gravity = {};
  scene.add(read_urdf(PLIANT_SOURCE_DIR "/scenes/bodies/arm.urdf", options));
  World world(scene);
  for (int frame = 0; frame < 120; ++frame) ASSERT_TRUE(world.step(scene.frame_time).ok());
  const Object& arm = scene.objects[0];
  const auto frame = static_cast<std::size_t>(body(arm, "forearm").frame);
  const Quatf before = arm.frames[frame].orientation, after = world.object(0).orientations()[frame];
  const float same = std::fabs(before.x * after.x + before.y * after.y + before.z * after.z + before.w * after.w);
  EXPECT_NEAR(2 * std::acos(std::min(same, 1.f)), 1, 0.02);
  const Vec3f hand = world.object(0).positions()[static_cast<std::size_t>(body(arm, "hand").particle)];
  EXPECT_GT(hand.x, 0.4f) << "a positive angle about -z swings what is up towards +x";
}

TEST_F(Urdf, HoldsARootLinkWithAFixedBase) {
  const test::Folder folder;
  test::put(folder / "a.urdf",
            "<robot name=\"r\"><link name=\"root\"><collision><geometry><sphere "
            "radius=\"1\"/></geometry></collision></link></robot>");
  EXPECT_EQ(read_urdf(folder / "a.urdf").joints.size(), 0U);
  UrdfOptions options;
  options.fixed_base = true;
  EXPECT_EQ(read_urdf(folder / "a.urdf", options).joints.size(), 1U);
}

TEST_F(Urdf, NamesWhatItIgnoresWithItsLine) {
  std::vector<std::string> warnings;
  static_cast<void>(read_urdf(arm_path, {}, &warnings));
  std::string all;
  for (const std::string& one : warnings) all += one.substr(one.find("arm.urdf")) + "\n";
  for (const std::string part :
       {"arm.urdf:18: 'dynamics' of joint (its damping)", "arm.urdf:29: mesh 'wheel.dae' is ignored: only .obj",
        "arm.urdf:28: mesh 'package://arm/tetra.obj' is ignored: there is no file", "arm.urdf:31: 'mimic' of joint",
        "arm.urdf:34: 'transmission' of robot", "arm.urdf:22: link 'finger' has no mass"})
    EXPECT_NE(all.find(part), std::string::npos) << part << "\nin\n" << all;
}

TEST_F(Urdf, IsAnObjectOfASceneFile) {
  const auto scene = [](const std::string& members) {
    return R"({"objects": [{"name": "robot", "colour": [0, 0, 1], "urdf": {"file": "arm.urdf")" + members + "}}]}";
  };
  const std::string folder = PLIANT_SOURCE_DIR "/tests/io";
  const std::string targets =
      R"(, "targets": [{"joint": "shoulder", "angle": 90}, {"joint": "grip", "displacement": 0.05}])";
  const Object robot =
      parse_scene(scene(R"(, "position": [1, 2, 3], "rotation": {"axis": [0, 1, 0], "degrees": 90})" + targets), "x.json",
                  folder)
          .objects[0];
  UrdfOptions options;
  options.position = {1, 2, 3};
  options.rotation = rotation({0, 1, 0}, 90);
  options.targets = {{"shoulder", 1.5707964f}, {"grip", 0.05f}};
  const Object same = read_urdf(arm_path, options);
  EXPECT_EQ(robot.name, "robot");
  EXPECT_EQ(robot.colour, (Vec3f{0, 0, 1}));
  EXPECT_EQ(robot.positions, same.positions);
  EXPECT_EQ(robot.joints.size(), same.joints.size());
  ASSERT_EQ(robot.constraints.size(), same.constraints.size());
  for (std::size_t i = 0; i < robot.constraints.size(); ++i) EXPECT_EQ(robot.constraints[i].rest, same.constraints[i].rest);
  EXPECT_THROW(parse_scene(scene(R"(, "targets": [{"joint": "elbow", "angle": 90}])"), "x.json", folder), Error);
  const Object free =
      parse_scene(scene(R"(, "z_up": false, "motors": true, "fixed_base": true)"), "x.json", folder).objects[0];
  EXPECT_EQ(free.joints.size(), 4U) << "the root is the world already";
}

TEST_F(Urdf, ReadsNoMeshOutsideItsFolderUnlessPermitted) {
  const test::Folder folder;
  std::filesystem::create_directory(folder / "robot");
  test::put(folder / "tetra.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  test::put(folder / "robot/a.urdf",
            "<robot name=\"r\"><link name=\"a\"><visual><geometry><mesh "
            "filename=\"../tetra.obj\"/></geometry></visual></link></robot>");
  UrdfOptions options;
  EXPECT_EQ(read_urdf(folder / "robot/a.urdf", options).bodies.at(0).solids.size(), 1U);
  options.allow_outside = false;
  EXPECT_THROW(static_cast<void>(read_urdf(folder / "robot/a.urdf", options)), Error);
}

TEST_F(Urdf, RefusesWhatIsNoTreeOrNoRobot) {
  const std::string link = R"(<link name="a"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>
)";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"<link name=\"a\">", "not valid XML"},
      {"<link/>", "a.urdf:2: link has no attribute 'name'"},
      {link + "<link name=\"a\"/>", "a.urdf:3: "},
      {link + "<link name=\"b\"/>", "a.urdf:3: "},
      {link + R"(<joint name="j" type="fixed"><parent link="a"/><child link="c"/></joint>)", "names no link: 'c'"},
      {link + R"(<link name="b"/><joint name="j" type="screw"><parent link="a"/><child link="b"/></joint>)", "'screw'"},
      {link + R"(<joint name="j" type="fixed"><parent link="a"/><child link="a"/></joint>)", "loop"},
      {R"(<link name="a"><visual><geometry><sphere radius="x"/></geometry></visual></link>)", "a.urdf:2: sphere, radius: "},
      {R"(<link name="a"><visual><geometry><box size="1 1"/></geometry></visual></link>)", "a.urdf:2: box, size: "},
      {R"(<link name="a"><inertial><mass value="1"/><inertia ixx="-1" iyy="1" izz="1"/></inertial></link>)", "a.urdf:2: "},
      {link + R"(<link name="b"/><link name="c"/><joint name="j" type="fixed"><parent link="b"/><child link="c"/></joint>
<joint name="k" type="fixed"><parent link="c"/><child link="b"/></joint>)",
       "a.urdf:3: object 'r': some joints form a loop"},
      {R"(<link name="a"/>)", "no link with mass or geometry"},
      {"", "has no links"}};
  for (const auto& [elements, message] : cases) {
    const std::string found = refused(elements);
    EXPECT_NE(found.find(message), std::string::npos) << elements << "\n" << found;
  }
}

}  // namespace
}  // namespace pliant
