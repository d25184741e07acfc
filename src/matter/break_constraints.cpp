#include "matter/break_constraints.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "constraints/distance_limit.h"
#include "constraints/point_in_tetrahedron.h"
#include "constraints/point_on_triangle.h"
#include "constraints/registry.h"
#include "matter/edit_parts.h"
#include "matter/tears.h"

namespace pliant {

namespace {

/// The force of constraint `number` of a group: |C| over its compliance [N].
class ForceOf {
 public:
  ForceOf(const Object& object, std::span<const Vec3f> positions, const ConstraintGroup& group, double factor)
      : object_(object), positions_(positions), group_(group), type_(constraint_type(find_constraint_type(group.type))) {
    factor_ = type_.rest_scales ? factor : 1;
  }

  double operator()(int number) const {
    const std::size_t slots = type_.slots.size(), rows = static_cast<std::size_t>(type_.rows);
    const std::vector<double> at = places_of(stencil_of(group_, static_cast<int>(slots), number), positions_);
    std::vector<double> rest = rest_of(group_, number, object_), c(rows), gradients(rows * slots * 3);
    rest[0] *= factor_;
    type_.evaluate_double(at.data(), rest.data(), c.data(), gradients.data());
    double squares = 0;
    for (const double one : c) squares += one * one;
    const float alpha =
        group_.compliances.empty() ? group_.stiffness.value : group_.compliances[static_cast<std::size_t>(number)];
    return alpha > 0 ? std::sqrt(squares) / static_cast<double>(alpha) : 0;
  }

 private:
  const Object& object_;
  std::span<const Vec3f> positions_;
  const ConstraintGroup& group_;
  const ConstraintDefinition& type_;
  double factor_ = 1;
};

}  // namespace

bool breaks_by_force(const std::string& type) {
  return is_length(type) || type == DistanceLimit::name || type == PointOnTriangle::name ||
         type == PointInTetrahedron::name;
}

bool can_break(const Object& object) {
  return std::any_of(object.constraints.begin(), object.constraints.end(),
                     [](const ConstraintGroup& group) { return group.break_force > 0; });
}

std::optional<Edit> break_constraints(const Object& object, std::span<const Vec3f> positions,
                                      const std::function<float(int group)>& factor) {
  std::set<std::pair<int, int>> broken;
  for (int g = 0; g < static_cast<int>(object.constraints.size()); ++g) {
    const ConstraintGroup& group = object.constraints[static_cast<std::size_t>(g)];
    if (!(group.break_force > 0) || !breaks_by_force(group.type)) continue;
    const ForceOf force(object, positions, group, static_cast<double>(factor(g)));
    const int count = static_cast<int>(group.particles.size()) / slots_of(group, object);
    for (int c = 0; c < count; ++c)
      if (force(c) > static_cast<double>(group.break_force)) broken.insert({g, c});
  }
  if (broken.empty()) return {};
  return edit_to(without_constraints(object, broken));
}

}  // namespace pliant
