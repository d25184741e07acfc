#include "math/best_rotation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace pliant {
namespace {

using Vec3d = Vec3<double>;

Matrix3d product_sum(const std::vector<Vec3d>& r, const std::vector<Vec3d>& q) {
  Matrix3d a{};
  for (std::size_t i = 0; i < r.size(); ++i) {
    const double rows[3] = {r[i].x, r[i].y, r[i].z}, columns[3] = {q[i].x, q[i].y, q[i].z};
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) a[3 * j + k] += rows[j] * columns[k];
  }
  return a;
}

class BestRotation : public ::testing::Test {
 protected:
  std::mt19937 random{7};
  std::uniform_real_distribution<double> in_cube{-1, 1};
  Vec3d point() { return {in_cube(random), in_cube(random), in_cube(random)}; }
  Quatd turn() { return normalise(Quatd{in_cube(random), in_cube(random), in_cube(random), in_cube(random)}); }
  std::vector<Vec3d> points(int count) {
    std::vector<Vec3d> out;
    for (int i = 0; i < count; ++i) out.push_back(point());
    return out;
  }
};

TEST_F(BestRotation, FindsTheRotationOfTurnedPoints) {
  for (int n = 0; n < 200; ++n) {
    const std::vector<Vec3d> q = points(8);
    const Quatd expected = turn();
    std::vector<Vec3d> r;
    for (const Vec3d& p : q) r.push_back(rotate(expected, p));
    EXPECT_NEAR(std::fabs(dot(best_rotation(product_sum(r, q)), expected)), 1, 1e-13);
  }
}

TEST_F(BestRotation, LeavesNoTorque) {
  for (int n = 0; n < 200; ++n) {
    const std::vector<Vec3d> q = points(6), r = points(6);
    const Quatd found = best_rotation(product_sum(r, q));
    Vec3d torque{};
    for (std::size_t i = 0; i < q.size(); ++i) torque += cross(r[i], rotate(found, q[i]));
    EXPECT_LT(std::sqrt(dot(torque, torque)), 1e-12) << n;
  }
}

TEST_F(BestRotation, IsTheBestOfManyEvenForMirroredAndFlatPoints) {
  const auto fit = [](const Quatd& by, const std::vector<Vec3d>& r, const std::vector<Vec3d>& q) {
    double sum = 0;
    for (std::size_t i = 0; i < q.size(); ++i) sum += dot(r[i], rotate(by, q[i]));
    return sum;
  };
  for (int n = 0; n < 50; ++n) {
    const std::vector<Vec3d> q = points(7);
    std::vector<Vec3d> r = q;
    for (Vec3d& p : r) p = n % 2 == 0 ? Vec3d{-p.x, p.y, p.z} : Vec3d{p.x, 0, p.z};
    const Quatd found = best_rotation(product_sum(r, q));
    EXPECT_NEAR(dot(found, found), 1, 1e-14);
    for (int other = 0; other < 200; ++other) EXPECT_GE(fit(found, r, q) + 1e-12, fit(turn(), r, q));
  }
}

TEST_F(BestRotation, OfNothingIsTheIdentity) {
  const Quatd found = best_rotation({});
  EXPECT_EQ(found.w, 1);
  EXPECT_EQ(found.x, 0);
}

}  // namespace
}  // namespace pliant
