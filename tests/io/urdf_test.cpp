// Tests the reader of robot descriptions: bodies, poses, inertia, joints, and what is named as unsupported or refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "pliant/body.h"
#include "pliant/error.h"
#include "pliant/io.h"
#include "pliant/joint.h"
#include "support/paths.h"
#include "support/refusal.h"
#include "write_support.h"

namespace pliant {
namespace {

const std::string arm_path = test::in_tree("tests/io/arm.urdf");

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
  static std::string refused(const std::string& elements, const UrdfOptions& options = {}) {
    const test::Folder folder;
    test::put(folder / "a.urdf", "<robot name=\"r\">\n" + elements + "</robot>\n");
    try {
      static_cast<void>(read_urdf(folder / "a.urdf", options));
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
  // The upper link's inertia is turned by 90 degrees about z: Ixx and Iyy change places, as an oracle with the world's
  // axes.
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
  scene.add(read_urdf(test::in_tree("scenes/bodies/arm.urdf"), options));
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
       {"arm.urdf:29: mesh 'wheel.dae' of link 'wheel' is ignored: only .obj",
        "arm.urdf:28: mesh 'package://arm/tetra.obj' of link 'wheel' is ignored: there is no file",
        "arm.urdf:26: link 'wheel' has mass but no shape that can be read, so it touches nothing",
        "arm.urdf:31: joint 'spin' mimics 'shoulder' without a motor, so it moves freely",
        "arm.urdf:32: link 'camera' has mass but no collision or visual shape, so it touches nothing",
        "arm.urdf:34: 'transmission' of robot", "arm.urdf:22: link 'finger' has no mass"})
    EXPECT_NE(all.find(part), std::string::npos) << part << "\nin\n" << all;
}

/// The warnings of a robot of two links, with what is added to its joint and after it.
std::string warned(const std::string& type, const std::string& in_joint, const std::string& after = {}) {
  const test::Folder folder;
  const std::string inertial = R"(<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>)";
  const std::string shape = R"(<collision><geometry><sphere radius="0.1"/></geometry></collision>)";
  test::put(folder / "a.urdf",
            "<robot name=\"r\">\n<link name=\"a\">" + inertial + shape + "</link>\n<link name=\"b\">" + inertial +
                shape + "</link>\n<joint name=\"j\" type=\"" + type + "\"><parent link=\"a\"/><child link=\"b\"/>" +
                in_joint + "</joint>\n" + after + "</robot>\n");
  std::vector<std::string> warnings;
  static_cast<void>(read_urdf(folder / "a.urdf", {}, &warnings));
  std::string all;
  for (const std::string& one : warnings) all += one.substr(folder.path().size() + 1) + "\n";
  return all;
}

TEST_F(Urdf, SuggestsANameForWhatIsUnknown) {
  const std::string limit = R"(<limit lower="-1" upper="1" effort="1" velocity="1"/>)";
  EXPECT_EQ(warned("revolute", limit), "");
  EXPECT_EQ(warned("revolute", limit + R"(<axes xyz="0 0 1"/>)"),
            "a.urdf:4: 'axes' of joint is unknown and ignored; did you mean 'axis'?\n");
  EXPECT_EQ(warned("revolute", limit + R"(<origin xyz="0 0 1" ryp="0 0 1"/>)"),
            "a.urdf:4: attribute 'ryp' of origin is unknown and ignored; did you mean 'rpy'?\n");
  EXPECT_EQ(warned("revolute", limit, "<gazebo/><gazebo/>\n<gazebo/>"),
            "a.urdf:5: 'gazebo' of robot is not supported and ignored (and 2 more)\n");
  EXPECT_EQ(warned("planar", R"(<dynamics friction="1"/>)"),
            "a.urdf:4: friction, damping and limits of the planar joint 'j' are ignored\n");
  EXPECT_EQ(warned("revolute", limit + R"(<dynamics damping="5"/>)"), "") << "it is read";
}

/// A gripper of two fingers that slide, the second of which is to mimic the first.
std::string gripper(const std::string& first, const std::string& second) {
  const std::string base = R"(<link name="base"><inertial><mass value="1"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01"/></inertial><collision><geometry><box size="0.1 0.1 0.05"/></geometry></collision></link>)";
  const auto finger = [](const std::string& name, const std::string& x, const std::string& axis,
                         const std::string& more) {
    return "\n<link name=\"" + name +
           R"("><collision><geometry><box size="0.02 0.03 0.06"/></geometry></collision></link>)" + "<joint name=\"j" +
           name + R"(" type="prismatic"><parent link="base"/><child link=")" + name + "\"/><origin xyz=\"" + x +
           " 0 0.06\"/><axis xyz=\"" + axis + " 0 0\"/>" + more + "</joint>";
  };
  return "<robot name=\"r\">" + base + finger("l", "-0.04", "1", first) + finger("r", "0.04", "-1", second) +
         "</robot>";
}

struct Grip {
  Object object;
  std::string warnings;
};

Grip grip(const std::string& first, const std::string& second, const std::map<std::string, float>& targets) {
  const test::Folder folder;
  test::put(folder / "a.urdf", gripper(first, second));
  UrdfOptions options;
  options.fixed_base = options.motors = true;
  options.targets = targets;
  std::vector<std::string> warnings;
  Grip made{read_urdf(folder / "a.urdf", options, &warnings), {}};
  for (const std::string& one : warnings) made.warnings += one.substr(folder.path().size() + 1) + "\n";
  return made;
}

const std::string strong = R"(<limit lower="0" upper="0.03" effort="10" velocity="0.1"/>)";  // NOLINT(cert-err58-cpp)

TEST_F(Urdf, MovesAJointThatMimicsAnother) {
  const Grip made = grip(strong, strong + R"(<mimic joint="jl" multiplier="0.5" offset="0.002"/>)", {{"jl", 0.02f}});
  EXPECT_NE(made.warnings.find("joint 'jr' mimics 'jl' by the target of its motor alone"), std::string::npos)
      << made.warnings;
  Scene scene;
  scene.gravity = {};
  scene.add(made.object);
  World world(scene);
  for (int frame = 0; frame < 120; ++frame) ASSERT_TRUE(world.step(scene.frame_time).ok());
  const auto x = [&](const char* name) {
    return world.object(0).positions()[static_cast<std::size_t>(body(made.object, name).particle)].x;
  };
  EXPECT_NEAR(x("l"), -0.04f + 0.02f, 2e-4f);
  EXPECT_NEAR(x("r"), 0.04f - 0.012f, 2e-4f);
}

TEST_F(Urdf, RefusesWhatCannotMimic) {
  const auto refused_grip = [](const std::string& first, const std::string& second,
                               const std::map<std::string, float>& targets) {
    return testing_support::refusal([&] { grip(first, second, targets); });
  };
  const std::string mimics = R"(<mimic joint="jl"/>)";
  for (const auto& [message, found] : std::vector<std::pair<std::string, std::string>>{
           {"joint 'jr' mimics 'jl', so it has no target of its own; give the target to 'jl'",
            refused_grip(strong, strong + mimics, {{"jr", 0.01f}})},
           {"joint 'jr' mimics 'jx', which is no joint", refused_grip(strong, strong + R"(<mimic joint="jx"/>)", {})},
           {"joint 'jl' mimics itself", refused_grip(strong + R"(<mimic joint="jr"/>)", strong + mimics, {})}})
    EXPECT_NE(found.find(message), std::string::npos) << found;
}

TEST_F(Urdf, TakesAnEffortOfZeroAsALimit) {
  const std::string weak = R"(<limit lower="0" upper="0.03" effort="0" velocity="0.1"/>)",
                    none = R"(<limit lower="0" upper="0.03" velocity="0.1"/>)";
  EXPECT_NE(grip(weak, strong, {}).warnings.find("joint 'jl' has an effort limit of 0, so it gets no motor\n"),
            std::string::npos);
  EXPECT_NE(grip(none, strong, {}).warnings.find("joint 'jl' has no effort limit, so it gets no motor\n"),
            std::string::npos);
}

TEST_F(Urdf, NamesAMissingMeshOfAPackageByARelativePath) {
  const test::Folder folder;
  const std::filesystem::path before = std::filesystem::current_path();
  test::put(folder / "a.urdf",
            "<robot name=\"r\">\n<link name=\"a\"><inertial><mass value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" "
            "izz=\"1\"/></inertial>\n<visual><geometry><mesh "
            "filename=\"package://x/no.stl\"/></geometry></visual></link></robot>");
  std::filesystem::current_path(folder.path());
  std::vector<std::string> warnings;
  UrdfOptions options;
  options.allow_outside = false;
  static_cast<void>(read_urdf("a.urdf", options, &warnings));
  std::filesystem::current_path(before);
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_EQ(
      warnings[0],
      "a.urdf:3: mesh 'package://x/no.stl' of link 'a' is ignored: there is no file './no.stl', and no 'x/no.stl' in "
      "this folder or one above");
}

TEST_F(Urdf, RefusesTargetsThatNoMotorReaches) {
  const std::string link = R"(<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>
)";
  for (const std::string type : {"fixed", "planar", "floating"}) {
    const std::string robot = "<link name=\"a\">" + link + "<link name=\"b\">" + link +
                              "<joint name=\"elbow\" type=\"" + type +
                              "\"><parent link=\"a\"/><child link=\"b\"/></joint>";
    UrdfOptions options;
    options.targets["elbow"] = 1;
    EXPECT_NE(refused(robot, options).find("a.urdf:4: object 'r': joint 'elbow' is " + type + ", so no motor moves it"),
              std::string::npos)
        << refused(robot, options);
    options.targets = {{"elbwo", 1}};
    EXPECT_NE(refused(robot, options).find("has no joint 'elbwo', for which there is a target; did you mean 'elbow'?"),
              std::string::npos)
        << refused(robot, options);
  }
  const auto refused_target = [](const std::string& target) -> std::string {
    try {
      static_cast<void>(
          parse_scene(R"({"objects": [{"name": "r", "urdf": {"file": "arm.urdf", "targets": [)" + target + "]}}]}",
                      "x.json", test::in_tree("tests/io")));
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  const std::vector<std::pair<std::string, std::string>> cases = {
      {R"({"joint": "sholder", "angle": 1})", "the robot has no joint 'sholder'; did you mean 'shoulder'?"},
      {R"({"joint": "mount", "angle": 1})",
       "targets/0/joint: joint 'mount' is fixed, so no motor moves it to a target"},
      {R"({"joint": "free", "angle": 1})", "targets/0/joint: joint 'free' is floating, so no motor"},
      {R"({"joint": "grip", "angle": 1})",
       "targets/0/angle: joint 'grip' is prismatic, so its target is a displacement"},
      {R"({"joint": "shoulder", "displacement": 1})",
       "targets/0/displacement: joint 'shoulder' is revolute, so its target is an angle; give 'angle' in degrees"}};
  for (const auto& [target, message] : cases)
    EXPECT_NE(refused_target(target).find(message), std::string::npos) << refused_target(target);
}

TEST_F(Urdf, IsAnObjectOfASceneFile) {
  const auto scene = [](const std::string& members) {
    return R"({"objects": [{"name": "robot", "colour": [0, 0, 1], "urdf": {"file": "arm.urdf")" + members + "}}]}";
  };
  const std::string folder = test::in_tree("tests/io");
  const std::string targets =
      R"(, "targets": [{"joint": "shoulder", "angle": 90}, {"joint": "grip", "displacement": 0.05}])";
  const Object robot =
      parse_scene(scene(R"(, "position": [1, 2, 3], "rotation": {"axis": [0, 1, 0], "degrees": 90})" + targets),
                  "x.json", folder)
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
  for (std::size_t i = 0; i < robot.constraints.size(); ++i)
    EXPECT_EQ(robot.constraints[i].rest, same.constraints[i].rest);
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
  const std::string link =
      R"(<link name="a"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>
)";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"<link name=\"a\">",
       "a.urdf:2: is not valid XML: this element is closed by a tag of another name: '<link name=\"a\"></robot>'"},
      {"<link name=a/>", "a.urdf:2: is not valid XML: an attribute of this element is not of the form name=\"value\""},
      {"<link/>", "a.urdf:2: link has no attribute 'name'"},
      {link + "<link name=\"a\"/>", "a.urdf:3: "},
      {link + "<link name=\"b\"/>", "a.urdf:3: "},
      {link + R"(<joint name="j" type="fixed"><parent link="a"/><child link="c"/></joint>)", "names no link: 'c'"},
      {link + R"(<link name="b"/><joint name="j" type="screw"><parent link="a"/><child link="b"/></joint>)", "'screw'"},
      {link + R"(<joint name="j" type="fixed"><parent link="a"/><child link="a"/></joint>)",
       "a.urdf:3: object 'r': joint 'j' joins link 'a' to itself; name two links"},
      {R"(<link name="a"><visual><geometry><sphere radius="x"/></geometry></visual></link>)",
       "a.urdf:2: sphere, radius: "},
      {R"(<link name="a"><visual><geometry><box size="1 1"/></geometry></visual></link>)",
       "a.urdf:2: box, size: needs 3 numbers, has 2"},
      {R"(<link name="a"><visual><geometry><box size="1,1,1"/></geometry></visual></link>)",
       "separate numbers by blanks"},
      {R"(<link name="a"><visual><geometry><box size="1 1 1 1"/></geometry></visual></link>)",
       "needs 3 numbers, has 4"},
      {R"(<link name="a"><inertial><mass value="1"/><inertia ixx="-1" iyy="1" izz="1"/></inertial></link>)",
       "a.urdf:2: "},
      {link +
           R"(<link name="b"/><link name="c"/><joint name="j" type="fixed"><parent link="b"/><child link="c"/></joint>
<joint name="k" type="fixed"><parent link="c"/><child link="b"/></joint>)",
       "a.urdf:3: object 'r': joints 'j' and 'k' form a loop"},
      {R"(<link name="a"><inertial><mass value="-1"/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>)",
       "a.urdf:2: inertial has a negative mass: -1 kg; give a mass above 0"},
      {link + R"(<link name="b"/><joint name="j" type="revolute"><parent link="a"/><child link="b"/>
<dynamics damping="-2"/></joint>)",
       "a.urdf:4: dynamics has a negative damping: -2"},
      {R"(<link name="a"/>)", "no link with mass or geometry"},
      {"", "has no links"}};
  for (const auto& [elements, message] : cases) {
    const std::string found = refused(elements);
    EXPECT_NE(found.find(message), std::string::npos) << elements << "\n" << found;
  }
}

}  // namespace
}  // namespace pliant
