// Cuts by a blade: where, when, and in how many pieces.
#include <atomic>

#include "pliant/edit.h"
#include "pliant/stitch.h"
#include "tears/tears_support.h"

namespace pliant {
namespace {

using namespace testing_support;

Object block() {
  SoftBodyOptions options;
  options.material.youngs_modulus = 2e4f;
  return make_soft_body(box_tetrahedra({0.4f, 0.2f, 0.2f}, {4, 2, 2}), options);
}

TEST(PlaneCut, PartsABlockInHalvesAtOnce) {
  Object object = block();
  object.cuts.push_back({0.5f, 0.5f, {}, {1, 0, 0}, {0, -1, 0}});
  World world(weightless(object, 20));
  EXPECT_EQ(run_and_tear(world, 29).new_particles, 0) << "not before its time";
  EXPECT_EQ(run_and_tear(world, 3).new_particles, 9) << "the middle has 3 x 3 nodes";
  const Object& after = world.object(ObjectId(0)).description();
  EXPECT_EQ(pieces_of(after), 2);
  EXPECT_NEAR(mass_of(after) / mass_of(object), 1, 1e-6);
  EXPECT_EQ(run_and_tear(world, 30).new_particles, 0) << "once";
}

TEST(PlaneCut, IsMadeAfterAStoppedStepAndForWhatIsAddedLate) {
  Object object = block();
  object.cuts.push_back({0.101f, 0.101f, {}, {1, 0, 0}, {0, -1, 0}});
  World world(weightless(object, 20));
  run_and_tear(world, 6);
  std::atomic<bool> stop{false};
  world.stop_when(&stop);
  stop = true;
  world.step(1.f / 60);
  stop = false;
  EXPECT_EQ(run_and_tear(world, 3).new_particles, 9);
  object.cuts[0].start = object.cuts[0].end = 0;
  for (Vec3f& p : object.positions) p.y += 2;
  world.add(object);
  EXPECT_EQ(run_and_tear(world, 1).new_particles, 9) << "a cut of the past";
}

TEST(PlaneCut, FollowsTheBlade) {
  Object object = block();
  object.cuts.push_back({0, 1, {}, {1, 0, 0}, {0, -1, 0}});
  EXPECT_FALSE(make_cuts(object, -0.1));
  EXPECT_FALSE(make_cuts(object, 0.1)) << "the blade is above the middle of the first faces";
  const std::optional<Edit> half = make_cuts(object, 0.5);
  ASSERT_TRUE(half);
  EXPECT_EQ(pieces_of(half->object), 1);
  for (std::size_t i = object.positions.size(); i < half->object.positions.size(); ++i)
    EXPECT_GE(half->object.positions[i].y, -1e-6f) << "only the upper half is open";
  const std::optional<Edit> whole = make_cuts(half->object, 1);
  ASSERT_TRUE(whole);
  EXPECT_EQ(pieces_of(whole->object), 2);
  EXPECT_FALSE(make_cuts(whole->object, 2)) << "all of it is made";
}

TEST(PlaneCut, PartsClothAndRope) {
  Object cloth = make_cloth(grid_mesh(9, 9, 1, 1));
  cloth.cuts.push_back({0, 0, {0.01f, 0, 0}, {1, 0, 0}, {0, 0, 1}});
  const std::optional<Edit> parted = make_cuts(cloth, 0);
  ASSERT_TRUE(parted);
  EXPECT_EQ(pieces_of(parted->object), 2);
  EXPECT_EQ(parted->object.positions.size(), 90u);
  std::vector<Vec3f> points;
  for (int i = 0; i < 11; ++i) points.push_back({0.1f * static_cast<float>(i), 0, 0});
  Object rope = make_rope(points);
  rope.cuts.push_back({0, 0, {0.45f, 0, 0}, {1, 0, 0}, {0, -1, 0}});
  const std::optional<Edit> two = make_cuts(rope, 0);
  ASSERT_TRUE(two);
  EXPECT_EQ(pieces_of(two->object), 2);
  EXPECT_EQ(two->object.positions.size(), rope.positions.size());
}

TEST(PlaneCut, HalvesFallApartAndDoNotPassThroughEachOther) {
  Object object = block();
  object.self_collision = true;
  object.cuts.push_back({0.2f, 0.6f, {}, {1, 0, 0.3f}, {0, -1, 0}});
  Scene scene = weightless(object, 20);
  scene.gravity = {0, -9.81f, 0};
  scene.colliders.push_back({});
  scene.colliders[0].position = {0, -0.12f, 0};
  World world(scene);
  EXPECT_GT(run_and_tear(world, 180).new_particles, 0);
  EXPECT_EQ(pieces_of(world.object(ObjectId(0)).description()), 2);
  EXPECT_EQ(world.measure().tetrahedra().inverted, 0);
  for (const Vec3f& p : world.object(ObjectId(0)).positions()) EXPECT_GT(p.y, -0.13f);
}

/// The particles that a cut has parted, in pairs: they have one place at rest.
std::vector<std::array<int, 2>> seam_of(const Object& object) {
  std::vector<std::array<int, 2>> pairs;
  for (int b = 0; b < static_cast<int>(object.positions.size()); ++b)
    for (int a = 0; a < b; ++a)
      if (object.positions[static_cast<std::size_t>(a)] == object.positions[static_cast<std::size_t>(b)])
        pairs.push_back({a, b});
  return pairs;
}

TEST(PlaneCut, IsNotMadeAgainWhereItsSidesAreWelded) {
  Object object = block();
  object.cuts = {{0.1f, 0.1f, {}, {1, 0, 0}, {0, -1, 0}}, {1, 1, {0.1f, 0, 0}, {1, 0, 0}, {0, -1, 0}}};
  World world(weightless(object, 20));
  const ObjectId id(0);
  EXPECT_EQ(run_and_tear(world, 10).new_particles, 9);
  const Object& cut = world.object(id).description();
  for (const Finding& finding : inspect(weightless(cut, 20)))
    EXPECT_EQ(finding.message.find("cut "), std::string::npos) << finding.message;
  const Edit whole = weld(cut, seam_of(cut));
  EXPECT_EQ(whole.object.positions.size(), object.positions.size());
  EXPECT_EQ(whole.object.triangles.size(), object.triangles.size()) << "faces of the seam are inside again";
  world.edit(id, whole);
  EXPECT_EQ(run_and_tear(world, 40).new_particles, 0);
  EXPECT_EQ(pieces_of(world.object(id).description()), 1);
  EXPECT_EQ(run_and_tear(world, 20).new_particles, 9) << "the cut that was still to come";
  EXPECT_EQ(pieces_of(world.object(id).description()), 2);
}

TEST(PartTriangles, PartsASheetByNumbers) {
  const Object whole = make_cloth(grid_mesh(9, 9, 1, 1));
  std::vector<int> part;
  for (const auto& [a, b, c] : whole.triangles)
    part.push_back(whole.positions[static_cast<std::size_t>(a)].x + whole.positions[static_cast<std::size_t>(b)].x +
                               whole.positions[static_cast<std::size_t>(c)].x >
                           0
                       ? 7
                       : -7);
  const Edit edit = part_triangles(whole, part);
  EXPECT_EQ(pieces_of(edit.object), 2);
  EXPECT_EQ(edit.object.positions.size(), 90u);
  EXPECT_NEAR(mass_of(edit.object), mass_of(whole), 1e-7);
}

}  // namespace
}  // namespace pliant
