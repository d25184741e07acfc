// Tests that every sweep has one hash whatever runs it, converges to the same result as all others, and conserves the
// momentum that it promises to conserve.
#include <gtest/gtest.h>

#include "solver/sweeps_support.h"

namespace pliant {
namespace {

using namespace testing_support;

int inter_tile_colours(const Model& model) {
  return static_cast<int>(std::count_if(model.phases.begin(), model.phases.end(),
                                        [](const Phase& phase) { return phase.driver == Driver::inter_tile; }));
}

SweepOptions options_of(float relaxation, Sharing sharing = Sharing::split) {
  SweepOptions options;
  options.relaxation = relaxation;
  options.sharing = sharing;
  return options;
}

class Sweeps : public testing::TestWithParam<SweepWay> {};
INSTANTIATE_TEST_SUITE_P(Ways, Sweeps, testing::ValuesIn(sweep_ways()), [](const auto& way) { return way.param.name; });

std::vector<Object> company() { return {mixed_sheet(13, true), ball(1.2f, {0.3f, 0.4f, 0.3f})}; }

TEST_P(Sweeps, GivesTheSameBitsWhateverRunsIt) {
  for (int iterations : {1, 8}) {
    SweepRun run = run_of(GetParam().sweep, 2, iterations, GetParam().options);
    run.frames = 6;
    const Outcome expected = run_sweep(company(), run, 9.81f, true);
    for (const Report& report : expected.reports) ASSERT_TRUE(report.ok());
    std::int64_t contacts = 0;
    for (const Report& report : expected.reports) contacts += report.contacts;
    EXPECT_GT(contacts, 0) << "the scene must touch its floor";
    for (int threads : {1, 2, 3, 8}) {
      run.threads = threads;
      expect_equal(run_sweep(company(), run, 9.81f, true).state, expected.state, std::to_string(threads) + " threads");
    }
    run.threads = 2;
    for (const std::string& isa : available_isas()) {
      run.isa = isa;
      expect_equal(run_sweep(company(), run, 9.81f, true).state, expected.state, isa);
    }
    run.settings.record_residuals = true;
    expect_equal(run_sweep(company(), run, 9.81f, true).state, expected.state, "looking");
  }
}

/// Nothing but the State may carry over from one step to the next.
TEST_P(Sweeps, GoesOnFromAStateThatWasPutBack) {
  SweepRun run = run_of(GetParam().sweep, 2, 6, GetParam().options);
  run.frames = 3;
  Outcome out = run_sweep(company(), run, 9.81f, true);
  const State middle = out.state;
  Executor executor(1);
  const auto go_on = [&](int frames) {
    for (int i = 0; i < frames; ++i) {
      Report report;
      step({out.model, out.state, out.workspace, executor, pick_kernels("sequential"), 2, 6, run.settings.sweep_options,
            false},
           1.0 / 60, report);
    }
    return out.state;
  };
  const State first = go_on(2);
  go_on(3);
  out.state = middle;
  expect_equal(go_on(2), first, "again");
}

double largest_difference(const State& a, const State& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.positions.size(); ++i) {
    const Record &p = a.positions[i], &q = b.positions[i];
    for (float difference : {p.x - q.x, p.y - q.y, p.z - q.z})
      largest = std::max(largest, static_cast<double>(std::fabs(difference)));
  }
  return largest;
}

/// A hanging line with masses from 1 to 4 kg. It is compliant, so that the result depends on the multipliers too.
Object compliant_line() {
  std::vector<double> stretch;
  for (int i = 0; i < 12; ++i) stretch.push_back(0.05 * std::sin(3.0 * i));
  Object line = stretched_chain(12, stretch, Stiffness::compliance(1e-4f), false);
  line.pins.push_back({0, {}});
  return line;
}

/// Two kinds of sweep converge elsewhere, which the test allows: averaging applies different parts of a force to
/// neighbours with different counts, and tethers hold back what is meant to stretch.
TEST_P(Sweeps, EndsWhereAllSweepsEnd) {
  const Outcome expected = run_sweep({compliant_line()}, run_of(Sweep::natural, 1, 4000));
  const Outcome found = run_sweep({compliant_line()}, run_of(GetParam().sweep, 1, 4000, GetParam().options));
  const double apart = largest_difference(found.state, expected.state);
  if (GetParam().lacks == Lacks::pairs || GetParam().lacks == Lacks::give) {
    EXPECT_GT(apart, 1e-4) << "it ends where all do: the table need not say that it can't";
  } else {
    EXPECT_LT(apart, 2e-6);
  }
  EXPECT_GT(largest_difference(expected.state, initial_state(expected.model)), 1e-3) << "something must move";
}

TEST_P(Sweeps, MeetsItsConstraints) {
  SweepRun run = run_of(GetParam().sweep, 1, 3000, GetParam().options);
  run.settings.record_residuals = true;
  std::vector<double> stretch;
  for (int i = 0; i < 20; ++i) stretch.push_back(0.1 * std::sin(5.0 * i));
  const Outcome out = run_sweep({stretched_chain(20, stretch, Stiffness::compliance(1e-5f))}, run, 0);
  const IterationResidual &first = out.reports[0].convergence.front(), &last = out.reports[0].convergence.back();
  ASSERT_EQ(out.reports[0].convergence.size(), 3001U);
  EXPECT_GT(first.primal[0].rms, 1e-3);
  EXPECT_EQ(first.dual_rms, 0);
  EXPECT_LT(last.primal[0].rms, 1e-6);
  if (GetParam().lacks == Lacks::pairs) return;
  EXPECT_LT(last.dual_largest, 1e-6) << "multipliers explain the motion";
}

TEST_P(Sweeps, MeetsVolumesToo) {
  SweepRun run = run_of(GetParam().sweep, 1, 500, GetParam().options);
  run.settings.record_residuals = true;
  Object soft = ball(1.02f, {});
  soft.constraints[0].stiffness = Stiffness::compliance(1);  // a compliant skin
  const Outcome out = run_sweep({soft}, run, 0);
  const IterationResidual &first = out.reports[0].convergence.front(), &last = out.reports[0].convergence.back();
  ASSERT_EQ(first.primal[1].type, "volume");
  EXPECT_GT(first.primal[1].largest, 0.001);
  EXPECT_LT(last.primal[1].largest, 0.02 * first.primal[1].largest);
  if (GetParam().lacks == Lacks::pairs) return;
  EXPECT_LT(last.dual_largest, 1e-4) << "multipliers explain the motion, but for the turning of gradients";
}

/// A sheet in small tiles, so that there are inter-tile constraints.
TEST_P(Sweeps, MeetsEveryTypeInAndBetweenTiles) {
  SweepRun run = run_of(GetParam().sweep, 1, 500, GetParam().options);
  run.settings.record_residuals = true;
  Object sheet = mixed_sheet(9, false);
  sheet.constraints.pop_back();                // PBD, which always leaves an error
  sheet.constraints[2].stiffness.damping = 0;  // as damping does
  const Outcome out = run_sweep({sheet}, run, 0);
  EXPECT_TRUE(GetParam().sweep == Sweep::natural || inter_tile_colours(out.model) > 0);
  const IterationResidual &first = out.reports[0].convergence.front(), &last = out.reports[0].convergence.back();
  ASSERT_EQ(first.primal.size(), 2U);
  const double left = GetParam().lacks == Lacks::turns ? 0.05 : 0.02;
  for (std::size_t type = 0; type < 2; ++type)
    EXPECT_LT(last.primal[type].largest, left * first.primal[type].largest) << first.primal[type].type;
}

// ---------------------------------------------------------------- momentum

struct Momentum {
  Vec3d linear{}, angular{};
  double scale = 0;
};

Momentum momentum_of(const State& state) {
  Momentum sum;
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    const Record &p = state.positions[i], &v = state.velocities[i];
    if (!(p.w > 0)) continue;
    const double mass = 1 / static_cast<double>(p.w);
    const Vec3d x{double(p.x), double(p.y), double(p.z)}, u{double(v.x), double(v.y), double(v.z)};
    sum.linear += u * mass;
    sum.angular += cross(x, u) * mass;
    sum.scale += mass * std::sqrt(dot(u, u));
  }
  return sum;
}

double change_of_momentum(const SweepWay& way) {
  SweepRun run = run_of(way.sweep, 4, 5, way.options);
  run.frames = 10;
  const std::vector<Object> free = {mixed_sheet(9, false), ball(1.5f, {0.3f, 0.4f, 0.3f})};
  SweepRun none = run;
  none.frames = 0;
  const Momentum start = momentum_of(run_sweep(free, none, 0).state), end = momentum_of(run_sweep(free, run, 0).state);
  const Vec3d change = end.linear - start.linear;
  return std::sqrt(dot(change, change)) / start.scale;
}

TEST_P(Sweeps, KeepsMomentum) {
  if (GetParam().lacks == Lacks::pairs) GTEST_SKIP() << "does not, and says so";
  EXPECT_LT(change_of_momentum(GetParam()), 2e-6);
}

TEST(Sweeps, AveragingDoesNotKeepMomentum) {
  EXPECT_GT(change_of_momentum({"", Sweep::jacobi, options_of(1, Sharing::average)}), 1e-3);
}

// ---------------------------------------------------------------- what is recorded

TEST(DualResidual, LeavesOutWhatNoMultiplierMoves) {
  Object line = stretched_chain(4, {0.1, 0.1, 0.1, 0.1}, Stiffness::pbd(0.5f));
  SweepRun run = run_of(Sweep::tiled, 1, 3);
  run.settings.record_residuals = true;
  EXPECT_EQ(run_sweep({line}, run, 0).reports[0].convergence.back().dual_largest, 0) << "PBD";
  line.constraints[0].stiffness = Stiffness::compliance(1e-4f);
  for (Vec3f& p : line.positions) p.y = -0.003f + line.thickness;
  const Report lying = run_sweep({line}, run, 9.81f, true).reports[0];
  EXPECT_EQ(lying.contacts, 5);
  EXPECT_EQ(lying.convergence.back().dual_largest, 0) << "what touches";
}

// ---------------------------------------------------------------- one iteration, by hand

/// Two links of different masses: the middle particle has two constraints, the ends have one.
Object three_particles() {
  Object object = stretched_chain(2, {0.5, 0.25}, Stiffness::rigid());
  object.masses = {1, 2, 4};
  return object;
}

std::vector<double> displacements_after_one(const SweepOptions& options, Sweep sweep = Sweep::jacobi) {
  SweepRun run = run_of(sweep, 1, 1, options);
  const Outcome out = run_sweep({three_particles()}, run, 0);
  std::vector<double> moved;
  for (int i = 0; i < 3; ++i) {
    const int at = out.model.objects[0].place[i];
    moved.push_back(static_cast<double>(out.state.positions[at].x) -
                    static_cast<double>(three_particles().positions[i].x));
  }
  return moved;
}

TEST(Jacobi, SplitsMasses) {
  // C = 0.05 and 0.025. The middle particle counts as two of 1 kg: dlambda = -0.05 / (1 + 1) and -0.025 / (1 + 0.25).
  const std::vector<double> moved = displacements_after_one({});
  EXPECT_NEAR(moved[0], 0.025, 1e-7);
  EXPECT_NEAR(moved[1], (-0.025 + 0.02) / 2, 1e-7);
  EXPECT_NEAR(moved[2], -0.02 / 4, 1e-7);
}

TEST(Jacobi, AveragesCorrections) {
  // dlambda = -0.05 / (1 + 1/2) and -0.025 / (1/2 + 1/4); the middle particle moves by the mean of its two corrections.
  const std::vector<double> moved = displacements_after_one(options_of(1, Sharing::average));
  EXPECT_NEAR(moved[0], 0.05 / 1.5, 1e-7);
  EXPECT_NEAR(moved[1], (-0.05 / 1.5 + 0.025 / 0.75) / 2 / 2, 1e-7);
  EXPECT_NEAR(moved[2], -0.025 / 0.75 / 4, 1e-7);
}

TEST(Jacobi, AveragedMultipliersAreThoseOfTheMeanForce) {
  // The shares of the multipliers' changes: for the first link (0.05 / 1.5) it is (1 + 0.5 / 2) / 1.5; for the second
  // (0.025 / 0.75) it is (0.5 / 2 + 0.25) / 0.75.
  const Outcome out = run_sweep({three_particles()}, run_of(Sweep::jacobi, 1, 1, options_of(1, Sharing::average)), 0);
  const Pool& pool = out.model.objects[0].pools[0];
  for (std::size_t lane = 0; lane < pool.origin.size(); ++lane) {
    if (pool.origin[lane] < 0) continue;
    const double expected = pool.origin[lane] == 0 ? -0.05 / 1.5 * (1.25 / 1.5) : -0.025 / 0.75 * (0.5 / 0.75);
    EXPECT_NEAR(static_cast<double>(out.workspace.multipliers[0][0][lane]), expected, 1e-7);
  }
}

TEST(Relaxation, MultipliesEveryCorrection) {
  const std::vector<double> plain = displacements_after_one({}), over = displacements_after_one(options_of(1.5f));
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(over[i], 1.5 * plain[i], 1e-7);
}

TEST(Relaxation, OfOneChangesNoBit) {
  Object line = compliant_line();
  CompileOptions options;
  options.largest_tile = 5;
  const CompiledObject object = compile(line, options);
  for (const std::string& isa : available_isas()) {
    Records one(object.positions.size()), two = one, remainders(one.size());
    std::vector<float> lanes(static_cast<std::size_t>(object.pools[0].batches) * batch_width, 0.f), more = lanes;
    const auto sweep = [&](Records& displacements, std::vector<float>& multipliers, auto kernel) {
      float* pointer = multipliers.data();
      SweepArguments a;
      a.positions = object.positions.data();
      a.displacements = displacements.data();
      a.remainders = remainders.data();
      a.multipliers = &pointer;
      a.h = 0.01f;
      a.inverse_h = 1 / a.h;
      a.inverse_h2 = a.inverse_h * a.inverse_h;
      kernel(object.pools.data(), object.segments.data(), object.segments.data() + object.segments.size(), a);
    };
    sweep(one, lanes, pick_kernels(isa).sweep);
    sweep(two, more, &sweep_general);
    EXPECT_TRUE(equal_bits(one, two)) << isa;
    for (std::size_t lane = 0; lane < lanes.size(); ++lane)  // padding is written by lanes alone
      EXPECT_TRUE(object.pools[0].origin[lane] < 0 || lanes[lane] == more[lane]) << isa;
  }
}

TEST(Symmetric, GoesThereAndBack) {
  // On one chain the last colour is projected twice in a row and the first one at both ends, so the first links are
  // satisfied at the end.
  std::vector<double> stretch(9, 0.1);
  SweepRun run = run_of(Sweep::symmetric, 1, 1);
  run.largest_tile = 4096;
  const Outcome out = run_sweep({stretched_chain(9, stretch, Stiffness::rigid())}, run, 0);
  const CompiledObject& object = out.model.objects[0];
  const Segment& first = object.segments.front();
  const Pool& pool = object.pools[first.pool];
  int met = 0;
  for (int lane = 0; lane < batch_width; ++lane) {
    if (!lane_is_valid(first, 0, lane)) continue;
    const std::int32_t* index = pool.indices.data() + first.index_offset;
    const Record &a = out.state.positions[particle_of(first, index, 0, lane)],
                 &b = out.state.positions[particle_of(first, index, 1, lane)];
    EXPECT_NEAR(std::fabs(a.x - b.x), 0.1f, 1e-6f);
    ++met;
  }
  EXPECT_GT(met, 1);
}

/// Particles on a line, each joined to its neighbours and to the next but one. Along the line projections are linear.
Object braced_line(const std::vector<double>& moved) {
  Object object;
  object.name = "line";
  ConstraintGroup group{"distance", {}, {}, Stiffness::rigid(), {}};
  for (int i = 0; i < static_cast<int>(moved.size()); ++i) {
    object.positions.push_back({static_cast<float>(0.1 * i + moved[i]), 0, 0});
    object.masses.push_back(1.f + static_cast<float>(i % 4));
    for (int before : {i - 1, i - 2}) {
      if (before < 0) continue;
      group.particles.insert(group.particles.end(), {before, i});
      group.rest.push_back(0.1f * static_cast<float>(i - before));
    }
  }
  object.constraints = {group};
  return object;
}

/// What remains of a displacement of the braced line after one iteration.
std::vector<double> left_after_one(const std::vector<double>& moved, Sweep sweep) {
  SweepRun run = run_of(sweep, 1, 1);
  run.largest_tile = 6;
  const Outcome out = run_sweep({braced_line(moved)}, run, 0);
  EXPECT_GT(inter_tile_colours(out.model), 1) << "inter_tile of one colour have no order";
  std::vector<double> left;
  for (std::size_t i = 0; i < moved.size(); ++i)
    left.push_back(double(out.state.positions[out.model.objects[0].place[i]].x) - 0.1 * static_cast<double>(i));
  return left;
}

double mass_product(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += static_cast<double>(1 + i % 4) * a[i] * b[i];
  return sum;
}

/// |<a, M b> - <M a, b>| over |a| |b| in the mass norm, for an iteration M and two displacements: 0 if M is symmetric.
double asymmetry(Sweep sweep) {
  std::vector<double> a, b;
  for (int i = 0; i < 40; ++i) {
    a.push_back(0.01 * std::sin(1.7 * i * i));
    b.push_back(0.01 * std::cos(2.3 * i * i));
  }
  const double forth = mass_product(a, left_after_one(b, sweep)), back = mass_product(left_after_one(a, sweep), b);
  return std::fabs(forth - back) / std::sqrt(mass_product(a, a) * mass_product(b, b));
}

TEST(Symmetric, HasNoDirection) {
  EXPECT_LT(asymmetry(Sweep::symmetric), 1e-4);
  EXPECT_GT(asymmetry(Sweep::tiled), 1e-3) << "or this shows nothing";
}

}  // namespace
}  // namespace pliant
