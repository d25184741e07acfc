// Simulates every scene in scenes/contact frame by frame, and checks with exact signs that an edge passes through a
// triangle only where the scene allows it. A new scene there is tested without a change here.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "pliant/pliant.h"
#include "support/paths.h"

namespace pliant {
namespace {

namespace fs = std::filesystem;

/// What a scene shows besides that nothing crosses, and how many frames it takes to show it.
struct Expectation {
  int frames = 90;
  bool crosses_at_start = false;
  bool crosses_later = false;
};

Expectation expectation_of(const std::string& scene) {
  static const std::map<std::string, Expectation> special{
      {"fold_no_filter", {20, false, true}},   // the filter is off; the first edge crosses in frame 8
      {"fold_no_contact", {90, false, true}},  // contact is off too
      {"untangle", {90, true, false}},         // intersects at the start and is moved apart
      {"layers", {24, false, false}},          // ten layers, which land on each other in frame 16
      // Without the filter the first edge crosses in frame 8; without contact of the cloth with itself in frame 12.
      {"fold_filter", {40, false, false}},
      {"fold", {40, false, false}},
      {"solids", {36, false, false}},  // without contact of the cloth with itself: in frame 13
  };
  const auto found = special.find(scene);
  return found == special.end() ? Expectation{} : found->second;
}

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(test::in_tree("scenes/contact")))
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// The triangles of all surfaces that a scene keeps apart: objects, and mesh colliders as triangles.
class Surfaces {
 public:
  explicit Surfaces(const Scene& scene) {
    for (const Object& object : scene.objects) add(object.triangles, object.positions.size());
    for (const MeshCollider& collider : scene.mesh_colliders) {
      as_triangles_.push_back(collider.as == MeshCollider::As::triangles);
      if (as_triangles_.back()) add(collider.mesh.triangles, collider.mesh.positions.size());
    }
  }

  TriangleMesh at(const World& world) const {
    TriangleMesh mesh{{}, triangles_};
    const auto append = [&](const std::vector<Vec3f>& more) {
      mesh.positions.insert(mesh.positions.end(), more.begin(), more.end());
    };
    for (int o = 0; o < world.object_count(); ++o) append(world.object(o).positions());
    for (std::size_t c = 0; c < as_triangles_.size(); ++c)
      if (as_triangles_[c]) append(world.mesh_collider(static_cast<int>(c)).positions());
    return mesh;
  }

 private:
  void add(const std::vector<std::array<int, 3>>& triangles, std::size_t vertices) {
    for (const auto& [a, b, c] : triangles) triangles_.push_back({count_ + a, count_ + b, count_ + c});
    count_ += static_cast<int>(vertices);
  }

  std::vector<std::array<int, 3>> triangles_;
  std::vector<bool> as_triangles_;
  int count_ = 0;
};

class ContactScene : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Scenes, ContactScene, testing::ValuesIn(scene_names()),
                         [](const auto& scene) { return scene.param; });

TEST_P(ContactScene, CrossesNothingThatItDoesNotSay) {
  const Scene scene = read_scene(test::in_tree("scenes/contact/" + GetParam() + ".json"));
  const Expectation expected = expectation_of(GetParam());
  World world(scene);
  const Surfaces surfaces(scene);
  std::size_t most = 0, last = find_crossings(surfaces.at(world)).size();
  EXPECT_EQ(last > 0, expected.crosses_at_start);
  for (int frame = 0; frame < std::min(scene.frames, expected.frames); ++frame) {
    const Report report = world.step(scene.frame_time);
    ASSERT_TRUE(report.ok()) << report.explain();
    if (!expected.crosses_at_start) {
      EXPECT_EQ(report.pairs.unresolvable, 0) << "frame " << frame;
    }
    last = find_crossings(surfaces.at(world)).size();
    most = std::max(most, last);
  }
  if (!expected.crosses_at_start) {
    EXPECT_EQ(most > 0, expected.crosses_later) << most << " edges pass through a triangle";
  }
  EXPECT_EQ(last > 0, expected.crosses_later) << last << " edges pass through a triangle at the end";
}

}  // namespace
}  // namespace pliant
