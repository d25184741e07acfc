// Bags of cloth hold what is poured into them: no particle passes the cloth, and heavy grains lie on it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "pliant/pliant.h"
#include "support/paths.h"

namespace pliant {
namespace {

class Bag : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Scenes, Bag, testing::Values("bags/water", "bags/gravel"), [](const auto& scene) {
  std::string name = scene.param;
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
});

constexpr float rim = 0.5f;    ///< height of the bag's, which is held [m]
constexpr float fall = 0.06f;  ///< more than anything falls in a frame [m]

/// The cloth's size now: what lies beyond is outside.
struct Extent {
  float width = 0, bottom = 1;
};

Extent extent_of(const World& world) {
  Extent extent;
  for (const Vec3f& p : world.object(0).positions()) {
    extent.width = std::max(extent.width, std::hypot(p.x, p.z));
    extent.bottom = std::min(extent.bottom, p.y);
  }
  return extent;
}

/// Counts the particles that are in a bag, and those that have left it through its cloth. Single drops splash over the
/// rim.
struct Count {
  int inside = 0, passed = 0;
};

Count count(const World& world, std::vector<char>& was_over_rim) {
  const Extent bag = extent_of(world);
  const auto positions = world.object(1).positions();
  was_over_rim.resize(positions.size(), 1);
  Count now;
  for (const int particle : world.object(1).present()) {
    const auto i = static_cast<std::size_t>(particle);
    const Vec3f& p = positions[i];
    const bool is_in = p.y < rim && p.y > bag.bottom && std::hypot(p.x, p.z) < bag.width;
    now.inside += is_in ? 1 : 0;
    if (p.y > rim - fall)
      was_over_rim[i] = 1;
    else if (is_in)
      was_over_rim[i] = 0;
    else
      now.passed += was_over_rim[i] == 0 ? 1 : 0;
  }
  return now;
}

TEST_P(Bag, HoldsWhatIsPouredIntoIt) {
  constexpr double spilled = 0.005;  // share
  const Scene scene = read_scene(test::in_tree("scenes/" + std::string(GetParam()) + ".json"));
  World world(scene);
  std::vector<char> was_over_rim;
  Count now;
  for (int frame = 0; frame < scene.frames; ++frame) {
    const Report report = world.step(scene.frame_time);
    ASSERT_TRUE(report.ok()) << report.explain();
    now = count(world, was_over_rim);
    ASSERT_EQ(now.passed, 0) << "frame " << frame;
  }
  const auto all = static_cast<double>(world.object(1).present_positions().size());
  EXPECT_GT(all, 1000);
  EXPECT_GE(now.inside, (1 - spilled) * all) << "of " << all;
}

/// Distance of a point from a triangle's plane where it lies above the triangle, else infinity [m].
double height_above(const Vec3f& p, const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  const auto from_a = [&](const Vec3f& x) { return Vec3d{x.x, x.y, x.z} - Vec3d{a.x, a.y, a.z}; };
  const Vec3d ab = from_a(b), ac = from_a(c), ap = from_a(p);
  const Vec3d normal = cross(ab, ac);
  const double nn = dot(normal, normal), v = dot(cross(ap, ac), normal) / nn, w = dot(cross(ab, ap), normal) / nn;
  if (v < 0 || w < 0 || v + w > 1) return INFINITY;
  return std::abs(dot(ap, normal)) / std::sqrt(nn);
}

// A grain weighs 70 times as much as a particle of the cloth. With the default substeps grains lay 1 mm from the cloth,
// not their radius.
TEST(GrainBag, KeepsGrainsARadiusFromTheCloth) {
  constexpr double radius = 0.01;
  constexpr int frames = 60, settled = 20;
  const Scene scene = read_scene(test::in_tree("scenes/bags/gravel.json"));
  World world(scene);
  double least = INFINITY;
  for (int frame = 0; frame < frames; ++frame) {
    ASSERT_TRUE(world.step(scene.frame_time).ok());
    if (frame < settled || frame % 10 != 9) continue;
    const auto cloth = world.object(0).positions();
    for (const Vec3f& p : world.object(1).present_positions())
      for (const auto& t : scene.objects[0].triangles)
        least =
            std::min(least, height_above(p, cloth[static_cast<std::size_t>(t[0])],
                                         cloth[static_cast<std::size_t>(t[1])], cloth[static_cast<std::size_t>(t[2])]));
  }
  EXPECT_GT(least, 0.9 * radius);
}

}  // namespace
}  // namespace pliant
