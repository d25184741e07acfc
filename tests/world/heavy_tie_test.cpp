// Tests ropes that are tied to bodies much heavier than they are: known lengths, and what the Report says of ties that
// open.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "pliant/body.h"
#include "pliant/world.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using testing_support::dt;

constexpr float half_side = 0.1f;  ///< half the side of the box that hangs [m]

struct Hung {
  int links = 10;
  float mass = 10;            ///< of the box [kg]
  float compliance = 0;       ///< of each link [m/N]
  bool starts_level = false;  ///< true: the rope starts level, and swings down
};

/// A rope of 1 m and 50 g with a box at its end.
Object hung_weight(const Hung& h) {
  BodyOptions options;
  options.name = "weight";
  options.position = h.starts_level ? Vec3f{1 + half_side, 0, 0} : Vec3f{0, -1 - half_side, 0};
  options.mass = h.mass;
  Object object = make_body({{Box{{half_side, half_side, half_side}}}}, options);
  std::vector<Vec3f> points;
  for (int i = 0; i <= h.links; ++i) {
    const float along = static_cast<float>(i) / static_cast<float>(h.links);
    points.push_back(h.starts_level ? Vec3f{along, 0, 0} : Vec3f{0, -along, 0});
  }
  RopeOptions rope;
  rope.stretch = Stiffness::compliance(h.compliance);
  const int first = append(object, make_rope(points, rope));
  object.name = "swing";
  object.pins.push_back({first, {}});
  attach(object, {first + h.links}, 0);
  return object;
}

/// The largest stretch of a rope and gap of its tie in a run.
struct Extent {
  double stretch = 0;  ///< of the whole rope [m]
  double gap = 0;      ///< of the tie [m]
};

double rope_length(const World& world) {
  const std::vector<Vec3f> x = world.object(0).positions();
  double sum = 0;
  for (std::size_t i = 1; i + 1 < x.size(); ++i) sum += std::sqrt(static_cast<double>(length_squared(x[i + 1] - x[i])));
  return sum;
}

Extent extent_of_run(World& world, int frames) {
  Extent found;
  for (int frame = 0; frame < frames; ++frame) {
    const Report report = world.step(dt);
    EXPECT_TRUE(report.ok()) << report.explain();
    EXPECT_TRUE(report.warnings.empty()) << "frame " << frame << ": " << report.explain();
    found.stretch = std::max(found.stretch, rope_length(world) - 1);
    found.gap = std::max(found.gap, report.widest_tie.gap);
  }
  return found;
}

World world_of(const Object& object) {
  Scene scene;
  scene.add(object);
  return World(scene);
}

/// Rigid links keep their lengths, and the tie is closed, whatever hangs there.
TEST(HeavyTie, DoesNotStretchARopeThatHangs) {
  for (const int links : {10, 20, 40})
    for (const float mass : {1.f, 10.f, 100.f, 1000.f}) {
      SCOPED_TRACE(std::to_string(links) + " links, " + std::to_string(mass) + " kg");
      World world = world_of(hung_weight({.links = links, .mass = mass}));
      const Extent found = extent_of_run(world, 120);
      EXPECT_LT(found.stretch, 1e-3);
      EXPECT_LT(found.gap, 1e-4);
    }
}

/// Half a swing, in which the rope bears up to three times the weight.
TEST(HeavyTie, DoesNotStretchARopeThatSwings) {
  for (const int links : {10, 40})
    for (const float mass : {10.f, 100.f}) {
      SCOPED_TRACE(std::to_string(links) + " links, " + std::to_string(mass) + " kg");
      World world = world_of(hung_weight({.links = links, .mass = mass, .starts_level = true}));
      const Extent found = extent_of_run(world, 60);
      EXPECT_LT(found.stretch, 1e-3);
      EXPECT_LT(found.gap, 1e-4);
    }
}

/// n links of compliance c stretch by n c F, F being the weight of the box and, on average, of half the rope.
TEST(HeavyTie, StretchesAnElasticRopeByItsCompliance) {
  for (const int links : {10, 40})
    for (const float mass : {10.f, 100.f}) {
      SCOPED_TRACE(std::to_string(links) + " links, " + std::to_string(mass) + " kg");
      const double wanted = 0.02, force = (static_cast<double>(mass) + 0.025) * 9.81;
      Object object =
          hung_weight({.links = links, .mass = mass, .compliance = static_cast<float>(wanted / (links * force))});
      object.damping = 5;
      World world = world_of(object);
      for (int frame = 0; frame < 300; ++frame) ASSERT_TRUE(world.step(dt).ok());
      EXPECT_NEAR(rope_length(world) - 1, wanted, 0.01 * wanted);
    }
}

/// Tethers, which only an object that names them has here, pull the tied particle off its body.
TEST(HeavyTie, ThatOpensIsNamed) {
  Object object = hung_weight({.links = 40});
  object.sweep = Sweep::tethered_chains;
  World world = world_of(object);
  Report report;
  for (int frame = 0; frame < 10; ++frame) report = world.step(dt);
  const TieGap& tie = report.widest_tie;
  const std::vector<Vec3f> x = world.object(0).positions();
  const Vec3f place = world.object(0).pose("weight").position + Vec3f{0, half_side, 0};
  EXPECT_EQ(tie.object, ObjectId(0));
  EXPECT_EQ(tie.body, 0);
  EXPECT_EQ(tie.particle, 41);
  EXPECT_NEAR(tie.gap, std::sqrt(static_cast<double>(length_squared(x[41] - place))), 1e-5);
  EXPECT_NEAR(tie.length, 1. / 40, 1e-6);
  EXPECT_FALSE(is_tolerable(tie));
  ASSERT_EQ(report.warnings.size(), 1U) << report.explain();
  EXPECT_EQ(report.warnings[0].find("object 'swing': particle 41 is "), 0U) << report.warnings[0];
  EXPECT_NE(report.warnings[0].find(" mm away from its place on body 0 ('weight') of 'swing', "), std::string::npos);
}

/// A tie with compliance opens by its force, which is no error. It is solved after the chain, whose last particle it
/// moves by up to F h^2 / m in a substep.
TEST(HeavyTie, WithComplianceOpensByItAndIsNotMeasured) {
  for (const int links : {10, 40}) {
    SCOPED_TRACE(links);
    Object object = hung_weight({.links = links});
    object.constraints.back().stiffness = Stiffness::compliance(1e-3f);
    object.damping = 5;
    World world = world_of(object);
    for (int frame = 0; frame < 300; ++frame) EXPECT_LT(world.step(dt).widest_tie.body, 0);
    const float end = world.object(0).positions().back().y;
    const double force = 10 * 9.81, h = static_cast<double>(dt) / world.object(0).info().substeps;
    const double moved = force * h * h / static_cast<double>(object.masses.back());
    EXPECT_NEAR(end - (world.object(0).pose("weight").position.y + half_side), 1e-3 * force, moved);
  }
}

}  // namespace
}  // namespace pliant
