// Tests warnings about a scene: folded surfaces, layers at distance 0, bounds of substeps without effect.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pliant/body.h"
#include "pliant/gas.h"
#include "pliant/joint.h"
#include "pliant/liquid.h"
#include "pliant/mesh.h"
#include "pliant/scene.h"
#include "pliant/substep_bounds.h"

namespace pliant {
namespace {

/// A sheet of 1 m x 1 m, 11 x 11 vertices, at a height.
TriangleMesh sheet(float height) {
  TriangleMesh mesh = grid_mesh(11, 11, 1, 1);
  for (Vec3f& p : mesh.positions) p.y = height;
  return mesh;
}

/// The text of all findings of which message or advice contains `words`.
std::string finding(const Scene& scene, const std::string& words) {
  std::string text;
  for (const Finding& found : inspect(scene)) {
    const std::string whole = found.message + "; " + found.advice;
    if (whole.find(words) != std::string::npos) text += whole + "\n";
  }
  return text;
}

/// A liquid of 5 x 5 x 5 particles from a height on.
Object drop(const std::string& name, float height, float spacing) {
  return make_liquid(fill_box({0, height, 0}, {5 * spacing, height + 5 * spacing, 5 * spacing}, spacing),
                     {.name = name, .fluid = {.spacing = spacing}});
}

TEST(InspectScene, NamesParticlesThatStartWithinOneAnother) {
  const auto doubt = [](float height) {
    Scene scene;
    scene.add(drop("water", 0, 0.01f));
    scene.add(drop("oil", height, 0.012f));
    return finding(scene, "let fills not overlap");
  };
  EXPECT_EQ(doubt(0.05f), "");
  const std::string words = doubt(0.02f);
  EXPECT_NE(words.find("starts within half the distance at rest of another one"), std::string::npos) << words;
  EXPECT_NE(words.find("of 'water'"), std::string::npos) << words;
}

TEST(InspectScene, NamesParticlesThatStartInSolids) {
  const auto doubt = [](float height) {
    Scene scene;
    scene.add(drop("water", height, 0.01f));
    scene.add(Collider{.name = "floor", .shape = Plane{}});
    return finding(scene, "let a fill leave out solids");
  };
  EXPECT_EQ(doubt(0), "");  // half a spacing above the floor
  EXPECT_NE(doubt(-0.015f).find("50 particles start inside 'floor'"), std::string::npos) << doubt(-0.015f);
}

TEST(InspectScene, NamesEmittersThatShoot) {
  const auto doubt = [](float flow) {
    LiquidOptions options{.fluid = {.spacing = 0.01f}, .capacity = 1000};
    options.flow.emitters.push_back({.radius = 0.02f, .flow = flow});
    Scene scene;
    scene.add(make_liquid({}, options));
    return finding(scene, "m/s for its flow");
  };
  EXPECT_EQ(doubt(0.001f), "");
  EXPECT_NE(doubt(1).find("a litre a second is 0.001"), std::string::npos) << doubt(1);
}

/// The check of a mesh names a fold, so that of a scene must too.
TEST(InspectScene, NamesFoldsOfWhatCollidesWithItself) {
  TriangleMesh mesh = sheet(0);
  for (Vec3f& p : mesh.positions) p.x = -std::abs(p.x);
  Scene scene;
  scene.add_cloth(mesh, {});
  EXPECT_EQ(finding(scene, "folds the surface back"), "") << "it has no contact with itself";
  scene.objects[0].self_collision = true;
  scene.objects[0].thickness = 0.01f;
  const std::string text = finding(scene, "folds the surface back");
  EXPECT_NE(text.find(" and 9 more"), std::string::npos) << text;
  const std::vector<Finding> of_mesh = inspect(mesh);
  EXPECT_TRUE(std::any_of(of_mesh.begin(), of_mesh.end(), [](const Finding& found) {
    return found.message.find("10 edges fold the surface back") != std::string::npos;
  }));
}

TEST(InspectScene, SaysOnWhichSideContactHoldsAtDistanceZero) {
  Scene scene;
  scene.add_cloth(sheet(0), {});
  scene.objects[0].collides = true;
  scene.objects[0].thickness = 0.01f;
  MeshCollider floor;
  floor.name = "floor";
  floor.mesh = sheet(0);
  scene.add(floor);
  EXPECT_NE(finding(scene, "held on the side of the normals"), "");
  EXPECT_EQ(finding(scene, "pushes it away"), "");
  scene.mesh_colliders[0].mesh = sheet(-0.005f);
  EXPECT_EQ(finding(scene, "held on the side of the normals"), "");
  EXPECT_NE(finding(scene, "pushes it away"), "");
}

TEST(InspectScene, OffersSubstepsInsteadOfBoundsOnlyWhereNoneAreNamed) {
  Scene scene;
  scene.add_cloth(sheet(0), {});
  scene.settings.sweep = Sweep::tiled;  // its substeps do not follow the State
  scene.settings.least_substeps = 8;
  EXPECT_NE(finding(scene, "has no effect").find("name substeps instead"), std::string::npos);
  scene.settings.substeps = 20;
  EXPECT_NE(finding(scene, "has no effect").find("because the scene names substeps; remove it\n"), std::string::npos);
}

TEST(InspectScene, BoundsUpToTheLargestIntDoNotOverflow) {
  constexpr int largest = std::numeric_limits<int>::max();
  Settings settings;
  settings.least_substeps = largest;
  EXPECT_FALSE(error_of_bounds(settings)) << "no upper bound, so no pair to refuse";
  settings.most_substeps = largest;
  const std::optional<Error> error = error_of_bounds(settings);
  ASSERT_TRUE(error) << "no multiple of four lies between";
  EXPECT_NE(error->advice().find("increase most_substeps to 2147483648"), std::string::npos) << error->advice();
  settings.least_substeps = largest - 3;
  EXPECT_FALSE(error_of_bounds(settings));
}

/// A body is free by nature; a particle in no constraint beside it is not.
TEST(InspectScene, DoesNotCallFreeBodiesLooseParticles) {
  Scene scene;
  Object object = make_body({{Sphere{0.1f}}}, {.name = "ball"});
  add_body(object, {{Sphere{0.1f}}}, {.name = "left", .position = {1, 0, 0}});
  add_body(object, {{Sphere{0.1f}}}, {.name = "right", .position = {2, 0, 0}});
  add_joint(object, BallJoint{.a = 1, .b = 2, .anchor = {1.5f, 0, 0}});
  scene.add(object);
  EXPECT_EQ(finding(scene, "moves freely"), "");
  scene.objects[0].positions.push_back({5, 0, 0});
  scene.objects[0].masses.push_back(1);
  EXPECT_NE(finding(scene, "moves freely").find("particle 3"), std::string::npos) << finding(scene, "moves freely");
}

TEST(InspectScene, NamesTheBodyWhoseInertiaIsTooSmall) {
  Scene scene;
  scene.add(make_body({{Sphere{1e-5f}}}, {.name = "dust"}));
  const std::string text = finding(scene, "moments of inertia");
  EXPECT_NE(text.find("object 'dust', body 0 'dust'"), std::string::npos) << text;
  EXPECT_NE(text.find("outside 1e-20 to 1e20"), std::string::npos) << text;
}

TEST(InspectScene, NamesBodiesThatShareAName) {
  Scene scene;
  Object object = make_body({{Sphere{0.1f}}}, {.name = "ball"});
  add_body(object, {{Sphere{0.1f}}}, {.position = {1, 0, 0}});
  add_body(object, {{Sphere{0.1f}}}, {.position = {2, 0, 0}});
  scene.add(object);
  EXPECT_EQ(finding(scene, "has the name"), "") << "bodies without a name of their own share the default";
  add_body(scene.objects[0], {{Sphere{0.1f}}}, {.name = "ball", .position = {3, 0, 0}});
  const std::string text = finding(scene, "has the name");
  EXPECT_NE(text.find("object 'ball', body 3 'ball': has the name of body 0"), std::string::npos) << text;
}

/// A ball of 0.1 m that hangs on a hinge from the world.
Scene hung(const Vec3f& anchor) {
  Scene scene;
  Object object = make_body({{Sphere{0.1f}}}, {.name = "bob"});
  add_joint(object, HingeJoint{.b = 0, .anchor = anchor, .options = {.name = "pivot"}});
  scene.add(object);
  return scene;
}

TEST(InspectScene, NamesAnAnchorFarFromWhatItHolds) {
  EXPECT_EQ(finding(hung({0, 5, 0}), "anchor"), "") << "a long pendulum is none";
  const std::string text = finding(hung({0, 50, 0}), "anchor");
  EXPECT_NE(text.find("joint 'pivot': has its anchor 50 m from the centre of body 'bob'"), std::string::npos) << text;
}

/// A platform that a pin lifts, as users make lifts before they find "kinematic".
TEST(InspectScene, DoubtsABodyThatAPinMovesButALoadTips) {
  const auto doubt = [](const auto& change) {
    Object lift = make_body({{Box{{0.5f, 0.05f, 0.5f}}}}, {.name = "platform"});
    lift.pins.push_back({0, {{{0}, {2, {0, 0.5f, 0}}}}});
    change(lift);
    Scene scene;
    scene.add(lift);
    return finding(scene, "\"kinematic\": true");
  };
  const std::string text = doubt([](Object&) {});
  EXPECT_NE(text.find("body 0 'platform': is moved by a pin"), std::string::npos) << text;
  EXPECT_NE(text.find("a load tips it"), std::string::npos) << text;
  EXPECT_EQ(doubt([](Object& lift) { lift.pins[0].motion.keyframes[1].rotation = rotation({0, 1, 0}, 90); }), "");
  EXPECT_EQ(doubt([](Object& lift) { lift.frames[0].angular_velocity = {0, 1, 0}; }), "") << "a wheel";
  EXPECT_EQ(doubt([](Object& lift) { lift.collides = lift.self_collision = false; }), "") << "nothing loads it";
  EXPECT_EQ(doubt([](Object& lift) { lift.pins[0].motion = {}; }), "") << "it may be a see-saw";
  EXPECT_EQ(doubt([](Object& lift) {
              const Motion motion = lift.pins[0].motion;
              lift = make_body({{Box{{0.5f, 0.05f, 0.5f}}}}, {.kinematic = true, .motion = motion});
            }),
            "");
}

TEST(InspectScene, SaysThatDampingOfRigidConstraintsHasNoEffect) {
  const auto doubt = [](float compliance) {
    Object object;
    object.name = "door";
    const int door = add_body(object, {{.shape = Box{{0.5f, 1, 0.05f}}}}, {});
    HingeJoint hinge{.a = -1, .b = door, .anchor = {-0.5f, 0, 0}, .axis = {0, 1, 0}};
    hinge.options.compliance = compliance;
    hinge.options.damping = 0.5f;
    add_joint(object, hinge);
    Scene scene;
    scene.objects = {object};
    return finding(scene, "has no effect, because they are rigid");
  };
  EXPECT_NE(doubt(0).find("damping"), std::string::npos);
  EXPECT_EQ(doubt(1e-4f), "");
}

TEST(InspectScene, DoubtsBreakForcesThatRoundingHides) {
  const auto doubt = [](float compliance, float break_force, int substeps) {
    Object object;
    object.positions = {{0, 0, 0}, {0, -0.5f, 0}};
    object.masses = {std::numeric_limits<float>::infinity(), 1};
    ConstraintGroup link;
    link.type = "distance";
    link.particles = {0, 1};
    link.stiffness = Stiffness::compliance(compliance);
    link.break_force = break_force;
    object.constraints = {link};
    Scene scene;
    scene.settings.substeps = substeps;
    scene.add(object);
    return finding(scene, "rounding changes their force");
  };
  EXPECT_EQ(doubt(1e-9f, 5, 20), "") << "the multiplier tells it";
  EXPECT_EQ(doubt(1e-5f, 0.2f, 1000), "") << "the elongation tells it";
  EXPECT_NE(doubt(1e-9f, 0.2f, 20).find("break at 0.2 N"), std::string::npos);
  EXPECT_NE(doubt(1e-9f, 5, 1000).find("fewer substeps"), std::string::npos);
}

TEST(InspectScene, TakesAnchorsAnywhereOnTheAxisOfASlider) {
  Scene scene;
  Object bead = make_body({{Sphere{0.005f}}}, {.name = "bead", .position = {1, 0, 0}});
  add_joint(bead, SliderJoint{.b = 0});
  scene.add(bead);
  EXPECT_EQ(finding(scene, "anchor"), "");
  Object far = make_body({{Sphere{0.005f}}}, {.name = "far"});
  add_joint(far, SliderJoint{.b = 0, .anchor = {0, 1e6f, 0}});
  scene.objects = {far};
  EXPECT_NE(finding(scene, "anchor").find("has its anchor 1e+06 m from the centre of body 'far'"), std::string::npos);
}

TEST(InspectScene, DoubtsATargetFarFromWhatIsAttached) {
  const auto doubt = [](float height) {
    Object object = make_cloth(sheet(0));
    object.attachments = {{.particle = 3, .target = {0, height, 0}}};
    Scene scene;
    scene.add(object);
    return finding(scene, "attachment");
  };
  EXPECT_EQ(doubt(1), "");
  EXPECT_NE(doubt(1e6f).find("attachment 0: has its target more than 10 km from its particle"), std::string::npos);
}

TEST(InspectScene, SurvivesJointsOfBodiesThatDoNotExist) {
  Scene scene = hung({});
  scene.objects[0].joints[0].a = -1;
  EXPECT_EQ(finding(scene, "anchor"), "");
  scene.objects[0].joints[0].b = 7;
  EXPECT_EQ(finding(scene, "anchor"), "");
}

TEST(InspectScene, NamesGearsWithoutBearings) {
  Scene scene;
  Object object = make_body({{Sphere{0.1f}}}, {.name = "sun"});
  const int planet = add_body(object, {{Sphere{0.1f}}}, {.name = "planet", .position = {0.2f, 0, 0}});
  add_joint(object, GearJoint{.a = 0, .b = planet});
  add_joint(object, HingeJoint{.b = 0, .anchor = {}});
  scene.add(object);
  const std::string text = finding(scene, "no other joint guides");
  EXPECT_NE(text.find("body 'planet'"), std::string::npos) << text;
  EXPECT_EQ(text.find("body 'sun'"), std::string::npos) << text;
  add_joint(scene.objects[0], HingeJoint{.b = planet, .anchor = {0.2f, 0, 0}});
  EXPECT_EQ(finding(scene, "no other joint guides"), "");
}

/// An object with a distance and, in group 1, a constraint on its first particles: as many as `type` takes.
Scene element(const std::string& type, const std::vector<Vec3f>& positions, std::vector<float> rest = {}) {
  Object object;
  object.name = "one";
  object.positions = positions;
  object.masses.assign(positions.size(), 1);
  ConstraintGroup length, group;
  length.type = "distance";
  length.particles = {0, 1};
  object.constraints.push_back(length);
  group.type = type;
  group.particles = {0, 1, 2};
  group.rest = std::move(rest);
  if (positions.size() == 4) group.particles.push_back(3);
  object.constraints.push_back(std::move(group));
  Scene scene;
  scene.add(std::move(object));
  return scene;
}

TEST(InspectScene, NamesConstraintsOnFlatElements) {
  const std::vector<Vec3f> flat{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}},
      solid{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const char* type :
       {"tetrahedron_shear", "corotational_strain", "green_strain", "green_trace", "tetrahedron_volume", "fibre"}) {
    const std::string text = finding(element(type, flat), "in one plane at rest");
    EXPECT_NE(text.find("object 'one', constraint group 1, " + std::string(type) + " constraint 0: "),
              std::string::npos)
        << text;
    EXPECT_EQ(finding(element(type, solid), "constraint group"), "") << type;
  }
  const std::vector<Vec3f> line{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, triangle{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
  for (const char* type : {"triangle_stretch", "triangle_shear"}) {
    const std::string text = finding(element(type, line), "on one line at rest");
    EXPECT_NE(text.find("object 'one', constraint group 1, " + std::string(type) + " constraint 0: "),
              std::string::npos)
        << text;
    EXPECT_EQ(finding(element(type, triangle), "constraint group"), "") << type;
  }
}

/// Where no edge lies along a yarn, its stretch is that of triangles, which yield by 1.25 s with s = Y h^2 / (2 rho
/// e^2) on squares of edges e; so does shear with s = G h^2 / (rho e^2).
TEST(InspectScene, DoubtsWovenClothThatYieldsTooMuch) {
  const auto doubt = [](const Vec3f& warp, int substeps, float stiffness, float shear = 0) {
    Scene scene;
    ClothOptions options{.name = "sheet", .stretch_model = ClothOptions::Stretching::woven, .warp = warp};
    options.material.area_density = 0.2f;
    options.material.stretch_stiffness = stiffness;
    options.material.shear_stiffness = shear;
    scene.add_cloth(grid_mesh(11, 81, 0.125f, 1), options);
    scene.settings.substeps = substeps;
    return finding(scene, "woven so finely");
  };
  EXPECT_EQ(doubt({0, 0, 1}, 20, 200), "");
  EXPECT_EQ(doubt({0.1f, 0, 1}, 150, 200), "");
  EXPECT_EQ(doubt({0.1f, 0, 1}, 20, 2), "");
  EXPECT_EQ(doubt({0.1f, 0, 1}, 0, 200), "") << "substeps follow the triangles by default";
  const std::string yarns = doubt({0.1f, 0, 1}, 20, 200);  // s = 200 x 6400 / (2 x 0.2 x 1200^2), and 3 s at borders
  EXPECT_NE(yarns.find("with 20 substeps yarns that no edge lies along stretch about "), std::string::npos) << yarns;
  EXPECT_NE(yarns.find("edges along the yarns"), std::string::npos) << yarns;
  const std::string shears = doubt({0, 0, 1}, 20, 200, 100);  // s = 100 x 6400 / (0.2 x 1200^2)
  EXPECT_NE(shears.find("with 20 substeps it shears about 3"), std::string::npos) << shears;
  EXPECT_EQ(shears.find("edges along the yarns"), std::string::npos) << shears;
}

TEST(InspectScene, NamesElementsWhoseRestDataAreZero) {
  const std::vector<Vec3f> flat{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  EXPECT_NE(finding(element("fibre", flat, {1, 0, 0, 0}), "has rest data of 0"), "");
  EXPECT_NE(finding(element("tetrahedron_volume", flat, {0}), "has rest data of 0"), "");
  EXPECT_EQ(finding(element("tetrahedron_volume", flat, {0.5f}), "constraint group"), "") << "it starts pressed flat";
}

/// A ball of rubber sheet with a volume.
Scene balloon(float radius, const Volume& volume) {
  ClothOptions options{.name = "ball", .material = fabric("rubber sheet"), .volume = volume};
  TriangleMesh mesh = sphere_mesh(2);
  for (Vec3f& p : mesh.positions) p = p * radius;
  Scene scene;
  scene.add_cloth(mesh, options);
  return scene;
}

TEST(InspectScene, NamesVolumesThatJumpAtTheStart) {
  const auto doubt = [](float radius, const Volume& volume) { return finding(balloon(radius, volume), "jumps"); };
  EXPECT_EQ(doubt(0.2f, {.pressure = 1.4f}), "");
  EXPECT_EQ(doubt(10, {.pressure = 1}), "");
  EXPECT_EQ(doubt(10, {.keyframes = {{0, 1}, {1, 1.3f}}}), "");
  EXPECT_EQ(doubt(10, {.pressure = 1.3f, .stiffness = Stiffness::compliance(1)}), "") << "it yields";
  const std::string text = doubt(10, {.pressure = 1.3f});
  EXPECT_NE(text.find("object 'ball', volume: has a pressure of 1.3"), std::string::npos) << text;
  EXPECT_NE(text.find("{\"time\": 1, \"pressure\": 1.3}"), std::string::npos) << text;
  EXPECT_NE(doubt(1, {.pressure = 0.5f}), "");
  EXPECT_NE(doubt(10, {.keyframes = {{0, 1.3f}}}), "");
}

/// Water of 1 m depth, 30 cm wide.
Scene water() {
  Scene scene;
  LiquidOptions options;
  options.name = "water";
  options.fluid.spacing = 0.05f;
  scene.add(make_liquid(fill_box({}, {0.3f, 1, 0.3f}, 0.05f), options));
  return scene;
}

TEST(InspectScene, DoubtsNumbersOfNoKnownMatter) {
  const auto of_liquid = [](float density, float viscosity) {
    Scene scene = water();
    scene.objects[0].fluid->density = density;
    scene.objects[0].fluid->viscosity = viscosity;
    return finding(scene, "object 'water', fluid, ");
  };
  EXPECT_EQ(of_liquid(1000, 0.001f), "");
  EXPECT_EQ(of_liquid(13534, 1e6f), "");
  const std::string both = of_liquid(1e-6f, 1e6f);
  EXPECT_NE(both.find("fluid, density: is 1e-06 kg/m^3, less than that of air"), std::string::npos) << both;
  EXPECT_NE(both.find("fluid, viscosity: is 1e+06 Pa s at a density of 1e-06 kg/m^3"), std::string::npos) << both;
  const auto of_gas = [](float temperature) {
    GasOptions options;
    options.name = "smoke";
    options.fluid.spacing = 0.1f;
    options.gas.temperature = temperature;
    Scene scene;
    scene.add(make_gas(fill_box({}, {0.3f, 0.3f, 0.3f}, 0.1f), options));
    return finding(scene, "gas, temperature");
  };
  EXPECT_EQ(of_gas(2000), "");
  EXPECT_NE(of_gas(1e9f).find("is 1e+09 K, hotter than the surface of the sun"), std::string::npos) << of_gas(1e9f);
  EXPECT_NE(of_gas(20).find("20 degrees Celsius are 293.15"), std::string::npos) << of_gas(20);
}

TEST(InspectScene, SaysThatWindDoesNotPushLiquids) {
  Scene scene = water();
  EXPECT_EQ(finding(scene, "wind"), "");
  scene.wind.velocity = {5, 0, 0};
  scene.wind.air_density = 1.2f;
  EXPECT_NE(finding(scene, "object 'water'").find("is not pushed by the wind"), std::string::npos);
}

TEST(InspectScene, SaysThatTracersAreNeverEmitted) {
  TracersOptions smoke;
  smoke.tracers.start = 2;
  smoke.capacity = 10;
  const auto found = [&](float end) {
    smoke.tracers.end = end;
    Scene scene;
    scene.add(make_tracers(smoke));
    return finding(scene, "none are emitted");
  };
  EXPECT_NE(found(1), "");
  EXPECT_NE(found(2), "");
  EXPECT_EQ(found(3), "");
  EXPECT_EQ(found(0), "");
}

TEST(InspectScene, SaysHowFarTooFewSubstepsCompressALiquid) {
  Scene scene = water();
  EXPECT_EQ(finding(scene, "denser"), "");
  const int chosen = chosen_substeps(scene).front();
  scene.settings.substeps = chosen;
  EXPECT_EQ(finding(scene, "denser"), "");
  scene.settings.substeps = chosen / 4;
  scene.settings.sweep = Sweep::tiled;
  const std::string text = finding(scene, "denser than at rest on average");
  EXPECT_NE(text.find("use " + std::to_string(chosen)), std::string::npos) << text;
  EXPECT_EQ(finding(scene, "like rubber"), "") << "of a liquid";
  scene.add_cloth(sheet(3), {});
  EXPECT_NE(finding(scene, "like rubber"), "") << "of the cloth beside it";
}

/// The case of a report, 1e6 : 1: frames took up to 0.8 s without a word.
TEST(InspectScene, NamesSheetsThatAreFarHeavierThanThoseTheyPressOn) {
  const auto doubt = [](float ratio, bool collides) {
    Scene scene;
    for (const float height : {0.f, 0.2f}) {
      Object cloth = make_cloth(sheet(height));
      cloth.name = height > 0 ? "upper" : "lower";
      cloth.collides = collides;
      for (float& mass : cloth.masses) mass *= height > 0 ? ratio : 1;
      scene.add(cloth);
    }
    return finding(scene, "on which it can press");
  };
  EXPECT_EQ(doubt(1e3f, true), "");
  EXPECT_EQ(doubt(1e6f, false), "");
  const std::string text = doubt(1e6f, true);
  EXPECT_NE(text.find("are 1e+06 times those of 'lower'"), std::string::npos) << text;
  EXPECT_NE(text.find("`most_substeps` bounds what frames take"), std::string::npos) << text;
}

/// The first `plain_iterations` of a substep are not accelerated.
TEST(InspectScene, NamesAnAccelerationThatNeverBegins) {
  Scene scene;
  scene.objects.push_back(make_rope({{0, 0, 0}, {0.1f, 0, 0}, {0.2f, 0, 0}}));
  scene.settings.sweep_options.acceleration = SweepOptions::Acceleration::chebyshev;
  scene.settings.iterations = 10;
  EXPECT_NE(finding(scene, "acceleration: has no effect: a substep has 10 iterations, and the first 10 are plain"), "");
  scene.settings.iterations = 11;
  EXPECT_EQ(finding(scene, "has no effect"), "");
}

}  // namespace
}  // namespace pliant
