// Tests that ties with compliance hold in every sweep, also where the body touches something and has joints.
#include <gtest/gtest.h>

#include <cmath>

#include "pliant/body.h"
#include "pliant/joint.h"
#include "pliant/world.h"

namespace pliant {
namespace {

constexpr float compliance = 1e-3f, mass = 1, gravity = 9.81f;

/// Two boxes with a joint that stand on the ground; a particle is tied to one of them in mid-air.
Scene tied_to_standing_boxes(Sweep sweep) {
  Object object;
  object.name = "boxes";
  for (const float x : {-0.3f, 0.3f}) add_body(object, {{Box{{0.25f, 0.25f, 0.25f}}}}, {.position = {x, 0.25f, 0}});
  add_joint(object, FixedJoint{.a = 0, .b = 1, .anchor = {0, 0.25f, 0}});
  Object weight;
  weight.positions = {{0.6f, 0.6f, 0}};
  weight.masses = {mass};
  const int particle = append(object, weight);
  attach(object, {particle}, 1, Stiffness::compliance(compliance));
  object.sweep = sweep;
  Scene scene;
  scene.colliders.emplace_back();
  scene.add(object);
  return scene;
}

class TiedSweeps : public testing::TestWithParam<Sweep> {};

TEST_P(TiedSweeps, YieldByForceTimesCompliance) {
  World world(tied_to_standing_boxes(GetParam()));
  for (int frame = 0; frame < 240; ++frame) {
    const Report report = world.step(1.f / 60);
    ASSERT_TRUE(report.ok()) << report.explain();
  }
  double mean = 0;  // over a second, as nothing damps the weight
  for (int frame = 0; frame < 60; ++frame) {
    world.step(1.f / 60);
    mean += double(0.6f - world.object(world.objects()[0]).positions().back().y) / 60;
  }
  EXPECT_NEAR(mean, double(mass * gravity * compliance), 0.1 * double(mass * gravity * compliance));
}

INSTANTIATE_TEST_SUITE_P(Of, TiedSweeps, testing::Values(Sweep::tiled, Sweep::chains),
                         [](const auto& of) { return sweep_name(of.param); });

}  // namespace
}  // namespace pliant
