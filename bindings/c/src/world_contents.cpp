// What is in a World: finding, adding and removing, and its contacts.
#include "arrays.h"
#include "memory.h"
#include "world_handle.h"

namespace pliant::c {

namespace {

const char* word_of(std::int32_t kind) {
  return kind == PLIANT_OBJECT ? "object" : kind == PLIANT_COLLIDER ? "primitive collider" : "mesh collider";
}

std::string one_of(std::int32_t kind) { return std::string(kind == PLIANT_OBJECT ? "an " : "a ") + word_of(kind); }

[[noreturn]] void refuse_kind(std::int32_t kind) {
  throw StatusError(PLIANT_REFUSED, std::to_string(kind) + " is no kind of thing",
                    "give PLIANT_OBJECT, PLIANT_COLLIDER or PLIANT_MESH_COLLIDER");
}

template <class Id>
Id require_id(const World& world, pliant_id id, std::int32_t kind) {
  if (id.kind < PLIANT_OBJECT || id.kind > PLIANT_MESH_COLLIDER) refuse_kind(id.kind);
  if (id.kind != kind)
    throw StatusError(PLIANT_REFUSED, "the id is that of " + one_of(id.kind), "pass that of " + one_of(kind));
  if (const Id found(id.slot, id.generation); world.has(found)) return found;
  throw StatusError(PLIANT_STALE,
                    std::string("there is no ") + word_of(kind) + " " + std::to_string(id.slot) + " of generation " +
                        std::to_string(id.generation),
                    "it was removed, or is of another World; pliant_world_ids lists those that exist");
}

pliant_id id_of(ObjectId id) { return {PLIANT_OBJECT, id.slot, id.generation}; }
pliant_id id_of(ColliderId id) { return {PLIANT_COLLIDER, id.slot, id.generation}; }
pliant_id id_of(MeshColliderId id) { return {PLIANT_MESH_COLLIDER, id.slot, id.generation}; }
pliant_id id_of(const Thing& thing) { return {static_cast<std::int32_t>(thing.kind), thing.slot, thing.generation}; }
static_assert(static_cast<int>(Thing::Kind::mesh_collider) == PLIANT_MESH_COLLIDER);

template <class Id>
std::vector<pliant_id> ids_of(const std::vector<Id>& from) {
  std::vector<pliant_id> ids;
  ids.reserve(from.size());
  for (const Id& id : from) ids.push_back(id_of(id));
  return ids;
}

/// Gives an id that was found, or throws a StatusError.
template <class Id>
void give_found(const World& world, const std::optional<Id>& found, const char* name, std::int32_t kind,
                pliant_id* into) {
  if (found) {
    *into = id_of(*found);
    return;
  }
  const std::int32_t other = world.find(name)                 ? PLIANT_OBJECT
                             : world.find_collider(name)      ? PLIANT_COLLIDER
                             : world.find_mesh_collider(name) ? PLIANT_MESH_COLLIDER
                                                              : kind;
  throw StatusError(
      PLIANT_NOT_FOUND, std::string("there is no ") + word_of(kind) + " '" + name + "'",
      other == kind ? "pliant_world_ids and pliant_world_name list those that exist" : "it is " + one_of(other));
}

/// Throws a StatusError unless contacts are recorded.
void require_recorded(const WorldHandle& world) {
  if (!world.records_contacts)
    throw StatusError(PLIANT_REFUSED, "contacts are not recorded",
                      "call pliant_world_record_contacts before the step; a loaded World does not record them");
}

pliant_contact contact_of(const ContactEvent& event) {
  pliant_contact contact{};
  contact.change = static_cast<std::int32_t>(event.change);
  contact.first = id_of(event.first);
  contact.second = id_of(event.second);
  contact.contacts = event.contacts;
  contact.impulse = event.impulse;
  put3(event.position, contact.position);
  put3(event.normal, contact.normal);
  put3(event.push, contact.push_on_first);
  return contact;
}

pliant_body_touch touch_of(const BodyTouch& from) {
  pliant_body_touch touch{};
  touch.first = id_of(from.first.thing);
  touch.first_body = from.first.body;
  touch.second = id_of(from.second.thing);
  touch.second_body = from.second.body;
  touch.contacts = from.contacts;
  touch.impulse = from.impulse;
  put3(from.position, touch.position);
  put3(from.push, touch.push_on_first);
  return touch;
}

SceneReadOptions with_arrays(const pliant_array* arrays, size_t count) {
  SceneReadOptions options;
  options.arrays = arrays_of(arrays, count);
  return options;
}

}  // namespace

ObjectId object_id(const World& world, pliant_id id) { return require_id<ObjectId>(world, id, PLIANT_OBJECT); }
ColliderId collider_id(const World& world, pliant_id id) { return require_id<ColliderId>(world, id, PLIANT_COLLIDER); }
MeshColliderId mesh_collider_id(const World& world, pliant_id id) {
  return require_id<MeshColliderId>(world, id, PLIANT_MESH_COLLIDER);
}

}  // namespace pliant::c

using namespace pliant;
using namespace pliant::c;

pliant_status pliant_world_find(const pliant_world* world, int32_t kind, const char* name, pliant_id* id) {
  return guarded([&] {
    const auto of = at(world);
    require(name, "name");
    require(id, "id");
    if (kind == PLIANT_OBJECT) return give_found(of->world, of->world.find(name), name, kind, id);
    if (kind == PLIANT_COLLIDER) return give_found(of->world, of->world.find_collider(name), name, kind, id);
    if (kind == PLIANT_MESH_COLLIDER) return give_found(of->world, of->world.find_mesh_collider(name), name, kind, id);
    refuse_kind(kind);
  });
}

pliant_status pliant_world_ids(const pliant_world* world, int32_t kind, pliant_id* into, size_t capacity,
                               size_t* count) {
  return guarded([&] {
    const auto of = at(world);
    const Room<pliant_id> room{into, capacity, count};
    if (kind == PLIANT_OBJECT) return give_list<pliant_id>(ids_of(of->world.objects()), room, "ids");
    if (kind == PLIANT_COLLIDER) return give_list<pliant_id>(ids_of(of->world.colliders()), room, "ids");
    if (kind == PLIANT_MESH_COLLIDER) return give_list<pliant_id>(ids_of(of->world.mesh_colliders()), room, "ids");
    refuse_kind(kind);
  });
}

pliant_status pliant_world_name(const pliant_world* world, pliant_id id, char* into, size_t capacity, size_t* length) {
  return guarded([&] {
    const auto of = at(world);
    const World& in = of->world;
    const Room<char> room{into, capacity, length};
    if (id.kind == PLIANT_COLLIDER) return give_text(in.collider(collider_id(in, id)).name(), room);
    if (id.kind == PLIANT_MESH_COLLIDER) return give_text(in.mesh_collider(mesh_collider_id(in, id)).name(), room);
    give_text(in.object(object_id(in, id)).name(), room);
  });
}

pliant_status pliant_world_add_object(pliant_world* world, const char* json, const pliant_array* arrays, size_t count,
                                      pliant_id* id) {
  return guarded([&] {
    const auto to = at(world);
    require(json, "json");
    const ObjectId made = to->world.add(parse_object(json, "object", to->folder, with_arrays(arrays, count)));
    if (id != nullptr) *id = id_of(made);
  });
}

pliant_status pliant_world_add_collider(pliant_world* world, const char* json, const pliant_array* arrays, size_t count,
                                        pliant_id* id) {
  return guarded([&] {
    const auto to = at(world);
    require(json, "json");
    const auto collider = parse_collider(json, "collider", to->folder, with_arrays(arrays, count));
    const pliant_id made = std::visit([&](const auto& one) { return id_of(to->world.add(one)); }, collider);
    if (id != nullptr) *id = made;
  });
}

pliant_status pliant_world_remove(pliant_world* world, pliant_id id) {
  return guarded([&] {
    const auto of = at(world);
    for_any_kind(of->world, id, [&](auto known) { of->world.remove(known); });
  });
}

pliant_status pliant_world_record_contacts(pliant_world* world, int32_t on) {
  return guarded([&] {
    const auto of = at(world);
    of->world.record_contact_events(on != 0);
    of->records_contacts = on != 0;
  });
}

pliant_status pliant_world_contacts(const pliant_world* world, pliant_contact* into, size_t capacity, size_t* count) {
  return guarded([&] {
    const auto of = at(world);
    require_recorded(*of);
    const std::vector<ContactEvent>& events = of->world.contact_events();
    if (!tell<pliant_contact>({into, capacity, count}, events.size(), "contacts")) return;
    std::transform(events.begin(), events.end(), into, contact_of);
  });
}

pliant_status pliant_world_body_touches(const pliant_world* world, pliant_body_touch* into, size_t capacity,
                                        size_t* count) {
  return guarded([&] {
    const auto of = at(world);
    require_recorded(*of);
    const std::vector<BodyTouch>& touches = of->world.body_touches();
    if (!tell<pliant_body_touch>({into, capacity, count}, touches.size(), "touches")) return;
    std::transform(touches.begin(), touches.end(), into, touch_of);
  });
}

pliant_status pliant_world_record_joint_loads(pliant_world* world, int32_t on) {
  return guarded([&] {
    const auto of = at(world);
    of->world.record_joint_loads(on != 0);
    of->records_joint_loads = on != 0;
  });
}
