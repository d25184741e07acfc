// Converts PBD stiffness to XPBD compliance and back, without a logarithm.
//
// One PBD projection of an isolated constraint leaves (1 - k'') C of its error C. The m iterations of a substep
// leave 1 - k', the n substeps of a frame leave 1 - k. XPBD leaves alpha~ / (w + alpha~) in a substep, alpha~ =
// alpha / h^2, whatever m is, because its multiplier accumulates. If both shares are equal, k' = w / (w +
// alpha~), the motion is the same. The step from k to k' needs k' = 1 - (1 - k)^(1/n). Newton's method solves
// K(k') = 1 - (1 - k')^n for it. Repeated doubling evaluates K from terms of one sign, so small shares keep their
// digits.
#include <cmath>
#include <limits>
#include <string>

#include "pliant/error.h"
#include "pliant/material.h"

namespace pliant {

namespace {

void require_context(const ConversionContext& context) {
  if (!(context.inverse_mass > 0) || !std::isfinite(context.inverse_mass))
    throw Error({"", 0, "", "inverse_mass"}, "is " + std::to_string(context.inverse_mass),
                "give the sum over the particles of w |grad C|^2, positive and finite [1/kg]");
  if (!(context.dt > 0) || !std::isfinite(context.dt))
    throw Error({"", 0, "", "dt"}, "is " + std::to_string(context.dt), "give a positive, finite time step [s]");
  if (context.substeps < 1 || context.iterations < 1)
    throw Error({"", 0, "", context.substeps < 1 ? "substeps" : "iterations"}, "must be at least 1");
}

/// 1 - (1 - share)^times. Two shares combine to a + b - a b = a + b (1 - a), which has no negative terms.
double repeated_share(double share, int times) {
  double result = 0, power = share;
  for (int bits = times; bits > 0; bits >>= 1) {
    if (bits & 1) result += power * (1 - result);
    power += power * (1 - power);
  }
  return result;
}

/// The share that gives `whole`, 0 < whole < 1, when it is repeated `times` times. K is concave and K(whole / times) <=
/// whole, so Newton's method approaches the root from below and stops when a step gains nothing. Each step reduces the
/// distance to the root by a factor e or more, so about twenty steps suffice for floats.
double single_share(double whole, int times) {
  double share = whole / times;
  for (int step = 0; step < 200; ++step) {
    const double left = 1 - repeated_share(share, times - 1);  // (1 - share)^(times - 1)
    const double next = share + (whole - repeated_share(share, times)) / (times * left);
    if (!(next > share)) break;
    share = next;
  }
  return share;
}

double squared_substep(const ConversionContext& context) {
  const double substep = static_cast<double>(context.dt) / context.substeps;
  return substep * substep;
}

}  // namespace

float compliance_from_stiffness(float k, const ConversionContext& context) {
  require_context(context);
  if (!(k >= 0 && k <= 1))
    throw Error({"", 0, "", "stiffness"}, "is " + std::to_string(k),
                "PBD stiffness is a share of the error: give 0 to 1");
  if (k == 0) return std::numeric_limits<float>::infinity();
  if (k == 1) return 0;
  const double share = single_share(k, context.substeps);
  const double alpha = squared_substep(context) * context.inverse_mass * (1 - share) / share;
  const bool fits = alpha <= static_cast<double>(std::numeric_limits<float>::max());
  return fits ? static_cast<float>(alpha) : std::numeric_limits<float>::infinity();
}

float stiffness_from_compliance(float alpha, const ConversionContext& context) {
  require_context(context);
  if (!(alpha >= 0)) throw Error({"", 0, "", "compliance"}, "is " + std::to_string(alpha), "give 0 (rigid) or more");
  if (std::isinf(alpha)) return 0;
  const double weight = squared_substep(context) * context.inverse_mass;
  return static_cast<float>(repeated_share(weight / (weight + alpha), context.substeps));
}

}  // namespace pliant
