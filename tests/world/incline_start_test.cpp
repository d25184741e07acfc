// Tests that bodies which begin at rest on an incline stay at rest: friction holds from the first substep on.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "pliant/body.h"
#include "pliant/world.h"

namespace pliant {
namespace {

constexpr float friction = 0.9f;  // of which 0.839 is needed
constexpr float incline = 40;     // degrees

/// What lies on the incline: a box, and the friction with which it slides.
struct Load {
  Vec3f half;
  float sliding;
};

enum class SlopeKind { plane, box, mesh };

Scene on_incline(const Load& load, SlopeKind ground) {
  Scene scene;
  scene.settings.threads = 1;
  const float angle = incline * 3.14159265f / 180, sine = std::sin(angle), cosine = std::cos(angle);
  scene.gravity = {9.81f * sine, -9.81f * cosine, 0};
  const auto rub = [&](auto& on) {
    on.static_friction = friction;
    on.kinetic_friction = load.sliding;
  };
  if (ground == SlopeKind::mesh) {
    MeshCollider mesh;
    mesh.mesh = grid_mesh(8, 8, 6, 6);
    rub(mesh);
    scene.add(mesh);
  } else {
    Collider solid;
    if (ground == SlopeKind::box) {
      solid.shape = Box{{3, 1, 3}};
      solid.position = {0, -1, 0};
    }
    rub(solid);
    scene.add(solid);
  }
  BodyOptions options;
  options.position = {0.03f, load.half.y, 0.02f};
  Object box = make_body({{Box{load.half}}}, options);
  rub(box);
  scene.add(box);
  return scene;
}

TEST(InclineStart, ABoxAtRestPicksUpNoSpeed) {
  for (const SlopeKind ground : {SlopeKind::plane, SlopeKind::box, SlopeKind::mesh})
    for (const Load& load : {Load{{0.5f, 0.5f, 0.5f}, friction}, Load{{0.5f, 0.5f, 0.5f}, 0.5f},
                             Load{{0.5f, 0.1f, 0.5f}, friction}, Load{{0.05f, 0.05f, 0.05f}, friction}}) {
      World world(on_incline(load, ground));
      const Vec3f start = world.object(0).positions()[0];
      float fastest = 0;
      for (int frame = 0; frame < 30; ++frame) {
        ASSERT_TRUE(world.step(1.f / 60).ok());
        fastest = std::max(fastest, std::sqrt(length_squared(world.object(0).velocities()[0])));
      }
      const std::string what = "half height " + std::to_string(load.half.y) + " m, sliding friction " +
                               std::to_string(load.sliding) + ", ground " + std::to_string(static_cast<int>(ground));
      EXPECT_LT(fastest, 1e-3f) << what;
      EXPECT_LT(std::abs(world.object(0).positions()[0].x - start.x), 2e-4f) << what;
    }
}

}  // namespace
}  // namespace pliant
