#include "collision/near/near_lists.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace pliant {

namespace {

constexpr int lists_in_a_task = 64;
/// The skin of a list, over the radius minus the thickness: trades longer lists against fewer searches.
constexpr float skin_share = 1.5f;
/// Clearances are queried up to most_skins beyond the activation distance, and pay from fewest_skins on.
constexpr float most_skins = 1.25f, fewest_skins = 0.2f;

/// The largest separation of two boxes along any axis.
float distance_between(const BoxBounds& a, const BoxBounds& b) {
  const Vec3f apart = max(a.low - b.high, b.low - a.high);
  return max(max(apart.x, apart.y), apart.z);
}

Neighbourhood make_neighbourhood(const PairModel& model, const PairKernels& kernels, std::vector<Clearance::Line>& joined) {
  Neighbourhood near{
      model, kernels, lay_out_clusters(model), ClusterMotions(kernels, model.clusters), ClusterPairs(model), {}, {}, {}};
  near.static_pairs = find_static_pairs(model, near.layout, joined);
  return near;
}

/// The order of near lists: kind, then clusters. An added or removed list does not change the order of contacts.
auto key_of(const ClusterSides& sides) { return std::make_tuple(!sides.of_vertices, sides.first, sides.second); }

/// The sides of all near lists, ascending by key_of.
std::vector<ClusterSides> sides_of(const Neighbourhood& near) {
  std::vector<ClusterSides> all;
  const auto add = [&](bool of_vertices, int first, int second, int pair) {
    if (near.layout.elements[row_kind(of_vertices)].count[first] == 0 ||
        near.layout.elements[column_kind(of_vertices)].count[second] == 0)
      return;
    ClusterSides sides;
    sides.first = first;
    sides.second = second;
    sides.of_vertices = of_vertices;
    sides.pair = pair;
    all.push_back(sides);
  };
  const std::vector<ClusterPair>& pairs = near.pairs.pairs();
  for (int i = 0; i < static_cast<int>(pairs.size()); ++i) {
    const auto [a, b] = std::make_pair(pairs[i].a, pairs[i].b);
    add(true, a, b, i);
    if (a != b) add(true, b, a, i);
    add(false, a, b, i);
  }
  std::sort(all.begin(), all.end(), [](const ClusterSides& x, const ClusterSides& y) { return key_of(x) < key_of(y); });
  return all;
}

}  // namespace

NearLists::NearLists(const PairModel& model, const PairKernels& kernels) : NearLists(model, kernels, {}) {}

NearLists::NearLists(const PairModel& model, const PairKernels& kernels, std::vector<Clearance::Line> joined)
    : near_(make_neighbourhood(model, kernels, joined)),
      clearance_(Clearance(clearance_pieces(model, near_.layout), model.rest, joined), model.clusters),
      search_(model, kernels, near_.layout) {}

float NearLists::skin() const { return skin_share * (near_.model.radius - near_.model.largest_thickness); }

bool NearLists::measure(Executor& executor, const PairParticles& particles) {
  const bool is_bounded = near_.motions.measure(executor, near_.layout, particles);
  if (!is_bounded) is_listed_ = false;
  near_.pairs.measure(near_.motions);
  return is_bounded;
}

void NearLists::advance() {
  near_.motions.advance();
  near_.pairs.advance();
}

void NearLists::update(Executor& executor, const PairParticles& particles) {
  if (is_listed_ && near_.motions.has_gone_far()) is_listed_ = false;
  if (!is_listed_ || !near_.motions.stay_within(near_.pairs.travel())) pair_clusters();
  find_stale();
  const auto is_stale = [](const Scratch& scratch) { return !scratch.stale.empty(); };
  if (std::none_of(scratch_.begin(), scratch_.end(), is_stale)) return;
  drop_clear(executor, particles);
  for (const Scratch& scratch : scratch_)
    for (const std::int32_t list : scratch.stale) search_.want(near_.lists[list]);
  search_.fit(executor, near_.motions, particles);
  executor.parallel_for("list pairs", static_cast<int>(scratch_.size()), [&](int task) {
    for (const std::int32_t list : scratch_[task].stale) refresh(near_.lists[list], scratch_[task].search, particles);
  });
  candidates_ = near_.static_pairs.count;
  for (const NearList& list : near_.lists) candidates_ += static_cast<std::int64_t>(list.pairs.size());
}

// ---------------------------------------------------------------- pairs of clusters

void NearLists::pair_clusters() {
  const std::vector<ClusterPair> old = near_.pairs.pairs();
  near_.pairs.find(near_.motions, near_.static_pairs.groups);
  carry_groups(old);
  make_lists(old);
  cut_into_tasks();
  near_.motions.begin_travel();
  if (!is_listed_) near_.motions.keep_extents();
  is_listed_ = true;
  ++rebuilds_;
}

/// Static groups keep their bounds, less the odometers' counts, unless forget() was called.
void NearLists::carry_groups(const std::vector<ClusterPair>& old) {
  for (StaticGroup& group : near_.static_pairs.groups) {
    if (is_listed_) group.least.since -= old[group.pair].odometer.total;
    if (!is_listed_) group.least.value = not_measured;
    group.pair = near_.pairs.number_of(group.first, group.second);
  }
  if (!is_listed_) std::fill(near_.static_pairs.value.begin(), near_.static_pairs.value.end(), not_measured);
}

/// Keeps the lists of pairs that stay near, unless forget() was called.
void NearLists::make_lists(const std::vector<ClusterPair>& old) {
  std::vector<NearList> before = std::move(near_.lists);
  near_.lists.clear();
  std::size_t next = 0;
  for (const ClusterSides& sides : sides_of(near_)) {
    NearList list;
    static_cast<ClusterSides&>(list) = sides;
    while (next < before.size() && key_of(before[next]) < key_of(sides)) ++next;
    if (is_listed_ && next < before.size() && key_of(before[next]) == key_of(sides)) {
      NearList& same = before[next];
      const float counted = old[same.pair].odometer.total;
      same.pair = sides.pair;
      same.complete.since -= counted;
      same.least.since -= counted;
      list = std::move(same);
    }
    near_.lists.push_back(std::move(list));
  }
}

void NearLists::cut_into_tasks() {
  const auto pieces = [](std::size_t size, int of) { return (static_cast<int>(size) + of - 1) / of; };
  const int lists = static_cast<int>(near_.lists.size()), groups = static_cast<int>(near_.static_pairs.groups.size()),
            tasks = pieces(near_.lists.size(), lists_in_a_task),
            share = std::max(1, pieces(near_.static_pairs.groups.size(), std::max(1, tasks)));
  near_.tasks.resize(static_cast<std::size_t>(tasks));
  scratch_.resize(near_.tasks.size());
  for (int task = 0; task < tasks; ++task)
    near_.tasks[task] = {task * lists_in_a_task, std::min(lists, (task + 1) * lists_in_a_task),
                         std::min(groups, task * share), std::min(groups, (task + 1) * share)};
}

// ---------------------------------------------------------------- which lists are due

void NearLists::find_stale() {
  for (std::size_t task = 0; task < near_.tasks.size(); ++task) {
    std::vector<std::int32_t>& stale = scratch_[task].stale;
    stale.clear();
    for (int i = near_.tasks[task].first; i < near_.tasks[task].last; ++i)
      if (const NearList& list = near_.lists[i]; !list.complete.lasts(near_.odometer(list))) stale.push_back(i);
  }
}

/// Drops stale lists whose clearance exceeds the activation distance; they stay empty until it is exhausted.
void NearLists::drop_clear(Executor& executor, const PairParticles& particles) {
  clearance_.begin(near_.pairs.pairs().size());
  for (const Scratch& scratch : scratch_)
    for (const std::int32_t number : scratch.stale)
      if (const NearList& list = near_.lists[number]; near_.pair_of(list).is_joined)
        clearance_.ask(list, activation_distance(near_, list) + most_skins * skin());
  clearance_.answer(executor, near_.kernels, particles.positions);
  for (Scratch& scratch : scratch_) {
    const auto is_clear_now = [&](std::int32_t number) { return is_clear(near_.lists[number]); };
    scratch.stale.erase(std::remove_if(scratch.stale.begin(), scratch.stale.end(), is_clear_now), scratch.stale.end());
  }
}

/// Uses vertex distances within a surface, and swept boxes otherwise.
bool NearLists::is_clear(NearList& list) const {
  const ClusterPair& pair = near_.pair_of(list);
  const float clearance = clearance_.of(list);
  const bool is_asked = clearance >= 0;
  const float apart = is_asked ? clearance
                               : distance_between(near_.motions.path_box(list.first), near_.motions.path_box(list.second)) *
                                     (1 - 1e-5f),
              least = is_asked ? max(fewest_skins * skin(), 1.1f * pair.odometer.next) : skin() * bound_slack,
              room = apart - activation_distance(near_, list);
  if (!(room > least)) return false;
  list.clear(pair.odometer);
  list.complete = {room, pair.odometer.total};
  return true;
}

// ---------------------------------------------------------------- how lists are made

/// Lists pairs whose paths come near in this substep or can before the odometer has counted the skin. Fast pairs get a list
/// for one substep; their motion is not limited.
void NearLists::refresh(NearList& list, BoxSearch::Scratch& scratch, const PairParticles& particles) {
  const Odometer& odometer = near_.odometer(list);
  if (is_too_far(near_, list)) {  // rechecked in the next substep
    list.clear(odometer);
    list.complete = {-1, odometer.total};
    return;
  }
  const float activation = activation_distance(near_, list), margin = skin() * bound_slack;
  const bool is_fast = 1.1f * odometer.next > skin();
  list.clear(odometer);
  list.complete = {is_fast ? -1 : skin(), odometer.total};
  const float reach = is_fast ? activation : activation + margin;
  search_.find(list, near_.motions.path_box(list.second).grown(reach), reach, scratch);
  keep_near(list, activation + max(margin, 1.1f * odometer.next), scratch, particles);
}

/// Measures the pairs found and keeps those nearer than `within`.
void NearLists::keep_near(NearList& list, float within, BoxSearch::Scratch& scratch, const PairParticles& particles) const {
  std::vector<NearPair>& found = scratch.found;
  scratch.value.clear();
  std::size_t kept = 0;
  PairLanes lanes;
  const float spent = list.least.spent(near_.odometer(list));
  for (std::size_t i = 0; i < found.size(); i += 16) {
    const std::size_t count = std::min<std::size_t>(16, found.size() - i);
    for (std::size_t lane = 0; lane < 16; ++lane) lanes.set(lane, found[i + (lane < count ? lane : 0)].vertex);
    near_.kernels.distances(lanes.stencils, list.of_vertices ? 1 : 2, particles.positions, lanes.at);
    for (std::size_t lane = 0; lane < count; ++lane) {
      const float value = (lanes.at.at_least[lane] + spent) * sum_slack;
      if (value > within) continue;
      list.least.value = min(list.least.value, value);
      found[kept++] = found[i + lane];
      scratch.value.push_back(value);
    }
  }
  // Exact-size copies: the growth capacity of vectors would nearly double the memory of contact.
  list.pairs = std::vector<NearPair>(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(kept));
  list.value = std::vector<float>(scratch.value);
}

}  // namespace pliant
