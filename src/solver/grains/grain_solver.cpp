#include "solver/grains/grain_solver.h"

#include <algorithm>
#include <cmath>

#include "core/at.h"
#include "math/record.h"
#include "math/vector.h"
#include "solver/grains/grain_formulas.h"
#include "solver/substep.h"

namespace pliant {

namespace {

/// Neighbours are found within this distance beyond contact, and again once a grain has moved by half of it; over the
/// radius.
constexpr float skin = 0.5f;

/// Calls body(slot) for all slots of a task.
template <class Body>
void for_slots(const NeighbourLists& lists, int task, const Body& body) {
  constexpr int slots = NeighbourLists::groups_in_a_task * NeighbourLists::lanes;
  const int first = task * slots, last = std::min(first + slots, lists.slots());
  for (int slot = first; slot < last; ++slot) body(slot);
}

/// Calls body(slot) for all slots on all threads.
template <class Body>
void for_all_slots(Substep& s, const char* name, const NeighbourLists& lists, const Body& body) {
  s.context.executor.parallel_for(name, lists.tasks(), [&](int task) { for_slots(lists, task, body); });
}

/// Grains of one object always meet.
bool can_touch(const GrainTraits& a, const GrainTraits& b) {
  return a.object == b.object || ((a.groups & b.mask) != 0 && (b.groups & a.mask) != 0);
}

/// The known slip of a over b, or none.
Vec3f known_slip(const std::vector<GrainContact>& known, std::int32_t a, std::int32_t b) {
  const GrainContact wanted{std::min(a, b), std::max(a, b), {}};
  const auto found = std::lower_bound(known.begin(), known.end(), wanted, in_order_of_particles);
  if (found == known.end() || found->a != wanted.a || found->b != wanted.b) return {};
  return a < b ? found->slip : -found->slip;
}

}  // namespace

GrainSolver::GrainSolver(const Model& model, const std::vector<int>* objects) {
  const int count = static_cast<int>(objects != nullptr ? objects->size() : model.objects.size());
  for (int i = 0; i < count; ++i) {
    const int o = objects != nullptr ? (*objects)[at(i)] : i;
    if (model.objects[at(o)].grains) objects_.push_back(o);
  }
  list_points(model, {});
}

GrainSolver::~GrainSolver() = default;

/// Lists the grains that are there.
void GrainSolver::list_points(const Model& model, const State& state) {
  points_.clear();
  traits_.clear();
  for (const int o : objects_) {
    const CompiledObject& object = model.objects[at(o)];
    const GrainTraits traits{object.grains->radius,
                             contact_friction(object.grains->friction),
                             object.grains->cohesion,
                             0,
                             object.grains->mass_scaling,
                             o,
                             object.groups,
                             object.mask};
    largest_radius_ = std::max(largest_radius_, traits.radius);
    has_cohesion_ = has_cohesion_ || traits.cohesion > 0;
    scales_masses_ = scales_masses_ || traits.mass_scaling > 0;
    for (int p = model.first[at(o)]; p < model.end_of(o); ++p) {
      if (!is_there(state, at(p))) continue;
      points_.push_back(p);
      traits_.push_back(traits);
    }
  }
}

void GrainSolver::begin_frame(Substep& s) {
  is_new_frame_ = true;
  if (!s.state.births.empty()) list_points(s.model, s.state);
}

void GrainSolver::find_neighbours(Substep& s, const std::vector<GrainContact>& known) {
  Records by_point(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) by_point[i] = predicted_position(s, points_[i]);
  const float beyond = has_cohesion_ ? skin + 2 * longest_bond : skin;
  lists_.find(s.context.executor, s.kernels.neighbours, by_point, (2 + beyond) * largest_radius_);
  const std::vector<std::int32_t>& order = lists_.order().points();
  of_slot_.resize(order.size());
  of_grain_.resize(order.size());
  found_at_.resize(order.size());
  for (std::size_t slot = 0; slot < order.size(); ++slot) {
    const std::size_t point = at(order[slot]);
    of_slot_[slot] = points_[point];
    of_grain_[slot] = traits_[point];
    of_grain_[slot].inverse_mass = s.state.positions[at(of_slot_[slot])].w;
    found_at_[slot] = by_point[point];
  }
  count_neighbours();
  for_all_slots(s, "neighbours: grains", lists_, [&](int slot) { list_neighbours(slot, known); });
}

/// Makes room for the neighbours of each slot.
void GrainSolver::count_neighbours() {
  constexpr int lanes = NeighbourLists::lanes;
  first_.assign(at(lists_.slots()) + 1, 0);
  for (int slot = 0; slot < lists_.slots(); ++slot) {
    const NeighbourGroup& group = lists_.group(slot / lanes);
    int count = 0;
    while (count < group.rows && group.slots[count * lanes + slot % lanes] != lists_.nobody()) ++count;
    first_[at(slot) + 1] = first_[at(slot)] + count;
  }
  neighbours_.assign(at(first_.back()), {});
}

/// Orders the neighbours of a slot by particle, so that sums do not depend on cells, nor on when neighbours are found.
void GrainSolver::list_neighbours(int slot, const std::vector<GrainContact>& known) {
  constexpr int lanes = NeighbourLists::lanes;
  const NeighbourGroup& group = lists_.group(slot / lanes);
  GrainNeighbour* const first = neighbours_.data() + first_[at(slot)];
  const int count = first_[at(slot) + 1] - first_[at(slot)];
  for (int k = 0; k < count; ++k) first[k].slot = group.slots[k * lanes + slot % lanes];
  std::sort(first, first + count, [&](const GrainNeighbour& a, const GrainNeighbour& b) {
    return of_slot_[at(a.slot)] < of_slot_[at(b.slot)];
  });
  for (int k = 0; k < count; ++k) first[k].slip = known_slip(known, of_slot_[at(slot)], of_slot_[at(first[k].slot)]);
}

/// False if a grain has moved so far that it may touch one that is not listed.
bool GrainSolver::are_neighbours_known(Substep& s) {
  if (points_.empty()) return true;
  task_moves_.assign(at(lists_.tasks()), 0);
  s.context.executor.parallel_for("neighbours: grains", lists_.tasks(), [&](int task) {
    float largest = 0;
    for_slots(lists_, task, [&](int slot) {
      const Vec3f move = xyz(predicted_position(s, of_slot_[at(slot)])) - xyz(found_at_[at(slot)]);
      largest = std::max(largest, dot(move, move));
    });
    task_moves_[at(task)] = largest;
  });
  const float largest = *std::max_element(task_moves_.begin(), task_moves_.end());
  const float most = skin / 2 * largest_radius_;
  return largest < most * most;
}

/// Adds the last substep's motion to the slip of a slot's contacts. What is not pressed together, or exceeds the
/// friction, slides.
void GrainSolver::slide(const State& state, int slot) {
  const auto move = [&](std::int32_t of) {
    const Record &x = state.positions[at(of_slot_[at(of)])], &r = state.remainders[at(of_slot_[at(of)])];
    return (xyz(x) - xyz(starts_[at(of)])) + (xyz(r) - xyz(residues_[at(of)]));
  };
  const auto place = [&](std::int32_t of) { return xyz(state.positions[at(of_slot_[at(of)])]); };
  const Vec3f own_move = move(slot), own = place(slot);
  for (std::int32_t k = first_[at(slot)]; k < first_[at(slot) + 1]; ++k) {
    GrainNeighbour& n = neighbours_[at(k)];
    if (!(n.push + n.pull > 0)) {
      n.slip = {};
      continue;
    }
    const float friction =
        grain_formulas::common_friction(of_grain_[at(slot)].friction, of_grain_[at(n.slot)].friction);
    const Vec3f normal = grain_formulas::normal_of(own - place(n.slot), of_slot_[at(slot)] < of_slot_[at(n.slot)]);
    n.slip = grain_formulas::after_motion(n.slip, own_move - move(n.slot), normal, friction * (n.push + n.pull));
  }
}

void GrainSolver::collide(Substep& s) {
  if (!is_new_frame_) for_all_slots(s, "neighbours: grains", lists_, [&](int slot) { slide(s.state, slot); });
  if (is_new_frame_ || !are_neighbours_known(s)) {
    std::vector<GrainContact> known;
    if (is_new_frame_) {
      known = s.state.grain_contacts;
    } else {
      list_contacts(known);
      std::sort(known.begin(), known.end(), in_order_of_particles);
    }
    find_neighbours(s, known);
    is_new_frame_ = false;
  }
  const std::size_t slots = at(lists_.slots());
  for (Records* records : {&places_, &moves_, &starts_, &residues_}) records->resize(slots);
  for_all_slots(s, "neighbours: grains", lists_, [&](int slot) {
    starts_[at(slot)] = s.state.positions[at(of_slot_[at(slot)])];
    residues_[at(slot)] = s.state.remainders[at(of_slot_[at(slot)])];
  });
}

void GrainSolver::project_neighbours(Substep& s, bool is_first) {
  for_all_slots(s, "solve: places of grains", lists_, [&](int slot) {
    const Record &d = s.work.displacements[at(of_slot_[at(slot)])], &r = residues_[at(slot)];
    places_[at(slot)] = predicted_position(s, of_slot_[at(slot)]);
    moves_[at(slot)] = {d.x - r.x, d.y - r.y, d.z - r.z, 0};
  });
  for_all_slots(s, "solve: grains", lists_, [&](int slot) { project_grain(s, slot, is_first); });
}

void GrainSolver::project_grain(Substep& s, int slot, bool is_first) {
  const GrainTraits& own = of_grain_[at(slot)];
  const Vec3f place = xyz(places_[at(slot)]), move = xyz(moves_[at(slot)]);
  const float gravity = scales_masses_ ? length(s.model.gravity) : 0;
  Vec3f sum{};
  for (std::int32_t k = first_[at(slot)]; k < first_[at(slot) + 1]; ++k) {
    GrainNeighbour& n = neighbours_[at(k)];
    const GrainTraits& other = of_grain_[at(n.slot)];
    if (is_first) {
      n.push = n.pull = 0;
      n.friction = {};
    }
    const Vec3f between = place - xyz(places_[at(n.slot)]);
    const float pull = has_cohesion_ ? grain_formulas::most_pull(own, other, s.h) : 0;
    const float reach = own.radius + other.radius, farthest = reach + pull / grain_formulas::stiffness;
    if (!(dot(between, between) < farthest * farthest) || !can_touch(own, other)) continue;
    const float inverse_mass = own.inverse_mass + other.inverse_mass;
    if (!(inverse_mass > 0)) continue;
    n.pull = pull;
    const Vec3f normal = grain_formulas::normal_of(between, of_slot_[at(slot)] < of_slot_[at(n.slot)]);
    const float gap = dot(between, normal) - reach;
    const float friction = grain_formulas::common_friction(own.friction, other.friction);
    const Vec3f by = grain_formulas::project(gap, normal, move - xyz(moves_[at(n.slot)]), friction, n);
    const float share = scales_masses_
                            ? grain_formulas::scaled_share(own, other, dot(between, s.model.gravity), gravity)
                            : own.inverse_mass / inverse_mass;
    sum = sum + share * by;
  }
  Record& d = s.work.displacements[at(of_slot_[at(slot)])];
  d = {d.x + sum.x, d.y + sum.y, d.z + sum.z, d.w};
}

void GrainSolver::list_contacts(std::vector<GrainContact>& to) const {
  for (int slot = 0; slot < lists_.slots(); ++slot)
    for (std::int32_t k = first_[at(slot)]; k < first_[at(slot) + 1]; ++k) {
      const GrainNeighbour& n = neighbours_[at(k)];
      const std::int32_t a = of_slot_[at(slot)], b = of_slot_[at(n.slot)];
      if (n.push + n.pull > 0 && a < b) to.push_back({a, b, n.slip});
    }
}

void GrainSolver::end_frame(Substep& s) {
  if (is_new_frame_) return;  // no substep was made
  for (int slot = 0; slot < lists_.slots(); ++slot) slide(s.state, slot);
  list_contacts(s.state.grain_contacts);
}

void GrainSolver::order(State& state) const {
  std::vector<GrainContact>& all = state.grain_contacts;
  if (!std::is_sorted(all.begin(), all.end(), in_order_of_particles))
    std::sort(all.begin(), all.end(), in_order_of_particles);
}

}  // namespace pliant
