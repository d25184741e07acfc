#include "collision/narrow/contact_detector.h"

#include <algorithm>

namespace pliant {

namespace {

/// A contact keeps at most this share of the distance that its two primitives have at rest.
constexpr double share_of_rest = 0.9;
/// With a mesh collider it keeps all of it: triangles over which an object begins would else be lower than those beside
/// them.
constexpr double share_of_rest_on_mesh = 1;
constexpr float no_limit_at_rest = 1e30f;  ///< [m]
/// When a block of static pairs is measured, all blocks of its group are that become due within this many substeps.
constexpr float substeps_of_rest = 4;

/// The inputs that all detection tasks share.
struct Detection {
  Neighbourhood& near;
  const PairParticles& particles;
  const FunctionRef<bool(const PairStencil&)>& is_exempt;
  const CoveredPairs& covered;
};

/// The side of a pair that is of a mesh collider, 0 or 1; -1: none.
int mesh_side(const ContactTables& tables, const PairStencil& pair) {
  if (tables.vertex_body[static_cast<std::size_t>(pair.vertex[0])] ==
      tables.vertex_body[static_cast<std::size_t>(pair.vertex[3])])
    return -1;  // what is pinned everywhere and collides with itself
  const auto is_of_mesh = [&](std::size_t i) {
    return tables.rules.is_immovable(tables.vertex_body[static_cast<std::size_t>(pair.vertex[i])]);
  };
  return is_of_mesh(3) ? 1 : is_of_mesh(0) ? 0 : -1;
}

/// The largest contact distance of a pair that its distance at rest permits [m]: no limit between bodies that were
/// described as touching, because they are moved apart when they are placed (world/touching_starts.h). `known` caches
/// the result: < 0 if not
/// computed yet; null if it is not cached.
float kept_at_rest(const Neighbourhood& near, const PairStencil& pair, float* known) {
  if (known != nullptr && *known >= 0) return *known;
  const ContactTables& tables = *near.model.shared;
  const double distance = pair_distance(pair, tables.rest.data()).distance;
  bool can_part[2] = {true, true};  // sides without pins, which stay where they are
  float extent = 0;
  for (int i = 0; i < 4; ++i) {
    const Record& place = tables.rest[pair.vertex[i]];
    extent = max(extent, largest(Vec3f{place.x, place.y, place.z}));
    bool& can = can_part[i < pair.first_side ? 0 : 1];
    can = can && place.w > 0;
  }
  const bool is_of_two = tables.vertex_body[pair.vertex[0]] != tables.vertex_body[pair.vertex[3]];
  const bool is_parted =
      is_of_two && (can_part[0] || can_part[1]) && distance <= double(least_margin_roundings * one_rounding * extent);
  const double share = mesh_side(tables, pair) < 0 ? share_of_rest : share_of_rest_on_mesh;
  const auto kept = is_parted ? no_limit_at_rest : static_cast<float>(share * distance);
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
  if (distance - lanes.paths.falls[lane] > kept.thickness || lanes.paths.apart[lane] > kept.thickness ||
      d.is_exempt(pair))
    return;
  // A covered pair that does not touch yet would push the surfaces sideways; one with a mesh does so if it touches,
  // too.
  if (distance > kept.thickness && d.covered.covers(pair, lanes.at, lane, d.particles.positions)) return;
  const int mesh = mesh_side(*d.near.model.shared, pair);
  if (mesh >= 0 && d.covered.is_closer_on_mesh(pair, mesh, lanes.at, lane, d.particles.positions, d.is_exempt)) return;
  add_contact(pair, lanes.at, lane, kept, d.particles, contacts);
}

/// True if any of sixteen pairs can come within the contact distance by what the odometer allows.
bool any_in_reach(const PairBatch& at, const ClusterPair& clusters) {
  const float within = clusters.material.thickness + clusters.odometer.next;
  bool any = false;
  for (int lane = 0; lane < 16; ++lane) any |= at.distance[lane] * (1 - 2e-5f) <= within;
  return any;
}

/// Adds the contacts of the first `pairs` of sixteen pairs, and to `lane_of` the lane of each if it is given.
void detect_block(const Detection& d, const ClusterSides& sides, const PairStencils& stencils, int pairs,
                  float* at_rest, std::vector<Contact>& contacts, std::vector<int>* lane_of = nullptr) {
  const ClusterPair& clusters = d.near.pair_of(sides);
  PairLanes lanes;
  lanes.stencils = stencils;
  d.near.kernels.distances(lanes.stencils, sides.of_vertices ? 1 : 2, d.particles.positions, lanes.at);
  if (!any_in_reach(lanes.at, clusters)) return;
  find_paths(d.near, sides, d.particles, lanes);
  const unsigned valid = (1U << pairs) - 1;
  for (unsigned left = find_candidates(lanes, clusters) & valid; left != 0; left &= left - 1) {
    const int lane = __builtin_ctz(left);
    detect_pair(d, sides, lanes, lane, at_rest != nullptr ? at_rest + lane : nullptr, contacts);
    if (lane_of != nullptr) lane_of->resize(contacts.size(), lane);
  }
}

/// Appends the contacts of a list in the order of their ranks, which does not depend on how blocks were made.
void append_by_rank(std::vector<std::pair<std::int32_t, std::int32_t>>& ranks, const std::vector<Contact>& from,
                    std::vector<Contact>& to) {
  std::sort(ranks.begin(), ranks.end());
  for (const auto& [rank, number] : ranks) to.push_back(from[static_cast<std::size_t>(number)]);
}

/// Loads the stencils of a block that is probably measured next: lists are sorted by distance, and exceed the caches.
void prefetch(const PairStencils& stencils) {
  for (const auto& vertex : stencils.vertex) __builtin_prefetch(vertex);
}

void detect_list(const Detection& d, NearList& list, ListContacts& found, std::vector<Contact>& contacts) {
  const ClusterPair& clusters = d.near.pair_of(list);
  const float within = cull_slack * clusters.material.thickness, next = clusters.odometer.next;
  if (list.least.after(clusters.odometer) > within || is_too_far(d.near, list)) return;
  const float spent = list.least.spent(clusters.odometer), gone = spent + next;
  found.clear();
  float least = out_of_reach;
  for (std::size_t b = 0; b < list.blocks.size(); ++b) {
    if (list.value[b] - gone <= within) {
      NearBlock& block = list.blocks[b];
      if (b + 1 < list.blocks.size()) prefetch(list.blocks[b + 1].stencils);
      const float now = d.near.kernels.least_distance(block.stencils, list.of_vertices ? 1 : 2, d.particles.positions);
      list.value[b] = (now + spent) * sum_slack;
      if (now - next <= within) {
        detect_block(d, list, block.stencils, list.pairs_in(b), block.kept.data(), found.contacts, &found.lane);
        for (std::size_t i = found.rank.size(); i < found.contacts.size(); ++i)
          found.rank.emplace_back(block.rank[static_cast<std::size_t>(found.lane[i])], static_cast<std::int32_t>(i));
      }
    }
    least = min(least, list.value[b]);
  }
  list.least.value = least;
  append_by_rank(found.rank, found.contacts, contacts);
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
      const float least =
          d.near.kernels.least_distance(group.blocks[b], group.of_vertices ? 1 : 2, d.particles.positions);
      group.value[b] = least * sum_slack;
      if (least - next <= within) detect_block(d, group, group.blocks[b], group.pairs_in(b), nullptr, contacts);
    }
    group.least.value = min(group.least.value, group.value[b]);
  }
}

}  // namespace

void ListContacts::clear() {
  contacts.clear();
  lane.clear();
  rank.clear();
}

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
    for (int i = task.first; i < task.last; ++i)
      detect_list(d, near.lists[near.order[i]], scratch.of_list, scratch.of_lists);
  });
  for (const Scratch& scratch : scratch_)
    contacts.insert(contacts.end(), scratch.of_groups.begin(), scratch.of_groups.end());
  const std::size_t of_static_pairs = contacts.size();
  for (const Scratch& scratch : scratch_)
    contacts.insert(contacts.end(), scratch.of_lists.begin(), scratch.of_lists.end());
  return flush_.remove(particles.positions, of_static_pairs, contacts);
}

}  // namespace pliant
