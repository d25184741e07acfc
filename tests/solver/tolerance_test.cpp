// Tests iterations that stop at a tolerance: at the iteration at which the record in double precision reaches it, with
// the same bits whatever runs them; without a tolerance nothing changes.
#include <gtest/gtest.h>

#include <cstring>

#include "solver/residual.h"
#include "solver/sweeps_support.h"

namespace pliant {
namespace {

using namespace testing_support;

struct Stopped {
  Model model;
  State state;
  std::vector<Report> reports;
};

/// Simulates as run_sweep does, with a tolerance.
Stopped run_with_tolerance(const std::vector<Object>& objects, const SweepRun& run, double tolerance) {
  SweepRun none = run;
  none.frames = 0;
  Outcome out = run_sweep(objects, none, 9.81f, true);
  prepare_residual(out.model, out.workspace.residual);
  Executor executor(run.threads);
  Stopped stopped;
  for (int frame = 0; frame < run.frames; ++frame) {
    stopped.reports.emplace_back();
    step(
        {out.model, out.state, out.workspace, executor, pick_kernels(run.isa), run.settings.substeps,
         run.settings.iterations, run.settings.sweep_options, run.settings.record_residuals, nullptr, false, tolerance},
        static_cast<double>(run.dt), stopped.reports.back());
  }
  stopped.state = out.state;
  stopped.model = out.model;
  return stopped;
}

bool equal_bits(const State& a, const State& b) {
  return std::memcmp(a.positions.data(), b.positions.data(), a.positions.size() * sizeof(Record)) == 0 &&
         std::memcmp(a.velocities.data(), b.velocities.data(), a.velocities.size() * sizeof(Record)) == 0;
}

/// Objects without PBD stiffness and damping, which would keep |C + alpha~ lambda| from vanishing.
std::vector<Object> undamped_company() {
  Object sheet = mixed_sheet(13, true);
  std::erase_if(sheet.constraints, [](const ConstraintGroup& group) {
    return group.stiffness.kind == Stiffness::Kind::pbd || group.stiffness.damping > 0;
  });
  sheet.velocities.clear();
  return {sheet, stretched_chain(40, std::vector<double>(40, 0.004), Stiffness::compliance(1e-5f), false)};
}

double distance_rms(const IterationResidual& at) {
  for (const Residual& residual : at.primal)
    if (residual.type == "distance") return residual.rms;
  return -1;
}

class ToleranceOf : public testing::TestWithParam<Sweep> {};
INSTANTIATE_TEST_SUITE_P(Sweeps, ToleranceOf,
                         testing::Values(Sweep::tiled, Sweep::symmetric, Sweep::jacobi, Sweep::natural));

/// The record is computed in double by other code, and has every iteration of the last substep.
TEST_P(ToleranceOf, EndsWhereTheRecordPassesIt) {
  SweepRun run = run_of(GetParam(), 2, 400);
  run.frames = 4;
  run.settings.record_residuals = true;
  const double tolerance = 6e-5;
  const Stopped stopped = run_with_tolerance(undamped_company(), run, tolerance);
  for (const Report& report : stopped.reports) {
    const auto& record = report.convergence;
    ASSERT_GE(record.size(), 3U);
    ASSERT_LT(record.size(), 401U) << "the tolerance must be met for the test to say something";
    EXPECT_LT(distance_rms(record.back()), tolerance * (1 + 1e-4));
    for (std::size_t i = 1; i + 1 < record.size(); ++i) EXPECT_GE(distance_rms(record[i]), tolerance * (1 - 1e-4)) << i;
    EXPECT_LE(report.iterations.smallest, record.back().iteration);
    EXPECT_GE(report.iterations.largest, record.back().iteration);
    EXPECT_NEAR(report.iterations.mean, (report.iterations.smallest + report.iterations.largest) / 2.0, 1e-12)
        << "of two substeps";
  }
}

TEST_P(ToleranceOf, GivesTheSameBitsWhateverRunsIt) {
  SweepRun run = run_of(GetParam(), 3, 60);
  run.frames = 5;
  const Stopped expected = run_with_tolerance(undamped_company(), run, 8e-5);
  EXPECT_LT(expected.reports.back().iterations.smallest, 60);
  for (int threads : {1, 2, 3, 8}) {
    run.threads = threads;
    EXPECT_TRUE(equal_bits(run_with_tolerance(undamped_company(), run, 8e-5).state, expected.state))
        << threads << " threads";
  }
  for (const std::string& isa : available_isas()) {
    run.isa = isa;
    const Stopped found = run_with_tolerance(undamped_company(), run, 8e-5);
    EXPECT_TRUE(equal_bits(found.state, expected.state)) << isa;
    EXPECT_EQ(found.reports.back().iterations.mean, expected.reports.back().iterations.mean) << isa;
  }
}

TEST(Tolerance, OutOfReachMakesAllIterationsWithTheBitsOfNone) {
  SweepRun run = run_of(Sweep::tiled, 2, 7);
  run.frames = 3;
  const Outcome plain = run_sweep(undamped_company(), run, 9.81f, true);
  const Stopped out_of_reach = run_with_tolerance(undamped_company(), run, 1e-12);
  EXPECT_TRUE(equal_bits(out_of_reach.state, plain.state));
  for (const Report& report : {plain.reports.back(), out_of_reach.reports.back()}) {
    EXPECT_EQ(report.iterations.smallest, 7);
    EXPECT_EQ(report.iterations.largest, 7);
    EXPECT_DOUBLE_EQ(report.iterations.mean, 7);
  }
}

TEST(Tolerance, LargeOneMakesOneIterationWithTheBitsOfOne) {
  SweepRun run = run_of(Sweep::tiled, 2, 7);
  run.frames = 3;
  const Stopped one =
      run_with_tolerance({stretched_chain(30, std::vector<double>(30, 0.01), Stiffness::rigid())}, run, 1e6);
  run.settings.iterations = 1;
  const Outcome plain =
      run_sweep({stretched_chain(30, std::vector<double>(30, 0.01), Stiffness::rigid())}, run, 9.81f, true);
  EXPECT_EQ(one.reports.back().iterations.largest, 1);
  EXPECT_TRUE(equal_bits(one.state, plain.state));
}

/// Constraints other than distances do not count. If there are no distances, the tolerance must not count as met.
TEST(Tolerance, WithoutDistancesMakesAllIterations) {
  Object sheet = mixed_sheet(6, true);
  std::erase_if(sheet.constraints, [](const ConstraintGroup& group) { return group.type == "distance"; });
  const Stopped out = run_with_tolerance({sheet}, run_of(Sweep::tiled, 2, 9), 1e6);
  EXPECT_EQ(out.reports.back().iterations.smallest, 9);
}

/// A batch has sixteen constraints. For numbers near multiples of it, padding must not count.
TEST(Tolerance, CountsNoPadding) {
  for (int links : {1, 2, 15, 16, 17, 33, 70}) {
    Object chain =
        stretched_chain(links, std::vector<double>(static_cast<std::size_t>(links), 0.0), Stiffness::rigid());
    SweepRun run = run_of(Sweep::tiled, 1, 1);
    run.frames = 0;
    Outcome out = run_sweep({chain}, run, 0);
    prepare_residual(out.model, out.workspace.residual);
    EXPECT_EQ(out.workspace.residual.constraints, links);
  }
}

}  // namespace
}  // namespace pliant
