#include "model/object_sets.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <tuple>

#include "constraints/registry.h"
#include "math/functions.h"
#include "math/vector.h"
#include "model/attachments.h"
#include "model/cohesion.h"
#include "model/compile_surface.h"
#include "model/forest.h"
#include "model/soft_body_substeps.h"
#include "model/woven_substeps.h"

namespace pliant {

namespace {

bool is_converted(const Stiffness& stiffness, bool has_own_values) {
  return stiffness.kind == Stiffness::Kind::pbd && (has_own_values || (stiffness.value > 0 && stiffness.value < 1));
}

bool has_converted(const Object& object) {
  if (object.volume && is_converted(object.volume->stiffness, false)) return true;
  if (std::any_of(object.clusters.begin(), object.clusters.end(),
                  [](const Cluster& cluster) { return is_converted(cluster.stiffness, false); }))
    return true;
  const auto group_is = [](const ConstraintGroup& group) {
    return !group.particles.empty() && is_converted(group.stiffness, !group.compliances.empty());
  };
  return std::any_of(object.constraints.begin(), object.constraints.end(), group_is) ||
         std::any_of(object.attachments.begin(), object.attachments.end(),
                     [](const Attachment& attachment) { return is_converted(attachment.stiffness, false); });
}

/// Up to this strain under its own weight an object counts as one that is not meant to stretch [-].
constexpr double most_strain_by_weight = 0.002;

/// Zero for a missing particle, because this runs before the scene is validated.
float distance(const Object& object, int from, int to) {
  const auto a = static_cast<std::size_t>(from), b = static_cast<std::size_t>(to), count = object.positions.size();
  return a < count && b < count ? length(object.positions[b] - object.positions[a]) : 0.f;
}

/// The sum of compliance over rest length of distance constraints [1/N], and their number.
struct CompliancePerLength {
  double sum = 0;
  std::size_t count = 0;

  double mean() const { return sum / static_cast<double>(count); }
};

CompliancePerLength compliance_per_length(const Object& object, const ConstraintGroup& group) {
  CompliancePerLength of;
  for (std::size_t i = 0; 2 * i + 1 < group.particles.size(); ++i) {
    const float rest =
        i < group.rest.size() ? group.rest[i] : distance(object, group.particles[2 * i], group.particles[2 * i + 1]);
    const float compliance = i < group.compliances.size() ? group.compliances[i] : group.stiffness.value;
    if (!(rest > 0)) continue;
    of.sum += static_cast<double>(compliance) / static_cast<double>(rest);
    ++of.count;
  }
  return of;
}

/// Substeps of objects solved by `multigrid` that nothing disturbs.
constexpr int substeps_of_undisturbed_multigrid = 5;

/// True if it has pins or attachments, and all of them lie together.
bool swings(const Object& object) {
  std::vector<Vec3f> held;
  const auto add = [&](int particle) {
    const auto p = static_cast<std::size_t>(particle);
    held.push_back(p < object.positions.size() ? object.positions[p] : Vec3f{});
  };
  for (const Pin& pin : object.pins) add(pin.particle);
  for (const Attachment& attachment : object.attachments) add(attachment.particle);
  return !held.empty() && largest_extent(held) < swinging_share * largest_extent(object.positions);
}

/// An inflated object may have up to twice substeps_of_volumes, with which its overstretch stays below 2 %.
constexpr int most_substeps_of_volumes = 160;
constexpr double wanted_overstretch = 0.018;
/// Substeps of a sheet that is meant to stretch and hangs, for each edge along a square of as many particles as one
/// held particle bears. Measured with 24 to 96 particles a side, held by 1 to 16: forces gather at what is held, and
/// travel along chains of one substep.
constexpr double substeps_per_edge_of_stretching = 1.6;
/// Beyond this overstretch an inflated object would jitter: its edges gain energy from the volume that pushes them.
constexpr double most_overstretch_of_volumes = 0.08;

/// The mean of 1 / compliance of an object's distances [N/m]; infinite if one of them is rigid or has PBD stiffness.
double mean_stiffness(const Object& object) {
  double sum = 0, count = 0;
  for (const ConstraintGroup& group : object.constraints) {
    if (!is_length(group.type)) continue;
    const bool is_pbd = group.stiffness.kind != Stiffness::Kind::compliance;
    for (std::size_t i = 0; 2 * i + 1 < group.particles.size(); ++i) {
      const float compliance = is_pbd ? 0 : i < group.compliances.size() ? group.compliances[i] : group.stiffness.value;
      sum += 1 / std::max(static_cast<double>(compliance), 1e-30);
      ++count;
    }
  }
  return count > 0 ? sum / count : 0;
}

double mean_mass(const Object& object) {
  double sum = 0, count = 0;
  for (const float m : object.masses) {
    if (!std::isfinite(m)) continue;
    sum += static_cast<double>(m);
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

/// The substeps of a sheet that is meant to stretch and solved by chains. The law of the State cannot tell its strain
/// from overstretch.
int substeps_of_stretching(const Object& object) {
  const std::size_t held = object.pins.size() + object.attachments.size() +
                           static_cast<std::size_t>(std::count_if(object.masses.begin(), object.masses.end(),
                                                                  [](float m) { return std::isinf(m); }));
  if (held == 0 || object.triangles.empty()) return substeps_of_others;
  const double borne =
      static_cast<double>(object.positions.size()) / static_cast<double>(std::max<std::size_t>(held, 2));
  const int quarter =
      static_cast<int>(std::ceil(std::min(substeps_per_edge_of_stretching * std::sqrt(borne) / 4, 1e4)));
  return std::clamp(4 * quarter, substeps_of_others, most_substeps_of_volumes);
}

/// True if both are liquids that mix.
bool are_of_a_kind(const SetMember& a, const SetMember& b) {
  return a.spacing > 0 && a.spacing == b.spacing && a.speed_of_sound == b.speed_of_sound && a.groups == b.groups &&
         a.mask == b.mask;
}

/// Divides members into classes that meet the same members. Scenes with many objects have few classes.
std::vector<std::vector<int>> classes_of(const std::vector<SetMember>& members) {
  std::map<std::tuple<std::uint32_t, std::uint32_t, bool, bool, float, float, bool, bool, int>, std::size_t> numbers;
  std::vector<std::vector<int>> classes;
  for (int i = 0; i < static_cast<int>(members.size()); ++i) {
    const SetMember& m = members[i];
    const std::size_t number = numbers
                                   .try_emplace({m.groups, m.mask, m.collides, m.is_collider, m.spacing,
                                                 m.speed_of_sound, m.is_of_grains, m.is_of_gas, m.place},
                                                classes.size())
                                   .first->second;
    if (number == classes.size()) classes.emplace_back();
    classes[number].push_back(i);
  }
  return classes;
}

}  // namespace

bool can_meet(const SetMember& a, const SetMember& b) {
  if (a.place != b.place) return false;
  if (are_of_a_kind(a, b)) return true;
  const bool by_masks = (a.groups & b.mask) != 0 && (b.groups & a.mask) != 0;
  if (((a.is_of_grains && b.is_of_grains) || (a.is_of_gas && b.is_of_gas)) && by_masks) return true;
  const bool by_kind = a.is_collider != b.is_collider || (a.collides && b.collides && !a.is_collider);
  return by_masks && by_kind;
}

std::optional<double> strain_by_weight(const Object& object, double gravity) {
  const double mass = finite_mass(object);
  const bool is_sheet = !object.triangles.empty();
  CompliancePerLength all, stiffest;
  for (const ConstraintGroup& group : object.constraints) {
    if (!is_length(group.type) || group.stiffness.kind != Stiffness::Kind::compliance) continue;
    const CompliancePerLength of = compliance_per_length(object, group);
    if (of.count == 0) continue;
    all = {all.sum + of.sum, all.count + of.count};
    if (stiffest.count == 0 || of.mean() < stiffest.mean()) stiffest = of;
  }
  if (all.count == 0) return std::nullopt;
  // What bends a rope are distances across two links, which cannot stretch unless the links do.
  const double compliance = is_sheet ? all.mean() : stiffest.mean();
  const double row = is_sheet ? std::sqrt(static_cast<double>(object.positions.size())) : 1;
  return compliance * mass * std::max(gravity, least_acceleration) / row;
}

bool blows(const Wind& wind, const std::vector<ForceField>& forces) {
  return !forces.empty() || (wind.air_density > 0 && length(wind.velocity) > 0);
}

double strain_of_inflated(const Object& object) {
  if (!object.volume || !(largest_pressure(*object.volume) > 1)) return 0;
  return pow(largest_pressure(*object.volume), 1.0 / 3) - 1;
}

double overstretch_of_inflated(const Object& object, double substep) {
  const double strain = strain_of_inflated(object);
  if (strain == 0) return 0;
  const double mass = mean_mass(object);
  return mass > 0 ? 1.8 * strain * substep * substep * mean_stiffness(object) / mass : 0;
}

bool can_follow_volume(const Object& object, double substep) {
  return overstretch_of_inflated(object, substep) <= most_overstretch_of_volumes;
}

/// The heights between which an object's particles are at the start [m]. Those that may be emitted are taken to lie in
/// a cube with them.
struct Heights {
  float low = 0, high = 0;
};

Heights heights_of(const Object& object) {
  Heights of;
  const auto count = static_cast<int>(object.positions.size());
  const auto start = static_cast<std::size_t>(count - std::clamp(object.flow.spare, 0, count));
  for (std::size_t i = 0; i < start; ++i) {
    of.low = i == 0 ? object.positions[i].y : std::min(of.low, object.positions[i].y);
    of.high = i == 0 ? object.positions[i].y : std::max(of.high, object.positions[i].y);
  }
  if (start == object.positions.size()) return of;
  const float size = object.fluid ? object.fluid->spacing : 2 * object.grains->radius;
  of.high = std::max(
      of.high, of.low + size * static_cast<float>(pliant::pow(static_cast<double>(object.positions.size()), 1. / 3)));
  return of;
}

/// The height of an object's particles at the start [m].
double depth_of(const Object& object) {
  const Heights of = heights_of(object);
  return static_cast<double>(of.high - of.low);
}

namespace {

/// The height of a pile without mass scaling whose lowest contact yields as much as under any pile with it [m]. A grain
/// over others of r = exp(-k d) times its weight bears (1 + r) / (1 - r) times what one grain moves it, instead of two
/// for each that lies on it.
double height_borne(const Grains& grains) {
  const double diameter = 2 * static_cast<double>(grains.radius);
  const double ratio = pliant::exp(-static_cast<double>(grains.mass_scaling) * diameter);
  return diameter * (1 + ratio) / (2 * std::max(1 - ratio, 1e-12));
}

}  // namespace

GrainHeights heights_of_grains(const Object& object, double frame_time) {
  if (!object.grains || object.positions.empty()) return {};
  const Heights of = heights_of(object);
  const auto high = static_cast<float>(
      std::min(static_cast<double>(of.high), static_cast<double>(of.low) + height_borne(*object.grains)));
  return {of.low, high, 2 * object.grains->radius, static_cast<float>(frame_time)};
}

int substeps_of_grains(const GrainHeights& grains, double height) {
  constexpr double overlap = 0.03, stiffness = static_cast<double>(stiffness_of_grains);  // over the diameter
  const double diameter = static_cast<double>(grains.diameter), frame_time = static_cast<double>(grains.frame_time);
  const double depth = std::max(height, 10 * diameter);
  // A grain bears `depth / diameter` others, each of which falls by g h^2 in a substep; it yields by twice that over
  // the stiffness.
  const double h = diameter * std::sqrt(overlap * stiffness / (2 * least_acceleration * depth));
  return std::clamp(static_cast<int>(std::ceil(std::min(frame_time / h, 1e4))), 8, 1000);
}

namespace {

/// The largest acceleration of what weighs in an object of fluid [m/s^2]. A gas weighs what its weight differs from
/// that of air.
double acceleration_of_fluid(const Object& object) {
  constexpr double least = 0.2;  // of gravity: what moves presses too
  if (!object.gas) return least_acceleration;
  const double ambient = static_cast<double>(object.gas->ambient_temperature);
  const double ratio = static_cast<double>(object.gas->ambient_density / object.fluid->density);
  double share = least;
  const auto take = [&](double temperature) { share = std::max(share, std::abs(ratio * temperature / ambient - 1)); };
  take(static_cast<double>(object.gas->temperature));
  if (object.gas->cooling_time > 0) take(ambient);
  for (const GasHeater& heater : object.gas->heaters) take(static_cast<double>(heater.temperature));
  return least_acceleration * share;
}

}  // namespace

int substeps_of_fluid(const Object& object, double frame_time) {
  constexpr double error = 0.0035, relaxation = 0.4;        // of solver/fluids/fluid_solver.cpp
  constexpr double squared_gradients = 0.98, excess = 1.3;  // over 1 / reach^2 in a liquid at rest; over a plain sum
  const double reach = 2 * static_cast<double>(object.fluid->spacing);
  const double depth = std::max(depth_of(object), 5 * reach);
  const double h =
      std::sqrt(error * relaxation / (squared_gradients * excess * acceleration_of_fluid(object) * depth / 2)) * reach;
  return std::clamp(static_cast<int>(std::ceil(std::min(frame_time / h, 1e4))), 4, 1000);
}

int substeps_of_tension(const Object& object, double frame_time) {
  constexpr double share = 0.05;
  const double tension = static_cast<double>(object.fluid->surface_tension);
  if (!(tension > 0)) return 1;
  const double s = static_cast<double>(object.fluid->spacing), density = static_cast<double>(object.fluid->density);
  const double h = share * std::sqrt(density * s * s * s / tension);
  return std::clamp(static_cast<int>(std::ceil(std::min(frame_time / h, 1e4))), 1, 1000);
}

int own_substeps(const Object& object, Sweep sweep, bool is_blown, double frame_time) {
  if (object.tracers) return 1;
  if (object.fluid) return std::max(substeps_of_fluid(object, frame_time), substeps_of_tension(object, frame_time));
  if (object.grains)
    return std::max(substeps_of_grains(heights_of_grains(object, frame_time),
                                       std::min(depth_of(object), height_borne(*object.grains))),
                    substeps_of_cohesion(object, frame_time));
  if (is_soft_body(object)) return substeps_of_soft_body(object, frame_time);
  const bool is_of_bodies = !object.bodies.empty() && object.bodies.size() == object.positions.size();
  if (is_of_bodies && !has_converted(object)) return substeps_of_bodies;
  if (object.volume && solves_chains(sweep) && !has_converted(object)) {
    const double overstretch = overstretch_of_inflated(object, frame_time / substeps_of_volumes);
    const double too_long = overstretch <= most_overstretch_of_volumes ? overstretch / wanted_overstretch : 0;
    const int needed = static_cast<int>(std::ceil(substeps_of_volumes * std::sqrt(too_long)));
    return std::clamp(needed, substeps_of_volumes, most_substeps_of_volumes);
  }
  if (has_converted(object)) return substeps_of_others;
  if (is_woven(object)) return std::max(substeps_of_stretching(object), substeps_of_woven(object, frame_time));
  if (solves_chains(sweep) && is_meant_to_stretch(object, least_acceleration)) return substeps_of_stretching(object);
  if (sweep != Sweep::multigrid) return substeps_of_others;
  const auto moves = [](const auto& one) { return one.motion.keyframes.size() > 1; };  // a pin or an attachment
  const bool is_disturbed = is_blown || object.collides || object.self_collision || swings(object) ||
                            std::any_of(object.pins.begin(), object.pins.end(), moves) ||
                            std::any_of(object.attachments.begin(), object.attachments.end(), moves);
  return is_disturbed ? substeps_of_multigrid : substeps_of_undisturbed_multigrid;
}

bool is_meant_to_stretch(const Object& object, double gravity) {
  return strain_by_weight(object, gravity).value_or(0) > most_strain_by_weight;
}

SubstepRule substep_rule(const Object& object, Sweep sweep, double gravity) {
  if (has_converted(object)) return SubstepRule::fixed;
  if (!object.bodies.empty() || object.grains) return SubstepRule::constant;
  if (object.volume) return SubstepRule::any;  // chosen by measurements of volumes, not of strain
  // The law of the State sees distances alone, so woven cloth would get too few for its triangles.
  if (!solves_chains(sweep) || is_woven(object)) return SubstepRule::any;
  const std::optional<double> strain = strain_by_weight(object, gravity);
  return strain && *strain <= most_strain_by_weight ? SubstepRule::by_state : SubstepRule::any;
}

SetMember member_of(const Object& object, int substeps, SubstepRule rule, double frame_time) {
  const Fluid fluid = object.fluid.value_or(Fluid{.spacing = 0});
  return {object.groups,
          object.mask,
          object.collides,
          false,
          substeps,
          rule,
          fluid.spacing,
          fluid.speed_of_sound,
          object.grains.has_value(),
          heights_of_grains(object, frame_time),
          object.gas || object.tracers};
}

SetMember member_of(const MeshCollider& collider) {
  if (collider.as != MeshCollider::As::triangles) return {};
  return {collider.groups, collider.mask, false, true, 0};
}

std::vector<int> find_sets(const std::vector<SetMember>& members) {
  const std::vector<std::vector<int>> classes = classes_of(members);
  Forest forest(members.size());
  for (std::size_t i = 0; i < classes.size(); ++i) {
    const int first = classes[i].front();
    if (can_meet(members[first], members[first]))
      for (const int member : classes[i]) forest.join(first, member);
    for (std::size_t j = 0; j < i; ++j) {
      const int other = classes[j].front();
      if (!can_meet(members[first], members[other])) continue;
      for (const int member : classes[i]) forest.join(other, member);
      for (const int member : classes[j]) forest.join(first, member);
    }
  }
  std::vector<int> sets(members.size());
  for (int i = 0; i < static_cast<int>(members.size()); ++i) sets[static_cast<std::size_t>(i)] = forest.first_of(i);
  return sets;
}

namespace {

/// The heights of a set's grains at the start. They come to lie upon one another: no higher than all together, nor than
/// the sum of each.
struct SetHeight {
  double low = std::numeric_limits<double>::infinity(), high = -low, sum = 0;

  void add(const GrainHeights& grains) {
    low = std::min(low, static_cast<double>(grains.low));
    high = std::max(high, static_cast<double>(grains.high));
    sum += static_cast<double>(grains.high - grains.low + grains.diameter);
  }
  double height() const { return std::min(high - low, sum); }
};

/// By first member of a set: the substeps that its grains need together.
std::vector<int> needs_of_grains(const std::vector<SetMember>& members, const std::vector<int>& sets) {
  std::vector<int> substeps(members.size(), 0);
  std::vector<SetHeight> heights(members.size());
  for (std::size_t i = 0; i < members.size(); ++i)
    if (members[i].grains.frame_time > 0) heights[sets[i]].add(members[i].grains);
  for (std::size_t i = 0; i < members.size(); ++i)
    if (members[i].grains.frame_time > 0)
      substeps[sets[i]] = std::max(substeps[sets[i]], substeps_of_grains(members[i].grains, heights[sets[i]].height()));
  return substeps;
}

}  // namespace

std::vector<SetSubsteps> substeps_of_sets(const std::vector<SetMember>& members) {
  return substeps_of_sets(members, find_sets(members));
}

std::vector<SetSubsteps> substeps_of_sets(const std::vector<SetMember>& members, const std::vector<int>& sets) {
  std::vector<int> most = needs_of_grains(members, sets), least = most, of_solids(members.size(), 0);
  std::vector<SubstepRule> rule(members.size(), SubstepRule::any);
  for (std::size_t i = 0; i < members.size(); ++i) {
    most[sets[i]] = std::max(most[sets[i]], members[i].substeps);
    if (!(members[i].spacing > 0) && !members[i].is_of_grains)
      of_solids[sets[i]] = std::max(of_solids[sets[i]], members[i].substeps);
    if (members[i].rule != SubstepRule::by_state) least[sets[i]] = std::max(least[sets[i]], members[i].substeps);
    rule[sets[i]] = std::max(rule[sets[i]], members[i].rule);
  }
  std::vector<SetSubsteps> out;
  out.reserve(sets.size());
  for (const int set : sets) {
    const bool is_coupled = rule[set] == SubstepRule::constant && of_solids[set] > substeps_of_bodies;
    const int wanted = is_coupled ? std::max(most[set], substeps_of_coupled) : most[set];
    const int substeps = rule[set] == SubstepRule::fixed ? substeps_of_others : wanted;
    out.push_back({set, substeps, rule[set] == SubstepRule::by_state, least[set]});
  }
  return out;
}

}  // namespace pliant
