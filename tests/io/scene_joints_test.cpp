// Tests joints in scene files: each is the one that add_joint makes, and what is refused.
#include <vector>

#include "pliant/body.h"
#include "pliant/joint.h"
#include "scene_support.h"

namespace pliant {
namespace {

constexpr float degree = 0.017453292519943295f;

/// The object "rig" of the scene that has every field, and the same object made by code.
class Rig : public testing::Test {
 protected:
  Rig() {
    for (int i = 0; i < 14; ++i) {
      BodyOptions options;
      options.name = "link_" + std::to_string(i);
      options.position = {static_cast<float>(2 * i), 0, 0};
      add_body(same, {{Box{}}}, options);
    }
    add_body(same, {{Box{}}}, {.name = "lift", .position = {0, 40, 0}, .kinematic = true});
  }

  /// Compares joint `index` of the scene's object with the one that was added last, with all its constraints.
  void expect_same(std::size_t index) {
    ASSERT_LT(index, rig.joints.size());
    ASSERT_EQ(same.joints.size(), index + 1);
    const ObjectJoint &found = rig.joints[index], &expected = same.joints[index];
    EXPECT_EQ(found.name, expected.name);
    EXPECT_EQ(found.kind, expected.kind);
    EXPECT_EQ(found.a, expected.a);
    EXPECT_EQ(found.b, expected.b);
    EXPECT_EQ(found.anchor, expected.anchor);
    EXPECT_EQ(found.break_force, expected.break_force);
    EXPECT_EQ(found.break_torque, expected.break_torque);
    ASSERT_EQ(found.motors.size(), expected.motors.size());
    for (std::size_t m = 0; m < found.motors.size(); ++m) {
      EXPECT_EQ(found.motors[m].name, expected.motors[m].name);
      EXPECT_EQ(found.motors[m].is_torque, expected.motors[m].is_torque);
      ASSERT_EQ(found.motors[m].keyframes.size(), expected.motors[m].keyframes.size());
      for (std::size_t k = 0; k < found.motors[m].keyframes.size(); ++k) {
        EXPECT_EQ(found.motors[m].keyframes[k].time, expected.motors[m].keyframes[k].time);
        EXPECT_EQ(found.motors[m].keyframes[k].target, expected.motors[m].keyframes[k].target);
      }
    }
    ASSERT_EQ(found.constraints.size(), expected.constraints.size());
    for (std::size_t c = 0; c < found.constraints.size(); ++c)
      EXPECT_EQ(described(rig, found.constraints[c]), described(same, expected.constraints[c]))
          << found.name << " " << c;
  }

  /// Type, slots, rest data and compliance of one constraint, as text.
  static std::string described(const Object& object, const std::array<int, 2>& at) {
    const ConstraintGroup& group = object.constraints[static_cast<std::size_t>(at[0])];
    const auto index = static_cast<std::size_t>(at[1]);
    std::string text = group.type;
    for (const ConstraintType& type : constraint_types()) {
      if (type.name != group.type) continue;
      const auto slots = static_cast<std::size_t>(type.stencil_size), fields = type.rest_fields.size();
      for (std::size_t k = 0; k < slots; ++k) text += " " + std::to_string(group.particles[index * slots + k]);
      for (std::size_t k = 0; k < fields; ++k) text += " " + std::to_string(group.rest[index * fields + k]);
    }
    text += " c " + std::to_string(group.stiffness.value) + " d " + std::to_string(group.stiffness.damping);
    if (!group.compliances.empty()) text += " " + std::to_string(group.compliances[index]);
    return text;
  }

  const Scene scene = parse_scene(test::full_scene(), "every_field.json", ".");
  const Object& rig = scene.objects.at(8);
  Object same;
};

TEST_F(Rig, HasTheJointsThatCodeMakes) {
  ASSERT_EQ(rig.joints.size(), 15U);
  JointOptions strong;
  strong.name = "shoulder";
  strong.compliance = 0.001f, strong.damping = 2;
  strong.break_force = 100, strong.break_torque = 50;
  add_joint(
      same,
      BallJoint{0, 1, {1, 0, 0}, {0, 1, 0}, 60 * degree, JointRange{-30 * degree, 45 * degree, 0.25f}, 0.5f, strong});
  expect_same(0);
  add_joint(same, FixedJoint{-1, 0, {0, 0, 1}, {}});
  expect_same(1);
  const JointMotor servo{JointMotor::Kind::position, 45 * degree, 3, 4, 180 * degree};
  add_joint(same, HingeJoint{1,
                             2,
                             {3, 0, 0},
                             {0, 1, 0},
                             JointRange{-90 * degree, 90 * degree},
                             servo,
                             0.125f,
                             {},
                             0.25f,
                             JointSpring{30 * degree, 12, 0.5f}});
  expect_same(2);
  const JointMotor drive{JointMotor::Kind::speed, 0.25f, 7};
  add_joint(
      same,
      SliderJoint{2, 3, {5, 0, 0}, {0, 1, 0}, JointRange{-1, 2, 0.5f}, drive, 0.5f, {}, 4, JointSpring{0.125f, 80, 2}});
  expect_same(3);
  CylindricalJoint both{3, 4, {7, 0, 0}, {0, 1, 0}};
  both.slide_limit = JointRange{-1, 1};
  both.turn_limit = JointRange{-10 * degree, 10 * degree};
  both.slide_motor = JointMotor{JointMotor::Kind::position, 0.5f, 1, 10, 2};
  both.turn_motor = JointMotor{JointMotor::Kind::speed, 90 * degree};
  both.slide_friction = 0.5f, both.turn_friction = 0.25f;
  both.slide_spring = JointSpring{0, 40}, both.turn_spring = JointSpring{0, 20};
  add_joint(same, both);
  expect_same(4);
  UniversalJoint cross{4, 5, {9, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  cross.limit_a = JointRange{-30 * degree, 60 * degree}, cross.limit_b = JointRange{-20 * degree, 20 * degree};
  cross.motor_a = JointMotor{.kind = JointMotor::Kind::torque, .target = -1.5f, .keyframes = {{0, -1}, {2, 3}}};
  cross.motor_b = JointMotor{JointMotor::Kind::position, 10 * degree};
  cross.friction_a = 0.5f, cross.friction_b = 0.25f;
  cross.spring_a = JointSpring{0, 3}, cross.spring_b = JointSpring{15 * degree, 4};
  add_joint(same, cross);
  expect_same(5);
  PlanarJoint plane{5, 6, {11, 0, 0}, {0, 0, 1}};
  plane.axis_x = Vec3f{0, 1, 0};
  plane.x_limit = JointRange{-1, 2}, plane.y_limit = JointRange{-3, 4};
  plane.turn_limit = JointRange{-90 * degree, 45 * degree};
  plane.x_motor = JointMotor{.kind = JointMotor::Kind::torque, .target = 2, .keyframes = {{0, 2}, {1, 5}}};
  plane.y_motor = JointMotor{JointMotor::Kind::position, 0.25f};
  plane.turn_motor = JointMotor{JointMotor::Kind::speed, 30 * degree};
  plane.slide_friction = 0.5f, plane.turn_friction = 0.125f;
  plane.x_spring = JointSpring{0, 5}, plane.y_spring = JointSpring{0, 6}, plane.turn_spring = JointSpring{0, 7};
  add_joint(same, plane);
  expect_same(6);
}

TEST_F(Rig, HasTheOtherJointsThatCodeMakes) {
  for (int i = 0; i < 7; ++i) add_joint(same, FixedJoint{-1, i, {}, {}});  // so that indices and the world are the same
  add_joint(same, DistanceJoint{6, 7, {12, 0, 0}, {14, 0, 0}, 1.f, 3.f, {}});
  expect_same(7);
  add_joint(same, SpringJoint{7, 8, {14, 0, 0}, {16, 0, 0}, 1.5f, 250, 4, {}});
  expect_same(8);
  add_joint(same, PulleyJoint{8, 9, {16, 0, 0}, {18, 0, 0}, {16, 3, 0}, {18, 3, 0}, 2, -1, {}});
  expect_same(9);
  add_joint(same, GearJoint{9, 10, {0, 0, 1}, {0, 0, 1}, 12, -24, 0, {}});
  expect_same(10);
  add_joint(same, RackJoint{10, 11, {0, 0, 1}, {0, 1, 0}, 0.25f, -1, {}});
  expect_same(11);
  SixAxisJoint six{11, 12, {23, 0, 0}, rotation({0, 1, 0}, 90)};
  six.linear[1].kind = six.angular[1].kind = AxisFreedom::Kind::free;
  six.linear[2] = {
      AxisFreedom::Kind::limited, {-1, 1}, JointMotor{JointMotor::Kind::speed, 0.5f}, 0.5f, JointSpring{0, 8}};
  six.angular[2] = {AxisFreedom::Kind::limited,
                    {-20 * degree, 20 * degree},
                    JointMotor{JointMotor::Kind::position, 10 * degree},
                    0.25f,
                    JointSpring{0, 9}};
  add_joint(same, six);
  expect_same(12);
}

TEST_F(Rig, RepeatsAJointAlongARow) {
  EXPECT_EQ(rig.joints[13].name, "chain_0");
  EXPECT_EQ(rig.joints[14].name, "chain_1");
  EXPECT_EQ(rig.bodies[static_cast<std::size_t>(rig.joints[14].a)].name, "link_12");
  EXPECT_EQ(rig.bodies[static_cast<std::size_t>(rig.joints[14].b)].name, "link_13");
  EXPECT_NEAR(rig.joints[14].anchor.x, 0, 1e-6) << "in the frame of the body, which lies a step further";
  EXPECT_NEAR(rig.joints[14].anchor.z, 1, 1e-6);
}

TEST(SceneJoints, AreNamedInErrors) {
  const std::string bodies = R"({"objects": [{"bodies": [{"name": "arm_1", "solids": [{"box": {}}]},
    {"name": "arm_2", "solids": [{"box": {}}], "position": [2, 0, 0]}], "joints": [
)";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {R"({"between": ["arm_1", "arm_3"], "fixed": {"anchor": [0, 0, 0]}})",
       "/objects/0/joints/0/between/1: the object has no body 'arm_3'; did you mean 'arm_1'?"},
      {R"({"between": ["arm_1", "arm_2"], "fixed": {"anchor": [0, 0, 0]}, "repeat": {"count": 2, "step": [1, 0, 0]}})",
       "the object has no body 'arm_3'"},
      {R"({"between": ["arm_1", "world"], "fixed": {"anchor": [0, 0, 0]}})",
       "/objects/0/joints/0/between/1: the world is the second body; name it first"},
      {R"({"between": ["arm_1", "arm_2"], "fixed": {"anchor": [0, 0, 0]}, "carrier": "arm_1"})",
       "/objects/0/joints/0/carrier: a fixed joint has no carrier; remove it"},
      {R"({"between": ["arm_1", "arm_2"], "spring": {"anchors": [[0, 0, 0], [1, 0, 0]]}, "compliance": 1})",
       "a spring joint has its own stiffness and damping"},
      {R"({"between": ["arm_1", "arm_2"], "hinge": {"anchor": [0, 0, 0], "motor": {"speed": 3, "rate": 2}}})",
       "/objects/0/joints/0/hinge/motor/rate: a motor that keeps a speed has no rate"},
      {R"({"between": ["arm_1", "arm_2"], "hinge": {"anchor": [0, 0, 0], "motor": {"torque": 3, "most": 2}}})",
       "/objects/0/joints/0/hinge/motor/most: a motor of a given torque or force has no other greatest one"},
      {R"({"between": ["arm_1", "arm_2"], "hinge": {"anchor": [0, 0, 0], "motor": {"speed": 3, "keyframes": [
         {"time": 1, "target": 2}, {"time": 1, "target": 3}]}}})",
       "has a motor whose keyframe 1 is not after the one before"},
      {R"({"between": ["arm_1", "arm_2"], "hinge": {"anchor": [0, 0, 0], "axis": [0, 0, 0]}})",
       "x.json:3:1: object 'bodies', /objects/0/joints/0"},
      {R"({"between": ["arm_1", "arm_1"], "fixed": {"anchor": [0, 0, 0]}})",
       "x.json:3:1: object 'bodies', /objects/0/joints/0, joint 'fixed 0': joins body 0 ('arm_1') with itself; give "
       "two "
       "bodies"},
      {R"({"between": ["arm_1", "arm_2"], "distance": {"anchors": [[0, 0, 0], [1, 0, 0]], "least": 2, "most": 1}})",
       "has a least distance of 2 m, more than its greatest of 1 m"},
      {R"({"between": ["world", "end"], "fixed": {"anchor": [0, 0, 0]}, "repeat": {"count": 3, "step": [0, 0, 0]}})",
       "/objects/0/joints/0/repeat: joins the same bodies at the same place 3 times"},
      {R"({"between": ["arm_1", "arm_2"]})", "the kind of this joint is missing"},
      {R"({"between": ["arm_1"], "fixed": {"anchor": [0, 0, 0]}})", "/objects/0/joints/0/between: "}};
  for (const auto& [joint, message] : cases) {
    const std::string found = test::scene_message(bodies + joint + "]}]}");
    EXPECT_NE(found.find(message), std::string::npos) << joint << "\n" << found;
  }
  EXPECT_NE(test::scene_message(R"({"objects": [{"rope": {"points": [[0,0,0],[1,0,0]]}, "joints": []}]})")
                .find("only an object of bodies has joints"),
            std::string::npos);
  EXPECT_NE(test::scene_message(R"({"objects": [{"bodies": [{"name": "world", "solids": [{"box": {}}]}]}]})")
                .find("no body can be called 'world'"),
            std::string::npos);
}

}  // namespace
}  // namespace pliant
