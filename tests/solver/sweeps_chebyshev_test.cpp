// Tests Chebyshev acceleration: it is fast, estimates rho, leaves particles in contact alone, and ends rather than
// diverges.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "solver/sweeps/chebyshev.h"
#include "solver/sweeps_support.h"

namespace pliant {
namespace {

using namespace testing_support;

constexpr int chain_links = 60;
const double pi = std::acos(-1.0);

SweepOptions chebyshev(float radius = 0, int plain = 10) {
  SweepOptions options;
  options.acceleration = Acceleration::chebyshev;
  options.spectral_radius = radius;
  options.plain_iterations = plain;
  return options;
}

Report solve(Sweep sweep, const SweepOptions& options, int iterations) {
  std::vector<double> stretch;
  for (int i = 0; i < chain_links; ++i) stretch.push_back(0.02 + 0.02 * std::sin(12.9898 * i));
  SweepRun run = run_of(sweep, 1, iterations, options);
  run.settings.record_residuals = true;
  run.largest_tile = 4096;
  return run_sweep({stretched_chain(chain_links, stretch, Stiffness::rigid())}, run, 0).reports[0];
}

TEST(Chebyshev, WithoutBeingToldRhoIsManyTimesFaster) {
  for (Sweep sweep : {Sweep::tiled, Sweep::symmetric, Sweep::jacobi}) {
    const int plain = iterations_to_a_thousandth(solve(sweep, {}, 12000));
    const int accelerated = iterations_to_a_thousandth(solve(sweep, chebyshev(), 1000));
    ASSERT_GT(plain, 500);
    ASSERT_GT(accelerated, 0) << static_cast<int>(sweep);
    EXPECT_LT(6 * accelerated, plain) << static_cast<int>(sweep);
  }
}

TEST(Chebyshev, ItsFirstIterationsArePlain) {
  const std::vector<double> plain = residual_curve(solve(Sweep::tiled, {}, 12)),
                            accelerated = residual_curve(solve(Sweep::tiled, chebyshev(0, 7), 12));
  for (std::size_t i = 0; i <= 7; ++i) EXPECT_EQ(plain[i], accelerated[i]) << i;
  EXPECT_NE(plain[8], accelerated[8]);
}

/// Two links with one free particle: the whole iteration computed by hand, in double.
TEST(Chebyshev, FollowsItsRecurrence) {
  Object object = stretched_chain(2, {0.2, 0.1}, Stiffness::rigid());
  object.masses = {std::numeric_limits<float>::infinity(), 1, std::numeric_limits<float>::infinity()};
  const float rho = 0.6f;
  SweepOptions options = chebyshev(rho, 1);
  options.relaxation = 0.25f;
  const Outcome out = run_sweep({object}, run_of(Sweep::jacobi, 1, 3, options), 0);
  // Jacobi with split masses: each link sees w = 2, moves the particle by 0.25 C, and the particle moves by the mean:
  // G(x) = x - 0.125 (C0 - C1) with C0 = 0.02 + x, C1 = 0.01 - x.
  const auto sweep = [](double x) { return x - 0.125 * (0.01 + 2 * x); };
  double older = 0, before = 0, weight = 1;
  for (int i = 0; i < 3; ++i) {
    const double r2 = static_cast<double>(rho) * static_cast<double>(rho);
    weight = i == 0 ? 1 : i == 1 ? 2 / (2 - r2) : 4 / (4 - r2 * weight);
    const double next = weight * (sweep(before) - older) + older;
    older = before;
    before = next;
  }
  const int at = out.model.objects[0].place[1];
  EXPECT_NEAR(static_cast<double>(out.state.positions[at].x) - 0.12, before, 1e-7);
}

TEST(Chebyshev, RhoFarTooLargeGivesUpInsteadOfDiverging) {
  // Over-relaxed Jacobi can have eigenvalues below -1, for which extrapolation cannot converge.
  SweepOptions options = chebyshev(0.99999f, 1);
  options.sharing = Sharing::average;
  options.relaxation = 1.95f;
  SweepRun run = run_of(Sweep::jacobi, 1, 400, options);
  run.settings.record_residuals = true;
  const Report report = run_sweep({mixed_sheet(9, true)}, run).reports[0];
  EXPECT_TRUE(report.ok());
  EXPECT_LT(report.convergence.back().primal[0].rms, 1);
}

/// A particle that lies on the floor must end where the plain sweep puts it, and nowhere lower.
TEST(Chebyshev, LeavesAloneWhatTouches) {
  Object sheet = mixed_sheet(9, false);
  for (Vec3f& v : sheet.velocities) v = {0, -1, 0};
  SweepRun run = run_of(Sweep::tiled, 2, 30, chebyshev(0, 4));
  run.frames = 3;
  const Outcome out = run_sweep({sheet}, run, 9.81f, true);
  EXPECT_GT(out.reports.back().contacts, 20);
  for (const Record& p : out.state.positions) EXPECT_GT(p.y, -0.003f + 0.0009f);
}

/// If all particles touch, none is extrapolated, so the bits are those of the plain sweep.
TEST(Chebyshev, OfWhatAllTouchesIsThePlainSweep) {
  std::vector<double> stretch;
  for (int i = 0; i < 20; ++i) stretch.push_back(0.02 + 0.02 * std::sin(12.9898 * i));
  Object line = stretched_chain(20, stretch, Stiffness::rigid());
  for (Vec3f& p : line.positions) p.y = -0.003f + line.thickness;
  line.static_friction = line.kinetic_friction = 0;
  const auto end_of = [&](const SweepOptions& options) {
    const Outcome out = run_sweep({line}, run_of(Sweep::tiled, 1, 20, options), 9.81f, true);
    EXPECT_EQ(out.reports[0].contacts, 21);
    return out.state;
  };
  expect_equal(end_of(chebyshev(0.9f, 3)), end_of({}), "touching");
}

/// Over natural order it diverges, so a World rejects it; this test has no World.
TEST(Chebyshev, IsGivenUpWhereCorrectionsGrow) {
  const double rho = std::cos(pi / (chain_links + 1)) * std::cos(pi / (chain_links + 1));
  const Report report = solve(Sweep::natural, chebyshev(static_cast<float>(rho), 1), 2000);
  const std::vector<double> curve = residual_curve(report);
  EXPECT_LT(*std::max_element(curve.begin(), curve.end()), 30 * curve[0]);
  EXPECT_LT(curve.back(), curve[0]);
}

TEST(Chebyshev, RhoIsThatOfTheChain) {
  SweepRun run = run_of(Sweep::jacobi, 1, 400, chebyshev());
  std::vector<double> stretch;
  for (int i = 0; i < chain_links; ++i) stretch.push_back(0.02 + 0.02 * std::sin(12.9898 * i));
  // Split masses halve the step of Jacobi: the slowest error is multiplied by (1 + cos) / 2, a little more because of
  // the ends' whole masses.
  const Outcome out = run_sweep({stretched_chain(chain_links, stretch, Stiffness::rigid())}, run, 0);
  const auto& scratch = static_cast<const ChebyshevScratch&>(*out.workspace.sweeps.at(Sweep::jacobi).acceleration);
  const double rho = scratch.recurrence.spectral_radius, expected = (1 + std::cos(pi / (chain_links + 1))) / 2;
  EXPECT_LT(rho, expected + 0.1 * (1 - expected));
  EXPECT_GT(rho, expected - 3 * (1 - expected));
}

}  // namespace
}  // namespace pliant
