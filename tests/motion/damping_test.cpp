// Damping of objects, joints and springs does what its time says, whatever the substeps.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "motion/modes.h"

namespace pliant {
namespace {

using namespace testing_support;

constexpr int few_some_many[] = {4, 16, 64};  ///< substeps

/// By how much a value falls in a time that ends with whole frames, as a rate [1/s].
double rate_of_fall(double before, double after, double seconds) { return std::log(before / after) / seconds; }

TEST(Damping, OfAnObjectIsItsRateOfDecay) {
  for (const int substeps : few_some_many)
    for (const double rate : {1., 20.}) {
      Mechanism m;
      m.substeps = substeps;
      m.scene.gravity = {};
      const int b = m.box({0, 0, 0}, 2, {0.3f, 0.2f, 0.2f}, {3, 0, 0}, {2, 0, 0});
      m.object.damping = static_cast<float>(rate);
      m.run(0.25);
      EXPECT_NEAR(rate_of_fall(3, m.velocity(b).x, 0.25) / rate, 1, 3e-4) << substeps;
      EXPECT_NEAR(rate_of_fall(2, m.spin(b).x, 0.25) / rate, 1, 3e-4) << substeps;
    }
}

TEST(Damping, OfAHingeAndASliderIsTheirRateOfDecay) {
  for (const int substeps : few_some_many) {
    Mechanism m;
    m.substeps = substeps;
    m.scene.gravity = {};
    const int wheel = m.box({0, 0, 0}, 3, {0.4f, 0.4f, 0.1f}, {}, {0, 0, 5}),
              sledge = m.box({0, 2, 0}, 2, {0.1f, 0.1f, 0.1f}, {3, 0, 0});
    const double rate = 20, inertia = box_inertia(3, 0.4, 0.4);
    add_joint(m.object, HingeJoint{.b = wheel, .axis = {0, 0, 1}, .damping = static_cast<float>(rate * inertia)});
    add_joint(
        m.object,
        SliderJoint{.b = sledge, .anchor = {0, 2, 0}, .axis = {1, 0, 0}, .damping = static_cast<float>(2 * rate)});
    m.run(0.25);
    EXPECT_NEAR(rate_of_fall(5, m.spin(wheel).z, 0.25) / rate, 1, 1e-3) << substeps;
    EXPECT_NEAR(rate_of_fall(3, m.velocity(sledge).x, 0.25) / rate, 1, 1e-3) << substeps;
  }
}

/// The bearing of a body that turns about another point than its centre gives it a larger inertia than the hinge alone
/// knows of.
TEST(Damping, OfAHingeBesideTheCentreIsOfSecondOrder) {
  for (const int substeps : few_some_many) {
    Mechanism m;
    m.substeps = substeps;
    m.scene.gravity = {};
    const int b = m.box({0.5f, 0, 0}, 3, {0.1f, 0.1f, 0.1f}, {0, 2.5f, 0}, {0, 0, 5});
    const double rate = 10, inertia = box_inertia(3, 0.1, 0.1) + 3 * 0.25;
    add_joint(m.object, HingeJoint{.b = b, .axis = {0, 0, 1}, .damping = static_cast<float>(rate * inertia)});
    m.run(0.25);
    EXPECT_NEAR(rate_of_fall(5, m.spin(b).z, 0.25) / rate, 1, substeps == 4 ? 0.02 : 2e-3) << substeps;
  }
}

TEST(Damping, OfASliderGivesItsTerminalSpeedAtFewSubsteps) {
  for (const int substeps : few_some_many) {
    Mechanism m;
    m.substeps = substeps;
    const int b = m.box({0, 0, 0}, 2);
    add_joint(m.object, SliderJoint{.b = b, .axis = {0, 1, 0}, .damping = 60});
    m.run(0.5);
    EXPECT_NEAR(m.velocity(b).y, -2 * gravity / 60, 2e-3 * gravity / 30) << substeps;
  }
}

/// Of a force field, too, which changes velocities before the prediction.
TEST(Damping, OfASliderGivesItsTerminalSpeedUnderAnyForce) {
  for (const int substeps : few_some_many) {
    Mechanism m;
    m.substeps = substeps;
    m.scene.gravity = {};
    m.scene.forces.push_back([](const Vec3f&, const Vec3f&, float mass, float) { return Vec3f{0, -10 * mass, 0}; });
    const int b = m.box({0, 0, 0}, 2);
    add_joint(m.object, SliderJoint{.b = b, .axis = {0, 1, 0}, .damping = 60});
    m.run(0.5);
    EXPECT_NEAR(m.velocity(b).y, -2 * 10. / 60, 2e-3 * 10 / 30) << substeps;
  }
}

/// Before, implicit Euler's own was beside it: 1.09 times as much with four substeps.
TEST(Damping, OfASpringIsItsTimeAtFewSubsteps) {
  for (const int substeps : few_some_many) {
    constexpr double mass = 2, stiffness = 200, damping = 8;
    Mechanism m;
    m.substeps = substeps;
    m.scene.gravity = {};
    const int b = m.box({1, 0, 0}, mass, {0.1f, 0.1f, 0.1f}, {0.5f, 0, 0});
    add_joint(m.object, SpringJoint{.b = b, .anchor_b = {1, 0, 0}, .stiffness = stiffness, .damping = damping});
    m.start();
    std::vector<double> energies;
    for (int frame = 0; frame < 60; ++frame) {
      const double u = m.pose(b).position.x - 1, v = m.velocity(b).x;
      energies.push_back(stiffness * u * u + damping * u * v +
                         mass * v * v);  // of one phase: falls by exp(-b t / m) alone
      m.run(1. / 60);
    }
    EXPECT_NEAR(rate_of_fall(energies[0], energies[59], 59. / 60), damping / mass, 0.01 * damping / mass) << substeps;
  }
}

/// How fast the amplitude of a mode falls in a second [1/s], and its frequency [rad/s]. From a third of a second on,
/// when higher modes that the start contains are gone.
struct Decay {
  double rate = 0, omega = 0;
};
Decay decay_of(const Mode& mode, int substeps, double frames_per_second = 60) {
  Settings settings = mode.scene.settings;
  settings.substeps = substeps;
  const ModeTrace trace(mode, settings, 1.34 + 4 * pi / mode.frequency, frames_per_second);
  EXPECT_TRUE(trace.ok);
  const double omega = trace.frequency(mode.frequency);
  const auto second = static_cast<std::size_t>(std::lround(frames_per_second));
  return {std::log(trace.amplitude(second / 3, omega) / trace.amplitude(second + second / 3, omega)), omega};
}

/// How fast the amplitude of a mode falls over a second, over omega^2 tau / 2.
double damped_share(const Mode& mode, double tau, int substeps, double frames_per_second = 60) {
  const Decay decay = decay_of(mode, substeps, frames_per_second);
  return decay.rate / (decay.omega * decay.omega * tau / 2);
}

constexpr double rates_of_frames[] = {30, 60, 120, 240};  ///< [1/s]

/// By default eight substeps for joints and twenty for matter, and up to four times as many. Before, a substep added
/// its length to the time: 1.3 and 1.2 times too much damping in the first frame time here.
TEST(Damping, OfSpringsIsItsTimeInAnyFrameTime) {
  for (const double frames : rates_of_frames)
    for (const int times : {1, 2, 4}) {
      EXPECT_NEAR(decay_of(spring_mode(12, 2), 8 * times, frames).rate, 1, 0.03) << frames << " " << times;
      EXPECT_NEAR(decay_of(hinge_mode(12, 2), 8 * times, frames).rate, 1, 0.03) << frames << " " << times;
      EXPECT_NEAR(decay_of(cluster_mode(12, 2), 20 * times, frames).rate, 1, 0.03) << frames << " " << times;
      for (const Sweep sweep : {Sweep::tiled, Sweep::chains, Sweep::symmetric})
        EXPECT_NEAR(damped_share(line_mode(12, 2, sweep, 0.01), 0.01, 20 * times, frames), 1, 0.03)
            << frames << " " << times << " " << sweep_name(sweep);
    }
}

TEST(Damping, OfSolidsAndRodsIsItsTimeInAnyFrameTime) {
  for (const double frames : rates_of_frames)
    for (const int times : {1, 2, 4}) {
      for (const double poisson : {0., 0.3, 0.45})
        EXPECT_NEAR(damped_share(bar_mode(1e5, poisson, 0.005, false), 0.005, 20 * times, frames), 1, 0.03)
            << frames << " " << times << " " << poisson;
      EXPECT_NEAR(damped_share(rod_mode(1e9, 1, 0.005), 0.005, 8 * times, frames), 1, 0.03) << frames << " " << times;
    }
}

/// A solid's damping resists all rates of strain, also those that do not change the strain's size: these kept a
/// quarter of the motion.
TEST(Damping, OfASolidIsItsTime) {
  for (const int substeps : {20, 40, 80}) {
    EXPECT_NEAR(damped_share(bar_mode(1e5, 0, 0.02, false), 0.02, substeps), 1, 0.08) << substeps;
    EXPECT_NEAR(damped_share(bar_mode(1e5, 0.45, 0.02, false), 0.02, substeps), 1, 0.08) << substeps;
  }
}

TEST(Damping, OfARodIsItsTime) {
  for (const int substeps : {8, 20, 60})
    EXPECT_NEAR(damped_share(rod_mode(1e8, 1, 0.02), 0.02, substeps), 1, 0.12) << substeps;
}

}  // namespace
}  // namespace pliant
