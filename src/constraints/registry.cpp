#include "constraints/registry.h"

#include <deque>
#include <mutex>

#include "constraints/all.h"
#include "constraints/gives_shape.h"
#include "constraints/traits.h"
#include "pliant/error.h"

namespace pliant {

namespace {

struct Registry {
  std::deque<ConstraintDefinition> definitions;  // a deque: references to its elements stay valid as it grows
  std::vector<ConstraintType> types;             // public descriptions of the types
  std::mutex growing;

  Registry() {
    for_each_type(AllConstraints{}, [&](auto tag, int) {
      using T = typename decltype(tag)::type;
      ConstraintDefinition definition = detail::definition_of<T>();
      definition.is_compiled = in_lanes<T>;
      add(definition);
    });
  }

  void add(const ConstraintDefinition& from) {
    definitions.push_back(from);
    types.push_back({from.name, static_cast<int>(from.slots.size()), from.rest_fields, from.slots, from.rows});
  }
};

Registry& registry() {
  static Registry one;
  return one;
}

[[noreturn]] void refuse(const ConstraintDefinition& definition, const std::string& problem,
                         const std::string& advice) {
  throw Error({}, "constraint type '" + definition.name + "' " + problem, advice);
}

void require_complete(const ConstraintDefinition& definition) {
  if (definition.name.empty()) refuse(definition, "has no name", "set its `name`");
  if (definition.slots.empty() || definition.slots.size() > 8)
    refuse(definition, "has " + std::to_string(definition.slots.size()) + " slots", "give it one to eight");
  if (definition.rows < 1 || definition.rows > 6)
    refuse(definition, "has " + std::to_string(definition.rows) + " rows", "give it one to six");
  if (definition.rest_fields.size() > 32)
    refuse(definition, "has " + std::to_string(definition.rest_fields.size()) + " rest fields", "give it up to 32");
  if (definition.evaluate == nullptr || definition.evaluate_double == nullptr)
    refuse(definition, "has no evaluation function", "use register_constraint<Type>()");
}

}  // namespace

void register_constraint(const ConstraintDefinition& definition) {
  require_complete(definition);
  Registry& all = registry();
  const std::lock_guard<std::mutex> lock(all.growing);
  if (const int same = find_constraint_type(definition.name); same >= 0) {
    if (constraint_type(same).evaluate == definition.evaluate) return;
    refuse(definition, "is already registered with another definition", "choose another name");
  }
  all.add(definition);
  all.definitions.back().is_compiled = all.definitions.back().is_length = false;  // only built-in types have kernels
}

int constraint_type_count() { return static_cast<int>(registry().definitions.size()); }

const ConstraintDefinition& constraint_type(int type) { return registry().definitions[static_cast<std::size_t>(type)]; }

int find_constraint_type(const std::string& name) {
  for (int type = 0; type < constraint_type_count(); ++type)
    if (constraint_type(type).name == name) return type;
  return -1;
}

std::string constraint_type_names() {
  std::string names;
  for (const ConstraintType& type : constraint_types()) names += (names.empty() ? "" : ", ") + type.name;
  return names;
}

int length_type() {
  for (int type = 0; type < constraint_type_count(); ++type)
    if (constraint_type(type).is_length) return type;
  return -1;
}

bool is_length(const std::string& name) {
  const int type = find_constraint_type(name);
  return type >= 0 && is_length(type);
}

bool gives_shape(const std::string& name) {
  return name == TetrahedronShear::name || name == CorotationalStrain::name || name == GreenStrain::name;
}

bool is_hinge(int type) { return is_hinge(constraint_type(type).name); }
bool belongs_to_solid(int type) {
  const std::string& name = constraint_type(type).name;
  return gives_shape(name) || name == TetrahedronVolume::name || name == VolumeAroundEdge::name ||
         name == GreenTrace::name;
}

bool is_hinge(const std::string& name) { return name == DihedralBending::name || is_flat_hinge(name); }
bool is_flat_hinge(const std::string& name) { return name == IsometricBending::name; }
double fold_angle(const Vec3d (&x)[4]) { return DihedralBending::measure(x).rest_angle; }

const std::vector<ConstraintType>& constraint_types() { return registry().types; }

}  // namespace pliant
