#include "world/rest.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>

#include "constraints/registry.h"
#include "pliant/error.h"
#include "pliant/world.h"
#include "solver/visit.h"
#include "world/control.h"

namespace pliant {

namespace {

bool is_before(const RestFactor& a, const RestFactor& b) {
  return std::tie(a.block, a.group) < std::tie(b.block, b.group);
}

const ScaledGroup* find_group(const CompiledObject& object, int group) {
  const auto found = std::find_if(object.changing.scaled.begin(), object.changing.scaled.end(),
                                  [&](const ScaledGroup& one) { return one.group == group; });
  return found == object.changing.scaled.end() ? nullptr : &*found;
}

[[noreturn]] void refuse(const std::string& element, const std::string& problem) {
  throw Error({.element = element}, problem, "restore a state of this world");
}

std::size_t lane_of(const ConstraintPlace& at) { return static_cast<std::size_t>(at.batch * batch_width + at.lane); }

/// Calls visit(place, slots) for each plastic constraint of a pool.
template <class Visit>
void for_plastic(const CompiledObject& object, const PlasticPool& plastic, const Visit& visit) {
  for (const Segment& segment : object.segments) {
    if (segment.pool != plastic.pool) continue;
    for_segment(object, segment, [&](const ConstraintPlace& at, const std::int32_t* number) {
      if (plastic.kind[lane_of(at)] >= 0) visit(at, number);
    });
  }
}

std::vector<float> rest_of(const ConstraintPlace& at) {
  std::vector<float> rest;
  rest.reserve(static_cast<std::size_t>(at.pool.fields));
  for (int field = 0; field < at.pool.fields; ++field) rest.push_back(at.value(field));
  return rest;
}

/// Gives rest data what has flowed, if what they had there at the start is what the others had. Else an edit has given
/// a new rest shape, which stays.
bool put_flow(const FlowedData& flowed, std::vector<float>& rest) {
  std::vector<float> out = rest;
  for (std::size_t field = 0; field < rest.size(); ++field) {
    if (flowed.start[field] == flowed.now[field]) continue;
    if (rest[field] != flowed.start[field]) return false;
    out[field] = flowed.now[field];
  }
  rest = std::move(out);
  return true;
}

/// The slots of a constraint in the order that its type prefers, and the rest data in that order.
struct Ordered {
  std::vector<int> slots;
  std::vector<float> rest;
};

Ordered in_order(const Pool& pool, std::vector<int> slots, std::vector<float> rest) {
  const ConstraintDefinition& type = constraint_type(pool.type);
  if (type.canonical != nullptr) type.canonical(slots.data(), rest.data());
  return {std::move(slots), std::move(rest)};
}

std::vector<int> key_of(const Pool& pool, const std::vector<int>& slots) {
  std::vector<int> key{pool.type};
  key.insert(key.end(), slots.begin(), slots.end());
  return key;
}

/// A plastic cluster by its particles, in ascending order, and their rest places as given.
struct KeyedCluster {
  std::vector<int> key;
  std::vector<float> given;
};

/// `name(particle)` is the number by which a particle (storage index) is known.
template <class Name>
KeyedCluster key_of(const CompiledClusters& clusters, const PlasticCluster& plastic, const Name& name) {
  const CompiledCluster& cluster = clusters.clusters[static_cast<std::size_t>(plastic.cluster)];
  std::vector<std::pair<int, Vec3f>> members;
  for (std::size_t i = 0; i < plastic.given.size(); ++i)
    members.emplace_back(name(clusters.members[static_cast<std::size_t>(cluster.first) + i].particle),
                         plastic.given[i]);
  std::stable_sort(members.begin(), members.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  const auto same = [](const auto& a, const auto& b) { return a.first == b.first; };  // what a particle has split into
  members.erase(std::unique(members.begin(), members.end(), same), members.end());
  KeyedCluster out{{-1}, {}};  // no constraint type
  for (const auto& [particle, place] : members) {
    out.key.push_back(particle);
    out.given.insert(out.given.end(), {place.x, place.y, place.z});
  }
  return out;
}

/// What the cluster had that these particles belonged to, with these rest places: the same, or one that has been
/// divided.
const FlowedData* find_whole(const FlowedRest& flowed, const KeyedCluster& part) {
  if (const auto same = flowed.find(part.key); same != flowed.end() && same->second.start == part.given)
    return &same->second;
  for (auto at = flowed.lower_bound({-1}); at != flowed.end() && at->first[0] == -1; ++at) {
    std::size_t found = 1, of = 1;
    for (; found < part.key.size() && of < at->first.size(); ++of)
      if (part.key[found] == at->first[of] &&
          std::equal(&part.given[3 * (found - 1)], &part.given[3 * (found - 1)] + 3, &at->second.start[3 * (of - 1)]))
        ++found;
    if (found == part.key.size()) return &at->second;
  }
  return nullptr;
}

}  // namespace

void follow_rest_factors(WorldData& world, double time) {
  for (std::size_t o = 0; o < world.model.objects.size(); ++o) {
    CompiledObject& object = world.model.objects[o];
    for (ScaledGroup& group : object.changing.scaled) {
      if (set_factor(object, group, factor_of(group, world.state, static_cast<int>(o), time)))
        wake_bodies(world, static_cast<int>(o));
    }
  }
}

float rest_factor_of(const WorldData& world, int object, int group) {
  const ScaledGroup* scaled = find_group(world.model.objects[static_cast<std::size_t>(object)], group);
  return scaled == nullptr ? 1 : factor_of(*scaled, world.state, object, world.state.time);
}

void keep_flowed(WorldData& world) {
  world.state.flowed.clear();
  for (const CompiledObject& object : world.model.objects) append_flowed(object, world.state.flowed);
}

void require_rest(const Model& model, const State& state) {
  const RestFactor* before = nullptr;
  for (const RestFactor& factor : state.rest_factors) {
    const bool is_known = factor.block >= 0 && static_cast<std::size_t>(factor.block) < model.objects.size() &&
                          find_group(model.objects[static_cast<std::size_t>(factor.block)], factor.group) != nullptr &&
                          std::isfinite(factor.factor) && factor.factor >= 0;
    if (!is_known || (before != nullptr && !is_before(*before, factor)))
      refuse("rest factor " + std::to_string(&factor - state.rest_factors.data()),
             "is of no group with keyframes, is not in ascending order, or is negative or not finite");
    before = &factor;
  }
  std::int64_t wanted = 0;
  for (const CompiledObject& object : model.objects) wanted += flowed_size(object);
  if (static_cast<std::int64_t>(state.flowed.size()) != wanted)
    refuse("plastic rest data",
           "have " + std::to_string(state.flowed.size()) + " numbers where the world has " + std::to_string(wanted));
  if (!std::all_of(state.flowed.begin(), state.flowed.end(), [](float number) { return std::isfinite(number); }))
    refuse("plastic rest data", "are not finite");
}

void take_rest_of_state(WorldData& world) {
  const float* flowed = world.state.flowed.data();
  for (CompiledObject& object : world.model.objects) flowed = take_flowed(object, flowed);
  follow_rest_factors(world, world.state.time);
}

bool changes_in_substeps(const Model& model) {
  return std::any_of(model.objects.begin(), model.objects.end(), [](const CompiledObject& object) {
    return !object.changing.plastic.empty() || !object.clusters.plastic.empty() || !object.changing.scaled.empty() ||
           (object.has_volume && object.volume.described.changes());
  });
}

FlowedRest flowed_rest(const CompiledObject& object) {
  FlowedRest out;
  for (const PlasticPool& plastic : object.changing.plastic)
    for_plastic(object, plastic, [&](const ConstraintPlace& at, const std::int32_t* number) {
      const std::vector<int> slots(number, number + at.pool.stencil);
      const float* start = &plastic.start[lane_of(at) * static_cast<std::size_t>(at.pool.fields)];
      const Ordered now = in_order(at.pool, slots, rest_of(at)),
                    before = in_order(at.pool, slots, {start, start + at.pool.fields});
      if (now.rest != before.rest) out[key_of(at.pool, now.slots)] = {before.rest, now.rest};
    });
  for (const PlasticCluster& plastic : object.clusters.plastic) {
    const KeyedCluster keyed = key_of(object.clusters, plastic, [](int particle) { return particle; });
    out[keyed.key] = {keyed.given, {plastic.stretch.begin(), plastic.stretch.end()}};
  }
  return out;
}

void carry_flowed(const FlowedRest& flowed, const std::vector<int>& slot_before, CompiledObject& object) {
  if (flowed.empty()) return;
  for (const PlasticPool& plastic : object.changing.plastic)
    for_plastic(object, plastic, [&](const ConstraintPlace& at, const std::int32_t* number) {
      std::vector<int> slots;
      slots.reserve(static_cast<std::size_t>(at.pool.stencil));
      for (int slot = 0; slot < at.pool.stencil; ++slot)
        slots.push_back(slot_before[static_cast<std::size_t>(number[slot])]);
      Ordered ordered = in_order(at.pool, slots, rest_of(at));
      const auto found = flowed.find(key_of(at.pool, ordered.slots));
      if (found == flowed.end() || !put_flow(found->second, ordered.rest)) return;
      const Ordered back = in_order(at.pool, slots, ordered.rest);  // what ordering changes, it changes back
      Pool& pool = object.pools[static_cast<std::size_t>(at.pool_number)];
      for (int field = 0; field < pool.fields; ++field)
        if (pool.row_offset[static_cast<std::size_t>(field)] >= 0)
          pool.change(field, at.batch)[at.lane] = back.rest[static_cast<std::size_t>(field)];
    });
  for (PlasticCluster& plastic : object.clusters.plastic) {
    const KeyedCluster keyed =
        key_of(object.clusters, plastic, [&](int particle) { return slot_before[static_cast<std::size_t>(particle)]; });
    const FlowedData* found = find_whole(flowed, keyed);
    if (found == nullptr) continue;
    std::array<float, 9> stretch;
    std::copy(found->now.begin(), found->now.end(), stretch.begin());
    set_stretch(object.clusters, plastic, stretch);
  }
}

void ObjectHandle::set_rest_factor(int group, float factor) {
  const int number = world_->number(id());
  CompiledObject& of = world_->model.objects[static_cast<std::size_t>(number)];
  const ScaledGroup* scaled = find_group(of, group);
  const std::string element = "constraint group " + std::to_string(group);
  if (scaled == nullptr)
    throw Error({.object = of.name, .element = element}, "does not exist or has no keyframes",
                "give the group keyframes in the scene, one at least, to say that its rest data change");
  if (!std::isfinite(factor) || factor < 0)
    throw Error({.object = of.name, .element = element}, "is given the factor " + std::to_string(factor),
                "give a finite number of 0 or more");
  std::vector<RestFactor>& all = world_->state.rest_factors;
  const RestFactor wanted{number, group, factor};
  const auto at = std::lower_bound(all.begin(), all.end(), wanted, is_before);
  if (at != all.end() && !is_before(wanted, *at))
    *at = wanted;
  else
    all.insert(at, wanted);
  wake_bodies(*world_, number);
}

}  // namespace pliant
