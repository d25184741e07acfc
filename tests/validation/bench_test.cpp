// What `pliant bench` compares must be one and the same cloth, or its ratios mean nothing. No test here looks at a clock.
#include "apps/bench/bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/bench/broadphase.h"
#include "apps/bench/cloth.h"
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

// Another order of the sweep gives another crumple; where the cloth as a whole goes must agree.
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

// Small ones, on which even plain sweeps reach what is asked for.
TEST(BenchQuality, FindsTheSubstepsThatKeepTheBounds) {
  for (const QualityWorkload& workload : quality_workloads()) {
    const std::vector<Row> rows = measure_quality(workload, 16, 60);
    ASSERT_EQ(rows.size(), 3U);
    for (const Row& row : rows) {
      EXPECT_EQ(row.workload, workload.as.name);
      EXPECT_EQ(row.met, row.stretch_p99 <= workload.p99 && row.stretch_max <= workload.largest) << row.engine;
      EXPECT_TRUE(row.met) << workload.as.name << ", " << row.engine << ": " << row.stretch_p99 << ", " << row.stretch_max;
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

TEST(Bench, WhatIsUnknownIsRefused) {
  Options options;
  options.workload = "W9";
  EXPECT_THROW(run(options), Error);
  options.workload.clear();
  options.sizes = {1};
  EXPECT_THROW(run(options), Error);
}

// Volumes differ, what they hold does not: hash and boxes find the same pairs, whatever the cell or the fanout.
TEST(Bench, BroadPhasesOverTheSameBoxesFindTheSamePairs) {
  int seen = 0;
  BroadPhaseOptions options{{12}, 2, 2, [&](const BroadPhaseRow&) { ++seen; }};
  const auto rows = measure_broad_phases(options);
  EXPECT_EQ(seen, static_cast<int>(rows.size()));
  EXPECT_EQ(nlohmann::json::parse(to_json(rows)).size(), rows.size());
  double pairs = 0;
  for (const BroadPhaseRow& row : rows) {
    EXPECT_GT(row.pairs, 100) << row.method;
    if (row.method == "hash, cells of 1 edges") pairs = row.pairs;
    if (row.method.rfind("hash", 0) == 0 || row.method.rfind("boxes", 0) == 0) {
      EXPECT_EQ(row.pairs, pairs) << row.input << ", " << row.method;
    }
  }
  EXPECT_THROW(measure_broad_phases({{1}, 2, 1, {}}), Error);
  EXPECT_THROW(measure_broad_phases({{12}, 0, 1, {}}), Error);
}

}  // namespace
}  // namespace pliant::bench
