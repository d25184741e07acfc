#include "model/changing_rest.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <tuple>
#include <utility>

#include "constraints/registry.h"
#include "core/at.h"
#include "math/disjoint_sets.h"
#include "model/compiled_object.h"
#include "pliant/error.h"

namespace pliant {

namespace {

const ChangingGroup* group_of(const std::vector<ChangingGroup>& groups, int type, std::int64_t constraint) {
  for (const ChangingGroup& group : groups)
    if (group.type == type && constraint >= group.first && constraint < group.last) return &group;
  return nullptr;
}

float& first_field(CompiledObject& object, const ScaledGroup::Place& place) {
  return object.pools[at(place.pool)].change(0, place.batch)[place.lane];
}

/// Calls body(lane number, batch, lane) for each lane of a pool that is plastic.
template <class Body>
void for_plastic(const PlasticPool& plastic, const Body& body) {
  for (std::size_t i = 0; i < plastic.kind.size(); ++i)
    if (plastic.kind[i] >= 0) body(i, static_cast<std::int64_t>(i / batch_width), static_cast<int>(i % batch_width));
}

/// Collects what changes in one pool.
class PoolScan {
 public:
  PoolScan(const std::vector<ChangingGroup>& groups, const CompiledObject& object, int number, ChangingRest& out)
      : groups_(groups), pool_(object.pools[at(number)]), number_(number), out_(out) {
    plastic_.pool = number;
    plastic_.kind.assign(pool_.origin.size(), -1);
  }

  void run() {
    for (std::size_t lane = 0; lane < pool_.origin.size(); ++lane) {
      if (pool_.origin[lane] < 0) continue;
      const ChangingGroup* group = group_of(groups_, pool_.type, pool_.origin[lane]);
      if (group == nullptr) continue;
      if (group->plasticity) add_plastic(*group, lane);
      if (!group->keyframes.empty()) add_scaled(*group, lane);
    }
    if (!plastic_.kinds.empty()) out_.plastic.push_back(std::move(plastic_));
  }

 private:
  float rest(int field, std::size_t lane) const {
    return pool_.row(field, static_cast<std::int64_t>(lane / batch_width))[lane % batch_width];
  }

  void add_plastic(const ChangingGroup& group, std::size_t lane) {
    const auto fields = at(pool_.fields);
    plastic_.start.resize(pool_.origin.size() * fields);
    for (int field = 0; field < pool_.fields; ++field) plastic_.start[lane * fields + at(field)] = rest(field, lane);
    const auto [found, added] = kinds_.try_emplace(group.group, static_cast<std::int32_t>(plastic_.kinds.size()));
    if (added) plastic_.kinds.push_back(*group.plasticity);
    plastic_.kind[lane] = found->second;
  }

  void add_scaled(const ChangingGroup& group, std::size_t lane) {
    ScaledGroup& scaled = *std::find_if(out_.scaled.begin(), out_.scaled.end(),
                                        [&](const ScaledGroup& other) { return other.group == group.group; });
    scaled.places.push_back(
        {number_, static_cast<std::int64_t>(lane / batch_width), static_cast<int>(lane % batch_width)});
    scaled.rest.push_back(rest(0, lane));
  }

  const std::vector<ChangingGroup>& groups_;
  const Pool& pool_;
  int number_;
  ChangingRest& out_;
  PlasticPool plastic_;
  std::map<int, std::int32_t> kinds_;  ///< of groups: index in plastic_.kinds
};

}  // namespace

float ScaledGroup::factor_at(double time) const {
  const auto later = std::find_if(keyframes.begin(), keyframes.end(),
                                  [&](const RestKeyframe& key) { return static_cast<double>(key.time) > time; });
  if (later == keyframes.begin()) return keyframes.front().factor;
  const RestKeyframe& before = *std::prev(later);
  if (later == keyframes.end()) return before.factor;
  const double share = (time - double(before.time)) / (double(later->time) - double(before.time));
  return static_cast<float>(double(before.factor) + share * (double(later->factor) - double(before.factor)));
}

std::vector<ChangingGroup> find_changing_groups(const Object& object) {
  std::vector<ChangingGroup> out;
  std::map<int, std::int64_t> counts;  // of constraints, by type
  for (std::size_t g = 0; g < object.constraints.size(); ++g) {
    const ConstraintGroup& group = object.constraints[g];
    const int type = find_constraint_type(group.type);
    if (type < 0) continue;  // gather_constraints refuses it
    std::int64_t& first = counts[type];
    const std::int64_t last =
        first + static_cast<std::int64_t>(group.particles.size() / constraint_type(type).slots.size());
    if (group.plasticity || !group.keyframes.empty())
      out.push_back({static_cast<int>(g), type, first, last, group.plasticity, group.keyframes});
    first = last;
  }
  return out;
}

ChangingRest compile_changing_rest(const std::vector<ChangingGroup>& groups, const CompiledObject& object) {
  ChangingRest out;
  if (groups.empty()) return out;
  for (const ChangingGroup& group : groups)
    if (!group.keyframes.empty()) out.scaled.push_back({group.group, group.keyframes, {}, {}});
  for (int pool = 0; pool < static_cast<int>(object.pools.size()); ++pool) PoolScan(groups, object, pool, out).run();
  return out;
}

bool is_one_free_piece(const CompiledObject& object) {
  if (object.frames.size() > 0) return false;
  for (const Record& position : object.positions)
    if (!(position.w > 0)) return false;
  DisjointSets pieces(object.positions.size());
  for (const Segment& segment : object.segments) {
    const Pool& pool = object.pools[at(segment.pool)];
    const std::int32_t* index = pool.indices.data() + segment.index_offset;
    for (int batch = 0; batch < segment.batches; ++batch, index += indices_per_batch(pool, segment))
      for (int lane = 0; lane < batch_width; ++lane)
        for (int slot = 1; slot < pool.stencil && lane_is_valid(segment, batch, lane); ++slot)
          pieces.join(at(particle_of(segment, index, slot, lane)), at(particle_of(segment, index, 0, lane)));
  }
  for (std::size_t i = 0; i < pieces.count(); ++i)
    if (pieces.root(i) != 0) return false;
  return true;
}

float factor_of(const ScaledGroup& group, const State& state, int object, double time) {
  const RestFactor wanted{object, group.group, 0};
  const auto is_before = [](const RestFactor& a, const RestFactor& b) {
    return std::tie(a.block, a.group) < std::tie(b.block, b.group);
  };
  const auto held = std::lower_bound(state.rest_factors.begin(), state.rest_factors.end(), wanted, is_before);
  return held == state.rest_factors.end() || is_before(wanted, *held) ? group.factor_at(time) : held->factor;
}

bool set_factor(CompiledObject& object, ScaledGroup& group, float factor) {
  bool changes = false;
  group.now = factor;
  for (std::size_t i = 0; i < group.places.size(); ++i) {
    float& field = first_field(object, group.places[i]);
    const float scaled = group.rest[i] * factor;
    changes = changes || field != scaled;
    field = scaled;
  }
  return changes;
}

void follow_keyframes(CompiledObject& object, const State& state, int number, double time) {
  for (ScaledGroup& group : object.changing.scaled) {
    const float factor = factor_of(group, state, number, time);
    if (factor != group.now) set_factor(object, group, factor);
  }
  if (object.has_volume && object.volume.described.changes()) object.volume.target = object.volume.target_at(time);
}

void append_flowed(const CompiledObject& object, std::vector<float>& flowed) {
  for (const PlasticPool& plastic : object.changing.plastic) {
    const Pool& pool = object.pools[at(plastic.pool)];
    for_plastic(plastic, [&](std::size_t, std::int64_t batch, int lane) {
      for (int field = 0; field < pool.fields; ++field) flowed.push_back(pool.row(field, batch)[lane]);
    });
  }
  for (const PlasticCluster& plastic : object.clusters.plastic)
    flowed.insert(flowed.end(), plastic.stretch.begin(), plastic.stretch.end());
}

std::int64_t flowed_size(const CompiledObject& object) {
  std::int64_t size = 0;
  for (const PlasticPool& plastic : object.changing.plastic)
    for_plastic(plastic, [&](std::size_t, std::int64_t, int) { size += object.pools[at(plastic.pool)].fields; });
  for (const PlasticCluster& plastic : object.clusters.plastic)
    size += static_cast<std::int64_t>(plastic.stretch.size());
  return size;
}

const float* take_flowed(CompiledObject& object, const float* flowed) {
  for (const PlasticPool& plastic : object.changing.plastic) {
    Pool& pool = object.pools[at(plastic.pool)];
    for_plastic(plastic, [&](std::size_t, std::int64_t batch, int lane) {
      for (int field = 0; field < pool.fields; ++field) pool.change(field, batch)[lane] = *flowed++;
    });
  }
  for (PlasticCluster& plastic : object.clusters.plastic) {
    std::array<float, 9> stretch;
    for (float& element : stretch) element = *flowed++;
    if (stretch != plastic.stretch) set_stretch(object.clusters, plastic, stretch);
  }
  return flowed;
}

void forget_flow(CompiledObject& object) {
  for (const PlasticPool& plastic : object.changing.plastic) {
    Pool& pool = object.pools[at(plastic.pool)];
    for_plastic(plastic, [&](std::size_t number, std::int64_t batch, int lane) {
      for (int field = 0; field < pool.fields; ++field)
        pool.change(field, batch)[lane] = plastic.start[number * at(pool.fields) + at(field)];
    });
  }
  for (PlasticCluster& plastic : object.clusters.plastic)
    set_stretch(object.clusters, plastic, PlasticCluster{}.stretch);
}

}  // namespace pliant
