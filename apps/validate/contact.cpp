// Friction and restitution: when a body begins to slip, how far it slides, how high it bounces.
#include <algorithm>
#include <cmath>

#include "apps/validate/rows.h"

namespace pliant::validate {
namespace {

constexpr float contact_thickness = 0.01f;
constexpr int sliding_substeps = 20, bounce_substeps = 100;

// A particle in contact with a plane that is tilted by `degrees` about the z-axis; both have the given friction.
Scene on_plane(double degrees, double friction, const Vec3f& velocity) {
  const double angle = degrees * pi / 180;
  const float away = contact_thickness;
  Object object =
      particles({{static_cast<float>(-std::sin(angle)) * away, static_cast<float>(std::cos(angle)) * away, 0}}, {0.5f});
  object.velocities = {velocity};
  object.thickness = contact_thickness;
  object.static_friction = object.kinetic_friction = static_cast<float>(friction);
  Scene scene = scene_with(object, standard_gravity, sliding_substeps, 1);
  Collider plane;
  plane.rotation = rotation({0, 0, 1}, static_cast<float>(degrees));
  plane.static_friction = plane.kinetic_friction = static_cast<float>(friction);
  scene.add(plane);
  return scene;
}

// How far a particle slides along the plane in a second, from rest [m].
double slide(double degrees, double friction) {
  World world(on_plane(degrees, friction, {}));
  const Vec3f start = world.object(0).positions()[0];
  for (int i = 0; i < 60; ++i) world.step(1.f / 60);
  const Vec3f moved = world.object(0).positions()[0] - start;
  return std::sqrt(static_cast<double>(length_squared(moved)));
}

double slip_angle(double friction) {
  double low = 0, high = 60;
  while (high - low > 0.02) {
    const double middle = (low + high) / 2;
    (slide(middle, friction) > 0.002 ? high : low) = middle;
  }
  return (low + high) / 2;
}

double stopping_distance(double friction, double speed) {
  World world(on_plane(0, friction, {static_cast<float>(speed), 0, 0}));
  const double time = 1.5 * speed / (friction * standard_gravity) + 0.2;
  for (int i = 0; i * (1.0 / 60) < time; ++i) world.step(1.f / 60);
  return static_cast<double>(world.object(0).positions()[0].x);
}

void friction_rows(Result& result) {
  for (double friction : {0.2, 0.5, 0.8}) {
    const std::string with = ", friction " + brief(friction);
    result.rows.push_back(absolute("contact: engine, slip angle" + with, std::atan(friction) * 180 / pi,
                                   slip_angle(friction), 1, "degrees", "tan(theta) = mu; bisection, 20 substeps"));
    result.rows.push_back(relative("contact: engine, stopping distance from 2 m/s" + with,
                                   4 / (2 * friction * standard_gravity), stopping_distance(friction, 2), 0.01, "m",
                                   "v^2 / (2 mu g), 20 substeps"));
  }
}

struct Bounce {
  double apex = 0;
  plot::Series curve;
};

// Drops a particle from 1 m above contact. The apex is computed from position and velocity, because it may be between
// frames.
Bounce drop(double restitution) {
  Object object = particles({{0, 1 + contact_thickness, 0}}, {1});
  object.thickness = contact_thickness;
  object.restitution = static_cast<float>(restitution);
  Scene scene = scene_with(object, standard_gravity, bounce_substeps, 1);
  scene.add(Collider{});
  World world(scene);
  Bounce bounce;
  bounce.curve.name = "e = " + brief(restitution);
  bool counted = false;
  for (int i = 0; i < 180; ++i) {
    world.step(1.f / 60);
    const double y = static_cast<double>(world.object(0).positions()[0].y - contact_thickness),
                 v = static_cast<double>(world.object(0).velocities()[0].y);
    if (v > 0.1 && !counted) bounce.apex = y + v * v / (2 * standard_gravity);
    if (v > 0.1) counted = true;
    bounce.curve.x.push_back((i + 1) / 60.0);
    bounce.curve.y.push_back(y);
  }
  return bounce;
}

void bounce_rows(Result& result) {
  plot::Chart chart{"A body bounces", "time [s]", "height [m]", false, false, {}};
  for (double e : {0.5, 0.8, 1.0}) {
    const Bounce bounce = drop(e);
    result.rows.push_back(relative("contact: engine, height of the bounce, e = " + brief(e), e * e, bounce.apex, 0.01,
                                   "m", "e^2 h, from 1 m, 100 substeps"));
    chart.series.push_back(bounce.curve);
  }
  result.charts.push_back(chart);
}

}  // namespace

void contact_rows(Result& result, bool) {
  friction_rows(result);
  bounce_rows(result);
}

}  // namespace pliant::validate
