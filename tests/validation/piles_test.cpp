// Tests the piles of rigid bodies that `pliant bench bodies` measures, in both engines.
#include "apps/bench/piles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/bench/bench.h"
#include "pliant/error.h"

namespace pliant::bench {
namespace {

std::vector<std::unique_ptr<PileEngine>> engines_of(const Pile& pile) {
  std::vector<std::unique_ptr<PileEngine>> engines;
  engines.push_back(make_pliant_pile(pile, 1));
  if (has_bullet()) engines.push_back(make_bullet_pile(pile, 4));
  return engines;
}

TEST(BenchPiles, APyramidHasAsManyBodiesAsItsRowsAndStands) {
  const Pile pile = make_pile("pyramid", 4);
  ASSERT_EQ(pile.bodies.size(), 10U);
  for (const auto& engine : engines_of(pile)) {
    for (int i = 0; i < 60; ++i) engine->step(1.f / 60);
    const std::vector<Vec3f> x = engine->positions();
    for (std::size_t i = 0; i < x.size(); ++i)
      EXPECT_LT(std::sqrt(length_squared(x[i] - pile.bodies[i].position)), 0.02f) << i;
    EXPECT_EQ(engine->velocities().size(), 10U);
  }
}

/// The mean height of the bodies' centres if these fill a paraboloid bowl (pour, height r^2 / size) with a flat
/// surface: two thirds of the height h of volume pi size h^2 / 2 = solid volume / packing.
double mean_height_in_bowl(int bodies, double packing) {
  const double pi = 3.14159265, size = 0.2 * std::cbrt(bodies);
  const double box = 0.2 * 0.16 * 0.24, ball = 4 * pi / 3 * std::pow(0.11, 3), can = pi * 0.1 * 0.1 * 0.2;
  const double pill = pi * 0.08 * 0.08 * 0.2 + 4 * pi / 3 * std::pow(0.08, 3);
  const double volume = bodies * (box + ball + can + pill) / 4;
  return 2. / 3 * std::sqrt(2 * volume / (packing * pi * size));
}

/// The mean height of a pile that was poured and came to rest in its bowl, over that of a flat packing of 0.5.
double height_of_poured(PileEngine& engine, int count) {
  for (int i = 0; i < 300; ++i) engine.step(1.f / 60);
  double mean = 0;
  for (const Vec3f& p : engine.positions()) {
    EXPECT_GT(p.y, 0.03f);
    EXPECT_LT(p.y, 1.69f * 0.2f * std::cbrt(static_cast<float>(count))) << "the rim, 1.3^2 times the size";
    mean += static_cast<double>(p.y) / count;
  }
  float fastest = 0;
  for (const Vec3f& v : engine.velocities()) fastest = std::max(fastest, std::sqrt(length_squared(v)));
  EXPECT_LT(fastest, 0.2f) << "at rest but for rolling balls";
  return mean / mean_height_in_bowl(count, 0.5);
}

/// Loose heaps of mixed bodies with friction take 0.5 to 0.64 of their room (random loose and random close packing).
/// Piles are chaotic: single ones take 0.49 to 0.53, which differs by more than engines do.
TEST(BenchPiles, PouredBodiesFillTheBowlAsAPackingDoes) {
  const std::array<int, 3> counts{180, 200, 220};
  for (std::size_t engine = 0; engine < (has_bullet() ? 2 : 1); ++engine) {
    double mean = 0;
    for (const int count : counts) mean += height_of_poured(*engines_of(make_pile("pour", count))[engine], count) / 3;
    EXPECT_LT(mean, 1) << engine;
    EXPECT_GT(mean, std::sqrt(0.5 / 0.64)) << engine;
  }
}

TEST(BenchPiles, ARunYieldsARowForEachEngine) {
  PileOptions options;
  options.piles = {"tower"};
  options.sizes = {3};
  options.frames = 10;
  options.against_bullet = has_bullet();
  const std::vector<PileRow> rows = measure_piles(options);
  ASSERT_EQ(rows.size(), has_bullet() ? 3U : 1U);
  EXPECT_EQ(nlohmann::json::parse(to_json(rows)).size(), rows.size());
  EXPECT_EQ(rows.back().engine, "pliant");
  ASSERT_EQ(rows.back().snapshots.size(), 2U);
  EXPECT_EQ(rows.back().snapshots[1].frame, 50);
  EXPECT_EQ(rows.back().snapshots[1].lost, 0);
  options.limit = 1e-9;  // no time for later frames
  for (const PileRow& row : measure_piles(options)) EXPECT_EQ(row.snapshots.size(), 1U);
}

TEST(BenchPiles, RefusesWhatCannotBeMeasured) {
  PileOptions options;
  options.sizes = {0};
  EXPECT_THROW(measure_piles(options), Error);
  options.sizes = {3};
  options.frames = 0;
  EXPECT_THROW(measure_piles(options), Error);
  EXPECT_THROW(make_pile("heap", 3), Error);
}

}  // namespace
}  // namespace pliant::bench
