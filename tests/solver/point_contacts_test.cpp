// Contacts of particles with primitive colliders: lanes of every level give the bits of one particle at a time.
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "collision/narrow/contact.h"
#include "pliant/error.h"
#include "solver/contact_kernels.h"
#include "solver/kernels.h"
#include "solver/random_support.h"
#include "support/kernels.h"

namespace pliant {
namespace {

using testing_support::random_vector;
using testing_support::uniform_float;

LocalShape random_shape(std::mt19937& random, ShapeKind kind) {
  const float a = uniform_float(random, 0.05f, 0.3f), b = uniform_float(random, 0, 0.3f);
  return {kind, a, b, uniform_float(random, 0.02f, 0.3f)};
}

constexpr ShapeKind kinds[] = {ShapeKind::plane, ShapeKind::sphere, ShapeKind::capsule, ShapeKind::box};

/// Particles near the surface of a collider: at rest, sliding, fast, some of them fixed.
struct ParticlesNearCollider {
  CompiledObject object;
  std::vector<MovingCollider> colliders{1};
  Records positions, displacements, remainders, velocities;
  AdvanceArguments particles;
  PointBounds bounds;

  ParticlesNearCollider(std::mt19937& random, ShapeKind kind, bool moves, int count) {
    object.thickness = 0.004f;
    object.static_friction = object.kinetic_friction = 0.5f;
    MovingCollider& collider = colliders[0];
    collider.shape = random_shape(random, kind);
    collider.thickness = 0.001f;
    collider.static_friction = collider.kinetic_friction = 0.4f;
    const Vec3f axis = random_vector(random, 1);
    collider.before = {random_vector(random, 2), normalise(Quat<float>{axis.x, axis.y, axis.z, 0.7f})};
    collider.after = collider.before;
    collider.moves = moves;
    if (moves) collider.after.position = collider.before.position + random_vector(random, 0.002f);
    collider.swept = {Vec3f{-1e9f, -1e9f, -1e9f}, Vec3f{1e9f, 1e9f, 1e9f}};
    for (int i = 0; i < count; ++i) add(random, i);
    particles.positions = positions.data();
    particles.displacements = displacements.data();
    particles.remainders = remainders.data();
    particles.velocities = velocities.data();
    particles.last = count;
    particles.h = 0.001f;
    particles.inverse_h = 1000;
    particles.gravity_step = {0, -0.01f, 0};
    particles.gravity_begun = {0, -0.05f, 0};
  }

  void add(std::mt19937& random, int i) {
    const Pose<float>& pose = colliders[0].before;
    const Vec3f anywhere = random_vector(random, 0.4f);
    const SurfaceDistance<float> surface = signed_distance(colliders[0].shape, anywhere);
    const Vec3f near = anywhere + surface.normal * (uniform_float(random, -0.004f, 0.008f) - surface.distance),
                at = to_world(pose, near),
                d = random_vector(random, i % 3 == 0   ? 0.02f
                                          : i % 3 == 1 ? 0.002f
                                                       : 1e-5f),
                r = random_vector(random, 1e-8f), v = random_vector(random, 2);
    positions.push_back({at.x, at.y, at.z, i % 7 == 0 ? 0.f : 2.f});
    displacements.push_back({d.x, d.y, d.z, 0});
    remainders.push_back({r.x, r.y, r.z, 0});
    velocities.push_back({v.x, v.y, v.z, 0});
  }

  std::vector<Contact> contacts(const Kernels& kernels, MakePointContacts make) const {
    const PointBounds everywhere{{-10, -10, -10, 0}, {10, 10, 10, 0}};
    std::vector<std::int32_t> near;
    std::vector<Contact> found;
    find_contacts({object, particles, everywhere, colliders, kernels.find_near, make}, near, found);
    return found;
  }
};

TEST(PointContacts, AreTheSameInLanesAsOneByOne) {
  std::mt19937 random(17);
  int found = 0;
  for (const std::string& isa : testing_support::available_isas()) {
    const Kernels& kernels = pick_kernels(isa);
    for (const ShapeKind kind : kinds)
      for (const bool moves : {false, true})
        for (const int count : {1, 15, 16, 17, 200}) {
          const ParticlesNearCollider meeting(random, kind, moves, count);
          const std::vector<Contact> lanes = meeting.contacts(kernels, kernels.contacts.make_point_contacts),
                                     single = meeting.contacts(kernels, nullptr);
          ASSERT_EQ(lanes.size(), single.size()) << isa << ", shape " << static_cast<int>(kind) << ", " << count;
          for (std::size_t i = 0; i < lanes.size(); ++i)
            EXPECT_EQ(std::memcmp(&lanes[i], &single[i], sizeof(Contact)), 0)
                << isa << ", shape " << static_cast<int>(kind) << ", contact " << i << " of " << lanes.size();
          found += static_cast<int>(lanes.size());
        }
  }
  EXPECT_GT(found, 1000);
}

TEST(PointContacts, PathsThatStayBeyondHaveNoFirstHit) {
  std::mt19937 random(5);
  int beyond = 0, hits = 0;
  for (int i = 0; i < 200000; ++i) {
    const LocalShape shape = random_shape(random, kinds[i % 4]);
    const float margin = uniform_float(random, 0, 0.005f);
    const Vec3f start = random_vector(random, 0.5f);
    const SurfaceDistance<float> surface = signed_distance(shape, start);
    const Vec3f a = start + surface.normal * (margin + uniform_float(random, -0.001f, 0.01f) - surface.distance),
                b = a + random_vector(random, i % 2 == 0 ? 0.02f : 0.2f);
    const bool hit = first_hit(shape, a, b, margin).hit;
    const bool stays = stays_beyond(margin, signed_distance(shape, b), b, b - a);
    EXPECT_FALSE(stays && hit) << "path " << i;
    beyond += stays ? 1 : 0;
    hits += hit ? 1 : 0;
  }
  EXPECT_GT(beyond, 20000);
  EXPECT_GT(hits, 20000);
}

}  // namespace
}  // namespace pliant
