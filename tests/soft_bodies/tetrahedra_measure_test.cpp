// Tests the measure of tetrahedra against volumes computed one by one.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "soft_body_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// A box of 1 m with corners moved at random, of which none is fixed.
World shaken(float by) {
  SoftBodyOptions options;
  options.name = "jelly";
  options.material = solid_of(1e4f, 0.3f);
  Object body = make_soft_body(box_tetrahedra({1, 1, 1}, {4, 4, 4}), options);
  keep_rest_shape(body);
  std::mt19937 random(3);
  const auto some = [&] { return by * (static_cast<float>(random()) / 2147483648.f - 1); };
  for (Vec3f& p : body.positions) p += Vec3f{some(), some(), some()};
  return World(scene_of(std::move(body), 10));
}

TEST(TetrahedraMeasure, IsOneAtRest) {
  const TetrahedraMeasure measure = shaken(0).measure().tetrahedra();
  EXPECT_EQ(measure.tetrahedra, static_cast<std::int64_t>(box_tetrahedra({1, 1, 1}, {4, 4, 4}).tetrahedra.size()));
  EXPECT_EQ(measure.inverted, 0);
  EXPECT_NEAR(measure.least_ratio, 1, 1e-4);
  EXPECT_NEAR(measure.volume_ratio, 1, 1e-5);
}

TEST(TetrahedraMeasure, CountsThoseTurnedInsideOut) {
  const World world = shaken(0.2f);
  const TetrahedralMesh mesh = box_tetrahedra({1, 1, 1}, {4, 4, 4});
  const std::vector<double> now = six_volumes(positions_of(world), mesh.tetrahedra),
                            rest = six_volumes(mesh.positions, mesh.tetrahedra);
  double least = 1, sum = 0, sum_at_rest = 0;
  std::int64_t inverted = 0;
  for (std::size_t t = 0; t < now.size(); ++t) {
    least = std::min(least, now[t] / rest[t]);
    inverted += now[t] / rest[t] < 0 ? 1 : 0;
    sum += now[t];
    sum_at_rest += rest[t];
  }
  const TetrahedraMeasure measure = world.measure().tetrahedra();
  EXPECT_GT(inverted, 10);
  EXPECT_EQ(measure.inverted, inverted);
  EXPECT_NEAR(measure.least_ratio, least, 1e-4 * std::abs(least));
  EXPECT_NEAR(measure.volume_ratio, sum / sum_at_rest, 1e-4);
  EXPECT_EQ(world.object(measure.object).info().name, "jelly");
  std::array<int, 4> worst = measure.particles;
  std::sort(worst.begin(), worst.end());
  const bool is_one = std::any_of(mesh.tetrahedra.begin(), mesh.tetrahedra.end(), [&](std::array<int, 4> corners) {
    std::sort(corners.begin(), corners.end());
    return corners == worst;
  });
  EXPECT_TRUE(is_one);
}

TEST(TetrahedraMeasure, NamesNoneWithoutSoftBodies) {
  const TetrahedraMeasure measure = World(Scene{}).measure().tetrahedra();
  EXPECT_EQ(measure.tetrahedra, 0);
  EXPECT_EQ(measure.particles[0], -1);
}

}  // namespace
}  // namespace pliant
