// Saving to memory: the bytes of a file, without one; and Worlds that know their own description.
#include <gtest/gtest.h>

#include <filesystem>

#include "pliant/edit.h"
#include "pliant/error.h"
#include "pliant/io.h"
#include "pliant/save.h"
#include "support/scenes.h"
#include "write_support.h"

namespace pliant {
namespace {

constexpr float frame_time = 1.f / 60;

Scene sheet_over_ball() {
  Scene scene;
  ClothOptions options;
  options.name = "sheet";
  const int sheet = scene.add_cloth(grid_mesh(9, 9, 1, 1), options);
  scene.pin(sheet, {0});
  Collider ball;
  ball.name = "ball";
  ball.shape = Sphere{0.2f};
  ball.position = {0, -0.3f, 0};
  scene.add(ball);
  MeshCollider ground;
  ground.name = "ground";
  ground.mesh = grid_mesh(3, 3, 4, 4);
  for (Vec3f& x : ground.mesh.positions) x.y -= 1;
  scene.add(ground);
  return scene;
}

void advance(World& world, int frames) {
  for (int i = 0; i < frames; ++i) world.step(frame_time);
}

std::string why(const auto& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(SaveBytes, AreThoseOfTheFile) {
  const test::Folder folder;
  const Scene scene = sheet_over_ball();
  World world(scene);
  advance(world, 3);
  save(folder / "state", world.state(), scene);
  save(folder / "world", world, scene);
  const auto text = [](const std::vector<std::byte>& bytes) {
    return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  };
  EXPECT_EQ(text(save_bytes(world.state(), fingerprint(scene))), test::read(folder / "state"));
  EXPECT_EQ(text(save_bytes(world, scene)), test::read(folder / "world"));
}

TEST(SaveBytes, AStateAndAWorldGoOnInTheSameBits) {
  const Scene scene = sheet_over_ball();
  World world(scene);
  advance(world, 3);
  const std::vector<std::byte> state = save_bytes(world.state()), all = save_bytes(world, scene);
  World again(scene);
  again.restore(load_state_bytes(state));
  LoadedWorld loaded = load_world_bytes(all);
  for (World* one : {&world, &again, &loaded.world}) advance(*one, 4);
  EXPECT_EQ(again.state_hash(), world.state_hash());
  EXPECT_EQ(loaded.world.state_hash(), world.state_hash());
}

TEST(SaveBytes, DamagedOnesAreRefusedWithTheirName) {
  const Scene scene = sheet_over_ball();
  std::vector<std::byte> bytes = save_bytes(World(scene).state(), fingerprint(scene));
  Scene other = scene;
  other.gravity.y = -1;
  EXPECT_EQ(why([&] { load_state_bytes(bytes, fingerprint(scene)); }), "");
  EXPECT_NE(
      why([&] { load_state_bytes(bytes, fingerprint(other), "blob"); }).find("blob: was saved with another scene"),
      std::string::npos);
  EXPECT_NE(why([&] { load_world_bytes(bytes, "blob"); }).find("blob: holds a State"), std::string::npos);
  for (std::size_t size = 0; size < bytes.size(); size += 37)
    EXPECT_EQ(why([&] { load_state_bytes(std::span(bytes).first(size), "cut"); }).rfind("cut: ", 0), 0u) << size;
  for (std::size_t i = 0; i < bytes.size(); i += 101) {
    bytes[i] ^= std::byte{4};
    EXPECT_EQ(why([&] { load_state_bytes(bytes, "bad"); }).rfind("bad: ", 0), 0u) << i;
    bytes[i] ^= std::byte{4};
  }
}

// ------------------------------------------------------------------------------------------------ descriptions

TEST(KeptDescription, IsThatOfTheScene) {
  const Scene scene = sheet_over_ball();
  const World world(scene, KeepDescription{});
  EXPECT_TRUE(world.keeps_description());
  EXPECT_EQ(fingerprint(world.description()).scene, fingerprint(scene).scene);
  EXPECT_EQ(fingerprint(world.description()).settings, fingerprint(scene).settings);
  EXPECT_EQ(world.description().frames, scene.frames);
  EXPECT_EQ(world.object(0).description().name, "sheet");
}

TEST(KeptDescription, FollowsWhatIsAddedEditedAndRemoved) {
  World world(sheet_over_ball(), KeepDescription{});
  Object rope = make_rope({{2, 0, 0}, {2.1f, 0, 0}, {2.2f, 0, 0}});
  rope.name = "rope";
  const ObjectId added = world.add(rope);
  Collider box;
  box.name = "box";
  box.shape = Box{{0.1f, 0.1f, 0.1f}};
  box.position = {3, 0, 0};
  world.add(box);
  world.remove(world.find_collider("ball").value());
  world.remove(world.find("sheet").value());
  advance(world, 3);
  rope.positions.push_back({2.3f, 0, 0});
  rope.masses.push_back(rope.masses.back());
  world.edit(added, {rope, {0, 1, 2, -1}});
  advance(world, 2);
  const Scene now = world.description();
  ASSERT_EQ(now.objects.size(), 1u);
  EXPECT_EQ(now.objects[0].positions.size(), 4u);
  ASSERT_EQ(now.colliders.size(), 1u);
  EXPECT_EQ(now.colliders[0].name, "box");
  EXPECT_EQ(now.mesh_colliders.at(0).name, "ground");
  LoadedWorld loaded = load_world_bytes(save_bytes(world));
  advance(world, 3);
  advance(loaded.world, 3);
  EXPECT_EQ(loaded.world.state_hash(), world.state_hash());
  EXPECT_TRUE(loaded.world.keeps_description());
}

TEST(KeptDescription, IsRefusedWhereItWasNotAskedFor) {
  const World world(sheet_over_ball());
  EXPECT_FALSE(world.keeps_description());
  EXPECT_NE(why([&] { (void)world.description(); }).find("make it with KeepDescription"), std::string::npos);
  EXPECT_NE(why([&] { save_bytes(world); }).find("KeepDescription"), std::string::npos);
  EXPECT_NE(why([&] { (void)world.object(0).description(); }).find("KeepDescription"), std::string::npos);
}

}  // namespace
}  // namespace pliant
