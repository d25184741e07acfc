// Rods that stay bent.
#include <cmath>

#include "pliant/edit.h"
#include "rods/rod_support.h"

namespace pliant {
namespace {

using namespace testing_support;

constexpr double length_of_rod = 1;
constexpr float radius_of_rod = 0.01f;
constexpr int segments_of_rod = 20;

/// A rod clamped at x = 0 that is loaded across at its tip with a force, then let go: the angle of its last segment
/// afterwards [rad].
double angle_left(double strain_at_clamp, const Plasticity& plasticity, int substeps, const Vec3f& clamp = {}) {
  RodMaterial material = material_of(1e8, 4e7, 1000);
  material.damping = 0.002f;
  material.plasticity = plasticity;
  Object rod =
      make_rod(line(clamp, clamp + Vec3f{length_of_rod, 0, 0}, segments_of_rod), clamped_rod(material, radius_of_rod));
  rod.damping = 15;  // over critical: it must not swing beyond where it is to be
  Lone lone(rod, substeps, false);
  const double moment =
      strain_at_clamp / static_cast<double>(radius_of_rod) * 1e8 * second_moment(static_cast<double>(radius_of_rod));
  std::vector<Vec3f> forces(rod.positions.size());
  forces[segments_of_rod - 1] = {0, -static_cast<float>(moment / length_of_rod), 0};
  for (int frame = 0; frame < 300; ++frame) {
    lone.world.object(0).set_forces(forces);
    lone.run(1.0 / 60);
  }
  lone.run(8);
  const Vec3d along = lone.position(segments_of_rod - 1) - lone.position(segments_of_rod - 2);
  return std::atan2(-along.y, along.x);
}

TEST(PlasticRod, SpringsBackBelowItsYieldStrain) { EXPECT_NEAR(angle_left(0.002, {.yield = 0.0025f}, 20), 0, 2e-4); }

// The moment falls linearly to the tip. Without hardening nothing bears more than the yield moment: so it folds at the
// clamp.
TEST(PlasticRod, StaysBentBeyondIt) { EXPECT_GT(angle_left(0.004, {.yield = 0.0025f}, 20), 0.02); }

TEST(PlasticRod, YieldsAtAClampWhereverThatIs) {
  const double at_origin = angle_left(0.0027, {.yield = 0.0025f}, 20);
  EXPECT_GT(at_origin, 1e-3);
  EXPECT_NEAR(angle_left(0.0027, {.yield = 0.0025f}, 20, {5, 2, -3}) / at_origin, 1, 0.02);
}

/// The angle that is left of a rod that was held in an arc and is let go. As it springs back it is elastic: its ends
/// overshoot.
double arc_left(double angle, double yield, int substeps) {
  RodMaterial material = material_of(1e8, 4e7, 1000);
  material.damping = 0.002f;
  material.plasticity = Plasticity{.yield = static_cast<float>(yield)};
  std::vector<Vec3f> arc;
  for (int i = 0; i <= segments_of_rod; ++i) {
    const double at = angle * (static_cast<double>(i) / segments_of_rod - 0.5), r = length_of_rod / angle;
    arc.push_back({static_cast<float>(r * std::sin(at)), static_cast<float>(r * std::cos(at) - r), 0});
  }
  RodOptions options;
  options.material = material;
  options.radius = radius_of_rod;
  options.straight = true;  // so it is held by its ends in an arc, and would be straight
  Object rod = make_rod(arc, options);
  rod.damping = 10;
  Lone lone(rod, substeps, false);
  (void)lone.world.step(1e-5f);  // what is beyond the yield strain flows before anything moves
  Edit elastic = unchanged(rod);
  for (ConstraintGroup& group : elastic.object.constraints) group.plasticity = Plasticity{.yield = 1e30f};
  lone.world.edit(0, elastic);
  lone.run(8);
  const auto direction = [&](int i) {
    const Vec3d d = lone.position(i + 1) - lone.position(i);
    return std::atan2(d.y, d.x);
  };
  return (direction(0) - direction(segments_of_rod - 2)) * segments_of_rod / (segments_of_rod - 2.0);
}

TEST(PlasticRod, AnArcKeepsTheCurvatureBeyondTheYieldStrain) {
  const double angle = 1.5, strain = angle * static_cast<double>(radius_of_rod) / length_of_rod;
  EXPECT_NEAR(arc_left(angle, strain * 1.01, 20), 0, 1e-3);
  for (const double share : {0.2, 0.6})
    EXPECT_NEAR(arc_left(angle, strain * share, 20) / (angle * (1 - share)), 1, 0.03) << share;
}

}  // namespace
}  // namespace pliant
