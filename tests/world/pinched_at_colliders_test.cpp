// Tests bodies that lie on cloth that lies on a collider: the cloth passes their weight and friction on.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "math/vector.h"
#include "pliant/body.h"
#include "pliant/material.h"
#include "pliant/mesh.h"
#include "pliant/world.h"
#include "world/run_time_support.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using testing_support::dt;

enum class Table { plane, box, sphere, capsule, grid, heightfield };
constexpr Table all_tables[] = {Table::plane,   Table::box,  Table::sphere,
                                Table::capsule, Table::grid, Table::heightfield};
const char* const table_names[] = {"plane", "box", "sphere", "capsule", "grid", "heightfield"};
constexpr float friction_of_all = 0.6f;

/// A table whose top is at height 0 in the middle.
void add_table(Scene& scene, Table kind) {
  if (kind == Table::grid || kind == Table::heightfield) {
    MeshCollider mesh;
    mesh.static_friction = mesh.kinetic_friction = friction_of_all;
    mesh.mesh = kind == Table::grid ? testing_support::box_mesh({2, 0.2f, 2}) : grid_mesh(9, 9, 2, 2);
    if (kind == Table::grid)
      for (Vec3f& p : mesh.mesh.positions) p.y -= 0.1f;
    mesh.as = kind == Table::grid ? MeshCollider::As::distance_grid : MeshCollider::As::heightfield;
    scene.add(mesh);
    return;
  }
  Collider collider;
  collider.static_friction = collider.kinetic_friction = friction_of_all;
  if (kind == Table::box) {
    collider.shape = Box{{1, 0.1f, 1}};
    collider.position = {0, -0.1f, 0};
  } else if (kind == Table::sphere) {
    collider.shape = Sphere{20};
    collider.position = {0, -20, 0};
  } else if (kind == Table::capsule) {
    collider.shape = Capsule{5, 10};
    collider.position = {0, -5, 0};
    collider.rotation = rotation({1, 0, 0}, 90);
  }
  scene.add(collider);
}

/// A body of a radius or half height of 10 cm on cotton of 3 mm, which passes through it by 6 mm where it does not bear
/// it.
Scene body_on_cotton(Table table, const SolidShape& shape, float mass) {
  Scene scene;
  BodyOptions options;
  options.position = {0, 0.11f, 0};
  options.mass = mass;
  Object crate = make_body({{shape}}, options);
  ClothOptions of_cloth;
  of_cloth.material = fabric("cotton");
  Object cloth = make_cloth(grid_mesh(9, 9, 0.5f, 0.5f), of_cloth);
  for (Vec3f& p : cloth.positions) p.y = 0.005f;
  cloth.thickness = 0.003f;
  cloth.self_collision = cloth.collides = true;
  for (Object* object : {&crate, &cloth}) object->static_friction = object->kinetic_friction = friction_of_all;
  crate.rolling_friction = 0.01f;
  scene.add(crate);
  scene.add(cloth);
  add_table(scene, table);
  return scene;
}

Hull hull_of_a_box() {
  Hull hull;
  for (const float x : {-0.1f, 0.1f})
    for (const float y : {-0.1f, 0.1f})
      for (const float z : {-0.1f, 0.1f}) hull.points.push_back({x, y, z});
  return hull;
}

struct Rest {
  float height = 0, creep = 0;  ///< at the end [m]; the largest in the last half second [m/s]
  double load = 0;              ///< of the collider, in the mean of that [N]
};

Rest rest_of(World& world, float sideways) {
  Rest out;
  Vec3f last{};
  world.record_contact_events(true);
  for (int frame = 0; frame < 75; ++frame) {
    if (sideways != 0) world.object(0).set_forces(std::vector<Vec3f>{{frame < 45 ? 0 : sideways, 0, 0}});
    const Report report = world.step(dt);
    EXPECT_TRUE(report.ok()) << report.explain();
    const Vec3f now = world.object(0).positions()[0];
    if (frame >= 45) out.creep = std::max(out.creep, length(now - last) / dt);
    if (frame >= 45)
      for (const ContactEvent& event : world.contact_events())
        if (event.first.kind != Thing::Kind::object || event.second.kind != Thing::Kind::object)
          out.load += std::fabs(event.push.y) / (30 * double(dt));
    last = now;
  }
  out.height = last.y;
  return out;
}

/// Before: all sank through the cloth, to 0.100 m. 40 kg are 85 000 masses of an inner particle.
TEST(PinchedAtColliders, BodiesLieOnClothOnEachCollider) {
  for (const Table table : all_tables)
    for (const float mass : {1.f, 40.f, 100.f}) {
      SCOPED_TRACE(table_names[static_cast<int>(table)] + (" and " + std::to_string(mass) + " kg"));
      World world(body_on_cotton(table, Box{{0.1f, 0.1f, 0.1f}}, mass));
      const Rest rest = rest_of(world, 0);
      EXPECT_NEAR(rest.height, 0.106f, 0.001f);
      EXPECT_LT(rest.creep, table == Table::sphere ? 0.0025f : 0.0015f);
      const double weight = 9.81 * (double(mass) + 0.25 * double(fabric("cotton").area_density));
      EXPECT_NEAR(rest.load, weight, 0.02 * weight);
    }
}

TEST(PinchedAtColliders, BallsAndHullsLieOnClothAsWell) {
  for (const Table table : {Table::plane, Table::box, Table::grid, Table::heightfield})
    for (const SolidShape& shape : {SolidShape{Sphere{0.1f}}, SolidShape{hull_of_a_box()}}) {
      SCOPED_TRACE(table_names[static_cast<int>(table)]);
      World world(body_on_cotton(table, shape, 40));
      const Rest rest = rest_of(world, 0);
      EXPECT_NEAR(rest.height, 0.106f, 0.001f);
      EXPECT_LT(rest.creep, 0.001f);
    }
}

/// Friction holds below its limit, and gives way above it.
TEST(PinchedAtColliders, FrictionHoldsToItsLimit) {
  const float limit = friction_of_all * 40 * 9.81f;
  for (const Table table : {Table::plane, Table::box, Table::grid, Table::heightfield}) {
    SCOPED_TRACE(table_names[static_cast<int>(table)]);
    World held(body_on_cotton(table, Box{{0.1f, 0.1f, 0.1f}}, 40)),
        pushed(body_on_cotton(table, Box{{0.1f, 0.1f, 0.1f}}, 40));
    EXPECT_LT(rest_of(held, 0.8f * limit).creep, 0.003f);
    EXPECT_GT(rest_of(pushed, 1.3f * limit).creep, 0.2f);
  }
}

}  // namespace
}  // namespace pliant
