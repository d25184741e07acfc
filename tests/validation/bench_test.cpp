// Tests that `pliant bench` gives all engines the same cloth, without which its ratios would mean nothing. No test
// measures time.
#include "apps/bench/bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/bench/cloth.h"
#include "apps/bench/landing.h"
#include "apps/bench/quality.h"
#include "pliant/error.h"

namespace pliant::bench {
namespace {

constexpr int side = 12;
constexpr Steps steps{10, 4};

Vec3d centre_after(Engine& engine, int frames) {
  for (int i = 0; i < frames; ++i) engine.step(1.f / 60);
  Vec3d sum{};
  const std::vector<Vec3f> positions = engine.positions();
  for (const Vec3f& x : positions) sum += Vec3d{x.x, x.y, x.z};
  return sum * (1 / static_cast<double>(positions.size()));
}

void expect_near(const Vec3d& a, const Vec3d& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(Bench, W1HasAConstraintAnEdgeAndAHingeAnInnerEdge) {
  const Cloth cloth = make_w1(side, true);
  const int cells = (side - 1) * (side - 1), edges = 3 * cells + 2 * (side - 1);
  EXPECT_EQ(static_cast<int>(cloth.edges.size()), edges);
  EXPECT_EQ(static_cast<int>(cloth.hinges.size()), edges - 4 * (side - 1));
  EXPECT_TRUE(make_w1(side, false).hinges.empty());
}

// Another order of constraints crumples the cloth differently, but its motion as a whole must agree.
TEST(Bench, ThePlainLoopSwingsAsTheEngineDoes) {
  for (bool bending : {false, true}) {
    const Cloth cloth = make_w1(side, bending);
    const auto plain = make_plain_loop(cloth, steps), pliant = make_pliant(cloth, steps, 1);
    const Vec3d centre = centre_after(*plain, 15);
    EXPECT_LT(centre.y, -0.1);
    expect_near(centre, centre_after(*pliant, 15), 0.01);
  }
}

TEST(Bench, BulletSwingsAsTheEngineDoes) {
  if (!has_bullet()) GTEST_SKIP() << "built without Bullet";
  const Cloth cloth = make_w1(side, false);
  for (BulletOrder order : {BulletOrder::spread, BulletOrder::shuffled}) {
    const auto bullet = make_bullet(cloth, steps, order), pliant = make_pliant(cloth, steps, 1);
    expect_near(centre_after(*bullet, 15), centre_after(*pliant, 15), 0.02);
  }
}

// Small cloths, on which even plain sweeps reach the bounds.
TEST(BenchQuality, FindsTheSubstepsThatKeepTheBounds) {
  for (const QualityWorkload& workload : quality_workloads()) {
    const std::vector<Row> rows = measure_quality(workload, 16, 60);
    ASSERT_EQ(rows.size(), 3U);
    for (const Row& row : rows) {
      EXPECT_EQ(row.workload, workload.as.name);
      EXPECT_EQ(row.met, row.stretch_p99 <= workload.p99 && row.stretch_max <= workload.largest) << row.engine;
      EXPECT_TRUE(row.met) << workload.as.name << ", " << row.engine << ": " << row.stretch_p99 << ", "
                           << row.stretch_max;
      EXPECT_GT(row.stretch_p99, 1);
    }
    EXPECT_EQ(rows[2].engine, "multigrid");
    EXPECT_LE(rows[2].substeps, 8) << workload.as.name;
  }
}

TEST(BenchQuality, AnIrregularMeshHasNoNegativeCellsAndBothDiagonals) {
  const TriangleMesh mesh = make_irregular_mesh(10), regular = grid_mesh(10, 10, 1, 1);
  ASSERT_EQ(mesh.triangles.size(), regular.triangles.size());
  const auto up = [&](const std::array<int, 3>& t) {
    return cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]).y;
  };
  int rising = 0;
  for (const auto& t : mesh.triangles) {
    EXPECT_GT(up(t) * up(mesh.triangles[0]), 0);
    rising += t[2] - t[0] == 11 ? 1 : 0;
  }
  EXPECT_GT(rising, 9);
  EXPECT_LT(rising, 72);
}

TEST(Bench, ARunYieldsARowForEachEngineAndTheJsonHoldsThem) {
  Options options;
  options.workload = "W1-stretching";
  options.sizes = {8};
  options.warm_up = 1;
  options.frames = 3;
  options.threads = 1;
  int seen = 0;
  options.on_row = [&](const Row&) { ++seen; };
  const std::vector<Row> rows = run(options);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(seen, 2);
  EXPECT_EQ(rows[0].engine, "plain loop");
  EXPECT_EQ(rows[0].ratio, 1);
  EXPECT_EQ(rows[1].engine, "pliant");
  EXPECT_NEAR(rows[1].ratio, rows[0].ms_per_frame / rows[1].ms_per_frame, 1e-12);
  EXPECT_GE(rows[1].stretch_max, rows[1].stretch_p99);
  const nlohmann::json json = nlohmann::json::parse(to_json(rows));
  ASSERT_EQ(json.size(), 2U);
  for (const char* key : {"workload", "size", "engine", "threads", "substeps", "iterations", "ms_per_frame",
                          "ns_per_projection", "stretch_mean", "stretch_p99", "stretch_max", "ratio"})
    EXPECT_TRUE(json[1].contains(key)) << key;
}

TEST(Bench, AlternatingDiagonalsAreCutTheOtherWayInEveryOtherCell) {
  const Cloth cloth = make_w1(4, false, Diagonals::alternating);
  const auto has = [&](int a, int b) {
    return std::any_of(cloth.edges.begin(), cloth.edges.end(),
                       [&](const Edge& e) { return std::min(e.a, e.b) == a && std::max(e.a, e.b) == b; });
  };
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      const int a = 4 * row + column;
      EXPECT_EQ(has(a, a + 5), (row + column) % 2 == 0) << row << " " << column;
      EXPECT_EQ(has(a + 1, a + 4), (row + column) % 2 == 1) << row << " " << column;
    }
  }
  EXPECT_EQ(cloth.edges.size(), make_w1(4, false).edges.size());
}

TEST(Bench, PhasesStandApart) {
  Options options;
  options.workload = "W1-stretching-alternating";
  options.sizes = {8};
  options.warm_up = 1;
  options.frames = 2;
  options.threads = 1;
  const std::vector<Row> rows = run(options);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[1].workload, "W1-stretching-alternating");
  const nlohmann::json json = nlohmann::json::parse(to_json(rows));
  for (const char* phase : {"solve: tiles", "predict", "update", "find non-finite values"})
    EXPECT_TRUE(json[1].at("phases_ms").contains(phase)) << phase;
  EXPECT_FALSE(json[0].contains("phases_ms"));
}

TEST(Bench, WhatIsUnknownIsRefused) {
  Options options;
  options.workload = "W9";
  EXPECT_THROW(run(options), Error);
  options.workload.clear();
  options.sizes = {1};
  EXPECT_THROW(run(options), Error);
}

// ---------------------------------------------------------------- W3

/// The least distance of a particle from the ball's surface [m]; negative: inside.
double nearest_to_ball(const Landing& landing, const LandingEngine& engine) {
  double nearest = 9;
  for (const Vec3f& x : engine.positions(0))
    nearest = std::min(nearest, std::sqrt(double(length_squared(x - landing.ball))) - double(landing.radius));
  return nearest;
}

TEST(BenchLanding, OnABallRestsOnItInBothEngines) {
  const Landing landing = make_landing("ball", 12);
  const auto pliant = make_pliant_landing(landing, steps);
  for (int i = 0; i < 30; ++i) pliant->step(1.f / 60);
  EXPECT_NEAR(nearest_to_ball(landing, *pliant), double(landing.cloths[0].thickness), 1e-3);
  if (!has_bullet()) return;
  for (const int clusters : {0, 64}) {
    const auto bullet = make_bullet_landing(landing, steps, clusters);
    for (int i = 0; i < 30; ++i) bullet->step(1.f / 60);
    EXPECT_NEAR(nearest_to_ball(landing, *bullet), 0, 0.1) << clusters;
  }
}

// Bullet 3.24 does not do this by its own flag (bullet_landing.cpp): a cloth that falls on another must stay above it.
TEST(BenchLanding, OnAClothIsCarriedInBothEngines) {
  const Landing landing = make_landing("cloth", 8);
  std::vector<std::unique_ptr<LandingEngine>> engines;
  engines.push_back(make_pliant_landing(landing, steps));
  if (has_bullet()) engines.push_back(make_bullet_landing(landing, steps, 0));
  for (const auto& engine : engines) {
    for (int i = 0; i < 40; ++i) engine->step(1.f / 60);
    double middle = 0;
    for (const Vec3f& x : engine->positions(1)) middle += double(x.y) / 64;
    EXPECT_GT(middle, -0.5);  // without contact it would have fallen by a metre
  }
}

TEST(BenchLanding, ARunYieldsARowForEachEngineWithinItsTime) {
  LandingOptions options;
  options.sizes = {10};
  options.frames = 12;
  options.against_bullet = has_bullet();
  const std::vector<LandingRow> rows = measure_landings(options);
  ASSERT_EQ(rows.size(), has_bullet() ? 8U : 4U);
  EXPECT_EQ(nlohmann::json::parse(to_json(rows)).size(), rows.size());
  EXPECT_EQ(rows.back().engine, "pliant");
  EXPECT_EQ(rows.back().crossings, 0U);
  EXPECT_EQ(rows.back().frames, 12);
  EXPECT_TRUE(rows.back().in_time);
  EXPECT_GT(rows.back().stretch_p99, 0.9);
  options.against_bullet = false;
  options.limit = 1e-9;
  for (const LandingRow& row : measure_landings(options)) {
    EXPECT_EQ(row.frames, 1);
    EXPECT_FALSE(row.in_time);
  }
  options.frames = 0;
  EXPECT_THROW(measure_landings(options), Error);
  EXPECT_THROW(make_landing("water", 10), Error);
}

}  // namespace
}  // namespace pliant::bench
