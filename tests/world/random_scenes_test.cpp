// Tests small random scenes with extremes: time steps of 1e-5 to 1 s, mass ratios of 1e6, compliance from none to much,
// 1 to 50 iterations, degenerate stencils, scales of 1e-3 to 1e3, positions 1e4 m away. Each must be rejected with its
// element named, or stay finite, or stop with the cause named; none may crash. Cloth must stay finite. Only balloons of
// any pressure and stiffness, and heaps of random constraints, may grow beyond float range. PLIANT_RANDOM_SCENES=3000
// tries more scenes, PLIANT_RANDOM_SEED others.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <random>
#include <string_view>

#include "pliant/error.h"
#include "support/sanitized.h"
#include "support/scenes.h"

namespace pliant {
namespace {

using namespace testing_support;

int number_from(const char* variable, int otherwise) {
  const char* text = std::getenv(variable);
  return text != nullptr ? std::atoi(text) : otherwise;
}

/// Never call a Dice twice in one list of arguments: compilers evaluate arguments in different orders.
class Dice {
 public:
  explicit Dice(unsigned seed) : random_(seed) {}
  int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  bool one_in(int n) { return below(n) == 0; }
  float between(float low, float high) { return low + (high - low) * static_cast<float>(random_() >> 8) / 16777216.f; }
  /// A number between 10^low and 10^high whose logarithm is uniformly distributed.
  float magnitude(float low, float high) { return std::pow(10.f, between(low, high)); }
  Vec3f point(float reach) { return {between(-reach, reach), between(-reach, reach), between(-reach, reach)}; }

 private:
  std::mt19937 random_;
};

Stiffness random_stiffness(Dice& dice) {
  switch (dice.below(5)) {
    case 0:
      return Stiffness::rigid();
    case 1:
      return Stiffness::pbd(dice.one_in(3) ? static_cast<float>(dice.below(2)) : dice.between(0, 1));
    case 2: {
      const float compliance = dice.one_in(4) ? 1e20f : dice.magnitude(-12, 6);
      return Stiffness::compliance(compliance, dice.magnitude(-6, 6));
    }
    default:
      return Stiffness::compliance(dice.magnitude(-12, 6));
  }
}

constexpr std::string_view first_types[] = {"distance", "dihedral_bending",  "isometric_bending",
                                            "fibre",    "tetrahedron_shear", "tetrahedron_volume"};

void add_random_constraints(Dice& all, Object& object, float scale) {
  const int particles = static_cast<int>(object.positions.size());
  for (const ConstraintType& type : constraint_types()) {
    // All but the first types use a copy of the dice, so that a new one leaves everything else in the scenes as it was.
    Dice copy = all;
    const bool is_of_the_first =
        std::find(std::begin(first_types), std::end(first_types), type.name) != std::end(first_types);
    Dice& dice = is_of_the_first ? all : copy;
    const bool has_frames = std::find(type.slots.begin(), type.slots.end(), SlotKind::frame) != type.slots.end();
    if (has_frames || type.stencil_size > particles || dice.one_in(3)) continue;  // these objects have no frames
    ConstraintGroup group{type.name, {}, {}, random_stiffness(dice), {}};
    const int count = dice.below(3 * particles);
    const int strides = type.stencil_size > 4 ? 1 : 3;  // wide ones would often have a particle twice, and be refused
    for (int c = 0; c < count; ++c) {
      const int first = dice.below(particles);
      for (int slot = 0; slot < type.stencil_size; ++slot)
        group.particles.push_back((first + slot * (1 + c % strides)) % particles);
    }
    if (dice.one_in(4)) {
      for (std::size_t i = 0; i < static_cast<std::size_t>(count) * type.rest_fields.size(); ++i) {
        group.rest.push_back(dice.one_in(5) ? 0 : dice.between(0, 2) * scale);
      }
    }
    object.constraints.push_back(group);
  }
}

Object random_object(Dice& dice, float scale, const Vec3f& place) {
  Object object;
  object.name = "heap";
  const int kind = dice.below(3);
  if (kind == 0) {
    const int n = 3 + dice.below(8);
    ClothOptions options;
    options.bending_model = static_cast<ClothOptions::Bending>(dice.below(3));
    if (dice.one_in(2)) options.stretch = random_stiffness(dice);
    if (dice.one_in(2)) options.bending = random_stiffness(dice);
    TriangleMesh mesh = dice.one_in(3) ? sphere_mesh(1) : grid_mesh(n, n + dice.below(4), 1, 1);
    if (mesh.positions.size() == 42) options.volume = Volume{dice.between(0, 3), random_stiffness(dice)};
    for (Vec3f& p : mesh.positions) p = (p + dice.point(0.02f)) * scale + place;
    options.name = options.volume ? "balloon" : "cloth";
    object = make_cloth(mesh, options);
  } else {
    const int particles = 1 + dice.below(40);
    for (int i = 0; i < particles; ++i) {
      // Sometimes many particles are in one place, or on one line.
      const Vec3f at = kind == 2 && dice.one_in(2) ? Vec3f{static_cast<float>(dice.below(3)), 0, 0} : dice.point(1);
      object.positions.push_back(at * scale + place);
    }
    object.masses.assign(object.positions.size(), 1);
    add_random_constraints(dice, object, scale);
  }
  for (float& mass : object.masses) {
    if (dice.one_in(4)) mass = dice.magnitude(-3, 3);
    if (dice.one_in(20)) mass = std::numeric_limits<float>::infinity();
  }
  if (dice.one_in(2)) {
    const float speed = dice.magnitude(-2, 3);
    for (std::size_t i = 0; i < object.positions.size(); ++i) object.velocities.push_back(dice.point(speed));
  }
  const int particles = static_cast<int>(object.positions.size());
  if (dice.one_in(2))
    object.pins.push_back({dice.below(particles), dice.one_in(2) ? straight(dice.point(scale), 0.1f) : Motion{}});
  if (dice.one_in(3))
    object.attachments.push_back({dice.below(particles), dice.point(scale) + place, {}, random_stiffness(dice)});
  object.thickness = dice.one_in(4) ? 0 : 0.01f * scale;
  object.restitution = dice.one_in(2) ? dice.between(0, 1) : 0;
  object.damping = dice.one_in(2) ? dice.magnitude(-2, 4) : 0;
  return object;
}

Scene random_scene(unsigned seed, float& step) {
  Dice dice(seed);
  Scene scene;
  const float scale = dice.one_in(3) ? dice.magnitude(-3, 3) : 1;
  const Vec3f place = dice.one_in(4) ? Vec3f{1e4f, -1e4f, 0} : Vec3f{};
  step = dice.one_in(3) ? dice.magnitude(-5, 0) : 1.f / 60;
  scene.settings.substeps = 1 + dice.below(12);
  scene.settings.iterations = dice.one_in(3) ? 1 + dice.below(dice.one_in(5) ? 50 : 10) : 1;
  scene.settings.threads = 1 + dice.below(2);
  scene.settings.measure = dice.one_in(2);
  if (dice.one_in(4)) scene.gravity = dice.point(100);
  if (dice.one_in(3)) scene.wind = {dice.point(50), dice.between(0, 1), dice.magnitude(-2, 1), dice.magnitude(-1, 2)};
  const int objects = 1 + dice.below(3), colliders = dice.below(4);
  for (int i = 0; i < objects; ++i) scene.add(random_object(dice, scale, place));
  for (int i = 0; i < colliders; ++i) {
    Collider collider;
    const Shape shapes[] = {Plane{}, Sphere{scale}, Capsule{0.3f * scale, dice.between(0, 1) * scale},
                            Box{{scale, 0.01f * scale, scale}}};
    collider.shape = shapes[dice.below(4)];
    collider.position = dice.point(scale) + place;
    const float degrees = dice.between(0, 360);
    collider.rotation = rotation({1, dice.between(-1, 1), 0.5f}, degrees);
    collider.static_friction = dice.magnitude(-2, 2);
    collider.kinetic_friction = collider.static_friction * dice.between(0, 1);
    if (dice.one_in(2)) {
      const Vec3f way = dice.point(10 * scale);
      collider.motion = straight(way, dice.magnitude(-2, 1));
    }
    scene.add(collider);
  }
  return scene;
}

bool records_are_finite(const State& state) {
  for (const auto* records : {&state.positions, &state.remainders, &state.velocities}) {
    for (const Record& r : *records) {
      if (!std::isfinite(r.x) || !std::isfinite(r.y) || !std::isfinite(r.z) || !std::isfinite(r.w)) return false;
    }
  }
  return true;
}

void expect_finite_or_said(Sweep sweep, unsigned first, int scenes) {
  const int frames = scenes > 200 ? 300 : 40;
  int refused = 0, stopped = 0;
  for (unsigned seed = first; seed < first + static_cast<unsigned>(scenes); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    try {
      float step = 0;
      Scene scene = random_scene(seed, step);
      scene.settings.sweep = sweep;
      World world(scene);
      for (int frame = 0; frame < frames; ++frame) {
        const Report report = world.step(step);
        ASSERT_TRUE(records_are_finite(world.state())) << "frame " << frame;
        if (report.ok()) continue;
        ++stopped;
        EXPECT_NE(report.nonfinite->object, "cloth") << report.explain();
        EXPECT_FALSE(report.nonfinite->object.empty());
        // If multigrid corrects by far too much, no constraint is the cause; then the particle is named.
        const char* culprit = sweep == Sweep::tiled ? " constraint " : " ";
        EXPECT_NE(report.nonfinite->element.find(culprit), std::string::npos) << report.explain();
        EXPECT_FALSE(world.step(step).ok());
        break;
      }
      EXPECT_TRUE(std::isfinite(world.measure().kinetic_energy()));
    } catch (const Error& error) {
      ++refused;
      EXPECT_FALSE(error.where().object.empty() && error.where().element.empty()) << error.what();
    }
  }
  testing::Test::RecordProperty("refused", refused);
  testing::Test::RecordProperty("stopped", stopped);
  EXPECT_LT(refused, 1 + scenes / 4) << "most scenes are to be run";
  EXPECT_LT(stopped, 1 + scenes / 8);
}

void expect_finite_or_said(Sweep sweep) {
  const auto first = static_cast<unsigned>(number_from("PLIANT_RANDOM_SEED", 0));
  expect_finite_or_said(sweep, first, number_from("PLIANT_RANDOM_SCENES", fewer_if_sanitized(200, 50)));
}

TEST(RandomScenes, StayFiniteOrSayWhatDidNot) { expect_finite_or_said(Sweep::tiled); }
TEST(RandomScenes, StayFiniteOrSayWhatDidNotByMultigrid) { expect_finite_or_said(Sweep::multigrid); }

// Cloth with masses from 1e-3 to 1e3 whose rigid bending undoes in each substep what was corrected. Every correction by
// a harmful Newton step would throw it farther, until values are infinite.
TEST(RandomScenes, UnsoundCorrectionsAreNotMade) { expect_finite_or_said(Sweep::multigrid, 1091, 1); }

}  // namespace
}  // namespace pliant
