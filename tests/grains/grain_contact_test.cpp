// Grains and all else, in both directions: rigid bodies, cloth, ropes and liquids.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "grains/grain_support.h"
#include "pliant/body.h"
#include "pliant/grains.h"
#include "pliant/liquid.h"
#include "pliant/mesh.h"
#include "pliant/world.h"
#include "support/run.h"
#include "support/same_bits.h"

namespace pliant {
namespace {

using testing_support::grain_diameter;
using testing_support::grain_radius;
using testing_support::gravity;
using testing_support::run;

Solid box(const Vec3f& half_extents, const Vec3f& at, float density = 1000) {
  Solid solid;
  solid.shape = Box{half_extents};
  solid.position = at;
  solid.density = density;
  return solid;
}

/// An open box with the given half width inside, whose floor is at 0.
std::vector<Solid> tray(float half_width, float height) {
  constexpr float wall = 0.01f;
  const float outer = half_width + wall, middle = half_width + wall / 2;
  std::vector<Solid> solids{box({outer, wall / 2, outer}, {0, -wall / 2, 0})};
  for (const float side : {-1.f, 1.f}) {
    solids.push_back(box({wall / 2, height / 2, outer}, {side * middle, height / 2, 0}));
    solids.push_back(box({half_width, height / 2, wall / 2}, {0, height / 2, side * middle}));
  }
  return solids;
}

Object sand(const Vec3f& low, const Vec3f& high, const Vec3f& velocity = {}) {
  return make_grains(fill_box(low, high, 1.05f * grain_diameter),
                     {.grains = {.radius = grain_radius}, .velocity = velocity});
}

double mass_of(const Object& object) {
  double sum = 0;
  for (const float mass : object.masses) sum += static_cast<double>(mass);
  return sum;
}

/// The force of the ground on bodies in the last substep [N].
double force_on_ground(const World& world) {
  double force = 0;
  for (const BodyContact& contact : world.state().body_contacts)
    for (int i = 0; contact.a.owner == -1 && i < contact.count; ++i)
      force += static_cast<double>(contact.impulse[static_cast<std::size_t>(i)]) / static_cast<double>(contact.substep);
  return force;
}

// The ground bears the tray and what lies in it. A step is a substep, so the mean has all of them: forces vary a little
// from one to the next.
TEST(GrainContact, PressesOnABodyByItsWeight) {
  constexpr float h = 1.f / 1500;
  Scene scene;
  scene.add(make_body(tray(0.1f, 0.3f), {.position = {0, 0.0105f, 0}, .mass = 1}));
  scene.add(sand({-0.1f, 0.012f, -0.1f}, {0.1f, 0.1f, 0.1f}));
  scene.add(Collider{});
  scene.settings.substeps = 1;
  World world(scene);
  double force = 0;
  for (int i = 0; i < 4500; ++i) {
    ASSERT_TRUE(world.step(h).ok());
    if (i >= 3000) force += force_on_ground(world) / 1500;
  }
  EXPECT_NEAR(force, (1 + mass_of(scene.objects[1])) * static_cast<double>(gravity), 0.005 * force);
}

/// How far the underside of a cube of 8 cm lies below the surface of a bed of sand 10 cm deep, a second after it was
/// put there [m].
double sinking(float density) {
  constexpr float half = 0.04f;
  Scene scene;
  scene.add(make_body(tray(0.15f, 0.2f), {.name = "tray", .mass = INFINITY}));
  scene.add(sand({-0.15f, 0, -0.15f}, {0.15f, 0.1f, 0.15f}));
  World world(scene);
  run(world, 60);
  const auto at_rest = world.object(1).positions();
  float top = 0;
  for (const Vec3f& p : at_rest) top = std::max(top, p.y + grain_radius);
  const ObjectId cube =
      world.add(make_body({box({half, half, half}, {}, density)}, {.name = "cube", .position = {0, top + half, 0}}));
  run(world, 90);
  return static_cast<double>(top + half - world.object(cube).positions()[0].y);
}

// Grains at rest bear a body by friction, so it lies on them, light or heavy: it does not sink until it displaces its
// weight.
TEST(GrainContact, BearsLightAndHeavyBodies) {
  EXPECT_LT(sinking(200), 0.5 * static_cast<double>(grain_diameter));
  EXPECT_LT(sinking(7800), 1.5 * static_cast<double>(grain_diameter));  // of iron, three times as dense as a grain
}

/// Cloth that is held by two sides.
Object hammock() {
  TriangleMesh mesh = grid_mesh(21, 21, 0.4f, 0.4f);
  for (Vec3f& p : mesh.positions) p.y += 0.4f;
  Object cloth = make_cloth(mesh, {.name = "hammock"});
  for (int i = 0; i < static_cast<int>(cloth.positions.size()); ++i)
    if (std::fabs(cloth.positions[static_cast<std::size_t>(i)].x) > 0.199f) cloth.pins.push_back({i, {}});
  cloth.thickness = 0.002f;
  cloth.collides = true;
  return cloth;
}

TEST(GrainContact, HoldsThemInAHammock) {
  Scene scene;
  scene.add(hammock());
  scene.add(sand({-0.06f, 0.42f, -0.06f}, {0.06f, 0.5f, 0.06f}));
  World world(scene);
  run(world, 120);
  const auto grains = world.object(1).positions();
  const auto below = std::count_if(grains.begin(), grains.end(), [](const Vec3f& p) { return p.y < 0.3f; });
  EXPECT_EQ(below, 0) << "of " << grains.size();
  double sag = 0.4;
  for (const Vec3f& p : world.object(0).positions()) sag = std::min(sag, static_cast<double>(p.y));
  EXPECT_LT(sag, 0.395) << "the cloth does not feel them";
}

struct Momentum {
  Vec3d sum{};
  double magnitude = 0;  ///< sum of magnitudes
};

Momentum momentum_of(const Scene& scene, const World& world) {
  Momentum of;
  for (int o = 0; o < static_cast<int>(scene.objects.size()); ++o) {
    const auto velocities = world.object(ObjectId{o}).velocities();
    for (std::size_t i = 0; i < velocities.size(); ++i) {
      const double mass = static_cast<double>(scene.objects[static_cast<std::size_t>(o)].masses[i]);
      const Vec3d p = Vec3d{velocities[i].x, velocities[i].y, velocities[i].z} * mass;
      of.sum = of.sum + p;
      of.magnitude += std::sqrt(length_squared(p));
    }
  }
  return of;
}

/// A cloud of grains that flies into one of each kind, without gravity.
Scene encounter() {
  Scene scene;
  scene.gravity = {};
  scene.add(sand({-0.1f, 0, -0.1f}, {0.1f, 0.06f, 0.1f}, {0, 1, 0}));
  scene.add(make_body({box({0.03f, 0.03f, 0.03f}, {}, 500)}, {.position = {-0.05f, 0.12f, -0.05f}}));
  TriangleMesh mesh = grid_mesh(9, 9, 0.08f, 0.08f);
  for (Vec3f& p : mesh.positions) p = p + Vec3f{0.05f, 0.1f, -0.05f};
  scene.add(make_cloth(mesh, {.name = "cloth"}));
  scene.objects[2].thickness = 0.002f;
  scene.objects[2].collides = true;
  scene.add(make_rope({{-0.1f, 0.1f, 0.05f}, {-0.08f, 0.1f, 0.05f}, {-0.06f, 0.1f, 0.05f}, {-0.04f, 0.1f, 0.05f}}));
  scene.objects[3].collides = true;
  scene.add(make_liquid(fill_box({0.02f, 0.09f, 0.02f}, {0.1f, 0.13f, 0.1f}, 0.02f), {.fluid = {.spacing = 0.02f}}));
  return scene;
}

TEST(GrainContact, KeepsTheMomentumOfAFreeSystem) {
  for (const int other : {1, 2, 3, 4}) {
    Scene scene = encounter();
    scene.objects = {scene.objects[0], scene.objects[static_cast<std::size_t>(other)]};
    World world(scene);
    const Momentum before = momentum_of(scene, world);
    run(world, 30);
    const Momentum after = momentum_of(scene, world);
    const std::string& name = scene.objects[1].name;
    EXPECT_LT(std::sqrt(length_squared(after.sum - before.sum)), 1e-6 * before.magnitude) << name;
    float fastest = 0;
    for (const Vec3f& v : world.object(ObjectId{1}).velocities()) fastest = std::max(fastest, v.y);
    EXPECT_GT(fastest, 0.1f) << name << " was not met";
  }
}

TEST(GrainContact, OfAnotherGroupOrThatDoesNotCollideIsNone) {
  const auto speed = [](bool collides, std::uint32_t mask) {
    Scene scene = encounter();
    scene.objects[0].collides = collides;
    scene.objects[0].mask = mask;
    World world(scene);
    run(world, 10);
    return length_squared(world.object(1).velocities()[0]);
  };
  EXPECT_GT(speed(true, ~0u), 0.f);
  EXPECT_EQ(speed(false, ~0u), 0.f);
  EXPECT_EQ(speed(true, 2), 0.f);
}

TEST(GrainContact, HasTheSameBitsOnAnyThreadsAndLevels) {
  const Scene scene = encounter();
  testing_support::expect_same_bits_on_any_threads_and_levels(scene, {15});
}

/// The substeps of sand that lies in layers, each an object.
int substeps_of_layers(int layers, float apart) {
  Scene scene;
  for (int i = 0; i < layers; ++i) {
    const float low = static_cast<float>(i) * apart;
    scene.add(sand({0, low, 0}, {0.1f, low + 0.4f, 0.1f}));
  }
  return chosen_substeps(scene)[0];
}

// They are as the root of the height of all that meet, which is no more than that of a heap of all.
TEST(GrainContact, HasTheSubstepsOfAllGrainsThatMeet) {
  const double one = substeps_of_layers(1, 0);
  EXPECT_NEAR(substeps_of_layers(4, 0.4f), 2 * one, 0.03 * one);
  EXPECT_NEAR(substeps_of_layers(4, 3), 2 * one, 0.06 * one);
  EXPECT_NEAR(substeps_of_layers(4, 0), one, 1);
}

int warnings_of(int substeps, int iterations) {
  Scene scene;
  scene.add(sand({0, 0, 0}, {0.1f, 0.4f, 0.1f}));
  scene.settings.substeps = substeps;
  scene.settings.iterations = iterations;
  const std::vector<Finding> findings = inspect(scene);
  return static_cast<int>(std::count_if(findings.begin(), findings.end(), [](const Finding& finding) {
    return finding.message.find("too few for the grains of 'grains'") != std::string::npos;
  }));
}

TEST(GrainContact, WarnsOfTooFewSubsteps) {
  EXPECT_EQ(warnings_of(0, 1), 0);
  EXPECT_EQ(warnings_of(45, 1), 0);
  EXPECT_EQ(warnings_of(20, 1), 1);
  EXPECT_EQ(warnings_of(20, 4), 0);
  EXPECT_EQ(warnings_of(5, 1), 1);
}

}  // namespace
}  // namespace pliant
