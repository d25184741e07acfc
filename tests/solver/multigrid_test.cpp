// Tests the multigrid correction: its matrices compared with dense ones in double, its solution with elimination.
#include "solver/multigrid_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// The matrix that the kernels apply on a level, computed column by column.
Matrix applied(Linearised& of, int l) {
  const MultigridLevel& level = of.level(l);
  const std::size_t n = 3 * static_cast<std::size_t>(level.rows);
  Matrix a(n, Vector(n, 0));
  Records x(static_cast<std::size_t>(level.batches()) * batch_width + 1), y = x;
  for (std::size_t j = 0; j < n; ++j) {
    (&x[j / 3].x)[j % 3] = 1;
    of.kernels->apply(level, of.values(l), l == 0, x.data(), y.data(), 0, level.batches());
    (&x[j / 3].x)[j % 3] = 0;
    for (std::size_t i = 0; i < n; ++i) a[i][j] = static_cast<double>((&y[i / 3].x)[i % 3]);
  }
  return a;
}

double largest_difference(const Matrix& a, const Matrix& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < a.size(); ++j) largest = std::max(largest, std::fabs(a[i][j] - b[i][j]));
  return largest;
}

double largest_of(const Matrix& a) {
  double largest = 0;
  for (const Vector& row : a) largest = std::max(largest, max_norm(row));
  return largest;
}

Vector flat(const Records& records, int rows) {
  Vector out;
  for (int i = 0; i < rows; ++i)
    for (int c = 0; c < 3; ++c) out.push_back(static_cast<double>((&records[std::size_t(i)].x)[c]));
  return out;
}

class Matrices : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Of, Matrices, testing::ValuesIn(available_isas()), [](const auto& isa) {
  return isa.param == "generic" ? isa.param : "v" + isa.param.substr(8);
});

TEST_P(Matrices, OfTheFinestLevelAreTheHessian) {
  Linearised of(crumpled(9, 7, 2), GetParam(), true);
  const LinearSystem expected = dense_system(of, true);
  const Matrix found = applied(of, 0);
  for (int i = 0; i < of.rows(0); ++i) {
    if (!of.moves(i)) continue;
    for (std::size_t r = 3 * std::size_t(i); r < 3 * std::size_t(i) + 3; ++r)
      for (std::size_t c = 0; c < found.size(); ++c)
        ASSERT_NEAR(found[r][c], expected.a[r][c], 2e-6 * largest_of(expected.a)) << r << " " << c;
  }
  const Vector right = flat(of.values(0).right, of.rows(0));
  for (std::size_t i = 0; i < right.size(); ++i)
    EXPECT_NEAR(right[i], of.moves(static_cast<int>(i / 3)) ? expected.b[i] : 0, 1e-4 * max_norm(expected.b)) << i;
}

/// P^T A P of the finer level, in which the coupling of two rows is halved, while what holds a row (inertia, contacts,
/// anchors) is not.
Matrix coarsened(Linearised& of, int l) {
  const MultigridLevel &fine = of.level(l - 1), &coarse = of.level(l);
  const Matrix a = applied(of, l - 1);
  const std::size_t n = 3 * static_cast<std::size_t>(coarse.rows);
  Matrix out(n, Vector(n, 0));
  const auto parent = [&](std::size_t i) {
    return fine.parent[static_cast<std::size_t>(lane_place(static_cast<int>(i / 3)))];
  };
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < a.size(); ++j) {
      const int from = parent(i), to = parent(j);
      if (from == coarse.nothing() || to == coarse.nothing()) continue;
      const std::size_t row = 3 * std::size_t(from) + i % 3, column = 3 * std::size_t(to) + j % 3;
      const std::size_t own = 3 * std::size_t(from) + j % 3;
      out[row][column] += a[i][j];
      if (from != to) {  // subtracts half of the coupling, from the diagonal block too
        out[row][column] -= 0.5 * a[i][j];
        out[row][own] += 0.5 * a[i][j];
      }
    }
  }
  return out;
}

TEST_P(Matrices, OfCoarserLevelsAreGalerkinsWithHalfTheCoupling) {
  Linearised of(crumpled(13, 11, 4), GetParam(), true);
  ASSERT_GE(of.levels(), 3);
  for (int l = 1; l < of.levels(); ++l) {
    const Matrix expected = coarsened(of, l);
    EXPECT_LT(largest_difference(applied(of, l), expected), 3e-6 * largest_of(expected)) << "level " << l;
  }
}

TEST_P(Matrices, ResidualAndJacobiAreThoseOfTheMatrix) {
  Linearised of(crumpled(13, 11, 4), GetParam(), true);
  std::mt19937 random(9);
  for (int l = 0; l < of.levels(); ++l) {
    const MultigridLevel& level = of.level(l);
    MultigridValues& values = of.values(l);
    Records x(values.x.size()), out = x, right = x;
    for (int i = 0; i < level.rows; ++i) {
      if (l == 0 && !of.moves(i)) continue;
      x[std::size_t(i)] = {uniform_16_bit(random, -1, 1), uniform_16_bit(random, -1, 1), uniform_16_bit(random, -1, 1),
                           0};
      right[std::size_t(i)] = {uniform_16_bit(random, -1e4f, 1e4f), uniform_16_bit(random, -1e4f, 1e4f),
                               uniform_16_bit(random, -1e4f, 1e4f), 0};
    }
    const Matrix a = applied(of, l);
    const Vector image = times(a, flat(x, level.rows)), b = flat(right, level.rows);
    of.kernels->residual(level, values, l == 0, right.data(), x.data(), out.data(), 0, level.batches());
    const Vector residual = flat(out, level.rows);
    for (std::size_t i = 0; i < b.size(); ++i) ASSERT_NEAR(residual[i], b[i] - image[i], 1e-5 * max_norm(image)) << l;
    of.kernels->smooth(level, values, l == 0, right.data(), x.data(), out.data(), 0, level.batches());
    const Vector smoothed = flat(out, level.rows), before = flat(x, level.rows);
    for (std::size_t i = 0; i < b.size(); i += 3) {
      if (l == 0 && !of.moves(static_cast<int>(i / 3))) continue;
      Matrix block(3, Vector(3));
      Vector rest(3);
      for (std::size_t r = 0; r < 3; ++r) {
        rest[r] = b[i + r] - image[i + r];
        for (std::size_t c = 0; c < 3; ++c) block[r][c] = a[i + r][i + c];
      }
      const Vector step = eliminate(block, rest);
      for (std::size_t r = 0; r < 3; ++r)
        ASSERT_NEAR(smoothed[i + r], before[i + r] + 0.65 * step[r], 1e-3 * (1 + max_norm(step))) << l << ", " << i;
    }
    const float product = of.kernels->apply(level, values, l == 0, x.data(), out.data(), 0, level.batches());
    double expected = 0;
    for (std::size_t i = 0; i < image.size(); ++i) expected += before[i] * image[i];
    EXPECT_NEAR(double(product), expected, 1e-5 * std::fabs(expected)) << l;
  }
}

TEST_P(Matrices, RestrictionSumsAndProlongationCopies) {
  Linearised of(crumpled(9, 7, 2), GetParam());
  std::mt19937 random(3);
  const MultigridLevel &fine = of.level(0), &coarse = of.level(1);
  Records residual(of.values(0).x.size()), up(residual.size());
  Vector sums(3 * static_cast<std::size_t>(coarse.rows), 0);
  for (int i = 0; i < fine.rows; ++i) {
    residual[std::size_t(i)] = {uniform_16_bit(random, -1, 1), uniform_16_bit(random, -1, 1),
                                uniform_16_bit(random, -1, 1), 0};
    const int parent = fine.parent[std::size_t(lane_place(i))];
    if (parent == coarse.nothing()) continue;
    for (std::size_t c = 0; c < 3; ++c) sums[3 * std::size_t(parent) + c] += double((&residual[std::size_t(i)].x)[c]);
  }
  of.kernels->restrict_to(coarse, of.values(1), residual.data(), 0, coarse.batches());
  const Vector right = flat(of.values(1).right, coarse.rows);
  for (std::size_t i = 0; i < right.size(); ++i) EXPECT_NEAR(right[i], sums[i], 1e-5);
  of.kernels->prolong(fine, of.values(1).right.data(), up.data(), 0, fine.batches());
  for (int i = 0; i < fine.rows; ++i) {
    const int parent = fine.parent[std::size_t(lane_place(i))];
    for (std::size_t c = 0; c < 3; ++c) {
      const float expected = parent == coarse.nothing() ? 0 : (&of.values(1).right[std::size_t(parent)].x)[c];
      EXPECT_EQ((&up[std::size_t(i)].x)[c], expected);
    }
  }
}

// ---------------------------------------------------------------- the solve

Vector exact_change(const Object& object, const Records& predicted) {
  Linearised of(object);
  of.displacements = predicted;
  LinearSystem system = dense_system(of);
  hold(of, system);
  return eliminate(system.a, system.b);
}

TEST(MultigridCorrection, OfManyCyclesIsEliminations) {
  for (const Object& object : {crumpled(9, 7, 2), crumpled(13, 11, 6)}) {
    const Corrected found(object, 100);
    EXPECT_LT(error_of(found.change(), exact_change(object, found.predicted)), 2e-4);
  }
}

TEST(MultigridCorrection, ComesNearerWithEveryFewCycles) {
  const Object object = crumpled(17, 17, 3);
  double before = 1;
  for (int cycles : {2, 6, 12}) {
    const Corrected found(object, cycles);
    const double error = error_of(found.change(), exact_change(object, found.predicted));
    EXPECT_LT(error, 0.6 * before) << cycles;
    before = error;
  }
  EXPECT_LT(before, 2e-3) << "conjugate directions; steepest descent stands at 0.013";
}

/// If a correction exceeds the range of floats it must be rejected, so that the sweeps start from the prediction.
TEST(MultigridCorrection, ThatIsNotFiniteIsNotMade) {
  Object sheet = crumpled(9, 9, 2);
  const Corrected sound({sheet}, 3);
  EXPECT_GT(max_norm(sound.change()), 1e-4) << "or this shows nothing";
  std::mt19937 random(7);
  for (std::size_t i = 0; i < sheet.positions.size(); ++i)
    sheet.velocities.push_back(Vec3f{uniform_16_bit(random, -1e20f, 1e20f), uniform_16_bit(random, -1e20f, 1e20f), 0});
  const Corrected found({sheet}, 3);
  for (const Record& d : found.predicted) ASSERT_TRUE(std::isfinite(d.x) && std::isfinite(d.y) && std::isfinite(d.z));
  for (const double moved : found.change()) ASSERT_EQ(moved, 0);
  for (const auto& pool : found.workspace.multipliers.at(0))
    for (const float lambda : pool)
      ASSERT_EQ(lambda, 0) << "or sweeps take soft springs for met, which then hold nothing";
}

}  // namespace
}  // namespace pliant
