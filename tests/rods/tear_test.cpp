// Rods tear where they are stretched too far, and are cut by blades: a joint breaks.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "pliant/body.h"
#include "pliant/error.h"
#include "rods/rod_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// Three stalks on the ground, of segments of 0.1 m.
Object stalks() {
  Object object;
  for (int i = 0; i < 3; ++i) {
    const float x = 0.5f * static_cast<float>(i) - 0.5f;
    RodOptions options = clamped_rod(material_of(1e9, 3.5e8, 1000), 0.01f);
    options.name = "stalk " + std::to_string(i);
    add_rod(object, line({x, 0, 0}, {x, 0.6f, 0}, 6), options);
  }
  object.cuts.push_back({0.1f, 0.5f, {0, 0.31f, 0}, {0, 1, 0}, {1, 0, 0}});
  return object;
}

TEST(RodThatTears, BreaksOnceAtItsStretch) {
  constexpr float limit = 1.2f, length = 1, seconds = 4, way = 0.3f;
  RodOptions options = clamped_rod(material_of(1e7, 3.5e6, 1000), 0.02f);  // waves cross it in a frame
  options.material.damping = 0.002f;
  Object rod;
  BodyOptions grip;
  grip.position = {length + 0.05f, 0, 0};
  options.end = {RodEnd::Kind::clamped, add_body(rod, {{Sphere{0.05f}}}, grip)};
  add_rod(rod, line({0, 0, 0}, {length, 0, 0}, 10), options);
  Pin pin{rod.bodies[0].particle, {}};
  pin.motion.keyframes = {{0, {}, {}}, {seconds, {way, 0, 0}, {}}};
  rod.pins.push_back(pin);
  rod.tearing = Tearing{limit};
  Lone lone(std::move(rod), 20, false);
  double torn_at = 0;
  std::size_t broken = 0;
  for (int frame = 0; frame < 300; ++frame) {
    const Report report = lone.world.step(frame_time);
    ASSERT_TRUE(report.ok()) << report.explain();
    broken += report.broken_joints.size();
    if (broken > 0 && torn_at == 0) torn_at = lone.position(0).x - double(length) - 0.05;
  }
  EXPECT_EQ(broken, 1u) << "what is left springs back";
  EXPECT_NEAR(torn_at / double(length), double(limit) - 1, 0.01);
}

TEST(RodThatTears, BreaksWhereItIsStretchedFarthest) {
  RodOptions options = clamped_rod(material_of(1e7, 3.5e6, 1000), 0.02f);
  options.material.damping = 0.002f;
  options.end_radius = 0.01f;
  Object rod;
  BodyOptions grip;
  grip.position = {1.05f, 0, 0};
  options.end = {RodEnd::Kind::clamped, add_body(rod, {{Sphere{0.05f}}}, grip)};
  add_rod(rod, line({0, 0, 0}, {1, 0, 0}, 10), options);
  Pin pin{rod.bodies[0].particle, {}};
  pin.motion.keyframes = {{0, {}, {}}, {0.5f, {0.19f, 0, 0}, {}}};
  rod.pins.push_back(pin);
  Lone whole(rod, 20, false);
  whole.run(1);
  Scene scene = whole.scene;
  scene.objects[0].tearing = Tearing{1.05f};  // many of its joints are beyond that when it begins to tear
  World world(scene);
  world.restore(whole.world.state());
  const Report report = world.step(frame_time);
  ASSERT_EQ(report.broken_joints.size(), 1u);
  EXPECT_EQ(report.broken_joints[0].name, "rod end") << "where it is thinnest";
}

TEST(RodThatTears, BreaksEachOfTwoThatHangOnTheWorld) {
  RodOptions options = clamped_rod(material_of(1e6, 3.5e5, 1000), 0.01f);
  Object rods;
  for (const float x : {0.f, 0.5f}) {
    options.name = "rod " + std::to_string(rods.bodies.size());
    options.velocity = {0, -3, 0};
    add_rod(rods, line({x, 0, 0}, {x, -0.5f, 0}, 5), options);
  }
  rods.tearing = Tearing{1.02f};
  Lone lone(std::move(rods), 20, false);
  std::size_t most = 0;
  for (int frame = 0; frame < 20; ++frame) most = std::max(most, lone.world.step(frame_time).broken_joints.size());
  EXPECT_EQ(most, 2u) << "both in the same step";
}

TEST(RodThatTears, DoesNotTearByBendingOrAtASmallerStretch) {
  RodOptions options = clamped_rod(material_of(1e6, 3.5e5, 1000), 0.01f);
  options.material.damping = 0.05f;
  Object rod = make_rod(line({0, 0, 0}, {1, 0, 0}, 20), options);  // falls from horizontal, and hangs
  rod.tearing = Tearing{1.3f};
  Lone lone(std::move(rod));
  lone.run(2);
  EXPECT_LT(lone.tip(20).y, -0.6);
  for (int j = 0; j < 20; ++j) EXPECT_FALSE(lone.world.object(0).joint_is_broken(j)) << j;
}

TEST(RodThatIsCut, PartsWhereTheBladeHasPassed) {
  Lone lone(stalks());
  std::vector<std::pair<double, std::string>> breaks;
  for (int frame = 0; frame < 60; ++frame) {
    const Report report = lone.world.step(frame_time);
    ASSERT_TRUE(report.ok()) << report.explain();
    for (const JointBreak& one : report.broken_joints) breaks.emplace_back(lone.world.state().time, one.name);
  }
  ASSERT_EQ(breaks.size(), 3u);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(breaks[static_cast<std::size_t>(i)].first, 0.1 + 0.2 * i, 1.1 / 60);
    EXPECT_EQ(breaks[static_cast<std::size_t>(i)].second, "stalk " + std::to_string(i) + " 2-3");
    const auto middle = [&](int segment) {
      const std::string name = "stalk " + std::to_string(i) + " " + std::to_string(segment);
      const std::vector<ObjectBody>& bodies = lone.scene.objects[0].bodies;
      const auto found =
          std::find_if(bodies.begin(), bodies.end(), [&](const ObjectBody& body) { return body.name == name; });
      return lone.position(found->particle);
    };
    EXPECT_NEAR(middle(2).y, 0.25, 0.01) << "what is below the cut stands";
    EXPECT_LT(middle(3).y, 0.2) << "what is above it falls";
  }
}

/// The names of all joints that break within a second.
std::vector<std::string> broken_of(const Object& object) {
  Lone lone(object);
  std::vector<std::string> names;
  for (int frame = 0; frame < 60; ++frame)
    for (const JointBreak& one : lone.world.step(frame_time).broken_joints) names.push_back(one.name);
  return names;
}

TEST(RodThatIsCut, StaysWhereItIsHeldWhereverTheOriginIs) {
  Object object = stalks();
  for (const float x : {-0.25f, 0.25f})
    for (const float way : {-1.f, 1.f}) {
      object.cuts = {{0, 0.5f, {x, 0, 0}, {way, 0, 0}, {0, -1, 0}}};
      EXPECT_TRUE(broken_of(object).empty()) << "the plane is between stalks";
    }
  RodOptions options = clamped_rod(material_of(1e9, 3.5e8, 1000), 0.01f);
  Object hanging = make_rod(line({0, 2, 0}, {0, 1, 0}, 10), options);
  hanging.cuts = {{0, 0.5f, {0, 1.52f, 0}, {0, 1, 0}, {1, 0, 0}}};
  EXPECT_EQ(broken_of(hanging), std::vector<std::string>{"rod 4-5"});
  hanging.cuts = {{0, 0.5f, {0, 1.98f, 0}, {0, 1, 0}, {1, 0, 0}}};
  EXPECT_EQ(broken_of(hanging), std::vector<std::string>{"rod start"}) << "between the end and the first middle";
}

TEST(RodThatIsCut, MeetsTheBladeWhenItIsThereFarFromTheOrigin) {
  Object object;
  add_rod(object, line({100, 0, 0}, {100, 0.6f, 0}, 6), clamped_rod(material_of(1e9, 3.5e8, 1000), 0.01f));
  object.cuts.push_back({0, 1, {0, 0.31f, 0}, {0, 1, 0}, {1, 0, 0}});  // both ends of its way are where the rod is
  Lone lone(object);
  EXPECT_EQ(lone.world.step(frame_time).broken_joints.size(), 1u);
}

TEST(RodThatIsCut, GoesOnFromALayoutAndAStateWithTheSameBits) {
  Lone lone(stalks());
  lone.run(0.35);
  World again(lone.scene, lone.world.layout());
  again.restore(lone.world.state());
  for (int frame = 0; frame < 30; ++frame) {
    const Report one = lone.world.step(frame_time), other = again.step(frame_time);
    EXPECT_EQ(one.broken_joints.size(), other.broken_joints.size());
    ASSERT_EQ(lone.world.state_hash(), again.state_hash()) << frame;
  }
}

TEST(RodThatIsCut, IsCutAgainAfterAnEarlierStateIsRestored) {
  Lone lone(stalks());
  const State start = lone.world.state();
  lone.run(1);
  const std::string once = lone.world.state_hash();
  lone.world.restore(start);
  lone.run(1);
  EXPECT_EQ(lone.world.state_hash(), once);
}

TEST(RodThatIsCut, HasTheSameBitsOnTwoThreads) {
  std::vector<std::string> hashes;
  for (const int threads : {1, 2}) {
    Scene scene;
    scene.settings.threads = threads;
    scene.add(stalks());
    World world(scene);
    for (int frame = 0; frame < 40; ++frame) world.step(frame_time);
    hashes.push_back(world.state_hash());
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST(RodThatIsCut, IsARodAndNotAnyBody) {
  Object body = make_body({{Sphere{0.1f}}});
  body.cuts.push_back({0, 1, {}, {1, 0, 0}, {0, -1, 0}});
  Scene scene;
  scene.add(body);
  EXPECT_THROW(World{scene}, Error);
}

}  // namespace
}  // namespace pliant
