#include "collision/near/near_lists.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "collision/near/near_order.h"

namespace pliant {

namespace {

constexpr int lists_in_a_task = 64;
/// The skin of a list, over the search radius minus the thickness. A larger skin makes longer lists, but fewer
/// searches.
constexpr float skin_share = 1.5f;
/// In skins: clearances are queried up to this far beyond the activation distance; smaller ones than this do not pay.
constexpr float most_skins = 1.25f, fewest_skins = 0.2f;

/// The largest separation of two boxes along a coordinate axis; negative if they overlap.
float distance_between(const BoxBounds& a, const BoxBounds& b) {
  const Vec3f apart = max(a.low - b.high, b.low - a.high);
  return max(max(apart.x, apart.y), apart.z);
}

/// The intervals of distance by which the pairs of a list are sorted.
constexpr int intervals = 32;

/// Sets the number of pairs of an empty list. Sizes are exact where they grow: the growth capacity of vectors would
/// nearly double the memory of contact.
void make_blocks(NearList& list, std::size_t pairs) {
  const std::size_t blocks = (pairs + 15) / 16;
  list.pairs = static_cast<int>(pairs);
  if (blocks > list.blocks.capacity() || 2 * blocks < list.blocks.capacity())
    list.blocks = AlignedVector<NearBlock>(blocks);
  else
    list.blocks.resize(blocks);
  list.value.assign(blocks, out_of_reach);
}

void copy(const PairStencils& from, std::size_t lane, std::int32_t rank, NearBlock& to, std::size_t at) {
  for (std::size_t k = 0; k < 4; ++k) to.stencils.vertex[k][at] = from.vertex[k][lane];
  to.kept[at] = -1;
  to.rank[at] = rank;
}

}  // namespace

NearLists::NearLists(const PairModel& model, const PairKernels& kernels)
    : near_(model, kernels), search_(model, kernels, near_.layout) {
  std::vector<int> bodies;
  for (const auto& [body, elements] : model.bodies)
    if (elements.clusters.size > 0) bodies.push_back(body);
  resize();
  add(bodies);
}

float NearLists::skin() const { return skin_share * (near_.model.radius - near_.model.largest_thickness); }

bool NearLists::measure(Executor& executor, const PairParticles& particles) {
  const bool is_bounded = near_.motions.measure(executor, near_.layout, near_.model.cluster_order, particles);
  if (!is_bounded) is_listed_ = false;
  near_.pairs.measure(near_.motions);
  return is_bounded;
}

void NearLists::advance() {
  near_.motions.advance(near_.model.cluster_order);
  near_.pairs.advance();
}

void NearLists::update(Executor& executor, const PairParticles& particles) {
  for (const int cluster : new_clusters_) near_.motions.keep_extent(cluster);
  if (is_listed_ && near_.motions.has_gone_far()) is_listed_ = false;
  if (!is_listed_ || must_pair_ || !near_.motions.stay_within(near_.pairs.travel(), near_.model.cluster_order)) {
    pair_clusters();
  } else if (!new_clusters_.empty()) {
    pair_new_clusters();
  }
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
  listed_ = 0;
  for (const std::int32_t list : near_.order) listed_ += near_.lists[list].pairs;
}

// ---------------------------------------------------------------- pairs of clusters

void NearLists::pair_clusters() {
  const std::vector<ClusterPair> old = near_.pairs.pairs();
  carry_groups(old, near_.pairs.find(near_.motions, near_.static_pairs.groups));
  make_lists(old);
  cut_into_tasks();
  near_.motions.begin_travel();
  if (!is_listed_) near_.motions.keep_extents();
  is_listed_ = true;
  must_pair_ = false;
  new_clusters_.clear();
  ++rebuilds_;
}

/// Attaches static groups to the new cluster pairs. Their bounds stay valid, unless forget() was called.
void NearLists::carry_groups(const std::vector<ClusterPair>& old, const std::vector<int>& pairs) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    StaticGroup& group = near_.static_pairs.groups[i];
    if (!is_listed_) group.forget();
    if (is_listed_ && group.pair >= 0) group.least.since -= old[group.pair].odometer.total;
    group.pair = pairs[i];
  }
}

/// Makes a list for each side of the new cluster pairs. Lists of pairs that stay near are kept, unless forget() was
/// called.
void NearLists::make_lists(const std::vector<ClusterPair>& old) {
  std::vector<NearList> before;
  before.reserve(near_.order.size());
  for (const std::int32_t list : near_.order) before.push_back(std::move(near_.lists[list]));
  near_.lists.clear();
  unused_lists_.clear();
  std::size_t next = 0;
  for (const ClusterSides& sides : sides_of(near_, near_.pairs.numbers())) {
    NearList list;
    static_cast<ClusterSides&>(list) = sides;
    while (next < before.size() && is_before(near_.model, before[next], sides)) ++next;
    if (is_listed_ && next < before.size() && !is_before(near_.model, sides, before[next])) {
      NearList& same = before[next];
      const float counted = old[same.pair].odometer.total;
      same.pair = sides.pair;
      same.complete.since -= counted;
      same.least.since -= counted;
      list = std::move(same);
    }
    near_.lists.push_back(std::move(list));
  }
  near_.order.resize(near_.lists.size());
  std::iota(near_.order.begin(), near_.order.end(), 0);
}

void NearLists::cut_into_tasks() {
  const auto pieces = [](std::size_t size, int of) { return (static_cast<int>(size) + of - 1) / of; };
  const int lists = static_cast<int>(near_.order.size()), groups = static_cast<int>(near_.static_pairs.groups.size()),
            tasks = pieces(near_.order.size(), lists_in_a_task),
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
      if (const NearList& list = near_.lists[near_.order[i]]; !list.complete.lasts(near_.odometer(list)))
        stale.push_back(near_.order[i]);
  }
}

/// Empties stale lists whose clearance exceeds the activation distance. They stay empty until motion exhausts the
/// clearance.
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

/// True if no pair is near, by vertex distances within a surface and by swept boxes otherwise. Empties the list then.
bool NearLists::is_clear(NearList& list) const {
  const ClusterPair& pair = near_.pair_of(list);
  const float clearance = clearance_.of(list);
  const bool is_asked = clearance >= 0;
  const float apart = is_asked
                          ? clearance
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

/// Rebuilds a list: pairs that come near in this substep, or can come near before the odometer has counted the skin. If
/// the clusters move fast, the list is for this substep only; their motion is not limited.
void NearLists::refresh(NearList& list, BoxSearch::Scratch& scratch, const PairParticles& particles) {
  const Odometer& odometer = near_.odometer(list);
  if (is_too_far(near_, list)) {  // tested again in the next substep
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

/// Measures the pairs found and makes the list's blocks of those nearer than `within`, nearest first: sorted by
/// counting into intervals of distance. Which ones are kept is unpredictable, so each is written, and the next one
/// overwrites it.
void NearLists::keep_near(NearList& list, float within, BoxSearch::Scratch& scratch,
                          const PairParticles& particles) const {
  const auto found = static_cast<std::size_t>(scratch.found);
  if (scratch.kept.size() <= found) scratch.kept.resize(2 * found + 1);
  const float scale = intervals / within;
  std::array<std::int32_t, intervals + 2> next{};
  std::size_t kept = 0;
  for (std::size_t i = 0; i < found; i += 16) {
    alignas(64) float bounds[16];
    near_.kernels.lower_bounds(scratch.blocks[i / 16], list.of_vertices ? 1 : 2, particles.positions, bounds);
    for (std::size_t k = i; k < std::min(i + 16, found); ++k) {
      const float value = bounds[k - i] * sum_slack;
      const bool is_kept = !(value > within);
      const int interval = static_cast<int>((value <= within ? value : 0.f) * scale);
      scratch.kept[kept] = {static_cast<std::int32_t>(k), interval, value};
      next[static_cast<std::size_t>(interval) + 1] += is_kept ? 1 : 0;
      kept += static_cast<std::size_t>(is_kept);
    }
  }
  std::partial_sum(next.begin(), next.end(), next.begin());
  make_blocks(list, kept);
  for (std::size_t i = 0; i < kept; ++i) {
    const BoxSearch::Kept& pair = scratch.kept[i];
    const auto from = static_cast<std::size_t>(pair.number),
               to = static_cast<std::size_t>(next[static_cast<std::size_t>(pair.interval)]++);
    copy(scratch.blocks[from / 16], from % 16, pair.number, list.blocks[to / 16], to % 16);
    list.value[to / 16] = min(list.value[to / 16], pair.value);
    list.least.value = min(list.least.value, pair.value);
  }
  for (std::size_t to = kept; to % 16 != 0; ++to)
    copy(list.blocks[to / 16].stencils, 0, list.blocks[to / 16].rank[0], list.blocks[to / 16], to % 16);
}

}  // namespace pliant
