// Tests searches along paths with corners and tips whose first touches and directions of passing are known.
#include "geometry/contact_path.h"

#include <gtest/gtest.h>

#include <vector>

namespace pliant {
namespace {

/// A solid of several planes against a point at the origin: each has a unit normal from the point to the solid, and a
/// separation at the start [m].
struct Planes {
  std::vector<PathGap> all;

  PathGap operator()(const Vec3d& displacement) const {
    PathGap most{-1e300, {}};
    for (const PathGap& plane : all) {
      const double separation = plane.separation + dot(plane.normal, displacement);
      if (separation > most.separation) most = {separation, plane.normal};
    }
    return most;
  }
};

/// A tip that comes along x from 0.1 m away, and is `height` above the point.
Planes tip(double height) {
  const Vec3d leading{-0.28, 0.96, 0}, trailing{0.6, 0.8, 0};
  return {{{0.028 + 0.96 * height, leading}, {-0.06 + 0.8 * height, trailing}}};
}

PathContact found(const Planes& planes, const Vec3d& along, double slop) {
  return PathSearch(ContactPath(along), slop, planes).find();
}

TEST(ContactPath, ATipThatGoesInTouchesOnTheSideOnWhichItComes) {
  const PathContact touch = found(tip(-0.01), {0.2, 0, 0}, 1e-3);
  EXPECT_TRUE(touch.touches);
  EXPECT_NEAR(touch.normal.x, -0.28, 1e-12);
  EXPECT_NEAR(touch.displacement.x, 0.1 - 0.01 * 0.96 / 0.28, 1e-3);
}

TEST(ContactPath, ATipThatPassesIsHeldAcrossItsMotion) {
  for (const double height : {-1e-4, 0., 0.02}) {
    const PathContact pass = found(tip(height), {0.2, 0, 0}, 1e-3);
    EXPECT_FALSE(pass.touches);
    EXPECT_NEAR(pass.displacement.x, 0.1 + 0.16 / 0.88 * height, 1e-4) << "where both planes are as far";
    EXPECT_NEAR(pass.normal.x, 0, 1e-12) << "stops nothing, at " << height;
    EXPECT_NEAR(pass.normal.y, 1, 1e-12);
  }
}

/// It is a millimetre before the point when the frame ends.
TEST(ContactPath, WhatPassesSoonIsHeldAcrossItsMotionToo) {
  const Vec3d along{0.099, 0, 0};
  EXPECT_NEAR(found(tip(-1e-4), along, 1e-3).normal.x, 0, 1e-12);
  const PathContact later = found(tip(-0.01), {0.06, 0, 0}, 1e-3);
  EXPECT_FALSE(later.touches) << "not in this frame";
  EXPECT_NEAR(later.normal.x, -0.28, 1e-12) << "but in the next one";
}

/// As what lies on soft contacts does. It is a millimetre before the flat place beyond the edge when the frame ends.
TEST(ContactPath, WhatHardlySinksPassesAnEdge) {
  const Planes edge{{{0.028 - 0.96e-4, {-0.28, 0.96, 0}}, {-1e-4, {0, 1, 0}}}};
  const ContactPath path({0.099, -2e-5, 0});
  EXPECT_NEAR(PathSearch(path, 1e-3, edge, 3e-5).find().normal.x, 0, 1e-12);
  EXPECT_NEAR(PathSearch(path, 1e-3, edge, 1e-5).find().normal.x, -0.28, 1e-12) << "sinks faster than that";
}

TEST(ContactPath, WhatPartsIsNearestWhereItBegins) {
  const PathContact nearest = found(tip(0.01), {-0.2, 0, 0}, 1e-3);
  EXPECT_FALSE(nearest.touches);
  EXPECT_EQ(nearest.time, 0);
}

TEST(ContactPath, WhatStandsIsNearestWhereItIs) {
  ContactPath path({0.2, 0, 0});
  path.turn(0, {-0.2, 0, 0});
  const PathContact nearest = PathSearch(path, 1e-3, tip(0.01)).find();
  EXPECT_FALSE(nearest.touches);
  EXPECT_NEAR(nearest.normal.x, -0.28, 1e-12);
}

}  // namespace
}  // namespace pliant
