// Motion that is kept, and motion that is damped: the first modes of a spring, a bar, a cantilever and a rod, and the
// times of dampings. All rows are of the engine, in float, in frames of 1/60 s.
#include <cmath>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "apps/validate/rows.h"
#include "pliant/body.h"
#include "pliant/joint.h"
#include "pliant/rod.h"
#include "pliant/soft_body.h"

namespace pliant::validate {
namespace {

using Integrator = Settings::Integrator;

constexpr double motion_frame = 1. / 60;

/// An object that begins with the velocity of a mode, and its frequency [rad/s].
struct ModeOf {
  Scene scene;
  std::vector<Vec3f> shape;
  double omega = 1;
};

using ShapeAt = std::function<Vec3d(const Vec3f&)>;

/// The first object of a scene without gravity, with `speed` times the shape as its velocities; held where x is below
/// `held`.
ModeOf mode_of(Object object, double omega, double speed, double held, const ShapeAt& shape_at) {
  ModeOf mode;
  mode.omega = omega;
  mode.scene.gravity = {};
  mode.scene.settings.threads = 1;
  object.collides = object.self_collision = false;
  object.velocities.assign(object.positions.size(), {});
  mode.shape.resize(object.positions.size());
  std::vector<int> pins;
  for (std::size_t i = 0; i < object.positions.size(); ++i) {
    mode.shape[i] = to_float(shape_at(object.positions[i]));
    object.velocities[i] = mode.shape[i] * static_cast<float>(speed);
    if (static_cast<double>(object.positions[i].x) < held) pins.push_back(static_cast<int>(i));
  }
  mode.scene.add(std::move(object));
  if (!pins.empty()) mode.scene.pin(0, pins);
  return mode;
}

/// A body of 1 kg on a spring along x.
ModeOf spring_mode(double omega, double damping) {
  BodyOptions options;
  options.mass = 1;
  options.position = {1, 0, 0};
  Object object = make_body({{Sphere{0.1f}}}, options);
  add_joint(object, SpringJoint{.b = 0,
                                .anchor_b = {1, 0, 0},
                                .stiffness = static_cast<float>(omega * omega),
                                .damping = static_cast<float>(damping)});
  return mode_of(std::move(object), omega, 0.1, -1, [](const Vec3f& x) { return Vec3d{x.x > 0.5f ? 1. : 0., 0, 0}; });
}

double clamped_beam(double along) {
  constexpr double k = 1.875104, s = 0.734096;
  return (std::cosh(k * along) - std::cos(k * along) - s * (std::sinh(k * along) - std::sin(k * along))) / 2;
}

/// A bar of 1 m x 0.1 m x 0.1 m, lengthwise or, along the diagonal of its section, as a cantilever.
ModeOf bar_mode(double modulus, double damping, bool bends) {
  SoftBodyOptions options;
  options.material.youngs_modulus = static_cast<float>(modulus);
  options.material.poisson_ratio = 0.3f;
  options.material.damping = static_cast<float>(damping);
  const double speed = std::sqrt(modulus / 1000);
  const double omega = bends ? 3.51602 * speed * 0.1 / std::sqrt(12.) : pi / 2 * speed;
  return mode_of(make_soft_body(box_tetrahedra({1, 0.1f, 0.1f}, {10, 1, 1}), options), omega, 0.05, -0.4999,
                 [bends](const Vec3f& x) {
                   const double along = static_cast<double>(x.x) + 0.5, lift = clamped_beam(along);
                   return bends ? Vec3d{0, lift, lift} : Vec3d{std::sin(pi / 2 * along), 0, 0};
                 });
}

/// A clamped rod of 1 m, 1 cm thick to each side.
ModeOf rod_mode(double modulus, double damping) {
  RodOptions options;
  options.material.youngs_modulus = static_cast<float>(modulus);
  options.material.shear_modulus = static_cast<float>(0.35 * modulus);
  options.material.damping = static_cast<float>(damping);
  options.radius = 0.01f;
  options.start.kind = RodEnd::Kind::clamped;
  std::vector<Vec3f> points;
  for (int i = 0; i <= 16; ++i) points.push_back({static_cast<float>(i) / 16, 0, 0});
  return mode_of(make_rod(points, options), 3.51602 * 0.005 * std::sqrt(modulus / 1000), 0.1, -1, [](const Vec3f& x) {
    return Vec3d{0, clamped_beam(static_cast<double>(x.x)), 0};
  });
}

/// A mode's coordinate and its velocity, frame by frame.
struct Trace {
  std::vector<double> x, v;

  /// pi times the zeros over the time between them [rad/s].
  double omega(double guess) const {
    double first = -1, last = 0;
    int zeros = 0;
    for (std::size_t i = 1; i < x.size(); ++i) {
      if ((x[i - 1] < 0) == (x[i] < 0)) continue;
      last = static_cast<double>(i) - x[i] / (x[i] - x[i - 1]);
      if (zeros++ == 0) first = last;
    }
    return zeros < 3 ? guess : pi * (zeros - 1) / ((last - first) * motion_frame);
  }
  /// The mean amplitude of the period that begins at a time [s].
  double amplitude(double time, double omega) const {
    const auto first = static_cast<std::size_t>(std::lround(time / motion_frame)),
               period = static_cast<std::size_t>(std::lround(2 * pi / omega / motion_frame));
    double sum = 0;
    for (std::size_t i = first; i < first + period; ++i) sum += std::hypot(x[i], v[i] / omega);
    return sum / static_cast<double>(period);
  }
};

Trace trace_of(const ModeOf& mode, Integrator integrator, int substeps, double seconds) {
  Settings settings = mode.scene.settings;
  settings.integrator = integrator;
  settings.substeps = substeps;
  World world(mode.scene, settings);
  const std::vector<Vec3f> start = mode.scene.objects[0].positions;
  Trace trace;
  for (int frame = 0; frame <= std::lround(seconds / motion_frame); ++frame) {
    if (frame > 0) world.step(static_cast<float>(motion_frame));
    double x = 0, v = 0, squares = 0;
    for (std::size_t i = 0; i < start.size(); ++i) {
      const Vec3d shape = to_double(mode.shape[i]);
      x += dot(shape, to_double(world.object(0).positions()[i]) - to_double(start[i]));
      v += dot(shape, to_double(world.object(0).velocities()[i]));
      squares += dot(shape, shape);
    }
    trace.x.push_back(x / squares);
    trace.v.push_back(v / squares);
  }
  return trace;
}

void kept_rows(Result& result, const std::string& name, const ModeOf& mode, const std::string& note) {
  const auto kept = [&](Integrator integrator) {
    const Trace trace = trace_of(mode, integrator, 0, 13 * 2 * pi / mode.omega);
    const double omega = trace.omega(mode.omega);
    return trace.amplitude(10 * 2 * pi / omega, omega) / trace.amplitude(0, omega);
  };
  result.rows.push_back(at_least("motion: amplitude after ten periods, " + name, 0.5, kept(Integrator::pbd), "",
                                 note + ", default substeps"));
  result.rows.push_back(at_least("motion: the same with `energy`, " + name, 0.95, kept(Integrator::energy), "",
                                 note + ", default substeps, integrator energy"));
}

/// The rate at which an amplitude falls over a second, at three numbers of substeps; the farthest from omega^2 tau / 2.
void damped_rows(Result& result, const std::string& name, const ModeOf& mode, double tau, double tolerance,
                 const std::string& note) {
  std::vector<double> shares;
  for (const int substeps : {20, 40, 80}) {
    const Trace trace = trace_of(mode, Integrator::energy, substeps, 1 + 4 * pi / mode.omega);
    const double omega = trace.omega(mode.omega);
    shares.push_back(std::log(trace.amplitude(0, omega) / trace.amplitude(1, omega)) / (omega * omega * tau / 2));
  }
  result.rows.push_back(relative("motion: damping of " + name + ", its rate over omega^2 tau / 2", 1,
                                 farthest(1, shares), tolerance, "", note + "; farthest of 20, 40, 80 substeps"));
}

/// What is left of a body's speed along x, or of its spin about z, after a quarter of a second, as a rate over that of
/// its damper.
double decay(int substeps, const std::function<void(Object&)>& damp, bool spins) {
  BodyOptions options;
  options.mass = 2;
  options.velocity = {spins ? 0.f : 3.f, 0, 0};
  options.angular_velocity = {0, 0, spins ? 3.f : 0.f};
  Object object = make_body({{Sphere{0.1f}}}, options);
  damp(object);
  Scene scene = scene_with(std::move(object), 0, substeps, 1);
  World world(scene);
  for (int frame = 0; frame < 15; ++frame) world.step(static_cast<float>(motion_frame));
  const float left = spins ? world.object(0).angular_velocities()[0].z : world.object(0).velocities()[0].x;
  return std::log(3 / static_cast<double>(left)) / 0.25;
}

void decay_rows(Result& result) {
  constexpr double rate = 20, inertia = 0.4 * 2 * 0.01;  // [1/s], [kg m^2]
  const auto add = [&](const std::string& name, const std::function<void(Object&)>& damp, bool spins) {
    std::vector<double> rates;
    for (const int substeps : {4, 16, 64}) rates.push_back(decay(substeps, damp, spins));
    result.rows.push_back(relative("motion: rate of decay, " + name, rate, farthest(rate, rates), 1e-3, "1/s",
                                   "farthest of 4, 16, 64 substeps"));
  };
  add(
      "damping of an object", [](Object& o) { o.damping = rate; }, false);
  add(
      "damping of a slider", [](Object& o) { add_joint(o, SliderJoint{.b = 0, .damping = 2 * rate}); }, false);
  add(
      "damping of a hinge",
      [](Object& o) { add_joint(o, HingeJoint{.b = 0, .damping = static_cast<float>(rate * inertia)}); }, true);
}

}  // namespace

void motion_rows(Result& result, bool) {
  kept_rows(result, "spring joint", spring_mode(2 * pi, 0), "1 Hz");
  kept_rows(result, "bar", bar_mode(1e5, 0, false), "1 m, E = 1e5 Pa, nu = 0.3, 2.5 Hz");
  kept_rows(result, "cantilever", bar_mode(1e6, 0, true), "1 m x 0.1 m, E = 1e6 Pa, nu = 0.3");
  kept_rows(result, "rod", rod_mode(1e8, 0), "1 m, radius 1 cm, E = 1e8 Pa, 0.9 Hz");
  decay_rows(result);
  const double omega = 2 * pi, damping = 1;  // of 1 kg [N s/m]
  damped_rows(result, "a spring joint", spring_mode(omega, damping), damping / (omega * omega), 0.02,
              "1 Hz, tau = b / k");
  damped_rows(result, "a solid", bar_mode(1e5, 0.02, false), 0.02, 0.05, "bar of E = 1e5 Pa, 20 ms");
  damped_rows(result, "a rod", rod_mode(1e8, 0.02), 0.02, 0.05, "E = 1e8 Pa, 20 ms");
}

}  // namespace pliant::validate
