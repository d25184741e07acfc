// Tests that boxes come to rest on planks that hang on ropes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "pliant/body.h"
#include "pliant/world.h"

namespace pliant {
namespace {

constexpr int planks = 8, links_a_plank = 5;
constexpr float link_length = 0.05f, pitch = links_a_plank * link_length, half_span = 0.5f * pitch * planks,
                sag = 0.25f;
constexpr Vec3f half_plank{0.11f, 0.02f, 0.5f}, half_box{0.13f, 0.13f, 0.13f};

/// A parabola through both ends of the ropes.
float height_at(float x) { return sag * (x * x / (half_span * half_span) - 1); }

void add_rope(Object& bridge, float z) {
  std::vector<Vec3f> points;
  for (int i = 0; i <= planks * links_a_plank; ++i) {
    const float x = static_cast<float>(i) * link_length - half_span;
    points.push_back({x, height_at(x), z});
  }
  RopeOptions options;
  options.linear_density = 0.5f;
  const int first = append(bridge, make_rope(points, options));
  bridge.pins.push_back({first, {}});
  bridge.pins.push_back({first + planks * links_a_plank, {}});
  for (int plank = 0; plank < planks; ++plank)
    attach(bridge, {first + plank * links_a_plank + 1, first + plank * links_a_plank + 4}, plank);
}

Object bridge_of_planks() {
  Object bridge;
  bridge.name = "bridge";
  for (int plank = 0; plank < planks; ++plank) {
    const float x = (static_cast<float>(plank) + 0.5f) * pitch - half_span;
    BodyOptions options;
    options.position = {x, height_at(x), 0};
    const float angle = std::atan(2 * sag * x / (half_span * half_span));
    options.rotation = {0, 0, std::sin(angle / 2), std::cos(angle / 2)};
    add_body(bridge, {{Box{half_plank}, {}, {}, 500}}, options);
  }
  for (const float z : {-0.51f, 0.51f}) add_rope(bridge, z);
  bridge.static_friction = 0.6f;
  bridge.kinetic_friction = 0.5f;
  bridge.damping = 0.5f;
  return bridge;
}

/// Boxes over the joints between planks, and one on top.
Object boxes() {
  Object object;
  object.name = "boxes";
  const auto add = [&](float x, float over, float z) {
    BodyOptions options;
    options.position = {x, height_at(x) + over, z};
    add_body(object, {{Box{half_box}, {}, {}, 400}}, options);
  };
  for (const float x : {-0.5f, -0.06f, 0.37f}) add(x, 0.17f, 0.2f * x);
  add(-0.05f, 0.45f, 0.05f);
  object.static_friction = 0.6f;
  object.kinetic_friction = 0.5f;
  object.damping = 0.5f;
  return object;
}

std::vector<Vec3f> centres(const World& world, ObjectId id, std::size_t count) {
  std::vector<Vec3f> all = world.object(id).positions();
  all.resize(count);
  return all;
}

struct FastestMotion {
  double speed = 0;  ///< of the fastest body [m/s]
  double spin = 0;   ///< of any body [rad/s]
};

FastestMotion fastest(const World& world, const Scene& scene) {
  FastestMotion most;
  for (std::size_t o = 0; o < scene.objects.size(); ++o) {
    const auto view = world.object(world.objects()[o]);
    const std::vector<Vec3f> velocities = view.velocities(), spins = view.angular_velocities();
    for (const ObjectBody& body : scene.objects[o].bodies) {
      most.speed = std::max(most.speed, std::sqrt(double(length_squared(velocities[std::size_t(body.particle)]))));
      most.spin = std::max(most.spin, std::sqrt(double(length_squared(spins[std::size_t(body.frame)]))));
    }
  }
  return most;
}

/// Contact forces are there when the ropes are solved. Otherwise these take up what friction has left, and all hums for
/// ever.
TEST(BridgeOfPlanks, ComesToRestWithBoxesOnIt) {
  Scene scene;
  scene.add(bridge_of_planks());
  const ObjectId load = scene.add(boxes());
  World world(scene);
  for (int frame = 0; frame < 600; ++frame) ASSERT_TRUE(world.step(1.f / 60).ok());
  const std::vector<Vec3f> before = centres(world, load, 4);
  FastestMotion most;
  for (int frame = 0; frame < 300; ++frame) {
    ASSERT_TRUE(world.step(1.f / 60).ok());
    const FastestMotion now = fastest(world, scene);
    most = {std::max(most.speed, now.speed), std::max(most.spin, now.spin)};
  }
  const std::vector<Vec3f> after = centres(world, load, 4);
  double creep = 0;
  for (std::size_t i = 0; i < 4; ++i) creep = std::max(creep, std::sqrt(double(length_squared(after[i] - before[i]))));
  EXPECT_LT(most.speed, 5e-3);
  EXPECT_LT(most.spin, 50e-3);
  EXPECT_LT(creep, 3e-3);
}

}  // namespace
}  // namespace pliant
