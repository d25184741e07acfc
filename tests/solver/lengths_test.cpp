// The searches among distance constraints: every instruction set gives the bits of the scalar twin, and the twin the
// constraints that a plain loop finds.
#include "solver/lengths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "model/length_ranges.h"
#include "solver/chains_support.h"
#include "solver/kernels.h"
#include "solver/visit.h"

namespace pliant {
namespace {

using namespace testing_support;

const Stiffness damped = Stiffness::compliance(2e-4f, 200.f);

/// A compiled grid in a random deformation, with multipliers.
struct Stretched {
  CompiledObject object;
  Records positions, displacements, velocities;
  std::vector<AlignedVector<float>> multipliers;
  std::vector<float*> pointers;

  Stretched(Sweep sweep, unsigned seed) {
    CompileOptions options;
    options.sweep = sweep;
    Object cloth = grid(23, 17, 1e-4f);
    cloth.pins = {{0, {}}, {1, {}}, {23, {}}};  // three constraints between fixed particles
    cloth.constraints.push_back({"distance", {0, 5, 7, 90}, {0, 0.1f}, Stiffness::pbd(0.5f), {}});
    cloth.constraints.push_back({"distance", {3, 50, 8, 91, 9, 92}, {0.1f, 0.1f, 0.2f}, damped, {}});
    object = compile(cloth, options);
    std::mt19937 random(seed);
    const auto record = [&](double range) {
      const double x = uniform(random, -range, range), y = uniform(random, -range, range);
      return Record{static_cast<float>(x), static_cast<float>(y), static_cast<float>(uniform(random, -range, range)),
                    0};
    };
    for (const Record& p : object.positions) {
      const Record by = record(0.004);
      positions.push_back({p.x + by.x, p.y + by.y, p.z + by.z, p.w});
      displacements.push_back(record(0.002));
      velocities.push_back(record(2));
    }
    for (const Pool& pool : object.pools) {
      multipliers.emplace_back(static_cast<std::size_t>(pool.batches) * batch_width);
      for (float& value : multipliers.back()) value = static_cast<float>(uniform(random, -1e-6, 1e-6));
    }
    for (AlignedVector<float>& values : multipliers) pointers.push_back(values.data());
  }

  LengthQuery query(float above) const {
    return {positions.data(), displacements.data(), pointers.data(), 3600, above, velocities.data()};
  }
  DemandQuery demand(float above) const { return {positions.data(), velocities.data(), 5000, 0.3f, above}; }
};

std::vector<FoundLength> long_by(const Stretched& of, const LengthKernels& kernels, const LengthQuery& query) {
  std::vector<FoundLength> found;
  for (const LengthRange& range : of.object.lengths) find_long(of.object, range, kernels, query, found);
  return found;
}

std::vector<float> demands_by(const Stretched& of, const LengthKernels& kernels, const DemandQuery& query) {
  std::vector<FoundLength> found;
  for (const LengthRange& range : of.object.lengths) find_demanding(of.object, range, kernels, query, found);
  std::vector<float> demands;
  demands.reserve(found.size());
  for (const FoundLength& one : found) demands.push_back(one.value);
  return demands;
}

/// In double precision, one constraint after another.
std::vector<double> overstretches(const Stretched& of) {
  std::vector<double> all;
  for (const Segment& segment : of.object.segments) {
    const Pool& pool = of.object.pools[segment.pool];
    if (pool.law == Law::pbd || !pool.is_length) continue;
    for_segment(of.object, segment, [&](const ConstraintPlace& at, const std::int32_t* particle) {
      if (!(at.value(0) > 0)) return;
      if (of.object.positions[particle[0]].w == 0 && of.object.positions[particle[1]].w == 0) return;
      double squared = 0, along = 0;
      for (const auto c : {&Record::x, &Record::y, &Record::z}) {
        const auto place = [&](int i) { return double(of.positions[i].*c) + double(of.displacements[i].*c); };
        const double way = place(particle[1]) - place(particle[0]);
        squared += way * way;
        along += way * (double(of.velocities[particle[1]].*c) - double(of.velocities[particle[0]].*c));
      }
      const double compliance = double(at.value(1)), damping = pool.law == Law::damped ? double(at.value(2)) : 0;
      const double explained = compliance * 3600 * double(of.multipliers[at.pool_number][at.multiplier_place(0)]) +
                               std::max(compliance * damping - 1. / 60, 0.) * along / std::sqrt(squared);
      all.push_back((std::sqrt(squared) - double(at.value(0)) + explained) / double(at.value(0)));
    });
  }
  return all;
}

class Lengths : public testing::TestWithParam<Sweep> {};

TEST_P(Lengths, FindsWhatAPlainLoopInDoublesFinds) {
  const Stretched of(GetParam(), 1);
  const std::vector<double> all = overstretches(of);
  for (const float above : {-10.f, 0.f, 0.05f, 0.1f}) {
    const std::vector<FoundLength> found = long_by(of, length_kernels_sequential(), of.query(above));
    std::vector<double> expected;
    for (const double one : all)
      if (one > double(above)) expected.push_back(one);
    ASSERT_EQ(found.size(), expected.size()) << above;
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i].value, expected[i], 1e-4);
  }
  EXPECT_GT(long_by(of, length_kernels_sequential(), of.query(0.05f)).size(), 10u);
}

TEST_P(Lengths, GivesTheSameBitsInLanes) {
  const Stretched of(GetParam(), 2);
  for (const float above : {-10.f, 0.f, 0.08f}) {
    for (const bool with : {false, true}) {
      LengthQuery query = of.query(above);
      if (!with) query.multipliers = nullptr;
      if (!with) query.displacements = query.velocities = nullptr;
      const std::vector<FoundLength> lanes = long_by(of, pick_kernels("").lengths, query),
                                     one_by_one = long_by(of, length_kernels_sequential(), query);
      ASSERT_EQ(lanes.size(), one_by_one.size());
      for (std::size_t i = 0; i < lanes.size(); ++i) {
        EXPECT_EQ(lanes[i].value, one_by_one[i].value);
        EXPECT_EQ(lanes[i].segment, one_by_one[i].segment);
        EXPECT_EQ(lanes[i].batch, one_by_one[i].batch);
        EXPECT_EQ(lanes[i].lane, one_by_one[i].lane);
      }
    }
  }
}

/// Thresholds at, just below and just above each value: none is lost where squares are compared.
TEST_P(Lengths, AreFoundToTheLastBit) {
  const Stretched of(GetParam(), 5);
  const LengthKernels& lanes = pick_kernels("").lengths;
  std::vector<float> values;
  for (const FoundLength& one : long_by(of, length_kernels_sequential(), of.query(-10))) values.push_back(one.value);
  std::sort(values.begin(), values.end());
  for (std::size_t i = 0; i < values.size(); i += 7)
    for (const float above : {std::nextafter(values[i], -1e9f), values[i], std::nextafter(values[i], 1e9f)}) {
      const auto greater = std::upper_bound(values.begin(), values.end(), above);
      EXPECT_EQ(long_by(of, lanes, of.query(above)).size(), static_cast<std::size_t>(values.end() - greater)) << above;
    }
}

TEST_P(Lengths, LeaveDampedOnesOutWithoutVelocities) {
  const Stretched of(GetParam(), 6);
  LengthQuery query = of.query(-10);
  const std::size_t with = long_by(of, pick_kernels("").lengths, query).size();
  query.velocities = nullptr;
  EXPECT_EQ(long_by(of, pick_kernels("").lengths, query).size() + 3, with);
  EXPECT_EQ(long_by(of, length_kernels_sequential(), query).size() + 3, with);
}

TEST_P(Lengths, DemandTheSameSubstepsInLanes) {
  const Stretched of(GetParam(), 3);
  for (const float above : {-1.f, 12.f, 200.f})
    EXPECT_EQ(demands_by(of, pick_kernels("").lengths, of.demand(above)),
              demands_by(of, length_kernels_sequential(), of.demand(above)));
  EXPECT_GT(demands_by(of, length_kernels_sequential(), of.demand(12)).size(), 10u);
}

TEST_P(Lengths, AreCountedOnceInTheRanges) {
  const Stretched of(GetParam(), 4);
  std::int64_t constraints = 0;
  for (const LengthRange& range : of.object.lengths) constraints += range.constraints;
  EXPECT_EQ(constraints, static_cast<std::int64_t>(overstretches(of).size()));
  EXPECT_EQ(long_by(of, length_kernels_sequential(), of.query(-10)).size(), static_cast<std::size_t>(constraints));
}

/// One constraint of rest length 2 from (0, 0, 0) to (3, 0, 0), whose end moves at (1, 4, 0) m/s.
TEST(LengthDemand, IsTheLargerOfStrainAndTurn) {
  Object pair;
  pair.positions = {{0, 0, 0}, {3, 0, 0}};
  pair.masses = {1, 1};
  pair.constraints.push_back({"distance", {0, 1}, {2}, Stiffness::compliance(0), {}});
  const CompiledObject object = compile(pair, CompileOptions{});
  const Records positions{{0, 0, 0, 1}, {3, 0, 0, 1}}, velocities{{0, 0, 0, 0}, {1, 4, 0, 0}};
  const auto demanded = [&](float by_stretch, float by_turn) {
    std::vector<FoundLength> found;
    find_demanding(object, object.lengths.front(), length_kernels_sequential(),
                   {positions.data(), velocities.data(), by_stretch, by_turn, 0}, found);
    return found.at(0).value;
  };
  EXPECT_FLOAT_EQ(demanded(100, 0), 50);  // a strain of one half
  EXPECT_FLOAT_EQ(demanded(0, 30), 40);   // 4 m/s across 3 m
  EXPECT_FLOAT_EQ(demanded(100, 30), 50);
}

std::string name_of(const testing::TestParamInfo<Sweep>& info) {
  return info.param == Sweep::tiled ? "tiled" : "chains";
}
INSTANTIATE_TEST_SUITE_P(Sweeps, Lengths, testing::Values(Sweep::tiled, Sweep::chains), name_of);

}  // namespace
}  // namespace pliant
