// Tests lists of particles near solids against brute force, and that contacts found with them are those of all
// particles.
#include "collision/narrow/near_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <random>

#include "collision/narrow/contact.h"
#include "collision/points_support.h"
#include "pliant/mesh.h"

namespace pliant {
namespace {

using testing_support::is_inside;

Vec3f random_vector(std::mt19937& random, float size) {
  std::uniform_real_distribution<float> unit(-size, size);
  return {unit(random), unit(random), unit(random)};
}

Records random_points(std::mt19937& random, int count, float size) {
  Records points;
  for (int i = 0; i < count; ++i) {
    const Vec3f p = random_vector(random, size);
    points.push_back({p.x, p.y, p.z, 1});
  }
  return points;
}

/// Moves all points at random. Returns by how much the fastest one moved.
float shake(std::mt19937& random, float size, Records& points) {
  float fastest = 0;
  for (Record& p : points) {
    const Vec3f by = random_vector(random, size), to = Vec3f{p.x, p.y, p.z} + by;
    fastest = std::max(fastest, length(to - Vec3f{p.x, p.y, p.z}));
    p = {to.x, to.y, to.z, p.w};
  }
  return fastest;
}

bool has(const NearPoints::List& list, int i) { return std::binary_search(list.points.begin(), list.points.end(), i); }

TEST(NearPoints, HaveAllPointsInABoxWhileBothMove) {
  std::mt19937 random(7);
  Records points = random_points(random, 3000, 1);
  NearPoints near;
  float moved = std::numeric_limits<float>::infinity();
  Vec3f middle{};
  for (int substep = 0; substep < 200; ++substep) {
    near.begin_substep(points.data(), 50, 2950, moved);
    middle += random_vector(random, 0.02f);
    const BoxBounds box = BoxBounds{middle, middle}.grown(0.4f);
    const NearPoints::List& list = near.near(3, box, 0.05f);
    EXPECT_TRUE(std::is_sorted(list.points.begin(), list.points.end()));
    EXPECT_EQ(list.points.size(), list.known.size());
    for (int i = 50; i < 2950; ++i)
      if (is_inside(points[static_cast<std::size_t>(i)], box)) {
        EXPECT_TRUE(has(list, i)) << i << " in substep " << substep;
      }
    moved = shake(random, 0.01f, points);
  }
}

TEST(NearPoints, KeepAListWhileLittleMoves) {
  std::mt19937 random(8);
  Records points = random_points(random, 100, 1);
  NearPoints near;
  const BoxBounds box{{-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}};
  near.begin_substep(points.data(), 0, 100, std::numeric_limits<float>::infinity());
  near.near(0, box, 0.1f).points.clear();  // a mark
  near.begin_substep(points.data(), 0, 100, 0.05f);
  EXPECT_TRUE(near.near(0, box, 0.1f).points.empty());
  near.begin_substep(points.data(), 0, 100, 0.06f);
  EXPECT_FALSE(near.near(0, box, 0.1f).points.empty());
}

TEST(NearPoints, KeepWhatIsKnownOfPointsThatStayNear) {
  std::mt19937 random(9);
  Records points = random_points(random, 100, 1);
  NearPoints near;
  near.begin_substep(points.data(), 0, 100, std::numeric_limits<float>::infinity());
  NearPoints::List& first = near.near(0, {{-1, -1, -1}, {0.2f, 1, 1}}, 0);
  for (std::size_t k = 0; k < first.points.size(); ++k) first.known[k].distance = static_cast<float>(first.points[k]);
  const std::vector<std::int32_t> before = first.points;
  const NearPoints::List& second = near.near(0, {{-0.2f, -1, -1}, {1, 1, 1}}, 0);
  for (std::size_t k = 0; k < second.points.size(); ++k) {
    const int i = second.points[k];
    const bool was_listed = std::binary_search(before.begin(), before.end(), i);
    EXPECT_EQ(second.known[k].distance, was_listed ? static_cast<float>(i) : NearPoints::Known{}.distance);
  }
}

TEST(NearPoints, ForgetListsOfCollidersThatAreFar) {
  std::mt19937 random(10);
  Records points = random_points(random, 100, 1);
  NearPoints near;
  near.begin_substep(points.data(), 0, 100, std::numeric_limits<float>::infinity());
  const BoxBounds box{{-2, -2, -2}, {2, 2, 2}};
  near.near(2, box, 0).known[0].distance = 7;
  near.near(5, box, 0).known[0].distance = 8;
  near.keep_only({1, 5});
  EXPECT_EQ(near.near(5, box, 0).known[0].distance, 8);
  EXPECT_NE(near.near(2, box, 0).known[0].distance, 7);
}

// ---------------------------------------------------------------- contacts

/// Particles of an object whose positions start at number `first` of the State, and solids that move among them.
struct Cloud {
  static constexpr float h = 1.f / 600;
  static constexpr int first = 20, count = 500;
  CompiledObject object;
  Records positions, displacements, remainders, velocities;
  SolidField cone;
  std::vector<MovingCollider> solids;

  explicit Cloud(std::mt19937& random) : cone(DistanceGrid(measure_distances(sphere_mesh(2), 0.15f))) {
    object.thickness = 0.02f;
    positions = random_points(random, first + count, 1.6f);
    displacements.resize(positions.size());
    remainders.resize(positions.size());
    velocities.resize(positions.size());
    solids.resize(3);
    solids[0].shape = {ShapeKind::sphere, 0.6f};
    solids[1].field = &cone;
    solids[2].shape = {ShapeKind::box, 0.3f, 0.6f, 0.4f};
    for (MovingCollider& solid : solids) solid.moves = true;
  }

  /// A substep in which particles move by up to `size` and solids along with them. Returns the fastest particle's
  /// displacement.
  float begin_substep(std::mt19937& random, float size) {
    float fastest = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const Vec3f by = random_vector(random, size), v = by * (1 / h);
      displacements[i] = {by.x, by.y, by.z, 0};
      velocities[i] = {v.x, v.y, v.z, 0};
      fastest = std::max(fastest, length(by));
    }
    for (MovingCollider& solid : solids) {
      solid.before = solid.after;
      solid.after.position += random_vector(random, size);
      const Vec3f turn = random_vector(random, 0.02f);
      Quatf q{turn.x, turn.y, turn.z, 1};
      const float scale = 1 / std::sqrt(turn.x * turn.x + turn.y * turn.y + turn.z * turn.z + 1);
      q = multiply({q.x * scale, q.y * scale, q.z * scale, q.w * scale}, solid.after.rotation);
      solid.after.rotation = q;
      const Vec3f middle = (solid.before.position + solid.after.position) * 0.5f, by{1.2f, 1.2f, 1.2f};
      solid.swept = {middle - by, middle + by};
    }
    return fastest;
  }

  /// Returns how far the fastest particle moved.
  float end_substep() {
    float moved = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      Record& p = positions[i];
      const Record& d = displacements[i];
      const Vec3f before{p.x, p.y, p.z};
      p = {p.x + d.x, p.y + d.y, p.z + d.z, p.w};
      moved = std::max(moved, length(Vec3f{p.x, p.y, p.z} - before));
    }
    return moved;
  }

  std::vector<Contact> contacts(NearPoints* near_points, float fastest) const {
    AdvanceArguments a;
    a.positions = const_cast<Record*>(positions.data()) + first;
    a.displacements = const_cast<Record*>(displacements.data()) + first;
    a.remainders = const_cast<Record*>(remainders.data()) + first;
    a.velocities = const_cast<Record*>(velocities.data()) + first;
    a.last = count;
    a.h = h;
    a.inverse_h = 1 / h;
    PointBounds bounds;
    bounds.low = {-9, -9, -9, 0};
    bounds.high = {9, 9, 9, 0};
    const std::vector<int> all{0, 1, 2};
    std::vector<std::int32_t> near;
    std::vector<Contact> found;
    find_contacts({object, a, bounds, solids, nullptr, nullptr, &all, near_points, first, fastest}, near, found);
    return found;
  }
};

TEST(NearPoints, GiveTheContactsOfAllParticles) {
  std::mt19937 random(11);
  Cloud cloud(random);
  NearPoints near;
  float moved = std::numeric_limits<float>::infinity();
  std::size_t of_grid = 0, of_shapes = 0;
  for (int substep = 0; substep < 150; ++substep) {
    near.begin_substep(cloud.positions.data(), Cloud::first, Cloud::first + Cloud::count, moved);
    const float fastest = cloud.begin_substep(random, substep % 40 < 30 ? 0.001f : 0.03f);
    const std::vector<Contact> all = cloud.contacts(nullptr, fastest), listed = cloud.contacts(&near, fastest);
    ASSERT_EQ(all.size(), listed.size()) << substep;
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_EQ(all[i].point, listed[i].point);
      EXPECT_EQ(all[i].collider, listed[i].collider);
      EXPECT_EQ(all[i].gap, listed[i].gap);
      EXPECT_TRUE(all[i].normal == listed[i].normal);
      ++(all[i].collider == 1 ? of_grid : of_shapes);
    }
    moved = cloud.end_substep();
  }
  EXPECT_GT(of_grid, 1000u);
  EXPECT_GT(of_shapes, 1000u);
}

}  // namespace
}  // namespace pliant
