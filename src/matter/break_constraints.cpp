#include "matter/break_constraints.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "constraints/distance_limit.h"
#include "constraints/point_in_tetrahedron.h"
#include "constraints/point_on_triangle.h"
#include "constraints/registry.h"
#include "math/disjoint_sets.h"
#include "matter/edit_parts.h"
#include "matter/tears.h"

namespace pliant {

namespace {

/// Finds the constraints of a group whose force is beyond that at which they break.
class ForceShares {
 public:
  /// `first`: how many constraints of that type earlier groups have.
  ForceShares(const Object& object, const KnownForces& known, int group, std::size_t first)
      : object_(object),
        known_(known),
        group_(object.constraints[static_cast<std::size_t>(group)]),
        type_(constraint_type(find_constraint_type(group_.type))),
        first_(first),
        factor_(type_.rest_scales ? static_cast<double>(known.factor(group)) : 1) {}

  /// The force of a constraint over that at which it breaks, if it is beyond; 0 if it holds.
  double overload(int number) {
    const float alpha =
        group_.compliances.empty() ? group_.stiffness.value : group_.compliances[static_cast<std::size_t>(number)];
    if (!(alpha > 0)) return 0;
    const std::vector<int> stencil = stencil_of(group_, static_cast<int>(type_.slots.size()), number);
    const std::vector<double> at = places_of(stencil, known_.positions);
    const double most = static_cast<double>(group_.break_force), rounding = rounding_of_elongation(extent(at));
    std::optional<double> force;
    if (rounding * lightest(stencil) <= coarse * most * known_.h * known_.h) force = by_multipliers(number);
    if (!force) force = elongation(number, at) / static_cast<double>(alpha);
    if (std::fabs(*force - most) <= rounding / static_cast<double>(alpha))
      force = by_multipliers(number).value_or(*force);
    return *force > most ? *force / most : 0;
  }

 private:
  /// Multipliers are the forces of the substep, those of constraints that one iteration does not meet too. Elongations
  /// are taken where rounding changes multipliers by more than this share of the limit, as with many short substeps.
  static constexpr double coarse = 0.01;

  /// C of a length, which breaks by a pull alone; |C| of other types [m].
  double elongation(int number, const std::vector<double>& at) const {
    const std::size_t slots = type_.slots.size(), rows = static_cast<std::size_t>(type_.rows);
    std::vector<double> rest = rest_of(group_, number, object_), c(rows), gradients(rows * slots * 3);
    rest[0] *= factor_;
    type_.evaluate_double(at.data(), rest.data(), c.data(), gradients.data());
    if (is_length(group_.type)) return c[0];
    double squares = 0;
    for (const double one : c) squares += one * one;
    return std::sqrt(squares);
  }

  /// The least mass of these particles [kg].
  double lightest(const std::vector<int>& particles) const {
    double mass = std::numeric_limits<double>::infinity();
    for (const int p : particles)
      mass = std::min(mass, static_cast<double>(object_.masses[static_cast<std::size_t>(p)]));
    return mass;
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
    if (is_length(group_.type)) return -static_cast<double>(multipliers_[begin]);
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

/// A constraint that carries more than it can.
struct Overload {
  std::pair<int, int> constraint;  ///< group, and number in it
  double share = 0;                ///< its force over that at which it breaks
};

/// The constraints of an object that carry more than they can, in the order of groups and numbers.
std::vector<Overload> find_overloads(const Object& object, const KnownForces& known) {
  std::vector<Overload> found;
  std::map<std::string, std::size_t> counts;  // of each type in the groups before
  for (int g = 0; g < static_cast<int>(object.constraints.size()); ++g) {
    const ConstraintGroup& group = object.constraints[static_cast<std::size_t>(g)];
    const int count = static_cast<int>(group.particles.size()) / slots_of(group, object);
    const std::size_t first = counts[group.type];
    counts[group.type] += static_cast<std::size_t>(count);
    if (!(group.break_force > 0) || !breaks_by_force(group.type)) continue;
    ForceShares shares(object, known, g, first);
    for (int c = 0; c < count; ++c)
      if (const double share = shares.overload(c); share > 0) found.push_back({{g, c}, share});
  }
  return found;
}

/// Constraints that bear one load in series: links that can break, joined by free particles at which no third one meets
/// them, and a tie that holds the end of such a row.
class Series {
 public:
  explicit Series(const Object& object)
      : object_(object), rows_(number_constraints(object)), links_(object.positions.size()) {
    for_each([&](std::size_t number, const ConstraintGroup& group, int c) {
      if (!is_link(group)) return;
      for (std::size_t end = 0; end < 2; ++end) links_at(group, c, 2, end).push_back(number);
    });
    const std::vector<char> held = held_particles(object);
    for (std::size_t i = 0; i < links_.size(); ++i)
      if (links_[i].size() == 2 && held[i] == 0) rows_.join(links_[i][0], links_[i][1]);
    for_each([&](std::size_t number, const ConstraintGroup& group, int c) {
      if (is_link(group)) return;
      const std::vector<std::size_t>& tied = links_at(group, c, slots_of(group, object_), 0);
      if (tied.size() == 1) rows_.join(tied[0], number);
    });
  }

  /// The same number for all constraints of a row.
  std::size_t row_of(const std::pair<int, int>& constraint) {
    return rows_.root(first_[static_cast<std::size_t>(constraint.first)] + static_cast<std::size_t>(constraint.second));
  }

 private:
  static bool is_link(const ConstraintGroup& group) {
    return is_length(group.type) || group.type == DistanceLimit::name;
  }

  std::size_t number_constraints(const Object& object) {
    std::size_t count = 0;
    for (const ConstraintGroup& group : object.constraints) {
      first_.push_back(count);
      count += group.particles.size() / static_cast<std::size_t>(slots_of(group, object));
    }
    return count;
  }

  /// Calls body(number among all, group, number in it) for each constraint that can break.
  template <class Body>
  void for_each(Body&& body) const {
    for (std::size_t g = 0; g < object_.constraints.size(); ++g) {
      const ConstraintGroup& group = object_.constraints[g];
      if (!(group.break_force > 0) || !breaks_by_force(group.type)) continue;
      const std::size_t end = g + 1 < first_.size() ? first_[g + 1] : rows_.count();
      for (std::size_t number = first_[g]; number < end; ++number)
        body(number, group, static_cast<int>(number - first_[g]));
    }
  }

  std::vector<std::size_t>& links_at(const ConstraintGroup& group, int c, int slots, std::size_t slot) {
    const std::size_t at = static_cast<std::size_t>(c) * static_cast<std::size_t>(slots) + slot;
    return links_[static_cast<std::size_t>(group.particles[at])];
  }

  const Object& object_;
  std::vector<std::size_t> first_;  ///< of each group: the number of its first constraint among all
  DisjointSets rows_;
  std::vector<std::vector<std::size_t>> links_;  ///< at each particle: the links that can break
};

/// Of each row keeps the constraint with the greatest share, the first of equal ones: that it breaks relieves the
/// others.
void keep_one_of_each_row(const Object& object, std::vector<Overload>& overloads) {
  Series series(object);
  std::map<std::size_t, Overload> greatest;  // of each row
  for (const Overload& one : overloads) {
    const auto [found, is_new] = greatest.try_emplace(series.row_of(one.constraint), one);
    if (!is_new && one.share > found->second.share) found->second = one;
  }
  overloads.clear();
  for (const auto& [row, one] : greatest) overloads.push_back(one);
}

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
  std::vector<Overload> overloads = find_overloads(object, known);
  if (overloads.empty()) return {};
  if (overloads.size() > 1) keep_one_of_each_row(object, overloads);
  std::set<std::pair<int, int>> broken;
  for (const Overload& one : overloads) broken.insert(one.constraint);
  return edit_to(without_constraints(object, broken));
}

}  // namespace pliant
