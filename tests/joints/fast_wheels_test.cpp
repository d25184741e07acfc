// Tests wheels that turn by radians in a substep: a bearing that stands still neither speeds them up nor slows them
// down.
#include <gtest/gtest.h>

#include <algorithm>

#include "joint_support.h"

namespace pliant {
namespace {

using namespace testing_support;

constexpr int wheel_substeps = 8;

/// The angular velocity at which a body turns by `angle` in a substep [rad/s].
float spin_of(float angle) { return angle * 60 * wheel_substeps; }

struct Wheel {
  float radius = 0.3f, half_width = 0.02f;
};

int add_wheel(Object& object, const Wheel& wheel, const Vec3f& at, const Vec3f& spin) {
  BodyOptions options;
  options.position = at;
  options.mass = 2;
  options.angular_velocity = spin;
  options.rotation = normalise(Quatf{0, 0, 1, 1});  // a cylinder is along y; the wheel along x
  return add_body(object, {{Cylinder{wheel.radius, wheel.half_width}, {}, {}, 1000}}, options);
}

TEST(FastWheels, KeepTheirSpeedOnAHinge) {
  for (const Wheel& wheel : {Wheel{0.3f, 0.02f}, Wheel{0.3f, 0.1f}, Wheel{0.1f, 0.3f}})
    for (const float angle : {0.3f, 0.6f, 1.f, 1.2f, 1.5f, 2.f, 3.f, 5.f}) {
      Mechanism m;
      m.substeps = wheel_substeps;
      const int b = add_wheel(m.object, wheel, {0, 0, 0}, {spin_of(angle), 0, 0});
      add_joint(m.object, HingeJoint{.a = -1, .b = b, .anchor = {0, 0, 0}, .axis = {1, 0, 0}});
      m.run(4);
      EXPECT_NEAR(m.spin(b).x / spin_of(angle), 1, 2e-4) << angle << " rad a substep, half width " << wheel.half_width;
      EXPECT_LT(length(m.velocity(b)), 1e-2);
    }
}

/// Holding velocities, which keeps a wheel on a bearing at its speed, would make a light frame swing more and more.
TEST(FastWheels, KeepTheirEnergyInALightFreeFrame) {
  for (const float angle : {1.2f, 2.f, 3.f}) {
    Mechanism m;
    m.substeps = wheel_substeps;
    const int wheel = add_wheel(m.object, {}, {0, 0, 0}, {spin_of(angle), 0, 0});
    const int frame = m.box({0.5f, 0.4f, 0}, 1, {0.1f, 0.1f, 0.1f});
    add_joint(m.object, HingeJoint{.a = frame, .b = wheel, .anchor = {0, 0, 0}, .axis = {1, 0, 0}});
    m.object.collides = m.object.self_collision = false;
    m.scene.gravity = {};
    m.start();
    const double start = m.world->measure().kinetic_energy();
    m.run(4);
    EXPECT_NEAR(m.world->measure().kinetic_energy() / start, 1, 1e-3) << angle;
  }
}

}  // namespace
}  // namespace pliant
