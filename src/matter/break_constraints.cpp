#include "matter/break_constraints.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "constraints/distance_limit.h"
#include "constraints/point_in_tetrahedron.h"
#include "constraints/point_on_triangle.h"
#include "constraints/registry.h"
#include "matter/edit_parts.h"
#include "matter/tears.h"

namespace pliant {

namespace {

/// Tells of the constraints of a group which have a force beyond that at which they break.
class IsBroken {
 public:
  /// `first`: how many constraints of that type earlier groups have.
  IsBroken(const Object& object, const KnownForces& known, int group, std::size_t first)
      : object_(object),
        known_(known),
        group_(object.constraints[static_cast<std::size_t>(group)]),
        type_(constraint_type(find_constraint_type(group_.type))),
        first_(first),
        factor_(type_.rest_scales ? static_cast<double>(known.factor(group)) : 1) {}

  bool operator()(int number) {
    const float alpha =
        group_.compliances.empty() ? group_.stiffness.value : group_.compliances[static_cast<std::size_t>(number)];
    if (!(alpha > 0)) return false;
    const std::vector<int> stencil = stencil_of(group_, static_cast<int>(type_.slots.size()), number);
    const std::vector<double> at = places_of(stencil, known_.positions);
    const double by_length = elongation(number, at) / static_cast<double>(alpha),
                 most = static_cast<double>(group_.break_force),
                 error = rounding_of_elongation(extent(at)) / static_cast<double>(alpha);
    if (std::fabs(by_length - most) > error) return by_length > most;
    return by_multipliers(number).value_or(by_length) > most;
  }

 private:
  /// |C| [m].
  double elongation(int number, const std::vector<double>& at) const {
    const std::size_t slots = type_.slots.size(), rows = static_cast<std::size_t>(type_.rows);
    std::vector<double> rest = rest_of(group_, number, object_), c(rows), gradients(rows * slots * 3);
    rest[0] *= factor_;
    type_.evaluate_double(at.data(), rest.data(), c.data(), gradients.data());
    double squares = 0;
    for (const double one : c) squares += one * one;
    return std::sqrt(squares);
  }

  /// The greatest distance of a point from the first.
  static double extent(const std::vector<double>& at) {
    double squares = 0;
    for (std::size_t i = 0; i < at.size(); i += 4)
      squares = std::max(squares, at[i] * at[i] + at[i + 1] * at[i + 1] + at[i + 2] * at[i + 2]);
    return std::sqrt(squares);
  }

  std::optional<double> by_multipliers(int number) {
    if (!are_known_) multipliers_ = known_.multipliers(group_.type);
    are_known_ = true;
    const auto rows = static_cast<std::size_t>(type_.rows), begin = (first_ + static_cast<std::size_t>(number)) * rows;
    if (begin + rows > multipliers_.size()) return {};
    double squares = 0;
    for (std::size_t i = begin; i < begin + rows; ++i)
      squares += static_cast<double>(multipliers_[i]) * static_cast<double>(multipliers_[i]);
    return std::sqrt(squares);
  }

  const Object& object_;
  const KnownForces& known_;
  const ConstraintGroup& group_;
  const ConstraintDefinition& type_;
  std::size_t first_;
  double factor_;
  std::vector<float> multipliers_;  ///< of the type, once they are asked for
  bool are_known_ = false;
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

double rounding_of_elongation(double distance) {
  constexpr double half_a_step = 1. / (1 << 24), errors = 4;  // twice what was measured on weights on threads
  return errors * half_a_step * distance;
}

std::optional<Edit> break_constraints(const Object& object, const KnownForces& known) {
  std::set<std::pair<int, int>> broken;
  std::map<std::string, std::size_t> counts;  // of each type in the groups before
  for (int g = 0; g < static_cast<int>(object.constraints.size()); ++g) {
    const ConstraintGroup& group = object.constraints[static_cast<std::size_t>(g)];
    const int count = static_cast<int>(group.particles.size()) / slots_of(group, object);
    const std::size_t first = counts[group.type];
    counts[group.type] += static_cast<std::size_t>(count);
    if (!(group.break_force > 0) || !breaks_by_force(group.type)) continue;
    IsBroken is_broken(object, known, g, first);
    for (int c = 0; c < count; ++c)
      if (is_broken(c)) broken.insert({g, c});
  }
  if (broken.empty()) return {};
  return edit_to(without_constraints(object, broken));
}

}  // namespace pliant
