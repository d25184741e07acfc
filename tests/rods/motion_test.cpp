// Rods that move: frequencies, damping, what is kept, and what contact does to them.
#include <algorithm>
#include <cmath>
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

/// A signal once a frame: the mean period between its upward zeros, and the ratio of two peaks a period apart.
struct Swing {
  std::vector<double> values;

  double period() const {
    std::vector<double> zeros;
    for (std::size_t i = 1; i < values.size(); ++i)
      if (values[i - 1] < 0 && values[i] >= 0)
        zeros.push_back((static_cast<double>(i) - values[i] / (values[i] - values[i - 1])) * double(frame_time));
    return zeros.size() < 2 ? 0 : (zeros.back() - zeros.front()) / static_cast<double>(zeros.size() - 1);
  }
  /// The logarithmic decrement over all periods: ln(first peak / last peak) / periods between them.
  double decrement() const {
    std::vector<double> peaks;
    for (std::size_t i = 1; i + 1 < values.size(); ++i)
      if (values[i] > values[i - 1] && values[i] >= values[i + 1] && values[i] > 0) peaks.push_back(values[i]);
    return std::log(peaks.front() / peaks.back()) / static_cast<double>(peaks.size() - 1);
  }
};

Swing swing_of_a_clamped_rod(double e, double damping, int substeps, double seconds) {
  constexpr int segments = 20;
  RodMaterial material = material_of(e, 0.35 * e, 1000);
  material.damping = static_cast<float>(damping);
  Object rod = make_rod(line({0, 0, 0}, {1, 0, 0}, segments), clamped_rod(material, 0.01f));
  rod.velocities.assign(rod.positions.size(), {});
  for (int i = 0; i < segments; ++i) {  // close to the first mode
    const float x = (static_cast<float>(i) + 0.5f) / segments;
    rod.velocities[static_cast<std::size_t>(i)].y = 0.1f * x * x * (6 - 4 * x + x * x) / 3;
  }
  Lone lone(std::move(rod), substeps, false);
  Swing swing;
  for (int frame = 0; frame < static_cast<int>(seconds * 60); ++frame) {
    lone.run(1 / 60.);
    swing.values.push_back(lone.tip(segments).y);
  }
  return swing;
}

TEST(RodInMotion, SwingsAtTheFrequencyOfABeam) {
  constexpr double e = 1e9, radius = 0.01;
  const double omega = 3.51602 * std::sqrt(e * second_moment(radius) / (1000 * pi * radius * radius));
  EXPECT_NEAR(swing_of_a_clamped_rod(e, 0, 60, 4).period(), 2 * pi / omega, 0.01 * 2 * pi / omega);
}

TEST(RodInMotion, IsDampedByItsMaterial) {
  constexpr double e = 1e9, radius = 0.01, damping = 0.005;
  const double omega = 3.51602 * std::sqrt(e * second_moment(radius) / (1000 * pi * radius * radius));
  const double expected = pi * damping * omega;  // 2 pi times the damping ratio, omega tau / 2
  // Substeps of 0.17 ms lose omega h / 2 of critical damping themselves.
  EXPECT_NEAR(swing_of_a_clamped_rod(e, damping, 100, 2).decrement(), expected, 0.15 * expected);
}

TEST(RodInMotion, TwistsAsATorsionPendulum) {
  constexpr double g = 1e9, radius = 0.002, moment = 1e-3;
  constexpr int segments = 16;
  Object rod;
  rod.name = "pendulum";
  BodyOptions disc;
  disc.angular_velocity = {0, 1, 0};
  disc.inertia = BodyInertia{1, {}, {float(moment), float(moment), float(moment)}, {}};
  const int body = add_body(rod, {}, disc);
  RodOptions options = clamped_rod(material_of(2.6e9, g, 1000), static_cast<float>(radius));
  options.end = {RodEnd::Kind::clamped, body};
  add_rod(rod, line({0, 1, 0}, {0, 0, 0}, segments), options);
  const int frame_of_disc = rod.bodies[static_cast<std::size_t>(body)].frame;
  Lone lone(std::move(rod), 60);
  Swing swing;
  for (int frame = 0; frame < 600; ++frame) {
    lone.run(1 / 60.);
    const Quatf q = lone.world.object(0).orientations()[static_cast<std::size_t>(frame_of_disc)];
    swing.values.push_back(double(q.y * (q.w < 0 ? -1 : 1)));
  }
  const double expected = 2 * pi * std::sqrt(moment / (g * 2 * second_moment(radius)));
  EXPECT_NEAR(swing.period(), expected, 0.01 * expected);
}

/// Momentum, and angular momentum about the origin, of the bodies of an object whose frames are their principal axes.
struct Momenta {
  Vec3d linear, angular;
};

Momenta momenta_of(const Lone& lone) {
  const Object& object = lone.scene.objects[0];
  Momenta sum{};
  for (std::size_t i = 0; i < object.bodies.size(); ++i) {
    const int n = static_cast<int>(i);
    const Vec3d momentum = lone.velocity(n) * double(object.masses[i]);
    const Quatd q = normalise(convert<double>(lone.world.object(0).orientations()[i]));
    const Vec3d spin = rotate(conjugate(q), convert<double>(lone.world.object(0).angular_velocities()[i]));
    const Vec3d inertia = convert<double>(object.frames[i].inertia);
    sum.linear = sum.linear + momentum;
    sum.angular = sum.angular + cross(lone.position(n), momentum) +
                  rotate(q, Vec3d{inertia.x * spin.x, inertia.y * spin.y, inertia.z * spin.z});
  }
  return sum;
}

TEST(RodInMotion, KeepsItsMomentum) {
  constexpr int segments = 20;
  RodOptions options;
  options.material = material_of(1e8, 3.5e7, 1000);
  options.radius = 0.01f;
  Object rod = make_rod(line({0, 0, 0}, {1, 0, 0}, segments), options);
  rod.velocities.assign(rod.positions.size(), {});
  for (int i = 0; i < segments; ++i) {
    const float x = (static_cast<float>(i) + 0.5f) / segments - 0.5f;
    rod.velocities[static_cast<std::size_t>(i)] = {0, 4 * x * x + x, 2 * x};
  }
  Lone lone(std::move(rod), 20, false);
  const Momenta start = momenta_of(lone);
  lone.run(4);
  const Momenta end = momenta_of(lone);
  EXPECT_LT(std::sqrt(length_squared(end.linear - start.linear)), 1e-5 * std::sqrt(length_squared(start.linear)));
  EXPECT_LT(std::sqrt(length_squared(end.angular - start.angular)), 1e-3 * std::sqrt(length_squared(start.angular)));
}

/// Momenta after two seconds of free flight in 8 substeps, over those at first. The rod of steel begins to spin about
/// its middle at `spin` [rad/s], as if it were rigid.
std::pair<Momenta, Momenta> of_baton(int segments, float spin) {
  RodOptions options;
  options.material = rod_material("steel wire");
  options.material.damping = 0;
  Object rod = make_rod(line({-0.25f, 0, 0}, {0.25f, 0, 0}, segments), options);
  for (const Vec3f& p : rod.positions) rod.velocities.push_back({0.5f, spin * p.x, 0});
  for (auto& frame : rod.frames) frame.angular_velocity = {0, 0, spin};
  Lone lone(std::move(rod), 8, false);
  const Momenta start = momenta_of(lone);
  lone.run(2);
  return {start, momenta_of(lone)};
}

/// Pulls need stiffness, which has a torque on free rods (solver/bodies/free_tree.h): they kept 83, 33 and 61 %.
TEST(RodInMotion, KeepsItsAngularMomentumWhereItSpinsFast) {
  for (const auto& [segments, spin] : {std::pair{10, 20.f}, {10, 50.f}, {40, 10.f}}) {
    const auto [start, end] = of_baton(segments, spin);
    EXPECT_LT(length(end.angular - start.angular), 1e-3 * length(start.angular)) << segments << " segments, " << spin;
    EXPECT_LT(length(end.linear - start.linear), 1e-5 * length(start.linear)) << segments << " segments, " << spin;
  }
}

/// Many alike, which are solved side by side.
TEST(RodInMotion, KeepsItsAngularMomentumBesideOthers) {
  Object rods;
  for (int i = 0; i < 7; ++i) {
    RodOptions options;
    options.name = "rod " + std::to_string(i);
    options.material = rod_material("steel wire");
    const float x = 2 * static_cast<float>(i);
    add_rod(rods, line({x, 0, 0}, {x + 0.5f, 0, 0}, 10), options);
  }
  rods.velocities.clear();
  for (const Vec3f& p : rods.positions) {
    const float x = p.x - 2 * std::floor(p.x / 2);
    rods.velocities.push_back({0, 30 * (x - 0.25f), 0});
  }
  Lone lone(std::move(rods), 8, false);
  const Vec3d start = momenta_of(lone).angular;
  lone.run(2);
  EXPECT_LT(length(momenta_of(lone).angular - start), 2e-3 * length(start));
}

TEST(RodInMotion, ThatIsStraightWithoutLoadSpringsOpen) {
  constexpr int segments = 24;
  std::vector<Vec3f> points;
  for (int i = 0; i <= segments; ++i) {
    const double angle = 1.5 * pi * i / segments;
    points.push_back(convert<float>(Vec3d{0.2 * std::cos(angle), 0.2 * std::sin(angle), 0}));
  }
  RodOptions options;
  options.material = material_of(1e7, 3.5e6, 1000);
  options.straight = true;
  Object rod = make_rod(points, options);
  rod.damping = 4;
  Lone lone(std::move(rod), 20, false);
  lone.run(8);
  const double length = 0.2 * 1.5 * pi * (segments - 1) / segments;
  EXPECT_NEAR(std::sqrt(length_squared(lone.position(segments - 1) - lone.position(0))), length, 0.002 * length);
}

/// The names of all joints that break in so many frames.
std::vector<std::string> broken_in(World& world, int frames) {
  std::vector<std::string> names;
  for (int frame = 0; frame < frames; ++frame)
    for (const JointBreak& one : world.step(frame_time).broken_joints) names.push_back(one.name);
  return names;
}

TEST(RodInMotion, BreaksWhereItCarriesTooMuch) {
  RodOptions options = clamped_rod(material_of(1e9, 3.5e8, 1000), 0.005f);
  options.break_force = 20;
  Object rod = make_rod(line({0, 1, 0}, {0, 0, 0}, 10), options);
  BodyOptions weight;
  weight.mass = 5;
  weight.position = {0, -0.05f, 0};
  BallJoint joint;
  joint.a = 9;
  joint.b = add_body(rod, {{Sphere{0.05f}}}, weight);
  add_joint(rod, joint);
  const int ball = rod.bodies[static_cast<std::size_t>(joint.b)].particle;
  Lone lone(std::move(rod));
  EXPECT_EQ(broken_in(lone.world, 30), std::vector<std::string>{"rod start"}) << "the top carries most";
  EXPECT_LT(lone.position(ball).y, -0.5);
}

/// Two wires hang side by side on the world by `kind`, with a weight on each.
Object weights_on_wires(RodEnd::Kind kind) {
  Object object;
  for (const float x : {0.f, 0.5f}) {
    BodyOptions weight;
    weight.mass = 10;
    weight.position = {x, -0.55f, 0};
    RodOptions options;
    options.name = x > 0 ? "b" : "a";
    options.material = rod_material("steel wire");
    options.radius = 0.002f;
    options.break_force = 93;
    options.start = {kind, -1};
    options.end = {kind, add_body(object, {{Sphere{0.05f}}}, weight)};
    add_rod(object, line({x, 0, 0}, {x, -0.5f, 0}, 10), options);
  }
  return object;
}

TEST(RodInMotion, BreaksAtOneJoint) {
  for (const RodEnd::Kind kind : {RodEnd::Kind::clamped, RodEnd::Kind::ball}) {
    Lone lone(weights_on_wires(kind));
    const std::vector<std::string> both{"a start", "b start"};
    EXPECT_EQ(broken_in(lone.world, 60), both) << "each wire by itself";
  }
}

TEST(RodInMotion, BreaksWhereItIsWeakest) {
  Object object = weights_on_wires(RodEnd::Kind::clamped);
  for (ObjectJoint& joint : object.joints)
    if (joint.name == "a 6-7" || joint.name == "b 2-3") joint.break_force = 80;
  Lone lone(std::move(object));
  const std::vector<std::string> both{"a 6-7", "b 2-3"};
  EXPECT_EQ(broken_in(lone.world, 60), both);
}

TEST(RodInMotion, DoesNotPushItselfApartWhereItBreaks) {
  RodOptions options = clamped_rod(material_of(1e9, 3.5e8, 1000), 0.01f);
  options.break_force = 3;  // its own weight pulls it apart near the top
  Object rod = make_rod(line({0, 1, 0}, {0, 0, 0}, 10), options);
  Scene scene;
  scene.add(rod);
  World world(scene);
  std::size_t broken = 0;
  for (int frame = 0; frame < 20; ++frame) {
    const Report report = world.step(frame_time);
    EXPECT_TRUE(report.warnings.empty()) << report.explain();
    broken += report.broken_joints.size();
  }
  EXPECT_GT(broken, 0u);
  EXPECT_GT(world.object(0).velocities()[9].y, -9.9f * 20 / 60);  // falls, and is not thrown
}

TEST(RodInMotion, OfAHairBendsAsItDoesInFineSubsteps) {
  const auto at_rest = [](int substeps) {
    Object hair = make_rod(line({0, 0, 0}, {0.1f, 0, 0}, 20), clamped_rod(rod_material("hair"), 4e-5f));
    hair.damping = 3;
    Lone lone(std::move(hair), substeps);
    lone.run(4);
    return lone.tip(20);
  };
  const Vec3d fine = at_rest(40);
  EXPECT_LT(fine.y, -0.05);
  for (const int substeps : {1, 4, 10})
    EXPECT_LT(std::sqrt(length_squared(at_rest(substeps) - fine)), 0.001) << substeps;
}

/// A rod that hangs in a steady wind comes to rest where drag and weight are in equilibrium.
TEST(RodInWind, HangsAtTheAngleOfItsDrag) {
  constexpr int segments = 12;
  constexpr double radius = 0.005, speed = 2, density = 40, air = 1.2, drag = 1.2;
  RodOptions options;
  options.material = material_of(1e5, 4e4, density);
  options.radius = float(radius);
  options.start.kind = RodEnd::Kind::ball;
  Scene scene;
  Object rod = make_rod(line({0, 1, 0}, {0, 0, 0}, segments), options);
  rod.damping = 1;
  rod.collides = rod.self_collision = false;
  scene.add(std::move(rod));
  scene.wind.velocity = {float(speed), 0, 0};
  scene.wind.air_density = float(air);
  World world(scene);
  for (int frame = 0; frame < 900; ++frame) ASSERT_TRUE(world.step(frame_time).ok());
  // Drag acts across the rod: rho/2 c 2r (v cos a)^2 = (rho_rod pi r^2 g) sin a at each segment, so the rod is
  // straight.
  const double weight = density * pi * radius * radius * gravity, full = air * drag * radius * speed * speed;
  const double angle = std::asin((std::sqrt(weight * weight + 4 * full * full) - weight) / (2 * full));
  const std::vector<Vec3f> x = world.object(0).positions();
  const Vec3d along = convert<double>(x[segments - 1]) - convert<double>(x[0]);
  EXPECT_NEAR(std::atan2(along.x, -along.y), angle, 0.02 * angle);
}

}  // namespace
}  // namespace pliant
