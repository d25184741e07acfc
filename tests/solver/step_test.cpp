// Tests whole steps on small tiles, so that small scenes have many tiles and inter-tile constraints: the same bits on
// any number of threads and any lanes; volumes; and how errors are named.
#include "solver/step.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <regex>

#include "math/quat.h"
#include "pliant/error.h"
#include "solver/forces.h"
#include "solver/measure.h"
#include "solver/step_support.h"
#include "solver/volume.h"
#include "support/kernels.h"

namespace pliant {
namespace {

using namespace testing_support;

Object sheet(int n, float y) {
  Object object;
  object.name = "sheet";
  for (int r = 0; r < n; ++r) {
    for (int c = 0; c < n; ++c) {
      object.positions.push_back(
          {static_cast<float>(c) * 0.05f, y + static_cast<float>((r * c) % 3) * 0.003f, static_cast<float>(r) * 0.05f});
      object.masses.push_back(0.01f);
    }
  }
  const GridStencils grid = grid_stencils(n);
  std::vector<int> edges = grid.across;
  edges.insert(edges.end(), grid.along.begin(), grid.along.end());
  object.constraints = {{"distance", edges, {}, Stiffness::compliance(1e-7f), {}},
                        {"distance", grid.diagonals, {}, Stiffness::compliance(1e-4f, 0.5f), {}},
                        {"dihedral_bending", grid.hinges, {}, Stiffness::compliance(1), {}},
                        {"isometric_bending", grid.hinges, {}, Stiffness::pbd(0.2f), {}}};
  object.triangles = grid.triangles;
  object.pins.push_back({0, Motion{{Keyframe{0, {}, {}}, Keyframe{1, {0.2f, 0.1f, 0}, {}}}, {}, false}});
  object.attachments.push_back({n - 1, {1, y + 0.3f, 0}, {}, Stiffness::compliance(1e-3f, 1)});
  object.damping = 0.3f;
  return object;
}

/// A model of objects, colliders, wind and a force field, compiled with tiles of `largest_tile` particles.
Model make_model(int largest_tile, int passes, bool forces) {
  Model model;
  model.gravity = {0, -9.81f, 0};
  if (forces) {
    model.wind = {{3, 0, 1}, 0.5f, 0.3f, 1.2f};
    model.forces.push_back([](const Vec3f& x, const Vec3f&, float, float) { return Vec3f{0.001f * x.y, 0, 0}; });
  }
  Collider ground, ball;
  ground.position = {0, 0.3f, 0};
  ball.shape = Sphere{0.3f};
  ball.position = {0.4f, 0.6f, 0.4f};
  ball.motion = {{Keyframe{0, {}, {}}, Keyframe{0.5f, {0.1f, 0.2f, 0}, {}}}, {}, false};
  model.colliders = {ground, ball};
  model.add(compile(sheet(19, 1), {passes, largest_tile}));
  model.add(compile(balloon(2, 1.2f, Stiffness::compliance(1e-6f, 1e-3f)), {passes, largest_tile}));
  model.add(compile(balloon(1, 1, Stiffness::pbd(0.5f)), {passes, largest_tile}));
  return model;
}

struct Manner {
  int largest_tile = 40, threads = 1, substeps = 6, iterations = 1;
  bool forces = false, keeps = false;
  const Kernels* kernels = &kernels_sequential();
};

State run(const Manner& how) {
  const Model model = make_model(how.largest_tile, how.substeps * how.iterations, how.forces);
  State state = initial_state(model);
  Workspace workspace;
  prepare(model, how.keeps || how.iterations > 1 ? Multipliers::all : Multipliers::none, workspace);
  prepare_sweeps(model, Settings{}, 1, workspace);
  Executor executor(how.threads);
  for (int frame = 0; frame < 12; ++frame) {
    Report report;
    step({model, state, workspace, executor, *how.kernels, how.substeps, how.iterations}, 1.f / 60, report);
    EXPECT_TRUE(report.ok()) << (report.ok() ? "" : report.nonfinite->element);
  }
  return state;
}

TEST(Step, GivesTheSameBitsOnAnyThreadsAndLanes) {
  for (int largest_tile : {16, 100, 4096}) {
    for (int iterations : {1, 3}) {
      for (bool forces : {false, true}) {
        Manner how;
        how.largest_tile = largest_tile;
        how.iterations = iterations;
        how.substeps = 12 / iterations;
        how.forces = forces;
        const State expected = run(how);
        for (const std::string& isa : available_isas()) {
          how.kernels = &pick_kernels(isa);
          for (int threads : {1, 2, 3, 8}) {
            if (isa != available_isas().back() && threads != 2) continue;
            how.threads = threads;
            expect_equal(run(how), expected,
                         isa + " on " + std::to_string(threads) + ", tiles of " + std::to_string(largest_tile));
          }
        }
      }
    }
  }
}

TEST(Step, KeepingMultipliersOfOneIterationChangesNoBit) {
  Manner how;
  const State without = run(how);
  how.keeps = true;
  expect_equal(run(how), without, "sequential");
  how.kernels = &pick_kernels("");
  expect_equal(run(how), without, how.kernels->isa);
}

TEST(Step, TheScheduleOfOneObjectKnowsNothingOfAnother) {
  // The same sheet must move with the same bits alone and among others.
  Model alone, together;
  together.add(compile(balloon(1, 1, Stiffness::compliance(0)), {6, 40}));
  alone.add(compile(sheet(9, 1), {6, 40}));
  together.add(compile(sheet(9, 1), {6, 40}));
  alone.gravity = together.gravity = {0, -9.81f, 0};
  const auto moved = [](const Model& model) {
    State state = initial_state(model);
    Workspace workspace;
    prepare(model, Multipliers::none, workspace);
    prepare_sweeps(model, Settings{}, 1, workspace);
    Executor executor(2);
    for (int frame = 0; frame < 10; ++frame) {
      Report report;
      step({model, state, workspace, executor, pick_kernels(""), 6, 1}, 1.f / 60, report);
    }
    return state.positions;
  };
  const Records a = moved(alone), b = moved(together);
  EXPECT_TRUE(equal_bits(a, {b.begin() + together.first[1], b.end()}));
}

// ------------------------------------------------------------------------------------------------ wind

TEST(Wind, SwingsEvenlyAtAnyTime) {
  const Wind wind{{2, 0, 0}, 0.5f, 1, 1.2f};
  EXPECT_NEAR(wind_at(wind, 7.25).x, 3, 1e-6);
  EXPECT_NEAR(wind_at(wind, 7.75).x, 1, 1e-6);
  EXPECT_NEAR(wind_at(wind, -0.75).x, 3, 1e-6);
  EXPECT_EQ(wind_at(wind, 1e19).x, 2) << "a whole number of turns, more than any integer holds";
}

// ------------------------------------------------------------------------------------------------ volume

struct VolumeCase {
  Model model;
  State state;
  Workspace workspace;
  VolumeCase(int largest_tile, float pressure, const Stiffness& stiffness) {
    Object object = balloon(3, pressure, stiffness);
    object.constraints.clear();
    model.add(compile(object, {1, largest_tile}));
    state = initial_state(model);
    prepare(model, Multipliers::none, workspace);
    prepare_sweeps(model, Settings{}, 1, workspace);
    workspace.displacements.assign(state.positions.size(), Record{});
  }
  /// The volume error at the displaced positions.
  double error() const {
    Records places = state.positions;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Record& d = workspace.displacements[i];
      places[i] = {places[i].x + d.x, places[i].y + d.y, places[i].z + d.z, places[i].w};
    }
    return volume_error(model.objects[0], places.data());
  }
  void project(int threads, bool first_pass, float h = 0.01f) {
    Executor executor(threads);
    executor.enter([&] {
      const auto of_object = [&](int) {
        SweepArguments a;
        a.positions = state.positions.data();
        a.displacements = workspace.displacements.data();
        a.remainders = state.remainders.data();
        a.h = h;
        a.inverse_h = 1 / h;
        a.inverse_h2 = 1 / h / h;
        a.first_pass = first_pass;
        return a;
      };
      std::vector<int> tasks(model.tiles().size());
      std::iota(tasks.begin(), tasks.end(), 0);
      project_volumes(model, workspace, executor, of_object, tasks);
    });
  }
};

TEST(Volume, IsThatOfTheMesh) {
  const VolumeCase sphere(4096, 1, {});
  EXPECT_NEAR(measure_volume(sphere.model.objects[0], sphere.state.positions.data()), 4.18879 * 0.008,
              0.02 * 4.18879 * 0.008);
  EXPECT_NEAR(sphere.error(), 0, 1e-8);
}

TEST(Volume, RigidProjectionReachesItsPressure) {
  VolumeCase sphere(30, 1.5f, {});
  const double before = sphere.error();
  EXPECT_LT(before, 0);
  for (int i = 0; i < 6; ++i) sphere.project(2, i == 0);
  EXPECT_LT(std::fabs(sphere.error()), 1e-5 * std::fabs(before));
}

TEST(Volume, ComplianceBalancesItsMultiplier) {
  VolumeCase sphere(30, 1.5f, Stiffness::compliance(1e-3f));
  for (int i = 0; i < 60; ++i) sphere.project(1, i == 0);
  const double multiplier = sphere.workspace.volume_multipliers[0];
  EXPECT_GT(multiplier, 0);
  EXPECT_NEAR(sphere.error() + 1e-3 / (0.01 * 0.01) * multiplier, 0, 1e-5 * std::fabs(sphere.error()));
}

TEST(Volume, PbdRemovesItsShare) {
  VolumeCase sphere(30, 1.001f, Stiffness::pbd(0.25f));
  const double before = sphere.error();
  sphere.project(1, true);
  EXPECT_NEAR(sphere.error(), 0.75 * before, 0.01 * std::fabs(before));
}

TEST(Volume, SumsAreTheSameOnAnyNumberOfThreads) {
  VolumeCase one(16, 1.3f, Stiffness::compliance(1e-4f, 0.1f));
  for (int i = 0; i < 5; ++i) one.project(1, i == 0);
  for (int threads : {2, 3, 8}) {
    VolumeCase many(16, 1.3f, Stiffness::compliance(1e-4f, 0.1f));
    for (int i = 0; i < 5; ++i) many.project(threads, i == 0);
    EXPECT_TRUE(equal_bits(one.workspace.displacements, many.workspace.displacements)) << threads;
  }
}

/// The largest distance of a displaced particle from a point.
double reach(const VolumeCase& sphere, const Vec3d& centre) {
  double largest = 0;
  for (std::size_t i = 0; i < sphere.state.positions.size(); ++i) {
    const Record &p = sphere.state.positions[i], &d = sphere.workspace.displacements[i];
    const Vec3d x{double(p.x) + d.x, double(p.y) + d.y, double(p.z) + d.z};
    largest = std::fmax(largest, std::sqrt(length_squared(x - centre)));
  }
  return largest;
}

TEST(Volume, IsNeverThrownFarBeyondWhatIsWanted) {
  const double radius = 0.2;
  const Vec3d centre{0, 1.5, 0.4};
  VolumeCase crushed(4096, 1, {});
  for (Record& p : crushed.state.positions) p = {p.x * 1e-6f, p.y * 1e-6f, p.z * 1e-6f, p.w};
  crushed.project(1, true);
  EXPECT_GT(reach(crushed, {}), 0.5 * radius);
  EXPECT_LT(reach(crushed, {}), 1.2 * radius);
  for (float pressure : {10.f, 100.f, 1000.f}) {
    const double wanted = radius * std::cbrt(pressure);
    VolumeCase pumped(4096, pressure, {});
    pumped.project(1, true);
    EXPECT_LT(reach(pumped, centre), 1.5 * wanted) << pressure;
    for (int i = 0; i < 15; ++i) pumped.project(1, false);
    EXPECT_LT(std::fabs(pumped.error()), 1e-4 * pumped.model.objects[0].volume.target) << pressure;
  }
  VolumeCase emptied(4096, 0, {});
  const double full = emptied.error();
  for (int i = 0; i < 20; ++i) emptied.project(1, i == 0);
  EXPECT_LT(std::fabs(emptied.error()), 0.01 * full) << "nothing holds it as it is";
}

TEST(Volume, OfACollapsedBalloonStaysFinite) {
  for (float size : {0.f, 1e-12f, 1e-20f}) {
    VolumeCase point(4096, 1, {});
    for (Record& p : point.state.positions) p = {p.x * size, p.y * size, p.z * size, p.w};
    for (int i = 0; i < 3; ++i) point.project(1, i == 0);
    EXPECT_LT(reach(point, {}), 10) << size;
  }
}

TEST(Volume, MovesTheCentreNowhere) {
  VolumeCase sphere(30, 1.5f, {});
  for (int i = 0; i < 6; ++i) sphere.project(1, i == 0);
  Vec3d sum{}, size{};
  for (const Record& d : sphere.workspace.displacements) {
    sum += Vec3d{d.x, d.y, d.z};
    size += Vec3d{std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)};
  }
  EXPECT_GT(size.x, 1);
  EXPECT_LT(std::fabs(sum.x) + std::fabs(sum.y) + std::fabs(sum.z), 1e-6 * (size.x + size.y + size.z));
}

// ------------------------------------------------------------------------------------------------ what went wrong

NonFinite failure(const Model& model, State& state, int iterations) {
  Workspace workspace;
  prepare(model, iterations > 1 ? Multipliers::needed : Multipliers::none, workspace);
  prepare_sweeps(model, Settings{}, 1, workspace);
  Executor executor(2);
  Report report;
  step({model, state, workspace, executor, pick_kernels(""), 4, iterations}, 1.f / 60, report);
  EXPECT_FALSE(report.ok());
  for (const auto* records : {&state.positions, &state.velocities, &state.remainders}) {
    for (const Record& r : *records) EXPECT_TRUE(std::isfinite(r.x) && std::isfinite(r.y) && std::isfinite(r.z));
  }
  return report.nonfinite.value_or(NonFinite{});
}

/// A line whose constraint 7 has rest data that a World would reject, and that make its particles non-finite at once.
Object line_with_a_fault(const std::string& type) {
  Object object;
  object.name = "line";
  ConstraintGroup edges{"distance", {}, {}, {}, {}}, bends{type, {}, {}, {}, {}};
  for (int i = 0; i < 40; ++i) {
    object.positions.push_back({static_cast<float>(i) * 0.1f, 0, static_cast<float>(i % 2) * 0.01f});
    object.masses.push_back(1);
    if (i > 0 && type != "distance") edges.particles.insert(edges.particles.end(), {i - 1, i});
  }
  if (type == "distance") {
    for (int i = 1; i < 40; ++i) bends.particles.insert(bends.particles.end(), {i - 1, i});
    bends.rest.assign(39, 0.1f);
    bends.rest[7] = std::numeric_limits<float>::quiet_NaN();
  } else {
    for (int i = 0; i + 3 < 40; i += 4) bends.particles.insert(bends.particles.end(), {i, i + 1, i + 2, i + 3});
    bends.rest.assign(30, 0.1f);
    bends.rest[3 * 7 + 1] = std::numeric_limits<float>::quiet_NaN();
  }
  object.constraints = {edges, bends};
  return object;
}

TEST(Diagnosis, NamesTheConstraintInATileAndBetweenTiles) {
  for (int largest_tile : {4, 8, 4096}) {
    for (int iterations : {1, 3}) {
      for (const std::string type : {"distance", "isometric_bending"}) {
        Model model;
        model.add(compile(sheet(4, 0), {4, largest_tile}));
        model.add(compile(line_with_a_fault(type), {4, largest_tile}));
        State state = initial_state(model);
        const NonFinite found = failure(model, state, iterations);
        EXPECT_EQ(found.object, "line");
        // The ends may come in either order, as they are stored.
        const std::string particles = type == "distance" ? "(particles (7, 8|8, 7))" : "(particles 28, 29, 30, 31)";
        const std::regex expected(type + " constraint 7 \\" + particles.substr(0, particles.size() - 1) + "\\)");
        EXPECT_TRUE(std::regex_match(found.element, expected))
            << found.element << " in tiles of " << largest_tile << ", " << iterations << " iterations";
        EXPECT_EQ(found.substep, 0);
      }
    }
  }
}

TEST(Diagnosis, NamesTheParticleThatFliesAway) {
  Model model;
  model.add(compile(sheet(6, 0), {4, 8}));
  State state = initial_state(model);
  state.velocities[static_cast<std::size_t>(model.objects[0].place[17])] = {3e38f, 3e38f, 0, 0};
  state.positions[static_cast<std::size_t>(model.objects[0].place[17])].x = 3.4e38f;
  const NonFinite found = failure(model, state, 1);
  EXPECT_EQ(found.object, "sheet");
  EXPECT_FALSE(found.element.empty());
}

TEST(Measure, CountsAndMeasuresByType) {
  const Model model = make_model(40, 6, false);
  const State state = initial_state(model);
  Workspace workspace;
  prepare(model, Multipliers::none, workspace);
  prepare_sweeps(model, Settings{}, 1, workspace);
  const std::vector<Residual> residuals = measure_residuals(model, state, workspace, [](int) { return 0.01f; });
  ASSERT_EQ(residuals.size(), 4u);
  EXPECT_EQ(residuals[0].type, "distance");
  EXPECT_EQ(residuals[1].type, "dihedral_bending");
  EXPECT_EQ(residuals[2].type, "isometric_bending");
  EXPECT_EQ(residuals[3].type, "volume");
  EXPECT_EQ(residuals[1].constraints, 18 * 18);
  EXPECT_EQ(residuals[3].constraints, 2);
  EXPECT_LT(residuals[1].largest, 1e-5) << "rest angles are those of the start";
  EXPECT_NEAR(residuals[0].largest, 0.31, 0.02) << "the attachment alone is off";
  std::vector<float> ratios;
  EXPECT_NEAR(measure_stretch(model, state, ratios).largest, 1, 1e-6);
}

}  // namespace
}  // namespace pliant
