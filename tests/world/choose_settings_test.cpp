// Tests which sweep a scene gets if it names none: known answers, among them the bending length from which a sheet
// counts as stiff.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "model/object_sets.h"
#include "pliant/scene.h"
#include "pliant/world.h"
#include "support/scenes.h"
#include "world/world_support.h"

namespace pliant {
namespace {

using namespace testing_support;

Scene with(const TriangleMesh& mesh, const ClothOptions& options) {
  Scene scene;
  scene.add_cloth(mesh, options);
  return scene;
}

Scene sheet_scene(int n, float size, const ClothOptions& options = {}) {
  return with(grid_mesh(n, n, size, size), options);
}

/// The same with its inner vertices moved by up to a third of an edge: no springs lie in rows.
TriangleMesh irregular_mesh(int n, float size) {
  TriangleMesh mesh = grid_mesh(n, n, size, size);
  std::mt19937 random(5);
  const float range = size / static_cast<float>(3 * (n - 1));
  for (Vec3f& p : mesh.positions) {
    const float x = std::uniform_real_distribution<float>(-range, range)(random);
    p += Vec3f{x, 0, std::uniform_real_distribution<float>(-range, range)(random)};
  }
  return mesh;
}
Scene irregular(int n, float size) { return with(irregular_mesh(n, size), {}); }

void expect_chosen(const Scene& scene, Sweep sweep, int substeps, const std::string& why) {
  SCOPED_TRACE(why);
  std::string reason;
  const Settings chosen = chosen_settings(scene, &reason);
  EXPECT_EQ(sweep_name(chosen.sweep), sweep_name(sweep)) << reason;
  EXPECT_EQ(chosen.substeps, substeps);
  EXPECT_NE(reason.find(why), std::string::npos) << reason;
  const World world(scene);
  EXPECT_EQ(world.settings().sweep, sweep) << "a World runs by what is chosen";
  EXPECT_EQ(world.settings().substeps, substeps);
}

Attachment attached(const Object& object, int particle, const Stiffness& stiffness = Stiffness::rigid()) {
  return {particle, object.positions[static_cast<std::size_t>(particle)], {}, stiffness};
}

TEST(ChosenSettings, AreMultigridForIrregularCloth) {
  expect_chosen(irregular(40, 1), Sweep::multigrid, 5, "1600 particles");
  expect_chosen(irregular(6, 1), Sweep::multigrid, 5, "36 particles");
}

TEST(ChosenSettings, AreMoreSubstepsOfMultigridWhereClothIsDisturbed) {
  Scene scene = irregular(40, 1);
  scene.pin(0, {0, 39});
  expect_chosen(scene, Sweep::multigrid, 5, "meets nothing");
  Scene other = scene;
  other.objects[0].pins[0].motion = straight({1, 0, 0}, 1);
  expect_chosen(other, Sweep::multigrid, 10, "meets nothing");
  other = scene;
  other.objects[0].pins[1].particle = 1;  // it swings about one corner
  expect_chosen(other, Sweep::multigrid, 10, "meets nothing");
  other = scene;
  other.objects[0].pins.clear();
  for (const int p : {0, 1}) other.objects[0].attachments.push_back(attached(other.objects[0], p));
  expect_chosen(other, Sweep::multigrid, 10, "meets nothing");
  other.objects[0].attachments[1] = attached(other.objects[0], 39);
  expect_chosen(other, Sweep::multigrid, 5, "meets nothing");
  other.objects[0].attachments[1].motion = straight({1, 0, 0}, 1);
  expect_chosen(other, Sweep::multigrid, 10, "meets nothing");
  other = scene;
  other.wind.air_density = 1.2f;
  expect_chosen(other, Sweep::multigrid, 5, "meets nothing");  // still air only brakes
  other.wind.velocity = {3, 0, 0};
  expect_chosen(other, Sweep::multigrid, 10, "meets nothing");
  other = scene;
  other.forces.push_back([](const Vec3f&, const Vec3f&, float, float) { return Vec3f{}; });
  expect_chosen(other, Sweep::multigrid, 10, "meets nothing");
}

TEST(ChosenSettings, AreTetheredWhereAttachmentsActLikePins) {
  Scene scene = sheet_scene(40, 1);  // 0.15 kg, 1.5 N
  for (const int p : {0, 39}) scene.objects[0].attachments.push_back(attached(scene.objects[0], p));
  expect_chosen(scene, Sweep::tethered_chains, 0, "hangs from pins or attachments");
  const auto with_second = [&](const Attachment& second) {
    Scene other = scene;
    other.objects[0].attachments[1] = second;
    return other;
  };
  const Attachment rigid = attached(scene.objects[0], 39);
  const std::string why = "springs lie in straight rows";
  for (const Stiffness& firm : {Stiffness::compliance(0.001f), Stiffness::pbd(1)})
    expect_chosen(with_second(attached(scene.objects[0], 39, firm)), Sweep::tethered_chains, 0, "hangs from pins");
  expect_chosen(with_second(attached(scene.objects[0], 39, Stiffness::compliance(0.002f))), Sweep::chains, 0, why);
  expect_chosen(with_second(attached(scene.objects[0], 39, Stiffness::pbd(0.9f))), Sweep::chains, 20, why);
  Attachment other = rigid;
  other.target.x += 0.002f;
  expect_chosen(with_second(other), Sweep::chains, 0, why);
  other = rigid;
  other.motion = straight({1, 0, 0}, 1);
  expect_chosen(with_second(other), Sweep::chains, 0, why);
  Scene alike = with_second(other);
  alike.objects[0].attachments[0].motion = other.motion;
  expect_chosen(alike, Sweep::tethered_chains, 0, "hangs from pins");
  alike.objects[0].attachments.pop_back();
  alike.objects[0].attachments[0].motion = {};
  alike.pin(0, {39});
  expect_chosen(alike, Sweep::tethered_chains, 0, "hangs from pins");
  alike.objects[0].attachments[0].stiffness = Stiffness::compliance(1);
  expect_chosen(alike, Sweep::chains, 0, why);
}

/// With multigrid cloth sticks to a collider on which it should slide.
TEST(ChosenSettings, AreChainsWhereCollidersAreMet) {
  Scene scene = irregular(40, 1);
  scene.add(Collider{});
  expect_chosen(scene, Sweep::chains, 0, "which can meet a collider");
}

TEST(ChosenSettings, AreChainsForRegularCloth) {
  expect_chosen(sheet_scene(40, 1), Sweep::chains, 0, "springs lie in straight rows");
  Scene hung = sheet_scene(40, 1);
  hung.pin(0, {0, 39});
  expect_chosen(hung, Sweep::tethered_chains, 0, "hangs from pins");
  Scene lying = hung;
  lying.objects[0].self_collision = true;
  expect_chosen(lying, Sweep::tethered_chains, 0, "hangs from pins");
  for (int p = 2; p < 400; ++p) lying.pin(0, {p});
  expect_chosen(lying, Sweep::chains, 0, "can touch itself");
  for (ConstraintGroup& group : hung.objects[0].constraints)
    if (group.type == "distance") group.compliances.assign(group.particles.size() / 2, 0.1f);
  expect_chosen(hung, Sweep::chains, 48, "springs lie in straight rows");  // it is meant to stretch
}

/// Forces gather at what holds such a sheet, in proportion to the number of particles that hang there.
TEST(ChosenSettings, AreMoreSubstepsForSheetsThatStretchAndHangFromFewParticles) {
  ClothOptions options;
  options.material = fabric("rubber sheet");
  const std::string why = "springs lie in straight rows";
  const auto hung = [&](int n, int step) {
    Scene scene = sheet_scene(n, 1, options);
    for (int p = 0; p < n; p += step) scene.pin(0, {p});
    return scene;
  };
  expect_chosen(sheet_scene(64, 1, options), Sweep::chains, 20, why);
  expect_chosen(hung(64, 63), Sweep::chains, 76, why);
  expect_chosen(hung(64, 64), Sweep::chains, 76, why);  // one corner
  expect_chosen(hung(64, 21), Sweep::chains, 52, why);  // four pins
  expect_chosen(hung(64, 1), Sweep::chains, 20, why);
  expect_chosen(hung(144, 143), Sweep::chains, 160, why);
  Scene attached_at_corners = sheet_scene(64, 1, options);
  for (const int p : {0, 63})
    attached_at_corners.objects[0].attachments.push_back(attached(attached_at_corners.objects[0], p));
  expect_chosen(attached_at_corners, Sweep::chains, 76, why);
  Scene tiled = hung(64, 63);
  tiled.objects[0].sweep = Sweep::tiled;
  EXPECT_EQ(chosen_substeps(tiled), std::vector<int>{20});
}

TEST(ChosenSettings, ArePlainForWhatIsCoarse) {
  expect_chosen(sheet_scene(5, 1), Sweep::tiled, 20, "fewer than 32");
  expect_chosen(sheet_scene(6, 1), Sweep::chains, 0, "straight rows");
  expect_chosen(Scene{}, Sweep::tiled, 20, "fewer than 32");
}

TEST(ChosenSettings, AreChainsInManySubstepsForVolumes) {
  ClothOptions options{.volume = Volume{1, Stiffness::rigid()}};
  options.name = "ball";
  expect_chosen(with(sphere_mesh(2), options), Sweep::chains, 80, "'ball', which has a volume");
  options.stretch = Stiffness::rigid();
  expect_chosen(with(sphere_mesh(3), options), Sweep::chains, 80, "'ball', which has a volume");  // not by the State
  options.volume->pressure = 1.01f;  // its edges cannot follow, and chains would gain energy without bound
  expect_chosen(with(sphere_mesh(2), options), Sweep::tiled, 20, "'ball', which is inflated, though");
  options.volume->pressure = 0.8f;
  Scene beside_pbd = with(sphere_mesh(2), options);
  Object rope = chain(40, 0.1f);
  rope.constraints.push_back({"distance", {0, 2}, {}, Stiffness::pbd(0.5f), {}});
  for (Vec3f& p : rope.positions) p.x += 3;
  rope.collides = beside_pbd.objects[0].collides = true;
  beside_pbd.add(rope);
  EXPECT_EQ(chosen_substeps(beside_pbd), (std::vector<int>{20, 20})) << "for which PBD stiffness is converted";
  Scene small = with(sphere_mesh(0), options);
  expect_chosen(small, Sweep::tiled, 20, "fewer than 32");
}

/// A sphere of 0.2 m of a material of 0.5 kg/m^2 in which waves have the given speed [m/s].
Scene balloon(float wave_speed, float pressure) {
  ClothOptions options;
  options.material.area_density = 0.5f;
  options.material.stretch_stiffness = 0.5f * wave_speed * wave_speed;
  options.volume = Volume{pressure, Stiffness::rigid()};
  TriangleMesh mesh = sphere_mesh(3);
  for (Vec3f& p : mesh.positions) p = p * 0.2f;
  return with(mesh, options);
}

/// The overstretch of the last 30 frames of 60 that a balloon is given.
double late_overstretch(Scene scene, int substeps) {
  scene.settings.sweep = Sweep::chains;
  scene.settings.substeps = substeps;
  scene.gravity = {};
  World world(scene);
  double late = 0;
  for (int frame = 0; frame < 60; ++frame) {
    world.step(dt);
    if (frame >= 30) late = std::max(late, static_cast<double>(world.measure().overstretch().p99));
  }
  return late;
}

/// Rubber follows the volume, with the overstretch that is predicted; silk cannot.
TEST(ChosenSettings, AreChainsForInflatedObjectsThatCanFollow) {
  for (const auto& [speed, pressure] : {std::pair{40.f, 1.1f}, {40.f, 1.4f}, {80.f, 1.1f}, {120.f, 1.05f}}) {
    const Scene scene = balloon(speed, pressure);
    const double predicted = overstretch_of_inflated(scene.objects[0]);
    EXPECT_NEAR(late_overstretch(scene, 80), predicted, 0.25 * predicted) << speed << ' ' << pressure;
    EXPECT_EQ(chosen_sweep(scene, 0), Sweep::chains);
    EXPECT_LE(late_overstretch(scene, chosen_substeps(scene)[0]), 0.02) << speed << ' ' << pressure;
  }
  EXPECT_EQ(chosen_substeps(balloon(40, 1.1f)), std::vector<int>{80});
  expect_chosen(balloon(450, 1.4f), Sweep::tiled, 20, "edges resist");
}

/// The prediction counts with the duration of the substeps that the scene will have.
TEST(ChosenSettings, AreChainsForInflatedObjectsWhereSubstepsAreShort) {
  Scene longer = balloon(40, 1.4f);
  longer.frame_time = 1.f / 30;
  expect_chosen(longer, Sweep::chains, 154, "'cloth', which has a volume");  // about twice as many as in 1/60 s
  EXPECT_EQ(World(longer).step(longer.frame_time).substeps, 154);
  longer.frame_time = 1.f / 24;
  expect_chosen(longer, Sweep::tiled, 20, "edges resist");
  Scene named = balloon(120, 1.1f);
  for (const auto& [substeps, sweep] : {std::pair{20, Sweep::tiled}, {40, Sweep::tiled}, {80, Sweep::chains}}) {
    named.settings.substeps = substeps;
    EXPECT_EQ(chosen_sweep(named, 0), sweep) << substeps;
  }
  named.settings.substeps = 40;
  expect_chosen(named, Sweep::tiled, 40, "40 substeps of chains are too few");
  World empty([&] {
    Scene without = named;
    without.objects.clear();
    return without;
  }());
  empty.add(named.objects[0]);
  EXPECT_EQ(empty.layout().sweeps[0], Sweep::tiled) << "also if it is added later";
}

/// The sweep of a balloon beside a rope that it can meet, by the content of the scene and if the balloon is added
/// later.
Sweep beside(const Object& rope, Scene scene) {
  Object ball = scene.objects[0];
  ball.collides = true;
  scene.objects = {rope};
  scene.objects[0].collides = true;
  World world(scene);
  world.add(ball);
  scene.add(ball);
  EXPECT_EQ(world.layout().sweeps[1], chosen_sweep(scene, 1));
  return chosen_sweep(scene, 1);
}

TEST(ChosenSettings, AreChainsForInflatedObjectsWhereTheirSetGrantsTheSubsteps) {
  Object rope = chain(60, 0.1f), converted = rope;
  for (Vec3f& p : converted.positions) p.x += 3;
  converted.constraints.push_back({"distance", {0, 2}, {}, Stiffness::pbd(0.5f), {}});
  EXPECT_EQ(beside(rope, balloon(40, 1.4f)), Sweep::chains);
  EXPECT_EQ(beside(converted, balloon(40, 1.4f)), Sweep::tiled) << "in 20 substeps, for which stiffness is converted";
  Scene bounded = balloon(40, 1.4f);
  bounded.settings.most_substeps = 24;
  EXPECT_EQ(beside(rope, bounded), Sweep::tiled);
  bounded.settings.most_substeps = 80;
  EXPECT_EQ(beside(rope, bounded), Sweep::chains);
  bounded.settings.least_substeps = 12;
  EXPECT_EQ(beside(rope, bounded), Sweep::tiled) << "the law knows of strain alone";
}

TEST(ChosenSettings, AreEachObjectsOwn) {
  ClothOptions ball, sock;
  ball.name = "ball";
  ball.volume = Volume{1, Stiffness::rigid()};
  sock.name = "sock";
  Scene scene = with(sphere_mesh(2), ball);
  scene.add_cloth(irregular_mesh(20, 1));
  scene.add_cloth(grid_mesh(20, 20, 1, 1), sock);
  scene.objects[2].self_collision = true;
  EXPECT_EQ(chosen_sweep(scene, 0), Sweep::chains);
  EXPECT_EQ(chosen_sweep(scene, 1), Sweep::multigrid) << "whatever is beside it";
  EXPECT_EQ(chosen_sweep(scene, 2), Sweep::chains);
  expect_chosen(scene, Sweep::automatic, 0, "'cloth' by 'multigrid'");
  EXPECT_EQ(chosen_substeps(scene), (std::vector<int>{80, 5, 0}));
  scene.objects[2].sweep = Sweep::jacobi;
  EXPECT_EQ(chosen_sweep(scene, 2), Sweep::jacobi) << "what it names itself";
  scene.settings.sweep = Sweep::symmetric;
  EXPECT_EQ(chosen_sweep(scene, 1), Sweep::symmetric) << "else what the settings name";
  EXPECT_EQ(chosen_sweep(scene, 2), Sweep::jacobi);
}

TEST(ChosenSettings, ArePlainWherePbdStiffnessOrIterationsSaySo) {
  ClothOptions options;
  options.stretch = Stiffness::pbd(0.9f);
  expect_chosen(sheet_scene(20, 1, options), Sweep::tiled, 20, "fewer than 32");
  Scene scene = sheet_scene(20, 1);
  scene.settings.iterations = 2;
  expect_chosen(scene, Sweep::tiled, 20, "more than one iteration");
}

// Peirce's bending length is c = (B / rho g)^(1/3). A sheet is stiff if c is more than a quarter of its size, whatever
// the mesh and the type of bending.
TEST(ChosenSettings, AreChainsWithoutTethersForSheetsThatHoldThemselvesUp) {
  for (const auto model : {ClothOptions::Bending::dihedral, ClothOptions::Bending::isometric}) {
    ClothOptions options;
    options.bending_model = model;
    options.material.bending_stiffness = 0.02f;
    options.material.area_density = 0.75f;
    options.stretch = Stiffness::rigid();
    const double length = std::cbrt(0.02 / (0.75 * 9.81));
    for (const int n : {8, 30}) {
      const auto hung = [&](double size) {
        Scene scene = sheet_scene(n, static_cast<float>(size), options);
        scene.pin(0, {0, n - 1});
        return scene;
      };
      expect_chosen(hung(3.9 * length), Sweep::chains, 0, "a quarter of its size");
      expect_chosen(hung(4.1 * length), Sweep::tethered_chains, 0, "straight rows");
    }
  }
}

TEST(ChosenSettings, AreChainsInFixedSubstepsForPbdBending) {
  ClothOptions options;
  options.bending = Stiffness::pbd(0.1f);
  expect_chosen(sheet_scene(20, 1, options), Sweep::chains, 20, "a quarter of its size");
  options.bending = Stiffness::rigid();
  expect_chosen(sheet_scene(20, 1, options), Sweep::chains, 0, "a quarter of its size");
}

TEST(ChosenSettings, AreChainsWhereSurfacesMeet) {
  Scene scene = irregular(20, 1);
  scene.objects[0].name = "shirt";
  scene.objects[0].collides = true;
  expect_chosen(scene, Sweep::multigrid, 10, "particles");  // nothing else is there
  scene.objects[0].self_collision = true;
  expect_chosen(scene, Sweep::chains, 0, "'shirt', a surface that can touch itself or others");
  scene.objects[0].self_collision = false;
  Object other = scene.objects[0];
  other.name = "trousers";
  for (Vec3f& p : other.positions) p.y += 1;
  scene.add(other);
  expect_chosen(scene, Sweep::chains, 0, "'shirt', a surface");
  scene.objects[1].collides = false;
  expect_chosen(scene, Sweep::multigrid, 0, "particles");
  EXPECT_EQ(chosen_substeps(scene), (std::vector<int>{10, 5})) << "the shirt can touch what is added later";
  MeshCollider body;
  body.name = "body";
  body.mesh = sphere_mesh(2);
  for (Vec3f& p : body.mesh.positions) p.y -= 3;
  body.as = MeshCollider::As::distance_grid;
  scene.add(body);
  expect_chosen(scene, Sweep::chains, 0, "'shirt', which can meet a collider");
  scene.mesh_colliders[0].as = MeshCollider::As::triangles;
  expect_chosen(scene, Sweep::chains, 0, "'shirt', a surface");
}

TEST(ChosenSettings, LeaveWhatIsNamed) {
  Scene scene = sheet_scene(40, 1);
  for (const NamedSweep& one : sweeps()) {
    scene.settings.sweep = one.sweep;
    std::string reason;
    EXPECT_EQ(chosen_settings(scene, &reason).sweep, one.sweep);
    const int substeps = one.sweep == Sweep::multigrid ? 5 : solves_chains(one.sweep) ? 0 : 20;
    EXPECT_EQ(chosen_settings(scene).substeps, substeps) << one.name;
    EXPECT_EQ(reason, "");
  }
  scene.settings.substeps = 7;
  EXPECT_EQ(chosen_settings(scene).substeps, 7);
}

TEST(ChosenSettings, AreNotDecidedByAHingeOfNoArea) {
  ClothOptions options;
  options.material.bending_stiffness = 5;
  Scene scene = sheet_scene(20, 1, options);
  const std::vector<int> hinge = scene.objects[0].constraints[1].particles;
  scene.objects[0].positions.at(std::size_t(hinge[1])) = scene.objects[0].positions.at(std::size_t(hinge[0]));
  expect_chosen(scene, Sweep::chains, 0, "a quarter of its size");
}

TEST(ChosenSettings, AreNotDecidedByAFewStiffHingesOrLooseParticles) {
  Scene scene = sheet_scene(20, 1);
  scene.objects[0].constraints[1].compliances.at(7) = 0;
  expect_chosen(scene, Sweep::chains, 0, "straight rows");
  ClothOptions stiff;
  stiff.material.bending_stiffness = 5;
  scene = sheet_scene(20, 1, stiff);
  scene.objects[0].triangles.clear();
  expect_chosen(scene, Sweep::chains, 20, "a quarter of its size");
  scene = {};
  Object loose = chain(40, 0.1f);
  loose.constraints[0].particles.resize(2);
  scene.add(loose);
  expect_chosen(scene, Sweep::tiled, 20, "fewer than 32");
}

TEST(ChosenSettings, AreFoundForScenesThatWillBeRefused) {
  Scene scene = irregular(40, 1);
  scene.objects[0].constraints[1].particles[3] = 1 << 30;
  scene.objects[0].constraints[1].particles[4] = -1;
  scene.objects[0].triangles[0] = {-5, 1 << 30, 0};
  EXPECT_EQ(chosen_settings(scene).substeps, 5);
  scene.objects[0].positions.clear();
  EXPECT_GT(chosen_settings(scene).substeps, 0);
}

}  // namespace
}  // namespace pliant
