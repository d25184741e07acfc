// Compares every sweep with the same known answers: rest state and motion must not depend on the order of constraints.
// The variants are those of apps/validate/sweep_table.h. If a variant cannot give an answer, its row has the value that
// it gives instead, and the reason.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "apps/validate/rows.h"
#include "apps/validate/sweep_table.h"

namespace pliant::validate {
namespace {

constexpr double sweep_gravity = 10;

World world_of(const SweepWay& way, Object object, int substeps, int iterations, double gravity = sweep_gravity) {
  Scene scene = scene_with(std::move(object), gravity, substeps, iterations);
  scene.settings.sweep = way.sweep;
  scene.settings.sweep_options = way.options;
  scene.settings.record_multipliers = true;
  return World(scene);
}

void step(World& world, int frames) {
  for (int i = 0; i < frames; ++i) world.step(1.f / 60);
}

// ---------------------------------------------------------------- the measurements

double static_stretch(const SweepWay& way) {
  Object object = hanging_line(2, 1, 2, 2, Stiffness::compliance(0.01f));
  object.damping = 6;
  World world = world_of(way, std::move(object), 10, 20);
  step(world, 240);
  return -1 - static_cast<double>(world.object(0).positions()[1].y);
}

// The force lambda / h^2 of the topmost constraint of twenty particles of 1 kg. The first one is fixed, so it carries
// nineteen.
double top_force(const SweepWay& way) {
  World world = world_of(way, hanging_line(20, 0.1f, 1, 1, Stiffness::compliance(1e-8f)), 1, 100);
  std::vector<double> forces;
  for (int i = 0; i < 400; ++i) {
    world.step(1.f / 60);
    if (i >= 300) forces.push_back(-static_cast<double>(world.object(0).multipliers("distance")[0]) * 3600);
  }
  return farthest(190, forces);
}

// The sag of a rubber sheet that hangs by one edge, over its sag with 50 substeps of 50 Gauss-Seidel iterations.
double sinking(const SweepWay& way, int substeps, int iterations) {
  ClothOptions options;
  options.material.area_density = 0.5f;
  options.material.stretch_stiffness = 25;
  options.bending_model = ClothOptions::Bending::none;
  TriangleMesh mesh = grid_mesh(9, 9, 1, 1);
  for (Vec3f& x : mesh.positions) x = {x.x, -x.z, 0};  // turns the mesh upright, the first row on top
  Object object = make_cloth(mesh, options);
  object.damping = 6;
  for (int i = 0; i < 9; ++i) object.pins.push_back({i, {}});
  World world = world_of(way, std::move(object), substeps, iterations);
  step(world, 120);
  return -0.5 - static_cast<double>(world.object(0).positions()[76].y);  // middle of the lower edge
}
double sinking_share(const SweepWay& way) {
  static const double converged = sinking(sweep_ways()[0], 50, 50);
  return sinking(way, 20, 10) / converged;
}

double inflation(const SweepWay& way) {
  ClothOptions options;
  options.stretch = Stiffness::compliance(0.02f);
  options.bending_model = ClothOptions::Bending::none;
  options.volume = Volume{1.5f, Stiffness::rigid()};
  Object object = make_cloth(sphere_mesh(2), options);
  object.damping = 4;
  World world = world_of(way, std::move(object), 10, 4, 0);
  const double rest = world.object(0).enclosed_volume();
  step(world, 120);
  return world.object(0).enclosed_volume() / rest;
}

// T / T0 of a pendulum of 1 m released at 90 degrees. The time to the lowest point is a quarter of the period.
double period(const SweepWay& way) {
  Object object = particles({{0, 0, 0}, {1, 0, 0}}, {std::numeric_limits<float>::infinity(), 1});
  connect(object, {0, 1}, {1}, Stiffness::rigid());
  World world = world_of(way, std::move(object), 50, 4);
  double before = 1;
  for (int i = 1; i < 120; ++i) {
    world.step(1.f / 120);
    const double x = static_cast<double>(world.object(0).positions()[1].x);
    if (x < 0) return 4 * (i - x / (x - before)) / 120 / (2 * pi * std::sqrt(1 / sweep_gravity));
    before = x;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

Object flying_cloth() {
  Random random(7);
  TriangleMesh mesh = grid_mesh(7, 7, 1, 1);
  for (Vec3f& x : mesh.positions) x.y += static_cast<float>(random.uniform(-0.1, 0.1));
  ClothOptions options;
  options.stretch = Stiffness::compliance(1e-4f);
  options.bending = Stiffness::compliance(1e-2f);
  Object object = make_cloth(mesh, options);
  for (std::size_t i = 0; i < object.positions.size(); ++i) {
    const Vec3d v = random.vector(2);
    object.velocities.push_back({static_cast<float>(v.x + 1), static_cast<float>(v.y), static_cast<float>(v.z + 2)});
  }
  return object;
}

struct Momenta {
  Vec3d linear{}, angular{};
  double linear_scale = 0, angular_scale = 0;
};

Momenta momenta_of(const World& world, const std::vector<float>& masses) {
  Momenta sum;
  const std::vector<Vec3f> places = world.object(0).positions(), velocities = world.object(0).velocities();
  for (std::size_t i = 0; i < masses.size(); ++i) {
    const Vec3d x{places[i].x, places[i].y, places[i].z}, v{velocities[i].x, velocities[i].y, velocities[i].z};
    const double m = static_cast<double>(masses[i]);
    sum.linear += v * m;
    sum.angular += cross(x, v) * m;
    sum.linear_scale += length(v) * m;
    sum.angular_scale += length(x) * length(v) * m;
  }
  return sum;
}

double momentum_change(const SweepWay& way, bool angular) {
  const Object object = flying_cloth();
  World world = world_of(way, object, 10, 4, 0);
  const Momenta before = momenta_of(world, object.masses);
  step(world, 30);
  const Momenta after = momenta_of(world, object.masses);
  return angular ? length(after.angular - before.angular) / before.angular_scale
                 : length(after.linear - before.linear) / before.linear_scale;
}
double linear_momentum(const SweepWay& way) { return momentum_change(way, false); }
double angular_momentum(const SweepWay& way) { return momentum_change(way, true); }

// How far a sheet slides on a floor from 2 m/s [m]; it must be v^2 / (2 mu g), whatever its constraints are.
double stopping_distance(const SweepWay& way) {
  ClothOptions options;
  options.material = fabric("cotton");
  Object object = make_cloth(grid_mesh(7, 7, 0.3f, 0.3f), options);
  for (Vec3f& x : object.positions) x.y = object.thickness;
  object.velocities.assign(object.positions.size(), {2, 0, 0});
  object.static_friction = object.kinetic_friction = 0.5f;
  Scene scene = scene_with(std::move(object), sweep_gravity, 20, 4);
  Collider floor;
  floor.static_friction = floor.kinetic_friction = 0.5f;
  scene.add(floor);
  scene.settings.sweep = way.sweep;
  scene.settings.sweep_options = way.options;
  World world(scene);
  const double start = static_cast<double>(world.object(0).positions()[24].x);
  step(world, 60);
  return static_cast<double>(world.object(0).positions()[24].x) - start;
}

// A square of inextensible cloth, hung by two corners.
Object hanging_cloth() {
  constexpr int side = 16;
  ClothOptions options;
  options.material.area_density = 0.2f;
  options.stretch = Stiffness::rigid();
  Object object = make_cloth(grid_mesh(side, side, 1, 1), options);
  object.pins = {{0, {}}, {side - 1, {}}};
  return object;
}

// The largest energy above the initial one [J].
double energy_gain(const SweepWay& way) {
  World world = world_of(way, hanging_cloth(), 10, 4);
  const double start = world.measure().kinetic_energy() + world.measure().potential_energy();
  double highest = start;
  for (int i = 0; i < 90; ++i) {
    if (!world.step(1.f / 60).ok()) return std::numeric_limits<double>::infinity();
    highest = std::max(highest, world.measure().kinetic_energy() + world.measure().potential_energy());
  }
  return highest - start;
}

// The largest overstretch of an edge in the first second.
double overstretch(const SweepWay& way) {
  World world = world_of(way, hanging_cloth(), 20, 10);
  double largest = 0;
  for (int i = 0; i < 60; ++i) {
    if (!world.step(1.f / 60).ok()) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, world.measure().overstretch().largest);
  }
  return largest;
}

// ---------------------------------------------------------------- the table

/// What an answer requires of a variant.
struct Asks {
  bool pairs = false, give = false, speed = false, force = false;
};

struct Answer {
  const char* what;
  double (*measure)(const SweepWay&);
  Asks asks;
  double expected, tolerance;
  Row (*compare)(std::string, double, double, double, std::string, std::string);
  const char *unit, *how;
};

Row no_more(std::string name, double bound, double measured, double, std::string unit, std::string note) {
  return at_most(std::move(name), bound, measured, std::move(unit), std::move(note));
}

const Answer known_answers[] = {
    {"static stretch, 2 kg on 100 N/m", static_stretch, {false, true}, 0.2, 1e-4, relative, "m", "10 x 20"},
    {"force at the top of 20 particles",
     top_force,
     {true, true, false, true},
     190,
     5e-3,
     relative,
     "N",
     "1 x 100, alpha 1e-8 m/N"},
    {"sag of a rubber sheet over the converged one", sinking_share, {true, true}, 1, 0.01, relative, "", "20 x 10"},
    {"V / V0 of a balloon at k = 1.5", inflation, {}, 1.5, 0.01, relative, "", "10 x 4"},
    {"period over T0 at 90 degrees", period, {}, 1.18034, 5e-3, relative, "", "h = 1/6000 s, 4 iterations"},
    {"linear momentum of a flying sheet", linear_momentum, {true}, 0, 1e-4, absolute, "", "10 x 4, 0.5 s"},
    {"angular momentum of a flying sheet", angular_momentum, {true}, 0, 1e-2, absolute, "", "10 x 4, 0.5 s"},
    {"stopping distance of a sheet", stopping_distance, {}, 0.4, 0.01, relative, "m", "v^2 / (2 mu g), 20 x 4"},
    {"energy that hanging cloth gains", energy_gain, {}, 0, 0, no_more, "J", "16 x 16, rigid, 10 x 4, 1.5 s"},
    {"overstretch of hanging cloth",
     overstretch,
     {false, false, true},
     0.03,
     0,
     no_more,
     "",
     "16 x 16, rigid, 20 x 10, largest of 1 s"},
};

/// Why a variant cannot give an answer; null if it can.
const char* excuse(const SweepWay& way, const Answer& answer) {
  if (answer.asks.pairs && way.lacks == Lacks::pairs) return "averaging violates Newton's third law between neighbours";
  if (answer.asks.give && way.lacks == Lacks::give)
    return "tethers limit objects that are meant to stretch (tether_slack)";
  if (answer.asks.force && way.lacks == Lacks::force)
    return "tethers carry part of the load, which no multiplier shows";
  if (answer.asks.speed && way.sweep == Sweep::jacobi)
    return "its steps are smaller than those of Gauss-Seidel, so it needs more";
  return nullptr;
}

void add_row(const SweepWay& way, const Answer& answer, Result& result) {
  const double measured = answer.measure(way);
  const std::string name = "sweeps: " + way.name + ", " + answer.what;
  const Row row = answer.compare(name, answer.expected, measured, answer.tolerance, answer.unit,
                                 std::string(answer.how) + ", float");
  const char* why = excuse(way, answer);
  if (why == nullptr) {
    result.rows.push_back(row);
    return;
  }
  result.rows.push_back(relative(name + ": missed", 1, row.pass ? 0 : 1, 0, "",
                                 "gives " + brief(measured) + " for " + brief(answer.expected) + ": " + why));
}

}  // namespace

void sweep_rows(Result& result, bool) {
  for (const SweepWay& way : sweep_ways())
    for (const Answer& answer : known_answers) add_row(way, answer, result);
}

}  // namespace pliant::validate
