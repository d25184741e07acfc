// Solves chains again where surfaces press on one another or on rigid bodies.
//
// Contacts are projected after the chains, so where they conflict contacts win, and edges end too long: in jammed or
// pinched cloth one in a hundred by 3 %, however many iterations follow, because both cannot be met exactly. So chains
// and contacts take turns once more, and contacts yield: they may overlap by a share of their thickness, which nobody
// sees, while an edge that is too long is seen. The filter still keeps surfaces from crossing. What is far heavier than
// the cloth that it lies on, such as stones, would be overrun by it in this way, so its contacts do not yield.
//
// Rigid stitches are projected before the chains, too, which then pull sewn particles apart: in a substep by T h^2 / m,
// T being the tension beside the seam, so cloth that is too tight round a body gapes. Closing a stitch alone would
// leave that error in the edges beside it, and the chains would take most of it back, since a row of n particles weighs
// n times as much as its last one. So both take turns, and Aitken's relaxation of the interface (Irons and Tuck 1969)
// takes the chains' share from how the gaps have changed.
#include "solver/stages/solve_again.h"

#include <algorithm>
#include <cstdio>

#include "constraints/distance_limit.h"
#include "constraints/registry.h"
#include "core/at.h"
#include "solver/bodies/body_solver.h"
#include "solver/drivers/contacts.h"
#include "solver/drivers/driver.h"
#include "solver/momentum.h"
#include "solver/object_lookup.h"
#include "solver/stages/stages.h"

namespace pliant {

namespace {

/// Marks the objects solved by chains whose surface an active contact touches. False if there are none.
bool find_pressed(const Substep& s, std::vector<char>& is_pressed) {
  is_pressed.assign(s.model.objects.size(), 0);
  bool any = false;
  ObjectLookup objects(s.model);
  const auto mark = [&](const std::vector<Contact>& contacts) {
    for (const Contact& contact : contacts) {
      if (!(contact.push > 0)) continue;
      for (std::size_t i = 0; i < contact.point.size(); ++i) {
        if (contact.weight[i] == 0) continue;
        const int object = objects.of(contact.point[i]);
        if (!solves_chains(s.model.objects[object].sweep)) continue;
        is_pressed[object] = 1;
        any = true;
      }
    }
  };
  if (s.has_pairs()) mark(s.pairs->contacts());
  if (s.bodies != nullptr) mark(s.bodies->point_contacts());
  return any;
}

void solve_chains(Substep& s, const std::vector<char>& of) {
  note_momentum(s, Since::note, &of);
  if (s.bodies != nullptr) s.bodies->find_loads(s);
  for (const auto& [sweep, group] : s.work.sweeps) {
    if (!solves_chains(sweep)) continue;
    s.group = &group;
    walk(s, Driver::chain, {false, Order::forward, 0, &of});
  }
  s.group = nullptr;
  conserve_momentum(s, Since::note, &of);
}

}  // namespace

void solve_again(Substep& s) {
  if ((!s.has_pairs() && s.bodies == nullptr) || s.lengths().empty() || !(s.context.options.most_overstretch > 0))
    return;
  std::vector<char>& is_pressed = s.own->limit.is_moved;
  if (!find_pressed(s, is_pressed)) return;
  constexpr int rounds = 2;  // of chains and contacts
  for (int round = 0; round < rounds; ++round) {
    solve_chains(s, is_pressed);
    project_contacts_of(s, "solve: contacts among surfaces", is_pressed, overlap_left);
  }
}

namespace {

constexpr int most_turns = 12;
/// An object has no further turn when its stitches are open by no more than this share of its mean distance.
constexpr float open_over_edge = 0.01f;
/// What is left of a gap of no more than this share is closed at last, without the chains. It stretches the edges
/// beside it by half as much.
constexpr float closed_over_edge = 0.2f;
constexpr float least_relaxation = 0.5f, most_relaxation = 16;
constexpr double tolerated_stitch_gap = 1e-3;  // [m]

/// A rigid thread between two particles in storage order, and the distance that it allows [m].
struct Stitch {
  int from = 0, to = 0;
  float allowed = 0;
};

/// Appends the stitches of a group of constraints: its distance limits without compliance. Where the surface collides
/// with itself, contact keeps both sides apart by two thicknesses.
void append_stitches(const CompiledObject& object, const ScaledGroup& group, std::vector<Stitch>& out) {
  static const int limit_type = find_constraint_type(DistanceLimit::name);
  if (group.places.empty() || object.pools[at(group.places.front().pool)].type != limit_type)
    return;  // all are of a type
  const float least = object.self_collision ? 2 * object.thickness : 0;
  std::size_t s = 0;  // places and segments are in the same order within a pool
  for (const ScaledGroup::Place& place : group.places) {
    const Pool& pool = object.pools[at(place.pool)];
    if (pool.law == Law::pbd || pool.row(pool.fields, place.batch)[place.lane] > 0) continue;
    const auto has = [&](const Segment& segment) {
      return segment.pool == place.pool && place.batch >= segment.first_batch &&
             place.batch < segment.first_batch + segment.batches;
    };
    for (std::size_t tried = 0; tried < object.segments.size() && !has(object.segments[s]); ++tried)
      s = (s + 1) % object.segments.size();
    const Segment& segment = object.segments[s];
    const std::int32_t* index = pool.indices.data() + segment.index_offset +
                                (place.batch - segment.first_batch) * indices_per_batch(pool, segment);
    out.push_back({particle_of(segment, index, 0, place.lane), particle_of(segment, index, 1, place.lane),
                   std::max(pool.row(0, place.batch)[place.lane], least)});
  }
}

/// A mean of the rest lengths of an object's distances, from some of each of its ranges; 0 without any [m].
float typical_length(const CompiledObject& object) {
  constexpr int most_batches = 16;
  float sum = 0, count = 0;
  for (const LengthRange& range : object.lengths) {
    int left = most_batches;
    for (int number = range.first; number < range.last; ++number) {
      const Segment& segment = object.segments[at(number)];
      const Pool& pool = object.pools[at(segment.pool)];
      for (int b = 0; pool.is_length && b < segment.batches && left > 0; ++b, --left) {
        const float* rest = pool.row(0, std::int64_t{segment.first_batch} + b);
        for (int lane = 0; lane < batch_width; ++lane) sum += rest[lane];  // lanes of padding repeat one of the batch
        count += batch_width;
      }
    }
  }
  return count > 0 ? sum / count : 0;
}

/// An object with stitches in one substep.
struct Sewn {
  int object = 0;
  float edge = 0;        ///< typical_length()
  float relaxation = 1;  ///< factor of the closing displacements
  std::vector<Stitch> stitches{};
  std::vector<Vec3f> gaps{};  ///< before they were closed last [m]
};

std::vector<Sewn> sewn_objects(const Substep& s) {
  std::vector<Sewn> all;
  for_objects(s, [&](int o) {
    const CompiledObject& object = s.model.objects[o];
    if (object.changing.scaled.empty() || !solves_chains(object.sweep)) return;
    Sewn sewn{o};
    for (const ScaledGroup& group : object.changing.scaled) append_stitches(object, group, sewn.stitches);
    if (sewn.stitches.empty()) return;
    sewn.edge = typical_length(object);
    sewn.gaps.resize(sewn.stitches.size());
    all.push_back(std::move(sewn));
  });
  return all;
}

/// The vector between two particles less the distance that is allowed [m]; zero if they are no farther apart.
Vec3f excess_of(const Vec3f& across, float allowed) {
  const float distance = length(across);
  return distance > allowed ? across * (1 - allowed / distance) : Vec3f{};
}

Vec3f gap_now(const Substep& s, int object, const Stitch& stitch) {
  const int from = s.model.first[object] + stitch.from, to = s.model.first[object] + stitch.to;
  const Record &p = s.state.positions[from], &q = s.state.positions[to];
  const Record &d = s.work.displacements[from], &e = s.work.displacements[to];
  return excess_of({(q.x - p.x) + (e.x - d.x), (q.y - p.y) + (e.y - d.y), (q.z - p.z) + (e.z - d.z)}, stitch.allowed);
}

/// Moves sewn particles towards one another by `by` in all, by their inverse masses.
void pull_together(Substep& s, int object, const Stitch& stitch, const Vec3f& by) {
  const int from = s.model.first[object] + stitch.from, to = s.model.first[object] + stitch.to;
  Record &d = s.work.displacements[from], &e = s.work.displacements[to];
  const float w = s.state.positions[from].w, v = s.state.positions[to].w;
  if (!(w + v > 0)) return;
  const Vec3f first = by * (w / (w + v)), second = by * (v / (w + v));
  d = {d.x + first.x, d.y + first.y, d.z + first.z, 0};
  e = {e.x - second.x, e.y - second.y, e.z - second.z, 0};
}

/// Pulls the stitches of an object together, by no more than an edge each: others cannot be reached.
void pull_stitches(Substep& s, const Sewn& sewn) {
  for (const Stitch& stitch : sewn.stitches) {
    const Vec3f gap = gap_now(s, sewn.object, stitch);
    const float wanted = sewn.relaxation * length(gap);
    if (wanted > 0) pull_together(s, sewn.object, stitch, gap * (sewn.relaxation * std::min(1.f, sewn.edge / wanted)));
  }
}

/// Notes the gaps of an object. True if one is open too far; then the relaxation follows from how they have changed
/// since the last turn.
bool note_gaps(const Substep& s, int turn, Sewn& sewn) {
  double along = 0, squared = 0;
  bool is_open = false;
  for (std::size_t i = 0; i < sewn.stitches.size(); ++i) {
    const Vec3f now = gap_now(s, sewn.object, sewn.stitches[i]), by = now - sewn.gaps[i];
    along += static_cast<double>(dot(sewn.gaps[i], by));
    squared += static_cast<double>(dot(by, by));
    is_open = is_open || length(now) > open_over_edge * sewn.edge;
    sewn.gaps[i] = now;
  }
  if (!is_open || turn == 0 || !(squared > 0)) return is_open;
  const double wanted = -static_cast<double>(sewn.relaxation) * along / squared;
  sewn.relaxation = static_cast<float>(std::clamp(wanted, double(least_relaxation), double(most_relaxation)));
  return true;
}

/// Closes what the last turn has left, where that stretches the edges beside it by little.
void close_rest(Substep& s, const Sewn& sewn) {
  for (const Stitch& stitch : sewn.stitches) {
    const Vec3f gap = gap_now(s, sewn.object, stitch);
    if (length(gap) <= closed_over_edge * sewn.edge) pull_together(s, sewn.object, stitch, gap);
  }
}

std::string words_of_stitch(const CompiledObject& object, const Stitch& stitch, double gap) {
  const auto [first, second] = std::minmax(object.order[at(stitch.from)], object.order[at(stitch.to)]);
  char open[32];
  std::snprintf(open, sizeof open, "%.3g", 1000 * gap);
  return "object '" + object.name + "': the stitch of particles " + std::to_string(first) + " and " +
         std::to_string(second) + " is open by " + open +
         " mm; what it joins is held, too small or in the way of a collider: free or enlarge it, give the stitch a "
         "compliance, or "
         "use more substeps";
}

}  // namespace

void close_stitches(Substep& s) {
  std::vector<Sewn> all = sewn_objects(s);
  if (all.empty()) return;
  std::vector<char>& is_open = s.own->limit.is_moved;
  is_open.assign(s.model.objects.size(), 0);
  for (int turn = 0; turn < most_turns; ++turn) {
    bool any = false;
    for (Sewn& sewn : all) {
      is_open[at(sewn.object)] = note_gaps(s, turn, sewn) ? 1 : 0;
      any = any || is_open[at(sewn.object)] != 0;
      if (is_open[at(sewn.object)] != 0) pull_stitches(s, sewn);
    }
    if (!any) break;
    solve_chains(s, is_open);
    project_contacts_of(s, "solve: contacts among surfaces", is_open, overlap_left);
  }
  for (const Sewn& sewn : all) close_rest(s, sewn);
}

void warn_of_stitches(const Model& model, const State& state, std::vector<std::string>& warnings) {
  for (std::size_t o = 0; o < model.objects.size(); ++o) {
    const CompiledObject& object = model.objects[o];
    std::vector<Stitch> stitches;
    for (const ScaledGroup& group : object.changing.scaled)
      if (!(group.keyframes.back().factor < group.now)) append_stitches(object, group, stitches);
    const Record* positions = state.positions.data() + model.first[o];
    const Stitch* widest = nullptr;
    double largest = tolerated_stitch_gap;
    for (const Stitch& stitch : stitches) {
      const Record &p = positions[stitch.from], &q = positions[stitch.to];
      const double gap = static_cast<double>(length(excess_of({q.x - p.x, q.y - p.y, q.z - p.z}, stitch.allowed)));
      if (!(gap > largest)) continue;
      largest = gap;
      widest = &stitch;
    }
    if (widest != nullptr) warnings.push_back(words_of_stitch(object, *widest, largest));
  }
}

}  // namespace pliant
