// Cohesion of grains: what a contact bears, what a bulk bears, and that none changes nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "grains/grain_support.h"
#include "pliant/grains.h"
#include "pliant/liquid.h"
#include "pliant/world.h"
#include "support/paths.h"
#include "support/refusal.h"
#include "support/same_bits.h"

namespace pliant {
namespace {

using testing_support::grain_diameter;
using testing_support::grain_radius;
using testing_support::gravity;

constexpr double pi = 3.14159265358979;

/// The tensile stress at which a contact bears a force: Rumpf's, with 0.6 of the volume filled and six contacts a
/// grain.
float stress_of(double force) {
  return static_cast<float>(force * 0.6 * 6 /
                            (pi * static_cast<double>(grain_diameter) * static_cast<double>(grain_diameter)));
}

double weight_of_grain() {
  return static_cast<double>(make_grains({{}}, {.grains = {.radius = grain_radius}}).masses[0]) *
         static_cast<double>(gravity);
}

/// How far a grain is from a fixed one that it hangs on, after a load has slowly grown to `force` [N] [m].
float gap_under(double force, float cohesion, float cohesion_of_other, int substeps) {
  Scene scene;
  scene.add(make_grains({{0, 0, 0}}, {.name = "fixed", .grains = {.radius = grain_radius, .cohesion = cohesion}}));
  scene.add(
      make_grains({{0, -grain_diameter, 0}}, {.grains = {.radius = grain_radius, .cohesion = cohesion_of_other}}));
  scene.objects[0].masses[0] = INFINITY;
  scene.gravity = {};
  scene.settings.threads = 1;
  scene.settings.substeps = substeps;
  World world(scene);
  for (int i = 0; i < 200; ++i) {  // a load that is put on at once would swing
    const Vec3f load{0, -static_cast<float>(force) * std::min(1.f, static_cast<float>(i) / 160), 0};
    world.object(ObjectId{1}).set_forces(std::vector<Vec3f>{load});
    EXPECT_TRUE(world.step(1.f / 60).ok());
  }
  return -grain_diameter - world.object(ObjectId{1}).positions()[0].y;
}

TEST(Cohesion, HoldsAKnownWeightAndPartsAboveIt) {
  for (const double weights : {1., 4.})
    for (const int substeps : {30, 60}) {
      const double pull = weights * weight_of_grain();
      EXPECT_LT(gap_under(0.97 * pull, stress_of(pull), stress_of(pull), substeps), 0.1f * grain_diameter) << pull;
      EXPECT_GT(gap_under(1.03 * pull, stress_of(pull), stress_of(pull), substeps), grain_diameter) << pull;
    }
}

TEST(Cohesion, OfTwoKindsIsTheLesser) {
  const double pull = weight_of_grain();
  EXPECT_LT(gap_under(0.97 * pull, stress_of(pull), stress_of(3 * pull), 60), 0.1f * grain_diameter);
  EXPECT_GT(gap_under(1.03 * pull, stress_of(pull), stress_of(3 * pull), 60), grain_diameter);
  EXPECT_GT(gap_under(0.05 * pull, 0, stress_of(3 * pull), 60), grain_diameter);
}

/// A block of sand, 6 diameters wide, in a mould of planes that withdraws after half a second.
Scene block_of_sand(const std::string& kind, float cohesion) {
  constexpr float width = 6 * grain_diameter, r = 0.70710678f;
  const GrainKind& of = grain_kind(kind);
  std::vector<Vec3f> places = fill_box({0, 0, 0}, {width, 12 * grain_diameter, width}, 1.3f * grain_diameter);
  std::uint32_t seed = 1;
  const auto next = [&] {
    seed = seed * 1664525u + 1013904223u;
    return (static_cast<float>(seed >> 8) / static_cast<float>(1 << 24) - 0.5f) * 0.28f * grain_diameter;
  };
  for (Vec3f& p : places) p = {p.x + next(), p.y + next(), p.z + next()};  // in no order, which would stand
  Scene scene;
  scene.add(make_grains(places, {.grains = {grain_radius, of.density, of.friction, cohesion}}));
  const auto add_wall = [&](const Vec3f& at, const Quatf& rotation, const Vec3f& way) {
    Collider wall;
    wall.position = at;
    wall.rotation = rotation;
    wall.static_friction = wall.kinetic_friction = 0;
    if (length_squared(way) > 0) wall.motion.keyframes = {{.time = 0.5}, {.time = 1, .position = way}};
    scene.add(wall);
  };
  add_wall({}, {0, 0, 0, 1}, {});
  add_wall({}, {0, 0, -r, r}, {-0.5f, 0, 0});
  add_wall({width, 0, 0}, {0, 0, r, r}, {0.5f, 0, 0});
  add_wall({}, {r, 0, 0, r}, {0, 0, -0.5f});
  add_wall({0, 0, width}, {-r, 0, 0, r}, {0, 0, 0.5f});
  scene.colliders[0].static_friction = scene.colliders[0].kinetic_friction = 1;
  scene.settings.threads = 1;
  return scene;
}

float height_after(const Scene& scene, int frames) {
  World world(scene);
  for (int i = 0; i < frames; ++i) EXPECT_TRUE(world.step(1.f / 60).ok());
  std::vector<float> heights;
  for (const Vec3f& p : world.object(0).positions()) heights.push_back(p.y);
  std::sort(heights.begin(), heights.end());
  return heights[heights.size() * 9 / 10];
}

TEST(Cohesion, LetsABlockStandThatFallsWhenDry) {
  const Scene wet = block_of_sand("wet sand", grain_kind("wet sand").cohesion), dry = block_of_sand("dry sand", 0);
  EXPECT_GT(height_after(wet, 120), 0.95f * height_after(wet, 30));
  EXPECT_LT(height_after(dry, 120), 0.6f * height_after(dry, 30));
}

TEST(Cohesion, KeepsMomentum) {
  Scene scene = block_of_sand("wet sand", 1000);
  scene.colliders.clear();
  scene.gravity = {};
  Object& sand = scene.objects[0];
  for (const Vec3f& p : sand.positions) sand.velocities.push_back({p.y > 0.08f ? 0.5f : 0.f, 0, p.x});
  Vec3d before{};
  for (const Vec3f& v : sand.velocities) before += Vec3d{v.x, v.y, v.z};
  World world(scene);
  for (int i = 0; i < 30; ++i) ASSERT_TRUE(world.step(1.f / 60).ok());
  Vec3d after{};
  for (const Vec3f& v : world.object(0).velocities()) after += Vec3d{v.x, v.y, v.z};
  EXPECT_LT(std::sqrt(length_squared(after - before)), 1e-5 * std::sqrt(length_squared(before)));
}

TEST(Cohesion, HasTheSameBitsOnAnyThreadsAndLevels) {
  Scene scene = block_of_sand("wet sand", 1000);
  testing_support::expect_same_bits_on_any_threads_and_levels(scene, {10});
}

TEST(Cohesion, GoesOnFromARestoredStateWithTheSameBits) {
  const Scene scene = block_of_sand("wet sand", 1000);
  testing_support::expect_same_bits_after_a_restore(scene, {5});
}

TEST(Cohesion, OutOfRangeIsNamed) {
  EXPECT_NE(testing_support::refusal([] { make_grains({{}}, {.grains = {.cohesion = -1}}); }).find("cohesion"),
            std::string::npos);
  Scene scene = block_of_sand("dry sand", 0);
  scene.objects[0].grains->cohesion = 1e12f;
  const std::string words = testing_support::refusal([&] { const World world(scene); });
  EXPECT_NE(words.find("'grains'"), std::string::npos) << words;
  EXPECT_NE(words.find("cohesion"), std::string::npos) << words;
}

TEST(Cohesion, IsSaidToActInPartWhereSubstepsAreTooLong) {
  const auto is_said = [](int substeps) {
    Scene scene = block_of_sand("wet sand", 1e5f);
    scene.settings.substeps = substeps;
    const std::vector<Finding> findings = inspect(scene);
    return std::any_of(findings.begin(), findings.end(), [](const Finding& finding) {
      return finding.message.find("of the cohesion can act") != std::string::npos;
    });
  };
  EXPECT_TRUE(is_said(20));
  EXPECT_FALSE(is_said(0));
  EXPECT_FALSE(is_said(chosen_substeps(block_of_sand("wet sand", 1e5f))[0]));
}

std::string number(float value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

TEST(KindsOfGrains, AreThoseOfThePage) {
  std::ifstream file(test::in_tree("docs/guide/grains.md"));
  std::stringstream page;
  page << file.rdbuf();
  std::string table = "| kind | density, kg/m^3 | friction | cohesion, Pa |\n|---|---|---|---|\n";
  for (const GrainKind& of : grain_kinds())
    table += "| " + of.name + " | " + number(of.density) + " | " + number(of.friction) + " | " + number(of.cohesion) +
             " |\n";
  EXPECT_NE(page.str().find(table), std::string::npos) << table;
  for (const GrainKind& of : grain_kinds()) {
    const std::string line = "- **" + of.name + "**: " + of.source + "\n";
    EXPECT_NE(page.str().find(line), std::string::npos) << line;
  }
}

TEST(KindsOfGrains, AreFoundByName) {
  for (const GrainKind& of : grain_kinds()) EXPECT_EQ(grain_kind(of.name).name, of.name);
  EXPECT_NE(testing_support::refusal([] { grain_kind("snow"); }).find("wet sand"), std::string::npos);
}

}  // namespace
}  // namespace pliant
