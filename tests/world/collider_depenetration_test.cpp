// Tests what starts inside of a collider: it comes out slowly and in one direction, and the Report says where it
// started.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <vector>

#include "pliant/body.h"
#include "pliant/soft_body.h"
#include "pliant/world.h"
#include "world/run_time_support.h"
#include "world/surface_support.h"

namespace pliant {
namespace {

using testing_support::dt;

enum class SolidKind { box, sphere, capsule, grid };
constexpr SolidKind all_solids[] = {SolidKind::box, SolidKind::sphere, SolidKind::capsule, SolidKind::grid};
const char* const solid_names[] = {"box", "sphere", "capsule", "grid"};

/// A solid of 10 cm to all sides, and more for a capsule.
void add_solid(Scene& scene, SolidKind kind) {
  if (kind == SolidKind::grid) {
    MeshCollider grid;
    grid.name = "solid";
    grid.mesh = testing_support::box_mesh({0.2f, 0.2f, 0.2f});
    grid.as = MeshCollider::As::distance_grid;
    scene.add(grid);
    return;
  }
  Collider collider;
  collider.name = "solid";
  collider.shape = Box{{0.1f, 0.1f, 0.1f}};
  if (kind == SolidKind::sphere) collider.shape = Sphere{0.1f};
  if (kind == SolidKind::capsule) collider.shape = Capsule{0.1f, 0.2f};
  scene.add(collider);
}

Object patch(int n, float size, float height) {
  Object object = testing_support::cloth(testing_support::sheet(n, size, height));
  object.name = "patch";
  return object;
}

Object rope(float from, float to, int points, float height) {
  std::vector<Vec3f> places;
  for (int i = 0; i < points; ++i)
    places.push_back({from + (to - from) * static_cast<float>(i) / static_cast<float>(points - 1), height, 0.002f});
  Object object = make_rope(places);
  object.name = "rope";
  object.collides = true;
  return object;
}

Object jelly(float size, const Vec3f& at) {
  SoftBodyOptions options;
  options.material = elastic_solid("rubber");
  Object object = make_soft_body(box_tetrahedra({size, size, size}, {2, 2, 2}), options);
  for (Vec3f& p : object.positions) p += at;
  object.name = "jelly";
  return object;
}

struct ComingOut {
  float fastest = 0;          ///< of a particle, by velocity or by the way in a frame [m/s]
  std::vector<Vec3f> places;  ///< at the end
  std::string warnings;
};

ComingOut come_out(const Scene& scene, int frames) {
  World world(scene);
  ComingOut out;
  std::vector<Vec3f> before = world.object(0).positions();
  for (int frame = 0; frame < frames; ++frame) {
    const Report report = world.step(dt);
    EXPECT_TRUE(report.ok()) << report.explain();
    for (const std::string& warning : report.warnings) out.warnings += warning + "\n";
    out.places = world.object(0).positions();
    const std::vector<Vec3f> velocities = world.object(0).velocities();
    for (std::size_t i = 0; i < before.size(); ++i)
      out.fastest = std::max({out.fastest, length(velocities[i]), length(out.places[i] - before[i]) / dt});
    before = out.places;
  }
  return out;
}

Scene without_gravity(const Object& object, SolidKind solid) {
  Scene scene;
  scene.gravity = {};
  scene.add(object);
  add_solid(scene, solid);
  return scene;
}

void expect_told(const ComingOut& seen, const std::string& who) {
  EXPECT_NE(seen.warnings.find("object '" + who + "', particle "), std::string::npos) << seen.warnings;
  EXPECT_NE(seen.warnings.find(": is inside of collider 'solid'"), std::string::npos) << seen.warnings;
}

/// Before: 51, 25, 28 and 90 m/s of the patch, 28 of the rope, 183 of the jelly.
TEST(ColliderDepenetration, OfWhatIsInsideIsSlow) {
  for (const SolidKind solid : all_solids)
    for (const Object& object : {patch(5, 0.1f, 0.01f), rope(-0.04f, 0.04f, 10, 0.01f), jelly(0.1f, {0, 0.01f, 0})}) {
      SCOPED_TRACE(solid_names[static_cast<int>(solid)] + (" and " + object.name));
      const ComingOut seen = come_out(without_gravity(object, solid), 40);
      EXPECT_LT(seen.fastest, 2.1f);
      expect_told(seen, object.name);
      for (const Vec3f& p : seen.places) EXPECT_GT(std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}), 0.07f);
    }
}

/// Before: 279, 90, 327 and 147 m/s of the sheet, 867, 140, 140 and 64 m/s of the rope. What is outside is dragged
/// along.
TEST(ColliderDepenetration, OfWhatGoesRightThroughIsSlow) {
  for (const SolidKind solid : all_solids)
    for (const Object& object : {patch(13, 0.4f, 0), rope(-0.3f, 0.31f, 40, 0)}) {
      SCOPED_TRACE(solid_names[static_cast<int>(solid)] + (" and " + object.name));
      const ComingOut seen = come_out(without_gravity(object, solid), 60);
      EXPECT_LT(seen.fastest, solid == SolidKind::box || solid == SolidKind::grid ? 17.f : 2.5f);
      expect_told(seen, object.name);
    }
}

/// What has a pin inside is meant to be there.
TEST(ColliderDepenetration, LeavesWhatIsPinnedInside) {
  Object object = patch(9, 0.3f, 0);
  object.pins.push_back({40, {}});  // the middle
  EXPECT_EQ(come_out(without_gravity(object, SolidKind::sphere), 2).warnings.find("is inside of"), std::string::npos);
}

/// Half of the thickness is ordinary contact.
TEST(ColliderDepenetration, LeavesShallowOverlapsToContact) {
  for (const SolidKind solid : {SolidKind::box, SolidKind::grid})
    EXPECT_EQ(come_out(without_gravity(patch(5, 0.1f, 0.099f), solid), 2).warnings.find("is inside of"),
              std::string::npos);
}

/// A collider that comes at play time pushes cloth at its full speed.
TEST(ColliderDepenetration, LeavesWhatIsPushedItsSpeed) {
  Scene scene;
  scene.gravity = {};
  scene.add(patch(9, 0.15f, 0.3f));
  Collider ram;
  ram.name = "solid";
  ram.shape = Box{{0.1f, 0.1f, 0.1f}};
  ram.motion.keyframes = {{0, {}, {}}, {1, {0, 5, 0}, {}}};
  scene.add(ram);
  const ComingOut seen = come_out(scene, 30);
  EXPECT_EQ(seen.warnings.find("is inside of"), std::string::npos) << seen.warnings;
  for (const Vec3f& p : seen.places) EXPECT_GT(p.y, 2.55f);
}

/// One that was inside is carried along as well.
TEST(ColliderDepenetration, GoesWithTheCollider) {
  Scene scene;
  scene.gravity = {};
  scene.add(patch(5, 0.1f, 0.06f));
  Collider ram;
  ram.name = "solid";
  ram.shape = Box{{0.1f, 0.1f, 0.1f}};
  ram.motion.keyframes = {{0, {}, {}}, {1, {0, 5, 0}, {}}};
  scene.add(ram);
  const ComingOut seen = come_out(scene, 30);
  expect_told(seen, "patch");
  for (const Vec3f& p : seen.places) EXPECT_GT(p.y, 2.59f);
  EXPECT_LT(seen.fastest, 7.5f);
}

}  // namespace
}  // namespace pliant
