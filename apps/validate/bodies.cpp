// Rigid bodies: a tumbling body, friction, impacts, stacks. All rows are of the engine, in float, with its default
// substeps.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "apps/validate/rows.h"
#include "pliant/body.h"

namespace pliant::validate {
namespace {

double length_of(const Vec3f& v) { return std::sqrt(static_cast<double>(length_squared(v))); }

BodyOptions at(const Vec3f& position, const Vec3f& velocity = {}) {
  BodyOptions options;
  options.position = position;
  options.velocity = velocity;
  return options;
}

/// A ground, and gravity that is turned by an angle towards x as on an incline.
Scene with_ground(double friction, double restitution = 0, double degrees = 0) {
  Scene scene;
  const double angle = degrees * pi / 180;
  scene.gravity = {static_cast<float>(standard_gravity * std::sin(angle)),
                   static_cast<float>(-standard_gravity * std::cos(angle)), 0};
  scene.settings.threads = 1;
  Collider ground;
  ground.static_friction = ground.kinetic_friction = static_cast<float>(friction);
  ground.restitution = static_cast<float>(restitution);
  scene.add(ground);
  return scene;
}

Object with_friction(Object object, double friction) {
  object.static_friction = object.kinetic_friction = static_cast<float>(friction);
  return object;
}

void run(World& world, int frames) {
  for (int i = 0; i < frames; ++i) world.step(frame_time);
}

// ------------------------------------------------------------------------------------------------ tumbling

/// Half of the period of a body with principal moments of inertia 1, 2 and 3 that starts at w = (0.01, 1, 0): 2 K(k) /
/// rate, with the complete elliptic integral by the arithmetic-geometric mean (Landau and Lifshitz, Mechanics, section
/// 37).
double tumbling_half_period() {
  const double twice_energy = 1e-4 + 2, squared = 1e-4 + 4;  // 2 E and L^2
  const double rate = std::sqrt((3 * twice_energy - squared) / 6),
               k_squared = (squared - twice_energy) / (3 * twice_energy - squared);
  double a = 1, b = std::sqrt(1 - k_squared);
  for (int i = 0; i < 40; ++i) {
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return pi / (a * rate);
}

/// The time at which the third angular velocity of such a body returns to zero [s].
double measured_half_period(int substeps) {
  Scene scene;
  scene.gravity = {};
  scene.settings.threads = 1;
  scene.settings.substeps = substeps;
  BodyOptions options;
  options.mass = 1;
  Object body = make_body({{Box{}}}, options);
  body.frames[0].inertia = {1, 2, 3};
  body.frames[0].angular_velocity = {0.01f, 1, 0};
  scene.add(body);
  World world(scene);
  double before = 0;
  for (int frame = 1; frame < 1800; ++frame) {
    world.step(frame_time);
    const auto now = static_cast<double>(world.state().frames.angular_velocities[0].z);
    if (frame > 60 && (now < 0) != (before < 0)) return (frame - now / (now - before)) / 60;
    before = now;
  }
  return 0;
}

void tumbling_rows(Result& result) {
  const double expected = tumbling_half_period();
  for (const int substeps : {1, 10, 40})
    result.rows.push_back(relative("bodies: engine, half-period of a tumbling body, " + brief(substeps) + " substeps",
                                   expected, measured_half_period(substeps), 1e-3, "s",
                                   "I = (1, 2, 3) kg m^2, w = (0.01, 1, 0) rad/s, frames of 1/60 s, float"));
}

// ------------------------------------------------------------------------------------------------ friction

Vec3f slid(double degrees, double speed, int frames) {
  Scene scene = with_ground(0.6, 0, degrees);
  scene.add(with_friction(make_body({{Box{}}}, at({0, 0.5f, 0}, {static_cast<float>(speed), 0, 0})), 0.6));
  World world(scene);
  run(world, frames);
  return world.object(0).positions()[0];
}

/// The fastest speed after a frame of a box that friction holds [m/s].
double fastest_on_incline() {
  Scene scene = with_ground(0.9, 0, 40);
  scene.add(with_friction(make_body({{Box{}}}, at({0, 0.5f, 0})), 0.9));
  World world(scene);
  double fastest = 0;
  for (int i = 0; i < 30; ++i) {
    world.step(frame_time);
    fastest = std::max(fastest, length_of(world.object(0).velocities()[0]));
  }
  return fastest;
}

/// Where a solid is after it has been pushed along x for 2 s, on a plane or on a flat mesh with edges every 0.3 m.
Vec3f pushed(const SolidShape& shape, bool is_on_mesh) {
  Scene scene = with_ground(0.1);
  if (is_on_mesh) {
    scene.colliders.clear();
    MeshCollider ground;
    ground.mesh = grid_mesh(61, 21, 18, 6);
    ground.static_friction = ground.kinetic_friction = 0.1f;
    scene.add(ground);
  }
  scene.add(with_friction(make_body({{shape}}, at({0.07f, 0.5f, 0.05f}, {3, 0, 0.2f})), 0.1));
  World world(scene);
  run(world, 120);
  return world.object(0).positions()[0];
}

void body_mesh_rows(Result& result) {
  const std::vector<std::pair<std::string, SolidShape>> solids{{"box", Box{}}, {"ball", Sphere{}}};
  for (const auto& [name, shape] : solids)
    result.rows.push_back(at_most("bodies: engine, " + name + " on a flat mesh, from where it would be on a plane",
                                  1e-3, length_of(pushed(shape, true) - pushed(shape, false)), "m",
                                  "3 m/s, friction 0.1, after 4 m, edges every 0.3 m"));
}

void body_friction_rows(Result& result) {
  double slips = 0;
  for (double degrees = 30; degrees < 32 && slips == 0; degrees += 0.05)
    if (std::fabs(static_cast<double>(slid(degrees, 0, 300).x)) > 0.02) slips = degrees;
  auto& rows = result.rows;
  rows.push_back(absolute("bodies: engine, incline on which a box slips", std::atan(0.6) * 180 / pi, slips, 0.3,
                          "degrees", "friction 0.6; moves by 2 cm within 5 s"));
  rows.push_back(at_most("bodies: engine, creep of a box on an incline of 29 degrees", 1e-3,
                         std::fabs(static_cast<double>(slid(29, 0, 600).x)), "m", "friction 0.6, 10 s"));
  rows.push_back(at_most("bodies: engine, speed of a box that begins at rest on an incline of 40 degrees", 1e-3,
                         fastest_on_incline(), "m/s", "friction 0.9, half a second"));
  const double a = standard_gravity * (std::sin(40 * pi / 180) - 0.6 * std::cos(40 * pi / 180));
  rows.push_back(relative("bodies: engine, way of a box on an incline of 40 degrees", a * 2,
                          static_cast<double>(slid(40, 0, 120).x), 1e-2, "m",
                          "friction 0.6, 2 s: (g sin - mu g cos) t^2 / 2"));
  rows.push_back(relative("bodies: engine, stopping distance of a box", 9 / (2 * 0.6 * standard_gravity),
                          static_cast<double>(slid(0, 3, 120).x), 1e-2, "m", "3 m/s, friction 0.6: v^2 / (2 mu g)"));
}

// ------------------------------------------------------------------------------------------------ impacts

/// The height to which a body rises after its first impact, of a fall by 2 m [m].
double bounce(const SolidShape& shape, double restitution, int substeps) {
  Scene scene = with_ground(0.3, restitution);
  scene.settings.substeps = substeps;
  scene.add(make_body({{shape}}, at({0, 2.5f, 0})));
  World world(scene);
  double height = 0;
  bool has_bounced = false;
  for (int i = 0; i < 120; ++i) {
    world.step(frame_time);
    const auto y = static_cast<double>(world.object(0).positions()[0].y),
               v = static_cast<double>(world.object(0).velocities()[0].y);
    if (has_bounced && v < 0) break;
    has_bounced = has_bounced || v > 0;
    if (has_bounced) height = std::max(height, y - 0.5 + v * v / (2 * standard_gravity));
  }
  return height;
}

/// The velocities of balls in a row after the first has hit the second at 1 m/s, in zero gravity.
std::vector<double> after_impact(const std::vector<double>& densities, double restitution, double gap) {
  Scene scene;
  scene.gravity = {};
  scene.settings.threads = 1;
  Object row;
  row.name = "row";
  for (std::size_t i = 0; i < densities.size(); ++i) {
    const double x = static_cast<double>(i) * (1 + gap) - (i == 0 ? 0.5 : 0);
    add_body(row, {{Sphere{0.5f}, {}, {}, static_cast<float>(densities[i])}},
             at({static_cast<float>(x), 0, 0}, {i == 0 ? 1.f : 0.f, 0, 0}));
  }
  row.restitution = static_cast<float>(restitution);
  scene.add(row);
  World world(scene);
  run(world, 90);
  std::vector<double> speeds;
  for (const Vec3f& v : world.object(0).velocities()) speeds.push_back(static_cast<double>(v.x));
  return speeds;
}

void body_impact_rows(Result& result) {
  auto& rows = result.rows;
  for (const double e : {1., 0.8, 0.5}) {
    const std::string what = ", restitution " + brief(e), note = "falls by 2 m; ";
    rows.push_back(relative("bodies: engine, bounce of a ball" + what, 2 * e * e, bounce(Sphere{}, e, 0), 0.02, "m",
                            note + "default substeps"));
    rows.push_back(relative("bodies: engine, bounce of a ball" + what, 2 * e * e, bounce(Sphere{}, e, 40), 0.005, "m",
                            note + "40 substeps"));
    rows.push_back(relative("bodies: engine, bounce of a flat box" + what, 2 * e * e, bounce(Box{}, e, 0), 0.02, "m",
                            note + "default substeps"));
  }
  const std::vector<double> pair = after_impact({1000, 3000}, 0.5, 0.1);
  rows.push_back(absolute("bodies: engine, impact on a ball of three times the mass, first", -0.125, pair[0], 0.005,
                          "m/s", "1 m/s, restitution 0.5"));
  rows.push_back(absolute("bodies: engine, impact on a ball of three times the mass, second", 0.375, pair[1], 0.005,
                          "m/s", "1 m/s, restitution 0.5"));
  for (const double gap : {0., 0.001, 0.1}) {
    const std::vector<double> cradle = after_impact({1000, 1000, 1000, 1000, 1000}, 1, gap);
    rows.push_back(absolute("bodies: engine, last ball of Newton's cradle, gaps of " + brief(gap) + " m", 1,
                            cradle.back(), 0.01, "m/s", "1 m/s; five balls of 1 m, restitution 1"));
    rows.push_back(absolute("bodies: engine, first ball of Newton's cradle, gaps of " + brief(gap) + " m", 0,
                            cradle.front(), 0.01, "m/s", "likewise"));
  }
}

// ------------------------------------------------------------------------------------------------ rest

/// How far the top of a stack of boxes has sunk, and the fastest speed, after some frames.
struct Rest {
  double sunk = 0, speed = 0;
};

Rest stack(const std::vector<float>& sizes, const std::vector<float>& densities, int substeps, int frames) {
  Scene scene = with_ground(0.6);
  scene.settings.substeps = substeps;
  Object pile;
  pile.name = "stack";
  float top = 0;
  std::vector<float> heights;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const float half = 0.5f * sizes[i];
    add_body(pile, {{Box{{half, half, half}}, {}, {}, densities[i]}}, at({0, top + half, 0}));
    heights.push_back(top + half);
    top += sizes[i];
  }
  scene.add(with_friction(pile, 0.6));
  World world(scene);
  run(world, frames);
  Rest rest;
  const std::vector<Vec3f> x = world.object(0).positions();
  for (std::size_t i = 0; i < x.size(); ++i) rest.sunk = std::max(rest.sunk, length_of(x[i] - Vec3f{0, heights[i], 0}));
  for (const Vec3f& v : world.object(0).velocities()) rest.speed = std::max(rest.speed, length_of(v));
  return rest;
}

/// The force that contacts with the ground exert on a box of 1000 kg after 2 s [N].
double resting_force() {
  Scene scene = with_ground(0.6);
  scene.add(make_body({{Box{}}}, at({0, 0.5f, 0})));
  World world(scene);
  run(world, 120);
  double force = 0;
  for (const BodyContact& contact : world.state().body_contacts)
    for (int i = 0; i < contact.count; ++i)
      force += static_cast<double>(contact.impulse[static_cast<std::size_t>(i)]) / static_cast<double>(contact.substep);
  return force;
}

Row stack_row(const std::string& what, const std::vector<float>& sizes, const std::vector<float>& densities,
              int substeps, double bound = 0.01) {
  const Rest rest = stack(sizes, densities, substeps, 600);
  const std::string how = substeps == 0 ? "default substeps" : brief(substeps) + " substeps";
  return at_most("bodies: engine, " + what, bound, rest.sunk, "m",
                 how + "; farthest that a box has moved after 10 s; fastest " + brief(rest.speed) + " m/s");
}

void rest_rows(Result& result) {
  auto& rows = result.rows;
  rows.push_back(relative("bodies: engine, force under a box at rest", 1000 * standard_gravity, resting_force(), 1e-3,
                          "N", "1000 kg, after 2 s"));
  rows.push_back(stack_row("box on one a hundredth as heavy", {1, 1}, {1000, 1e5f}, 0));
  rows.push_back(stack_row("box on one a thousandth as heavy", {1, 1}, {1000, 1e6f}, 32));
  std::vector<float> ten(11, 1000.f);
  ten.back() = 1e6f;
  rows.push_back(stack_row("box on ten a thousandth as heavy", std::vector<float>(11, 1.f), ten, 128));
  // Six doublings, 1:262144, stand at no number of substeps up to 512.
  const std::array<int, 3> substeps{32, 64, 256};
  for (std::size_t i = 0; i < substeps.size(); ++i) {
    std::vector<float> sizes;
    for (std::size_t k = 0; k < i + 4; ++k) sizes.push_back(0.1f * static_cast<float>(1 << k));
    rows.push_back(stack_row("stack of " + brief(static_cast<double>(i + 3)) + " doublings of size", sizes,
                             std::vector<float>(sizes.size(), 1000.f), substeps[i], 0.02));
  }
}

}  // namespace

void body_rows(Result& result, bool) {
  tumbling_rows(result);
  body_friction_rows(result);
  body_mesh_rows(result);
  body_impact_rows(result);
  impact_of_body_rows(result);
  trusted_contact_rows(result);
  rest_rows(result);
}

}  // namespace pliant::validate
