// Compares moments of solids with the formulas of mechanics, with samples, and with one another.
#include "geometry/mass_properties.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "geometry/geometry_support.h"

namespace pliant {
namespace {

using testing_support::expect_near;

constexpr double pi = 3.14159265358979323846;

Quatd turn(const Vec3d& axis, double radians) {
  const Vec3d unit = axis * (1 / length(axis));
  const double s = std::sin(radians / 2);
  return {unit.x * s, unit.y * s, unit.z * s, std::cos(radians / 2)};
}

void expect_equal(const Moments& a, const Moments& b, double tolerance) {
  EXPECT_NEAR(a.mass, b.mass, tolerance);
  expect_near(a.first, b.first, tolerance);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(a.second[i], b.second[i], tolerance) << i;
}

TEST(MassProperties, OfSimpleSolidsAreThoseOfTextbooks) {
  const MassProperties ball = mass_properties(times(moments_of_sphere(0.5), 3));
  EXPECT_NEAR(ball.mass, 3 * 4 * pi / 3 / 8, 1e-12);
  expect_near(ball.inertia, Vec3d{1, 1, 1} * (0.4 * ball.mass * 0.25), 1e-12);

  const MassProperties box = mass_properties(moments_of_box({0.5, 1, 1.5}));  // edges of 1, 2 and 3 m
  EXPECT_NEAR(box.mass, 6, 1e-12);
  expect_near(box.inertia, Vec3d{4 + 9, 9 + 1, 1 + 4} * (6. / 12), 1e-12);
  EXPECT_EQ(box.axes.w, 1) << "principal axes stay as they are";

  const MassProperties rod = mass_properties(moments_of_cylinder(0.1, 2));
  expect_near(rod.inertia, Vec3d{0.01 / 4 + 16. / 12, 0.01 / 2, 0.01 / 4 + 16. / 12} * rod.mass, 1e-12);

  const MassProperties cone = mass_properties(moments_of_cone(0.3, 1));  // height 2 m
  EXPECT_NEAR(cone.mass, pi / 3 * 0.09 * 2, 1e-12);
  expect_near(cone.centre, {0, -0.5, 0}, 1e-12);
  expect_near(cone.inertia, Vec3d{3. / 80 * (4 * 0.09 + 4), 0.3 * 0.09, 3. / 80 * (4 * 0.09 + 4)} * cone.mass, 1e-12);
}

/// Sums over cells of a fine grid.
Moments sampled(const std::function<bool(const Vec3d&)>& inside, double reach, int cells) {
  Moments out;
  const double size = 2 * reach / cells, volume = size * size * size;
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j)
      for (int k = 0; k < cells; ++k) {
        const Vec3d p = Vec3d{i + 0.5, j + 0.5, k + 0.5} * size - Vec3d{reach, reach, reach};
        if (!inside(p)) continue;
        out.mass += volume;
        out.first += p * volume;
        const std::array<double, 6> square{p.x * p.x, p.y * p.y, p.z * p.z, p.y * p.z, p.z * p.x, p.x * p.y};
        for (std::size_t s = 0; s < 6; ++s) out.second[s] += volume * square[s];
      }
  return out;
}

TEST(MassProperties, OfCapsuleAndConeAgreeWithSamples) {
  const auto in_capsule = [](const Vec3d& p) {
    const double y = p.y - std::fmin(std::fmax(p.y, -0.5), 0.5);
    return p.x * p.x + y * y + p.z * p.z < 0.16;
  };
  expect_equal(moments_of_capsule(0.4, 0.5), sampled(in_capsule, 1, 200), 2e-3);
  const auto in_cone = [](const Vec3d& p) {
    const double radius = 0.6 * (0.8 - p.y) / 1.6;
    return std::fabs(p.y) < 0.8 && p.x * p.x + p.z * p.z < radius * radius;
  };
  expect_equal(moments_of_cone(0.6, 0.8), sampled(in_cone, 1, 200), 2e-3);
}

const std::vector<std::array<int, 3>> box_triangles{{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};

std::vector<Vec3d> box_corners(const Vec3d& half, const Posed& pose) {
  std::vector<Vec3d> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back(to_world(pose, Vec3d{(i & 1) != 0 ? half.x : -half.x, (i & 2) != 0 ? half.y : -half.y,
                                           (i & 4) != 0 ? half.z : -half.z}));
  return corners;
}

TEST(MassProperties, OfAMeshAreThoseOfTheSolidItEncloses) {
  const Vec3d half{0.2, 0.7, 0.4};
  const Posed pose{{3, -2, 5}, turn({1, 2, -0.5}, 0.9)};
  const Moments mesh = moments_of_mesh(box_corners(half, pose), box_triangles);
  expect_equal(mesh, moved(moments_of_box(half), pose), 1e-11);
}

TEST(MassProperties, PrincipalAxesAreFoundForAnyPose) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto draw = [&] {
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    return Vec3d{x, y, z};
  };
  for (int trial = 0; trial < 200; ++trial) {
    const Vec3d half = abs(draw()) + Vec3d{0.05, 0.05, 0.05};
    const Posed pose{draw() * 3., turn(draw(), 3 * uniform(random))};
    const MassProperties own = mass_properties(moments_of_box(half)),
                         found = mass_properties(moved(moments_of_box(half), pose));
    expect_near(found.centre, pose.position, 1e-12);
    EXPECT_NEAR(found.inertia.x + found.inertia.y + found.inertia.z, own.inertia.x + own.inertia.y + own.inertia.z,
                1e-12);
    // The inertia about any axis is the same, whichever principal axes represent it.
    for (int check = 0; check < 4; ++check) {
      const Vec3d spin = draw();
      const auto energy = [&](const MassProperties& of, const Quatd& axes) {
        const Vec3d local = rotate(conjugate(axes), spin);
        return of.inertia.x * local.x * local.x + of.inertia.y * local.y * local.y + of.inertia.z * local.z * local.z;
      };
      EXPECT_NEAR(energy(found, found.axes), energy(own, pose.rotation), 1e-11);
    }
  }
}

TEST(MassProperties, OfPartsAddUp) {
  Moments halves = moved(moments_of_box({0.5, 1, 1}), {{-0.5, 0, 0}, {}});
  halves += moved(moments_of_box({0.5, 1, 1}), {{0.5, 0, 0}, {}});
  expect_equal(halves, moments_of_box({1, 1, 1}), 1e-12);
  EXPECT_EQ(mass_properties(Moments{}).mass, 0);
}

}  // namespace
}  // namespace pliant
