#include "solver/drivers/contacts.h"
#include "solver/bodies/body_solver.h"

#include <algorithm>
#include <utility>

#include "solver/collider_depenetration.h"
#include "solver/contact_kernels.h"
#include "solver/drivers/driver.h"
#include "solver/object_lookup.h"

namespace pliant {

namespace {

/// Contacts found during the solve are dropped if their overlap is below this share of the thickness; the next substep
/// resolves them. If they were resolved at once, cloth at rest on a floor would move two to four times as much.
constexpr float least_depth = 0.25f;
/// How often the particles of a liquid are held at solids within a substep.
constexpr int most_rounds_in_corners = 3;

/// Extends a tile's bounds to the current positions of its particles.
void grow_bounds(const AdvanceArguments& a, PointBounds& bounds) {
  for (int i = a.first; i < a.last; ++i) {
    const Record &x = a.positions[i], &d = a.displacements[i];
    bounds.low = {min(bounds.low.x, x.x + d.x), min(bounds.low.y, x.y + d.y), min(bounds.low.z, x.z + d.z), 0};
    bounds.high = {max(bounds.high.x, x.x + d.x), max(bounds.high.y, x.y + d.y), max(bounds.high.z, x.z + d.z), 0};
  }
}

void find_more_in_tile(Substep& s, int task) {
  TileScratch& scratch = s.work.tiles[task];
  const AdvanceArguments a = particles(s, task);
  const CompiledObject& object = object_of(s, task);
  grow_bounds(a, scratch.bounds);
  scratch.more_contacts.clear();
  find_contacts(
      {object, a, scratch.bounds, s.own->colliders, s.kernels.find_near, s.kernels.contacts.make_point_contacts},
      scratch.near, scratch.more_contacts);
  follow_ways_out(s, task, scratch.more_contacts);
  const auto is_shallow = [&](const Contact& c) {
    const Record& d = a.displacements[c.point[0]];
    const float thickness = object.thickness + s.own->colliders[c.collider].thickness;
    return c.gap + dot(c.normal, Vec3f{d.x, d.y, d.z}) > -least_depth * thickness;
  };
  std::erase_if(scratch.more_contacts, is_shallow);
  if (scratch.more_contacts.empty()) return;
  merge_contacts(scratch.contacts, scratch.more_contacts, scratch.all_contacts);
  std::swap(scratch.contacts, scratch.all_contacts);
}

/// Projects particles that constraints moved below a plane collider and that had no predicted contact, and those of
/// liquids that they moved into any solid. They move to the surface, not to the thickness: otherwise cloth at rest on a
/// floor would move two to four times as much.
void hold_tile_at_surfaces(Substep& s, int task) {
  TileScratch& scratch = s.work.tiles[task];
  const AdvanceArguments a = particles(s, task);
  const ContactSearch search{object_of(s, task),  a,
                             scratch.bounds,      s.own->colliders,
                             s.kernels.find_near, s.kernels.contacts.make_point_contacts};
  if (search.object.fluid) grow_bounds(a, scratch.bounds);  // the density moves particles far
  // What leaves one solid may enter another, in a corner.
  const int rounds = search.object.fluid ? most_rounds_in_corners : 1;
  for (int round = 0; round < rounds; ++round) {
    scratch.more_contacts.clear();
    find_breaches(search, scratch.contacts, scratch.near, scratch.more_contacts);
    if (scratch.more_contacts.empty()) return;
    project_contacts(scratch.more_contacts, arguments(s, s.model.tiles()[task].object, false));
    merge_contacts(scratch.contacts, scratch.more_contacts, scratch.all_contacts);
    std::swap(scratch.contacts, scratch.all_contacts);
  }
}

}  // namespace

void project_surface_contacts(Substep& s, const Phase& /*phase*/, const Pass& /*pass*/) { sweep_pairs(s); }

void project_collider_contacts(Substep& s, const Phase& /*phase*/, const Pass& /*pass*/) { sweep_contacts(s); }

namespace {

/// Projects the shape contacts of the objects whose sweep runs. Each object gets the same bits as when it is alone,
/// because no shape contact joins two objects.
void sweep_shape_contacts(Substep& s) {
  constexpr const char* name = "solve: contacts";
  std::vector<Contact>& contacts = s.own->shape_contacts;
  Record* displacements = s.work.displacements.data();
  const ContactSolver& solver = s.own->shape_contact_solver;
  if (s.group == nullptr || s.work.sweeps.size() == 1)
    return solver.project(s.context.executor, name, contacts, displacements);
  solver.for_each(s.context.executor, name, contacts, [&](const Contact& contact) {
    if (is_swept(s, s.model.object_of(contact.point[0])))
      project_contact(contacts[static_cast<std::size_t>(&contact - contacts.data())], displacements);
  });
}

}  // namespace

void sweep_contacts(Substep& s) {
  if (s.own->colliders.empty()) return;
  sweep_shape_contacts(s);
  for_swept_tiles(s, "solve: contacts", [&](int task) {
    std::vector<Contact>& contacts = s.work.tiles[task].contacts;
    if (!contacts.empty()) project_contacts(contacts, arguments(s, s.model.tiles()[task].object, false));
  });
}

namespace {

/// True if a point of the contact belongs to an object for which `has(object)` is true.
template <class Has>
bool concerns_any(ObjectLookup& objects, const Contact& contact, const Has& has) {
  for (std::size_t i = 0; i < contact.point.size(); ++i)
    if (contact.weight[i] != 0 && has(objects.of(contact.point[i]))) return true;
  return false;
}

}  // namespace

void sweep_pairs(Substep& s) {
  if (!s.has_pairs()) return;
  constexpr const char* name = "solve: contacts among surfaces";
  std::vector<Contact>& contacts = s.pairs->contacts();
  Record* displacements = s.work.displacements.data();
  if (s.group == nullptr || s.work.sweeps.size() == 1)
    return s.own->contact_solver.project(s.context.executor, name, contacts, displacements);
  // Objects of other sweeps keep the bits that they have alone.
  ObjectLookup objects(s.model);
  const auto is_of_group = [&](int object) { return is_swept(s, object); };
  s.own->contact_solver
      .only(contacts, [&](const Contact& contact) { return concerns_any(objects, contact, is_of_group); })
      .project(s.context.executor, name, contacts, displacements);
}

namespace {

/// True if one side takes nearly all of a contact's corrections, because the other is at least twenty times as heavy
/// but can move: a stone on cloth. If such a contact yielded, the light side would be pulled into the heavy one in
/// every substep, farther than the little that a correction moves the heavy side. Stones 70 times as heavy as the
/// particles of a bag of cloth lay 1 mm from it instead of 11.
bool is_lopsided(const Contact& c) {
  constexpr float least_share = 0.05f;
  float first = 0, second = 0;
  for (std::size_t i = 0; i < c.point.size(); ++i) (c.weight[i] > 0 ? first : second) += c.weight[i] * c.share[i];
  const float lesser = std::min(first, second);
  return lesser > 0 && lesser < least_share;
}

/// Projects the contacts for which `concerns` is true. Lopsided ones do not yield, and come last, so that they prevail.
void project_yielding(Substep& s, const char* name, std::vector<Contact>& contacts, float yield,
                      FunctionRef<bool(const Contact&)> concerns) {
  const ContactSolver& solver = s.own->contact_solver;
  const auto yields = [&](const Contact& contact) { return !is_lopsided(contact) && concerns(contact); };
  const auto holds = [&](const Contact& contact) { return is_lopsided(contact) && concerns(contact); };
  Record* displacements = s.work.displacements.data();
  solver.only(contacts, yields).project(s.context.executor, name, contacts, displacements, yield);
  solver.only(contacts, holds).project(s.context.executor, name, contacts, displacements);
}

}  // namespace

void project_contacts_of(Substep& s, const char* name, const std::vector<char>& has, float yield) {
  ObjectLookup objects(s.model);
  const auto concerns = [&](const Contact& contact) {
    return concerns_any(objects, contact, [&](int object) { return has[object] != 0; });
  };
  const bool all = std::all_of(has.begin(), has.end(), [](char is_set) { return is_set != 0; });
  const auto project = [&](const ContactSolver& solver, std::vector<Contact>& contacts, float left) {
    Record* displacements = s.work.displacements.data();
    if (left > 0 && std::any_of(contacts.begin(), contacts.end(), is_lopsided))
      return project_yielding(s, name, contacts, left, concerns);
    if (all) return solver.project(s.context.executor, name, contacts, displacements, left);
    solver.only(contacts, concerns).project(s.context.executor, name, contacts, displacements, left);
  };
  if (s.bodies != nullptr) s.bodies->project_points(s, has);
  if (s.has_pairs()) project(s.own->contact_solver, s.pairs->contacts(), yield);
  if (s.own->colliders.empty()) return;
  project(s.own->shape_contact_solver, s.own->shape_contacts, 0);
  for_tiles(s, name, [&](int task) {
    const int object = s.model.tiles()[task].object;
    std::vector<Contact>& contacts = s.work.tiles[task].contacts;
    if (has[object] != 0 && !contacts.empty()) project_contacts(contacts, arguments(s, object, false));
  });
}

void for_touching_points(const Substep& s, FunctionRef<void(int)> visit) {
  const auto visit_points = [&](const std::vector<Contact>& contacts) {
    for (const Contact& contact : contacts)
      for (std::size_t i = 0; i < contact.point.size(); ++i)
        if (contact.push > 0 && contact.weight[i] != 0) visit(contact.point[i]);
  };
  if (!s.own->colliders.empty()) visit_points(s.own->shape_contacts);
  if (s.bodies != nullptr) visit_points(s.bodies->point_contacts());
  if (s.has_pairs()) visit_points(s.pairs->contacts());
}

void find_more_contacts(Substep& s) {
  if (s.own->colliders.empty()) return;
  for_swept_tiles(s, "solve: contacts", [&](int task) { find_more_in_tile(s, task); });
}

void hold_at_surfaces(Substep& s) {
  if (s.own->colliders.empty()) return;
  for_swept_tiles(s, "solve: contacts", [&](int task) { hold_tile_at_surfaces(s, task); });
}

}  // namespace pliant
