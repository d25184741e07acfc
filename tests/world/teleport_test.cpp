// Tests that teleporting moves objects and colliders rigidly, without velocity, and at the cost of a usual frame.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "pliant/body.h"
#include "pliant/grains.h"
#include "pliant/joint.h"
#include "support/run.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using namespace testing_support;

const RigidPose quarter_turn{{3, 2, -5}, {0, std::sqrt(0.5f), 0, std::sqrt(0.5f)}};  // x -> -z, z -> x

Vec3f turned(const Vec3f& v) { return {v.z, v.y, -v.x}; }
Vec3f carried(const Vec3f& p) { return turned(p) + quarter_turn.position; }

void expect_near(const Vec3f& found, const Vec3f& wanted, float tolerance) {
  EXPECT_NEAR(found.x, wanted.x, tolerance);
  EXPECT_NEAR(found.y, wanted.y, tolerance);
  EXPECT_NEAR(found.z, wanted.z, tolerance);
}

/// A cape on five pins around a mesh that walks, above a floor.
struct Character {
  Scene scene;
  std::vector<int> held;
  std::vector<Vec3f> shoulders, skin;

  Character() {
    Object cape = sheet_at("cape", {0, 0, 0}, 15, 0.6f);
    for (Vec3f& p : cape.positions) p = {p.x, 1.3f - p.z, -0.24f};
    for (int i = 0; i < 15; ++i) {
      cape.pins.push_back({i, {}});
      held.push_back(i);
      shoulders.push_back(cape.positions[static_cast<std::size_t>(i)]);
    }
    cape.self_collision = true;
    cape.thickness = 0.004f;
    scene.add(cape);
    MeshCollider body;
    body.name = "body";
    body.mesh = sphere_mesh(2);
    for (Vec3f& p : body.mesh.positions) p = Vec3f{0.2f * p.x, 0.7f * p.y, 0.2f * p.z} + Vec3f{0, 1, 0};
    skin = body.mesh.positions;
    scene.add(body);
    scene.add(floor_at(0));
  }

  /// A step to where the character is `way` from its start.
  Report walk(World& world, const Vec3f& way) const {
    std::vector<Vec3f> targets = shoulders, positions = skin;
    for (Vec3f& p : targets) p += way;
    for (Vec3f& p : positions) p += way;
    world.object(0).set_targets(held, targets);
    world.mesh_collider(0).set_positions(positions);
    return world.step(dt);
  }
};

/// The case of a report, of which a frame took 44 s. What costs time is counted.
TEST(Teleport, OfACharacterCostsAUsualFrame) {
  const Character character;
  World world(character.scene), other(character.scene);
  Vec3f way{};
  Report report, usual;
  for (int frame = 0; frame < 40; ++frame) {
    way.z += 0.02f;
    usual = character.walk(other, way);
    const Vec3f away{0, 0, frame >= 20 ? 20.f : 0.f};
    if (frame == 20) {
      world.object(0).teleport({away, {}});
      world.mesh_collider(0).teleport({away, {}});
    }
    report = character.walk(world, way + away);
    ASSERT_TRUE(report.ok()) << report.explain();
    ASSERT_LE(report.substeps, usual.substeps + 4) << frame;
    ASSERT_LE(report.pairs.candidates, 2 * usual.pairs.candidates + 1000) << frame;
  }
  const std::vector<Vec3f> moved = world.object(0).positions(), stayed = other.object(0).positions();
  float most = 0;
  for (std::size_t i = 0; i < moved.size(); ++i)
    most = std::max(most, static_cast<float>(distance(moved[i], stayed[i] + Vec3f{0, 0, 20})));
  EXPECT_LT(most, 0.02f) << "it hangs as it would without";
}

/// Without the call the same happens, since no number of substeps could move it so far, and the Report names both.
TEST(Teleport, IsWhatAJumpOfManySizesIs) {
  const Character character;
  World world(character.scene), other(character.scene);
  Vec3f way{};
  for (int frame = 0; frame < 40; ++frame) {
    way.z += 0.02f;
    const Vec3f away{0, 0, frame >= 20 ? 20.f : 0.f};
    const Report report = character.walk(world, way + away), usual = character.walk(other, way);
    ASSERT_TRUE(report.ok()) << report.explain();
    ASSERT_LE(report.substeps, 2 * usual.substeps) << frame;
    ASSERT_LE(report.pairs.candidates, 2 * usual.pairs.candidates + 1000) << frame;
    std::string words;
    for (const std::string& warning : report.warnings) words += warning + "\n";
    const bool is_named = words.find("object 'cape': moves 20 m in one frame") != std::string::npos &&
                          words.find("collider 'body': moves 20 m in one frame") != std::string::npos &&
                          words.find("teleport") != std::string::npos;
    ASSERT_EQ(is_named, frame == 20) << words;
  }
  const std::vector<Vec3f> moved = world.object(0).positions(), stayed = other.object(0).positions();
  for (std::size_t i = 0; i < moved.size(); ++i) expect_near(moved[i] - Vec3f{0, 0, 20}, stayed[i], 0.05f);
}

/// What is as fast as its targets does not jump, however far it gets in a frame.
TEST(Teleport, IsNotWhatMovesSteadily) {
  const Character character;
  Scene scene = character.scene;
  scene.objects[0].velocities.assign(scene.objects[0].positions.size(), Vec3f{0, 0, 300});
  World world(scene);
  for (int frame = 1; frame <= 3; ++frame) {
    const Report report = character.walk(world, {0, 0, 5.f * static_cast<float>(frame)});
    for (const std::string& warning : report.warnings)
      EXPECT_EQ(warning.find("object 'cape': moves"), std::string::npos) << warning;
  }
}

TEST(Teleport, MovesEveryPartAndTurnsVelocities) {
  Object object = sheet_at("sheet", {1, 2, 3}, 6, 1);
  object.pins = {{0, {}}};
  object.attachments.push_back({5, object.positions[5] + Vec3f{0, 0.1f, 0}, {}, Stiffness::compliance(1e-3f)});
  BodyOptions options;
  options.position = {1, 1, 1};
  options.angular_velocity = {1, 2, 3};
  append(object, make_body({{Box{{0.1f, 0.2f, 0.3f}}}}, options));
  Scene scene;
  scene.add(object);
  World world(scene);
  run(world, 5);
  const std::vector<Vec3f> places = world.object(0).positions(), velocities = world.object(0).velocities();
  const Vec3f spin = world.object(0).angular_velocities()[0];
  const double energy = world.measure().kinetic_energy();
  world.object(0).teleport(quarter_turn);
  const std::vector<Vec3f> after = world.object(0).positions();
  for (std::size_t i = 0; i < places.size(); ++i) {
    expect_near(after[i], carried(places[i]), 2e-6f);
    expect_near(world.object(0).velocities()[i], turned(velocities[i]), 1e-6f);
  }
  expect_near(world.object(0).angular_velocities()[0], turned(spin), 1e-5f);
  EXPECT_NEAR(world.measure().kinetic_energy(), energy, 1e-5 * energy);
  world.step(dt);
  expect_near(world.object(0).positions()[0], carried(places[0]), 2e-6f);  // pins stay at the new place
  EXPECT_LT(distance(world.object(0).positions()[5], carried(places[5])), 0.05) << "the attachment has come along";
}

/// What falls freely goes on falling from the new place.
TEST(Teleport, GivesNoVelocity) {
  Scene scene;
  scene.add(sheet_at("sheet", {0, 0, 0}, 6, 1));
  World world(scene);
  run(world, 30);
  world.object(0).teleport({{100, 50, 0}, {}});
  run(world, 30);
  for (const Vec3f& v : world.object(0).velocities()) expect_near(v, {0, -9.81f, 0}, 1e-3f);
}

TEST(Teleport, ForgetsContactsAndFindsNewOnes) {
  Scene scene;
  scene.add(floor_at(0));
  for (int i = 0; i < 3; ++i) {
    BodyOptions options;
    options.name = "box " + std::to_string(i);
    options.position = {0, 0.1f + 0.2f * static_cast<float>(i), 0};
    scene.add(make_body({{Box{{0.1f, 0.1f, 0.1f}}}}, options));
  }
  scene.settings.sleep.on = true;
  World world(scene);
  run(world, 120);
  world.object(1).teleport({{5, -0.2f, 0}, {}});
  for (const BodyContact& contact : world.state().body_contacts) {
    EXPECT_NE(contact.a.owner, 1);
    EXPECT_NE(contact.b.owner, 1);
  }
  run(world, 120);
  EXPECT_NEAR(world.object(1).positions()[0].y, 0.1f, 2e-3f) << "it lies on the floor";
  EXPECT_NEAR(world.object(2).positions()[0].y, 0.3f, 4e-3f) << "what it bore has fallen onto the lowest";
}

TEST(Teleport, MovesCollidersWithoutPushing) {
  Scene scene;
  Collider shelf;
  shelf.name = "shelf";
  shelf.shape = Box{{1, 0.1f, 1}};
  scene.add(shelf);
  BodyOptions options;
  options.position = {0, 0.2f, 0};
  scene.add(make_body({{Box{{0.1f, 0.1f, 0.1f}}}}, options));
  World world(scene);
  run(world, 20);
  world.collider(0).teleport({{0, -1, 0}, {}});
  expect_near(world.collider(0).pose().position, {0, -1, 0}, 1e-6f);
  world.step(dt);
  EXPECT_NEAR(world.object(0).velocities()[0].y, -9.81f * dt, 1e-3f) << "it falls freely from rest";
  run(world, 60);
  EXPECT_NEAR(world.object(0).positions()[0].y, -0.8f, 3e-3f) << "onto the shelf at its new place";
}

/// A World that restores the State after a teleport goes on with the same bits.
TEST(Teleport, LeavesAStateThatCanBeRestored) {
  const Character character;
  World world(character.scene), other(character.scene);
  for (int frame = 0; frame < 10; ++frame) character.walk(world, {0, 0, 0.02f * static_cast<float>(frame)});
  world.object(0).teleport(quarter_turn);
  world.mesh_collider(0).teleport(quarter_turn);
  other.restore(world.state());
  for (World* each : {&world, &other}) run(*each, 5);
  EXPECT_EQ(world.state_hash(), other.state_hash());
}

/// Calls teleport and returns the message of the Error; empty if there was none.
template <class Handle>
std::string refused(Handle handle, const RigidPose& by) {
  try {
    handle.teleport(by);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Teleport, NamesWhatIsWrong) {
  Object held = sheet_at("flag", {0, 0, 0}, 4, 1), hung = sheet_at("lamp", {3, 0, 0}, 4, 1);
  held.pins = {{2, straight({1, 0, 0}, 1)}};
  hung.attachments.push_back({1, {}, straight({1, 0, 0}, 1), {}});
  Object door = make_body({{Box{{0.4f, 1, 0.02f}}}}, {.name = "door"});
  door.name = "door";
  add_joint(door, HingeJoint{.b = 0, .anchor = {0.4f, 0, 0}, .axis = {0, 1, 0}});
  Collider ball;
  ball.name = "ball";
  ball.shape = Sphere{0.1f};
  ball.motion = straight({1, 0, 0}, 1);
  Scene scene;
  for (const Object& object : {held, hung, door, sheet_at("free", {9, 0, 0}, 4, 1)}) scene.add(object);
  scene.add(ball);
  World world(scene);
  const std::string before = world.state_hash();
  const RigidPose by{{1, 0, 0}, {}};
  const auto contains = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  const std::string pin = refused(world.object(0), by), attachment = refused(world.object(1), by),
                    hinge = refused(world.object(2), by), collider = refused(world.collider(0), by);
  EXPECT_TRUE(contains(pin, "'flag'") && contains(pin, "pin of particle 2")) << pin;
  EXPECT_TRUE(contains(attachment, "'lamp'") && contains(attachment, "attachment 0")) << attachment;
  EXPECT_TRUE(contains(hinge, "'door'") && contains(hinge, "'world'")) << hinge;
  EXPECT_TRUE(contains(collider, "'ball'")) << collider;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(contains(refused(world.object(3), {{nan, 0, 0}, {}}), "not finite"));
  EXPECT_TRUE(contains(refused(world.object(3), {{0, 0, 0}, {0, 0, 0, 0}}), "rotation is zero"));
  EXPECT_TRUE(contains(refused(world.object(ObjectId(7)), by), "no object 7"));
  EXPECT_EQ(world.state_hash(), before) << "nothing has moved";
}

/// A pose that was set for the next step is reached from the new place, as if it had been set after the move.
TEST(Teleport, OfAKinematicBodyTakesItsRotationAlong) {
  Scene scene;
  BodyOptions options;
  options.name = "arm";
  options.kinematic = true;
  scene.add(make_body({{Box{{0.5f, 0.05f, 0.05f}}}}, options));
  const RigidPose asked{{3, 2.1f, -5}, {0, std::sqrt(0.5f), 0, std::sqrt(0.5f)}};
  World before(scene), after(scene);
  before.object(0).set_pose("arm", asked);
  before.object(0).teleport(quarter_turn);
  after.object(0).teleport(quarter_turn);
  after.object(0).set_pose("arm", asked);
  for (World* world : {&before, &after}) world->step(dt);
  EXPECT_EQ(before.state_hash(), after.state_hash());
  for (const Record& w : before.state().frames.angular_velocities)
    EXPECT_LT(std::abs(w.y), 1e-3f) << "it has turned already";
}

/// What no joint connects with a body that jumps is not of its whole.
TEST(Teleport, LeavesWhatOnlyLiesOnABodyThatJumps) {
  Scene scene;
  BodyOptions lift;
  lift.name = "lift";
  lift.kinematic = true;
  Object object = make_body({{Box{{0.2f, 0.05f, 0.2f}}}}, lift);
  add_body(object, {{Box{{0.05f, 0.05f, 0.05f}}}}, {.name = "crate", .position = {0.1f, 0.1f, 0}});
  scene.add(object);
  scene.add(sheet_at("cloth", {5, 0, 0}, 5, 0.2f));
  World world(scene);
  world.object(0).set_pose("lift", {{0, -30, 0}, {}});
  world.step(dt);
  EXPECT_NEAR(world.object(0).pose("crate").position.y, 0.1f, 0.05f);
}

}  // namespace
}  // namespace pliant
