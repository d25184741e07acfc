// Objects that tear by strain: when, where, and what they keep.
#include "math/vector.h"
#include "pliant/body.h"
#include "pliant/cluster.h"
#include "pliant/edit.h"
#include "pliant/error.h"
#include "pliant/save.h"
#include "tears/tears_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// A sheet of 1 m x 0.5 m in the plane y = 0, of elastic edges.
Object sheet(int columns = 17, int rows = 9) {
  ClothOptions options;
  options.stretch = Stiffness::compliance(1e-4f);
  Object object = make_cloth(grid_mesh(columns, rows, 1, 0.5f), options);
  object.tearing = Tearing{1.3f};
  return object;
}

TEST(Tear, LeavesWhatIsStretchedLess) {
  Object object = sheet();
  pull_apart(object, 1.1f, 1);
  World world(weightless(object, 20));
  const Torn torn = run_and_tear(world, 90);
  EXPECT_EQ(torn.new_particles, 0);
  EXPECT_EQ(torn.lost_constraints, 0);
}

TEST(Tear, PartsASheetThatIsPulledTooFarAndKeepsItsMass) {
  Object object = sheet();
  pull_apart(object, 2, 1);
  World world(weightless(object, 20));
  const Torn torn = run_and_tear(world, 240);
  EXPECT_GT(torn.new_particles, 8) << "a tear across nine rows splits at least nine particles, or more";
  const Object& after = world.object(ObjectId(0)).description();
  EXPECT_GE(pieces_of(after), 2);
  EXPECT_NEAR(mass_of(after) / mass_of(object), 1, 1e-6);
  EXPECT_EQ(after.triangles.size(), object.triangles.size());
  EXPECT_EQ(world.object(ObjectId(0)).positions().size(), after.positions.size());
}

/// The particle that splits first.
int first_split(const Object& object, const Scene& scene) {
  World world(scene);
  for (int frame = 0; frame < 240; ++frame) {
    const std::vector<Vec3f> before = world.object(ObjectId(0)).positions();
    const Report report = world.step(1.f / 60);
    if (report.torn.empty()) continue;
    const Object& torn = world.object(ObjectId(0)).description();
    for (std::size_t i = 0; i < object.positions.size(); ++i)
      if (torn.masses[i] < 0.999f * object.masses[i]) return static_cast<int>(i);
  }
  return -1;
}

TEST(Tear, BeginsAtTheTipOfANotch) {
  Object whole = sheet();
  whole.tearing.reset();
  // Particles are row after row along z; the middle column is across the pull. The notch reaches four rows in.
  std::vector<int> notch;
  for (int row = 0; row < 5; ++row) notch.push_back(17 * row + 8);
  Object object = cut(whole, notch).object;
  object.tearing = Tearing{1.3f};
  pull_apart(object, 1.6f, 2);
  const int first = first_split(object, weightless(object, 40));
  ASSERT_GE(first, 0);
  const Vec3f& tip = whole.positions[static_cast<std::size_t>(notch.back())];
  const Vec3f& place = object.positions[static_cast<std::size_t>(first)];
  EXPECT_LE(length(place - tip), 0.0626f) << "the tip or a neighbour of it";
}

TEST(Tear, BreaksARopeWhereItBearsMost) {
  std::vector<Vec3f> points;
  for (int i = 0; i < 11; ++i) points.push_back({0, -0.1f * static_cast<float>(i), 0});
  RopeOptions options;
  options.stretch = Stiffness::compliance(2e-2f);
  Object rope = make_rope(points, options);
  rope.masses.back() = 0.2f;
  rope.pins.push_back({0, {}});
  rope.damping = 20;  // above critical: no link is ever longer than at rest
  // The uppermost link bears 0.2 kg and nine particles of 5 g: it is 1 + m g alpha / L = 1.481 times as long; the next
  // one 1.471.
  rope.tearing = Tearing{1.476f};
  Scene scene = weightless(rope, 50);
  scene.gravity = {0, -9.81f, 0};
  World world(scene);
  Torn torn;
  for (int frame = 0; frame < 900 && torn.lost_constraints == 0; ++frame) torn = run_and_tear(world, 1);
  ASSERT_EQ(torn.lost_constraints, 1);
  EXPECT_EQ(torn.new_particles, 0);
  const Object& after = world.object(ObjectId(0)).description();
  for (const ConstraintGroup& group : after.constraints)
    for (std::size_t i = 0; i + 1 < group.particles.size(); i += 2)
      EXPECT_FALSE(group.particles[i] + group.particles[i + 1] == 1) << "the uppermost link is gone";
  const float before = world.object(ObjectId(0)).positions()[5].y;
  run_and_tear(world, 60);
  EXPECT_LT(world.object(ObjectId(0)).positions()[5].y, before - 0.2f) << "the rest falls";
}

TEST(Tear, SnapsARopeInOnePlaceAtATime) {
  std::vector<Vec3f> points;
  for (int i = 0; i < 41; ++i) points.push_back({0.025f * static_cast<float>(i), 0, 0});
  Object rope = make_rope(points);
  rope.tearing = Tearing{1.2f};
  std::vector<Vec3f> now = rope.positions;
  for (Vec3f& p : now) p.x *= 1.3f;
  const std::optional<Edit> edit = tear(rope, now);
  ASSERT_TRUE(edit);
  EXPECT_EQ(pieces_of(edit->object), 2);
}

TEST(Tear, LeavesHeldParticlesWhole) {
  Object object = sheet();
  pull_apart(object, 2, 1);
  const std::size_t pins = object.pins.size();
  World world(weightless(object, 20));
  EXPECT_GT(run_and_tear(world, 240).new_particles, 8);
  EXPECT_EQ(world.object(ObjectId(0)).description().pins.size(), pins);
}

TEST(Tear, TearsRopeAndClothBesideTetrahedra) {
  Object both = make_soft_body(box_tetrahedra({0.2f, 0.2f, 0.2f}, {1, 1, 1}));
  std::vector<Vec3f> points;
  for (int i = 0; i < 5; ++i) points.push_back({0.1f * static_cast<float>(i), 1, 0});
  const int first = append(both, make_rope(points));
  both.tearing = Tearing{1.2f};
  std::vector<Vec3f> now = both.positions;
  for (std::size_t i = static_cast<std::size_t>(first); i < now.size(); ++i) now[i].x *= 1.5f;
  const std::optional<Edit> edit = tear(both, now);
  ASSERT_TRUE(edit);
  EXPECT_EQ(edit->object.positions.size(), both.positions.size());
  EXPECT_EQ(edit->object.constraints.back().particles.size(), 2u * 3) << "one of four links is gone";
}

TEST(Tear, DividesClusters) {
  Object object = make_cloth(grid_mesh(9, 9, 1, 1));
  add_cluster(object, [] {
    std::vector<int> all(81);
    std::iota(all.begin(), all.end(), 0);
    return all;
  }());
  object.cuts.push_back({0, 0, {0.01f, 0, 0}, {1, 0, 0}, {0, 0, 1}});
  const std::optional<Edit> edit = make_cuts(object, 0);
  ASSERT_TRUE(edit);
  ASSERT_EQ(edit->object.clusters.size(), 2u);
  EXPECT_EQ(edit->object.clusters[0].particles.size() + edit->object.clusters[1].particles.size(), 90u);
}

TEST(Tear, NeverThrowsInAStep) {
  Object bar = make_soft_body(box_tetrahedra({0.4f, 0.1f, 0.1f}, {4, 1, 1}));
  const ConstraintGroup& shear = bar.constraints[0];
  ConstraintGroup again;  // a tetrahedron twice: its faces have three
  again.type = shear.type;
  again.stiffness = shear.stiffness;
  again.particles.assign(shear.particles.begin(), shear.particles.begin() + 4);
  bar.constraints.push_back(again);
  bar.cuts.push_back({0.01f, 0.01f, {}, {1, 0, 0}, {0, -1, 0}});
  World world(weightless(bar, 20));
  Report report;
  EXPECT_NO_THROW(report = world.step(1.f / 60));
  ASSERT_FALSE(report.warnings.empty());
  EXPECT_NE(report.warnings.back().find("could not tear"), std::string::npos) << report.warnings.back();
}

TEST(Tear, DoesNotTakeFramesForParticles) {
  Object object = make_cloth(grid_mesh(3, 3, 1, 1));
  const int first = static_cast<int>(object.positions.size());
  for (int i = 0; i < first; ++i)
    add_body(object, {Solid{Sphere{0.1f}, {}, {}, 1000}}, {.position = {0, 1 + 0.3f * static_cast<float>(i), 0}});
  const std::array<int, 3> corners = object.triangles[0];  // frames have these numbers too
  ConstraintGroup gear;
  gear.type = "gear_joint";
  gear.particles.assign(corners.begin(), corners.end());
  object.constraints.push_back(gear);
  std::vector<int> part(object.triangles.size(), 0);
  part[0] = 1;
  const Edit edit = part_triangles(object, part);
  EXPECT_EQ(edit.object.constraints.back().particles, gear.particles);
  EXPECT_GT(edit.object.positions.size(), static_cast<std::size_t>(2 * first));
}

TEST(Tear, BurstsABalloon) {
  TriangleMesh sphere = sphere_mesh(3);
  for (Vec3f& p : sphere.positions) p = 0.2f * p;
  ClothOptions options;
  options.material = fabric("rubber sheet");
  options.volume = Volume{};
  Object balloon = make_cloth(sphere, options);
  balloon.volume->keyframes = {{0, 1}, {8, 6}};
  balloon.tearing = Tearing{1.4f};
  balloon.damping = 5;
  World world(weightless(balloon, 100));
  const double before = world.object(ObjectId(0)).enclosed_volume();
  double largest = 0;
  Torn torn;
  for (int frame = 0; frame < 480; ++frame) {
    largest = std::max(largest, world.object(ObjectId(0)).enclosed_volume());
    torn = run_and_tear(world, 1);
    if (torn.new_particles > 0) break;
  }
  ASSERT_GT(torn.new_particles, 0);
  // All edges of a sphere would be stretched alike; those of its mesh of springs differ by some per cent.
  EXPECT_NEAR(std::cbrt(largest / before), 1.4, 0.1);
  EXPECT_FALSE(world.object(ObjectId(0)).description().volume) << "the air is gone";
}

TEST(Tear, PartsABarOfTetrahedra) {
  SoftBodyOptions options;
  options.material.youngs_modulus = 2e4f;
  options.material.poisson_ratio = 0.3f;
  Object bar = make_soft_body(box_tetrahedra({0.4f, 0.1f, 0.1f}, {8, 2, 2}), options);
  bar.tearing = Tearing{1.5f};
  pull_apart(bar, 3, 2);
  World world(weightless(bar, 30));
  const Torn torn = run_and_tear(world, 240);
  EXPECT_GT(torn.new_particles, 8);
  const Object& after = world.object(ObjectId(0)).description();
  EXPECT_GE(pieces_of(after), 2);
  EXPECT_NEAR(mass_of(after) / mass_of(bar), 1, 1e-6);
  EXPECT_EQ(tetrahedra_of(after).size(), tetrahedra_of(bar).size());
  EXPECT_EQ(world.measure().tetrahedra().inverted, 0);
}

TEST(Tear, HasTheSameBitsOnAnyNumberOfThreads) {
  Object object = sheet();
  pull_apart(object, 2, 1);
  Scene scene = weightless(object, 20);
  World one(scene);
  scene.settings.threads = 3;
  World three(scene);
  for (int frame = 0; frame < 90; ++frame) {
    one.step(1.f / 60);
    three.step(1.f / 60);
    ASSERT_EQ(one.state_hash(), three.state_hash()) << "after frame " << frame;
  }
  EXPECT_GT(one.object(ObjectId(0)).positions().size(), object.positions.size()) << "it tore";
}

TEST(Tear, GoesOnFromASavedWorld) {
  Object object = sheet();
  pull_apart(object, 2, 1);
  Scene scene = weightless(object, 20);
  World world(scene);
  while (world.object(ObjectId(0)).positions().size() == object.positions.size() && world.state().frame < 240)
    world.step(1.f / 60);
  Scene torn = scene;
  torn.objects[0] = world.object(ObjectId(0)).description();
  const std::string path = ::testing::TempDir() + "torn_world.pliant";
  save(path, world, torn);
  LoadedWorld loaded = load_world(path);
  for (int frame = 0; frame < 60; ++frame) {
    world.step(1.f / 60);
    loaded.world.step(1.f / 60);
    ASSERT_EQ(world.state_hash(), loaded.world.state_hash()) << "frame " << frame;
  }
}

TEST(Tear, KeepsWhatTheUserSet) {
  SoftBodyOptions options;
  options.material.youngs_modulus = 2e4f;
  options.fibres = Fibres{};
  options.fibres->stretch = {{0, 1}};
  Object bar = make_soft_body(box_tetrahedra({0.4f, 0.1f, 0.1f}, {8, 2, 2}), options);
  bar.cuts.push_back({0.05f, 0.05f, {}, {1, 0, 0}, {0, -1, 0}});
  World world(weightless(bar, 20));
  const int fibres = static_cast<int>(bar.constraints.size()) - 1;
  world.object(ObjectId(0)).set_rest_factor(fibres, 0.8f);
  const Torn torn = run_and_tear(world, 30);
  ASSERT_GT(torn.new_particles, 0);
  ASSERT_EQ(world.state().rest_factors.size(), 1u);
  EXPECT_EQ(world.state().rest_factors[0].factor, 0.8f);
}

TEST(Tear, HasADescriptionOnlyWhereItMayTear) {
  Scene scene = weightless(sheet(), 8);
  scene.objects[0].tearing.reset();
  World world(scene);
  EXPECT_THROW(world.object(ObjectId(0)).description(), Error);
  const ObjectId other = world.add(sheet());
  EXPECT_EQ(world.object(other).description().positions.size(), 17u * 9);
  world.remove(other);
  EXPECT_THROW(world.object(other).description(), Error);
}

TEST(Tear, RefusesWhatCannotTear) {
  const auto problem = [](const Object& object) {
    try {
      World world(weightless(object, 8));
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  Object object = sheet();
  object.tearing = Tearing{1};
  EXPECT_NE(problem(object).find("tearing, stretch"), std::string::npos) << problem(object);
  object = sheet();
  object.skin.emplace();
  EXPECT_NE(problem(object).find("skin"), std::string::npos) << problem(object);
  object = sheet();
  object.cuts.push_back({0, 0, {}, {0, 0, 1}, {0, 0, 2}});
  EXPECT_NE(problem(object).find("cut 0"), std::string::npos) << problem(object);
  object = sheet();
  object.cuts.push_back({2, 1, {}, {1, 0, 0}, {0, 0, 2}});
  EXPECT_NE(problem(object).find("cut 0, end"), std::string::npos) << problem(object);
  object = sheet();
  EXPECT_THROW(tear(object, std::vector<Vec3f>(3)), Error);
  EXPECT_THROW(part_triangles(object, std::vector<int>(3)), Error);
}

}  // namespace
}  // namespace pliant
