// Tests pliant compare: all sweeps start from one State, the curves equal single runs, and errors name what cannot be
// compared.
#include "apps/compare/compare.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>

#include "pliant/error.h"

namespace pliant::compare {
namespace {

/// A sheet that swings from a corner and is held by an attachment, and a rope.
Scene swinging(int columns = 9) {
  Scene scene;
  scene.frames = 4;
  scene.settings.substeps = 3;
  scene.settings.sweep = Sweep::tiled;
  scene.settings.iterations = 2;
  scene.settings.threads = 1;
  ClothOptions options;
  options.stretch = Stiffness::compliance(1e-6f);
  scene.add_cloth(grid_mesh(columns, columns - 1, 1.f, 0.8f), options);
  scene.pin(0, {0});
  scene.objects[0].attachments.push_back({5, {0.2f, 0.1f, -0.4f}, {}, Stiffness::compliance(1e-3f)});
  std::vector<Vec3f> points;
  for (int i = 0; i < 12; ++i) points.push_back({3 + 0.1f * static_cast<float>(i), 0, 0});
  scene.add(make_rope(points));
  scene.pin(1, {0});
  return scene;
}

Settings with(Sweep sweep, const Scene& scene) {
  Settings settings = scene.settings;
  settings.sweep = sweep;
  return settings;
}

bool equal_bits(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3f)) == 0;
}

TEST(TakeState, IsThatOfTheOtherWorldHoweverParticlesAreNumbered) {
  const Scene scene = swinging(68);  // more particles than a tile can have; the natural order has no tiles
  World start(scene);
  for (int frame = 0; frame < 5; ++frame) start.step(scene.frame_time);
  const std::string before = start.state_hash();
  int otherwise = 0;
  for (const NamedSweep& one : sweeps()) {
    World world(scene, with(one.sweep, scene));
    take_state(world, start);
    EXPECT_EQ(start.state_hash(), before) << one.name;
    EXPECT_EQ(world.state().time, start.state().time);
    EXPECT_EQ(world.state().frame, 5);
    for (int object = 0; object < 2; ++object) {
      EXPECT_TRUE(equal_bits(world.object(object).positions(), start.object(object).positions())) << one.name;
      EXPECT_TRUE(equal_bits(world.object(object).velocities(), start.object(object).velocities())) << one.name;
    }
    if (world.state_hash() != before) ++otherwise;
  }
  EXPECT_GT(otherwise, 0) << "some sweep numbers particles otherwise, or this test says nothing";
}

TEST(TakeState, GoesOnWithTheSameBits) {
  const Scene scene = swinging();
  World start(scene), taken(scene, with(Sweep::sequential, scene));
  for (int frame = 0; frame < 5; ++frame) start.step(scene.frame_time);
  take_state(taken, start);
  start.step(scene.frame_time);
  taken.step(scene.frame_time);
  EXPECT_TRUE(equal_bits(start.object(0).positions(), taken.object(0).positions()))
      << "remainders and the attachment's target too";
}

Options quick(const std::vector<std::string>& methods = {}) {
  Options options;
  options.methods = methods;
  options.iterations = 12;
  return options;
}

TEST(Compare, EverySweepSolvesTheSameSubstep) {
  const Result result = run(swinging(), quick());
  EXPECT_EQ(result.curves.size() + result.refused.size(), default_methods(swinging()).size());
  EXPECT_EQ(result.frame, 2);
  EXPECT_EQ(result.residual_type, "distance");
  for (const Curve& curve : result.curves) {
    ASSERT_EQ(curve.record.size(), 13U) << curve.name;
    EXPECT_NEAR(curve.residuals.front(), result.curves.front().residuals.front(), 1e-12) << curve.name;
    EXPECT_GT(curve.residuals.front(), 1e-7);
    std::vector<int> sampled;
    for (const Sample& sample : curve.samples) {
      sampled.push_back(sample.iterations);
      EXPECT_EQ(sample.residual, curve.residuals.at(static_cast<std::size_t>(sample.iterations)));
    }
    EXPECT_EQ(sampled, (std::vector<int>{1, 2, 3, 5, 7, 10, 12}));
    EXPECT_GT(curve.samples[0].milliseconds, 0) << curve.name;
  }
}

/// The stretch of a sample must be that of a World stepped by hand.
/// Where substeps follow the State, the substep is one of the frame before the State that curves start from.
TEST(Compare, MeasuresASubstepOfTheLengthThatTheSceneHad) {
  Scene scene;
  scene.frames = 6;
  scene.add_cloth(grid_mesh(24, 24, 1, 1));
  scene.objects[0].self_collision = true;
  Options options;
  options.methods = {"chains"};
  options.iterations = 1;
  World world(scene);
  int substeps = 0;
  for (const int frame : {0, 3}) {
    options.frame = frame;
    const Result result = run(scene, options);
    for (; world.state().frame < std::max(frame, 1);) substeps = world.step(scene.frame_time).substeps;
    EXPECT_DOUBLE_EQ(result.substep, static_cast<double>(scene.frame_time) / substeps) << frame;
    EXPECT_NE(substeps, 30) << "that was the length before";
    // The first quarter of a scene has the length of 40 substeps a frame, as nothing was measured before it; then it
    // falls.
    EXPECT_LT(substeps, frame == 0 ? 40 : 20) << frame;
  }
  scene.settings.least_substeps = 48;
  EXPECT_DOUBLE_EQ(run(scene, options).substep, static_cast<double>(scene.frame_time) / 48);
  options.substeps = 7;
  EXPECT_DOUBLE_EQ(run(scene, options).substep, static_cast<double>(scene.frame_time) / 7);
}

TEST(Compare, ASampleIsWhatARunGives) {
  Scene scene = swinging();
  Options options = quick({"tiled"});
  options.substeps = 6;
  options.frame = 0;
  const Curve curve = run(scene, options).curves.at(0);
  scene.settings.substeps = 1;
  for (const Sample& sample : curve.samples) {
    scene.settings.iterations = sample.iterations;
    World world(scene);
    world.step(scene.frame_time / 6);
    EXPECT_EQ(world.measure().stretch().largest, sample.stretch.largest) << sample.iterations;
    EXPECT_EQ(world.measure().stretch().p99, sample.stretch.p99) << sample.iterations;
  }
}

/// A sheet that lies on a fixed one, so that every restored World rebuilds its near lists.
Scene touching() {
  Scene scene;
  scene.frames = 4;
  scene.settings.substeps = 3;
  scene.settings.sweep = Sweep::tiled;
  scene.settings.threads = 1;
  for (const float height : {0.f, 0.004f}) {
    TriangleMesh mesh = grid_mesh(8, 8, 0.2f, 0.2f);
    for (Vec3f& p : mesh.positions) p.y += height;
    const int object = scene.add_cloth(mesh, {});
    scene.objects[static_cast<std::size_t>(object)].collides = true;
    scene.objects[static_cast<std::size_t>(object)].thickness = 0.002f;
  }
  scene.pin(0, {0, 7, 56, 63});
  return scene;
}

TEST(Compare, TimesTheSubstepAfterWhereARestoredOneListsPairs) {
  Options options = quick({"tiled", "multigrid"});
  options.frame = 0;
  options.iterations = 3;
  const Result result = run(touching(), options);
  EXPECT_TRUE(times_next(result));
  for (const Curve& curve : result.curves)
    for (const Sample& sample : curve.samples) EXPECT_TRUE(sample.of_next) << curve.name;
  EXPECT_EQ(to_charts(result)[1].x_label, "milliseconds of the next substep");
  EXPECT_NE(to_table(result).find("\nms: of the substep after it"), std::string::npos) << to_table(result);
  EXPECT_EQ(nlohmann::json::parse(to_json(result)).at("times_next"), true);
  Scene scene = touching();
  scene.settings.substeps = 1;
  for (const Sample& sample : result.curves[0].samples) {
    scene.settings.iterations = sample.iterations;
    World world(scene);
    ASSERT_GT(world.step(scene.frame_time / 3).pairs.rebuilds, 0) << "or this shows nothing";
    EXPECT_EQ(world.measure().stretch().largest, sample.stretch.largest)
        << "of the substep itself, with " << sample.iterations;
  }

  const Result apart = run(swinging(), quick({"tiled"}));
  EXPECT_FALSE(times_next(apart));
  EXPECT_EQ(to_charts(apart)[1].x_label, "milliseconds of the substep");
  EXPECT_EQ(to_table(apart).find("ms: of"), std::string::npos);
}

TEST(Compare, FiguresHaveNoPowersOfTen) {
  EXPECT_EQ(figure(100000, 4), "100000");
  EXPECT_EQ(figure(118.4, 2), "118");
  EXPECT_EQ(figure(99.6, 2), "100");
  EXPECT_EQ(figure(9.96, 2), "10");
  EXPECT_EQ(figure(0.00834, 2), "0.0083");
  EXPECT_EQ(figure(1234.5, 4), "1234");
}

TEST(Compare, ATightRopeIsSolvedByChainsAtOnce) {
  Scene scene;
  scene.settings.threads = 1;
  scene.frames = 0;
  std::vector<Vec3f> points;
  for (int i = 0; i < 60; ++i) points.push_back({0, -0.1f * static_cast<float>(i), 0});
  scene.add(make_rope(points));
  scene.pin(0, {0});
  scene.settings.substeps = 1;
  scene.settings.sweep_options.chain_softness = 0;
  const Result result = run(scene, quick({"tiled", "chains"}));
  // The rope hangs straight down, so nothing rotates: one exact solve is enough, while a sweep has hardly begun.
  EXPECT_LT(result.curves[1].residuals[1], 0.01 * result.curves[1].residuals[0]);
  EXPECT_GT(result.curves[0].residuals[1], 0.1 * result.curves[0].residuals[0]);
}

std::string refusal(const Scene& scene, const Options& options) {
  try {
    run(scene, options);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(Compare, SaysWhichNamesThereAre) {
  const std::string sweep = refusal(swinging(), quick({"tilde"})),
                    option = refusal(swinging(), quick({"tiled+lasers"}));
  EXPECT_NE(sweep.find("'tilde'"), std::string::npos) << sweep;
  for (const NamedSweep& one : sweeps()) EXPECT_NE(sweep.find(one.name), std::string::npos) << sweep;
  EXPECT_NE(option.find("'lasers'"), std::string::npos) << option;
  EXPECT_NE(option.find("tethers, chebyshev, average"), std::string::npos) << option;
  EXPECT_NE(refusal(swinging(), quick({"tiled", "tiled"})).find("twice"), std::string::npos);
}

TEST(Compare, OptionsFollowThePlusAndTheRestIsTheScenes) {
  SweepOptions base;
  base.relaxation = 1.25f;
  const Method plain = method_of("jacobi", base), full = method_of("jacobi+average+chebyshev+tethers", base);
  EXPECT_EQ(plain.options.relaxation, 1.25f);
  EXPECT_EQ(plain.options.sharing, SweepOptions::Sharing::split);
  EXPECT_EQ(full.sweep, Sweep::jacobi);
  EXPECT_EQ(full.options.sharing, SweepOptions::Sharing::average);
  EXPECT_EQ(full.options.acceleration, SweepOptions::Acceleration::chebyshev);
  EXPECT_TRUE(full.options.tethers);
  EXPECT_EQ(full.options.relaxation, 1.25f);
}

TEST(Compare, WhatIsRefusedIsLeftOutWithItsReason) {
  const Result result = run(swinging(), quick({"natural+chebyshev", "tiled"}));
  ASSERT_EQ(result.curves.size(), 1U);
  EXPECT_EQ(result.curves[0].name, "tiled");
  ASSERT_EQ(result.refused.size(), 1U);
  EXPECT_EQ(result.refused[0].name, "natural+chebyshev");
  EXPECT_NE(result.refused[0].reason.find("natural order"), std::string::npos) << result.refused[0].reason;
  EXPECT_NE(refusal(swinging(), quick({"natural+chebyshev"})).find("every sweep was rejected"), std::string::npos);
}

TEST(Budget, TakesWhatFitsAndRefusesWhatDoesNot) {
  Scene scene = swinging();
  scene.frames = 2;
  Options options = quick({"tiled", "chains"});
  options.budget = 1e6;  // no machine is so slow
  const Result plenty = run(scene, options);
  ASSERT_EQ(plenty.budgeted.size(), 2U);
  for (const Budgeted& row : plenty.budgeted) {
    EXPECT_EQ(row.substeps, 2000) << row.name;
    EXPECT_GT(row.milliseconds, 0);
    EXPECT_GE(row.worst.largest, row.last.largest);
    EXPECT_LT(row.worst.p99, 1.05) << row.name;
  }
  options.budget = 1e-9;
  const Result nothing = run(scene, options);
  EXPECT_TRUE(nothing.budgeted.empty());
  ASSERT_EQ(nothing.refused.size(), 2U);
  EXPECT_NE(nothing.refused[0].reason.find("nothing fits into 1e-09 ms a frame"), std::string::npos)
      << nothing.refused[0].reason;
  EXPECT_EQ(nothing.refused[0].reason.find("finite"), std::string::npos) << "not the reason";
  EXPECT_EQ(nothing.curves.size(), 2U) << "the curves need no budget";
}

TEST(Budget, TellsWhatIsTooSlowFromWhatDoesNotStayFinite) {
  Scene scene = swinging();
  scene.frames = 12;
  scene.forces.push_back([](const Vec3f&, const Vec3f&, float, float time) {
    return Vec3f{time > 0.15f ? 3e38f : 0, 0, 0};  // after the frame of the curves and that of the first run
  });
  Options options = quick({"tiled"});
  options.frame = 1;
  options.budget = 1e6;
  const Result result = run(scene, options);
  ASSERT_EQ(result.refused.size(), 1U);
  EXPECT_NE(result.refused[0].reason.find("diverges"), std::string::npos) << result.refused[0].reason;
}

TEST(Compare, EveryKindOfSweepIsComparedAndTethersWhereSomethingHoldsThem) {
  const auto has = [](const std::vector<std::string>& names, const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  Scene scene = swinging();
  for (const NamedSweep& one : sweeps())
    EXPECT_EQ(has(default_methods(scene), one.name.c_str()), one.sweep != Sweep::sequential) << one.name;
  EXPECT_FALSE(has(default_methods(scene), "chains+tethers")) << "which is the same as tethered_chains";
  scene.settings.sweep_options.tethers = true;
  EXPECT_FALSE(has(default_methods(scene), "tethered_chains")) << "which is then the same as chains";
  scene.settings.sweep_options.tethers = false;
  for (Object& object : scene.objects) object.pins.clear();
  EXPECT_FALSE(has(default_methods(scene), "tethered_chains"));
  EXPECT_TRUE(has(default_methods(scene), "chains"));
  scene.objects[1].masses[0] = std::numeric_limits<float>::infinity();
  EXPECT_TRUE(has(default_methods(scene), "tethered_chains"));
}

TEST(Compare, ALongerRunBoundsWhatAShorterOneTakes) {
  std::vector<Sample> samples{{1, 2.0, 0, {}}, {2, 5.0, 0, {}}, {3, 4.0, 0, {}}, {5, 3.0, 0, {}}, {7, 9.0, 0, {}}};
  lower_to_longer_runs(samples);
  const double expected[] = {2, 3, 3, 3, 9};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(samples[i].milliseconds, expected[i]) << i;
}

TEST(Compare, TimesBetweenSamplesLieOnALine) {
  const Curve curve{"", {}, {}, {{1, 2.0, 0, {}}, {3, 6.0, 0, {}}, {7, 7.0, 0, {}}}};
  const double expected[] = {2, 2, 4, 6, 6.25, 6.5, 6.75, 7, 7};
  for (int i = 0; i < 9; ++i) EXPECT_DOUBLE_EQ(milliseconds_at(curve, i), expected[i]) << i;
}

TEST(Compare, DrawsSixPanelsWithALineASweep) {
  const Result result = run(swinging(), quick({"tiled", "jacobi", "chains"}));
  const std::vector<plot::Chart> charts = to_charts(result);
  ASSERT_EQ(charts.size(), 6U);
  for (std::size_t i = 0; i < charts.size(); ++i) {
    const plot::Chart& chart = charts[i];
    EXPECT_TRUE(chart.logarithmic_x && chart.logarithmic_y) << chart.title;
    EXPECT_EQ(chart.series.size(), i < 2 ? 4U : 3U) << chart.title;
    for (std::size_t sweep = 0; sweep < 3; ++sweep) {
      EXPECT_EQ(chart.series[sweep].name, result.curves[sweep].name) << chart.title;
      EXPECT_EQ(chart.series[sweep].colour, static_cast<int>(sweep)) << chart.title << ": one colour in all panels";
      EXPECT_TRUE(std::is_sorted(chart.series[sweep].x.begin(), chart.series[sweep].x.end())) << chart.title;
    }
  }
  EXPECT_DOUBLE_EQ(charts[0].series[2].y[4], 1000 * result.curves[2].residuals[5])
      << "millimetres, from iteration 1 on";
  EXPECT_EQ(charts[1].series[2].y, charts[0].series[2].y) << "by time as by iterations, whatever was sampled";
  EXPECT_DOUBLE_EQ(charts[2].series[0].y[0], 100 * (result.curves[0].samples[0].stretch.largest - 1)) << "percent";
  EXPECT_DOUBLE_EQ(charts[5].series[1].y[6], 100 * (result.curves[1].samples[6].stretch.p99 - 1));
}

TEST(Compare, ShowsTheErrorThatAllBeginWith) {
  const Result result = run(swinging(), quick({"tiled", "jacobi"}));
  const plot::Series by_iterations = to_charts(result)[0].series[2], by_time = to_charts(result)[1].series[2];
  const double start = 1000 * result.curves[0].record[0].primal[0].rms;
  EXPECT_EQ(result.curves[0].record[0].primal[0].type, "distance");
  EXPECT_EQ(by_iterations.y, (std::vector<double>{start, start}));
  EXPECT_EQ(by_iterations.x, (std::vector<double>{1, 12}));
  EXPECT_EQ(by_time.y, by_iterations.y);
  double longest = 0;
  for (const Curve& curve : result.curves) longest = std::max(longest, curve.samples.back().milliseconds);
  EXPECT_EQ(by_time.x[1], longest);
}

TEST(Compare, WritesAllNumbers) {
  Options options = quick({"tiled", "natural+chebyshev"});
  const Result result = run(swinging(), options);
  const auto json = nlohmann::json::parse(to_json(result));
  EXPECT_EQ(json.at("curves").size(), 1U);
  EXPECT_EQ(json["curves"][0]["samples"].size(), 7U);
  EXPECT_EQ(json["curves"][0]["residuals"].size(), 13U);
  EXPECT_EQ(json["curves"][0]["samples"][6]["residual"], result.curves[0].residuals[12]);
  EXPECT_EQ(json["refused"][0]["sweep"], "natural+chebyshev");
  EXPECT_FALSE(json.contains("budget"));
  const std::string table = to_table(result);
  EXPECT_NE(table.find("after 2 frames"), std::string::npos) << table;
  EXPECT_NE(table.find("\ntiled "), std::string::npos) << table;
}

}  // namespace
}  // namespace pliant::compare
