// Grains: contacts, momentum, Coulomb friction, and the angle of a heap.
#include "pliant/grains.h"
#include "grains/grain_support.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "pliant/liquid.h"
#include "pliant/world.h"
#include "solver/grains/grain_formulas.h"
#include "solver/grains/grain_solver.h"
#include "support/refusal.h"
#include "support/same_bits.h"

namespace pliant {
namespace {

using testing_support::grain_diameter;
using testing_support::grain_radius;

/// Steps a World, and returns the last report.
Report advance(World& world, int frames) {
  Report report;
  for (int i = 0; i < frames; ++i) report = world.step(1.f / 60);
  return report;
}

Collider wall(const Vec3f& at, const Quatf& rotation, float friction) {
  Collider plane;
  plane.position = at;
  plane.rotation = rotation;
  plane.static_friction = plane.kinetic_friction = friction;
  return plane;
}

/// A block of grains between planes without friction, free along x on one side, on ground that no grain slides on. Rows
/// are shifted, so that no column stands.
Scene block(const Vec3f& size, float friction) {
  std::vector<Vec3f> places = fill_box({0, 0, 0}, size, 1.07f * grain_diameter);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto part = [&](std::size_t prime) {
      return 0.05f * grain_diameter * static_cast<float>(i * prime % 101) / 101;
    };
    places[i] = places[i] + Vec3f{part(37), part(59), part(83)};
  }
  Scene scene;
  scene.add(make_grains(places, {.grains = {.radius = grain_radius, .friction = friction}}));
  const float r = std::sqrt(0.5f);
  scene.add(wall({0, 0, 0}, {0, 0, 0, 1}, 1000));
  scene.add(wall({0, 0, 0}, {0, 0, -r, r}, 0));
  scene.add(wall({0, 0, 0}, {r, 0, 0, r}, 0));
  scene.add(wall({0, 0, size.z}, {-r, 0, 0, r}, 0));
  scene.settings.threads = 1;
  return scene;
}

/// Places that fill a box loosely, in no order: a lattice of 1.3 diameters, each place moved by up to 0.14 along each
/// axis.
std::vector<Vec3f> shaken(const Vec3f& size) {
  std::vector<Vec3f> places = fill_box({0, 0, 0}, size, 1.3f * grain_diameter);
  std::uint32_t seed = 1;
  const auto next = [&] {
    seed = seed * 1664525u + 1013904223u;
    return (static_cast<float>(seed >> 8) / static_cast<float>(1 << 24) - 0.5f) * 0.28f * grain_diameter;
  };
  for (Vec3f& p : places) p = {p.x + next(), p.y + next(), p.z + next()};
  return places;
}

TEST(Grains, KeepTheirMomentumWhenTheyCollide) {
  Scene scene;
  scene.gravity = {};
  scene.add(make_grains({{0, 0, 0}}, {.grains = {.radius = grain_radius}, .velocity = {1, 0, 0}}));
  scene.add(make_grains({{0.1f, 0.005f, 0}},
                        {.name = "other", .grains = {.radius = 2 * grain_radius}, .velocity = {0, 0, 0}}));
  World world(scene);
  advance(world, 30);
  const Vec3f a = world.object(0).velocities()[0], b = world.object(1).velocities()[0];
  EXPECT_NEAR(a.x + 8 * b.x, 1, 1e-5);  // masses are as the cubes of the radii
  EXPECT_NEAR(a.y + 8 * b.y, 0, 1e-5);
  EXPECT_GT(b.x, 0.05f) << "they have not met";
  EXPECT_LE(a.x, b.x);
  EXPECT_LE(length_squared(a) + 8 * length_squared(b), 1);
}

/// Where a light grain on a fixed sphere of 1 m is after a second, `degrees` from its top at the start; how far it has
/// moved [m].
double slip_on_sphere(float friction, double degrees) {
  Scene scene;
  Object sphere = make_grains({{0, 0, 0}}, {.name = "sphere", .grains = {.radius = 1, .friction = friction}});
  sphere.pins = {{0, {}}};
  scene.add(sphere);
  const double angle = degrees * 3.14159265 / 180, distance = 1.01 - 1e-5;
  const Vec3f start{static_cast<float>(distance * std::sin(angle)), static_cast<float>(distance * std::cos(angle)), 0};
  scene.add(make_grains({start}, {.grains = {.radius = grain_radius, .friction = friction}}));
  scene.settings.substeps = 20;
  World world(scene);
  advance(world, 60);
  return std::sqrt(static_cast<double>(length_squared(world.object(1).positions()[0] - start)));
}

TEST(Grains, StickBelowTheAngleOfFrictionAndSlideAboveIt) {
  for (const float friction : {0.3f, 0.6f, 1.0f}) {
    const double angle = std::atan(static_cast<double>(contact_friction(friction))) * 180 / 3.14159265;
    EXPECT_LT(slip_on_sphere(friction, angle - 2), 1e-3) << friction;
    EXPECT_GT(slip_on_sphere(friction, angle + 2), 5e-3) << friction;
  }
}

/// All pairs of grains whose distance is below a share of their diameter.
std::vector<GrainContact> pairs_within(const State& state, float share) {
  std::vector<GrainContact> pairs;
  const int count = static_cast<int>(state.positions.size());
  for (int a = 0; a < count; ++a)
    for (int b = a + 1; b < count; ++b) {
      const Record &p = state.positions[static_cast<std::size_t>(a)], &q = state.positions[static_cast<std::size_t>(b)];
      const Vec3f d{p.x - q.x, p.y - q.y, p.z - q.z};
      if (length_squared(d) < share * share * grain_diameter * grain_diameter) pairs.push_back({a, b, {}});
    }
  return pairs;
}

/// The pairs that press by more than `least` [m] when a substep of h begins, by the formula of a contact.
std::vector<GrainContact> pairs_that_press(const State& state, float h, double least) {
  std::vector<GrainContact> pairs;
  const int count = static_cast<int>(state.positions.size());
  const auto move = [&](int i) {
    const Record& v = state.velocities[static_cast<std::size_t>(i)];
    return Vec3d{v.x, v.y - 9.81 * static_cast<double>(h), v.z} * static_cast<double>(h);
  };
  const auto place = [&](int i) {
    const Record& p = state.positions[static_cast<std::size_t>(i)];
    return Vec3d{p.x, p.y, p.z} + move(i);
  };
  for (int a = 0; a < count; ++a)
    for (int b = a + 1; b < count; ++b) {
      const Vec3d between = place(a) - place(b), moves = move(a) - move(b);
      const double distance = std::sqrt(between.x * between.x + between.y * between.y + between.z * between.z);
      const double gap = distance - 2 * static_cast<double>(grain_radius);
      const double along = (between.x * moves.x + between.y * moves.y + between.z * moves.z) / distance;
      const double push =
          -static_cast<double>(grain_formulas::stiffness) * gap - static_cast<double>(grain_formulas::damping) * along;
      if (gap < -least && push > least) pairs.push_back({a, b, {}});
    }
  return pairs;
}

bool has_all(const std::vector<GrainContact>& these, const std::vector<GrainContact>& of) {
  return std::includes(these.begin(), these.end(), of.begin(), of.end(), in_order_of_particles);
}

// Grains fall and mix for half a second, in frames in which lists are found again. One more substep then has the
// contacts that brute force finds, but for those that hardly touch.
TEST(Grains, TouchWhereBruteForceFindsThemTouching) {
  Scene scene = block({0.3f, 0.2f, 0.1f}, 0.5f);
  World world(scene);
  scene.settings.substeps = 1;
  World one(scene);
  constexpr float h = 1.f / 1500;
  constexpr double rounding = 1e-7;
  for (int i = 0; i < 10; ++i) {
    advance(world, 3);
    const State& state = world.state();
    one.restore(state);
    one.step(h);
    const std::vector<GrainContact>& contacts = one.state().grain_contacts;
    EXPECT_TRUE(has_all(contacts, pairs_that_press(state, h, rounding))) << "a contact is missing";
    EXPECT_TRUE(has_all(pairs_that_press(state, h, -rounding), contacts)) << "a contact of grains that are apart";
    EXPECT_TRUE(i < 5 || contacts.size() > state.positions.size() / 2) << "they have not come to lie";
  }
}

TEST(Grains, DoNotOverlapMuchWhereTheyLie) {
  World world(block({0.3f, 0.2f, 0.1f}, 0.5f));
  ASSERT_TRUE(advance(world, 90).ok());
  EXPECT_TRUE(pairs_within(world.state(), 0.94f).empty());  // twice the overlap that the substeps are chosen for
}

/// The slope of a surface between 20 and 80 % of its height, by least squares over columns of grains across z
/// [degrees].
double slope_of(const std::vector<Vec3f>& grains) {
  std::map<std::pair<int, int>, double> tops;  // by column along x, and along z of twice the width
  for (const Vec3f& p : grains) {
    double& top = tops[{static_cast<int>(p.x / grain_diameter), static_cast<int>(p.z / (2 * grain_diameter))}];
    top = std::max(top, static_cast<double>(p.y));
  }
  std::map<int, std::pair<double, int>> sums;
  for (const auto& [cell, top] : tops) sums[cell.first] = {sums[cell.first].first + top, sums[cell.first].second + 1};
  double highest = 0, n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& [column, sum] : sums) highest = std::max(highest, sum.first / sum.second);
  for (const auto& [column, sum] : sums) {
    const double at = (column + 0.5) * static_cast<double>(grain_diameter), height = sum.first / sum.second;
    if (height < 0.2 * highest || height > 0.8 * highest) continue;
    n += 1;
    x += at;
    y += height;
    xx += at * at;
    xy += at * height;
  }
  return -std::atan((n * xy - x * y) / (n * xx - x * x)) * 180 / 3.14159265358979;
}

/// The slope of a heap that comes to rest when a gate withdraws from a block that lay behind it.
double angle_of_repose(float friction, int substeps, int iterations) {
  const Vec3f size{0.6f, 0.45f, 0.2f};
  Scene scene = block(size, friction);
  scene.objects[0].positions = shaken(size);
  scene.objects[0].masses.resize(scene.objects[0].positions.size(), scene.objects[0].masses[0]);
  const float r = std::sqrt(0.5f);
  Collider gate = wall({size.x, 0, 0}, {0, 0, r, r}, 0);
  gate.name = "gate";
  gate.motion.keyframes = {{.time = 0.5}, {.time = 3, .position = {0.5f, 0, 0}}};
  scene.add(gate);
  scene.settings.substeps = substeps;
  scene.settings.iterations = iterations;
  scene.settings.threads = 2;
  World world(scene);
  advance(world, 165);
  return slope_of(world.object(0).positions());
}

// The bound for heaps. The slope of one heap of 3 600 grains scatters by some 2 degrees (docs/guide/grains.md).
TEST(Grains, LieAtTheAngleOfTheirFriction) {
  for (const float friction : {0.4f, 0.7f})
    EXPECT_NEAR(angle_of_repose(friction, 0, 1), std::atan(static_cast<double>(friction)) * 180 / 3.14159265358979, 3)
        << friction;
}

// Several tasks of 512 grains.
TEST(Grains, HaveTheSameBitsOnAnyThreadsAndLevels) {
  const Scene scene = block({0.5f, 0.3f, 0.2f}, 0.5f);
  testing_support::expect_same_bits_on_any_threads_and_levels(scene, {20});
}

TEST(Grains, GoOnFromARestoredStateWithTheSameBits) {
  const Scene scene = block({0.3f, 0.2f, 0.1f}, 0.5f);
  World world(scene);
  advance(world, 15);
  const State kept = world.state();
  ASSERT_FALSE(kept.grain_contacts.empty());
  advance(world, 7);
  const std::string expected = hash(world.state());
  World other(scene);
  other.restore(kept);
  advance(other, 7);
  EXPECT_EQ(hash(other.state()), expected);
  State without = kept;
  without.grain_contacts.clear();
  other.restore(without);
  advance(other, 7);
  EXPECT_NE(hash(other.state()), expected) << "contacts have no effect";
}

TEST(Grains, ForgetThoseThatAreRemoved) {
  Scene scene = block({0.3f, 0.1f, 0.1f}, 0.5f);
  Object above = scene.objects[0];
  above.name = "above";
  for (Vec3f& p : above.positions) p.y += 0.1f;
  scene.add(above);
  World world(scene);
  advance(world, 30);
  const int first = static_cast<int>(scene.objects[0].positions.size());
  const auto is_above = [&](const GrainContact& contact) { return contact.b >= first; };
  const auto count = [&] {
    return std::count_if(world.state().grain_contacts.begin(), world.state().grain_contacts.end(), is_above);
  };
  EXPECT_GT(count(), 0);
  const std::size_t all = world.state().grain_contacts.size();
  world.remove(ObjectId{1});
  EXPECT_EQ(count(), 0);
  EXPECT_GT(world.state().grain_contacts.size(), 0U);
  EXPECT_LT(world.state().grain_contacts.size(), all);
  EXPECT_TRUE(advance(world, 5).ok());
}

TEST(Grains, OfAnotherGroupDoNotMeetThem) {
  const auto gap = [](std::uint32_t mask) {
    Scene scene;
    scene.gravity = {};
    scene.add(make_grains({{0, 0, 0}}, {.grains = {.radius = grain_radius}}));
    Object other = make_grains({{0.5f * grain_radius, 0, 0}}, {.name = "other", .grains = {.radius = grain_radius}});
    other.mask = mask;
    scene.add(other);
    World world(scene);
    advance(world, 30);
    return world.object(1).positions()[0].x - world.object(0).positions()[0].x;
  };
  EXPECT_GT(gap(~0u), 1.9f * grain_radius);
  EXPECT_EQ(gap(0), 0.5f * grain_radius);
}

TEST(Grains, NameWhatIsOutOfRange) {
  EXPECT_NE(testing_support::refusal([] { make_grains({}); }).find("without particles"), std::string::npos);
  EXPECT_NE(testing_support::refusal([] { make_grains({{}}, {.grains = {.radius = 0}}); }).find("radius"),
            std::string::npos);
  EXPECT_NE(testing_support::refusal([] { make_grains({{}}, {.grains = {.density = -1}}); }).find("density"),
            std::string::npos);
  EXPECT_NE(testing_support::refusal([] { make_grains({{}}, {.grains = {.friction = NAN}}); }).find("friction"),
            std::string::npos);
  EXPECT_NE(testing_support::refusal([] {
              Scene scene = block({0.1f, 0.1f, 0.1f}, 0.5f);
              scene.objects[0].grains->radius = NAN;
              const World world(scene);
            }).find("radius"),
            std::string::npos);
  EXPECT_NE(testing_support::refusal([] {
              World world(block({0.1f, 0.1f, 0.1f}, 0.5f));
              State state = world.state();
              state.grain_contacts = {{3, 3, {}}};
              world.restore(state);
            }).find("grain contact 0"),
            std::string::npos);
}

/// The overlap of the lowest two of grains that stand on one another [m].
double lowest_overlap(int grains, float mass_scaling, int substeps) {
  std::vector<Vec3f> places;
  for (int i = 0; i < grains; ++i) places.push_back({0, grain_radius + static_cast<float>(i) * grain_diameter, 0});
  Scene scene;
  GrainsOptions options;
  options.grains = {.radius = grain_radius, .mass_scaling = mass_scaling};
  Object column = make_grains(places, options);
  column.damping = 20;
  scene.add(std::move(column));
  scene.add(wall({0, 0, 0}, {0, 0, 0, 1}, 1));
  scene.settings.substeps = substeps;
  scene.settings.threads = 1;
  World world(scene);
  advance(world, 600);
  const std::vector<Vec3f> at = world.object(0).positions();
  return static_cast<double>(grain_diameter - (at[1].y - at[0].y));
}

/// A contact yields by twice g h^2 over the stiffness for each grain that lies on it. With mass scaling, r being the
/// ratio of the masses of neighbours, the series is geometric: (1 + r) (1 - r^n) / (1 - r) instead of 2 n.
TEST(Grains, OfAHighPileYieldLittleWithMassScaling) {
  constexpr int grains = 31, substeps = 40;
  const double h = 1. / 60 / substeps, of_one = 9.81 * h * h / static_cast<double>(grain_formulas::stiffness);
  const double plain = lowest_overlap(grains, 0, substeps), scaled = lowest_overlap(grains, 10, substeps);
  const double r = std::exp(-10 * static_cast<double>(grain_diameter));
  EXPECT_NEAR(plain, 2 * (grains - 1) * of_one, 0.02 * plain);
  EXPECT_NEAR(scaled, (1 + r) * (1 - std::pow(r, grains - 1)) / (1 - r) * of_one, 0.02 * scaled);
  EXPECT_LT(scaled, 0.4 * plain);
}

TEST(Grains, NeedFewerSubstepsWithMassScaling) {
  const auto substeps = [](float mass_scaling) {
    Scene scene;
    scene.add(make_grains(fill_box({0, 0, 0}, {0.06f, 2, 0.06f}, grain_diameter),
                          {.grains = {.radius = grain_radius, .mass_scaling = mass_scaling}}));
    return chosen_substeps(scene)[0];
  };
  EXPECT_LT(substeps(10), substeps(0) / 2);
  EXPECT_EQ(substeps(0.001f), substeps(0));
}

}  // namespace
}  // namespace pliant
