// One Gauss-Seidel pass a substep makes a constraint more compliant by about half of its inverse mass w, in units of
// alpha / h^2: of two constraints that share particles, one is projected after the other, and moves it. So a sheet
// yields by 1 + s with s = h^2 w / (2 alpha), whatever its rows; for shear of a square grid s = G h^2 / (rho e^2).
// Figures: docs/internals/woven.md.
#include "model/woven_substeps.h"

#include <algorithm>
#include <cmath>

#include "constraints/triangle_shear.h"
#include "constraints/triangle_stretch.h"
#include "model/attachments.h"
#include "model/object_sets.h"

namespace pliant {

namespace {

constexpr double excess_of_number = 1.1;    ///< measured: 1.08 to 1.18
constexpr double largest_number = 0.09;     ///< s up to which the error is below a tenth
constexpr double tolerated_strain = 0.002;  ///< that stiff cloth may yield by too much [-]

struct WovenGroup {
  double rate_squared = 0;  ///< mean of w / (2 alpha) [1/s^2]
  double strain = 0;        ///< by the object's weight [-]
  double number(double h) const { return rate_squared * h * h; }
  double allowed() const { return strain > 0 ? std::max(largest_number, tolerated_strain / strain) : largest_number; }
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
  if (count == 0 || group.rest.size() < fields * count || group.stiffness.kind != Stiffness::Kind::compliance) return {};
  double rates = 0, compliances = 0, measured = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double alpha = static_cast<double>(i < group.compliances.size() ? group.compliances[i] : group.stiffness.value);
    if (!(alpha > 0)) continue;
    rates += inverse_mass(object, group, i, fields) / (2 * alpha);
    compliances += alpha;
    ++measured;
  }
  if (measured == 0) return {};
  const double triangles = std::max<double>(1, static_cast<double>(object.triangles.size()));
  return {rates / measured, compliances / measured * finite_mass(object) / triangles * least_acceleration * height};
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

bool has_oblique_yarns(const Object& object) {
  return std::any_of(object.constraints.begin(), object.constraints.end(),
                     [](const ConstraintGroup& group) { return group.type == TriangleStretch::name; });
}

double needed_substeps_of_woven(const Object& object, double frame_time) {
  double needed = is_woven(object) ? 1 : 0;
  for_woven_groups(object, [&](const WovenGroup& group) {
    needed = std::max(needed, frame_time * std::sqrt(group.rate_squared / group.allowed()));
  });
  return needed;
}

WovenYield yield_of_woven(const Object& object, double frame_time, double substeps) {
  WovenYield most;
  double farthest = 1;
  for_woven_groups(object, [&](const WovenGroup& group) {
    const double s = group.number(frame_time / substeps), excess = excess_of_number * s;
    if (!(s > farthest * group.allowed())) return;
    farthest = s / group.allowed();
    most = {1 + excess, excess * group.strain};
  });
  return most;
}

}  // namespace pliant
