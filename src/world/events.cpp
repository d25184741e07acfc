// Contact events: compares the contacts between bodies in this step with those of the previous step.
#include "world/events.h"

#include <algorithm>
#include <tuple>

#include "math/vector.h"

namespace pliant {

namespace {

Vec3f direction_of(const Vec3d& push, double impulse) {
  const double size = length(push);
  return size > 1e-6 * impulse ? convert<float>(push * (1 / size)) : Vec3f{};
}

Thing thing_of(const WorldData& world, int body) {
  if (body < 0) return world.ids.colliders.id_of(-1 - body);
  return world.model.objects[body].is_collider ? Thing(world.ids.mesh_colliders.id_of(body))
                                               : Thing(world.ids.objects.id_of(body));
}

/// The sums of each rigid body and what it touched.
std::vector<BodyTouch> body_touches_of(const WorldData& world) {
  std::vector<BodyTouch> touches;
  touches.reserve(world.workspace.contact_log->bodies.size());
  for (const auto& [sides, sum] : world.workspace.contact_log->bodies) {
    BodyTouch touch{{thing_of(world, sides.first.thing), sides.first.body},
                    {thing_of(world, sides.second.thing), sides.second.body},
                    sum.contacts,
                    sum.impulse,
                    convert<float>(sum.moment * (1 / std::max(sum.impulse, 1e-300))),
                    sum.push};
    if (touch.second < touch.first) {
      std::swap(touch.first, touch.second);
      touch.push = -touch.push;
    }
    touches.push_back(touch);
  }
  std::sort(touches.begin(), touches.end(), [](const BodyTouch& a, const BodyTouch& b) {
    return std::tie(a.first, a.second) < std::tie(b.first, b.second);
  });
  return touches;
}

}  // namespace

void make_events(WorldData& world) {
  world.events.touches = body_touches_of(world);
  std::vector<ContactEvent> now;
  for (const auto& [bodies, sum] : world.workspace.contact_log->things) {
    ContactEvent event;
    event.first = thing_of(world, bodies.first);
    event.second = thing_of(world, bodies.second);
    event.contacts = sum.contacts;
    event.impulse = sum.impulse;
    event.position = convert<float>(sum.moment * (1 / std::max(sum.impulse, 1e-300)));
    event.normal = direction_of(sum.push, sum.impulse);
    event.push = sum.push;
    if (event.second < event.first) {
      std::swap(event.first, event.second);
      event.normal = -event.normal;
      event.push = -event.push;
    }
    now.push_back(event);
  }
  const auto pair = [](const ContactEvent& event) { return std::make_pair(event.first, event.second); };
  const auto before = [&](const ContactEvent& a, const ContactEvent& b) { return pair(a) < pair(b); };
  std::sort(now.begin(), now.end(), before);
  std::vector<ContactEvent> all;
  auto old = world.events.touching.begin();
  const auto end_old = [&] {
    all.push_back({ContactEvent::Change::end, old->first, old->second});
    ++old;
  };
  for (ContactEvent& event : now) {
    while (old != world.events.touching.end() && *old < pair(event)) end_old();
    if (old != world.events.touching.end() && *old == pair(event)) {
      event.change = ContactEvent::Change::persist;
      ++old;
    }
    all.push_back(event);
  }
  while (old != world.events.touching.end()) end_old();
  world.events.touching.clear();
  for (const ContactEvent& event : now) world.events.touching.push_back(pair(event));
  world.events.of_last_step = std::move(all);
}

void forget_touching(WorldData& world, const Thing& thing) {
  std::erase_if(world.events.touching, [&](const auto& pair) { return pair.first == thing || pair.second == thing; });
  std::erase_if(world.events.touches,
                [&](const BodyTouch& touch) { return touch.first.thing == thing || touch.second.thing == thing; });
}

void World::record_contact_events(bool on) {
  data_->events.of_last_step.clear();
  data_->events.touching.clear();
  data_->events.touches.clear();
  data_->workspace.contact_log = on ? std::make_unique<ContactLog>() : nullptr;
}

const std::vector<ContactEvent>& World::contact_events() const { return data_->events.of_last_step; }
const std::vector<BodyTouch>& World::body_touches() const { return data_->events.touches; }

}  // namespace pliant
