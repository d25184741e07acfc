// Rigid bodies in joints against closed forms: a compound pendulum, a top, a four-bar linkage. All rows are of the
// engine, in float, in frames of 1/60 s.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "apps/validate/rows.h"
#include "pliant/body.h"
#include "pliant/joint.h"

namespace pliant::validate {
namespace {

constexpr double mechanism_frame = 1. / 60;

/// Substeps of a frame: steps of 1/480 to 1/2400 s.
constexpr std::array<int, 3> all_substeps{8, 20, 40};

Quatf rotation_about(const Vec3d& axis, double angle) {
  const Vec3f v = to_float(axis * std::sin(angle / 2));
  return {v.x, v.y, v.z, static_cast<float>(std::cos(angle / 2))};
}

/// A body's axis in the world.
Vec3d axis_of(const Quatf& rotation, const Vec3d& axis) {
  const double x = rotation.x, y = rotation.y, z = rotation.z, w = rotation.w;
  const Vec3d v{x, y, z}, t = cross(v, axis) * 2.0;
  return axis + t * w + cross(v, t);
}

/// A World of one object with gravity along -y.
World world_of(const Object& object, int substeps) {
  Scene scene;
  scene.gravity = {0, static_cast<float>(-standard_gravity), 0};
  scene.settings.threads = 1;
  scene.settings.substeps = substeps;
  scene.add(object);
  return World(scene);
}

double energy(const World& world) { return world.measure().kinetic_energy() + world.measure().potential_energy(); }

// ------------------------------------------------------------------------------------------------ compound pendulum

constexpr double rod = 1, rod_thickness = 0.1;

/// A rod on a hinge at its upper end, an angle from hanging.
Object pendulum(double angle) {
  BodyOptions options;
  options.position = to_float({rod / 2 * std::sin(angle), -rod / 2 * std::cos(angle), 0});
  options.rotation = rotation_about({0, 0, 1}, angle);
  options.mass = 2;
  const float half = static_cast<float>(rod_thickness / 2);
  Object object = make_body({{Box{{half, static_cast<float>(rod / 2), half}}}}, options);
  add_joint(object, HingeJoint{.b = 0, .anchor = {0, 0, 0}, .axis = {0, 0, 1}});
  return object;
}

/// 2 pi sqrt(I / (m g l)) over the arithmetic-geometric mean of 1 and cos(amplitude / 2) [s].
double pendulum_period(double amplitude) {
  const double inertia = (rod * rod + rod_thickness * rod_thickness) / 12 + rod * rod / 4;  // for each kilogram
  double a = 1, b = std::cos(amplitude / 2);
  for (int i = 0; i < 40; ++i) {
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return 2 * pi * std::sqrt(inertia / (standard_gravity * rod / 2)) / a;
}

/// What a pendulum does in 10 s: its mean period [s], and how its energy where it turns back differs at most from that
/// of the start, as a share of what it had above hanging. Elsewhere an integrator of first order shows an energy that
/// is off by h v F / 2.
struct Swing {
  double period = 0, energy = 0;
};

Swing swing(double amplitude, int substeps) {
  World world = world_of(pendulum(amplitude), substeps);
  const double start = energy(world), scale = 2 * standard_gravity * rod / 2 * (1 - std::cos(amplitude));
  Swing result;
  std::vector<double> passages, energies;
  struct Moment {
    double x, spin, energy;
  } before{std::sin(amplitude), 0, start};
  for (int frame = 1; frame <= 600; ++frame) {
    world.step(static_cast<float>(mechanism_frame));
    const Moment now{world.object(0).positions()[0].x, world.object(0).angular_velocities()[0].z, energy(world)};
    if ((now.x < 0) != (before.x < 0)) passages.push_back((frame - now.x / (now.x - before.x)) * mechanism_frame);
    if (frame > 1 && (now.spin < 0) != (before.spin < 0)) {
      const double turns = before.spin / (before.spin - now.spin);
      energies.push_back((before.energy + (now.energy - before.energy) * turns - start) / scale);
    }
    before = now;
  }
  result.energy = farthest(0, energies);
  if (passages.size() > 1)
    result.period = 2 * (passages.back() - passages.front()) / static_cast<double>(passages.size() - 1);
  return result;
}

void compound_rows(Result& result, int substeps) {
  for (const double degrees : {30., 90., 150.}) {
    const double amplitude = degrees * pi / 180;
    const Swing found = swing(amplitude, substeps);
    const std::string what =
        " of a compound pendulum of " + brief(degrees) + " degrees, " + brief(substeps) + " substeps";
    result.rows.push_back(relative("mechanisms: engine, period" + what, pendulum_period(amplitude), found.period, 5e-3,
                                   "s", "rod of 1 m on a hinge; mean of 10 s; complete elliptic integral"));
    result.rows.push_back(absolute("mechanisms: engine, change of energy" + what, 0, found.energy, 1e-3, "-",
                                   "of that above hanging; farthest at a turning point in 10 s"));
  }
}

// ------------------------------------------------------------------------------------------------ top

/// A disc on a massless axle that stands on its tip.
struct Top {
  static constexpr double radius = 0.3, half_width = 0.05, arm = 0.5, mass = 1;
  static constexpr double axial = mass * radius * radius / 2,
                          transverse =
                              mass * (3 * radius * radius + 4 * half_width * half_width) / 12 + mass * arm * arm;
  double tilt = 0, spin = 0;  ///< angle from upright [rad], angular velocity about the axle [rad/s]

  /// The slower of both regular precessions [rad/s]: I3 w3 W - I1 W^2 cos(tilt) = m g l, of which m g l / (I3 w3) is
  /// the limit.
  double precession() const {
    const double l = axial * spin, c = transverse * std::cos(tilt), moment = mass * standard_gravity * arm;
    return 2 * moment / (l + std::sqrt(l * l - 4 * c * moment));
  }
};

Object object_of(const Top& top) {
  const Vec3d axle{std::sin(top.tilt), std::cos(top.tilt), 0};
  const double w = top.precession();
  // The part of the precession along the axle is part of the spin.
  const Vec3d spin = axle * (top.spin - w * std::cos(top.tilt)) + Vec3d{0, w, 0};
  BodyOptions options;
  options.position = to_float(axle * Top::arm);
  options.rotation = rotation_about({0, 0, 1}, -top.tilt);
  options.mass = static_cast<float>(Top::mass);
  options.angular_velocity = to_float(spin);
  options.velocity = to_float(cross(spin, axle * Top::arm));
  const Cylinder disc{static_cast<float>(Top::radius), static_cast<float>(Top::half_width)};
  Object object = make_body({{disc}}, options);
  add_joint(object, BallJoint{.b = 0, .anchor = {0, 0, 0}});
  return object;
}

/// The mean precession of a top over 4 s [rad/s], and the greatest change of its tilt [rad].
std::pair<double, double> precess(const Top& top, int substeps) {
  World world = world_of(object_of(top), substeps);
  double angle = 0, before = 0, nutation = 0;
  for (int frame = 0; frame < 240; ++frame) {
    world.step(static_cast<float>(mechanism_frame));
    const Vec3d x = to_double(world.object(0).positions()[0]);
    const double now = std::atan2(-x.z, x.x);
    angle += std::remainder(now - before, 2 * pi);
    before = now;
    nutation = std::max(nutation, std::fabs(std::atan2(std::hypot(x.x, x.z), x.y) - top.tilt));
  }
  return {angle / (240 * mechanism_frame), nutation};
}

void top_rows(Result& result, int substeps) {
  for (const double degrees : {90., 60., 20.}) {
    const Top top{degrees * pi / 180, 60};
    const auto [rate, nutation] = precess(top, substeps);
    const std::string what = " of a top at " + brief(degrees) + " degrees, " + brief(substeps) + " substeps";
    const double simple = Top::mass * standard_gravity * Top::arm / (Top::axial * top.spin);
    result.rows.push_back(relative("mechanisms: engine, precession" + what, top.precession(), rate, 5e-3, "rad/s",
                                   "60 rad/s, mean of 4 s; m g l / (I3 w3) is " + brief(simple)));
    result.rows.push_back(
        at_most("mechanisms: engine, nutation" + what, 5e-3, nutation, "rad", "a regular precession has none"));
  }
}

// ------------------------------------------------------------------------------------------------ four-bar linkage

/// Ground, crank, coupler and rocker [m]; the crank is the shortest, so it can turn all the way (Grashof).
constexpr double ground_link = 2, crank_link = 0.5, coupler_link = 1.8, rocker_link = 1.5;

/// Where the pins of crank and rocker are while the crank has an angle: the closed form of Freudenstein's equation. The
/// linkage is open, so the rocker's pin is above the coupler.
struct Pins {
  Vec3d crank, rocker;
};

Pins pins_at(double angle) {
  const Vec3d pin{crank_link * std::cos(angle), crank_link * std::sin(angle), 0}, pivot{ground_link, 0, 0},
      d = pivot - pin;
  const double distance = length(d),
               along = (coupler_link * coupler_link - rocker_link * rocker_link + distance * distance) / (2 * distance);
  const Vec3d u = d * (1 / distance), across{-u.y, u.x, 0};
  return {pin, pin + u * along + across * std::sqrt(coupler_link * coupler_link - along * along)};
}

int add_bar(Object& object, const Vec3d& from, const Vec3d& to) {
  BodyOptions options;
  options.name = "bar " + brief(static_cast<double>(object.bodies.size()));
  options.position = to_float((from + to) * 0.5);
  options.rotation = rotation_about({0, 0, 1}, std::atan2(to.y - from.y, to.x - from.x));
  options.mass = 1;
  return add_body(object, {{Box{{static_cast<float>(length(to - from) / 2), 0.03f, 0.03f}}}}, options);
}

/// A linkage whose crank a motor drives at 3 rad/s.
Object linkage() {
  const Pins pins = pins_at(1);
  Object object;
  const int first = add_bar(object, {}, pins.crank), middle = add_bar(object, pins.crank, pins.rocker),
            last = add_bar(object, pins.rocker, {ground_link, 0, 0});
  HingeJoint driven{.b = first, .anchor = {0, 0, 0}};
  driven.motor = JointMotor{.kind = JointMotor::Kind::speed, .target = 3, .most = 500};
  add_joint(object, driven);
  add_joint(object, HingeJoint{.a = first, .b = middle, .anchor = to_float(pins.crank)});
  add_joint(object, HingeJoint{.a = middle, .b = last, .anchor = to_float(pins.rocker)});
  add_joint(object, HingeJoint{.b = last, .anchor = {static_cast<float>(ground_link), 0, 0}});
  return object;
}

/// The farthest that the middle of the coupler is, in 5 s, from where the angle of the crank puts it [m].
double coupler_error(int substeps) {
  const Object object = linkage();
  World world = world_of(object, substeps);
  double error = 0;
  for (int frame = 0; frame < 300; ++frame) {
    world.step(static_cast<float>(mechanism_frame));
    const Vec3d along = axis_of(world.object(0).orientations()[0], axis_of(object.bodies[0].axes, {1, 0, 0}));
    const Pins pins = pins_at(std::atan2(along.y, along.x));
    error = std::max(error, length(to_double(world.object(0).positions()[1]) - (pins.crank + pins.rocker) * 0.5));
  }
  return error;
}

}  // namespace

void mechanism_rows(Result& result, bool) {
  for (const int substeps : all_substeps) compound_rows(result, substeps);
  for (const int substeps : all_substeps) top_rows(result, substeps);
  for (const int substeps : all_substeps)
    result.rows.push_back(
        absolute("mechanisms: engine, coupler of a four-bar linkage, " + brief(substeps) + " substeps", 0,
                 coupler_error(substeps), 1e-3 * ground_link, "m",
                 "farthest from Freudenstein's equation in 5 s; 1e-3 of the ground link of 2 m"));
}

}  // namespace pliant::validate
