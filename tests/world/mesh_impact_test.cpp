// Tests that solids which fall flat on a mesh rebound no faster than from a plane, wherever the edges of its triangles
// are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "pliant/body.h"
#include "pliant/world.h"

namespace pliant {
namespace {

/// How fast a solid goes up and spins after an impact at 9 m/s, at most, in many places and phases of the frame.
struct Rebound {
  float up = 0, spin = 0;
};

Rebound rebound(const SolidShape& shape, bool is_on_mesh) {
  Rebound most;
  for (int phase = 0; phase < 16; ++phase) {
    const float shift = static_cast<float>(phase);
    Scene scene;
    scene.gravity = {};
    scene.settings.threads = 1;
    if (is_on_mesh) {
      MeshCollider mesh;
      mesh.mesh = grid_mesh(12, 12, 2.4f, 2.4f);
      scene.add(mesh);
    } else {
      scene.add(Collider{});
    }
    BodyOptions options;
    options.position = {0.3f + 0.013f * shift, 0.8f + 9.f / 60 / 16 * shift, 0.2f};
    options.velocity = {0, -9, 0};
    scene.add(make_body({{shape}}, options));
    World world(scene);
    for (int frame = 0; frame < 16; ++frame) {
      EXPECT_TRUE(world.step(1.f / 60).ok());
      const Record& spin = world.state().frames.angular_velocities[0];
      most.up = std::max(most.up, world.object(0).velocities()[0].y);
      most.spin = std::max(most.spin, std::sqrt(spin.x * spin.x + spin.y * spin.y + spin.z * spin.z));
    }
  }
  return most;
}

TEST(MeshImpact, ReboundsNoFasterThanFromAPlane) {
  const std::vector<std::pair<const char*, SolidShape>> solids{{"small cube", Box{{0.05f, 0.05f, 0.05f}}},
                                                               {"cube", Box{{0.25f, 0.25f, 0.25f}}},
                                                               {"cylinder", Cylinder{0.1f, 0.1f}},
                                                               {"ball", Sphere{0.1f}}};
  for (const auto& [name, shape] : solids) {
    const Rebound on_mesh = rebound(shape, true), on_plane = rebound(shape, false);
    // What is left depends on the phase, on a plane as well: up to 0.1 m/s.
    EXPECT_LE(on_mesh.up, std::max(on_plane.up, 0.1f)) << name;
    EXPECT_LE(on_mesh.spin, on_plane.spin + 1e-2f) << name;
  }
}

}  // namespace
}  // namespace pliant
