// The limit of overstretch: what an iteration of chains or multigrid leaves too long is shortened constraint by
// constraint.
//
// Contacts move particles after the springs were solved, so single edges end far too long where cloth meets an
// obstacle. They are few. These sweeps leave the rest within a few percent, so a sequential pass over those few is
// enough.
#include <algorithm>

#include "solver/drivers/contacts.h"
#include "solver/momentum.h"
#include "solver/stages/solve_again.h"
#include "solver/stages/stages.h"

namespace pliant {

namespace {

constexpr int first_rounds = 2;  ///< of search, passes and contacts
/// An object has further rounds, up to these, while a shortened constraint exceeds the limit by half. A point that
/// bears much of a sheet, such as the corner of a box, needs them: its contact undoes much of each round.
constexpr int most_limit_rounds = 8;
constexpr float tolerated = 1.5f;
/// If more constraints of an object are too long than these, and than this share, the cloth is pulled as a whole.
/// Shortening one constraint after another would take long and achieve nothing.
constexpr double most_share_at_once = 0.05, most_at_once = 500;
constexpr int passes_a_round = 6;  ///< over the list of a round, alternately forward and backward

Vec3f across(const LimitedLength& pair, const Record* positions, const Record* displacements) {
  const Record &p = positions[pair.from], &q = positions[pair.to];
  const Record &d = displacements[pair.from], &e = displacements[pair.to];
  return {(q.x - p.x) + (e.x - d.x), (q.y - p.y) + (e.y - d.y), (q.z - p.z) + (e.z - d.z)};
}

/// Finds the constraints that are too long in the objects with is_searched. False if there are none, or too many in
/// each.
bool find_all(Substep& s, LimitScratch& scratch) {
  const std::vector<Task>& tasks = s.lengths();
  if (scratch.found.size() < tasks.size()) scratch.found.resize(tasks.size());
  for_tasks(s, "limit: search", static_cast<int>(tasks.size()), [&](int i) {
    const int object = tasks[i].object;
    const SweepArguments a = arguments(s, object, false);
    scratch.found[i].clear();
    if (scratch.is_searched[object] == 0) return;
    find_long(s.model.objects[object], s.model.objects[object].lengths[tasks[i].item], s.kernels.lengths,
              {a.positions, a.displacements, a.multipliers, a.inverse_h2, s.context.options.most_overstretch},
              scratch.found[i]);
  });
  scratch.is_moved.assign(s.model.objects.size(), 0);
  bool any = false;
  for (std::size_t first = 0, last = 0; first < tasks.size(); first = last) {
    double constraints = 0, too_long = 0;
    for (; last < tasks.size() && tasks[last].object == tasks[first].object; ++last) {
      constraints += static_cast<double>(s.model.objects[tasks[last].object].lengths[tasks[last].item].constraints);
      too_long += static_cast<double>(scratch.found[last].size());
    }
    const bool is_limited = too_long > 0 && too_long <= std::max(most_at_once, most_share_at_once * constraints);
    scratch.is_moved[tasks[first].object] = is_limited ? 1 : 0;
    any = any || is_limited;
  }
  return any;
}

/// The constraint as a pair of particles and the length that it may have: never less than its rest length.
LimitedLength limited(const Substep& s, int number, const FoundLength& found) {
  const CompiledObject& object = s.model.objects[number];
  const Segment& segment = object.segments[found.segment];
  const float rest = object.pools[segment.pool].row(0, std::int64_t{segment.first_batch} + found.batch)[found.lane];
  const auto [from, to] = ends_of(object, found);
  LimitedLength pair{s.model.first[number] + from, s.model.first[number] + to};
  const float now = length(across(pair, s.state.positions.data(), s.work.displacements.data()));
  const float most = s.context.options.most_overstretch;
  pair.longest = std::max(rest, now - (found.value - most) * rest);
  pair.tolerated = pair.longest + (tolerated - 1) * most * rest;
  return pair;
}

void list_all(const Substep& s, LimitScratch& scratch) {
  scratch.limited.clear();
  for (std::size_t i = 0; i < s.lengths().size(); ++i) {
    const int object = s.lengths()[i].object;
    if (scratch.is_moved[object] == 0) continue;
    for (const FoundLength& found : scratch.found[i]) scratch.limited.push_back(limited(s, object, found));
  }
}

/// Shortens a pair of particles to its longest length, by their inverse masses.
void shorten(const LimitedLength& pair, const Record* positions, Record* displacements) {
  const Record &p = positions[pair.from], &q = positions[pair.to];
  Record &d = displacements[pair.from], &e = displacements[pair.to];
  const Vec3f way = across(pair, positions, displacements);
  const float now = length(way);
  if (!(now > pair.longest)) return;
  const Vec3f by = way * ((now - pair.longest) / (now * (p.w + q.w)));
  d = {d.x + by.x * p.w, d.y + by.y * p.w, d.z + by.z * p.w, 0};
  e = {e.x - by.x * q.w, e.y - by.y * q.w, e.z - by.z * q.w, 0};
}

void shorten_all(Substep& s, const std::vector<LimitedLength>& limited) {
  const Stopwatch watch(s.context.executor.timings(), "limit");
  const Record* positions = s.state.positions.data();
  Record* displacements = s.work.displacements.data();
  for (int pass = 0; pass < passes_a_round; ++pass) {
    if (pass % 2 == 0)
      for (const LimitedLength& pair : limited) shorten(pair, positions, displacements);
    else
      for (std::size_t i = limited.size(); i-- > 0;) shorten(limited[i], positions, displacements);
  }
}

/// Decides which objects a round searches: all in the first rounds, then those whose shortened pairs are still longer
/// than tolerated. Others are not searched again, which would cost more than the passes. False if there are none.
bool choose_searched(const Substep& s, int round, LimitScratch& scratch) {
  scratch.is_searched.assign(s.model.objects.size(), round < first_rounds ? 1 : 0);
  if (round < first_rounds) return true;
  bool any = false;
  for (const LimitedLength& pair : scratch.limited) {
    if (!(length(across(pair, s.state.positions.data(), s.work.displacements.data())) > pair.tolerated)) continue;
    scratch.is_searched[s.model.object_of(pair.from)] = 1;
    any = true;
  }
  return any;
}

}  // namespace

void limit(Substep& s) {
  LimitScratch& scratch = s.own->limit;
  if (s.lengths().empty() || !(s.context.options.most_overstretch > 0)) return;
  for (int round = 0; round < most_limit_rounds && choose_searched(s, round, scratch) && find_all(s, scratch);
       ++round) {
    list_all(s, scratch);
    note_momentum(s, Since::note, &scratch.is_moved);
    shorten_all(s, scratch.limited);
    conserve_momentum(s, Since::note, &scratch.is_moved);
    project_contacts_of(s, "limit: contacts", scratch.is_moved, overlap_left);
  }
}

}  // namespace pliant
