// Tests what saving and loading refuse: anything but a complete file of this format, with the reason.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <random>
#include <span>

#include "pliant/error.h"
#include "pliant/save.h"
#include "save_support.h"
#include "support/scenes.h"
#include "write_support.h"

namespace pliant {
namespace {

using namespace testing_support;
using test::Folder;

TEST(Save, EveryCutAndEveryFlippedBitIsRefused) {
  const Folder folder;
  const std::string path = folder / "state";
  State state;
  state.positions = state.remainders = state.velocities = Records(2);
  save(path, state);
  const std::string whole = test::read(path);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    test::put(path, whole.substr(0, size));
    const std::string why = reason([&] { load_state(path); });
    ASSERT_EQ(why.rfind(path + ": is ", 0), 0u) << size << " " << why;
  }
  test::put(path, whole + "x");
  EXPECT_NE(reason([&] { load_state(path); }).find("header says"), std::string::npos);
  std::vector<std::byte> bytes = save_bytes(state);  // as in the file
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    bytes[bit / 8] ^= std::byte(1 << (bit % 8));
    ASSERT_EQ(reason([&] { load_state_bytes(bytes, "it"); }).rfind("it: ", 0), 0u) << "bit " << bit;
    bytes[bit / 8] ^= std::byte(1 << (bit % 8));
  }
}

TEST(Save, TheReasonIsNamed) {
  const Folder folder;
  const std::string path = folder / "state";
  const auto why = [&](const std::string& bytes) {
    test::put(path, bytes);
    return reason([&] { load_state(path); });
  };
  const auto says = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  save(path, State{});
  const std::string whole = test::read(path);
  std::string changed = whole;
  changed[8] = 2;
  says(why(changed), "has format version 2, and this Pliant reads version 24; use the Pliant that wrote it");
  says(why(""), "is empty");
  says(why("o cloth\nv 0 0 0\n"), "is not a file saved by Pliant");
  says(why(whole.substr(0, 100)),
       "is incomplete or damaged: its header says " + std::to_string(whole.size()) + " bytes, it has 100");
  changed = whole;
  changed[60] ^= 1;
  says(why(changed), "is damaged: its checksum");
  const Scene scene = full_scene();
  const World world(scene);
  save(path, world, scene);
  says(reason([&] { load_state(path); }), "holds a World, not a State; load it as a World");
  save(path, State{});
  says(reason([&] { load_world(path); }), "holds a State, not a World");
  says(reason([&] { load_state(folder.path()); }), "is a folder");
  says(reason([&] { load_state(folder / "missing"); }), "cannot open");
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  says(reason([&] { load_state(folder / "pipe"); }), "is a pipe");
}

/// With a correct checksum, so that only the sizes themselves can be found wrong.
TEST(Save, ForgedSizesAreRefusedBeforeMemoryIsTaken) {
  const Folder folder;
  const std::string path = folder / "state";
  save(path, State{});
  const std::string whole = test::read(path);
  const std::size_t count_of_blocks = 24, first_block = 32, element_size = first_block + 28, count = first_block + 32;
  for (const std::uint64_t huge :
       {std::uint64_t{2}, std::uint64_t{1} << 31, std::uint64_t{1} << 61, ~std::uint64_t{0}}) {
    for (const std::size_t at : {count_of_blocks, count}) {
      std::string forged = whole;
      forged.replace(at, 8, reinterpret_cast<const char*>(&huge), 8);
      test::put(path, sealed(forged));
      ASSERT_NE(reason([&] { load_state(path); }).find("is malformed"), std::string::npos) << at << " " << huge;
    }
  }
  for (const std::uint32_t size : {0u, 16u, ~0u}) {
    std::string forged = whole;
    forged.replace(element_size, 4, reinterpret_cast<const char*>(&size), 4);
    test::put(path, sealed(forged));
    ASSERT_NE(reason([&] { load_state(path); }).find("is malformed"), std::string::npos) << size;
  }
  std::string renamed = whole;
  renamed[first_block] = 'S';
  test::put(path, sealed(renamed));
  EXPECT_NE(reason([&] { load_state(path); }).find("block 'State.time', which this Pliant does not know"),
            std::string::npos);
}

/// Thousands of forged files of a World, each with a correct checksum: an Error or a World, never a crash or
/// bad_alloc.
TEST(Save, AForgedWorldIsRefusedOrLoaded) {
  const Folder folder;
  const std::string path = folder / "world";
  Scene scene;
  scene.add(testing_support::chain(3, 0.1f));
  Collider ball;
  ball.shape = Sphere{0.1f};
  scene.add(ball);
  save(path, World(scene), scene);
  const std::string whole = test::read(path);
  std::mt19937 random(7);
  int refused = 0;
  for (int i = 0; i < 2000; ++i) {
    std::string forged = whole;
    for (int k = 1 + static_cast<int>(random() % 3); k > 0; --k)
      forged[24 + random() % (forged.size() - 56)] = static_cast<char>(i % 2 == 0 ? random() : 255);
    const std::string bytes = sealed(forged);
    refused += reason([&] { load_world_bytes(std::as_bytes(std::span(bytes))); }).empty() ? 0 : 1;
  }
  EXPECT_GT(refused, 500);
  EXPECT_LT(refused, 2000) << "a colour may be anything";
}

TEST(Save, AnotherSceneIsRefusedAndThisOneIsNotForItsColours) {
  const Folder folder;
  const std::string path = folder / "state";
  const Scene scene = full_scene();
  save(path, World(scene).state(), scene);
  const auto with = [&](const auto& change) {
    Scene other = scene;
    change(other);
    return reason([&] { load_state(path, other); });
  };
  const auto is_another = [&](const auto& change) {
    return with(change).find("was saved with another scene") != std::string::npos;
  };
  const auto has_other_settings = [&](const auto& change) {
    return with(change).find("was saved with other settings") != std::string::npos;
  };
  EXPECT_EQ(with([](Scene&) {}), "");
  EXPECT_EQ(with([](Scene& s) { s.objects[0].colour.x = 1; }), "");
  EXPECT_EQ(with([](Scene& s) { s.frames = 7; }), "");
  EXPECT_EQ(with([](Scene& s) { s.settings.threads = 2; }), "");
  EXPECT_EQ(with([](Scene& s) { s.settings.isa = "x86-64-v2"; }), "");
  EXPECT_EQ(with([](Scene& s) { s.mesh_colliders[1].field = nullptr; }), "") << "it is measured again";
  EXPECT_TRUE(is_another([](Scene& s) { s.gravity.y = -9.5f; }));
  EXPECT_TRUE(is_another([](Scene& s) { s.objects[0].positions[3].x += 1e-7f; }));
  EXPECT_TRUE(is_another([](Scene& s) { s.objects[1].volume->pressure = 2; }));
  EXPECT_TRUE(is_another([](Scene& s) { s.objects[1].volume->keyframes = {{0, 2}}; }));
  EXPECT_TRUE(is_another([](Scene& s) { s.objects[1].volume->leak = 1; }));
  EXPECT_TRUE(is_another([](Scene& s) { s.objects[0].pins[0].motion.keyframes[1].time = 2; }));
  EXPECT_TRUE(is_another([](Scene& s) { s.colliders[0].shape = Capsule{0.1f, 0.31f}; }));
  EXPECT_TRUE(is_another([](Scene& s) { s.mesh_colliders.pop_back(); }));
  EXPECT_TRUE(is_another([](Scene& s) { s.pairs[0].thickness = 0.02f; }));
  EXPECT_TRUE(is_another([](Scene& s) { s.frame_time = 0.02f; }));
  EXPECT_TRUE(is_another([](Scene& s) { s.forces.push_back([](const auto&...) { return Vec3f{}; }); }));
  EXPECT_TRUE(has_other_settings([](Scene& s) { s.settings.substeps = 6; }));
  EXPECT_TRUE(has_other_settings([](Scene& s) { s.settings.contact_filter = false; }));
  save(path, World(scene).state());
  EXPECT_NE(with([](Scene&) {}).find("does not say which scene"), std::string::npos);
}

TEST(Save, WhatCannotBeSavedSaysSo) {
  const Folder folder;
  Scene scene = full_scene();
  const World world(scene);
  Scene other = scene;
  other.objects[0].name = "shirt";
  EXPECT_NE(reason([&] { save(folder / "w", world, other); }).find("object 'shirt'"), std::string::npos);
  other = scene;
  other.objects.pop_back();
  EXPECT_NE(reason([&] { save(folder / "w", world, other); }).find("3 objects and the scene 2"), std::string::npos);
  scene.forces.push_back([](const auto&...) { return Vec3f{}; });
  EXPECT_NE(reason([&] { save(folder / "w", World(scene), scene); }).find("force fields"), std::string::npos);
  EXPECT_TRUE(folder.names().empty());
  const std::string nowhere = folder / "no/w";
  EXPECT_EQ(reason([&] { save(nowhere, State{}); }).rfind(nowhere + ": ", 0), 0u);
}

}  // namespace
}  // namespace pliant
