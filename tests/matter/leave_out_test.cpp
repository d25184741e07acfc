// Fills leave out what lies in solids of the scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "pliant/body.h"
#include "pliant/error.h"
#include "pliant/liquid.h"
#include "pliant/mesh.h"

namespace pliant::places_left_out {
namespace {

constexpr float spacing = 0.05f, radius = spacing / 2;
constexpr Vec3f low{-0.5f, 0, -0.5f}, high{0.5f, 0.5f, 0.5f};

float distance(const Vec3f& a, const Vec3f& b) { return std::sqrt(length_squared(a - b)); }

/// Places that are at least `reach` from a point: what is left of the fill around a ball.
std::vector<Vec3f> beyond(const Vec3f& centre, float reach) {
  std::vector<Vec3f> places = fill_box(low, high, spacing);
  std::erase_if(places, [&](const Vec3f& p) { return distance(p, centre) < reach; });
  return places;
}

/// What is left of the fill in a scene, and how many places were left out.
struct Left {
  std::vector<Vec3f> places;
  std::vector<PlacesInSolid> out;
};

Left left_in(const Scene& scene, const LeaveOutOptions& options = {radius}) {
  Left left{fill_box(low, high, spacing), {}};
  left.out = leave_out_solids(left.places, scene, options);
  return left;
}

/// A floor and walls that the fill touches.
Scene tank() {
  Scene scene;
  scene.add(Collider{.name = "floor", .shape = Plane{}});
  for (const float side : {-1.f, 1.f}) {
    scene.add(Collider{.name = "wall", .shape = Box{{0.05f, 0.5f, 0.6f}}, .position = {0.55f * side, 0.5f, 0}});
    scene.add(Collider{.name = "wall", .shape = Box{{0.6f, 0.5f, 0.05f}}, .position = {0, 0.5f, 0.55f * side}});
  }
  return scene;
}

Object body_of(const SolidShape& shape, const Vec3f& at) {
  BodyOptions options;
  options.name = "buoy";
  options.position = at;
  return make_body({{.shape = shape}}, options);
}

TEST(LeaveOutSolids, KeepsAllOfAFillThatTouchesTheWalls) {
  const Left left = left_in(tank());
  EXPECT_EQ(left.places.size(), 4000U);
  EXPECT_TRUE(left.out.empty());
}

TEST(LeaveOutSolids, LeavesOutABallWithTheRadiusOfAParticleAroundIt) {
  Scene scene = tank();
  scene.add(body_of(Sphere{0.18f}, {0, 0.3f, 0}));
  const Left left = left_in(scene);
  EXPECT_EQ(left.places, beyond({0, 0.3f, 0}, 0.18f + 0.99f * radius));
  ASSERT_EQ(left.out.size(), 1U);
  EXPECT_EQ(left.out[0].in, "buoy");
  EXPECT_EQ(static_cast<std::size_t>(left.out[0].places), 4000 - left.places.size());
  EXPECT_NEAR(left.out[0].places * std::pow(spacing, 3), 4.18879 * std::pow(0.205, 3), 0.002);
}

TEST(LeaveOutSolids, KnowsEveryKindOfSolid) {
  const Vec3f centre{0, 0.25f, 0};
  const auto left_with = [](const auto& thing) {
    Scene scene;
    scene.add(thing);
    return left_in(scene).places;
  };
  const std::vector<Vec3f> around = beyond(centre, 0.1f + 0.99f * radius);
  EXPECT_EQ(left_with(Collider{.shape = Sphere{0.1f}, .position = centre}), around);
  // Capsules, cylinders, boxes and hulls of 0.1 to 0.2 m: the places nearest to their surface are within and beyond it.
  const auto holes = [&](const std::vector<Vec3f>& places, const auto& is_left_out) {
    for (const Vec3f& p : fill_box(low, high, spacing)) {
      const bool is_there = std::find(places.begin(), places.end(), p) != places.end();
      EXPECT_EQ(is_there, !is_left_out(p - centre)) << p.x << " " << p.y << " " << p.z;
    }
  };
  const auto in_box = [](const Vec3f& p) {
    const Vec3f over{std::max(std::abs(p.x) - 0.1f, 0.f), std::max(std::abs(p.y) - 0.1f, 0.f),
                     std::max(std::abs(p.z) - 0.1f, 0.f)};
    return std::sqrt(length_squared(over)) < 0.99f * radius;
  };
  holes(left_with(body_of(Box{{0.1f, 0.1f, 0.1f}}, centre)), in_box);
  holes(left_with(body_of(Hull{{{-0.1f, -0.1f, -0.1f},
                                {0.1f, -0.1f, -0.1f},
                                {-0.1f, 0.1f, -0.1f},
                                {0.1f, 0.1f, -0.1f},
                                {-0.1f, -0.1f, 0.1f},
                                {0.1f, -0.1f, 0.1f},
                                {-0.1f, 0.1f, 0.1f},
                                {0.1f, 0.1f, 0.1f}}},
                          centre)),
        in_box);
  holes(left_with(body_of(Cylinder{0.11f, 0.11f}, centre)), [](const Vec3f& p) {
    const float across = std::max(std::sqrt(p.x * p.x + p.z * p.z) - 0.11f, 0.f);
    const float along = std::max(std::abs(p.y) - 0.11f, 0.f);
    return std::sqrt(across * across + along * along) < 0.99f * radius;
  });
  MeshCollider box;
  box.mesh = mesh_of({{.shape = Box{{0.1f, 0.1f, 0.1f}}}}, 8);
  for (Vec3f& p : box.mesh.positions) p += centre;
  holes(left_with(box), in_box);
  box.as = MeshCollider::As::distance_grid;
  holes(left_with(box), in_box);
}

TEST(LeaveOutSolids, FollowsMasksAndCollides) {
  Scene scene;
  Object body = body_of(Sphere{0.1f}, {0, 0.25f, 0});
  body.groups = 2;
  scene.add(body);
  EXPECT_FALSE(left_in(scene).out.empty());
  EXPECT_TRUE(left_in(scene, {radius, 1, 1}).out.empty());
  EXPECT_TRUE(left_in(scene, {radius, 1, ~0U, false}).out.empty());
  scene.objects[0].collides = false;
  EXPECT_TRUE(left_in(scene).out.empty());
}

TEST(LeaveOutSolids, TakesAClosedSurfaceAroundAllForAVessel) {
  MeshCollider collider;
  collider.name = "bag";
  collider.mesh = mesh_of({{.shape = Box{{0.6f, 0.6f, 0.6f}}}}, 8);
  Scene scene;
  scene.add(collider);
  EXPECT_TRUE(left_in(scene).out.empty());
  for (Vec3f& p : scene.mesh_colliders[0].mesh.positions) p.x += 0.6f;  // half of the fill is outside
  const Left left = left_in(scene);
  ASSERT_EQ(left.out.size(), 1U);
  EXPECT_EQ(left.out[0].in, "bag");
  EXPECT_EQ(left.out[0].places, 2000);
}

TEST(LeaveOutSolids, RefusesARadiusThatIsNone) {
  std::vector<Vec3f> places;
  EXPECT_THROW((void)leave_out_solids(places, {}, {0}), Error);
  EXPECT_THROW((void)leave_out_solids(places, {}, {NAN}), Error);
}

}  // namespace
}  // namespace pliant::places_left_out
