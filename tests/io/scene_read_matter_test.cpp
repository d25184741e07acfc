// Tests that every field of ropes, liquids, gases, grains, clusters, stitches and particles is stored.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "scene_support.h"

namespace pliant {
namespace {

using test::FullScene;

TEST_F(FullScene, HasItsRopes) {
  const Object& line = scene.objects.at(3);
  EXPECT_EQ(line.positions, (std::vector<Vec3f>{{0, 0, 0}, {0, -1, 0}, {0, -2, 0}, {0, -3, 0}, {0, -4, 0}}));
  EXPECT_FLOAT_EQ(line.masses[1], 0.5f);
  ASSERT_EQ(line.constraints.size(), 3U);  // stitches, too
  EXPECT_EQ(line.constraints[1].stiffness.value, 0.25f);
  ASSERT_EQ(line.pins.size(), 2U);
  EXPECT_EQ(line.pins[1].particle, 4);
  EXPECT_EQ(scene.objects.at(4).name, "rope");
  EXPECT_EQ(scene.objects.at(4).constraints.size(), 1U);
  EXPECT_EQ(scene.objects.at(4).thickness, RopeOptions{}.thickness);
}

TEST_F(FullScene, HasItsLiquids) {
  const Object& oil = scene.objects.at(9);
  ASSERT_TRUE(oil.fluid);
  EXPECT_EQ(oil.fluid->spacing, 0.25f);
  EXPECT_EQ(oil.fluid->density, 920);
  EXPECT_EQ(oil.fluid->speed_of_sound, 12.5f);
  EXPECT_EQ(oil.fluid->contact_angle, 60);
  EXPECT_EQ(oil.fluid->vorticity, 0.25f);
  EXPECT_EQ(oil.fluid->clarity, 0.5f);
  EXPECT_EQ(oil.positions.size(), 16U);
  EXPECT_EQ(oil.positions.at(1), (Vec3f{-7.625f, 4.125f, 1.125f}));
  EXPECT_EQ(oil.masses.at(0), 14.375f);
  EXPECT_EQ(oil.thickness, 0.125f);
  EXPECT_EQ(oil.static_friction, 0);
  EXPECT_EQ(scene.objects.at(10).positions.at(1), (Vec3f{-8, 8.5f, 1}));
}

TEST_F(FullScene, HasClusters) {
  const auto rope =
      std::find_if(scene.objects.begin(), scene.objects.end(), [](const Object& o) { return !o.clusters.empty(); });
  ASSERT_NE(rope, scene.objects.end());
  ASSERT_EQ(rope->clusters.size(), 2u);
  const Cluster& first = rope->clusters[0];
  EXPECT_EQ(first.particles, (std::vector<int>{0, 1, 2}));
  EXPECT_EQ(first.mode, Cluster::Mode::quadratic);
  EXPECT_EQ(first.share, 0.25f);
  EXPECT_EQ(first.stiffness.value, 0.5f);
  EXPECT_EQ(first.stiffness.damping, 2.f);
  EXPECT_EQ(rope->clusters[1].particles.size(), 5u);
  EXPECT_EQ(rope->clusters[1].mode, Cluster::Mode::linear);
  ASSERT_TRUE(rope->clusters[1].plasticity.has_value());
  EXPECT_EQ(rope->clusters[1].plasticity->yield, 0.25f);
  EXPECT_EQ(rope->clusters[1].plasticity->rate, 2.f);
  EXPECT_EQ(rope->clusters[1].plasticity->most, 0.5f);
}

TEST_F(FullScene, HasStitches) {
  const auto rope =
      std::find_if(scene.objects.begin(), scene.objects.end(), [](const Object& o) { return !o.clusters.empty(); });
  ASSERT_NE(rope, scene.objects.end());
  const ConstraintGroup& stitches = rope->constraints.back();
  EXPECT_EQ(stitches.type, "distance_limit");
  EXPECT_EQ(stitches.particles, (std::vector<int>{0, 3}));  // the nearer end
  EXPECT_EQ(stitches.rest, (std::vector<float>{3, 0}));
  EXPECT_EQ(stitches.stiffness.value, 0.125f);
  EXPECT_EQ(stitches.break_force, 16.f);
  ASSERT_EQ(stitches.keyframes.size(), 2u);
  EXPECT_EQ(stitches.keyframes[1].time, 0.5f);
  EXPECT_EQ(stitches.keyframes[1].factor, 0.f);
}

TEST_F(FullScene, HasItsGases) {
  const auto named = [&](const char* name) {
    return *std::find_if(scene.objects.begin(), scene.objects.end(),
                         [&](const Object& one) { return one.name == name; });
  };
  const Object steam = named("steam");
  ASSERT_TRUE(steam.gas && steam.fluid);
  EXPECT_EQ(steam.fluid->spacing, 0.25f);
  EXPECT_EQ(steam.fluid->density, 0.5f);
  EXPECT_EQ(steam.fluid->speed_of_sound, 12.5f);
  EXPECT_EQ(steam.gas->temperature, 380);
  EXPECT_EQ(steam.gas->ambient_temperature, 280);
  EXPECT_EQ(steam.gas->ambient_density, 1.25f);
  EXPECT_EQ(steam.gas->cooling_time, 2);
  EXPECT_EQ(steam.gas->diffusivity, 0.125f);
  EXPECT_EQ(steam.gas->drag, 3);
  EXPECT_EQ(steam.gas->vorticity, 0.25f);
  ASSERT_EQ(steam.gas->heaters.size(), 2u);
  EXPECT_EQ(steam.gas->heaters[0].region.centre, (Vec3f{-8, 14, 1}));
  EXPECT_EQ(steam.gas->heaters[0].region.radius, 0.5f);
  EXPECT_EQ(steam.gas->heaters[0].temperature, 600);
  EXPECT_EQ(steam.gas->heaters[0].rate, 4);
  EXPECT_EQ(steam.gas->heaters[1].region.centre, (Vec3f{-7.5f, 14.5f, 2}));
  EXPECT_EQ(steam.gas->heaters[1].region.half_size, (Vec3f{0.5f, 0.5f, 1}));
  const Object breath = named("breath");
  EXPECT_EQ(breath.gas->temperature, 400);
  EXPECT_EQ(breath.gas->ambient_density, 1.204f);
  const Object smoke = named("smoke");
  ASSERT_TRUE(smoke.tracers);
  EXPECT_EQ(smoke.positions.size(), 64u);
  EXPECT_EQ(smoke.tracers->rate, 32);
  EXPECT_EQ(smoke.tracers->lifetime, 2);
  EXPECT_EQ(smoke.tracers->start, 1);
  EXPECT_EQ(smoke.tracers->end, 8);
  EXPECT_EQ(smoke.tracers->radius, 0.125f);
  EXPECT_EQ(smoke.tracers->opacity, 0.25f);
}

TEST_F(FullScene, HasItsGrains) {
  const Object& sand = scene.objects.at(11);
  ASSERT_TRUE(sand.grains);
  EXPECT_EQ(sand.grains->radius, 0.125f);
  EXPECT_EQ(sand.grains->density, 1500);
  EXPECT_EQ(sand.grains->friction, 0.75f);
  EXPECT_EQ(sand.grains->cohesion, 500);
  EXPECT_EQ(sand.grains->mass_scaling, 2);
  EXPECT_EQ(sand.positions.size(), 16U);
  const Vec3f off = sand.positions.at(1) - Vec3f{-7.53125f, 10.15625f, 1.15625f};  // its place in a lattice of 0.3125 m
  for (const float along : {off.x, off.y, off.z}) EXPECT_LE(std::abs(along), 0.03125f);
  EXPECT_NE(off, Vec3f{});
  EXPECT_NEAR(sand.masses.at(0), 1500 * 3.14159265 / 6 / 64, 1e-4);
  EXPECT_EQ(sand.thickness, 0.125f);
  EXPECT_EQ(sand.static_friction, 0.75f);
  EXPECT_EQ(sand.kinetic_friction, 0.75f);
  EXPECT_EQ(scene.objects.at(12).positions.at(1), (Vec3f{-8, 12.5f, 1}));
}

TEST_F(FullScene, HasWhatComesAndGoes) {
  const Object& drops = scene.objects.at(10);
  EXPECT_EQ(drops.positions.size(), 40U);
  EXPECT_EQ(drops.flow.spare, 38);
  EXPECT_EQ(drops.flow.lifetime, 8);
  ASSERT_EQ(drops.flow.emitters.size(), 2U);
  const Emitter &tap = drops.flow.emitters[0], &round = drops.flow.emitters[1];
  EXPECT_EQ(tap.name, "tap");
  EXPECT_EQ(tap.position, (Vec3f{-8, 9, 5}));
  EXPECT_EQ(tap.direction, (Vec3f{0, -2, 1}));
  EXPECT_EQ(tap.across, (Vec3f{1, 0, 0}));
  EXPECT_EQ(tap.width, 0.75f);
  EXPECT_EQ(tap.height, 0.5f);
  EXPECT_EQ(tap.speed, 0.5f);
  EXPECT_EQ(tap.start, 1);
  EXPECT_EQ(tap.end, 4);
  EXPECT_EQ(tap.motion.keyframes.size(), 2U);
  EXPECT_EQ(round.radius, 0.5f);
  EXPECT_EQ(round.flow, 0.125f);
  ASSERT_EQ(drops.flow.drains.size(), 4U);
  const Drain& sink = drops.flow.drains[0];
  EXPECT_EQ(sink.name, "sink");
  EXPECT_EQ(std::get<Box>(sink.shape).half_extents, (Vec3f{1, 0.5f, 2}));
  EXPECT_EQ(sink.position, (Vec3f{-8, -20, 1}));
  EXPECT_NEAR(sink.rotation.y, std::sqrt(0.5), 1e-6);
  EXPECT_TRUE(std::holds_alternative<Plane>(drops.flow.drains[1].shape));
  EXPECT_EQ(std::get<Sphere>(drops.flow.drains[2].shape).radius, 0.5f);
  EXPECT_EQ(std::get<Capsule>(drops.flow.drains[3].shape).half_length, 1);
  const Object& pebbles = scene.objects.at(12);
  EXPECT_EQ(pebbles.flow.spare, 6);
  EXPECT_EQ(pebbles.flow.emitters.size() + pebbles.flow.drains.size(), 2U);
  EXPECT_EQ(pebbles.flow.lifetime, 16);
}

TEST_F(FullScene, HasItsParticles) {
  const Object& object = scene.objects.at(5);
  EXPECT_EQ(object.masses, (std::vector<float>{1, 2, std::numeric_limits<float>::infinity(), 4}));
  EXPECT_EQ(object.velocities.at(1), (Vec3f{1, 2, 3}));
  ASSERT_EQ(object.constraints.size(), 2U);
  ASSERT_EQ(object.constraints[0].keyframes.size(), 2U);
  EXPECT_EQ(object.constraints[0].keyframes[1].time, 3.f);
  EXPECT_EQ(object.constraints[0].keyframes[1].factor, 2.f);
  EXPECT_EQ(object.constraints[0].break_force, 8.f);
  ASSERT_TRUE(object.constraints[1].plasticity);
  EXPECT_EQ(object.constraints[1].plasticity->yield, 0.5f);
  EXPECT_EQ(object.constraints[0].type, "distance");
  EXPECT_EQ(object.constraints[0].particles, (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(object.constraints[0].rest, (std::vector<float>{0.5f, 1.5f}));
  EXPECT_EQ(object.constraints[0].compliances, (std::vector<float>{0.25f, 0.5f}));
  EXPECT_EQ(object.triangles.at(1), (std::array<int, 3>{0, 1, 3}));
  EXPECT_EQ(object.volume.value().pressure, 2.f);
  EXPECT_EQ(object.attachments.size(), 4U);
  EXPECT_EQ(scene.objects.at(6).masses, (std::vector<float>{3, 3}));
}

}  // namespace
}  // namespace pliant
