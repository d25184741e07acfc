// Tests objects that are edited while they move: torn, cut, pinned, made heavier.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "math/vector.h"
#include "pliant/body.h"
#include "pliant/error.h"
#include "world/run_time_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// Of nine by nine particles, row after row: the middle column from border to border.
std::vector<int> middle_column() {
  std::vector<int> path;
  for (int row = 0; row < 9; ++row) path.push_back(9 * row + 4);
  return path;
}

/// For each particle, the lowest particle of its connected component.
std::vector<int> pieces_of(const Object& object) {
  std::vector<int> piece(object.positions.size());
  for (std::size_t i = 0; i < piece.size(); ++i) piece[i] = static_cast<int>(i);
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& t : object.triangles) {
      const int least = std::min({piece[static_cast<std::size_t>(t[0])], piece[static_cast<std::size_t>(t[1])],
                                  piece[static_cast<std::size_t>(t[2])]});
      for (const int corner : t) {
        changed = changed || piece[static_cast<std::size_t>(corner)] != least;
        piece[static_cast<std::size_t>(corner)] = least;
      }
    }
  }
  return piece;
}

Scene scene_with_sheet(float gravity = -9.81f) {
  Scene scene;
  scene.gravity = {0, gravity, 0};
  scene.add_cloth(grid_mesh(9, 9, 1, 1));
  scene.settings = settings_of(8);
  return scene;
}

TEST(Cut, PartsASheetInTwoAndKeepsItsMass) {
  const Object whole = scene_with_sheet().objects[0];
  const Edit edit = cut(whole, middle_column());
  EXPECT_EQ(edit.object.positions.size(), 90u) << "nine particles were split";
  EXPECT_NEAR(mass_of(edit.object), mass_of(whole), 1e-7);
  const std::vector<int> pieces = pieces_of(edit.object);
  EXPECT_EQ(std::set<int>(pieces.begin(), pieces.end()).size(), 2u);
  for (const ConstraintGroup& group : edit.object.constraints) {
    const std::size_t slots = group.type == "distance" ? 2 : 4;
    for (std::size_t i = 0; i < group.particles.size(); i += slots)
      for (std::size_t s = 1; s < slots; ++s)
        EXPECT_EQ(pieces[static_cast<std::size_t>(group.particles[i])],
                  pieces[static_cast<std::size_t>(group.particles[i + s])])
            << group.type;
  }
  EXPECT_EQ(edit.from[3], 3);
  for (std::size_t i = 81; i < 90; ++i) EXPECT_EQ(edit.from[i] % 9, 4);
}

TEST(Cut, EndsInsideWithoutSplittingItsTip) {
  const Object whole = scene_with_sheet().objects[0];
  const Edit edit = cut(whole, std::vector<int>{4, 13, 22, 31});
  EXPECT_EQ(edit.object.positions.size(), 84u) << "the border's and two inside, not the tip";
  const std::vector<int> pieces = pieces_of(edit.object);
  EXPECT_EQ(std::set<int>(pieces.begin(), pieces.end()).size(), 1u);
  EXPECT_EQ(cut(whole, std::vector<int>{40, 41}).object.positions.size(), 81u) << "one edge inside is no opening";
}

TEST(Cut, HoldsItsEdgesOnEitherSideByItsShare) {
  const Object whole = scene_with_sheet().objects[0];
  const Edit edit = cut(whole, middle_column());
  const auto stiffness_of = [](const Object& object, int a, int b, const std::vector<int>& from) {
    double sum = 0;
    int count = 0;
    for (const ConstraintGroup& group : object.constraints) {
      if (group.type != "distance") continue;
      for (std::size_t i = 0; i + 1 < group.particles.size(); i += 2) {
        const int p = from[static_cast<std::size_t>(group.particles[i])],
                  q = from[static_cast<std::size_t>(group.particles[i + 1])];
        if (std::minmax(p, q) != std::minmax(a, b)) continue;
        sum += 1 / double(group.compliances.empty() ? group.stiffness.value : group.compliances[i / 2]);
        ++count;
      }
    }
    EXPECT_GT(count, 0);
    return sum;
  };
  const std::vector<int> same = unchanged(whole).from;
  const double before = stiffness_of(whole, 13, 22, same);
  EXPECT_NEAR(stiffness_of(edit.object, 13, 22, edit.from), before, 1e-5 * before) << "springs side by side";
}

TEST(Cut, BothHalvesStayTiedAndAttached) {
  Object whole = make_body({{Box{{0.1f, 0.1f, 0.1f}}}}, {.position = {0, 1, 0}});
  const int first = append(whole, scene_with_sheet().objects[0]);
  attach(whole, {first + 4}, 0);
  whole.attachments.push_back({first + 76, {0, 0, 1}});
  std::vector<int> path = middle_column();
  for (int& particle : path) particle += first;
  const Edit edit = cut(whole, path);
  std::vector<int> tied, attached;
  for (const ConstraintGroup& group : edit.object.constraints)
    for (std::size_t i = 0; group.type == "body_anchor" && i < group.particles.size(); i += 3)
      tied.push_back(edit.from[static_cast<std::size_t>(group.particles[i + 2])]);
  for (const Attachment& attachment : edit.object.attachments)
    attached.push_back(edit.from[static_cast<std::size_t>(attachment.particle)]);
  EXPECT_EQ(tied, (std::vector<int>{first + 4, first + 4}));
  EXPECT_EQ(attached, (std::vector<int>{first + 76, first + 76}));
}

TEST(Cut, CopiesOfAParticleThatIsTiedToASurfaceStayTied) {
  Object both = scene_with_sheet().objects[0];
  Object other = both;
  for (Vec3f& p : other.positions) p.y += 0.01f;
  append(both, other);
  attach_to_surface(both, {4, 40, 41});
  const Edit edit = cut(both, middle_column());
  std::vector<int> tied;
  const std::vector<int>& particles = edit.object.constraints.back().particles;
  for (std::size_t i = 0; i < particles.size(); i += 4)
    tied.push_back(edit.from[static_cast<std::size_t>(particles[i])]);
  EXPECT_EQ(tied, (std::vector<int>{4, 4, 40, 40, 41}));
}

TEST(Cut, RefusesWhatIsNoEdge) {
  const Object whole = scene_with_sheet().objects[0];
  EXPECT_THROW(cut(whole, std::vector<int>{0, 2}), Error);
  EXPECT_THROW(cut(whole, std::vector<int>{0, 81}), Error);
  EXPECT_THROW(remove_triangles(whole, std::vector<int>{-1}), Error);
  EXPECT_THROW(remove_triangles(whole, std::vector<int>{128}), Error);
}

TEST(Edit, ACutKeepsMomentumAndEnergyAndTheHalvesFallApart) {
  Scene scene = scene_with_sheet();
  scene.pin(0, {0});
  World world(scene);
  for (int frame = 0; frame < 30; ++frame) world.step(dt);
  const Vec3<double> before = momentum(world, 0);
  const double kinetic = world.measure().kinetic_energy(), potential = world.measure().potential_energy();
  const std::vector<Vec3f> places = world.object(0).positions(), speeds = world.object(0).velocities();
  const Edit edit = cut(scene.objects[0], middle_column());
  const std::vector<int> news = world.edit(0, edit);
  ASSERT_EQ(news.size(), 81u);
  for (int i = 0; i < 81; ++i) EXPECT_EQ(news[static_cast<std::size_t>(i)], i);
  const std::vector<Vec3f> now = world.object(0).positions(), speeds_now = world.object(0).velocities();
  ASSERT_EQ(now.size(), 90u);
  for (std::size_t i = 0; i < 90; ++i) {
    EXPECT_EQ(now[i], places[static_cast<std::size_t>(edit.from[i])]) << i;
    EXPECT_EQ(speeds_now[i], speeds[static_cast<std::size_t>(edit.from[i])]) << i;
  }
  const Vec3<double> after = momentum(world, 0);
  EXPECT_NEAR(after.y, before.y, 1e-6 * std::abs(before.y));
  EXPECT_NEAR(world.measure().kinetic_energy(), kinetic, 1e-6 * kinetic);
  EXPECT_NEAR(world.measure().potential_energy(), potential, 1e-6 * std::abs(potential));
  // The half without the pin falls freely.
  double fallen = 0, mass = 0, speed = 0;
  const std::vector<int> pieces = pieces_of(edit.object);
  const int loose = pieces[8];
  ASSERT_NE(loose, pieces[0]);
  for (std::size_t i = 0; i < 90; ++i) {
    if (pieces[i] != loose) continue;
    mass += double(edit.object.masses[i]);
    fallen -= double(edit.object.masses[i]) * double(now[i].y);
    speed += double(edit.object.masses[i]) * double(speeds_now[i].y);
  }
  for (int frame = 0; frame < 30; ++frame) ASSERT_TRUE(world.step(dt).ok());
  const std::vector<Vec3f> then = world.object(0).positions();
  for (std::size_t i = 0; i < 90; ++i)
    if (pieces[i] == loose) fallen += double(edit.object.masses[i]) * double(then[i].y);
  const double t = 30 * double(dt), h = double(dt) / 8;
  EXPECT_NEAR(fallen / mass, speed / mass * t - 0.5 * 9.81 * t * (t + h), 1e-4);
  EXPECT_GT(then[0].y, -1e-6f) << "the other hangs on";
}

TEST(Edit, ANinthOfTheTrianglesGoWithWhatTheyHeld) {
  Scene scene = scene_with_sheet();
  World world(scene);
  world.step(dt);
  std::vector<int> gone;
  for (int t = 0; t < 128; t += 9) gone.push_back(t);
  const Edit edit = remove_triangles(scene.objects[0], gone);
  EXPECT_EQ(edit.object.triangles.size(), 128 - gone.size());
  const auto before = world.object(0).info().constraints;
  world.edit(0, edit);
  const auto after = world.object(0).info().constraints;
  EXPECT_LT(after[1].second, before[1].second) << "hinges of what is gone";
  EXPECT_LE(after[0].second, before[0].second);
  EXPECT_EQ(world.object(0).mesh().triangles.size(), edit.object.triangles.size());
  EXPECT_TRUE(world.step(dt).ok());
}

TEST(Edit, NothingChangedGivesTheBitsOfAWorldThatWasNotEdited) {
  Scene scene = hanging_cloth();
  World world(scene), same(scene);
  for (int frame = 0; frame < 20; ++frame) {
    if (frame == 10) world.edit(0, unchanged(scene.objects[0]));
    world.step(dt);
    same.step(dt);
  }
  EXPECT_EQ(world.object(0).positions(), same.object(0).positions());
  EXPECT_EQ(world.object(0).velocities(), same.object(0).velocities());
}

TEST(Edit, PinsAndMassesChangeInPlace) {
  Scene scene = scene_with_sheet();
  scene.pin(0, {0, 8});
  World world(scene);
  for (int frame = 0; frame < 20; ++frame) world.step(dt);
  Edit edit = unchanged(scene.objects[0]);
  edit.object.pins = {{80, {}}};
  for (float& mass : edit.object.masses) mass *= 2;
  const Vec3f place = world.object(0).positions()[80], other = world.object(0).positions()[8];
  world.edit(0, edit);
  for (int frame = 0; frame < 20; ++frame) ASSERT_TRUE(world.step(dt).ok());
  EXPECT_EQ(world.object(0).positions()[80], place);
  EXPECT_LT(world.object(0).positions()[8].y, other.y - 0.1f);
}

/// A sheet whose corners and middle are attached where they are.
Scene attached_sheet() {
  Scene scene = scene_with_sheet(0);
  Object& object = scene.objects[0];
  for (const int particle : {0, 8, 40, 72, 80})
    object.attachments.push_back({particle, object.positions[static_cast<std::size_t>(particle)]});
  return scene;
}

TEST(Edit, AttachmentsStayWhereTheyAreWhenOthersComeAndGo) {
  const Scene scene = attached_sheet();
  const Object& at_rest = scene.objects[0];
  for (const bool inserts : {false, true}) {
    World world(scene);
    world.step(dt);
    Edit edit = unchanged(at_rest);
    std::vector<Attachment>& attachments = edit.object.attachments;
    if (inserts)
      attachments.insert(attachments.begin(), {20, at_rest.positions[20]});
    else
      attachments.erase(attachments.begin());
    world.edit(0, edit);
    for (int frame = 0; frame < 20; ++frame) ASSERT_TRUE(world.step(dt).ok());
    const std::vector<Vec3f> now = world.object(0).positions();
    for (std::size_t i = 0; i < now.size(); ++i) EXPECT_NEAR(length(now[i] - at_rest.positions[i]), 0, 1e-5) << i;
  }
}

TEST(Edit, ATargetThatWasMovedKeepsItsPlaceAndANewOneStartsAtItsOwn) {
  const Scene scene = attached_sheet();
  const Vec3f up{0, 0.05f, 0}, middle = scene.objects[0].positions[40] + up;
  World world(scene);
  world.object(0).set_attachment_targets(std::vector<int>{2}, std::vector<Vec3f>{middle});
  world.step(dt);
  Edit edit = unchanged(scene.objects[0]);
  edit.object.attachments.erase(edit.object.attachments.begin());
  edit.object.attachments[3].target += up;  // of particle 80
  world.edit(0, edit);
  for (int frame = 0; frame < 60; ++frame) ASSERT_TRUE(world.step(dt).ok());
  const std::vector<Vec3f> now = world.object(0).positions();
  EXPECT_NEAR(length(now[40] - middle), 0, 1e-4);
  EXPECT_NEAR(length(now[80] - scene.objects[0].positions[80] - up), 0, 1e-4);
  EXPECT_NEAR(length(now[72] - scene.objects[0].positions[72]), 0, 1e-4);
}

TEST(Edit, CopiesOfAnAttachedParticleGoToTheTargetWhereItIs) {
  const Scene scene = attached_sheet();
  const Vec3f middle = scene.objects[0].positions[40] + Vec3f{0, 0.05f, 0};
  World world(scene);
  world.object(0).set_attachment_targets(std::vector<int>{2}, std::vector<Vec3f>{middle});
  world.step(dt);
  const Edit edit = cut(scene.objects[0], middle_column());
  world.edit(0, edit);
  for (int frame = 0; frame < 60; ++frame) ASSERT_TRUE(world.step(dt).ok());
  const std::vector<Vec3f> now = world.object(0).positions();
  for (std::size_t i = 0; i < now.size(); ++i)
    if (edit.from[i] == 40) {
      EXPECT_NEAR(length(now[i] - middle), 0, 5e-3) << i;
    }
}

TEST(Edit, OthersKeepTheirBitsAndSurfacesMeetAsBefore) {
  Scene scene = scene_with_sheet();
  scene.add_cloth(grid_mesh(7, 7, 1, 1));
  for (Vec3f& p : scene.objects[1].positions) p.x += 5;
  scene.pin(1, {0});
  World world(scene), same(scene);
  for (int frame = 0; frame < 20; ++frame) {
    if (frame == 10) world.edit(0, cut(scene.objects[0], middle_column()));
    world.step(dt);
    same.step(dt);
  }
  EXPECT_EQ(world.object(1).positions(), same.object(1).positions());
  Scene landing = scene_with_sheet();
  landing.objects[0].collides = true;
  MeshCollider floor;
  floor.mesh = box_mesh({3, 0.2f, 3});
  for (Vec3f& p : floor.mesh.positions) p.y -= 0.5f;
  landing.add(floor);
  World lands(landing);
  for (int frame = 0; frame < 15; ++frame) lands.step(dt);
  lands.edit(0, cut(landing.objects[0], middle_column()));
  for (int frame = 0; frame < 40; ++frame) ASSERT_TRUE(lands.step(dt).ok());
  for (const Vec3f& p : lands.object(0).positions()) EXPECT_NEAR(p.y, -0.4f, 0.01f);
}

TEST(Edit, WhatDoesNotFitIsRefusedAndChangesNothing) {
  Scene scene = scene_with_sheet();
  World world(scene);
  world.step(dt);
  const std::string before = world.state_hash();
  Edit edit = unchanged(scene.objects[0]);
  edit.from.pop_back();
  EXPECT_THROW(world.edit(0, edit), Error);
  edit = unchanged(scene.objects[0]);
  edit.from[3] = 81;
  EXPECT_THROW(world.edit(0, edit), Error);
  edit = unchanged(scene.objects[0]);
  edit.object.masses[0] = -1;
  EXPECT_THROW(world.edit(0, edit), Error);
  EXPECT_EQ(world.state_hash(), before);
}

}  // namespace
}  // namespace pliant
