// Tests that the contact filter changes neither linear nor angular momentum of free systems, also where cloth, soft
// bodies and rigid bodies hit one another too hard for contacts, and that nothing crosses.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "math/quat.h"
#include "math/vector.h"
#include "pliant/body.h"
#include "pliant/soft_body.h"
#include "pliant/world.h"
#include "world/surface_support.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// A square sheet that turns about x by an angle, with self-collision.
Object free_sheet(int n, float side, float density, const Vec3f& centre, float angle = 0) {
  ClothOptions options;
  options.material.area_density = density;
  TriangleMesh mesh = grid_mesh(n, n, side, side);
  Vec3f middle{};
  for (const Vec3f& p : mesh.positions) middle += p * (1.f / static_cast<float>(mesh.positions.size()));
  const float c = std::cos(angle), s = std::sin(angle);
  for (Vec3f& p : mesh.positions) {
    const Vec3f q = p - middle;
    p = centre + Vec3f{q.x, c * q.y - s * q.z, s * q.y + c * q.z};
  }
  Object object = make_cloth(mesh, options);
  object.self_collision = object.collides = true;
  return object;
}

Object moving(Object object, const Vec3f& velocity) {
  object.velocities.assign(object.positions.size(), velocity);
  return object;
}

/// A cube of gelatine.
Object gelatine(const Vec3f& corner) {
  SoftBodyOptions options;
  options.material = elastic_solid("gelatine");
  TetrahedralMesh mesh = box_tetrahedra({0.3f, 0.3f, 0.3f}, {4, 4, 4});
  for (Vec3f& p : mesh.positions) p += corner;
  Object object = make_soft_body(mesh, options);
  object.collides = object.self_collision = true;
  return object;
}

struct Momenta {
  Vec3d linear{}, angular{};
};

Vec3d vector_of(const Record& r) { return {double(r.x), double(r.y), double(r.z)}; }

/// The momentum of particles from number `first` on, about the origin.
Momenta momentum_of(const World& world, std::size_t first, std::size_t last) {
  Momenta sum;
  const State& state = world.state();
  for (std::size_t i = first; i < last; ++i) {
    const Record& x = state.positions[i];
    if (!(x.w > 0)) continue;
    const Vec3d p = vector_of(state.velocities[i]) * (1 / double(x.w));
    sum.linear += p;
    sum.angular += cross(vector_of(x), p);
  }
  return sum;
}

/// The angular momentum of the rotation of all rigid bodies.
Vec3d spin_of(const World& world) {
  Vec3d sum{};
  const FrameRecords& frames = world.state().frames;
  for (std::size_t i = 0; i < frames.orientations.size(); ++i) {
    const Record &q = frames.orientations[i], &w = frames.angular_velocities[i], &inverse = frames.inverse_inertias[i];
    if (!(inverse.x > 0)) continue;
    const Vec3d local{double(w.x) / double(inverse.x), double(w.y) / double(inverse.y), double(w.z) / double(inverse.z)};
    sum += rotate(Quatd{double(q.x), double(q.y), double(q.z), double(q.w)}, local);
  }
  return sum;
}

struct Outcome {
  double energy_before = 0,
         energy_after = 0;  ///< kinetic energy of particles, in relation to their mean velocity at the start [J]
  double exchanged = 0;     ///< change of the second object's momentum [kg m/s]
  double linear = 0;        ///< change of the sum, over `exchanged`
  double angular = 0;       ///< the same of angular momentum about the origin, over `exchanged` times 1 m
  std::int64_t filtered = 0;
  std::size_t crossings = 0;
  std::vector<std::string> warnings;
};

double energy_of(const World& world, std::size_t particles, const Vec3f& common) {
  double sum = 0;
  for (std::size_t i = 0; i < particles; ++i) {
    const Vec3d v = vector_of(world.state().velocities[i]) - convert<double>(common);
    sum += 0.5 * dot(v, v) / double(world.state().positions[i].w);
  }
  return sum;
}

/// Runs two objects in free space, both with a velocity in common. `others`: what else is there, far away.
Outcome outcome_of(Object first, Object second, int frames, const Vec3f& common = {}, const Scene& others = {}) {
  Scene scene;
  scene.colliders = others.colliders;
  scene.gravity = {};
  for (Object* object : {&first, &second}) {
    if (object->velocities.empty()) object->velocities.assign(object->positions.size(), {});
    for (Vec3f& v : object->velocities) v += common;
    scene.add(*object);
  }
  for (const Object& object : others.objects) scene.add(object);
  World world(scene);
  Watch watch(world, scene);
  const std::size_t half = first.positions.size(), all = half + second.positions.size();
  const Momenta before = momentum_of(world, 0, all), of_second = momentum_of(world, half, all);
  Outcome out;
  out.energy_before = energy_of(world, all, common);
  for (int frame = 0; frame < frames; ++frame) {
    const Report report = world.step(dt);
    EXPECT_TRUE(report.ok());
    out.filtered += report.pairs.truncated;
    out.crossings += watch.crossings(world);
    out.warnings.insert(out.warnings.end(), report.warnings.begin(), report.warnings.end());
  }
  Momenta after = momentum_of(world, 0, all);
  after.angular += spin_of(world);  // none turns at the start
  out.exchanged = length(momentum_of(world, half, all).linear - of_second.linear);
  out.linear = length(after.linear - before.linear) / out.exchanged;
  out.angular = length(after.angular - before.angular) / out.exchanged;
  out.energy_after = energy_of(world, all, common);
  return out;
}

/// `rounded`: how much rounding of velocities may change the sum, over what is exchanged. `lag`: the same of angular
/// momentum, by positions that lag behind.
void expect_kept(const Outcome& outcome, double rounded = 1e-4, double lag = 1e-2) {
  EXPECT_GT(outcome.filtered, 0) << "the filter had nothing to do";
  EXPECT_GT(outcome.exchanged, 0.01) << "they have not met";
  EXPECT_LT(outcome.linear, rounded);
  EXPECT_LT(outcome.angular, lag);
  EXPECT_LT(outcome.energy_after, outcome.energy_before * (1 + 1e-5)) << "a collision adds no energy";
  EXPECT_EQ(outcome.crossings, 0u);
  for (const std::string& warning : outcome.warnings)
    EXPECT_EQ(warning.find("passes through"), std::string::npos) << warning;
}

/// Two sheets, of which the upper one is tilted and falls on the other.
Outcome sheets(float speed, const Vec3f& common = {}, float density = 0.2f) {
  return outcome_of(free_sheet(16, 0.8f, 0.2f, {0, 0, 0}),
                    moving(free_sheet(16, 0.8f, density, {0.05f, 0.35f, 0}, 1.f), {0, -speed, 0}), 30, common);
}

TEST(FilterMomentum, BallIntoFreeSelfCollidingCloth) {
  BodyOptions options;
  options.position = {0.1f, 0.2f, 0};
  options.mass = 0.5f;
  const Object ball = make_body({{Sphere{0.1f}}}, options);
  for (const Vec3f& common : {Vec3f{}, Vec3f{20, 0, 0}}) {
    const Outcome outcome = outcome_of(free_sheet(21, 1, 0.2f, {0, 0, 0}), moving(ball, {0, -5, 0}), 30, common);
    expect_kept(outcome, length_squared(common) > 0 ? 5e-4 : 1e-4);
    EXPECT_GT(outcome.exchanged, 0.5) << "the cloth slows the ball";
  }
}

TEST(FilterMomentum, SheetsOnSheets) {
  for (const float speed : {2.f, 5.f, 10.f}) expect_kept(sheets(speed));
}

/// Contact depends on relative motion alone. Cloth that crumples amplifies rounding: a velocity of 1e-6 m/s in common
/// changes what is exchanged by 1 %, and those of 20 to 50 m/s by 10 % at most.
TEST(FilterMomentum, IsTheSameWithAVelocityInCommon) {
  const Outcome still = sheets(5), common = sheets(5, {20, 0, 0});
  expect_kept(common);
  EXPECT_NEAR(common.exchanged, still.exchanged, 0.15 * still.exchanged);
}

TEST(FilterMomentum, WherePinnedClothAndCollidersAreFarAway) {
  Scene others;
  Object pinned = free_sheet(8, 0.8f, 0.2f, {3, 0, 0});
  pinned.pins.push_back({0});
  others.add(pinned);
  Collider ground;
  ground.position = {0, -4, 0};
  others.colliders.push_back(ground);
  expect_kept(outcome_of(free_sheet(16, 0.8f, 0.2f, {0, 0, 0}),
                         moving(free_sheet(16, 0.8f, 0.2f, {0.05f, 0.35f, 0}, 1.f), {0, -5, 0}), 20, {}, others));
}

/// 1 : 100 in mass. The centre of mass of the heavy sheet lags by 0.3 mm, which is much of the little that the light
/// one takes.
TEST(FilterMomentum, HeavySheetOnLightSheet) { expect_kept(sheets(5, {}, 20), 1e-4, 0.05); }

TEST(FilterMomentum, HasTheSameBitsOnAnyThreadsAndAfterARestore) {
  Scene scene;
  scene.gravity = {};
  scene.add(free_sheet(16, 0.8f, 0.2f, {0, 0, 0}));
  scene.add(moving(free_sheet(16, 0.8f, 0.2f, {0.05f, 0.25f, 0}, 1.f), {20, -10, 0}));
  scene.settings.threads = 1;
  World one(scene);
  scene.settings.threads = 3;
  World three(scene);
  std::int64_t filtered = 0;
  for (int frame = 0; frame < 6; ++frame) {
    World again(scene);
    again.restore(three.state());
    for (World* world : {&one, &three, &again}) filtered += world->step(dt).pairs.truncated;
    ASSERT_EQ(one.state_hash(), three.state_hash()) << "frame " << frame;
    ASSERT_EQ(again.state_hash(), three.state_hash()) << "frame " << frame;
  }
  EXPECT_GT(filtered, 100);
}

TEST(FilterMomentum, SoftBodiesAtTenMetresPerSecond) {
  const Object first = gelatine({0, 0, 0}), second = moving(gelatine({-0.4f, -0.02f, -0.03f}), {10, 0, 0});
  expect_kept(outcome_of(first, second, 20));
  expect_kept(outcome_of(first, second, 20, {0, 20, 0}));
}

}  // namespace
}  // namespace pliant
