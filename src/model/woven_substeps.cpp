// One Gauss-Seidel pass a substep makes a constraint more compliant by about half of its inverse mass w, in units of
// alpha / h^2: of two constraints that share particles, one is projected after the other, and moves it. The projection
// takes that off (`led` in solver/project.h) as far as alpha / h^2 is larger, so a sheet is right while s = h^2 w /
// (2 alpha) is small, whatever its rows; for shear of a square grid s = G h^2 / (rho e^2). Beyond, it yields in
// proportion to s. Figures: docs/internals/woven.md.
#include "model/woven_substeps.h"

#include <algorithm>
#include <cmath>

#include "constraints/triangle_shear.h"
#include "constraints/triangle_stretch.h"
#include "model/attachments.h"
#include "model/object_sets.h"

namespace pliant {

namespace {

constexpr double largest_number = 0.5;         ///< s up to which the error is below 3 %
constexpr double largest_without_lead = 0.09;  ///< the same where several passes leave no lead: 10 % too far
constexpr double tolerated_strain = 0.0005;    ///< by weight: what strains less may yield by so much more [-]
constexpr double yield_of_number = 1.25;       ///< measured for s of 1 to 16: 1.25 s times as much
constexpr double excess_of_number = 1.1;       ///< the same where several iterations leave no lead: 1 + 1.1 s
constexpr int most_substeps_of_woven = 160;

double excess_of(double number, bool is_led) {
  return is_led ? std::max(yield_of_number * number - 1, 0.0) : excess_of_number * number;
}

struct WovenGroup {
  double rate_squared = 0;  ///< mean of w / (2 alpha) [1/s^2]
  double strain = 0;        ///< by the object's weight [-]
  bool is_of_yarns = false;
  double number(double h) const { return rate_squared * h * h; }
  double allowed(bool is_led) const {
    const bool is_stiff = strain > 0 && strain < tolerated_strain;
    if (!is_led) return is_stiff ? tolerated_strain / strain / excess_of_number : largest_without_lead;
    return is_stiff ? (1 + tolerated_strain / strain) / yield_of_number : largest_number;
  }
};

/// w of a triangle's stretch or shear at rest: gradients are the two directions, square to each other, times these
/// coefficients.
double inverse_mass(const Object& object, const ConstraintGroup& group, std::size_t number, std::size_t fields) {
  const float* rest = &group.rest[fields * number];
  double sum = 0;
  for (std::size_t first = fields - fields / 2 * 2; first + 1 < fields;
       first += 2) {  // after `stretch`, where there is one
    const double a1 = static_cast<double>(rest[first]), a2 = static_cast<double>(rest[first + 1]);
    const double a[3] = {-a1 - a2, a1, a2};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto p = static_cast<std::size_t>(group.particles[3 * number + k]);
      if (p < object.masses.size()) sum += a[k] * a[k] / static_cast<double>(object.masses[p]);
    }
  }
  return sum;
}

bool is_of_triangles(const ConstraintGroup& group) {
  return group.type == TriangleStretch::name || group.type == TriangleShear::name;
}

/// Empty (rate_squared 0) if the group is rigid, damped by PBD, or lacks data.
WovenGroup measured_group(const Object& object, const ConstraintGroup& group, double height) {
  const std::size_t fields = group.type == TriangleStretch::name ? 3 : 4, count = group.particles.size() / 3;
  if (count == 0 || group.rest.size() < fields * count || group.stiffness.kind != Stiffness::Kind::compliance)
    return {};
  double rates = 0, compliances = 0, measured = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double alpha =
        static_cast<double>(i < group.compliances.size() ? group.compliances[i] : group.stiffness.value);
    if (!(alpha > 0)) continue;
    rates += inverse_mass(object, group, i, fields) / (2 * alpha);
    compliances += alpha;
    ++measured;
  }
  if (measured == 0) return {};
  const double triangles = std::max<double>(1, static_cast<double>(object.triangles.size()));
  return {rates / measured, compliances / measured * finite_mass(object) / triangles * least_acceleration * height,
          group.type == TriangleStretch::name};
}

/// Calls visit(WovenGroup) for each group of triangles.
template <class Visit>
void for_woven_groups(const Object& object, const Visit& visit) {
  if (!is_woven(object)) return;
  const double height = largest_extent(object.positions);
  for (const ConstraintGroup& group : object.constraints)
    if (is_of_triangles(group)) visit(measured_group(object, group, height));
}

}  // namespace

bool is_woven(const Object& object) {
  return std::any_of(object.constraints.begin(), object.constraints.end(), is_of_triangles);
}

double needed_substeps_of_woven(const Object& object, double frame_time, bool is_led) {
  double needed = is_woven(object) ? 1 : 0;
  for_woven_groups(object, [&](const WovenGroup& group) {
    needed = std::max(needed, frame_time * std::sqrt(group.rate_squared / group.allowed(is_led)));
  });
  return needed;
}

int substeps_of_woven(const Object& object, double frame_time) {
  const double most = most_substeps_of_woven;
  return static_cast<int>(std::ceil(std::min(needed_substeps_of_woven(object, frame_time), most)));
}

WovenYield yield_of_woven(const Object& object, double frame_time, const Passes& passes) {
  WovenYield most;
  double farthest = 1;
  const double h = frame_time / (passes.substeps * std::sqrt(double(passes.iterations)));
  for_woven_groups(object, [&](const WovenGroup& group) {
    const double s = group.number(h), excess = excess_of(s, passes.is_led), allowed = group.allowed(passes.is_led);
    if (!(s > farthest * allowed)) return;
    farthest = s / allowed;
    most = {1 + excess, excess * group.strain, group.is_of_yarns};
  });
  return most;
}

}  // namespace pliant
