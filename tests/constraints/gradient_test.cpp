// Tests the mathematics of every constraint type, in double: gradients, invariance, zero net force and torque,
// momentum.
#include <gtest/gtest.h>

#include <algorithm>

#include "solver/project.h"
#include "support/constraint_support.h"

namespace pliant {
namespace {

using namespace testing_support;

constexpr int samples = 300;

template <class T>
class Formula : public testing::Test {
 protected:
  Random random_{20261120};
};
TYPED_TEST_SUITE(Formula, ConstraintAndContactTypes, NameOfType);

template <class T>
class Internal : public testing::Test {
 protected:
  Random random_{7};
};
TYPED_TEST_SUITE(Internal, ConstraintTypes, NameOfType);

double& component(Vec3d& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

/// The central difference of sixth order. Its error is h^6 / 140 times the seventh derivative.
template <class T>
double difference(Stencil<T, double> x, const ParamsOf<T, double>& params, std::size_t slot, int axis) {
  const double h = 3e-3, here = component(x[slot], axis);
  const auto at = [&](double offset) {
    component(x[slot], axis) = here + offset;
    return evaluate<T, double>(x, params).c;
  };
  return (45 * (at(h) - at(-h)) - 9 * (at(2 * h) - at(-2 * h)) + (at(3 * h) - at(-3 * h))) / (60 * h);
}

/// True if C wraps around, as angles do, among the points of the difference: it changes by more than a gradient of at
/// most `scale` says.
template <class T>
bool has_jump(const Stencil<T, double>& at, const ParamsOf<T, double>& params, std::size_t slot, double scale) {
  bool jumps = false;
  for (int axis = 0; axis < 3; ++axis) {
    auto low = at, high = at;
    component(low[slot], axis) -= 9e-3;
    component(high[slot], axis) += 9e-3;
    jumps = jumps || std::fabs(evaluate<T, double>(low, params).c - evaluate<T, double>(high, params).c) >
                         max(1.0, 0.03 * scale);
  }
  return jumps;
}

/// True for an inverted co-rotational tetrahedron, whose nearest rotation may change at once.
template <class T>
bool is_at_a_kink(const Stencil<T, double>& x, const ParamsOf<T, double>& p) {
  if constexpr (std::is_same_v<T, CorotationalStrain>) {
    const Vec3d a = x[1] - x[0], b = x[2] - x[0], c = x[3] - x[0];
    const Vec3d f[3] = {a * p.d00 + b * p.d10 + c * p.d20, a * p.d01 + b * p.d11 + c * p.d21,
                        a * p.d02 + b * p.d12 + c * p.d22};
    return dot(cross(f[0], f[1]), f[2]) < 0;
  }
  return false;
}

template <std::size_t n>
double largest_of(const std::array<Vec3d, n>& vectors) {
  double most = 0;
  for (const Vec3d& v : vectors) most = max(most, length(v));
  return most;
}

TYPED_TEST(Formula, GradientIsTheDerivative) {
  int jumps = 0;
  for (int sample = 0; sample < samples; ++sample) {
    const auto x = random_stencil<TypeParam>(this->random_);
    const auto params = random_params<TypeParam>(this->random_);
    const auto value = evaluate<TypeParam, double>(x, params);
    const double scale = largest_of(value.gradient);
    if (is_at_a_kink<TypeParam>(x, params)) continue;
    for (std::size_t slot = 0; slot < x.size(); ++slot) {
      const Vec3d numeric{difference<TypeParam>(x, params, slot, 0), difference<TypeParam>(x, params, slot, 1),
                          difference<TypeParam>(x, params, slot, 2)};
      if (has_jump<TypeParam>(x, params, slot, scale)) {
        ++jumps;
        continue;
      }
      EXPECT_LT(length(numeric - value.gradient[slot]), 1e-9 * scale) << "sample " << sample << ", slot " << slot;
    }
  }
  EXPECT_LT(jumps, samples / 50);
}

/// The plane of a contact belongs to the world, not to the stencil, so these tests are for the other types.
TYPED_TEST(Internal, RigidMotionChangesNothing) {
  for (int sample = 0; sample < samples; ++sample) {
    const auto x = random_stencil<TypeParam>(this->random_);
    const auto params = random_params<TypeParam>(this->random_);
    const Quatd rotation = random_rotation(this->random_);
    const Vec3d shift = random_point(this->random_, 10);
    auto moved = x;
    for (Vec3d& p : moved) p = rotate(rotation, p) + shift;
    const auto before = evaluate<TypeParam, double>(x, params), after = evaluate<TypeParam, double>(moved, params);
    const double scale = largest_of(before.gradient);
    EXPECT_NEAR(before.c, after.c, 1e-12 * (1 + std::fabs(before.c)));
    for (std::size_t i = 0; i < x.size(); ++i) {
      EXPECT_LT(length(rotate(rotation, before.gradient[i]) - after.gradient[i]), 1e-12 * scale) << "sample " << sample;
    }
  }
}

TYPED_TEST(Internal, NoNetForceAndNoNetTorque) {
  for (int sample = 0; sample < samples; ++sample) {
    const auto x = random_stencil<TypeParam>(this->random_);
    const auto value = evaluate<TypeParam, double>(x, random_params<TypeParam>(this->random_));
    const double scale = largest_of(value.gradient);
    ASSERT_GT(scale, 0);
    Vec3d force{}, torque{};
    for (std::size_t i = 0; i < x.size(); ++i) {
      force += value.gradient[i];
      torque += cross(x[i], value.gradient[i]);
    }
    EXPECT_LT(length(force), 1e-14 * scale);
    EXPECT_LT(length(torque), 1e-13 * scale);
  }
}

/// Projects once in double. Returns C before the projection.
template <class T, Law law, bool keeps>
double project_once(Stencil<T, double>& at, const std::array<double, size_of<T>>& inverse_mass,
                    const ParamsOf<T, double>& params, const Stencil<T, double>& moved,
                    ConstraintResponse<double>& response) {
  SweepArguments arguments;
  arguments.h = 0.0078125f;  // powers of two, which are exact in float
  arguments.inverse_h = 128;
  arguments.inverse_h2 = 16384;
  Vec3<double> x[size_of<T>], motion[size_of<T>], correction[size_of<T>];
  double w[size_of<T>];
  for (std::size_t i = 0; i < size_of<T>; ++i) {
    x[i] = at[i];
    w[i] = inverse_mass[i];
    motion[i] = moved[i];
  }
  const double c = evaluate<T, double>(at, params).c;
  project<T, law, keeps, false, double>(x, w, params, motion, response, arguments, correction);
  for (std::size_t i = 0; i < size_of<T>; ++i) at[i] = x[i] + correction[i];
  return c;
}

template <class T, Law law>
void expect_momentum_kept(Random& random) {
  for (int sample = 0; sample < samples; ++sample) {
    const auto before = random_stencil<T>(random);
    auto after = before;
    std::array<double, size_of<T>> w;
    Stencil<T, double> motion;
    for (std::size_t i = 0; i < w.size(); ++i) {
      w[i] = uniform(random, 0.01, 100);
      motion[i] = random_point(random, 0.1);
    }
    ConstraintResponse<double> response{law == Law::pbd ? 0.7 : uniform(random, 0, 1e-4), uniform(random, 0, 1), 0};
    project_once<T, law, true>(after, w, random_params<T>(random), motion, response);
    Vec3d momentum{}, angular{};
    double moved = 0;
    for (std::size_t i = 0; i < w.size(); ++i) {
      const Vec3d change = (after[i] - before[i]) * (1 / w[i]);
      momentum += change;
      angular += cross(before[i], change);
      // The rounding of x + dx is not the constraint's error: an ulp of the position, weighted by the mass.
      moved += length(change) + 1e-3 / w[i];
    }
    ASSERT_GT(moved, 0);
    EXPECT_LT(length(momentum), 1e-13 * moved) << "sample " << sample;
    EXPECT_LT(length(angular), 1e-13 * 2 * moved) << "sample " << sample;
  }
}

TYPED_TEST(Internal, ProjectionKeepsMomentum) {
  expect_momentum_kept<TypeParam, Law::compliant>(this->random_);
  expect_momentum_kept<TypeParam, Law::damped>(this->random_);
  expect_momentum_kept<TypeParam, Law::pbd>(this->random_);
}

/// The response of compliance: after one projection alpha~ lambda balances the error of the linearised constraint, and
/// further projections of an unmoved stencil change nothing (Macklin 2016, eq. 18).
TYPED_TEST(Internal, MultiplierBalancesTheErrorWhateverTheIterations) {
  for (int sample = 0; sample < 20; ++sample) {
    const auto start = random_stencil<TypeParam>(this->random_);
    auto params = measure<TypeParam, double>(start);
    auto x = start;
    for (Vec3d& p : x) p += random_point(this->random_, 1e-4);
    std::array<double, size_of<TypeParam>> w;
    w.fill(1);
    ConstraintResponse<double> response{1e-5, 0, 0};
    const int times = is_norm<TypeParam> ? 1000 : 40;
    for (int i = 0; i < times; ++i) project_once<TypeParam, Law::compliant, true>(x, w, params, {}, response);
    const double c = evaluate<TypeParam, double>(x, params).c;
    EXPECT_NEAR(c + 1e-5 * 16384 * response.multiplier, 0, 1e-9 * (1e-4 + std::fabs(c))) << "sample " << sample;
  }
}

TYPED_TEST(Internal, PbdRemovesItsShareOfASmallError) {
  for (int sample = 0; sample < samples; ++sample) {
    auto x = flat_stencil<TypeParam>(this->random_);
    const auto params = measure<TypeParam, double>(x);
    for (Vec3d& p : x) p += random_point(this->random_, 1e-4);
    std::array<double, size_of<TypeParam>> w;
    w.fill(1);
    ConstraintResponse<double> response{0.25, 0, 0};
    const double before = project_once<TypeParam, Law::pbd, false>(x, w, params, {}, response);
    const double after = evaluate<TypeParam, double>(x, params).c;
    if (is_norm<TypeParam>) {  // which is at least what a plane at its level set would leave
      EXPECT_GT(after, 0.749 * before);
      EXPECT_LT(after, before);
    } else {
      EXPECT_NEAR(after, 0.75 * before, 2e-3 * std::fabs(before) + 1e-8);
    }
  }
}

TYPED_TEST(Internal, GradientsSaidToBeUnitAre) {
  for (int sample = 0; sample < samples; ++sample) {
    const auto x = random_stencil<TypeParam>(this->random_);
    for (const Vec3d& gradient : evaluate<TypeParam, double>(x, random_params<TypeParam>(this->random_)).gradient) {
      EXPECT_TRUE(!has_unit_gradients<TypeParam> || std::fabs(length(gradient) - 1) < 1e-14) << length(gradient);
    }
  }
}

TYPED_TEST(Internal, WhatIsMeasuredIsMet) {
  for (int sample = 0; sample < samples; ++sample) {
    const auto flat = flat_stencil<TypeParam>(this->random_);
    EXPECT_NEAR((evaluate<TypeParam, double>(flat, measure<TypeParam, double>(flat)).c), 0, 1e-13);
    if constexpr (std::is_same_v<TypeParam, IsometricBending>) continue;  // has flat rest shapes only, by definition
    const auto x = random_stencil<TypeParam>(this->random_);
    EXPECT_NEAR((evaluate<TypeParam, double>(x, measure<TypeParam, double>(x)).c), 0, 1e-13);
  }
}

TYPED_TEST(Internal, CanonicalOrderIsTheSameConstraint) {
  int exchanged = 0;
  for (int sample = 0; sample < samples; ++sample) {
    const auto x = random_stencil<TypeParam>(this->random_);  // x[i] is the position of particle i
    std::array<int, size_of<TypeParam>> ids, ordered;
    for (std::size_t i = 0; i < ids.size(); ++i) ids[i] = static_cast<int>(i);
    std::shuffle(ids.begin(), ids.end(), this->random_);
    auto params = convert_params<TypeParam, float, double>(random_params<TypeParam>(this->random_));
    const auto arranged = [&](const auto& order) {
      Stencil<TypeParam, double> y;
      for (std::size_t i = 0; i < y.size(); ++i) y[i] = x[static_cast<std::size_t>(order[i])];
      return y;
    };
    const auto before = evaluate<TypeParam, double>(arranged(ids), convert_params<TypeParam, double, float>(params));
    ordered = ids;
    canonical_order<TypeParam>(ordered, params);
    const auto after = evaluate<TypeParam, double>(arranged(ordered), convert_params<TypeParam, double, float>(params));
    exchanged += ordered != ids;
    EXPECT_NEAR(std::fabs(before.c), std::fabs(after.c), 1e-12);
    std::array<Vec3d, size_of<TypeParam>> force_before, force_after;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      force_before[static_cast<std::size_t>(ids[i])] = before.gradient[i] * -before.c;
      force_after[static_cast<std::size_t>(ordered[i])] = after.gradient[i] * -after.c;
    }
    for (std::size_t i = 0; i < ids.size(); ++i) {
      EXPECT_LT(length(force_before[i] - force_after[i]), 1e-11 * (1 + largest_of(force_before))) << "particle " << i;
    }
    auto again = ordered;
    auto params_again = params;
    canonical_order<TypeParam>(again, params_again);
    EXPECT_EQ(again, ordered) << "canonical must be settled by one call";
  }
  constexpr bool is_symmetric = std::is_same_v<TypeParam, Distance> || std::is_same_v<TypeParam, DihedralBending>;
  EXPECT_GT(exchanged, is_symmetric ? samples / 4 : -1);
}

// ------------------------------------------------------------------------------------------------ damping of a strain

template <class T>
class DampedStrain : public testing::Test {
 protected:
  /// Stretches a tetrahedron along x by `strain`, moves it by F' = 0.01 e_x e_axis, and projects it once.
  void project_after(double strain, double Vec3d::*axis) {
    const Vec3d rest[4] = {{0, 0, 0}, {1, 0.1, 0}, {0.2, 1.1, 0}, {0.1, 0.3, 0.9}};
    params_ = T::template measure<double>(rest);
    for (int i = 0; i < 4; ++i) {
      x_[i] = {(1 + strain) * rest[i].x, rest[i].y, rest[i].z};
      motion_[i] = {0.01 * (rest[i].*axis), 0, 0};
    }
    SweepArguments arguments;
    arguments.h = 1.f / 64;
    arguments.inverse_h = 64;
    arguments.inverse_h2 = 64 * 64;
    arguments.first_pass = true;
    project<T, Law::damped, true, false, double>(x_, w_, params_, motion_, response_, arguments, correction_);
  }

  double mass_along(const Vec3d (&gradient)[4]) const { return generalised_inverse_mass<T, double>(gradient, w_); }

  double w_[4] = {1, 2, 0.5, 1};
  ParamsOf<T, double> params_;
  Vec3d x_[4], motion_[4], correction_[4];
  ConstraintResponse<double> response_{1e-3, 20, 0};
  const double compliance_ = 1e-3 * 64 * 64, gamma_ = 1e-3 * 20 * 64 - 1;  // less implicit Euler's
};

using StrainTypes = testing::Types<TetrahedronShear, CorotationalStrain, GreenStrain>;
TYPED_TEST_SUITE(DampedStrain, StrainTypes, NameOfType);

TYPED_TEST(DampedStrain, KeepsAShareOfTheRateAcrossTheStrain) {
  this->project_after(1e-6, &Vec3d::y);
  Vec3d gradient[4];
  const double rate = TypeParam::strain_across(this->x_, this->motion_, this->params_, gradient);
  double left = rate;
  for (int i = 0; i < 4; ++i) left += dot(gradient[i], this->correction_[i]);
  EXPECT_NEAR(rate, 0.01, 1e-6);  // sqrt(2) |E'|
  EXPECT_NEAR(left / rate, this->compliance_ / (this->gamma_ * this->mass_along(gradient) + this->compliance_), 1e-3);
}

TYPED_TEST(DampedStrain, AlongTheStrainIsThatOfXpbd) {
  this->project_after(0.01, &Vec3d::x);
  Vec3d gradient[4];
  const double c = TypeParam::evaluate(this->x_, this->params_, gradient);
  const double motion = motion_along<TypeParam, double>(gradient, this->motion_);
  const double change =
      -(c + this->gamma_ * motion) / ((1 + this->gamma_) * this->mass_along(gradient) + this->compliance_);
  EXPECT_NEAR(this->response_.multiplier / change, 1, 1e-9);
  for (int i = 0; i < 4; ++i)
    EXPECT_LT(length(this->correction_[i] - gradient[i] * (this->w_[i] * change)), 1e-9 * std::fabs(change));
}

}  // namespace
}  // namespace pliant
