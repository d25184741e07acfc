#include "collision/proxies/contact_tables.h"

#include <algorithm>
#include <map>
#include <string>

namespace pliant {

namespace {

bool is_immovable(const CompiledObject& object) {
  for (const Record& p : object.positions)
    if (p.w > 0) return false;
  return true;
}

ContactBody body_of(const CompiledObject& object) {
  ContactBody body;
  const bool is_there = object.particles > 0;  // or it was removed
  body.groups = is_there ? object.groups : 0;
  body.mask = is_there ? object.mask : 0;
  body.collides = object.collides;
  body.is_collider = object.is_collider;
  if (object.fluid) {
    body.spacing = object.fluid->spacing;
    body.speed_of_sound = object.fluid->speed_of_sound;
  }
  body.is_of_grains = object.grains.has_value();
  body.is_immovable = is_immovable(object);
  body.meets_itself = is_there && object.self_collision;
  body.thickness = object.thickness;
  body.static_friction = object.static_friction;
  body.kinetic_friction = object.kinetic_friction;
  body.restitution = object.restitution;
  return body;
}

/// Applies the overrides of pairs that the scene names.
void set_exceptions(const Model& model, ContactRules& rules) {
  std::map<std::string, std::vector<int>> named;
  for (int o = 0; o < rules.bodies(); ++o) named[model.objects[o].name].push_back(o);
  for (const PairProperties& pair : model.pairs)
    for (const int a : named[pair.first])
      for (const int b : named[pair.second]) {
        PairMaterial material = rules.material(a, b);
        apply(pair, material);
        rules.set_material(a, b, material);
      }
}

/// Updates the changed bodies. If the scene names pairs, all rules are rebuilt, because overrides refer to names of
/// objects.
void update_rules(const Model& model, const std::vector<int>& changed, ContactRules& rules) {
  if (!model.pairs.empty()) rules = {};
  for (int o = rules.bodies(); o < static_cast<int>(model.objects.size()); ++o) rules.add(body_of(model.objects[o]));
  if (!model.pairs.empty()) return set_exceptions(model, rules);
  for (const int o : changed) rules.set(o, body_of(model.objects[o]));
}

}  // namespace

void apply(const PairProperties& said, PairMaterial& material) {
  material.thickness = said.thickness.value_or(material.thickness);
  material.static_friction = said.static_friction.value_or(material.static_friction);
  material.kinetic_friction =
      std::min(said.kinetic_friction.value_or(material.kinetic_friction), material.static_friction);
  material.restitution = said.restitution.value_or(material.restitution);
}

ContactRules contact_rules(const Model& model) {
  ContactRules rules;
  update_rules(model, {}, rules);
  return rules;
}

void update_tables(const Model& model, const std::vector<int>& changed, ContactTables& out) {
  update_rules(model, changed, out.rules);
  const auto particles = static_cast<std::size_t>(model.particles());
  out.body_set.resize(model.objects.size(), -1);
  out.rest.resize(particles);
  out.vertex_body.resize(particles, -1);
  out.vertex_cluster.resize(particles, -1);
  out.permitted_shares.resize(particles, 1.f);
}

}  // namespace pliant
