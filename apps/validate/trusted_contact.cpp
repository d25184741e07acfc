// Contact that changes nothing but what touches: momentum of free cloth, loads of kinematic bodies, what is far away,
// and seams round what is too thick. All rows are of the engine, in float, with its default substeps.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "apps/validate/rows.h"
#include "pliant/body.h"
#include "pliant/stitch.h"

namespace pliant::validate {
namespace {

Scene weightless() {
  Scene scene;
  scene.gravity = {};
  scene.settings.threads = 1;
  return scene;
}

// ------------------------------------------------------------------------------------------------ momentum

struct FreeMomentum {
  Vec3d linear{}, angular{}, moment{};
  double mass = 0;

  void add(const Vec3d& x, const Vec3d& v, double m) {
    linear += v * m;
    angular += cross(x, v) * m;
  }
};

/// Of an object of cloth and a ball.
FreeMomentum momentum_of_both(const World& world, const Scene& scene) {
  FreeMomentum sum;
  for (int object = 0; object < 2; ++object) {
    const std::vector<Vec3f> x = world.object(object).positions(), v = world.object(object).velocities();
    const std::vector<float>& masses = scene.objects[static_cast<std::size_t>(object)].masses;
    for (std::size_t i = 0; i < x.size(); ++i)
      sum.add(to_double(x[i]), to_double(v[i]), static_cast<double>(masses[i]));
  }
  return sum;
}

void free_cloth_rows(Result& result) {
  constexpr double radius = 0.1, mass = 0.5;
  ClothOptions options;
  options.material.area_density = 0.2f;
  Object cloth = make_cloth(grid_mesh(21, 21, 1, 1), options);
  cloth.self_collision = cloth.collides = true;
  BodyOptions ball;
  ball.position = {0.1f, 0.2f, 0};
  ball.velocity = {0, -5, 0};
  ball.mass = static_cast<float>(mass);
  Scene scene = weightless();
  scene.add(cloth);
  scene.add(make_body({{Sphere{static_cast<float>(radius)}}}, ball));
  World world(scene);
  const FreeMomentum before = momentum_of_both(world, scene);
  for (int i = 0; i < 30; ++i) world.step(frame_time);
  FreeMomentum after = momentum_of_both(world, scene);
  after.angular += to_double(world.object(1).angular_velocities()[0]) * (0.4 * mass * radius * radius);
  const double taken = mass * length(to_double(world.object(1).velocities()[0] - Vec3f{0, -5, 0}));
  const std::string how = "0.5 kg at 5 m/s, half a second, self-collision; relative to what is exchanged";
  result.rows.push_back(
      at_least("bodies: engine, momentum that a ball gives to free cloth", 0.5, taken, "kg m/s", how));
  result.rows.push_back(at_most("bodies: engine, linear momentum of a ball and free cloth, change", 1e-4,
                                length(after.linear - before.linear) / taken, "", how));
  result.rows.push_back(at_most("bodies: engine, angular momentum of a ball and free cloth, change", 1e-2,
                                length(after.angular - before.angular) / taken, "",
                                how + " times 1 m, about the origin"));
}

// ------------------------------------------------------------------------------------------------ a lift

void lift_rows(Result& result) {
  BodyOptions options;
  options.kinematic = true;
  options.motion = {{{0}, {1, {0, 0.5f, 0}}}};
  Object lift = make_body({{Box{{0.5f, 0.05f, 0.5f}}}}, options);
  add_body(lift, {{Box{{0.1f, 0.1f, 0.1f}}}}, {.position = {0.35f, 0.15f, 0}});
  Scene scene;
  scene.settings.threads = 1;
  scene.add(lift);
  World world(scene);
  double tilt = 0;
  for (int i = 0; i < 60; ++i) {
    world.step(frame_time);
    const Quatf q = world.object(0).orientations()[0];
    tilt = std::max(tilt, 2 * std::asin(std::hypot(static_cast<double>(q.x), static_cast<double>(q.z))) * 180 / pi);
  }
  const std::string how = "a crate 0.35 m off the centre of a platform of 1 m, lifted by 0.5 m in 1 s";
  result.rows.push_back(at_most("bodies: engine, tilt of a kinematic lift", 1e-3, tilt, "degrees", how));
  result.rows.push_back(absolute("bodies: engine, rise of a load on a kinematic lift", 0.5,
                                 static_cast<double>(world.object(0).positions()[1].y) - 0.15, 1e-3, "m", how));
}

// ------------------------------------------------------------------------------------------------ far away

/// Where the particles of a hanging cloth are after a second, beside a box that falls 50 m away or without it.
std::vector<Vec3f> hung(bool beside_a_box) {
  ClothOptions options;
  options.material = fabric("cotton");
  Object cloth = make_cloth(grid_mesh(15, 15, 1, 1), options);
  cloth.self_collision = cloth.collides = true;
  cloth.pins = {{0}, {14}};
  Scene scene;
  scene.settings.threads = 1;
  scene.add(cloth);
  BodyOptions box;
  box.position = {50, 0, 0};
  if (beside_a_box) scene.add(make_body({{Box{{0.5f, 0.5f, 0.5f}}}}, box));
  World world(scene);
  for (int i = 0; i < 60; ++i) world.step(frame_time);
  return world.object(0).positions();
}

void far_rows(Result& result) {
  const std::vector<Vec3f> alone = hung(false), beside = hung(true);
  double most = 0;
  for (std::size_t i = 0; i < alone.size(); ++i)
    most = std::max(most, static_cast<double>(length(alone[i] - beside[i])));
  result.rows.push_back(absolute("bodies: engine, what a box 50 m away changes of a hanging cloth", 0, most, 0, "m",
                                 "1 m of cotton by two corners, a second"));
}

// ------------------------------------------------------------------------------------------------ a seam

/// Two upright panels that are sewn together at both sides round two balls, 8 % too narrow to go round them
/// unstretched.
void seam_rows(Result& result) {
  constexpr float ball = 0.12f;
  constexpr int columns = 13, rows = 17;
  TriangleMesh mesh;
  for (const float z : {-0.15f, 0.15f}) {
    const TriangleMesh flat = grid_mesh(columns, rows, 0.92f * static_cast<float>(pi) * ball, 0.44f);
    const int first = static_cast<int>(mesh.positions.size());
    for (const Vec3f& p : flat.positions) mesh.positions.push_back({p.x, p.z, z});
    for (const auto& [a, b, c] : flat.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
  }
  ClothOptions options;
  options.material = fabric("cotton");
  Object cover = make_cloth(mesh, options);
  cover.thickness = 0.001f;
  cover.damping = 2;
  std::vector<std::array<int, 2>> pairs;
  for (int row = 0; row < rows; ++row)
    for (const int column : {0, columns - 1})
      pairs.push_back({row * columns + column, (rows + row) * columns + column});
  add_stitches(cover, pairs, {.closing_time = 0.5f});
  Scene scene = weightless();
  scene.add(cover);
  for (const float y : {-ball, ball}) {
    Collider within;
    within.shape = Sphere{ball};
    within.position = {0, y, 0};
    scene.add(within);
  }
  World world(scene);
  for (int i = 0; i < 50; ++i) world.step(frame_time);
  const std::vector<Vec3f> x = world.object(0).positions();
  double gap = 0;
  for (const auto& [a, b] : pairs)
    gap = std::max(gap, static_cast<double>(length(x[static_cast<std::size_t>(a)] - x[static_cast<std::size_t>(b)])));
  result.rows.push_back(at_most("bodies: engine, widest stitch of a cover that is 8 % too narrow", 1e-3, gap, "m",
                                "cotton round two balls of 0.12 m"));
}

}  // namespace

void trusted_contact_rows(Result& result) {
  free_cloth_rows(result);
  lift_rows(result);
  far_rows(result);
  seam_rows(result);
}

}  // namespace pliant::validate
