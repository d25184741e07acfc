#include "solver/contact_log.h"

#include <algorithm>

#include "solver/substep.h"

namespace pliant {

namespace {

struct Push {
  int on = 0, by = 0;  ///< bodies
  double impulse = 0;  ///< [N s]
  Vec3f normal{};      ///< in which `on` is pushed
  Vec3d at{};          ///< [m]
};

void add(const Push& push, ContactLog& log) {
  ContactSum& sum = log[std::minmax(push.on, push.by)];
  ++sum.in_substep;
  sum.impulse += push.impulse;
  const double sign = push.on <= push.by ? 1 : -1;
  sum.push += convert<double>(push.normal) * (sign * push.impulse);
  sum.moment += push.at * push.impulse;
}

/// Normal impulse over inverse mass, as a speed: of the push, and of the restitution that the end of the substep makes of the speed
/// at which it leaves the two.
double speed_of(float push, float leaving, float approach, float restitution, float slow, float inverse_h) {
  const float wanted = -approach > slow ? -restitution * approach : 0.f;
  return std::max(0., double(push) * inverse_h + (double(wanted) - leaving));
}

Vec3f vector_of(const Record& r) { return {r.x, r.y, r.z}; }

Vec3d place_of(const Record& position, const Record& displacement) {
  return {double(position.x) + displacement.x, double(position.y) + displacement.y, double(position.z) + displacement.z};
}

void log_tile(const Substep& s, int task, ContactLog& log) {
  const int object = s.model.tiles[task].object, colliders = static_cast<int>(s.model.colliders.size());
  const AdvanceArguments a = particles(s, task);
  for (const Contact& contact : s.work.tiles[task].contacts) {
    const Record& x = a.positions[contact.particle];
    if (!(contact.push > 0) || !(x.w > 0)) continue;
    const bool is_field = contact.collider >= colliders;
    const int by = is_field ? s.model.fields[contact.collider - colliders].object : body_of_collider(contact.collider);
    const Record& d = a.displacements[contact.particle];
    const Vec3f motion = vector_of(d) - vector_of(a.remainders[contact.particle]) - contact.surface_motion;
    const float leaving = dot(contact.normal, motion) * a.inverse_h;
    const double speed =
        speed_of(contact.push, leaving, contact.approach, contact.restitution, 2 * length(a.gravity_step), a.inverse_h);
    add({object, by, speed / x.w, contact.normal, place_of(x, d)}, log);
  }
}

/// Without restitution the end of a substep only takes away the speed at which a push makes the two separate.
void log_pair(const Substep& s, const PairContact& contact, ContactLog& log) {
  if (!(contact.push > 0)) return;
  int on = 0, by = 0;
  double mobility = 0;  // inverse mass of the relative place
  Vec3d at{};
  Vec3f motion{};
  for (int i = 0; i < 4; ++i) {
    const int v = contact.vertex[i];
    const double weight = contact.weight[i];
    mobility += s.state.positions[v].w * weight * weight;
    (weight > 0 ? on : by) = s.model.object_of(v);
    motion += (vector_of(s.work.displacements[v]) - vector_of(s.state.remainders[v])) * contact.weight[i];
    if (weight > 0) at += place_of(s.state.positions[v], s.work.displacements[v]) * weight;
  }
  if (!(mobility > 0)) return;
  const float leaving = dot(contact.normal, motion) / s.h, slow = 2 * length(s.model.gravity) * s.h;
  const bool bounces = contact.restitution > 0 && -contact.approach > slow;
  const double speed = speed_of(contact.push, bounces ? leaving : std::max(leaving, 0.f), contact.approach,
                                contact.restitution, slow, 1 / s.h);
  add({on, by, speed / mobility, contact.normal, at}, log);
}

}  // namespace

void log_contacts(const Substep& s, ContactLog& log) {
  for (int task = 0; task < static_cast<int>(s.model.tiles.size()); ++task) log_tile(s, task, log);
  if (s.has_pairs())
    for (const PairContact& contact : s.work.pairs->contacts()) log_pair(s, contact, log);
  for (auto& [bodies, sum] : log) {
    sum.contacts = std::max(sum.contacts, sum.in_substep);
    sum.in_substep = 0;
  }
}

}  // namespace pliant
