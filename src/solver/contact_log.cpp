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
    const double impulse = double(contact.push) * a.inverse_h / x.w;
    add({object, by, impulse, contact.normal, place_of(x, a.displacements[contact.particle])}, log);
  }
}

/// Where the first side is, and what moving the two sides apart takes: the inverse mass of their relative place.
void log_pair(const Substep& s, const PairContact& contact, ContactLog& log) {
  if (!(contact.push > 0)) return;
  int on = 0, by = 0;
  double mobility = 0;
  Vec3d at{};
  for (int i = 0; i < 4; ++i) {
    const int v = contact.vertex[i];
    const double weight = contact.weight[i];
    mobility += s.state.positions[v].w * weight * weight;
    (weight > 0 ? on : by) = s.model.object_of(v);
    if (weight > 0) at += place_of(s.state.positions[v], s.work.displacements[v]) * weight;
  }
  if (mobility > 0) add({on, by, contact.push / (mobility * s.h), contact.normal, at}, log);
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
