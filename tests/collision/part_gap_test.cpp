// Tests that balls around parts prove them apart only where touch finds nothing, and that they prove it mostly.
#include "collision/bodies/part_gap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "collision/bodies/pair_touch.h"
#include "geometry/convex_hull.h"
#include "pliant/random.h"

namespace pliant {
namespace {

Polyhedron random_hull(Random& random) {
  std::vector<Vec3f> points;
  const int count = 5 + static_cast<int>(random.next() * 8);
  points.reserve(static_cast<std::size_t>(count));
  const Vec3f sides{random.between(0.02f, 0.2f), random.between(0.02f, 0.2f), random.between(0.02f, 0.2f)};
  for (int i = 0; i < count; ++i) {
    const Vec3f at = rotate(random.rotation(), Vec3f{0, 1, 0});
    points.push_back({0.1f + sides.x * at.x, sides.y * at.y, sides.z * at.z});
  }
  return polyhedron_of(convex_hull(points).value());
}

BodyPart random_part(Random& random, const std::vector<Polyhedron>& polyhedra) {
  BodyPart part;
  const int kind = static_cast<int>(random.next() * 5);
  part.shape.kind = static_cast<ConvexShape::Kind>(kind);
  if (part.shape.kind == ConvexShape::Kind::polyhedron) {
    part.shape.polyhedron = &polyhedra[static_cast<std::size_t>(random.next() * static_cast<float>(polyhedra.size()))];
  } else {
    part.shape.radius = kind < 2 || random.next() < 0.3f ? random.between(0.01f, 0.1f) : 0;
    part.shape.core_radius = kind >= 2 ? random.between(0.01f, 0.2f) : 0;
    part.shape.half_length = kind >= 1 ? random.between(0.01f, 0.2f) : 0;
  }
  part.pose.position = convert<double>(rotate(random.rotation(), Vec3f{0, random.between(0, 0.2f), 0}));
  part.pose.rotation = normalise(convert<double>(random.rotation()));
  return part;
}

TEST(PartGap, NeverHidesATouch) {
  Random random(7);
  std::vector<Polyhedron> polyhedra{polyhedron_of_box({0.05f, 0.03f, 0.1f}), polyhedron_of_box({0.2f, 0.2f, 0.01f})};
  while (polyhedra.size() < 20) polyhedra.push_back(random_hull(random));
  int apart = 0, proven = 0;
  for (int i = 0; i < 20000; ++i) {
    const BodyPart a = random_part(random, polyhedra), b = random_part(random, polyhedra);
    Posed b_in_a;
    b_in_a.position = convert<double>(rotate(random.rotation(), Vec3f{0, random.between(0, 0.6f), 0}));
    b_in_a.rotation = normalise(convert<double>(random.rotation()));
    const double reach = static_cast<double>(random.next() < 0.5f ? random.between(0, 0.002f) : random.between(0, 0.1f));
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
