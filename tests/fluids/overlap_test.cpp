// Particles of a liquid that overlap at the start separate at a limited speed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "pliant/edit.h"
#include "pliant/liquid.h"
#include "pliant/world.h"

namespace pliant::overlaps_of_liquids {
namespace {

constexpr float spacing = 0.05f, frame = 1.f / 60;

/// A tank of 1 x 1 m with walls of 1.5 m.
Scene tank() {
  Scene scene;
  scene.add(Collider{.name = "floor", .shape = Plane{}});
  for (const float side : {-1.f, 1.f}) {
    scene.add(Collider{.name = "wall", .shape = Box{{0.05f, 0.75f, 0.6f}}, .position = {0.55f * side, 0.75f, 0}});
    scene.add(Collider{.name = "wall", .shape = Box{{0.6f, 0.75f, 0.05f}}, .position = {0, 0.75f, 0.55f * side}});
  }
  scene.settings.threads = 1;
  return scene;
}

Scene with_particles(const std::vector<Vec3f>& places) {
  Scene scene = tank();
  scene.add(make_liquid(places, {.name = "water", .fluid = {.spacing = spacing}}));
  return scene;
}

/// 216 places within 5 mm.
std::vector<Vec3f> heap() {
  std::vector<Vec3f> places;
  for (int i = 0; i < 216; ++i)
    places.push_back({0.001f * static_cast<float>(i % 6), 0.5f + 0.001f * static_cast<float>(i / 6 % 6),
                      0.001f * static_cast<float>(i / 36)});
  return places;
}

struct Course {
  float highest = -1e9f;      ///< of any particle after any frame [m]
  std::vector<Vec3f> places;  ///< at the end [m]
  std::vector<std::string> warnings;
};

Course run(World& world, int frames) {
  Course course;
  for (int i = 0; i < frames; ++i) {
    const Report report = world.step(frame);
    EXPECT_FALSE(report.nonfinite);
    course.warnings.insert(course.warnings.end(), report.warnings.begin(), report.warnings.end());
    for (const Vec3f& p : world.object(0).positions()) course.highest = std::max(course.highest, p.y);
  }
  course.places = world.object(0).positions();
  return course;
}

/// For each place, the distance to the nearest other one [m].
std::vector<float> nearest_distances(const std::vector<Vec3f>& places) {
  std::vector<float> distances;
  for (std::size_t i = 0; i < places.size(); ++i) {
    float least = 1e9f;
    for (std::size_t k = 0; k < places.size(); ++k)
      if (k != i) least = std::min(least, std::sqrt(length_squared(places[k] - places[i])));
    distances.push_back(least);
  }
  return distances;
}

bool has_channel(const World& world) {
  const std::vector<Channel>& channels = world.state().channels;
  return std::any_of(channels.begin(), channels.end(), [](const Channel& one) { return one.name == "overlap"; });
}

TEST(LiquidOverlap, OfAHeapSeparatesWithoutAFountain) {
  World world(with_particles(heap()));
  const Course of = run(world, 120);
  // The ball of 216 particles has a radius of 0.19 m; it flew 58 m high.
  EXPECT_LT(of.highest, 0.5f + 0.2f + 0.05f);
  std::vector<float> distances = nearest_distances(of.places);
  std::sort(distances.begin(), distances.end());
  EXPECT_GT(distances[distances.size() / 2], 0.5f * spacing);
  EXPECT_FALSE(has_channel(world)) << "what has parted is limited no more";
}

TEST(LiquidOverlap, OfCoincidentParticlesEnds) {
  World world(with_particles(std::vector<Vec3f>(50, Vec3f{0, 0.5f, 0})));
  const Course of = run(world, 120);
  EXPECT_LT(of.highest, 0.5f + 0.12f + 0.05f);
  for (const float distance : nearest_distances(of.places)) EXPECT_GT(distance, 0.4f * spacing);
  std::vector<float> distances = nearest_distances(of.places);
  std::sort(distances.begin(), distances.end());
  EXPECT_NEAR(distances[25], spacing, 0.3f * spacing);
}

TEST(LiquidOverlap, OfTwoFillsRaisesTheLevelOnce) {
  const Vec3f low{-0.5f, 0, -0.5f}, high{0.5f, 0.3f, 0.5f}, shift{0.01f, 0.02f, 0.015f};
  std::vector<Vec3f> places = fill_box(low, high, spacing);
  for (const Vec3f& p : fill_box(low, high, spacing))
    if (p.x < 0) places.push_back(p + shift);
  World world(with_particles(places));
  const Course of = run(world, 90);
  EXPECT_FALSE(has_channel(world));
  EXPECT_LT(of.highest, 0.75f);  // the volume of half of the tank is 0.6 m high
}

TEST(LiquidOverlap, WarnsWithTheObjectAndTheNumberOfParticles) {
  World world(with_particles(heap()));
  const Course of = run(world, 2);
  ASSERT_FALSE(of.warnings.empty());
  EXPECT_NE(of.warnings[0].find("object 'water': 216 particles"), std::string::npos) << of.warnings[0];
  EXPECT_EQ(of.warnings.size(), 1U) << "once";
}

TEST(LiquidOverlap, WithASolidIsWarnedOf) {
  Scene scene = with_particles({{0, 0.5f, 0}, {0.06f, 0.5f, 0}, {0.3f, 0.5f, 0}});
  scene.add(Collider{.name = "rock", .shape = Sphere{0.1f}, .position = {0, 0.5f, 0}});
  World world(scene);
  const Course of = run(world, 2);
  ASSERT_EQ(of.warnings.size(), 1U);
  EXPECT_NE(of.warnings[0].find("object 'water': 2 particles start inside 'rock'"), std::string::npos)
      << of.warnings[0];
}

TEST(LiquidOverlap, IsNoneInALattice) {
  World world(with_particles(fill_box({-0.5f, 0, -0.5f}, {0.5f, 0.2f, 0.5f}, spacing)));
  EXPECT_FALSE(has_channel(world));
  EXPECT_TRUE(run(world, 1).warnings.empty());
}

TEST(LiquidOverlap, IsLimitedInWhatIsAddedAndEdited) {
  World world(with_particles(fill_box({-0.5f, 0, -0.5f}, {-0.4f, 0.1f, -0.4f}, spacing)));
  EXPECT_TRUE(run(world, 1).warnings.empty());
  const Object water = make_liquid(heap(), {.name = "more", .fluid = {.spacing = spacing}});
  const ObjectId added = world.add(water);
  const Report report = world.step(frame);
  ASSERT_EQ(report.warnings.size(), 1U);
  EXPECT_NE(report.warnings[0].find("object 'more': 216 particles"), std::string::npos) << report.warnings[0];
  for (const Vec3f& v : world.object(added).velocities()) EXPECT_LT(std::sqrt(length_squared(v)), 1);
  Edit edit{water, std::vector<int>(216, -1)};
  (void)world.edit(added, edit);
  EXPECT_TRUE(has_channel(world));
  EXPECT_EQ(world.step(frame).warnings.size(), 1U);
}

TEST(LiquidOverlap, GoesOnWithTheSameBitsAfterARestore) {
  const Scene scene = with_particles(heap());
  World world(scene), other(scene);
  (void)run(world, 3);
  EXPECT_TRUE(has_channel(world));
  other.restore(world.state());
  (void)run(world, 20);
  (void)run(other, 20);
  EXPECT_EQ(world.state_hash(), other.state_hash());
}

}  // namespace
}  // namespace pliant::overlaps_of_liquids
