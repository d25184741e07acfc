// Fibres in soft bodies against known answers, and rest data that keyframes and calls multiply.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "pliant/error.h"
#include "soft_bodies/soft_body_support.h"

namespace pliant {
namespace {

using namespace testing_support;

constexpr double muscle_side = 0.1, length_at_rest = 0.6, muscle_modulus = 1e5;
constexpr float mass_density = 100;

/// A bar that hangs from its top, with fibres along it, and a load at its lower end.
struct Muscle {
  Scene scene;
  std::vector<int> lower;

  double length_now(const World& world) const {
    const std::vector<Vec3f> positions = positions_of(world);
    double sum = 0;
    for (const int i : lower) sum -= static_cast<double>(positions[static_cast<std::size_t>(i)].y);
    return sum / static_cast<double>(lower.size());
  }
};

Muscle muscle_of(const Fibres& fibres, double load, int substeps = 160) {
  SoftBodyOptions options;
  options.material = solid_of(static_cast<float>(muscle_modulus), 0.3f, mass_density);
  options.fibres = fibres;
  TetrahedralMesh mesh = box_tetrahedra(
      {static_cast<float>(muscle_side), static_cast<float>(length_at_rest), static_cast<float>(muscle_side)},
      {2, 12, 2});
  for (Vec3f& p : mesh.positions) p.y -= static_cast<float>(length_at_rest / 2);
  Object object = make_soft_body(mesh, options);
  object.collides = false;
  object.damping = 3;
  Muscle muscle;
  std::vector<int> upper;
  for (int i = 0; i < static_cast<int>(object.positions.size()); ++i) {
    const float y = object.positions[static_cast<std::size_t>(i)].y;
    if (y > -1e-4f) upper.push_back(i);
    if (y < -static_cast<float>(length_at_rest) + 1e-4f) muscle.lower.push_back(i);
  }
  for (const int i : muscle.lower)
    object.masses[static_cast<std::size_t>(i)] +=
        static_cast<float>(load / 10 / static_cast<double>(muscle.lower.size()));
  muscle.scene = scene_of(std::move(object), substeps);
  muscle.scene.gravity = {0, -10, 0};
  muscle.scene.pin(0, upper);
  return muscle;
}

/// The stretch of a bar in which the fibres pull against the solid, and a load and half its own weight bear on both, to
/// first order.
double stretch_of(double fibre_modulus, double rest, double load) {
  const double stress =
      load / (muscle_side * muscle_side) + 10 * static_cast<double>(mass_density) * length_at_rest / 2;
  return 1 + (stress - fibre_modulus * (1 - rest)) / (muscle_modulus + fibre_modulus);
}

TEST(Fibres, StiffenABarAlongThem) {
  const double load = 20;  // newtons
  for (const double fibre_modulus : {2e4, 2e5}) {
    const Muscle muscle = muscle_of({.direction = {0, 1, 0}, .modulus = static_cast<float>(fibre_modulus)}, load);
    World world(muscle.scene);
    run(world, 240);
    const double strain = muscle.length_now(world) / length_at_rest - 1;
    EXPECT_NEAR(strain / (stretch_of(fibre_modulus, 1, load) - 1), 1, 0.06) << fibre_modulus;
  }
}

TEST(Fibres, AcrossABarHardlyMatter) {
  const double load = 20;
  const Muscle muscle = muscle_of({.direction = {1, 0, 0}, .modulus = 2e4f}, load);
  World world(muscle.scene);
  run(world, 240);
  const double strain = muscle.length_now(world) / length_at_rest - 1;
  EXPECT_NEAR(strain / (stretch_of(0, 1, load) - 1), 1, 0.06);
}

TEST(Fibres, AMuscleLiftsItsLoadAsFarAsItsForceSays) {
  const double load = 20, fibre_modulus = 1e5;
  Muscle muscle = muscle_of(
      {.direction = {0, 3, 0}, .modulus = static_cast<float>(fibre_modulus), .stretch = {{0.5f, 1}, {1, 0.9f}}}, load);
  World world(muscle.scene);
  run(world, 30);
  const double before = muscle.length_now(world);
  run(world, 270);
  const double after = muscle.length_now(world);
  EXPECT_GT(before, length_at_rest);  // the load has stretched it
  EXPECT_NEAR(after / length_at_rest, stretch_of(fibre_modulus, 0.9, load), 0.004);
}

/// Sets the stretch of all fibres of an object as docs/guide/soft_bodies.md does. Returns how many groups there are.
int set_stretch(const Object& body, float factor, World& world) {
  int groups = 0;
  for (std::size_t g = 0; g < body.constraints.size(); ++g) {
    if (body.constraints[g].type != "fibre") continue;
    world.object(0).set_rest_factor(static_cast<int>(g), factor);
    ++groups;
  }
  return groups;
}

TEST(Fibres, ACallActivatesThemAsKeyframesDo) {
  const Muscle by_keyframes = muscle_of({.direction = {0, 1, 0}, .stretch = {{0, 0.9f}}}, 10);
  const Muscle by_call = muscle_of({.direction = {0, 1, 0}}, 10);
  World keyed(by_keyframes.scene), called(by_call.scene);
  EXPECT_EQ(set_stretch(by_call.scene.objects[0], 0.9f, called), 1);
  run(keyed, 20);
  run(called, 20);
  EXPECT_EQ(positions_of(keyed), positions_of(called));
  const State state = called.state();
  run(called, 10);
  World other(by_call.scene);
  other.restore(state);
  run(other, 10);
  EXPECT_EQ(hash(other.state()), hash(called.state()));
}

TEST(Fibres, KeepMomentum) {
  Fibres fibres{.direction = {1, 2, 3}};
  fibres.stretch = {{0, 1}, {0.2f, 0.6f}, {0.5f, 1.1f}};
  SoftBodyOptions options;
  options.material = solid_of(1e4f, 0.4f);
  options.fibres = fibres;
  Object object = make_soft_body(box_tetrahedra({0.3f, 0.2f, 0.2f}, {3, 2, 2}), options);
  const std::vector<float> masses = object.masses;
  Scene scene = scene_of(std::move(object), 20);
  scene.gravity = {};
  World world(scene);
  run(world, 60);
  const Momentum after = momentum_of(world, masses);
  EXPECT_LT(length(after.linear), 1e-4);
}

// Sequential projections of stresses that stay would turn a free body by themselves.
TEST(Fibres, AContractedMuscleDoesNotTurnByItself) {
  SoftBodyOptions options;
  options.material = elastic_solid("muscle");
  options.fibres = Fibres{.direction = {0, 1, 0}, .directions = {}, .stretch = {{0.2f, 1}, {0.5f, 0.7f}}};
  Object object = make_soft_body(box_tetrahedra({0.05f, 0.3f, 0.05f}, {2, 12, 2}), options);
  const std::vector<float> masses = object.masses;
  Scene scene = scene_of(std::move(object), 0);
  scene.gravity = {};
  World world(scene);
  run(world, 200);
  const Momentum after = momentum_of(world, masses);
  const double moment_of_inertia = 0.75 * 1060 * 0.05 * 0.05 * 0.3 * 0.3 * 0.3 / 12;
  EXPECT_LT(length(after.angular) / moment_of_inertia, 0.01);  // rad/s
}

/// A column whose layers have these heights, with damped fibres that contract by 10 %, held at its top.
Object damped_column(const std::vector<float>& heights, std::vector<RestKeyframe> stretch) {
  const int layers = static_cast<int>(heights.size());
  SoftBodyOptions options;
  options.material = solid_of(2e4f, 0, 300);
  options.material.damping = 0.05f;
  options.fibres = Fibres{.direction = {0, 1, 0}, .directions = {}, .modulus = 1e5f, .stretch = std::move(stretch)};
  TetrahedralMesh mesh = box_tetrahedra({0.1f, 1, 0.1f}, {1, layers, 1});
  for (Vec3f& p : mesh.positions) {
    const int layer = static_cast<int>(std::lround((p.y + 0.5f) * static_cast<float>(layers)));
    p.y = 0;
    for (int below = 0; below < layer; ++below) p.y += heights[static_cast<std::size_t>(below)];
  }
  Object column = make_soft_body(mesh, options);
  float top = 0;
  for (const Vec3f& p : column.positions) top = std::max(top, p.y);
  for (std::size_t i = 0; i < column.positions.size(); ++i)
    if (column.positions[i].y == top) column.pins.push_back({.particle = static_cast<int>(i), .motion = {}});
  column.collides = false;
  return column;
}

/// The mean length over that at rest of what lies between two heights at rest.
double stretch_between(const World& world, const Object& column, float low, float high) {
  const std::vector<Vec3f> now = positions_of(world);
  double sum[2] = {}, count[2] = {};
  for (std::size_t i = 0; i < now.size(); ++i)
    for (const int end : {0, 1}) {
      if (std::fabs(column.positions[i].y - (end == 0 ? low : high)) > 1e-5f) continue;
      sum[end] += static_cast<double>(now[i].y);
      ++count[end];
    }
  return (sum[1] / count[1] - sum[0] / count[0]) / static_cast<double>(high - low);
}

// One damping for all tetrahedra held a thin layer: 0.987 in it, and 0.938 beside it, where all should be 0.947.
TEST(Fibres, DampingDoesNotDependOnTheMesh) {
  const Object column = damped_column({0.2f, 0.02f, 0.2f}, {{0, 0.9f}});
  Scene scene = scene_of(column, 4000);
  scene.gravity = {};
  World world(scene);
  run(world, 3);
  EXPECT_NEAR(stretch_between(world, column, 0, 0.2f), 0.947, 0.002);
  EXPECT_NEAR(stretch_between(world, column, 0.2f, 0.22f), 0.947, 0.002);
  EXPECT_NEAR(stretch_between(world, column, 0.22f, 0.42f), 0.947, 0.002);
}

TEST(Fibres, ACallForEachSizeActivatesDampedOnes) {
  const Object column = damped_column({0.2f, 0.02f, 0.2f}, {});
  Scene by_keyframes = scene_of(damped_column({0.2f, 0.02f, 0.2f}, {{0, 0.9f}}), 100), by_call = scene_of(column, 100);
  World keyed(by_keyframes), called(by_call);
  EXPECT_EQ(set_stretch(column, 0.9f, called), 2);
  run(keyed, 10);
  run(called, 10);
  EXPECT_EQ(positions_of(keyed), positions_of(called));
}

/// A strain limit comes after the fibres, so that they are not the last group.
TEST(Fibres, AreFoundByTheirTypeBesideAStrainLimit) {
  SoftBodyOptions options;
  options.material = solid_of(1e4f, 0.4f);
  options.fibres = Fibres{};
  options.strain_limit = StrainLimit{0.5f, 1.5f};
  const Object body = make_soft_body(box_tetrahedra({0.2f, 0.1f, 0.1f}, {2, 1, 1}), options);
  EXPECT_NE(body.constraints.back().type, "fibre");
  World world(scene_of(body, 20));
  EXPECT_EQ(set_stretch(body, 0.9f, world), 1);
  const int last = static_cast<int>(body.constraints.size()) - 1;
  EXPECT_THROW(world.object(0).set_rest_factor(last, 0.9f), Error) << "as the guide once did";
}

TEST(Fibres, WrongOnesAreRefused) {
  const TetrahedralMesh mesh = box_tetrahedra({1, 1, 1}, {1, 1, 1});
  const auto make = [&](const Fibres& fibres) {
    SoftBodyOptions options;
    options.fibres = fibres;
    return make_soft_body(mesh, options);
  };
  EXPECT_THROW((void)make({.direction = {0, 0, 0}}), Error);
  EXPECT_THROW((void)make({.modulus = 0}), Error);
  EXPECT_THROW((void)make({.directions = {{1, 0, 0}}}), Error);
  EXPECT_THROW((void)make({.stretch = {{1, 1}, {1, 0.5f}}}), Error);
  std::vector<Vec3f> some(6);
  some[2] = {0, 1, 0};
  EXPECT_EQ(make({.directions = some}).constraints.back().particles.size(), 4u);
}

// ------------------------------------------------------------------------------------------------ other rest data

TEST(RestFactors, ARopeGrowsToItsKeyframe) {
  Object rope = make_rope({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  rope.collides = false;
  rope.constraints[0].keyframes = {{0, 1}, {1, 1.5f}};
  Scene scene = scene_of(std::move(rope), 10);
  scene.gravity = {};
  scene.pin(0, {0});
  World world(scene);
  run(world, 30);
  EXPECT_NEAR(static_cast<double>(positions_of(world)[2].x), 2.5, 1e-3);
  run(world, 60);
  EXPECT_NEAR(static_cast<double>(positions_of(world)[2].x), 3, 0.02);
}

TEST(RestFactors, ALongRopeIsNotHeldByItsOldLength) {
  std::vector<Vec3f> points;
  for (int i = 0; i <= 60; ++i) points.push_back({0, -0.02f * static_cast<float>(i), 0});
  Object rope = make_rope(points);
  rope.constraints[0].keyframes = {{0, 1}, {1, 1.5f}};
  Scene scene;
  scene.settings.threads = 1;
  scene.add(std::move(rope));
  scene.pin(0, {0});
  World world(scene);
  run(world, 150);
  EXPECT_NEAR(static_cast<double>(positions_of(world)[60].y), -1.8, 0.01);
}

TEST(RestFactors, WrongCallsAreRefused) {
  Scene scene = scene_of(make_rope({{0, 0, 0}, {1, 0, 0}}), 1);
  World world(scene);
  EXPECT_THROW(world.object(0).set_rest_factor(0, 1), Error);  // it has no keyframes
  scene.objects[0].constraints[0].keyframes = {{0, 1}};
  World other(scene);
  EXPECT_THROW(other.object(0).set_rest_factor(1, 1), Error);
  EXPECT_THROW(other.object(0).set_rest_factor(0, -1), Error);
  EXPECT_NO_THROW(other.object(0).set_rest_factor(0, 2));
  State state = other.state();
  state.rest_factors[0].group = 4;
  EXPECT_THROW(other.restore(state), Error);
}

}  // namespace
}  // namespace pliant
