// Soft bodies that are torn to twenty times their length and back return to their shape, by every model, with and
// without damping. Where a tetrahedron is wide and flat, the shear constraint hardly says where its least energy is,
// and a body that followed it gained energy until its values were no longer finite: 10 of these 17 ways with the
// damping of foam, and 12 without.
#include <gtest/gtest.h>

#include <cmath>

#include "matter/advice_settings.h"
#include "pliant/measurements.h"
#include "pliant/scene.h"
#include "pliant/soft_body.h"
#include "pliant/world.h"
#include "support/pulled_cube.h"

namespace pliant {
namespace {

Scene pulled_foam(float way, float damping, SolidModel model) {
  ElasticSolid material = elastic_solid("foam");
  material.damping = damping;
  material.model = model;
  return testing_support::pulled_cube(way, material);
}

/// The speed that is left after 2 s [m/s], by the kinetic energy; infinite if something isn't finite.
double speed_left(const Scene& scene, const Settings& settings) {
  World world(scene, settings);
  for (int frame = 0; frame < 120; ++frame)
    if (!world.step(scene.frame_time).ok()) return INFINITY;
  const auto measured = world.measure();
  EXPECT_EQ(measured.tetrahedra().inverted, 0);
  return std::sqrt(2 * measured.kinetic_energy() / (30 * 0.008));
}

class PulledApart : public testing::TestWithParam<SolidModel> {};

TEST_P(PulledApart, ReturnsToItsShape) {
  for (const float damping : {0.f, 0.0001f, 0.0002f})
    for (int quarters = 8; quarters <= 24; quarters += damping > 0 ? 4 : 1) {
      const float way = 0.25f * static_cast<float>(quarters);
      const Scene scene = pulled_foam(way, damping, GetParam());
      EXPECT_LT(speed_left(scene, chosen_settings(scene)), 0.001) << way << " m, damping " << damping;
    }
}

/// With a third of the default substeps and with two iterations.
TEST_P(PulledApart, StaysFiniteWithOtherSettings) {
  for (int quarters = 8; quarters <= 24; quarters += 4) {
    const Scene scene = pulled_foam(0.25f * static_cast<float>(quarters), 0, GetParam());
    Settings few = chosen_settings(scene), twice = few;
    few.substeps = few.substeps / 3;
    twice.iterations = 2;
    EXPECT_LT(speed_left(scene, few), 0.001) << quarters;
    EXPECT_LT(speed_left(scene, twice), 0.001) << quarters;
  }
}

INSTANTIATE_TEST_SUITE_P(Models, PulledApart,
                         testing::Values(SolidModel::neo_hookean, SolidModel::corotational,
                                         SolidModel::st_venant_kirchhoff));

}  // namespace
}  // namespace pliant
