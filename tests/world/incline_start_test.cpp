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

enum class SlopeKind { plane, box, mesh, body };

/// The incline, along which gravity is tilted. `rub` sets its friction.
template <class Rub>
void add_slope(Scene& scene, SlopeKind kind, const Rub& rub) {
  if (kind == SlopeKind::mesh) {
    MeshCollider mesh;
    mesh.mesh = grid_mesh(8, 8, 6, 6);
    rub(mesh);
    scene.add(mesh);
  } else if (kind == SlopeKind::body) {
    BodyOptions options;
    options.position = {0, -1, 0};
    options.kinematic = true;
    Object slab = make_body({{Box{{3, 1, 3}}}}, options);
    rub(slab);
    scene.add(slab);
  } else {
    Collider solid;
    if (kind == SlopeKind::box) {
      solid.shape = Box{{3, 1, 3}};
      solid.position = {0, -1, 0};
    }
    rub(solid);
    scene.add(solid);
  }
}

Scene on_incline(const Load& load, SlopeKind ground) {
  Scene scene;
  scene.settings.threads = 1;
  const float angle = incline * 3.14159265f / 180, sine = std::sin(angle), cosine = std::cos(angle);
  scene.gravity = {9.81f * sine, -9.81f * cosine, 0};
  const auto rub = [&](auto& on) {
    on.static_friction = friction;
    on.kinetic_friction = load.sliding;
  };
  add_slope(scene, ground, rub);
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

struct StandingBody {
  const char* name;
  SolidShape shape;
  float half;
};

/// What lies on an incline of a share of the angle of static friction, and slides with 0.6 of that.
World world_at(const StandingBody& what, int ground, float share, float mu) {
  const auto rub = [&](auto& on) {
    on.static_friction = mu;
    on.kinetic_friction = 0.6f * mu;
  };
  Scene scene;
  scene.settings.threads = 1;
  const float angle = std::atan(share * mu);
  scene.gravity = {9.81f * std::sin(angle), -9.81f * std::cos(angle), 0};
  BodyOptions options;
  options.position = {0.03f, what.half, 0.02f};
  Object body = make_body({{what.shape}}, options);
  rub(body);
  scene.add(body);
  add_slope(scene, static_cast<SlopeKind>(ground), rub);
  return World(scene);
}

const StandingBody standing_bodies[] = {{"cube", Box{{0.1f, 0.1f, 0.1f}}, 0.1f},
                                        {"plate", Box{{0.3f, 0.02f, 0.2f}}, 0.02f},
                                        {"tall box", Box{{0.1f, 0.15f, 0.1f}}, 0.15f},
                                        {"cylinder", Cylinder{0.1f, 0.1f}, 0.1f},
                                        {"coin", Cylinder{0.1f, 0.01f}, 0.01f}};

/// All of them slid off: at the start a substep's pass leaves 4 % of the normal force out, and what then asks for more
/// than static friction got kinetic friction.
TEST(InclineStart, BodiesStayUpToTheAngleOfStaticFriction) {
  for (const float step : {1 / 30.f, 1 / 60.f, 1 / 240.f})
    for (const float mu : {0.3f, 0.5f})
      for (int ground = 0; ground < 4; ++ground)
        for (const StandingBody& what : standing_bodies) {
          World world = world_at(what, ground, 0.97f, mu);
          const float start = world.object(0).positions()[0].x;
          for (int frame = 0; frame < static_cast<int>(1 / step); ++frame) ASSERT_TRUE(world.step(step).ok());
          EXPECT_LT(std::abs(world.object(0).positions()[0].x - start), 2e-4f)
              << what.name << " on ground " << ground << ", friction " << mu << ", frames of " << step << " s";
        }
}

/// Beyond it they slide with kinetic friction: 0.5 g t^2 (sin - 0.6 mu cos) after what they need to begin.
TEST(InclineStart, BodiesSlideBeyondIt) {
  constexpr float mu = 0.5f;
  const float angle = std::atan(1.05f * mu), a = 9.81f * (std::sin(angle) - 0.6f * mu * std::cos(angle));
  for (int ground = 0; ground < 4; ++ground) {
    World world = world_at(standing_bodies[1], ground, 1.05f, mu);
    for (int frame = 0; frame < 60; ++frame) ASSERT_TRUE(world.step(1 / 60.f).ok());
    EXPECT_NEAR(world.object(0).velocities()[0].x, a, 0.05f * a) << ground;
  }
}

}  // namespace
}  // namespace pliant
