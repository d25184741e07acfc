// Collision: continuous tests on queries whose answer is known by construction, and what a World guarantees about
// surfaces, with and without the filter.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "apps/validate/long_contact.h"
#include "apps/validate/rows.h"
#include "pliant/queries.h"

namespace pliant::validate {
namespace {

// ------------------------------------------------------------------------------------------------ continuous tests

/// Makes vertex-triangle or edge-edge pairs in linear motion that cross at a time within it, or miss.
void impact_rows(Result& result) {
  Random random(11);
  constexpr int queries = 20000;
  int missed[2] = {0, 0}, false_alarms[2] = {0, 0};
  for (int i = 0; i < queries; ++i) {
    const bool edges = i % 2 == 1, hits = i % 4 < 2;
    std::array<Vec3f, 4> at, from,
        to;  // `at`: corners at the contact, in the plane z = 0, which cross or are 0.1 apart
    const float s = static_cast<float>(random.uniform(0.05, 0.95)), past = hits ? 0.f : 0.1f;
    if (edges) {
      at[0] = {-1, 0, past}, at[1] = {1, 0, past};
      at[2] = {s, -1, 0}, at[3] = {s, 1, 0};
    } else {
      at[0] = {0.3f * s, 0.3f, past};
      at[1] = {-1, -1, 0}, at[2] = {2, -1, 0}, at[3] = {-1, 2, 0};
    }
    const float time = static_cast<float>(random.uniform(0.05, 0.95));
    const Vec3f common = to_float(random.vector(1)), spin{0, 0, static_cast<float>(random.uniform(0.5, 3))};
    for (std::size_t k = 0; k < 4; ++k) {
      const bool first = k < (edges ? 2U : 1U);
      const Vec3f speed = hits ? common + (first ? spin : Vec3f{}) : common;
      from[k] = at[k] - speed * time;
      to[k] = at[k] + speed * (1 - time);
    }
    const bool found =
        edges ? edge_edge_impact(from, to, 0.f).has_value() : vertex_triangle_impact(from, to, 0.f).has_value();
    missed[edges] += hits && !found ? 1 : 0;
    false_alarms[edges] += !hits && found ? 1 : 0;
  }
  for (int edges = 0; edges < 2; ++edges) {
    const std::string name =
        std::string("collision: continuous, ") + (edges == 1 ? "two edges" : "vertex and triangle");
    result.rows.push_back(at_most(name + ", missed", 0, missed[edges], "", "5000 that meet during the motion, float"));
    result.rows.push_back(at_most(name + ", false alarms", 0.01 * queries / 4, false_alarms[edges], "",
                                  "1 % of 5000 that pass at 0.1 m, float"));
  }
}

// ------------------------------------------------------------------------------------------------ surfaces

Object patch(int n, float size, float height, const char* name) {
  TriangleMesh mesh = grid_mesh(n, n, size, size);
  for (Vec3f& p : mesh.positions) p.y += height;
  ClothOptions options;
  options.name = name;
  options.material = fabric("cotton");
  Object object = make_cloth(mesh, options);
  object.thickness = 0.002f;
  object.self_collision = object.collides = true;
  return object;
}

Settings settings_of(int substeps, bool filter) {
  Settings settings;
  settings.sweep = Sweep::tiled;
  settings.substeps = substeps;
  settings.threads = 1;
  settings.contact_filter = filter;
  return settings;
}

std::string with(bool filter) { return filter ? "" : ", without filter"; }

std::size_t crossings(const World& world) {
  TriangleMesh all;
  for (int o = 0; o < world.object_count(); ++o) {
    const TriangleMesh mesh = world.object(o).mesh();
    const int first = static_cast<int>(all.positions.size());
    for (const auto& [a, b, c] : mesh.triangles) all.triangles.push_back({first + a, first + b, first + c});
    all.positions.insert(all.positions.end(), mesh.positions.begin(), mesh.positions.end());
  }
  return find_crossings(all).size();
}

/// Layers that fall on the ground and on one another: intersections in any frame, and at what distance the top layer
/// rests.
void layer_rows(Result& result, bool filter) {
  Scene scene;
  scene.settings = settings_of(20, filter);
  for (int i = 0; i < 3; ++i)
    scene.add(patch(10, 0.2f, 0.01f + 0.01f * static_cast<float>(i), i == 0 ? "a" : i == 1 ? "b" : "c"));
  scene.add(Collider{});
  World world(scene);
  std::size_t most = 0;
  for (int frame = 0; frame < 90; ++frame) {
    world.step(1.f / 60);
    most = std::max(most, crossings(world));
  }
  double apart = 0;
  for (std::size_t i = 0; i < 100; ++i)
    apart += static_cast<double>(world.object(2).positions()[i].y - world.object(1).positions()[i].y) / 100;
  result.rows.push_back(at_most("collision: engine, three layers, edges through triangles" + with(filter), 0,
                                static_cast<double>(most), "", "exact signs, 90 frames"));
  result.rows.push_back(relative("collision: engine, distance of resting layers" + with(filter), 0.004, apart, 0.02,
                                 "m", "the sum of both thicknesses"));
}

/// How far a patch slides in a second down two oblique triangles [m].
double slide(double degrees, bool filter) {
  const double c = std::cos(degrees * pi / 180), s = std::sin(degrees * pi / 180);
  const auto turned = [&](const Vec3f& p) {
    return to_float(Vec3d{c * double(p.x) + s * double(p.y), c * double(p.y) - s * double(p.x), double(p.z)});
  };
  Scene scene;
  scene.settings = settings_of(20, filter);
  MeshCollider slope;
  slope.mesh = grid_mesh(2, 2, 8, 2);
  slope.static_friction = slope.kinetic_friction = 0.5f;
  Object object = patch(4, 0.2f, 0.002f, "patch");
  object.static_friction = object.kinetic_friction = 0.5f;
  for (Vec3f& p : slope.mesh.positions) p = turned(p);
  for (Vec3f& p : object.positions) p = turned(p);
  const Vec3f start = object.positions[0];
  scene.add(slope);
  scene.add(object);
  World world(scene);
  for (int frame = 0; frame < 60; ++frame) world.step(1.f / 60);
  return std::sqrt(static_cast<double>(length_squared(world.object(0).positions()[0] - start)));
}

void slope_rows(Result& result, bool filter) {
  const double angle = 40 * pi / 180, way = 0.5 * standard_gravity * (std::sin(angle) - 0.5 * std::cos(angle));
  result.rows.push_back(at_most("collision: engine, creep on triangles at 25.6 degrees" + with(filter), 0.002,
                                slide(25.6, filter), "m", "friction 0.5 holds to 26.57 degrees"));
  result.rows.push_back(relative("collision: engine, slide on triangles at 40 degrees" + with(filter), way,
                                 slide(40, filter), 0.03, "m", "g (sin - mu cos) / 2, in a second"));
}

/// How high a patch rebounds that falls flat on triangles from 0.5 m [m].
double apex(float restitution, bool filter) {
  Scene scene;
  scene.settings = settings_of(50, filter);
  MeshCollider ground;
  ground.mesh = grid_mesh(3, 3, 2, 2);
  ground.restitution = restitution;
  scene.add(ground);
  scene.add(patch(3, 0.2f, 0.502f, "patch"));
  World world(scene);
  for (int frame = 0; frame < 60; ++frame) {
    world.step(1.f / 60);
    const double y = double(world.object(0).positions()[4].y) - 0.002, v = double(world.object(0).velocities()[4].y);
    if (v > 0.1) return y + v * v / (2 * standard_gravity);
  }
  return 0;
}

/// Rows of a kinematic ball of triangles that meets a loose sheet.
void ball_rows(Result& result) {
  for (const float speed : {1.f, 10.f, 30.f}) {
    Scene scene;
    scene.gravity = {};
    scene.settings = settings_of(20, true);
    scene.add(patch(14, 0.4f, 0, "sheet"));
    MeshCollider ball;
    ball.mesh = sphere_mesh(2);
    for (Vec3f& p : ball.mesh.positions) p = p * 0.1f + Vec3f{0.011f, 0.12f, 0.007f};
    ball.motion.keyframes = {{0, {}, {}}, {1, {0, -speed, 0}, {}}};
    scene.add(ball);
    World world(scene);
    std::vector<std::array<int, 3>> triangles;
    for (const auto& [a, b, c] : world.object(0).mesh().triangles) triangles.push_back({a, b, c});
    for (const auto& [a, b, c] : ball.mesh.triangles) triangles.push_back({196 + a, 196 + b, 196 + c});
    CrossingFinder finder(triangles, 196 + static_cast<int>(ball.mesh.positions.size()));
    std::size_t most = 0;
    for (int frame = 0; frame < 10; ++frame) {
      world.step(1.f / 60);
      std::vector<Vec3f> places = world.object(0).positions();
      const std::vector<Vec3f> more = world.mesh_collider(0).positions();
      places.insert(places.end(), more.begin(), more.end());
      most = std::max(most, finder.find(places).size());
    }
    result.rows.push_back(at_most("collision: engine, mesh ball at " + brief(double(speed)) +
                                      " m/s against a loose sheet, edges through triangles",
                                  0, static_cast<double>(most), "", "exact signs, 10 frames"));
  }
}

/// The number of intersections of three loose sheets that are thrown at a fixed one at 20 m/s, with two substeps per
/// frame.
std::size_t thrown_sheets(bool filter) {
  Scene scene;
  scene.gravity = {};
  scene.settings = settings_of(2, filter);
  for (int i = 0; i < 4; ++i) {
    Object sheet = patch(9, 0.2f, 0.02f * static_cast<float>(i), ("sheet " + std::to_string(i)).c_str());
    if (i == 0)
      sheet.masses.assign(sheet.positions.size(), std::numeric_limits<float>::infinity());
    else
      sheet.velocities.assign(sheet.positions.size(), {0.3f, -20, 0.2f});
    scene.add(sheet);
  }
  World world(scene);
  std::size_t most = 0;
  for (int frame = 0; frame < 20; ++frame) {
    world.step(1.f / 60);
    most = std::max(most, crossings(world));
  }
  return most;
}

/// Rows of sheets that cross without the filter, so that a filter that does nothing fails here.
void filter_rows(Result& result) {
  const std::string name = "collision: engine, sheets thrown at 20 m/s, edges through triangles";
  result.rows.push_back(at_most(name, 0, static_cast<double>(thrown_sheets(true)), "", "exact signs, 2 substeps"));
  result.rows.push_back(at_least(name + with(false), 1, static_cast<double>(thrown_sheets(false)), "",
                                 "shows that the filter is needed"));
}

}  // namespace

void collision_rows(Result& result, bool slow) {
  impact_rows(result);
  for (const bool filter : {true, false}) {
    layer_rows(result, filter);
    slope_rows(result, filter);
    result.rows.push_back(relative("collision: engine, bounce on triangles, e = 0.5" + with(filter), 0.125,
                                   apex(0.5f, filter), 0.03, "m", "e^2 h, from 0.5 m, 50 substeps"));
  }
  ball_rows(result);
  filter_rows(result);
  if (slow) long_contact_rows(result);
}

}  // namespace pliant::validate
