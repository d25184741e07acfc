// What make_rod makes, and what it refuses.
#include <cstdio>
#include <cstring>
#include <fstream>
#include <functional>
#include <numeric>
#include <sstream>
#include <string>

#include "pliant/body.h"
#include "pliant/error.h"
#include "rods/rod_support.h"
#include "support/paths.h"
#include "support/refusal.h"

namespace pliant {
namespace {

using namespace testing_support;

TEST(MakeRod, MakesASegmentBetweenTwoPoints) {
  RodOptions options = clamped_rod(material_of(1e9, 4e8, 800), 0.01f);
  options.name = "wire";
  const Object rod = make_rod(line({0, 0, 0}, {1, 0, 0}, 10), options);
  ASSERT_EQ(rod.bodies.size(), 11u);  // and the world's
  ASSERT_EQ(rod.joints.size(), 10u);
  EXPECT_EQ(rod.bodies[3].name, "wire 3");
  EXPECT_EQ(rod.joints[3].name, "wire 3-4");
  EXPECT_EQ(rod.joints.back().name, "wire start");
  const float mass = std::accumulate(rod.masses.begin(), rod.masses.begin() + 10, 0.f);
  EXPECT_NEAR(mass, 800 * pi * 1e-4, 1e-5);
  EXPECT_EQ(rod.kinetic_friction, options.material.kinetic_friction);
}

TEST(MakeRod, TapersToItsEnd) {
  RodOptions options = clamped_rod(material_of(1e9, 4e8, 800), 0.01f);
  options.end_radius = 0.004f;
  const Object rod = make_rod(line({0, 0, 0}, {1, 0, 0}, 10), options);
  const float mass = std::accumulate(rod.masses.begin(), rod.masses.begin() + 10, 0.f);
  EXPECT_NEAR(mass, 800 * pi * (1e-4 + 4e-5 + 1.6e-5) / 3, 1e-5);  // a cone
  EXPECT_GT(rod.masses[0], 4 * rod.masses[9]);
  options.stiffness = RodStiffness{1, 1, 1, 1, 1};
  EXPECT_NE(refusal([&] { make_rod(line({0, 0, 0}, {1, 0, 0}, 10), options); }).find("end_radius"), std::string::npos);
  options.stiffness.reset();
  options.end_radius = 0.2f;
  EXPECT_NE(refusal([&] { make_rod(line({0, 0, 0}, {1, 0, 0}, 10), options); }).find("2.25 radii"), std::string::npos);
}

TEST(MakeRod, HasTheStiffnessOfARoundSection) {
  const RodStiffness found = stiffness_of(material_of(2e9, 8e8, 1000), 0.01f);
  EXPECT_NEAR(found.stretch, 2e9 * pi * 1e-4, 1);
  EXPECT_NEAR(found.bending, 2e9 * second_moment(0.01), 1e-3);
  EXPECT_NEAR(found.twist, 8e8 * 2 * second_moment(0.01), 1e-3);
}

TEST(MakeRod, BendsARopeMoreEasilyThanASolidRod) {
  RodMaterial rope = material_of(2e9, 8e8, 1000);
  const RodStiffness solid = stiffness_of(rope, 0.01f);
  rope.bending_share = 0.05f;
  const RodStiffness found = stiffness_of(rope, 0.01f);
  EXPECT_EQ(found.stretch, solid.stretch);
  EXPECT_EQ(found.shear, solid.shear);
  EXPECT_NEAR(found.bending / solid.bending, 0.05, 1e-6);
  EXPECT_NEAR(found.bending_2 / solid.bending_2, 0.05, 1e-6);
  EXPECT_NEAR(found.twist / solid.twist, 0.05, 1e-6);
  const RodMaterial& made = rod_material("rope");
  EXPECT_NEAR(made.density * pi * 0.005 * 0.005, 0.062, 0.001) << "62 g/m at 10 mm";
  for (const float share : {0.f, 1.5f}) {
    RodOptions options = clamped_rod(rope, 0.01f);
    options.material.bending_share = share;
    EXPECT_NE(refusal([&] {
                make_rod(line({0, 0, 0}, {1, 0, 0}, 10), options);
              }).find("bending_share"),
              std::string::npos);
  }
}

TEST(MakeRod, JoinsItsEndsToBodies) {
  Object object;
  const int block = add_body(object, {{Box{}}}, {.name = "block"});
  RodOptions options = clamped_rod({}, 0.01f);
  options.start.body = block;
  options.end.kind = RodEnd::Kind::ball;
  EXPECT_EQ(add_rod(object, line({0, 1, 0}, {1, 1, 0}, 5), options), 1);
  EXPECT_EQ(object.joints[4].a, block);
  EXPECT_EQ(object.joints[5].kind, "ball");
  options.name = "second";
  EXPECT_EQ(add_rod(object, line({0, 2, 0}, {1, 2, 0}, 5), options), 7);
}

/// A flat rod bends by its own weight about the axis that is level: as the one, or as the other stiffness.
TEST(MakeRod, HasTwoStiffnessesOfBending) {
  const auto sag = [](const Vec3f& across) {
    RodOptions options = clamped_rod(material_of(1e9, 4e8, 1000), 0.01f);
    options.stiffness = RodStiffness{1e5f, 4e4f, 4.f, 16.f, 8.f};
    options.across = across;
    Object rod = make_rod(line({0, 0, 0}, {1, 0, 0}, 12), options);
    rod.damping = 5;
    Lone lone(std::move(rod), 10);
    lone.run(8);
    return -lone.tip(12).y;
  };
  EXPECT_NEAR(sag({0, 0, 1}) / sag({0, 1, 0}), 4, 0.05);  // `across` is the axis about which `bending` acts
}

TEST(MakeRod, RefusesWhatIsNoRod) {
  const std::vector<Vec3f> points = line({0, 0, 0}, {1, 0, 0}, 10);
  const auto refused = [&](const std::function<void(RodOptions&)>& change) {
    RodOptions options;
    options.name = "wire";
    change(options);
    return refusal([&] { make_rod(points, options); });
  };
  EXPECT_NE(refused([](RodOptions& o) { o.radius = 0; }).find("radius"), std::string::npos);
  EXPECT_NE(refused([](RodOptions& o) { o.radius = 0.1f; }).find("points 0 and 1"), std::string::npos);
  EXPECT_NE(refused([](RodOptions& o) { o.material.youngs_modulus = -1; }).find("youngs_modulus"), std::string::npos);
  EXPECT_NE(refused([](RodOptions& o) { o.material.damping = NAN; }).find("damping"), std::string::npos);
  EXPECT_NE(refused([](RodOptions& o) { o.across = Vec3f{1, 0, 0}; }).find("across"), std::string::npos);
  EXPECT_NE(refused([](RodOptions& o) { o.start = {RodEnd::Kind::ball, 4}; }).find("body 4"), std::string::npos);
  EXPECT_NE(refusal([] { make_rod({{0, 0, 0}, {1, 0, 0}}); }).find("three points"), std::string::npos);
  EXPECT_NE(refusal([] { make_rod({{0, 0, 0}, {1, 0, 0}, {0, 0.1f, 0}}); }).find("point 1"), std::string::npos);
  EXPECT_NE(refusal([] { make_rod({{0, 0, 0}, {NAN, 0, 0}, {2, 0, 0}}); }).find("finite"), std::string::npos);
  EXPECT_NE(refusal([] { helix(0, 1, 2, 10); }).find("helix"), std::string::npos);
  Object object = make_rod(points);
  const std::size_t bodies = object.bodies.size();
  EXPECT_NE(refusal([&] { add_rod(object, points); }).find("taken"), std::string::npos);
  EXPECT_EQ(object.bodies.size(), bodies);
}

/// A cable over a drum that carries a crate: contact yields to the load where substeps are too few.
TEST(MakeRod, IsDoubtedWhereItsLoadIsTooHeavyForTheSubsteps) {
  Scene scene;
  Object winch;
  winch.name = "winch";
  BodyOptions crate;
  crate.mass = 8;
  RodOptions options = clamped_rod(material_of(2e8, 7e7, 1200), 0.007f);
  options.end = {RodEnd::Kind::ball, add_body(winch, {{Box{{0.1f, 0.1f, 0.1f}}}}, crate)};
  add_rod(winch, line({0, 1, 0}, {0, 0.1f, 0}, 30), options);
  scene.add(winch);
  const auto doubts = [&] {
    std::string text;
    for (const Finding& finding : inspect(scene)) text += finding.message + "; ";
    return text;
  };
  EXPECT_NE(doubts().find("carry up to 8 kg"), std::string::npos) << doubts();
  scene.settings.substeps = 40;
  EXPECT_EQ(doubts().find("carry up to"), std::string::npos) << doubts();
  scene.settings.substeps = 0;
  scene.objects[0].collides = scene.objects[0].self_collision = false;
  EXPECT_EQ(doubts().find("carry up to"), std::string::npos) << doubts();
}

std::string number(float value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", static_cast<double>(value));
  std::string short_text = text;
  for (const char* sign : {"e+0", "e+"})  // 3e+06 is written 3e6
    if (const std::size_t at = short_text.find(sign); at != std::string::npos)
      short_text.replace(at, std::strlen(sign), "e");
  return short_text;
}

TEST(RodMaterials, AreThoseOfTheGuide) {
  EXPECT_NE(refusal([] { rod_material("spaghetti"); }).find("bamboo"), std::string::npos);
  std::ifstream file(test::in_tree("docs/guide/rods.md"));
  std::ostringstream text;
  text << file.rdbuf();
  for (const RodMaterial& m : rod_materials()) {
    EXPECT_FALSE(m.source.empty());
    std::string row = "| " + m.name;
    for (const float value :
         {m.density, m.youngs_modulus, m.shear_modulus, m.damping, m.static_friction, m.kinetic_friction})
      row += " | " + number(value);
    EXPECT_NE(text.str().find(row + " |"), std::string::npos) << "docs/guide/rods.md should hold\n" << row;
  }
}

}  // namespace
}  // namespace pliant
