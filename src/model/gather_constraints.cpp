#include "model/gather_constraints.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "constraints/registry.h"
#include "model/stiffness.h"
#include "pliant/error.h"

namespace pliant {

namespace {

/// Computes the rest data of one constraint from the initial positions and orientations.
void measure(const ConstraintDefinition& type, const Object& object, const int* stencil, float* rest) {
  double slots[4 * most_slots], fields[most_rest_fields];
  for (std::size_t slot = 0; slot < type.slots.size(); ++slot) {
    double* to = slots + 4 * slot;
    const auto number = static_cast<std::size_t>(stencil[slot]);
    if (type.slots[slot] == SlotKind::frame) {
      const Quatf& q = object.frames[number].orientation;
      to[0] = double(q.x), to[1] = double(q.y), to[2] = double(q.z), to[3] = double(q.w);
    } else {
      const Vec3f& p = object.positions[number];
      to[0] = double(p.x), to[1] = double(p.y), to[2] = double(p.z), to[3] = 0;
    }
  }
  type.measure(slots, fields);
  for (std::size_t i = 0; i < type.rest_fields.size(); ++i) rest[i] = static_cast<float>(fields[i]);
}

Law law_of(const Stiffness& stiffness) {
  if (stiffness.kind == Stiffness::Kind::pbd) return Law::pbd;
  return stiffness.damping > 0 ? Law::damped : Law::compliant;
}

class Gatherer {
 public:
  Gatherer(const Object& object, int passes) : object_(object), passes_(passes) {}

  /// Adds a group. If `given_away` is not null, it is that group, and its arrays are moved instead of copied.
  void add(const ConstraintGroup& group, ConstraintGroup* given_away) {
    const int type = find_constraint_type(group.type);
    if (type < 0)
      throw Error({.object = object_.name}, "unknown constraint type '" + group.type + "'",
                  "use one of " + constraint_type_names());
    add_group(group, given_away, type);
  }

  void add_attachments() {
    const int type = length_type();
    for (std::size_t i = 0; i < object_.attachments.size(); ++i) {
      const Attachment& attachment = object_.attachments[i];
      ConstraintList& list = list_of(type, law_of(attachment.stiffness));
      list.stencils.push_back(attachment.particle);
      list.stencils.push_back(static_cast<int>(object_.positions.size() + i));
      list.rest.push_back(0);
      list.response.push_back(response(attachment.stiffness, attachment.stiffness.value));
      list.damping.push_back(attachment.stiffness.damping);
      list.origin.push_back(next_origin_[type]++);
    }
  }

  std::vector<ConstraintList> take() {
    std::vector<ConstraintList> lists;
    for (auto& [key, list] : lists_) {
      if (list.count() > 0) lists.push_back(std::move(list));  // groups may be empty
    }
    return lists;
  }

 private:
  ConstraintList& list_of(int type, Law law) {
    const ConstraintDefinition& definition = constraint_type(type);
    ConstraintList& list = lists_[{type, law}];
    list.type = type;
    list.law = law;
    list.size = static_cast<int>(definition.slots.size());
    list.fields = static_cast<int>(definition.rest_fields.size());
    list.components = definition.rows;
    list.in_lanes = definition.is_compiled;
    return list;
  }

  float response(const Stiffness& stiffness, float value) const {
    const bool pbd = stiffness.kind == Stiffness::Kind::pbd;
    return pbd ? static_cast<float>(stiffness_per_projection(value, passes_)) : value;
  }

  void append_stencils(const ConstraintGroup& group, ConstraintGroup* given_away, const ConstraintDefinition& type,
                       ConstraintList& list) const {
    const std::vector<SlotKind>& slots = type.slots;
    if (std::find(slots.begin(), slots.end(), SlotKind::frame) == slots.end())
      return given_away != nullptr ? list.stencils.append(std::move(given_away->particles))
                                   : list.stencils.append(group.particles);
    for (std::size_t i = 0; i < group.particles.size(); ++i) {
      const bool is_frame = slots[i % slots.size()] == SlotKind::frame;
      list.stencils.push_back(is_frame ? first_frame() + group.particles[i] : group.particles[i]);
    }
  }

  void require_sizes(const ConstraintGroup& group, const ConstraintDefinition& type) const {
    const std::size_t size = type.slots.size(), fields = type.rest_fields.size(), count = group.particles.size() / size;
    const auto refuse = [&](const std::string& problem) {
      throw Error({.object = object_.name, .element = type.name + " constraints"}, problem);
    };
    if (group.particles.size() % size != 0)
      refuse(std::to_string(group.particles.size()) + " particles cannot be divided into stencils of " +
             std::to_string(size));
    if (!group.rest.empty() && group.rest.size() != count * fields)
      refuse(std::to_string(group.rest.size()) + " rest values where " + std::to_string(count * fields) +
             " are needed");
    if (group.rest.empty() && fields > 0 && type.measure == nullptr && count > 0)
      refuse("this type cannot measure its rest data: give `rest`");
    if (!group.compliances.empty() && group.compliances.size() != count)
      refuse(std::to_string(group.compliances.size()) + " compliances for " + std::to_string(count) + " constraints");
    for (std::size_t i = 0; i < group.particles.size(); ++i) {
      const bool is_frame = type.slots[i % size] == SlotKind::frame;
      const std::size_t numbers = is_frame ? object_.frames.size() : object_.positions.size();
      if (group.particles[i] < 0 || group.particles[i] >= static_cast<int>(numbers))
        refuse((is_frame ? "frame " : "particle ") + std::to_string(group.particles[i]) + " does not exist");
    }
  }

  /// The rest data of a group, from the initial positions.
  std::vector<float> measured(const ConstraintGroup& group, const ConstraintDefinition& type, std::size_t count) const {
    const std::size_t size = type.slots.size(), fields = type.rest_fields.size();
    std::vector<float> rest(count * fields);
    for (std::size_t i = 0; i < count; ++i) measure(type, object_, &group.particles[i * size], &rest[i * fields]);
    return rest;
  }

  void add_group(const ConstraintGroup& group, ConstraintGroup* given_away, int type) {
    const ConstraintDefinition& definition = constraint_type(type);
    require_sizes(group, definition);
    ConstraintList& list = list_of(type, law_of(group.stiffness));
    const std::size_t size = definition.slots.size(), count = group.particles.size() / size;
    list.changes = list.changes || group.plasticity || !group.keyframes.empty();
    list.rest.append(group.rest);
    const bool has_own = !group.compliances.empty();
    const bool as_given = has_own && group.stiffness.kind == Stiffness::Kind::compliance;
    if (as_given)
      list.response.append(group.compliances);
    else if (has_own)
      for (const float compliance : group.compliances) list.response.push_back(response(group.stiffness, compliance));
    else
      list.response.append(response(group.stiffness, group.stiffness.value), count);
    if (group.rest.empty() && list.fields > 0) list.rest.append(measured(group, definition, count));
    list.damping.append(group.stiffness.damping, count);
    list.origin.append(next_origin_[type], count);
    next_origin_[type] += static_cast<int>(count);
    append_stencils(group, given_away, definition, list);  // last, because this may move the stencils
  }

  /// The index of the first frame in stencils: frames come after all particles and attachment targets.
  int first_frame() const { return static_cast<int>(object_.positions.size() + object_.attachments.size()); }

  const Object& object_;
  int passes_;
  std::map<std::pair<int, Law>, ConstraintList> lists_;
  std::map<int, int> next_origin_;
};

}  // namespace

ConstraintList ConstraintList::empty() const {
  ConstraintList without;
  without.type = type;
  without.law = law;
  without.size = size;
  without.fields = fields;
  without.components = components;
  without.in_lanes = in_lanes;
  without.chained = chained;
  without.changes = changes;
  return without;
}

std::vector<ConstraintList> gather_constraints(const Object& object, int passes) {
  Gatherer gatherer(object, passes);
  for (const ConstraintGroup& group : object.constraints) gatherer.add(group, nullptr);
  gatherer.add_attachments();
  return gatherer.take();
}

std::vector<ConstraintList> gather_constraints(Object&& object, int passes) {
  Gatherer gatherer(object, passes);
  for (ConstraintGroup& group : object.constraints) gatherer.add(group, &group);
  gatherer.add_attachments();
  return gatherer.take();
}

}  // namespace pliant
