#include "solver/substep_law.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "solver/impacts.h"
#include "solver/lengths.h"
#include "solver/tethers.h"

namespace pliant {

namespace {

/// Substeps per frame for each unit of strain, and for each radian that a constraint turns by in a frame. Measured:
/// with fewer, folds pass 2 % of strain at their impact (docs/internals/default_settings_tried.md).
constexpr double substeps_per_strain = 5000, substeps_per_radian = 20;
/// Tethers leave no long errors, and an impact on a primitive collider moves few particles.
constexpr double substeps_per_strain_hanging = 1000;
/// Substeps decrease to no less than this share from one quarter to the next. The strain of a swinging rope goes with
/// the square of the substep: left to demand alone, few and many substeps would alternate, and each change do work.
constexpr double slowest_decrease = 1 / 1.1;
constexpr double first_substeps = 40, first_of_hanging = 10;  ///< before the first quarter
/// The share of constraints that may demand more.
constexpr double share_beyond = 0.01;
/// The same for what an impact on a collider is about to do: it starts with few particles, and energy that it stores in
/// strain with too few substeps is released when more follow.
constexpr double share_beyond_of_impact = 0.001;

/// How strain and rotation of constraints are turned into a demand for substeps, and the velocities that it is found
/// from.
struct Demand {
  const Record* velocities = nullptr;  ///< of all particles of the State
  double per_strain = 0, per_radian = 0;
  double share_beyond = 0;  ///< the share of constraints that may demand more
};

/// The substeps per frame that all but a share of the constraints are satisfied with; `least` if those are fewer.
double demanded(Substep& s, const Demand& by, int least) {
  const std::vector<Task>& tasks = s.lengths();
  std::vector<std::vector<FoundLength>>& found = s.own->limit.found;
  if (found.size() < tasks.size()) found.resize(tasks.size());
  for_tasks(s, "choose substeps", static_cast<int>(tasks.size()), [&](int i) {
    const CompiledObject& object = s.model.objects[tasks[i].object];
    const int first = s.model.first[tasks[i].object];
    found[i].clear();
    if (!solves_chains(object.sweep)) return;  // multigrid does not need shorter substeps where strain is large
    find_demanding(object, object.lengths[tasks[i].item], s.kernels.lengths,
                   {s.state.positions.data() + first, by.velocities + first, static_cast<float>(by.per_strain),
                    static_cast<float>(by.per_radian * s.dt), static_cast<float>(least)},
                   found[i]);
  });
  double constraints = 0;
  std::vector<float>& all = s.own->demands;
  all.clear();
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const CompiledObject& object = s.model.objects[tasks[i].object];
    if (solves_chains(object.sweep)) constraints += static_cast<double>(object.lengths[tasks[i].item].constraints);
    for (const FoundLength& one : found[i]) all.push_back(one.value);
  }
  const auto beyond = static_cast<std::size_t>(by.share_beyond * constraints);
  if (all.size() <= beyond) return least;
  const auto place = all.begin() + static_cast<std::ptrdiff_t>(beyond);
  std::nth_element(all.begin(), place, all.end(), std::greater<>());
  return static_cast<double>(*place);
}

/// Calls body(object) for the objects of a group that have not been removed.
template <class Body>
void for_present(const Substep& s, const Body& body) {
  for_objects(s, [&](int o) {
    if (s.model.objects[o].particles > 0) body(o);
  });
}

/// The substeps per frame of the last quarter; 0 before the first one.
double substeps_before(const Substep& s) {
  float before = 0;
  for_present(s, [&](int o) { before = std::max(before, s.state.substeps[o]); });
  return static_cast<double>(before);
}

/// The largest demand of the present strain and motion, and of the impacts that the quarter will bring.
double demanded(Substep& s, int least) {
  const Demand now{s.state.velocities.data(), s.hangs ? substeps_per_strain_hanging : substeps_per_strain,
                   s.hangs ? substeps_per_radian / 2 : substeps_per_radian, share_beyond};
  const double by_state = demanded(s, now, least);
  const Record* after = velocities_after_impacts(s, s.dt / quarters);
  if (after == nullptr) return by_state;
  return std::max(by_state, demanded(s, {after, 0, substeps_per_radian, share_beyond_of_impact}, least));
}

/// The whole number of substeps that a quarter has.
int in_quarter(const Substep& s, double substeps) {
  return std::clamp(static_cast<int>(std::ceil(substeps / quarters)), 1, std::max(1, s.most / quarters));
}

void begin_quarter_with(Substep& s, double substeps, double before) {
  const int quarter = s.number * quarters / s.planned;
  const int number = in_quarter(s, substeps);
  // Not where the number only fluctuates, as at rest: the guard would hold back what bending energy lifts.
  s.is_guarded = before > 0 && 4 * number > 5 * in_quarter(s, before);
  s.substeps_before = before;
  s.planned = s.substeps = quarters * number;
  s.number = quarter * number;
  s.h = static_cast<float>(s.dt / s.planned);
  for_present(s, [&](int o) {
    // The end of a quarter has put all gravity into the velocities, as the end of a frame does.
    s.work.gravity[o] = {0, static_cast<double>(s.h), 0, velocity_kept(s.h, s.model.objects[o].damping)};
    s.work.last_h[o] = s.h;
    s.state.substeps[o] = static_cast<float>(substeps);
  });
}

/// True if all objects of the group hang by tethers that hold, and meet no surface.
bool hangs(const Substep& s) {
  bool all = s.least_hanging > 0 && !s.has_pairs();
  for_present(
      s, [&](int o) { all = all && tethers_hold(s.model.objects[o], s.state.positions.data() + s.model.first[o]); });
  return all;
}

}  // namespace

void begin_quarter(Substep& s) {
  if (s.most == 0 || s.number == s.substeps || s.number * quarters % s.planned != 0) return;
  s.state.substeps.resize(s.model.objects.size());
  s.hangs = hangs(s);
  const int least = std::min(s.hangs ? s.least_hanging : s.least, s.most);
  const double before = substeps_before(s), guess = s.hangs ? first_of_hanging : first_substeps;
  const double wanted = std::max(demanded(s, least), (before > 0 ? before : guess) * slowest_decrease);
  begin_quarter_with(s, std::clamp(wanted, double(least), double(s.most)), before);
}

void leave_quarter(Substep& s) {
  if (!s.is_guarded || s.number * quarters % s.planned == 0) return;
  s.state.substeps.resize(s.model.objects.size());
  for_present(s, [&](int o) { s.state.substeps[o] = static_cast<float>(s.substeps_before); });
}

void forget_substeps(Substep& s) {
  if (s.most > 0 || s.state.substeps.empty()) return;
  // As in a quarter with more substeps than the last one: what has come near has made them more.
  const double before = substeps_before(s);
  s.is_guarded = before > 0 && 4 * s.planned > 5 * before;
  s.substeps_before = before;
  for_objects(s, [&](int o) { s.state.substeps[o] = 0; });
  const auto is_zero = [](float substeps) { return substeps == 0; };
  if (std::all_of(s.state.substeps.begin(), s.state.substeps.end(), is_zero)) s.state.substeps.clear();
}

}  // namespace pliant
