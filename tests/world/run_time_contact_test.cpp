// Tests contact between surfaces while objects are added and removed: a World that updates its contact must give the
// same bits as one that makes it from the start.
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <string>

#include "world/run_time_support.h"

namespace pliant {
namespace {

using namespace testing_support;

Object thick_sheet(const std::string& name, const Vec3f& at, int n, float thickness) {
  Object object = sheet_at(name, at, n, 0.5f);
  object.collides = true;
  object.thickness = thickness;
  return object;
}

MeshCollider block(const Vec3f& at) {
  MeshCollider collider;
  collider.mask = 1;
  collider.name = "block";
  collider.mesh = box_mesh({0.3f, 0.2f, 0.3f});
  for (Vec3f& p : collider.mesh.positions) p += at;
  return collider;
}

/// A World to which objects are added and from which they are removed, with the descriptions of all its objects.
class Life {
 public:
  /// With an even seed, the pair of two names has contact properties of its own.
  Life(const Settings& settings, std::uint64_t seed)
      : random_(seed), is_split_(settings.substeps == 0), world_(begin(settings, seed % 2 == 0)) {}

  World& world() { return world_; }

  void change() {
    const std::size_t count = objects_.size();
    const std::uint64_t kind = random_() % 10;
    if (count < 4 || (kind < 4 && count < 14)) {
      const Object object = any_object();
      objects_[key(world_.add(object))] = object;
    } else if (kind < 7) {
      const auto at = std::next(objects_.begin(), static_cast<std::ptrdiff_t>(random_() % count));
      world_.remove(ObjectId(at->first.first, at->first.second));
      objects_.erase(at);
    } else if (kind == 7) {
      edit();
    } else if (meshes_.size() < 2) {
      const MeshCollider mesh = block({place(), place() - 0.5f, place()});
      meshes_[key(world_.add(mesh))] = mesh;
    } else {
      world_.remove(MeshColliderId(meshes_.begin()->first.first, meshes_.begin()->first.second));
      meshes_.erase(meshes_.begin());
    }
  }

  /// The same World made from the start, in the same State.
  World made_again() const {
    Scene scene;
    scene.settings = world_.settings();
    scene.pairs = pairs_;
    for (const ObjectId id : world_.objects()) scene.objects.push_back(objects_.at(key(id)));
    for (const MeshColliderId id : world_.mesh_colliders()) scene.mesh_colliders.push_back(meshes_.at(key(id)));
    World world(scene, world_.layout());
    world.restore(world_.state());
    return world;
  }

 private:
  using Key = std::pair<int, int>;  // slot and generation
  template <class Id>
  static Key key(const Id& id) {
    return {id.slot, id.generation};
  }

  World begin(const Settings& settings, bool with_pair) {
    Scene scene;
    scene.settings = settings;
    objects_[{0, 0}] = thick_sheet("thick", {0.1f, 0.1f, 0.1f}, 5, 0.015f);
    meshes_[{0, 0}] = block({});
    scene.add(objects_[{0, 0}]);
    scene.add(meshes_[{0, 0}]);
    if (is_split_) {  // a World whose objects all have the same number of substeps keeps that number
      Object& other = objects_[{1, 0}] = thick_sheet("other", {1, 1, 1}, 5, 0.002f);
      other.sweep = Sweep::multigrid;
      other.groups = other.mask = 2;
      scene.add(other);
    }
    if (with_pair) pairs_.push_back({"thick", "block", 0.03f, 0.1f, {}, {}});
    scene.pairs = pairs_;
    return World(scene);
  }

  float place() { return static_cast<float>(random_() % 100) * 0.004f; }

  Object any_object() {
    const Vec3f at{place(), place(), place()};
    const std::uint64_t kind = random_() % 8;
    if (kind == 0) {  // a rope
      Object rope = chain(4 + static_cast<int>(random_() % 10), 0.05f);
      for (Vec3f& p : rope.positions) p += at;
      rope.collides = true;
      return rope;
    }
    if (kind == 1) {  // free particles that collide with one another
      Object grains;
      grains.name = "grains";
      for (int i = 0; i < 12; ++i) grains.positions.push_back(at + Vec3f{0.01f * static_cast<float>(i), 0.3f, 0});
      grains.masses.assign(12, 0.01f);
      grains.thickness = 0.008f;
      grains.self_collision = grains.collides = true;
      return grains;
    }
    if (kind == 2) return thick_sheet("thick", at, 5, 0.015f);
    Object object = thick_sheet("sheet", at, 4 + static_cast<int>(random_() % 9), 0.002f);
    object.self_collision = kind == 3 || kind == 4;
    if (kind == 5) object.groups = object.mask = 2;  // meets only objects of this group
    if (is_split_ && kind > 2) split(object);
    if (kind == 6)
      for (Vec3f& p : object.positions) p = {p.x, p.z, 0.02f};  // upright, through the other objects
    return object;
  }

  /// Makes three sets that never meet, two of them with half the substeps, and sometimes an object that joins one of
  /// them to the first.
  void split(Object& object) {
    const std::uint64_t set = random_() % 9;
    if (set < 3) return;
    object.groups = object.mask = set < 5 ? 2 : set < 8 ? 4 : 3;
    if (set < 8) object.sweep = Sweep::multigrid;
  }

  /// Edits an object: other particles in the same place.
  void edit() {
    const auto at = std::next(objects_.begin(), static_cast<std::ptrdiff_t>(random_() % objects_.size()));
    Edit edit;
    edit.object = thick_sheet("edited", {place(), place(), place()}, 4 + static_cast<int>(random_() % 6), 0.003f);
    edit.from.assign(edit.object.positions.size(), -1);
    const ObjectId id(at->first.first, at->first.second);
    world_.edit(id, edit);
    at->second = edit.object;
  }

  std::mt19937_64 random_;
  bool is_split_ = false;  ///< true: several groups of substeps
  std::map<Key, Object> objects_;
  std::map<Key, MeshCollider> meshes_;
  std::vector<PairProperties> pairs_;
  World world_;  // last, since begin() fills the other members
};

Settings settings_of_life(Settings::Intersections intersections, bool filter) {
  Settings settings = settings_of(2);
  settings.sweep = Sweep::tiled;
  settings.threads = 2;
  settings.initial_intersections = intersections;
  settings.contact_filter = filter;
  return settings;
}

void expect_the_bits_of_a_world_made_again(const Settings& settings, std::uint64_t seed, int least_contacts = 1000) {
  Life life(settings, seed);
  std::int64_t contacts = 0, intersecting = 0;
  for (int round = 0; round < 40; ++round) {
    for (int changes = 0; changes < 1 + round % 3; ++changes) life.change();
    World expected = life.made_again();
    for (int frame = 0; frame < 3; ++frame) {
      const Report by = life.world().step(dt), again = expected.step(dt);
      ASSERT_TRUE(by.ok());
      ASSERT_EQ(life.world().state_hash(), expected.state_hash()) << "round " << round << ", frame " << frame;
      ASSERT_EQ(by.pairs.contacts, again.pairs.contacts) << round;
      ASSERT_EQ(by.pairs.initially_intersecting, again.pairs.initially_intersecting) << round;
      contacts += by.pairs.contacts;
      intersecting += by.pairs.initially_intersecting;
    }
  }
  EXPECT_GT(contacts, least_contacts);
  EXPECT_GT(intersecting, 10);
}

TEST(RunTimeContact, IsThatOfAWorldMadeFromTheStart) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
    expect_the_bits_of_a_world_made_again(settings_of_life(Settings::Intersections::leave, true), seed);
}

TEST(RunTimeContact, IsThatOfAWorldMadeFromTheStartWithoutTheFilter) {
  expect_the_bits_of_a_world_made_again(settings_of_life(Settings::Intersections::leave, false), 7);
}

TEST(RunTimeContact, IsThatOfAWorldMadeFromTheStartWhereIntersectionsAreUntangled) {
  expect_the_bits_of_a_world_made_again(settings_of_life(Settings::Intersections::untangle, true), 8);
}

TEST(RunTimeContact, IsThatOfAWorldMadeFromTheStartWhereSetsHaveDifferentSubsteps) {
  Settings settings = settings_of_life(Settings::Intersections::leave, true);
  settings.substeps = 0;
  for (std::uint64_t seed = 9; seed <= 12; ++seed) expect_the_bits_of_a_world_made_again(settings, seed, 300);
}

/// An object that falls beside the place of a removed one must not cause more rebuilds than one that falls alone.
TEST(RunTimeContact, PairsClustersAgainNoMoreOftenAfterARemoval) {
  Scene scene;
  scene.settings = settings_of(10);
  for (int i = 0; i < 6; ++i)
    scene.add(thick_sheet("sheet " + std::to_string(i), {0, 2 * static_cast<float>(i), 0}, 12, 0.005f));
  World world(scene);
  for (int frame = 0; frame < 5; ++frame) world.step(dt);
  world.remove(ObjectId(2));
  scene.objects.erase(scene.objects.begin() + 2);
  World without(scene);
  std::int64_t rebuilds = 0, least = 0;
  for (int frame = 0; frame < 60; ++frame) {
    rebuilds += world.step(dt).pairs.rebuilds;
    least += without.step(dt).pairs.rebuilds;
  }
  EXPECT_LE(rebuilds, least + 1);
}

}  // namespace
}  // namespace pliant
