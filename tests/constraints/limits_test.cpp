// Tests every constraint type in float where formulas break: coincident points, flat and folded hinges, triangles
// without area, scales from a micrometre to a thousand kilometres. All must stay finite, and a stencil at rest must not
// be set in motion.
#include <gtest/gtest.h>

#include <vector>

#include "solver/project.h"
#include "support/constraint_support.h"

namespace pliant {
namespace {

using namespace testing_support;

/// Four points, of which a type uses as many as it needs. Slots beyond them repeat the first, as padded slots do.
struct Case {
  const char* name;
  std::array<Vec3d, 4> x;
};

const std::vector<Case>& degenerate_cases() {
  static const std::vector<Case> cases{
      {"all in one place", {{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}}},
      {"all in one place, away from the origin", {{{3, -2, 7}, {3, -2, 7}, {3, -2, 7}, {3, -2, 7}}}},
      {"first two coincide", {{{0, 0, 0}, {0, 0, 0}, {0, 1, 0}, {0, -1, 0}}}},
      {"last two coincide: folded shut", {{{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, 1, 0}}}},
      {"first and third coincide", {{{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, {0.5, -1, 0}}}},
      {"second and fourth coincide", {{{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {1, 0, 0}}}},
      {"in line", {{{0, 0, 0}, {1, 0, 0}, {0.25, 0, 0}, {0.75, 0, 0}}}},
      {"in line, tips outside", {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {-1, 0, 0}}}},
      {"flat", {{{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, -1, 0}}}},
      {"nearly flat", {{{0, 0, 0}, {1, 0, 0}, {0.5, 1, 1e-7}, {0.5, -1, 0}}}},
      {"nearly flat, the other way", {{{0, 0, 0}, {1, 0, 0}, {0.5, 1, -1e-7}, {0.5, -1, 0}}}},
      {"folded to pi, from above", {{{0, 0, 0}, {1, 0, 0}, {0.5, 1, 1e-7}, {0.4, 1, 0}}}},
      {"folded to pi, from below", {{{0, 0, 0}, {1, 0, 0}, {0.5, 1, -1e-7}, {0.4, 1, 0}}}},
      {"at a right angle", {{{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, 0, 1}}}},
      {"one face a sliver", {{{0, 0, 0}, {1, 0, 0}, {0.5, 1e-6, 0}, {0.5, -1, 0}}}},
      {"both faces slivers", {{{0, 0, 0}, {1, 0, 0}, {0.5, 1e-6, 0}, {0.5, 0, 1e-6}}}},
      {"an edge of a millionth", {{{0, 0, 0}, {1e-6, 0, 0}, {0.5, 1, 0}, {0.5, -1, 0.2}}}},
  };
  return cases;
}

const double scales[] = {1e-6, 1e-3, 1, 1e3, 1e6};

template <class T>
Stencil<T, float> scaled(const Case& from, double scale) {
  Stencil<T, float> x;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = convert<float>(from.x[i < from.x.size() ? i : 0] * scale);
  return x;
}

bool is_finite(const Vec3f& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

template <class T>
class Limits : public testing::Test {};
TYPED_TEST_SUITE(Limits, ConstraintTypes, NameOfType);

/// The stencil after `times` projections of one substep.
template <class T, Law law>
Stencil<T, float> projected(const Stencil<T, float>& at, const ParamsOf<T, float>& params,
                            ConstraintResponse<float> response, int times) {
  SweepArguments arguments;
  arguments.h = 1.f / 600;
  arguments.inverse_h = 1 / arguments.h;
  arguments.inverse_h2 = arguments.inverse_h * arguments.inverse_h;
  Vec3f x[size_of<T>], motion[size_of<T>], correction[size_of<T>];
  float w[size_of<T>];
  for (std::size_t i = 0; i < size_of<T>; ++i) {
    x[i] = at[i];
    w[i] = i % 2 == 0 ? 1.f : 50.f;
    motion[i] = Vec3f{at[i].y, -at[i].x, at[i].z} * 0.1f;
  }
  for (int time = 0; time < times; ++time) {
    arguments.first_pass = time == 0;
    project<T, law, true, false, float>(x, w, params, motion, response, arguments, correction);
    for (std::size_t i = 0; i < size_of<T>; ++i) x[i] += correction[i];
  }
  Stencil<T, float> out;
  for (std::size_t i = 0; i < size_of<T>; ++i) out[i] = x[i];
  EXPECT_TRUE(std::isfinite(response.multiplier));
  return out;
}

template <class T>
ParamsOf<T, float> measured(const Stencil<T, float>& at) {
  Stencil<T, double> x;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = convert<double>(at[i]);
  return convert_params<T, float, double>(measure<T, double>(x));  // as compile() does
}

TYPED_TEST(Limits, EverythingStaysFinite) {
  for (const Case& shape : degenerate_cases()) {
    for (const Case& rest : degenerate_cases()) {
      for (double scale : scales) {
        const auto x = scaled<TypeParam>(shape, scale);
        const auto params = measured<TypeParam>(scaled<TypeParam>(rest, scale));
        const auto value = evaluate<TypeParam, float>(x, params);
        ASSERT_TRUE(std::isfinite(value.c)) << shape.name << " from " << rest.name << " at " << scale;
        for (const Vec3f& g : value.gradient)
          ASSERT_TRUE(is_finite(g)) << shape.name << " from " << rest.name << " at " << scale;
        for (float alpha : {0.f, 1e-6f, 1.f, 1e20f}) {
          for (const Vec3f& p : projected<TypeParam, Law::compliant>(x, params, {alpha, 0, 0}, 20)) {
            ASSERT_TRUE(is_finite(p)) << shape.name << " from " << rest.name << " at " << scale << ", alpha " << alpha;
          }
          for (const Vec3f& p : projected<TypeParam, Law::damped>(x, params, {alpha, 10, 0}, 20)) {
            ASSERT_TRUE(is_finite(p)) << shape.name << " from " << rest.name << " at " << scale << ", damped, alpha "
                                      << alpha;
          }
        }
        for (const Vec3f& p : projected<TypeParam, Law::pbd>(x, params, {1, 0, 0}, 20)) {
          ASSERT_TRUE(is_finite(p)) << shape.name << " from " << rest.name << " at " << scale << ", PBD";
        }
      }
    }
  }
}

TYPED_TEST(Limits, NothingMovesFromRest) {
  for (const Case& shape : degenerate_cases()) {
    for (double scale : scales) {
      const auto x = scaled<TypeParam>(shape, scale);
      if (std::is_same_v<TypeParam, IsometricBending> && std::string(shape.name).find("flat") == std::string::npos)
        continue;
      if (shape.x[1].x == 1e-6 && scale < 1e-3) continue;  // edges below a nanometre: products of six numbers underflow
      const auto after = projected<TypeParam, Law::compliant>(x, measured<TypeParam>(x), {0, 0, 0}, 50);
      for (std::size_t i = 0; i < x.size(); ++i) {
        EXPECT_LT(length(after[i] - x[i]), 2e-5 * scale) << shape.name << " at " << scale << ", slot " << i;
      }
    }
  }
}

TYPED_TEST(Limits, NothingMovesWithoutFreeMass) {
  SweepArguments arguments;
  arguments.h = 0.01f;
  arguments.inverse_h = 100;
  arguments.inverse_h2 = 10000;
  Random random(3);
  const auto at = random_stencil<TypeParam>(random);
  Vec3f x[size_of<TypeParam>], motion[size_of<TypeParam>], correction[size_of<TypeParam>];
  float w[size_of<TypeParam>];
  for (std::size_t i = 0; i < size_of<TypeParam>; ++i) {
    x[i] = convert<float>(at[i]);
    w[i] = 0;
  }
  ConstraintResponse<float> response{0, 0, 0};
  const auto params = convert_params<TypeParam, float, double>(random_params<TypeParam>(random));
  for (int time = 0; time < 1000; ++time) {
    project<TypeParam, Law::compliant, true, false, float>(x, w, params, motion, response, arguments, correction);
    for (const Vec3f& moved : correction) EXPECT_EQ(moved, Vec3f{});
  }
  EXPECT_TRUE(std::isfinite(response.multiplier));
}

// ------------------------------------------------------------------------------------------------ by type

TEST(Distance, EndsInOnePlaceHaveNoDirection) {
  const auto value = evaluate<Distance, float>({Vec3f{1, 2, 3}, Vec3f{1, 2, 3}}, {0.5f});
  EXPECT_EQ(value.c, -0.5f);
  EXPECT_EQ(value.gradient[0], (Vec3f{0, 0, 0}));
  EXPECT_EQ(value.gradient[1], (Vec3f{0, 0, 0}));
}

Stencil<DihedralBending, double> hinge(double angle) {
  // In the flat hinge the tips are at +-y; the second one is rotated about the edge, the x-axis.
  return {Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0.3, 1, 0}, Vec3d{0.6, -std::cos(angle), -std::sin(angle)}};
}

TEST(DihedralBending, MeasuresTheAngleWithItsSign) {
  for (int degrees = -179; degrees <= 179; ++degrees) {
    const double angle = degrees * 3.14159265358979323846 / 180;
    const double there = (measure<DihedralBending, double>(hinge(angle)).rest_angle);
    const double back = (measure<DihedralBending, double>(hinge(-angle)).rest_angle);
    EXPECT_NEAR(std::fabs(there), std::fabs(angle), 1e-12) << degrees;
    EXPECT_NEAR(there, -back, 1e-12) << degrees;
  }
}

TEST(DihedralBending, GoesTheShorterWayRound) {
  const double nearly = 3.1, beyond = -3.1;
  const double rest = measure<DihedralBending, double>(hinge(nearly)).rest_angle;
  const double c = evaluate<DihedralBending, double>(hinge(beyond), {rest}).c;
  EXPECT_NEAR(std::fabs(c), 2 * 3.14159265358979 - 6.2, 1e-6);
}

TEST(DihedralBending, HoldsAFoldThroughTheFlatHinge) {
  // After it was pressed past flat, it must return to the side on which it was, which an acos cannot know.
  const double rest = measure<DihedralBending, double>(hinge(0.6)).rest_angle;
  const auto value = evaluate<DihedralBending, double>(hinge(-0.2), {rest});
  EXPECT_NEAR(std::fabs(value.c), 0.8, 1e-12);
  auto x = hinge(-0.2);
  const Vec3d push = value.gradient[3] * (-value.c * 0.01);
  x[3] += push;
  EXPECT_LT(std::fabs(evaluate<DihedralBending, double>(x, {rest}).c), std::fabs(value.c));
}

TEST(IsometricBending, IsTheEnergyOfBergouOnEqualTriangles) {
  // Two equilateral triangles of side 1 at a small angle t; their areas sum to h = sqrt(3)/2. A tip has weight
  // 2/sqrt(3) times sqrt(3/h) and is h t out of the plane. So C^2 = 3 t^2 / h, which is the paper's 3 |e|^2 t^2 / (A1 +
  // A2).
  const double t = 1e-4, height = std::sqrt(3.0) / 2;
  const Stencil<IsometricBending, double> flat{Vec3d{0, 0, 0}, Vec3d{1, 0, 0}, Vec3d{0.5, height, 0},
                                               Vec3d{0.5, -height, 0}};
  auto bent = flat;
  bent[3] = {0.5, -height * std::cos(t), height * std::sin(t)};
  const double c = evaluate<IsometricBending, double>(bent, measure<IsometricBending, double>(flat)).c;
  EXPECT_NEAR(c, t * std::sqrt(3 / height), 1e-7 * t);
}

TEST(PlaneContact, IsTheDistanceAboveThePlane) {
  const auto value = evaluate<PlaneContact, double>({Vec3d{1, 3, 2}}, {{0, 1, 0}, 2.5});
  EXPECT_EQ(value.c, 0.5);
  EXPECT_EQ(value.gradient[0].y, 1);
  EXPECT_TRUE(PlaneContact::unilateral);
}

}  // namespace
}  // namespace pliant
