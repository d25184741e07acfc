// Tests what any World guarantees: the same bits however it is run, restored or loaded.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include "generators.h"
#include "io/write_support.h"
#include "pliant/save.h"
#include "support/kernels.h"

namespace pliant::properties {
namespace {

constexpr float dt = 1.f / 60;

std::string hash_after(const Scene& scene, const Settings& settings, int frames) {
  World world(scene, settings);
  for (int frame = 0; frame < frames; ++frame) RC_ASSERT(world.step(dt).ok());
  return world.state_hash();
}

RC_GTEST_PROP(Worlds, GiveTheSameBitsOnAnyThreadsAndInstructionSet, ()) {
  const Scene scene = small_scene();
  Settings settings = scene.settings;
  const std::string one = hash_after(scene, settings, 4);
  settings.threads = *rc::gen::inRange(2, 6);
  settings.isa = *rc::gen::elementOf(testing_support::available_isas());
  RC_ASSERT(hash_after(scene, settings, 4) == one);
}

RC_GTEST_PROP(Worlds, GoOnFromAStateThatWasPutBack, ()) {
  const Scene scene = small_scene();
  World world(scene);
  const int before = *rc::gen::inRange(0, 4), between_them = *rc::gen::inRange(1, 4);
  for (int frame = 0; frame < before; ++frame) world.step(dt);
  const State middle = world.state();
  for (int frame = 0; frame < between_them; ++frame) world.step(dt);
  const std::string there = world.state_hash();
  world.restore(middle);
  for (int frame = 0; frame < between_them; ++frame) world.step(dt);
  RC_ASSERT(world.state_hash() == there);
}

RC_GTEST_PROP(Worlds, GoOnFromTheirFile, ()) {
  const Scene scene = small_scene();
  const test::Folder folder;
  World world(scene);
  for (int frame = *rc::gen::inRange(0, 4); frame > 0; --frame) world.step(dt);
  save(folder / "world", world, scene);
  LoadedWorld loaded = load_world(folder / "world");
  for (int frame = 0; frame < 2; ++frame) {
    world.step(dt);
    loaded.world.step(dt);
  }
  RC_ASSERT(loaded.world.state_hash() == world.state_hash());
}

RC_GTEST_PROP(Worlds, WithoutGravityKeepTheirMomentum, ()) {
  Scene scene = small_scene();
  scene.gravity = {};
  scene.colliders.clear();
  for (Object& object : scene.objects) {
    object.pins.clear();
    object.velocities.assign(object.positions.size(), {});
    for (Vec3f& v : object.velocities) v = point(1);
  }
  World world(scene);
  const auto momentum = [&](int o) {
    Vec3d sum{};
    for (std::size_t i = 0; i < scene.objects[o].masses.size(); ++i) {
      const Vec3f v = world.object(o).velocities()[i];
      const double m = double(scene.objects[o].masses[i]);
      sum = sum + Vec3d{m * double(v.x), m * double(v.y), m * double(v.z)};
    }
    return sum;
  };
  Vec3d before{}, after{};
  double mass = 0;
  for (int o = 0; o < world.object_count(); ++o) before = before + momentum(o);
  for (const Object& object : scene.objects)
    for (const float m : object.masses) mass += double(m);
  for (int frame = 0; frame < 3; ++frame) world.step(dt);
  for (int o = 0; o < world.object_count(); ++o) after = after + momentum(o);
  const double change = std::sqrt(length_squared(after - before));
  RC_LOG() << "momentum changed by " << change << " of a mass of " << mass;
  RC_ASSERT(change <= 2e-4 * mass);  // rounding of velocities of 1 m/s over several dozen substeps
}

RC_GTEST_PROP(Worlds, ThatAreMirroredMoveMirrored, ()) {
  // Negating x is exact in floating point, and every formula is even or odd in it, except for how hinges are wound.
  Scene scene = small_scene();
  for (Object& object : scene.objects) {
    object.self_collision = object.collides = false;
    object.triangles.clear();
  }
  scene.settings.sweep = Sweep::natural;
  Scene mirrored = scene;
  for (Object& object : mirrored.objects)
    for (Vec3f& x : object.positions) x.x = -x.x;
  World here(scene), there(mirrored);
  for (int frame = 0; frame < 3; ++frame) {
    here.step(dt);
    there.step(dt);
  }
  for (int o = 0; o < here.object_count(); ++o)
    for (std::size_t i = 0; i < here.object(o).positions().size(); ++i) {
      RC_ASSERT(here.object(o).positions()[i].x == -there.object(o).positions()[i].x);
      RC_ASSERT(here.object(o).positions()[i].y == there.object(o).positions()[i].y);
    }
}

}  // namespace
}  // namespace pliant::properties
