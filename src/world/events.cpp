// Contact events: compares the contacts between bodies in this step with those of the previous step.
#include <algorithm>

#include "math/vector.h"
#include "world/implementation.h"

namespace pliant {

namespace {

Vec3f direction_of(const Vec3d& push, double impulse) {
  const double size = length(push);
  return size > 1e-6 * impulse ? convert<float>(push * (1 / size)) : Vec3f{};
}

}  // namespace

Thing World::Implementation::thing_of(int body) const {
  if (body < 0) return collider_ids.id_of(-1 - body);
  return model.objects[body].is_collider ? Thing(mesh_collider_ids.id_of(body)) : Thing(object_ids.id_of(body));
}

void World::Implementation::make_events() {
  std::vector<ContactEvent> now;
  for (const auto& [bodies, sum] : *workspace.contact_log) {
    ContactEvent event;
    event.first = thing_of(bodies.first);
    event.second = thing_of(bodies.second);
    event.contacts = sum.contacts;
    event.impulse = sum.impulse;
    event.position = convert<float>(sum.moment * (1 / std::max(sum.impulse, 1e-300)));
    event.normal = direction_of(sum.push, sum.impulse);
    if (event.second < event.first) {
      std::swap(event.first, event.second);
      event.normal = -event.normal;
    }
    now.push_back(event);
  }
  const auto pair = [](const ContactEvent& event) { return std::make_pair(event.first, event.second); };
  const auto before = [&](const ContactEvent& a, const ContactEvent& b) { return pair(a) < pair(b); };
  std::sort(now.begin(), now.end(), before);
  std::vector<ContactEvent> all;
  auto old = touching.begin();
  const auto end_old = [&] {
    all.push_back({ContactEvent::Change::end, old->first, old->second});
    ++old;
  };
  for (ContactEvent& event : now) {
    while (old != touching.end() && *old < pair(event)) end_old();
    if (old != touching.end() && *old == pair(event)) {
      event.change = ContactEvent::Change::persist;
      ++old;
    }
    all.push_back(event);
  }
  while (old != touching.end()) end_old();
  touching.clear();
  for (const ContactEvent& event : now) touching.push_back(pair(event));
  events = std::move(all);
}

/// Removes the contacts of a thing that is removed. It gets no end event, because its id is no longer valid.
void World::Implementation::forget_touching(const Thing& thing) {
  std::erase_if(touching, [&](const auto& pair) { return pair.first == thing || pair.second == thing; });
}

void World::record_contact_events(bool on) {
  self_->events.clear();
  self_->touching.clear();
  self_->workspace.contact_log = on ? std::make_unique<ContactLog>() : nullptr;
}

const std::vector<ContactEvent>& World::contact_events() const { return self_->events; }

}  // namespace pliant
