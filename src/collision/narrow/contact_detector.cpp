#include "collision/narrow/contact_detector.h"

#include <algorithm>

namespace pliant {

namespace {

/// A contact keeps at most this share of the distance that its two primitives have at rest.
constexpr double share_of_rest = 0.9;
/// When a block of static pairs is measured, all blocks of its group are that become due within this many substeps.
constexpr float substeps_of_rest = 4;

/// The inputs that all detection tasks share.
struct Detection {
  Neighbourhood& near;
  const PairParticles& particles;
  const FunctionRef<bool(const PairStencil&)>& is_exempt;
  const CoveredPairs& covered;
};

/// The largest contact distance of a pair that its distance at rest permits [m]. `known` caches the result: < 0 if not
/// computed yet; null if it is not cached.
float kept_at_rest(const Neighbourhood& near, const PairStencil& pair, float* known) {
  if (known != nullptr && *known >= 0) return *known;
  const auto kept = static_cast<float>(share_of_rest * pair_distance(pair, near.model.rest.data()).distance);
  if (known != nullptr) *known = kept;
  return kept;
}

void add_contact(const PairStencil& pair, const PairBatch& at, int lane, const PairMaterial& material,
                 const PairParticles& particles, std::vector<Contact>& contacts) {
  Contact contact = make_contact(pair, at, lane, material, particles.h);
  complete_contact(contact, particles.positions, particles.remainders);
  if (material.restitution > 0) contact.approach = approach_of(contact, particles.displacements, particles.h);
  contacts.push_back(contact);
}

/// Bit i is set if pair i of sixteen can become a contact: its distance minus the possible decrease is within the
/// contact distance.
unsigned find_candidates(const PairLanes& lanes, const ClusterPair& clusters) {
  const float thickness = clusters.material.thickness, next = clusters.odometer.next;
  std::int32_t bits[16];
  for (int lane = 0; lane < 16; ++lane) {
    const float distance = lanes.at.distance[lane] * (1 - 1e-5f);
    const bool rules_out = !(lanes.at.distance[lane] > 0) | (distance - next > thickness) |
                           (distance - lanes.paths.falls[lane] > thickness) | (lanes.paths.apart[lane] > thickness);
    bits[lane] = rules_out ? 0 : 1 << lane;
  }
  std::int32_t all = 0;
  for (const std::int32_t bit : bits) all |= bit;
  return static_cast<unsigned>(all);
}

void detect_pair(const Detection& d, const ClusterSides& sides, const PairLanes& lanes, int lane, float* at_rest,
                 std::vector<Contact>& contacts) {
  const PairStencil pair = lanes.pair(lane, sides.of_vertices);
  PairMaterial kept = d.near.pair_of(sides).material;
  kept.thickness = min(kept.thickness, kept_at_rest(d.near, pair, at_rest));
  const float distance = lanes.at.distance[lane] * (1 - 1e-5f);
  if (distance - lanes.paths.falls[lane] > kept.thickness || lanes.paths.apart[lane] > kept.thickness || d.is_exempt(pair))
    return;
  // A covered pair that does not touch yet would push the surfaces sideways.
  if (distance > kept.thickness && d.covered.covers(pair, lanes.at, lane, d.particles.positions)) return;
  add_contact(pair, lanes.at, lane, kept, d.particles, contacts);
}

void measure(const Detection& d, const ClusterSides& sides, PairLanes& lanes) {
  d.near.kernels.distances(lanes.stencils, sides.of_vertices ? 1 : 2, d.particles.positions, lanes.at);
  find_paths(d.near, sides, d.particles, lanes);
}

void detect_list(const Detection& d, NearList& list, std::vector<std::int32_t>& near, std::vector<Contact>& contacts) {
  const ClusterPair& clusters = d.near.pair_of(list);
  const float within = cull_slack * clusters.material.thickness;
  if (list.least.after(clusters.odometer) > within || is_too_far(d.near, list)) return;
  collect_near(d.near, list, within, near);
  const float spent = list.least.spent(clusters.odometer);
  PairLanes lanes;
  for (std::size_t i = 0; i < near.size(); i += 16) {
    const std::size_t count = std::min<std::size_t>(16, near.size() - i);
    for (std::size_t lane = 0; lane < 16; ++lane) lanes.set(lane, list.pairs[near[i + (lane < count ? lane : 0)]].vertex);
    measure(d, list, lanes);
    for (std::size_t lane = 0; lane < count; ++lane) {
      const std::int32_t number = near[i + lane];
      const float value = (lanes.at.at_least[lane] + spent) * sum_slack;
      list.value[number] = value;
      list.least.value = min(list.least.value, value);
    }
    const unsigned valid = (1U << count) - 1;
    for (unsigned left = find_candidates(lanes, clusters) & valid; left != 0; left &= left - 1) {
      const int lane = __builtin_ctz(left);
      detect_pair(d, list, lanes, lane, &list.pairs[near[i + static_cast<std::size_t>(lane)]].kept, contacts);
    }
  }
}

void detect_block(const Detection& d, const StaticGroup& group, std::size_t block, std::vector<Contact>& contacts) {
  PairLanes lanes;
  lanes.stencils = group.blocks[block];
  measure(d, group, lanes);
  const unsigned valid = (1U << group.pairs_in(block)) - 1;
  for (unsigned left = find_candidates(lanes, d.near.pair_of(group)) & valid; left != 0; left &= left - 1)
    detect_pair(d, group, lanes, __builtin_ctz(left), nullptr, contacts);
}

/// Measures the static pairs of a group. If a block is due, blocks due within substeps_of_rest are measured with it.
void detect_group(const Detection& d, StaticGroup& group, std::vector<Contact>& contacts) {
  const ClusterPair& clusters = d.near.pair_of(group);
  const float within = cull_slack * clusters.material.thickness, next = clusters.odometer.next;
  if (group.least.after(clusters.odometer) > within || is_too_far(d.near, group)) return;
  group.rebase(clusters.odometer);
  const float due = within + (1 + substeps_of_rest) * next;
  group.least.value = out_of_reach;
  for (std::size_t b = 0; b < group.blocks.size(); ++b) {
    if (group.value[b] <= due) {
      const float least = d.near.kernels.least_distance(group.blocks[b], group.of_vertices ? 1 : 2, d.particles.positions);
      group.value[b] = least * sum_slack;
      if (least - next <= within) detect_block(d, group, b, contacts);
    }
    group.least.value = min(group.least.value, group.value[b]);
  }
}

}  // namespace

std::size_t ContactDetector::detect(Executor& executor, Neighbourhood& near, const PairParticles& particles,
                                    FunctionRef<bool(const PairStencil&)> is_exempt, std::vector<Contact>& contacts) {
  contacts.clear();
  scratch_.resize(near.tasks.size());
  const Detection d{near, particles, is_exempt, covered_};
  executor.parallel_for("detect contacts", static_cast<int>(near.tasks.size()), [&](int number) {
    const NearTask& task = near.tasks[number];
    Scratch& scratch = scratch_[number];
    scratch.of_groups.clear();
    scratch.of_lists.clear();
    for (int g = task.first_group; g < task.last_group; ++g)
      detect_group(d, near.static_pairs.groups[g], scratch.of_groups);
    for (int i = task.first; i < task.last; ++i) detect_list(d, near.lists[near.order[i]], scratch.near, scratch.of_lists);
  });
  for (const Scratch& scratch : scratch_)
    contacts.insert(contacts.end(), scratch.of_groups.begin(), scratch.of_groups.end());
  const std::size_t of_static_pairs = contacts.size();
  for (const Scratch& scratch : scratch_) contacts.insert(contacts.end(), scratch.of_lists.begin(), scratch.of_lists.end());
  return of_static_pairs;
}

}  // namespace pliant
