#include "solver/contact_log.h"

#include <algorithm>

#include "solver/substep.h"

namespace pliant {

namespace {

Vec3d place_of(const Record& position, const Record& displacement) {
  return {double(position.x) + displacement.x, double(position.y) + displacement.y,
          double(position.z) + displacement.z};
}

/// Reads the particles that a contact's point indices refer to.
struct PointReader {
  const Record *positions, *displacements;
  float h;
  int object;  ///< the indices are local to this object; -1: they are indices into the State
};

/// The body of a contact's second side, which is a primitive collider or a mesh collider made into a solid.
int body_of(const Substep& s, std::int32_t collider) {
  const auto colliders = static_cast<std::int32_t>(s.model.colliders.size());
  return collider < colliders ? body_of_collider(collider) : s.model.fields[collider - colliders].object;
}

/// The change of the relative normal velocity in this substep, by projections and by restitution at the end [m/s].
double change_of(const Contact& contact, const PointReader& of, float slow) {
  const Vec3f motion = relative(contact, of.displacements) - contact.carried - contact.surface_motion;
  const float separating = dot(contact.normal, motion) / of.h;
  const float wanted = separation_after(separating, contact.approach, contact.restitution, slow, contact.collider >= 0);
  return std::max(0., double(contact.push) / of.h + (double(wanted) - separating));
}

void log_contact(const Substep& s, const Contact& contact, const PointReader& of, float slow, ContactLog& log) {
  const double mobility = inverse_mass_of(contact, of.positions);
  if (!(contact.push > 0) || !(mobility > 0)) return;
  ContactPush push;
  push.by = contact.collider >= 0 ? body_of(s, contact.collider) : 0;
  push.impulse = change_of(contact, of, slow) / mobility;
  push.normal = contact.normal;
  for (int i = 0; i < 4; ++i) {
    const int point = contact.point[i];
    const float weight = contact.weight[i];
    if (weight == 0) continue;
    (weight > 0 ? push.on : push.by) = of.object >= 0 ? of.object : s.model.object_of(point);
    if (weight > 0) push.at += place_of(of.positions[point], of.displacements[point]) * double(weight);
  }
  add_push(push, log);
}

}  // namespace

namespace {

/// `sign` is -1 where the first of the sums' sides is the one that pushes.
void add_to(ContactSum& sum, const ContactPush& push, double sign) {
  ++sum.in_substep;
  sum.impulse += push.impulse;
  sum.push += convert<double>(push.normal) * (sign * push.impulse);
  sum.moment += push.at * push.impulse;
}

}  // namespace

void add_push(const ContactPush& push, ContactLog& log) {
  add_to(log.things[std::minmax(push.on, push.by)], push, push.on <= push.by ? 1 : -1);
  if (push.on_body < 0 && push.by_body < 0) return;
  const ContactSide on{push.on, push.on_body}, by{push.by, push.by_body};
  add_to(log.bodies[std::minmax(on, by)], push, on <= by ? 1 : -1);
}

void add_pressure(const ContactSide& on, const ContactSide& by, const Vec3d& impulse, const Vec3d& at,
                  ContactLog& log) {
  const double size = length(impulse);
  const auto add = [&](ContactSum& sum, double sign) {
    sum.impulse += size;
    sum.push += impulse * sign;
    sum.moment += at * size;
  };
  add(log.things[std::minmax(on.thing, by.thing)], on.thing <= by.thing ? 1 : -1);
  if (on.body >= 0 || by.body >= 0) add(log.bodies[std::minmax(on, by)], on <= by ? 1 : -1);
}

void finish_substep(ContactLog& log) {
  const auto finish = [](auto& sums) {
    for (auto& [sides, sum] : sums) {
      sum.contacts = std::max(sum.contacts, sum.in_substep);
      sum.in_substep = 0;
    }
  };
  finish(log.things);
  finish(log.bodies);
}

void log_contacts(const Substep& s, ContactLog& log) {
  const float slow = 2 * length(s.model.gravity) * s.h;
  for_each_tile(s, [&](int task) {
    const int object = s.model.tiles()[task].object, first = s.model.first[object];
    const PointReader of{s.state.positions.data() + first, s.work.displacements.data() + first, s.h, object};
    for (const Contact& contact : s.work.tiles[task].contacts) log_contact(s, contact, of, slow, log);
  });
  const PointReader all{s.state.positions.data(), s.work.displacements.data(), s.h, -1};
  for (const Contact& contact : s.own->shape_contacts) log_contact(s, contact, all, slow, log);
  if (s.has_pairs())
    for (const Contact& contact : s.pairs->contacts()) log_contact(s, contact, all, slow, log);
  finish_substep(log);
}

}  // namespace pliant
