// Tests sweeps in a World: what is rejected and why, what the Report says, and errors.
#include <gtest/gtest.h>

#include <limits>

#include "pliant/error.h"
#include "support/scenes.h"

namespace pliant {
namespace {

using namespace testing_support;

Scene hanging_chain(Sweep sweep, const SweepOptions& options = {}) {
  Scene scene;
  scene.settings = settings_of(2, 12);
  scene.settings.sweep = sweep;
  scene.settings.sweep_options = options;
  scene.add(chain(8, 0.1f, Stiffness::compliance(1e-5f)));
  scene.pin(0, {0});
  return scene;
}

SweepOptions chebyshev() {
  SweepOptions options;
  options.acceleration = SweepOptions::Acceleration::chebyshev;
  return options;
}

Error scene_refusal(const Scene& scene) {
  try {
    const World world(scene);
  } catch (const Error& error) {
    return error;
  }
  return Error({}, "");
}

TEST(WorldSweeps, ChebyshevOverNaturalOrderIsRefusedWithTheReason) {
  const Error error = scene_refusal(hanging_chain(Sweep::natural, chebyshev()));
  const std::string text = error.what();
  EXPECT_NE(text.find("natural order"), std::string::npos) << text;
  EXPECT_NE(text.find("without bound"), std::string::npos) << text;
  EXPECT_NE(error.advice().find("symmetric"), std::string::npos);
  for (Sweep sweep : {Sweep::tiled, Sweep::sequential, Sweep::symmetric, Sweep::jacobi}) {
    EXPECT_STREQ(scene_refusal(hanging_chain(sweep, chebyshev())).what(), Error({}, "").what());
  }
}

/// A stretched square that lies on a fixed one, so that all four corners touch.
Scene square_on_square(const SweepOptions& options) {
  Scene scene;
  scene.settings = settings_of(1, 20);
  scene.settings.sweep = Sweep::tiled;
  scene.settings.sweep_options = options;
  ClothOptions rigid;
  rigid.stretch = Stiffness::rigid();
  rigid.bending_model = ClothOptions::Bending::none;
  for (const float height : {0.f, 0.005f}) {
    Object square = make_cloth(grid_mesh(2, 2, 0.5f, 0.5f), rigid);
    for (Vec3f& p : square.positions) p = {p.x * (height > 0 ? 1.1f : 2.f), height, p.z * (height > 0 ? 1.1f : 2.f)};
    square.collides = true;
    square.thickness = 0.01f;
    scene.add(square);
  }
  scene.pin(0, {0, 1, 2, 3});
  return scene;
}

/// No particle may be extrapolated, so the bits are those of the plain sweep.
TEST(WorldSweeps, ChebyshevDoesNotExtrapolateWhatTouchesASurface) {
  const auto end_of = [](const SweepOptions& options) {
    World world(square_on_square(options));
    EXPECT_GT(world.step(1.f / 60).pairs.contacts, 3);
    return world.state();
  };
  SweepOptions options = chebyshev();
  options.spectral_radius = 0.9f;
  options.plain_iterations = 3;
  EXPECT_EQ(hash(end_of(options)), hash(end_of({})));
}

/// No multiplier explains the displacements by contacts, so the dual residual must be that of the particles that do not
/// touch.
TEST(WorldSweeps, DualResidualLeavesOutWhatTouchesASurface) {
  Scene scene = square_on_square({});
  scene.settings.record_residuals = true;
  const Report report = World(scene).step(1.f / 60);
  ASSERT_EQ(report.convergence.size(), 21U);
  EXPECT_EQ(report.convergence.back().dual_largest, 0);
}

TEST(WorldSweeps, OptionsOutOfRangeAreRefusedByName) {
  for (float relaxation : {0.f, -1.f, 2.f, std::numeric_limits<float>::quiet_NaN()}) {
    SweepOptions options;
    options.relaxation = relaxation;
    EXPECT_NE(std::string(scene_refusal(hanging_chain(Sweep::tiled, options)).what()).find("relaxation"),
              std::string::npos);
  }
  for (float radius : {-0.1f, 1.f, std::numeric_limits<float>::quiet_NaN()}) {
    SweepOptions options = chebyshev();
    options.spectral_radius = radius;
    EXPECT_NE(std::string(scene_refusal(hanging_chain(Sweep::tiled, options)).what()).find("spectral_radius"),
              std::string::npos);
  }
  for (int plain : {0, 1, 10001}) {
    SweepOptions options = chebyshev();
    options.plain_iterations = plain;
    EXPECT_NE(std::string(scene_refusal(hanging_chain(Sweep::tiled, options)).what()).find("plain_iterations"),
              std::string::npos);
  }
}

TEST(WorldSweeps, TheReferenceRunsEverySweep) {
  for (Sweep sweep : {Sweep::tiled, Sweep::symmetric, Sweep::jacobi, Sweep::natural}) {
    Scene scene = hanging_chain(sweep);
    World world(scene);
    scene.settings.isa = "sequential";
    World reference(scene);
    for (int i = 0; i < 3; ++i) {
      world.step(1.f / 60);
      reference.step(1.f / 60);
    }
    EXPECT_EQ(reference.isa(), "sequential");
    EXPECT_EQ(world.state_hash(), reference.state_hash()) << static_cast<int>(sweep);
  }
}

TEST(WorldSweeps, SequentialIsTiledWithAccelerationToo) {
  World tiled(hanging_chain(Sweep::tiled, chebyshev())), sequential(hanging_chain(Sweep::sequential, chebyshev())),
      plain(hanging_chain(Sweep::tiled));
  for (World* world : {&tiled, &sequential, &plain}) world->step(1.f / 60);
  EXPECT_EQ(tiled.state_hash(), sequential.state_hash());
  EXPECT_NE(tiled.state_hash(), plain.state_hash());
}

TEST(WorldSweeps, TheReportFollowsTheLastSubstep) {
  Scene scene = hanging_chain(Sweep::tiled);
  EXPECT_TRUE(World(scene).step(1.f / 60).convergence.empty());
  scene.settings.record_residuals = true;
  World world(scene);
  for (int i = 0; i < 3; ++i) world.step(1.f / 60);
  const Report report = world.step(1.f / 60);
  ASSERT_EQ(report.convergence.size(), 13U);
  for (int i = 0; i <= 12; ++i) {
    const IterationResidual& at = report.convergence[static_cast<std::size_t>(i)];
    EXPECT_EQ(at.iteration, i);
    ASSERT_EQ(at.primal.size(), 1U);
    EXPECT_EQ(at.primal[0].type, "distance");
    EXPECT_EQ(at.primal[0].constraints, 7);
    EXPECT_LE(at.primal[0].rms, at.primal[0].largest);
  }
  EXPECT_EQ(report.convergence.front().dual_largest, 0) << "nothing has moved that needs explaining";
  EXPECT_LT(report.convergence.back().primal[0].rms, 0.5 * report.convergence.front().primal[0].rms);
  // With Gauss-Seidel the dual residual stays at what the rotation of gradients causes: small, but not zero.
  EXPECT_LT(report.convergence.back().dual_largest, 1e-3);
}

TEST(WorldSweeps, AToleranceSavesIterationsAndIsKeptByEverySweep) {
  for (const NamedSweep& one : sweeps()) {
    Scene scene = hanging_chain(one.sweep);
    scene.settings.iterations = 300;
    scene.settings.tolerance = 1e-5f;
    scene.settings.measure = true;
    World world(scene);
    for (int i = 0; i < 5; ++i) {
      const Report report = world.step(1.f / 60);
      EXPECT_GE(report.iterations.smallest, 1) << one.name;
      EXPECT_LT(report.iterations.largest, 300) << one.name;
      EXPECT_LT(report.residuals.at(0).rms, 1.01e-5) << one.name;
    }
  }
}

TEST(WorldSweeps, AToleranceThatCannotBeIsRefusedAndOneThatDoesNothingDoubted) {
  Scene scene = hanging_chain(Sweep::tiled);
  for (float tolerance : {-1e-6f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    scene.settings.tolerance = tolerance;
    EXPECT_NE(std::string(scene_refusal(scene).what()).find("tolerance"), std::string::npos) << tolerance;
  }
  const auto doubts = [&] {
    int count = 0;
    for (const Finding& finding : inspect(scene))
      count += finding.message.find("tolerance") != std::string::npos ? 1 : 0;
    return count;
  };
  scene.settings.tolerance = 1e-4f;
  EXPECT_EQ(doubts(), 0);
  scene.settings.iterations = 1;
  EXPECT_EQ(doubts(), 1) << "one iteration has nothing to save";
  scene.objects[0].constraints.clear();
  EXPECT_EQ(doubts(), 2) << "and nothing is judged";
}

TEST(WorldSweeps, WhatIsNotFiniteIsReportedByAll) {
  for (Sweep sweep : {Sweep::tiled, Sweep::symmetric, Sweep::jacobi, Sweep::natural}) {
    for (const SweepOptions& options : {SweepOptions{}, chebyshev()}) {
      if (sweep == Sweep::natural && options.acceleration != SweepOptions::Acceleration::none) continue;
      Scene scene = hanging_chain(sweep, options);
      scene.forces.push_back([](const Vec3f&, const Vec3f&, float, float) { return Vec3f{3e38f, 0, 0}; });
      World world(scene);
      Report report;
      for (int i = 0; i < 5 && report.ok(); ++i) report = world.step(1.f / 60);
      EXPECT_FALSE(report.ok()) << static_cast<int>(sweep);
      EXPECT_FALSE(report.nonfinite && report.nonfinite->element.empty());
    }
  }
}

}  // namespace
}  // namespace pliant
