// Tests that small stiff objects come to rest after they were thrown. A fast spin throws open a hinge. If projections
// closed it along tangents without limit, its triangles would stretch and feed the spin: square tubes of a few
// millimetres rolled for ever.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "math/quat.h"
#include "pliant/scene.h"
#include "pliant/world.h"
#include "support/scenes.h"

namespace pliant {
namespace {

/// An open square tube, 6 x 4 x 40 mm, rotated about a slanted axis and raised. With ten substeps per frame, some of
/// these never came to rest.
TriangleMesh tube(float degrees, float aside) {
  const Quatf turn = rotation({0.26f, 0.23f, 1}, degrees);
  TriangleMesh mesh;
  for (const float z : {0.02f, -0.02f}) {
    for (const auto& [x, y] :
         {std::array{0.0024f, -0.002f}, {0.0024f, 0.002f}, {-0.0036f, 0.002f}, {-0.0036f, -0.002f}}) {
      mesh.positions.push_back(rotate(turn, Vec3f{x, y, z}) + Vec3f{aside, 0.4f, 0});
    }
  }
  for (int side = 0; side < 4; ++side) {
    const int next = (side + 1) % 4;
    mesh.triangles.push_back({next, side, side + 4});
    mesh.triangles.push_back({next, side + 4, next + 4});
  }
  return mesh;
}

TEST(Tumbling, StiffTubesComeToRest) {
  constexpr int throws = 48;
  Scene scene;
  scene.settings = testing_support::settings_of(10);
  for (int i = 0; i < throws; ++i) {
    const auto number = static_cast<float>(i);
    ClothOptions options;
    options.name = "tube " + std::to_string(i);
    options.material = fabric("cotton");
    options.material.thickness = 0.004f;
    options.material.bending_damping = 0;
    options.velocity = {1 + number / 12, -5, 0.3f};
    scene.add_cloth(tube(7 * number, 0.2f * number), options);
  }
  scene.add(Collider{});
  World world(scene);
  for (int frame = 0; frame < 300; ++frame) ASSERT_TRUE(world.step(scene.frame_time).ok());
  for (int i = 0; i < throws; ++i) {
    for (const Vec3f& v : world.object(i).velocities()) EXPECT_LT(std::sqrt(length_squared(v)), 0.1f) << "tube " << i;
  }
}

}  // namespace
}  // namespace pliant
