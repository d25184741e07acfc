// Tests contacts of one tile: they are the same whether all particles are tested or only those found near; and what a
// contact stores.
#include "collision/narrow/contact.h"

#include <gtest/gtest.h>

#include <random>

#include "math/vector.h"

namespace pliant {
namespace {

int all_of_them(const NearQuery& q, std::int32_t* near) {
  for (int i = q.first; i < q.last; ++i) near[i - q.first] = i;
  return q.last - q.first;
}

struct Tiny {
  CompiledObject object;
  Records positions, displacements, remainders, velocities;
  PointBounds bounds;
  Tiny() {
    object.thickness = 0.01f;
    object.static_friction = 0.9f;
    object.kinetic_friction = 0.4f;
    object.restitution = 0.3f;
  }
  void add(const Vec3f& from, const Vec3f& velocity, float h, float inverse_mass = 1) {
    const Vec3f way = velocity * h, to = from + way;
    positions.push_back({from.x, from.y, from.z, inverse_mass});
    displacements.push_back({way.x, way.y, way.z, 0});
    remainders.emplace_back();
    velocities.push_back({velocity.x, velocity.y, velocity.z, 0});
    const Vec3f low = min(from, to), high = max(from, to);
    bounds.low = {min(bounds.low.x, low.x), min(bounds.low.y, low.y), min(bounds.low.z, low.z), 0};
    bounds.high = {max(bounds.high.x, high.x), max(bounds.high.y, high.y), max(bounds.high.z, high.z), 0};
  }
  /// The height of a contact's particle above the contact's plane [m].
  float height(const Contact& contact) const {
    const Record& d = displacements[static_cast<std::size_t>(contact.point[0])];
    return contact.gap + dot(contact.normal, Vec3f{d.x, d.y, d.z});
  }
  std::vector<Contact> contacts(const std::vector<Collider>& colliders, float h, const PointBounds& within) {
    Model model;
    model.colliders = colliders;
    std::vector<MovingCollider> moving;
    move_colliders(model, {}, 0, static_cast<double>(h), moving);
    AdvanceArguments a;
    a.positions = positions.data();
    a.displacements = displacements.data();
    a.remainders = remainders.data();
    a.velocities = velocities.data();
    a.last = static_cast<int>(positions.size());
    a.h = h;
    a.inverse_h = 1 / h;
    std::vector<Contact> found;
    std::vector<std::int32_t> near;
    find_contacts({object, a, within, moving, all_of_them}, near, found);
    return found;
  }
};

TEST(Contacts, HoldThePlaneOfTheSurfaceAndThePairsNumbers) {
  Tiny tiny;
  tiny.add({0.2f, 0.305f, 0}, {0, -1, 0}, 0.01f);
  Collider box;
  box.shape = Box{{1, 0.3f, 1}};
  box.thickness = 0.02f;
  box.static_friction = 0.4f;
  box.kinetic_friction = 0.1f;
  box.restitution = 0.1f;
  const std::vector<Contact> found = tiny.contacts({box}, 0.01f, tiny.bounds);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].normal, (Vec3f{0, 1, 0}));
  EXPECT_FLOAT_EQ(found[0].static_friction, 0.6f);
  EXPECT_FLOAT_EQ(found[0].kinetic_friction, 0.2f);
  EXPECT_EQ(found[0].restitution, 0.3f);
  EXPECT_FLOAT_EQ(found[0].approach, -1);
  EXPECT_EQ(found[0].push, 0);
  // A particle within the thickness at the start moves out at 2 m/s at most.
  EXPECT_NEAR(found[0].gap, 0.005 - (0.005 + 0.02), 1e-6);
}

TEST(Contacts, NoneWithoutFreeMassAndNoneFarAway) {
  Tiny tiny;
  tiny.add({0, -0.5f, 0}, {}, 0.01f, 0);
  tiny.add({0, 5, 0}, {0, -1, 0}, 0.01f);
  EXPECT_TRUE(tiny.contacts({Collider{}}, 0.01f, tiny.bounds).empty());
}

TEST(Contacts, BoundsSpareWorkAndNoContact) {
  std::mt19937 random(9);
  const auto uniform = [&](double low, double high) {
    return static_cast<float>(low + (high - low) * static_cast<double>(random()) / 4294967295.0);
  };
  PointBounds everywhere{{-1e9f, -1e9f, -1e9f, 0}, {1e9f, 1e9f, 1e9f, 0}};
  std::size_t met = 0;
  for (int round = 0; round < 2000; ++round) {
    Tiny tiny;
    const float h = uniform(1e-4, 0.02);
    const Vec3f centre{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
    for (int i = 0; i < 5; ++i) {
      tiny.add(centre + Vec3f{uniform(-.1, .1), uniform(-.1, .1), uniform(-.1, .1)},
               {uniform(-9, 9), uniform(-9, 9), uniform(-9, 9)}, h);
    }
    std::vector<Collider> colliders(3);
    colliders[0].shape = Sphere{uniform(0.01, 0.5)};
    colliders[1].shape = Box{{uniform(0.01, 0.5), uniform(0.01, 0.5), uniform(0.01, 0.5)}};
    colliders[2].shape = Capsule{uniform(0.01, 0.3), uniform(0, 0.5)};
    for (Collider& collider : colliders) {
      collider.position = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
      collider.rotation = rotation({1, uniform(-1, 1), 0}, uniform(0, 360));
      collider.motion.keyframes = {
          Keyframe{0, {}, {}},
          Keyframe{h, {uniform(-.3, .3), uniform(-.3, .3), 0}, rotation({0, 1, 0}, uniform(0, 20))}};
    }
    const std::vector<Contact> few = tiny.contacts(colliders, h, tiny.bounds),
                               all = tiny.contacts(colliders, h, everywhere);
    // Contacts that the search by bounds misses may exist, but none of them may be active.
    std::size_t next = 0;
    for (const Contact& contact : all) {
      const bool same =
          next < few.size() && few[next].point[0] == contact.point[0] && few[next].collider == contact.collider;
      if (same) ++next;
      EXPECT_TRUE(same || tiny.height(contact) > -1e-6f) << "round " << round << ": a contact was left out";
    }
    EXPECT_EQ(next, few.size());
    met += few.size();
  }
  EXPECT_GT(met, 500u);
}

TEST(Contacts, PushAndSlipWithinTheConeOfFriction) {
  Tiny tiny;
  const float h = 0.01f;
  tiny.add({0, 0.0f, 0}, {1, -1, 0}, h);
  std::vector<Contact> found = tiny.contacts({Collider{}}, h, tiny.bounds);
  ASSERT_EQ(found.size(), 1u);
  found[0].gap = 0;  // on the surface itself
  found[0].static_friction = 0.6f;
  found[0].kinetic_friction = 0.5f;
  SweepArguments a;
  a.positions = tiny.positions.data();
  a.displacements = tiny.displacements.data();
  a.remainders = tiny.remainders.data();
  a.h = h;
  for (int i = 0; i < 3; ++i) project_contacts(found, a);
  // Pressed by 0.01 m and sliding as far: friction takes back half of the press.
  EXPECT_NEAR(tiny.displacements[0].y, 0, 1e-7);
  EXPECT_NEAR(found[0].push, 0.01, 1e-7);
  EXPECT_NEAR(tiny.displacements[0].x, 0.005, 1e-6);
  found[0].static_friction = found[0].kinetic_friction = 1.5f;
  project_contacts(found, a);
  EXPECT_NEAR(tiny.displacements[0].x, 0, 1e-6) << "with more, it sticks";
}

}  // namespace
}  // namespace pliant
