// Tests how colliders are converted for contact.
#include "collision/fields/collider_pose.h"

#include <gtest/gtest.h>

namespace pliant {
namespace {

TEST(ColliderPose, PutsEveryShapeIntoThreeNumbers) {
  EXPECT_EQ(local_shape(Plane{}).kind, ShapeKind::plane);
  const LocalShape sphere = local_shape(Sphere{2}), capsule = local_shape(Capsule{3, 4}),
                   box = local_shape(Box{{5, 6, 7}});
  EXPECT_EQ(sphere.kind, ShapeKind::sphere);
  EXPECT_EQ(sphere.a, 2);
  EXPECT_EQ(capsule.kind, ShapeKind::capsule);
  EXPECT_EQ(capsule.a, 3);
  EXPECT_EQ(capsule.b, 4);
  EXPECT_EQ(box.kind, ShapeKind::box);
  EXPECT_EQ(box.a, 5);
  EXPECT_EQ(box.b, 6);
  EXPECT_EQ(box.c, 7);
}

TEST(ColliderPose, AppliesTheMotionAfterPositionAndRotation) {
  Collider collider;
  collider.shape = Capsule{0.1f, 1};
  collider.position = {1, 0, 0};
  collider.rotation = rotation({0, 0, 1}, -90);  // the capsule's axis is along +x
  EXPECT_NEAR(to_world(collider_pose(collider, 5), Vec3d{0, 1, 0}).x, 2, 1e-7);
  collider.motion.keyframes = {{0, {}, {}}, {1, {0, 0, 3}, rotation({0, 1, 0}, 90)}};
  const Vec3d tip =
      to_world(collider_pose(collider, 1), Vec3d{0, 1, 0});  // rotated about the origin of the world, then moved
  EXPECT_NEAR(tip.x, 0, 1e-6);
  EXPECT_NEAR(tip.y, 0, 1e-6);
  EXPECT_NEAR(tip.z, 1, 1e-6);
  collider.motion.pivot = {1, 0, 0};
  const Vec3d centre = to_world(collider_pose(collider, 1), Vec3d{0, 0, 0});
  EXPECT_NEAR(centre.x, 1, 1e-6);
  EXPECT_NEAR(centre.z, 3, 1e-6);
}

}  // namespace
}  // namespace pliant
