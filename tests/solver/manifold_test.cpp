// Tests contact of rigid bodies with known answers: sag, friction, impact, stacks.
#include "solver/bodies/manifold_passes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "solver/bodies_support.h"

namespace pliant {
namespace {

using testing_support::Bodies;

Bodies on_ground() {
  Bodies boxes;
  boxes.add({50, 1, 50}, {0, -1, 0}, 0);
  return boxes;
}

void run(Bodies& boxes, int frames) {
  for (int f = 0; f < frames; ++f) boxes.frame();
}

double fastest(const Bodies& boxes) {
  double most = 0;
  for (const auto& body : boxes.bodies) most = std::max(most, double(length(body.velocity)));
  return most;
}

/// |s| = eps / ((1 - eps) beta) h^2 w F, for each point with a quarter of the weight.
TEST(Manifold, ABoxAtRestSagsAsTheFormulaSays) {
  for (const int substeps : {4, 8, 16}) {
    Bodies boxes = on_ground();
    boxes.substeps = substeps;
    boxes.add({0.5f, 0.5f, 0.5f}, {0, 0.5, 0});
    run(boxes, 240);
    const double h = 1. / 60 / substeps, beta = 0.04, eps = 0.04;
    const double sag = eps / ((1 - eps) * beta) * h * h * 9.81;  // w F of four points that share the load is g
    EXPECT_NEAR(0.5 - boxes.bodies[1].pose.position.y, sag, 0.1 * sag) << substeps;
    EXPECT_LT(fastest(boxes), 1e-4);
  }
}

/// A box on an incline, which is gravity that is turned.
Bodies on_incline(double angle) {
  Bodies boxes = on_ground();
  boxes.gravity = {float(9.81 * std::sin(angle)), float(-9.81 * std::cos(angle)), 0};
  boxes.add({0.5f, 0.1f, 0.5f}, {0, 0.1, 0});
  run(boxes, 20);
  return boxes;
}

TEST(Manifold, ABoxHoldsOnAnInclineUpToTheAngleOfFriction) {
  const double limit = std::atan(0.6);
  Bodies below = on_incline(limit - 0.02), above = on_incline(limit + 0.05);
  const double start = below.bodies[1].pose.position.x;
  run(below, 120);
  EXPECT_NEAR(below.bodies[1].pose.position.x, start, 1e-3);
  const double before = double(above.bodies[1].velocity.x);
  run(above, 60);
  const double expected = 9.81 * (std::sin(limit + 0.05) - 0.6 * std::cos(limit + 0.05));
  EXPECT_NEAR(double(above.bodies[1].velocity.x) - before, expected, 0.03 * expected);
}

TEST(Manifold, ABoxThatSpinsOnItsFaceIsStoppedByTwist) {
  Bodies boxes = on_ground();
  boxes.add({0.5f, 0.1f, 0.5f}, {0, 0.1, 0});
  run(boxes, 10);
  boxes.bodies[1].spin = {0, 3, 0};
  // Friction acts at the points' mean radius r, and I = m (0.5^2 + 0.5^2) / 3: the box stops after w I / (mu m g r).
  const double time = 3 * (0.5 / 3) / (0.6 * 9.81 * std::sqrt(0.5));
  run(boxes, int(60 * time * 0.8));
  EXPECT_GT(boxes.bodies[1].spin.y, 0.1f);
  run(boxes, int(60 * time * 0.4) + 1);
  EXPECT_LT(std::fabs(boxes.bodies[1].spin.y), 1e-2f);
}

TEST(Manifold, ADroppedBoxBouncesByItsRestitution) {
  for (const float e : {0.f, 0.5f, 0.8f}) {
    Bodies boxes = on_ground();
    boxes.restitution = e;
    boxes.add({0.5f, 0.5f, 0.5f}, {0, 2.5, 0});
    double highest = 0;
    bool has_hit = false;
    for (int f = 0; f < 150; ++f) {
      boxes.frame();
      has_hit = has_hit || boxes.bodies[1].velocity.y > -0.01f;
      if (has_hit) highest = std::max(highest, boxes.bodies[1].pose.position.y - 0.5);
    }
    EXPECT_NEAR(highest, 2 * double(e) * double(e), 0.04) << e;
  }
}

/// Five balls in a row, which touch or are a little apart: the last one flies off.
TEST(Manifold, ACradlePassesAnImpactOn) {
  for (const double apart : {0., 1e-4, 5e-3, 0.03})
    for (const bool backwards : {false, true}) {
      Bodies boxes;
      boxes.gravity = {};
      boxes.restitution = 1;
      const auto x = [&](int i) { return (backwards ? 4 - i : i) * (0.1 + apart); };
      for (int i = 0; i < 5; ++i) boxes.add_ball(0.05f, {x(i), 0, 0});
      const std::size_t first = backwards ? 4 : 0, last = backwards ? 0 : 4;
      boxes.bodies[first].pose.position.x -= 0.2;
      boxes.bodies[first].velocity = {1, 0, 0};
      run(boxes, 60);
      EXPECT_NEAR(boxes.bodies[last].velocity.x, 1, 1e-3) << apart << backwards;
      for (std::size_t i = 0; i < 5; ++i) {
        if (i != last) {
          EXPECT_NEAR(boxes.bodies[i].velocity.x, 0, 1e-3) << apart << ' ' << backwards << ' ' << i;
        }
      }
    }
}

TEST(Manifold, MomentumIsKeptBetweenFreeBodies) {
  Bodies boxes;
  boxes.gravity = {};
  boxes.add({0.5f, 0.5f, 0.5f}, {0, 0, 0}, 2);
  boxes.add({0.3f, 0.4f, 0.5f}, {1.5, 0.3, 0.2}, 1);
  boxes.bodies[1].velocity = {-4, 0, 0};
  const auto linear = [&] { return boxes.bodies[0].velocity * 2.f + boxes.bodies[1].velocity; };
  run(boxes, 60);
  EXPECT_LT(boxes.bodies[0].velocity.x, -0.5f) << "they have met";
  EXPECT_NEAR(linear().x, -4, 1e-5);
  EXPECT_NEAR(linear().y, 0, 1e-5);
  EXPECT_NEAR(linear().z, 0, 1e-5);
}

TEST(Manifold, ATowerOfTenStands) {
  Bodies boxes = on_ground();
  for (int i = 0; i < 10; ++i) boxes.add({0.5f, 0.5f, 0.5f}, {0, 0.5 + i, 0});
  run(boxes, 600);
  EXPECT_LT(fastest(boxes), 1e-3);
  for (int i = 0; i < 10; ++i) {
    const Vec3d p = boxes.bodies[std::size_t(i + 1)].pose.position;
    EXPECT_NEAR(p.x, 0, 1e-3) << i;
    EXPECT_NEAR(p.y, 0.5 + i, 1e-2) << i;
  }
}

TEST(Manifold, APyramidStands) {
  Bodies boxes = on_ground();
  const int base = 10;
  std::vector<Vec3d> start{{}};
  for (int row = 0; row < base; ++row)
    for (int i = 0; i < base - row; ++i) {
      start.push_back({i + 0.5 * row - 0.5 * base, 0.5 + row, 0});
      boxes.add({0.5f, 0.5f, 0.5f}, start.back());
    }
  run(boxes, 240);
  double most = 0;
  for (std::size_t i = 1; i < start.size(); ++i)
    most = std::max(most, length(boxes.bodies[i].pose.position - start[i]));
  EXPECT_LT(most, 5e-3);
  EXPECT_LT(fastest(boxes), 5e-3);
  RecordProperty("displacement", std::to_string(most));
}

/// Dropped by 1 cm; heights are those of the shapes' frames.
TEST(Manifold, EveryKindOfSolidComesToRest) {
  using Kind = ConvexShape::Kind;
  const Quatd lying{0, 0, std::sqrt(0.5), std::sqrt(0.5)};
  Bodies bodies = on_ground();
  bodies.add({0.3f, 0.2f, 0.4f}, {0, 0.21, 0});
  bodies.add_ball(0.3f, {2, 0.31, 0});
  bodies.add_round(Kind::segment, 0.2f, 0.4f, {4, 0.21, 0}, lying);
  bodies.add_round(Kind::cylinder, 0.3f, 0.4f, {6, 0.41, 0});
  bodies.add_round(Kind::cylinder, 0.3f, 0.4f, {8, 0.31, 0}, lying);
  bodies.add_round(Kind::cone, 0.3f, 0.4f, {10, 0.41, 0});
  run(bodies, 240);
  const double heights[] = {0.2, 0.3, 0.2, 0.4, 0.3, 0.2};  // of the centres of mass
  for (std::size_t i = 0; i < 6; ++i) {
    const auto& body = bodies.bodies[i + 1];
    EXPECT_NEAR(body.pose.position.y, heights[i], 1e-3) << i;
    EXPECT_NEAR(body.pose.position.x, 2. * double(i), 2e-3) << i;
    EXPECT_LT(length(body.velocity), 1e-3f) << i;
    EXPECT_LT(length(body.spin), 5e-3f) << i;
  }
}

TEST(Manifold, AnOverhangingBoxStandsUpToHalfItsWidth) {
  for (const double overhang : {0.47, 0.53}) {
    Bodies boxes = on_ground();
    boxes.add({0.5f, 0.5f, 0.5f}, {0, 0.5, 0}, 0);
    boxes.add({0.5f, 0.5f, 0.5f}, {overhang, 1.5, 0});
    run(boxes, 240);
    if (overhang < 0.5) {
      EXPECT_NEAR(boxes.bodies[2].pose.position.y, 1.5, 0.02);
    } else {
      EXPECT_LT(boxes.bodies[2].pose.position.y, 1.2);
    }
  }
}

}  // namespace
}  // namespace pliant
