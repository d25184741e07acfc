// Tests that balls around parts prove them apart only where touch finds nothing, and that they prove it mostly.
#include "collision/bodies/part_gap.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "collision/bodies/pair_touch.h"
#include "collision/random_support.h"
#include "geometry/convex_hull.h"

namespace pliant {
namespace {

using testing_support::Random;
using testing_support::random_place;
using testing_support::uniform;

float length_from(Random& random, double low, double high) { return static_cast<float>(uniform(random, low, high)); }

Polyhedron random_hull(Random& random) {
  const int count = 5 + static_cast<int>(uniform(random, 0, 8));
  const Vec3d sides = abs(random_place(random, 0.2)) + Vec3d{0.02, 0.02, 0.02};
  std::vector<Vec3f> points;
  points.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const Vec3d at = unit_or(random_place(random, 1), Vec3d{0, 1, 0});
    points.push_back(convert<float>(Vec3d{0.1 + sides.x * at.x, sides.y * at.y, sides.z * at.z}));
  }
  return polyhedron_of(convex_hull(points).value());
}

Posed random_pose(Random& random, double range) {
  const Vec3d axis = random_place(random, 1);
  return {random_place(random, range), normalise(Quatd{axis.x, axis.y, axis.z, uniform(random, -1, 1)})};
}

BodyPart random_part(Random& random, const std::vector<Polyhedron>& polyhedra) {
  BodyPart part;
  const int kind = static_cast<int>(uniform(random, 0, 5));
  part.shape.kind = static_cast<ConvexShape::Kind>(kind);
  if (part.shape.kind == ConvexShape::Kind::polyhedron) {
    part.shape.polyhedron =
        &polyhedra[static_cast<std::size_t>(uniform(random, 0, static_cast<double>(polyhedra.size())))];
  } else {
    part.shape.radius = kind < 2 || uniform(random, 0, 1) < 0.3 ? length_from(random, 0.01, 0.1) : 0;
    part.shape.core_radius = kind >= 2 ? length_from(random, 0.01, 0.2) : 0;
    part.shape.half_length = kind >= 1 ? length_from(random, 0.01, 0.2) : 0;
  }
  part.pose = random_pose(random, 0.15);
  return part;
}

TEST(PartGap, NeverHidesATouch) {
  Random random(7);
  std::vector<Polyhedron> polyhedra{polyhedron_of_box({0.05f, 0.03f, 0.1f}), polyhedron_of_box({0.2f, 0.2f, 0.01f})};
  while (polyhedra.size() < 20) polyhedra.push_back(random_hull(random));
  int apart = 0, proven = 0;
  for (int i = 0; i < 20000; ++i) {
    const BodyPart a = random_part(random, polyhedra), b = random_part(random, polyhedra);
    const Posed b_in_a = random_pose(random, 0.4);
    const double reach = uniform(random, 0, i % 2 == 0 ? 0.002 : 0.1);
    const PartBall of_a = ball_around(a), of_b = ball_around(b);
    const bool is_proven = is_beyond(a, to_world(b_in_a, of_b.centre), of_b.radius, reach) ||
                           is_beyond(b, to_local(b_in_a, of_a.centre), of_a.radius, reach);
    const bool touches = touch_of(a, b, b_in_a, {reach, 0, {}}).count > 0;
    EXPECT_FALSE(is_proven && touches) << "pair " << i;
    apart += touches ? 0 : 1;
    proven += is_proven ? 1 : 0;
  }
  EXPECT_GT(apart, 4000);
  EXPECT_GT(proven, apart / 2);
}

}  // namespace
}  // namespace pliant
