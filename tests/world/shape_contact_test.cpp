// Tests edges and triangles in contact with spheres, capsules and boxes: where they rest, and that solids smaller than
// they are do not pass through.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "collision/fields/collider_pose.h"
#include "geometry/triangle.h"
#include "support/scenes.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using namespace testing_support;

constexpr float shape_thickness = 0.01f;

/// The least signed distance of the inside of a triangle or segment to a collider [m]: sampled, more finely near the
/// least sample.
double nearest(const Collider& collider, double time, const std::vector<Vec3f>& corners) {
  const Posed pose = collider_pose(collider, time);
  const LocalShape shape = local_shape(collider.shape);
  const Vec3d a = convert<double>(corners[0]), b = convert<double>(corners[1]), c = convert<double>(corners.back());
  constexpr int steps = 40;
  double least = 1e30, u = 0, v = 0, width = 1;
  for (int round = 0; round < 5; ++round, width *= 0.1) {
    const double low_u = std::max(u - width, 0.0), low_v = std::max(v - width, 0.0);
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; j <= steps; ++j) {
        const double s = low_u + 2 * width * i / steps, t = corners.size() == 2 ? 0 : low_v + 2 * width * j / steps;
        if (s + t > 1) continue;
        const double distance = signed_distance(shape, to_local(pose, a + (b - a) * s + (c - a) * t)).distance;
        if (!(distance < least)) continue;
        least = distance;
        u = s;
        v = t;
      }
  }
  return least;
}

Collider smooth(const Shape& shape) {
  Collider collider;
  collider.shape = shape;
  collider.static_friction = collider.kinetic_friction = 0;
  return collider;
}

/// Particles that keep all their distances, and a triangle if there are three.
Object rigid(const std::vector<Vec3f>& corners) {
  Object object = loose_particles(corners);
  object.name = "element";
  object.thickness = shape_thickness;
  object.damping = 1;
  ConstraintGroup sides{"distance", {0, 1}, {}, Stiffness::rigid(), {}};
  if (corners.size() == 3) {
    sides.particles.insert(sides.particles.end(), {1, 2, 0, 2});
    object.triangles = {{0, 1, 2}};
  }
  object.constraints = {sides};
  return object;
}

// ------------------------------------------------------------------------------------------------ rest

struct Rest {
  std::string name;
  Collider collider;
  std::vector<Vec3f> corners;
  float top;  ///< height of the solid below the element [m]
};
void PrintTo(const Rest& rest, std::ostream* out) { *out << rest.name; }

Collider on_its_edge() {
  Collider box = smooth(Box{{0.1f, 0.1f, 1}});
  box.rotation = rotation({0, 0, 1}, 45);
  return box;
}

/// A box that stands on a corner.
Collider on_its_corner() {
  Collider box = smooth(Box{{0.1f, 0.1f, 0.1f}});
  // Rotates the diagonal (1, 1, 1) to (0, 1, 0).
  box.rotation = rotation({1, 0, -1}, -180 / 3.14159265f * std::acos(1 / std::sqrt(3.f)));
  return box;
}

Collider lying(const Shape& shape) {
  Collider capsule = smooth(shape);
  capsule.rotation = rotation({1, 0, 0}, 90);
  return capsule;
}

const std::vector<Vec3f> large_triangle{{-1, 0, -0.577350269f}, {1, 0, -0.577350269f}, {0, 0, 1.154700538f}};

class ElementsAtRest : public testing::TestWithParam<Rest> {};
INSTANTIATE_TEST_SUITE_P(
    Shapes, ElementsAtRest,
    testing::Values(Rest{"LinkOnABoxEdge", on_its_edge(), {{-0.5f, 0, 0}, {0.5f, 0, 0}}, 0.1f * std::sqrt(2.f)},
                    Rest{"LinkOnAThinCapsule", lying(Capsule{0.005f, 1}), {{-0.5f, 0, 0}, {0.5f, 0, 0}}, 0.005f},
                    Rest{"LinkOnASphere", smooth(Sphere{0.05f}), {{-0.5f, 0, 0}, {0.5f, 0, 0}}, 0.05f},
                    Rest{"LinkAcrossANarrowBox", smooth(Box{{0.2f, 0.1f, 0.1f}}), {{-0.5f, 0, 0}, {0.5f, 0, 0}}, 0.1f},
                    Rest{"TriangleOnABoxEdge", on_its_edge(), large_triangle, 0.1f * std::sqrt(2.f)},
                    Rest{"TriangleOnABoxCorner", on_its_corner(), large_triangle, 0.1f * std::sqrt(3.f)},
                    Rest{"TriangleOnASmallSphere", smooth(Sphere{0.05f}), large_triangle, 0.05f},
                    Rest{"TriangleOnACapsuleEnd", smooth(Capsule{0.02f, 0.1f}), large_triangle, 0.12f},
                    Rest{"TriangleOverASmallBox", smooth(Box{{0.1f, 0.1f, 0.1f}}), large_triangle, 0.1f}),
    [](const auto& rest) { return rest.param.name; });

TEST_P(ElementsAtRest, AreHeldAtTheirThickness) {
  for (int substeps : {4, 20}) {
    Scene scene;
    Collider collider = GetParam().collider;
    collider.position = {0.25f, 0.5f, -0.125f};
    scene.add(collider);
    std::vector<Vec3f> corners = GetParam().corners;
    for (Vec3f& p : corners) p = p + collider.position + Vec3f{0, GetParam().top + shape_thickness + 0.02f, 0};
    scene.add(rigid(corners));
    World world(scene, settings_of(substeps, 4));
    for (int frame = 0; frame < 20; ++frame) {
      const Report report = world.step(dt);
      ASSERT_TRUE(report.ok());
      EXPECT_GT(nearest(collider, 0, world.object(0).positions()), shape_thickness - 2e-4)
          << substeps << " substeps, frame " << frame;
      EXPECT_TRUE(frame < 10 || report.contacts > 0) << "frame " << frame;
    }
    // By now it is sliding off a corner, but its distance is still that at which it was placed.
    EXPECT_NEAR(nearest(collider, 0, world.object(0).positions()), shape_thickness, 1e-3) << substeps << " substeps";
  }
}

TEST(ShapeContacts, KeepWhatIsSymmetricSymmetric) {
  Scene scene;
  Collider capsule = lying(Capsule{0.02f, 1});
  scene.add(capsule);
  scene.add(rigid({{-0.5f, 0.06f, 0}, {0.5f, 0.06f, 0}}));
  World world(scene, settings_of(20));
  for (int frame = 0; frame < 60; ++frame) world.step(dt);
  const std::vector<Vec3f> p = world.object(0).positions();
  EXPECT_NEAR(p[0].x, -p[1].x, 1e-5f);
  EXPECT_NEAR(p[0].y, p[1].y, 1e-5f);
  EXPECT_NEAR(p[0].y, 0.03f, 1e-4f);
}

// ------------------------------------------------------------------------------------------------ motion

TEST(ShapeContacts, ThrowBackByTheirRestitution) {
  Scene scene;
  scene.gravity = {};
  scene.add(smooth(Sphere{0.05f}));
  Object link = rigid({{-0.5f, 0.2f, 0}, {0.5f, 0.2f, 0}});
  link.velocities = {{0, -2, 0}, {0, -2, 0}};
  link.damping = 0;
  link.restitution = 0.5f;
  scene.add(link);
  World world(scene, settings_of(20));
  for (int frame = 0; frame < 12; ++frame) world.step(dt);
  for (const Vec3f& v : world.object(0).velocities()) EXPECT_NEAR(v.y, 1, 0.01f);
}

TEST(ShapeContacts, AreCarriedByWhatMoves) {
  Scene scene;
  scene.gravity = {};
  Collider box = on_its_edge();
  box.motion = straight({0, 1, 0}, 1);
  scene.add(box);
  scene.add(rigid({{-0.5f, 0.2f, 0}, {0.5f, 0.2f, 0}}));
  World world(scene, settings_of(10));
  for (int frame = 0; frame < 30; ++frame) {
    world.step(dt);
    EXPECT_GT(nearest(box, world.state().time, world.object(0).positions()), shape_thickness - 1e-4)
        << "frame " << frame;
  }
  for (const Vec3f& v : world.object(0).velocities()) EXPECT_NEAR(v.y, 1, 0.05f);
}

/// A link across an edge of a box that moves along that edge: friction must take it along; without friction it must
/// stay.
TEST(ShapeContacts, HaveFriction) {
  for (const float friction : {0.f, 0.5f}) {
    Scene scene;
    Collider box = on_its_edge();
    box.static_friction = box.kinetic_friction = friction;
    box.motion = straight({0, 0, 0.05f}, 1);
    scene.add(box);
    Object link = rigid({{-0.5f, 0.1515f, 0}, {0.5f, 0.1515f, 0}});
    link.static_friction = link.kinetic_friction = friction;
    scene.add(link);
    World world(scene, settings_of(20));
    for (int frame = 0; frame < 12; ++frame) world.step(dt);
    const float moved = 0.5f * (world.object(0).positions()[0].z + world.object(0).positions()[1].z);
    EXPECT_NEAR(moved, friction > 0 ? 0.0096f : 0.f, friction > 0 ? 4e-4f : 1e-6f);
  }
}

TEST(ShapeContacts, AreMadeWithAColliderThatCameLater) {
  Scene scene;
  scene.gravity = {};
  Object link = rigid({{-0.5f, 0.2f, 0}, {0.5f, 0.2f, 0}});
  link.velocities = {{0, -1, 0}, {0, -1, 0}};
  scene.add(link);
  World world(scene, settings_of(10));
  world.step(dt);
  world.add(smooth(Sphere{0.05f}));
  for (int frame = 0; frame < 30; ++frame) world.step(dt);
  EXPECT_NEAR(world.object(0).positions()[0].y, 0.06f, 1e-4f);
  EXPECT_EQ(world.step(dt).contacts, 0);  // it was stopped, and no force presses it down
}

/// A small sphere must stop a triangle that is shot at it from any side and at any angle; so must thin capsules and
/// boxes stop links.
TEST(ShapeContacts, StopShots) {
  std::mt19937 random(7);
  const auto uniform = [&](double low, double high) {
    return static_cast<float>(low + (high - low) * static_cast<double>(random()) / 4294967295.0);
  };
  const Collider colliders[] = {smooth(Sphere{0.05f}), lying(Capsule{0.02f, 1}), smooth(Box{{0.03f, 0.03f, 1}})};
  int through = 0, shots = 0;
  for (int round = 0; round < 300; ++round) {
    const Collider& collider = colliders[round % 3];
    std::vector<Vec3f> corners = large_triangle;
    if (round % 3 != 0)
      corners = {{-0.5f, uniform(-0.2, 0.2), uniform(-0.1, 0.1)}, {0.5f, uniform(-0.2, 0.2), uniform(-0.1, 0.1)}};
    const float tilt = uniform(-0.4, 0.4);
    for (Vec3f& p : corners) p = {p.x, p.y + tilt * p.x + 0.5f, p.z};
    Scene scene;
    scene.gravity = {};
    scene.add(collider);
    Object element = rigid(corners);
    element.damping = 0;
    const Vec3f velocity{uniform(-0.5, 0.5), -uniform(1, 20), uniform(-0.5, 0.5)};
    element.velocities.assign(corners.size(), velocity);
    scene.add(element);
    World world(scene, settings_of(20));
    for (int frame = 0; frame < 40; ++frame) world.step(1.f / 240);
    through += nearest(collider, 0, world.object(0).positions()) < 0.5 * shape_thickness ? 1 : 0;
    ++shots;
  }
  EXPECT_EQ(through, 0) << "of " << shots;
}

/// Cloth whose edges are longer than the sphere is wide.
TEST(ShapeContacts, HoldCoarseClothOnASmallSphere) {
  for (const float speed : {0.f, 3.f}) {
    Scene scene;
    Collider sphere;
    sphere.shape = Sphere{0.04f};
    sphere.position = {0.03f, 0, 0.02f};  // below the inside of a triangle
    scene.add(sphere);
    ClothOptions options;
    options.name = "cloth";
    TriangleMesh mesh = grid_mesh(8, 8, 1, 1);
    for (Vec3f& p : mesh.positions) p = {p.x, p.y + 0.06f, p.z};
    Object cloth = make_cloth(mesh, options);
    cloth.thickness = shape_thickness;
    cloth.velocities.assign(cloth.positions.size(), {0, -speed, 0});
    scene.add(cloth);
    World world(scene, settings_of(20));
    for (int frame = 0; frame < 30; ++frame) {
      ASSERT_TRUE(world.step(dt).ok());
      const std::vector<Vec3f> x = world.object(0).positions();
      for (const auto& t : mesh.triangles)
        ASSERT_GT(nearest(sphere, 0,
                          {x[static_cast<std::size_t>(t[0])], x[static_cast<std::size_t>(t[1])],
                           x[static_cast<std::size_t>(t[2])]}),
                  0.25 * shape_thickness)
            << "frame " << frame << " at " << speed << " m/s";
    }
  }
}

}  // namespace
}  // namespace pliant
