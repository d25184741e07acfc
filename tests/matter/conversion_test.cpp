// Tests stiffness and compliance: the conversions are inverse to each other, and both give the same motion in the
// formulas of the two solvers.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "pliant/error.h"
#include "pliant/material.h"
#include "support/nonfinite.h"

namespace pliant {
namespace {

using testing_support::infinity;

/// A particle of mass 1 / w on a spring to the origin (C = x), in double, without gravity. If `inertia` is false, it
/// stops in every substep.
struct IsolatedConstraint {
  double x = 1, v = 0;

  void xpbd(double alpha, const ConversionContext& c, bool inertia) {
    const double h = double{c.dt} / c.substeps, w = c.inverse_mass, scaled = alpha / (h * h);
    for (int s = 0; s < c.substeps; ++s) {
      const double start = x;
      double multiplier = 0;
      x += h * v;
      for (int i = 0; i < c.iterations; ++i) {
        const double change = (-x - scaled * multiplier) / (w + scaled);
        multiplier += change;
        x += w * change;
      }
      v = inertia ? (x - start) / h : 0;
    }
  }

  void pbd(double k, const ConversionContext& c, bool inertia) {
    const double h = double{c.dt} / c.substeps;
    const double share = 1 - std::pow(1 - k, 1.0 / (c.substeps * c.iterations));
    for (int s = 0; s < c.substeps; ++s) {
      const double start = x;
      x += h * v;
      for (int i = 0; i < c.iterations; ++i) x -= share * x;
      v = inertia ? (x - start) / h : 0;
    }
  }
};

TEST(Conversion, OneSubstepByHand) {
  // k = 1/2 leaves half: alpha~ = w, alpha = w h^2.
  EXPECT_FLOAT_EQ(compliance_from_stiffness(0.5f, {4, 0.5f}), 1);
  EXPECT_FLOAT_EQ(stiffness_from_compliance(1, {4, 0.5f}), 0.5f);
  // k = 3/4 in two substeps is 1/2 in each, of a quarter of h^2.
  EXPECT_FLOAT_EQ(compliance_from_stiffness(0.75f, {4, 0.5f, 2}), 0.25f);
}

TEST(Conversion, LogarithmsAgree) {
  for (int substeps : {1, 2, 3, 7, 20, 1000, 10000})
    for (float k : {1e-30f, 1e-9f, 1e-4f, 0.03f, 0.5f, 0.9f, 0.999f, 0.99999994f}) {
      const ConversionContext context{2, 1.f / 60, substeps};
      const double share = -std::expm1(std::log1p(-double{k}) / substeps), h = double{context.dt} / substeps;
      const double expected = h * h * 2 * (1 - share) / share;
      EXPECT_NEAR(compliance_from_stiffness(k, context) / expected, 1, 2e-7) << k << " in " << substeps;
    }
}

TEST(Conversion, Limits) {
  const ConversionContext context{2, 1.f / 60, 20, 3};
  EXPECT_EQ(compliance_from_stiffness(0, context), infinity);
  EXPECT_EQ(compliance_from_stiffness(1, context), 0);
  EXPECT_EQ(stiffness_from_compliance(0, context), 1);
  EXPECT_EQ(stiffness_from_compliance(infinity, context), 0);
  EXPECT_EQ(compliance_from_stiffness(std::numeric_limits<float>::denorm_min(), context), infinity);
  EXPECT_EQ(compliance_from_stiffness(0.3f, {2, 1.f / 60, 20, 1}),
            compliance_from_stiffness(0.3f, {2, 1.f / 60, 20, 50}));
}

TEST(Conversion, EachInvertsTheOther) {
  for (int substeps : {1, 2, 5, 20, 300, 10000})
    for (float k = 0.01f; k < 1; k += 0.07f) {
      const ConversionContext context{37, 1.f / 24, substeps};
      EXPECT_NEAR(stiffness_from_compliance(compliance_from_stiffness(k, context), context), k, 3e-7f);
    }
}

TEST(Conversion, MoreStiffnessIsLessCompliance) {
  const ConversionContext context{2, 1.f / 60, 10};
  float last = infinity;
  for (float k = 0; k <= 1; k += 1.f / 64) {
    const float alpha = compliance_from_stiffness(k, context);
    EXPECT_TRUE(alpha < last || k == 0);
    last = alpha;
  }
}

TEST(Conversion, BothSolversRemoveTheSameShareInAFrame) {
  for (int substeps : {1, 4, 20})
    for (int iterations : {1, 2, 10})
      for (float k : {0.1f, 0.5f, 0.95f}) {
        const ConversionContext context{3, 1.f / 60, substeps, iterations};
        const double alpha = compliance_from_stiffness(k, context);
        IsolatedConstraint by_compliance, by_stiffness;
        by_compliance.xpbd(alpha, context, false);
        by_stiffness.pbd(k, context, false);
        EXPECT_NEAR(by_compliance.x, 1 - double{k}, 1e-6) << substeps << " x " << iterations;
        EXPECT_NEAR(by_stiffness.x, 1 - double{k}, 1e-12);
      }
}

TEST(Conversion, BothSolversTakeTheSamePathWithInertia) {
  const ConversionContext context{3, 1.f / 60, 5, 4};
  const double alpha = compliance_from_stiffness(0.3f, context);
  IsolatedConstraint by_compliance, by_stiffness;
  for (int frame = 0; frame < 20; ++frame) {
    by_compliance.xpbd(alpha, context, true);
    by_stiffness.pbd(0.3f, context, true);
    EXPECT_NEAR(by_compliance.x, by_stiffness.x, 2e-6);
  }
}

TEST(Conversion, RefusesWhatHasNoMeaning) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const ConversionContext good{2, 1.f / 60};
  for (float k : {-0.1f, 1.1f, nan, infinity}) EXPECT_THROW(compliance_from_stiffness(k, good), Error);
  for (float alpha : {-1.f, nan}) EXPECT_THROW(stiffness_from_compliance(alpha, good), Error);
  for (float bad : {0.f, -1.f, nan, infinity}) {
    EXPECT_THROW(compliance_from_stiffness(0.5f, {bad, 1}), Error);
    EXPECT_THROW(stiffness_from_compliance(0.5f, {1, bad}), Error);
  }
  EXPECT_THROW(compliance_from_stiffness(0.5f, {1, 1, 0}), Error);
  EXPECT_THROW(compliance_from_stiffness(0.5f, {1, 1, 1, 0}), Error);
}

}  // namespace
}  // namespace pliant
