// Rods at rest, against the mechanics of beams, columns, shafts and springs.
#include <string>
#include <utility>
#include <vector>

#include "math/quat.h"
#include "pliant/body.h"
#include "pliant/joint.h"
#include "rods/rod_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// Sag of the free end of a horizontal rod 1 m long under its own weight, over that of Euler and Bernoulli's beam, q
/// L^4 / (8 E I).
double sag(int segments, int substeps) {
  constexpr double e = 1e9, density = 1000;
  constexpr float radius = 0.01f;
  Object rod = make_rod(line({0, 0, 0}, {1, 0, 0}, segments), clamped_rod(material_of(e, 3.5e8, density), radius));
  rod.damping = 5;
  Lone lone(std::move(rod), substeps);
  lone.run(12);
  const double area = pi * double(radius) * double(radius), load = density * area * gravity;
  return -lone.tip(segments).y / (load / (8 * e * second_moment(double(radius))));
}

TEST(RodAtRest, SagsAsABeamTheMoreSegmentsTheCloser) {
  EXPECT_NEAR(sag(8, 20), 1, 0.016);
  EXPECT_NEAR(sag(16, 20), 1, 0.004);
  EXPECT_NEAR(sag(32, 20), 1, 0.0025);
}

TEST(RodAtRest, IsAsStiffWhateverTheSubsteps) {
  const double expected = sag(16, 40);
  for (const int substeps : {1, 4, 15}) EXPECT_NEAR(sag(16, substeps), expected, 0.001 * expected) << substeps;
}

/// A cantilever that tapers: its sag is the integral of M(x) x / (E I(x)), x being the distance from the tip.
TEST(RodAtRest, ThatTapersSagsByTheIntegralOfItsMoments) {
  constexpr double e = 1e9, density = 1000, thick = 0.01, thin = 0.004;
  const auto radius = [](double x) { return thin + (thick - thin) * x; };
  double expected = 0, weight = 0, moment = 0;
  constexpr int steps = 100000;
  for (int i = 0; i < steps; ++i) {
    const double x = (i + 0.5) / steps;
    moment += weight / steps;
    weight += density * pi * radius(x) * radius(x) * gravity / steps;
    expected += moment * x / (e * second_moment(radius(x))) / steps;
  }
  for (const bool thick_first : {true, false}) {
    RodOptions options;
    options.material = material_of(e, 3.5e8, density);
    options.radius = static_cast<float>(thick_first ? thick : thin);
    options.end_radius = static_cast<float>(thick_first ? thin : thick);
    (thick_first ? options.start : options.end).kind = RodEnd::Kind::clamped;
    const Object made = make_rod(line({0, 0, 0}, {1, 0, 0}, 32), options);
    Object rod = made;
    rod.damping = 5;
    Lone lone(std::move(rod));
    lone.run(12);
    const int last = thick_first ? 31 : 0, before = thick_first ? 30 : 1;
    const double tip = lone.position(last).y + (lone.position(last).y - lone.position(before).y) * 0.5;
    EXPECT_NEAR(-tip, expected, 0.01 * expected) << thick_first;
  }
}

TEST(RodAtRest, OfSteelHeldAtBothEndsSagsAsABeam) {
  constexpr double length = 0.3, radius = 0.001;
  const RodMaterial& steel = rod_material("steel wire");
  for (const int segments : {20, 100}) {
    RodOptions options = clamped_rod(steel, float(radius));
    options.end = options.start;
    Object rod = make_rod(line({0, 0, 0}, {float(length), 0, 0}, segments), options);
    rod.damping = 5;
    Lone lone(std::move(rod));
    lone.run(3);
    const double load = double(steel.density) * pi * radius * radius * gravity;
    const double expected =
        load * length * length * length * length / (384 * double(steel.youngs_modulus) * second_moment(radius));
    const double middle = (lone.position(segments / 2 - 1).y + lone.position(segments / 2).y) / 2;
    EXPECT_NEAR(-middle, expected, 0.06 * expected) << segments;
  }
}

/// Mattiasson 1981, table 1: a clamped beam with a load P across its free end. Displacements over the length.
struct Elastica {
  double load;  ///< P L^2 / (E I)
  double down, back;
};

TEST(RodAtRest, BendsFarAsTheElasticaDoes) {
  constexpr double e = 1e8;
  constexpr float radius = 0.005f;
  constexpr int segments = 40;
  for (const Elastica& row :
       {Elastica{1, 0.30172, 0.05643}, {2, 0.49346, 0.16064}, {5, 0.71379, 0.38763}, {10, 0.81061, 0.55500}}) {
    Object rod = make_rod(line({0, 0, 0}, {1, 0, 0}, segments), clamped_rod(material_of(e, 3.5e7, 0.1), radius));
    BodyOptions weight;
    weight.position = {1, 0, 0};
    weight.mass = static_cast<float>(row.load * e * second_moment(double(radius)) / gravity);
    const int ball = add_body(rod, {{Sphere{0.02f}}}, weight);
    BallJoint joint;
    joint.a = segments - 1;
    joint.b = ball;
    joint.anchor = {1, 0, 0};
    add_joint(rod, joint);
    rod.damping = 4;
    Lone lone(std::move(rod));
    lone.run(15);
    const Vec3d tip = lone.tip(segments);
    EXPECT_NEAR(-tip.y, row.down, 0.004) << row.load;
    EXPECT_NEAR(1 - tip.x, row.back, 0.004) << row.load;
  }
}

/// Where the top of a vertical column of 1 m is sideways after a push, with a load that is this share of Euler's, pi^2
/// E I / (4 L^2).
double sideways(double share) {
  constexpr double e = 1e9;
  constexpr float radius = 0.01f;
  constexpr int segments = 24;
  Object rod = make_rod(line({0, 0, 0}, {0, 1, 0}, segments), clamped_rod(material_of(e, 3.5e8, 0.1), radius));
  BodyOptions weight;
  weight.position = {0, 1, 0};
  weight.mass = static_cast<float>(share * pi * pi / 4 * e * second_moment(double(radius)) / gravity);
  weight.velocity = {0.02f, 0, 0};
  const int ball = add_body(rod, {{Sphere{0.02f}}}, weight);
  BallJoint joint;
  joint.a = segments - 1;
  joint.b = ball;
  joint.anchor = {0, 1, 0};
  add_joint(rod, joint);
  rod.damping = 1;
  Lone lone(std::move(rod));
  lone.run(20);
  return std::fabs(lone.tip(segments).x);
}

TEST(RodAtRest, BucklesAtEulersLoad) {
  EXPECT_LT(sideways(0.96), 0.01);
  EXPECT_GT(sideways(1.04), 0.2);
}

TEST(RodAtRest, OfACoilIsASpring) {
  constexpr double wire = 0.001, coil = 0.03, turns = 8;
  constexpr int segments = 192;
  RodOptions options = clamped_rod(material_of(2e11, 7.9e10, 7850), static_cast<float>(wire));
  Object spring = make_rod(helix(float(coil), -0.2f, float(turns), segments), options);
  BodyOptions weight;
  weight.mass = 0.5f;
  weight.position = {0, -0.25f, 0};
  const int ball = add_body(spring, {{Sphere{0.03f}}}, weight);
  FixedJoint joint;
  joint.a = segments - 1;
  joint.b = ball;
  joint.anchor = {float(coil), -0.2f, 0};
  add_joint(spring, joint);
  spring.damping = 4;
  Lone lone(std::move(spring), 10);
  lone.run(8);
  const double d = 2 * wire, diameter = 2 * coil;
  const double stiffness = 7.9e10 * d * d * d * d / (8 * diameter * diameter * diameter * turns);
  const double own = 7850 * pi * wire * wire * 2 * pi * coil * turns;  // half of the wire's weight counts
  EXPECT_NEAR(-0.25 - lone.position(ball).y, (0.5 + own / 2) * gravity / stiffness, 0.03 * 0.5 * gravity / stiffness);
}

/// A pin that does not turn holds the centre of a body alone; joints of such a body are solved with the others.
TEST(RodAtRest, IsNotPulledOffABodyWhoseCentreIsPinned) {
  Object object;
  object.name = "hanging";
  const int hook = add_body(object, {{Box{{0.05f, 0.05f, 0.05f}}}}, {.name = "hook", .position = {0, 0.5f, 0}}),
            ball = add_body(object, {{Sphere{0.05f}}}, {.name = "ball", .position = {0, 0.04f, 0}, .mass = 3});
  RodOptions options = clamped_rod(rod_material("steel wire"), 0.002f);
  options.start.body = hook;
  options.end = {RodEnd::Kind::clamped, ball};
  std::vector<Vec3f> points = helix(0.03f, -0.35f, 8, 160);
  for (Vec3f& p : points) p.y += 0.44f;
  const int first = add_rod(object, points, options);
  object.pins.push_back({object.bodies[static_cast<std::size_t>(hook)].particle, {}});
  const Vec3f start = object.positions[static_cast<std::size_t>(first)];
  Lone lone(std::move(object), 8);
  for (int frame = 0; frame < 30; ++frame) {
    lone.run(1 / 60.);
    EXPECT_LT(std::sqrt(length_squared(lone.position(first) - convert<double>(start))), 0.004);  // 138 mm before
  }
}

/// A ring in the plane y = 0 that starts and ends in the middle of a side, so that both ends point the same way.
std::vector<Vec3f> ring_points(int sides, double radius) {
  std::vector<Vec3f> points;
  for (int i = 0; i <= sides + 1; ++i) {
    const double corner = 2 * pi * (i - 0.5) / sides;
    const bool is_end = i == 0 || i == sides + 1;
    const Vec3d at = is_end ? Vec3d{radius * std::cos(pi / sides), 0, 0}
                            : Vec3d{radius * std::cos(corner), 0.001 * std::sin(2 * corner), radius * std::sin(corner)};
    points.push_back(convert<float>(at));
  }
  return points;
}

/// Turns slowly about z, by an angle that may be above half a turn.
Motion turning(const Vec3f& pivot, double angle) {
  constexpr int keys = 16;
  Motion motion;
  motion.pivot = pivot;
  for (int i = 0; i <= keys; ++i) {
    const double half = angle * i / keys / 2;
    Keyframe key;
    key.time = static_cast<float>(i);
    key.rotation = {0, 0, static_cast<float>(std::sin(half)), static_cast<float>(std::cos(half))};
    motion.keyframes.push_back(key);
  }
  return motion;
}

/// How far a ring of a straight rod leaves its plane when one end is twisted against the other by this share of
/// 2 pi sqrt(3) E I / (G J) (Michell 1889, Zajac 1962).
double rise(double share) {
  constexpr int sides = 48;
  constexpr double e = 1e7;
  const std::vector<Vec3f> points = ring_points(sides, 0.5);
  RodOptions options = clamped_rod(material_of(e, e / 2, 1000), 0.01f);  // G J = E I
  options.straight = true;
  Object ring;
  ring.name = "ring";
  BodyOptions hand;
  hand.name = "hand";
  hand.position = points.back();
  hand.inertia = BodyInertia{1, {}, {1, 1, 1}, {}};
  options.end = {RodEnd::Kind::clamped, add_body(ring, {}, hand)};
  add_rod(ring, points, options);
  ring.pins.push_back({ring.bodies[0].particle, turning(points.back(), share * 2 * pi * std::sqrt(3.))});
  ring.damping = 2;
  Lone lone(std::move(ring), 10, false);
  double most = 0;
  for (int second = 0; second < 45; ++second) {
    lone.run(1);
    for (int i = 1; i <= sides; ++i) most = std::max(most, std::fabs(lone.position(i).y));
  }
  return most;
}

TEST(RodAtRest, OfARingBucklesAtMichellsTwist) {
  EXPECT_LT(rise(0.97), 0.06);  // 0.04 of it from the start, when it springs open
  EXPECT_GT(rise(1.03), 0.2);
}

}  // namespace
}  // namespace pliant
