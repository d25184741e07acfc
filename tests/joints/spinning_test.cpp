// Tests bodies on joints that turn by more than a radian in a substep.
#include <gtest/gtest.h>

#include "joint_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// A disc or shaft that turns about y on a hinge through its centre, without gravity.
Mechanism spinning(float half_length, float speed) {
  Mechanism m;
  m.substeps = 8;
  m.scene.gravity = {};
  BodyOptions options;
  options.name = "disc";
  options.angular_velocity = {0, speed, 0};
  const int disc = add_body(m.object, {{Cylinder{0.1f, half_length}, {}, {}, 2700}}, options);
  add_joint(m.object, HingeJoint{.b = disc, .axis = {0, 1, 0}});
  return m;
}

// Corrections over the length of the substep, as velocities, made the disc gain energy from 1.17 rad in a substep on.
TEST(FastBodies, KeepTheirSpeedOnAHinge) {
  for (const float half_length : {0.01f, 0.05f, 0.4f})
    for (const float speed : {300.f, 560.f, 600.f, 900.f, 1500.f, 3000.f}) {
      Mechanism m = spinning(half_length, speed);
      m.run(5);
      EXPECT_NEAR(length(m.spin(0)) / static_cast<double>(speed), 1, 1e-3) << half_length << " m, " << speed << " rad/s";
      EXPECT_LT(length(m.place(0, {})), 1e-4);
    }
}

TEST(FastBodies, AreDrivenAndBraked) {
  Mechanism m;
  m.substeps = 8;
  m.scene.gravity = {};
  const int disc = add_body(m.object, {{Cylinder{0.1f, 0.01f}, {}, {}, 2700}}, {.name = "disc"});
  JointMotor motor{.target = 1200, .most = 5};
  add_joint(m.object, HingeJoint{.b = disc, .axis = {0, 1, 0}, .motor = motor});
  // m r^2 / 2 = 8.48e-3 kg m^2, so 5 N m give 589.5 rad/s^2.
  m.run(0.5);
  EXPECT_NEAR(length(m.spin(0)), 294.7, 0.5);
  m.run(1.25);
  EXPECT_NEAR(length(m.spin(0)), 1031.6, 2);
  m.run(0.5);
  EXPECT_NEAR(length(m.spin(0)), 1200, 1);
}

}  // namespace
}  // namespace pliant
