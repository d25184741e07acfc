// Tests chains and tethers: the exact solution compared with elimination in double, all kernels with the sequential
// reference.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "solver/chains_support.h"
#include "solver/records_support.h"
#include "support/bits.h"
#include "support/kernels.h"

namespace pliant {
namespace {

using namespace testing_support;
using testing_support::expect_same;

// ---------------------------------------------------------------- the exact solution

/// Solves (J W J^T + s) dlambda = -C - alpha~ lambda by elimination with pivoting, in double precision.
std::vector<double> solve_in_double(std::vector<std::vector<double>> matrix, std::vector<double> right) {
  const std::size_t n = right.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k; i < n; ++i)
      if (std::fabs(matrix[i][k]) > std::fabs(matrix[pivot][k])) pivot = i;
    std::swap(matrix[k], matrix[pivot]);
    std::swap(right[k], right[pivot]);
    for (std::size_t i = k + 1; i < n; ++i) {
      const double share = matrix[i][k] / matrix[k][k];
      for (std::size_t j = k; j < n; ++j) matrix[i][j] -= share * matrix[k][j];
      right[i] -= share * right[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) right[k] -= matrix[k][j] * right[j];
    right[k] /= matrix[k][k];
  }
  return right;
}

TEST(Chains, give_the_solution_of_the_dense_system) {
  std::mt19937 random(11);
  for (const float softness : {0.f, 0.1f, 10.f}) {
    for (const float compliance : {0.f, 1e-6f}) {
      const int links = 1 + static_cast<int>(random() % 40);
      Object from = line(links, compliance, random);
      from.pins.push_back({0, {}});
      ChainedSubstep substep(from, chained(softness));
      std::vector<Vec3d> x;
      for (int i = 0; i <= links; ++i) {
        Record& d = substep.displacements[substep.object.place[i]];
        d = {static_cast<float>(uniform(random, -0.01, 0.01)), static_cast<float>(uniform(random, -0.01, 0.01)), 0, 0};
        const Record& p = substep.positions[substep.object.place[i]];
        x.push_back({double(p.x) + d.x, double(p.y) + d.y, double(p.z) + d.z});
      }
      const auto w = [&](int i) { return double(substep.positions[substep.object.place[i]].w); };
      std::vector<Vec3d> n;
      std::vector<double> right;
      for (int k = 0; k < links; ++k) {
        const Vec3d e = x[k + 1] - x[k];
        const double length = std::sqrt(length_squared(e));
        const Vec3f rest = from.positions[k + 1] - from.positions[k];
        n.push_back(e * (1 / length));
        right.push_back(std::sqrt(double(dot(rest, rest))) - length);
      }
      std::vector<std::vector<double>> matrix(links, std::vector<double>(links, 0.0));
      double mass = 0;
      for (int i = 1; i <= links; ++i) mass += 1 / w(i);
      for (int k = 0; k < links; ++k) {
        matrix[k][k] = w(k) + w(k + 1) + double(softness) / mass + double(compliance) / (double(substep.h) * substep.h);
        if (k > 0) matrix[k][k - 1] = matrix[k - 1][k] = -w(k) * dot(n[k - 1], n[k]);
      }
      const std::vector<double> change = solve_in_double(matrix, right);
      substep.solve(chain_kernels_sequential(), true, true);
      for (int i = 0; i <= links; ++i) {
        Vec3d expected = x[i];
        if (i > 0) expected += n[i - 1] * (w(i) * change[i - 1]);
        if (i < links) expected -= n[i] * (w(i) * change[i]);
        const Record &p = substep.positions[substep.object.place[i]],
                     &d = substep.displacements[substep.object.place[i]];
        EXPECT_NEAR(double(p.x) + d.x, expected.x, 1e-5);
        EXPECT_NEAR(double(p.y) + d.y, expected.y, 1e-5);
        EXPECT_NEAR(double(p.z) + d.z, expected.z, 1e-5);
      }
    }
  }
}

TEST(Chains, keep_momentum) {
  std::mt19937 random(2);
  ChainedSubstep substep(line(60, 0, random), chained(0.1f));
  for (Record& d : substep.displacements) d = {static_cast<float>(uniform(random, -0.01, 0.01)), 0.02f, 0, 0};
  const auto momentum = [&] {
    Vec3d sum{};
    for (std::size_t i = 0; i < substep.positions.size(); ++i) {
      const Record& d = substep.displacements[i];
      sum += Vec3d{d.x, d.y, d.z} * (1 / double(substep.positions[i].w));
    }
    return sum;
  };
  const Vec3d before = momentum();
  substep.solve(chain_kernels_sequential(), true, false);
  const Vec3d after = momentum();
  EXPECT_NEAR(after.x, before.x, 2e-6);
  EXPECT_NEAR(after.y, before.y, 2e-6);
  EXPECT_NEAR(after.z, before.z, 2e-6);
}

// ---------------------------------------------------------------- lanes

void disturb(ChainedSubstep& substep, std::mt19937& random, bool nasty) {
  const auto number = [&] { return nasty ? nasty_float(random) : static_cast<float>(uniform(random, -0.02, 0.02)); };
  for (Record& d : substep.displacements) d = {number(), number(), number(), 0};
  for (float& m : substep.multipliers) m = 1e-3f * number();
  for (std::size_t i = 0; i < substep.positions.size(); ++i)
    if (random() % 7 == 0 &&
        std::count(substep.object.tethers.anchors.begin(), substep.object.tethers.anchors.end(), i) == 0)
      substep.positions[i].w = random() % 2 == 0 ? 0.f : 1e5f;
}

TEST(Chains, and_tethers_give_the_bits_of_the_reference_in_lanes) {
  std::mt19937 random(4);
  for (int round = 0; round < 24; ++round) {
    const bool nasty = round % 3 == 2;
    const int columns = 3 + static_cast<int>(random() % 30), rows = 3 + static_cast<int>(random() % 20);
    Object from = grid(columns, rows, round % 2 == 0 ? 0.f : 1e-6f);
    for (int pin = 0; pin < round % 7; ++pin)
      from.pins.push_back({static_cast<int>(random() % from.positions.size()), {}});
    ChainedSubstep start(from, chained(0.1f, true));
    disturb(start, random, nasty);
    ChainedSubstep reference = start;
    for (bool first : {true, false}) {
      reference.solve(chain_kernels_sequential(), first, true);
      reference.hold(chain_kernels_sequential());
    }
    for (const std::string& isa : available_isas()) {
      ChainedSubstep substep = start;
      for (bool first : {true, false}) {
        substep.solve(pick_kernels(isa).chains, first, true);
        substep.hold(pick_kernels(isa).chains);
      }
      ASSERT_NO_FATAL_FAILURE(expect_same(substep.displacements, reference.displacements, isa));
      for (std::size_t i = 0; i < substep.multipliers.size(); ++i)
        ASSERT_TRUE(substep.object.pools[0].origin[i] < 0 ||
                    same_bits(substep.multipliers[i], reference.multipliers[i]))
            << isa;
    }
  }
}

}  // namespace
}  // namespace pliant
