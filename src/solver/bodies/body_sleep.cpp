#include "solver/bodies/body_sleep.h"

#include <algorithm>
#include <iterator>

#include "collision/bodies/body_contacts.h"
#include "solver/bodies/body_math.h"
#include "solver/substep.h"

namespace pliant {

namespace {

bool is_zero(const Record& r) { return r.x == 0 && r.y == 0 && r.z == 0; }

/// True if a particle follows keyframes.
bool is_kinematic(const CompiledObject& object, int particle) {
  return std::any_of(object.kinematics.begin(), object.kinematics.end(),
                     [&](const Kinematic& kinematic) { return kinematic.particle == particle; });
}

}  // namespace

bool slides(const BodyState& state) { return length_squared(state.surface_velocity) > 0; }

bool moves(const BodyState& state) {
  return state.deforms || slides(state) || length_squared(state.velocity) > 0 || length_squared(state.spin) > 0;
}

BodySleep::BodySleep(const Model& model, const ContactBodies& bodies, const BodyIslands& islands)
    : model_(&model),
      bodies_(&bodies),
      links_(&islands),
      first_body_(model.objects.size(), -1),
      is_tied_(at(bodies.dynamic())),
      held_(bodies, islands.links()) {
  for (int body = count(); body-- > 0;) {
    const BodyPlace& place = bodies.places()[at(body)];
    first_body_[at(place.object)] = body;
    has_kinematic_ =
        has_kinematic_ || is_kinematic(model.objects[at(place.object)], place.particle - model.first[at(place.object)]);
  }
  for (const BodyLink& link : islands.links()) {
    if (link.a >= count() && link.b < count()) is_tied_[at(link.b)] = 1;
    if (link.b >= count() && link.a < count()) is_tied_[at(link.a)] = 1;
  }
}

float& BodySleep::rest_time(Substep& s, int body) const {
  return s.state.rest_times[at(bodies_->places()[at(body)].frame)];
}

bool BodySleep::is_broken(const Substep& s, const BodyLink& link) const {
  const std::vector<int>& broken = s.work.joints[at(link.object)].broken;
  return link.joint >= 0 && std::binary_search(broken.begin(), broken.end(), link.joint);
}

int BodySleep::body_of(const ContactPart& part) const {
  if (part.owner < 0 || first_body_[at(part.owner)] < 0) return -1;
  return first_body_[at(part.owner)] + model_->objects[at(part.owner)].bodies.solids[at(part.solid)].body;
}

bool BodySleep::involves_sleeper(const BodyContact& contact) const {
  const int a = body_of(contact.a), b = body_of(contact.b);
  return (a >= 0 && held_.holds(a)) || (b >= 0 && held_.holds(b));
}

// ---------------------------------------------------------------- a frame's start

/// True if the user may move a fixed body in this frame, which nothing else would notice.
bool BodySleep::moves_fixed_body(const Substep& s) const {
  for (int body = 0; body < count(); ++body) {
    const BodyPlace& place = bodies_->places()[at(body)];
    if (s.state.positions[at(place.particle)].w == 0 && s.work.control.object(place.object) != nullptr) return true;
  }
  return false;
}

void BodySleep::begin_frame(Substep& s, std::span<const BodyContact> contacts) {
  held_.clear();
  kept_.clear();
  is_on_ = s.context.sleep.on;
  if (!is_on_) {
    s.state.rest_times.clear();
  } else {
    s.state.rest_times.resize(s.state.frames.size(), 0.f);
    const Wind& wind = s.model.wind;
    const bool gusts = wind.air_density > 0 && wind.gust != 0 && length_squared(wind.velocity) > 0;
    is_restless_ = has_kinematic_ || !s.model.forces.empty() || gusts || moves_fixed_body(s);
    for (int body = 0; body < count(); ++body)
      if (rest_time(s, body) == asleep) held_.hold(s.state, body);
    if (any()) wake_pushed(s, contacts);
  }
  held_.leave_out_constraints(s);
}

/// Joins the bodies that sleep and have a contact or a constraint with one another.
void BodySleep::find_islands(const Substep& s, std::span<const BodyContact> contacts) {
  islands_.reset(count());
  const auto join = [&](int a, int b) {
    if (a >= 0 && b >= 0 && held_.holds(a) && held_.holds(b)) islands_.unite(a, b);
  };
  for (const BodyContact& contact : contacts) join(body_of(contact.a), body_of(contact.b));
  for (const BodyLink& link : links_->links())
    if (link.a < count() && link.b < count() && !is_broken(s, link)) join(link.a, link.b);
}

/// True if the user acts on a body of its object in this frame.
bool BodySleep::is_driven(const Substep& s, int body) const {
  return is_restless_ || s.work.control.object(bodies_->places()[at(body)].object) != nullptr;
}

/// Wakes bodies that have a velocity, because a State was restored with one, those on which the user acts, and those
/// that a constraint connects with a body that is awake.
void BodySleep::wake_pushed(Substep& s, std::span<const BodyContact> contacts) {
  std::vector<char> is_woken(at(count()));
  for (const HeldBodies::Held& held : held_.all()) {
    const BodyPlace& place = bodies_->places()[at(held.body)];
    const bool has_velocity = !is_zero(s.state.velocities[at(place.particle)]) ||
                              !is_zero(s.state.frames.angular_velocities[at(place.frame)]);
    if (has_velocity || is_driven(s, held.body) || is_tied_[at(held.body)] != 0) is_woken[at(held.body)] = 1;
  }
  const auto is_awake = [&](int body) {
    const BodyPlace& place = bodies_->places()[at(body)];
    return !held_.holds(body) &&
           (s.state.positions[at(place.particle)].w > 0 || !is_zero(s.state.frames.inverse_inertias[at(place.frame)]));
  };
  for (const BodyLink& link : links_->links()) {
    if (link.a >= count() || link.b >= count() || is_broken(s, link)) continue;
    if (is_awake(link.a)) is_woken[at(link.b)] = 1;
    if (is_awake(link.b)) is_woken[at(link.a)] = 1;
  }
  wake(s, contacts, is_woken);
}

bool BodySleep::wake_touched(Substep& s, std::span<const std::pair<int, int>> pairs,
                             std::span<const BodyContact> contacts) {
  std::vector<char> is_woken(at(count()));
  bool any_woken = false;
  for (const auto& [a, b] : pairs)  // two bodies that do not move have none
    for (const int place : {a, b}) {
      if (place >= count() || !held_.holds(place)) continue;
      is_woken[at(place)] = 1;
      any_woken = true;
    }
  if (!any_woken) return false;
  wake(s, contacts, is_woken);
  held_.leave_out_constraints(s);
  return true;
}

/// Wakes the islands of the bodies that are marked.
void BodySleep::wake(Substep& s, std::span<const BodyContact> contacts, std::vector<char>& is_woken) {
  if (std::find(is_woken.begin(), is_woken.end(), char{1}) == is_woken.end()) return;
  find_islands(s, contacts);
  for (const HeldBodies::Held& held : held_.all())
    if (is_woken[at(held.body)] != 0) is_woken[at(islands_.find(held.body))] = 1;
  held_.release(s.state, [&](int body) {
    const bool wakes = is_woken[at(islands_.find(body))] != 0;
    if (wakes) rest_time(s, body) = 0;
    return wakes;
  });
}

void BodySleep::keep_contacts(bool is_alone, std::vector<BodyContact>& contacts) {
  if (held_.holds_every_body() && is_alone) {
    kept_.swap(contacts);  // all of them, and a copy takes many bytes
    contacts.clear();
    return;
  }
  std::copy_if(contacts.begin(), contacts.end(), std::back_inserter(kept_),
               [&](const BodyContact& c) { return involves_sleeper(c); });
}

// ---------------------------------------------------------------- its end

int BodySleep::end_frame(Substep& s, const Frame& frame) {
  held_.put_back(s.state);
  std::vector<char> is_woken(at(count()));
  for (const int body : frame.pressed) is_woken[at(body)] = held_.holds(body) ? 1 : 0;
  if (any()) wake(s, kept_, is_woken);
  add_rest(s, frame);
  return fall_asleep(s, frame);
}

/// Counts for how long each body has been slow.
void BodySleep::add_rest(Substep& s, const Frame& frame) {
  const SleepOptions& options = s.context.sleep;
  std::vector<char> is_touched(is_tied_);
  for (const int body : frame.pressed) is_touched[at(body)] = 1;
  for (const auto& [a, b] : frame.pairs) {  // colliders come after bodies
    const auto disturbs = [&](int of) {
      return of >= count() ? moves(frame.states[at(of)]) : slides(frame.states[at(of)]);
    };
    if (a < count() && disturbs(b)) is_touched[at(a)] = 1;
    if (b < count() && disturbs(a)) is_touched[at(b)] = 1;
  }
  for (int body = 0; body < count(); ++body) {
    if (held_.holds(body)) continue;
    const BodyPlace& place = bodies_->places()[at(body)];
    const Vec3f v = xyz(s.state.velocities[at(place.particle)]),
                w = xyz(s.state.frames.angular_velocities[at(place.frame)]);
    const bool is_slow =
        length_squared(v) < options.speed * options.speed && length_squared(w) < options.spin * options.spin;
    const bool rests = is_slow && is_touched[at(body)] == 0 && !frame.states[at(body)].is_fixed && !is_driven(s, body);
    rest_time(s, body) = rests ? rest_time(s, body) + static_cast<float>(s.dt) : 0;
  }
}

/// Lets the islands sleep whose bodies have all been slow for long enough.
int BodySleep::fall_asleep(Substep& s, const Frame& frame) {
  islands_.reset(count());
  const auto is_free = [&](int body) {
    return body < count() && !held_.holds(body) && !frame.states[at(body)].is_fixed;
  };
  const auto join = [&](int a, int b) {
    if (is_free(a) && is_free(b)) islands_.unite(a, b);
  };
  for (const auto& [a, b] : frame.pairs) join(a, b);
  for (const BodyLink& link : links_->links())
    if (!is_broken(s, link)) join(link.a, link.b);
  std::vector<char> is_awake(at(count()));
  for (int body = 0; body < count(); ++body)
    if (is_free(body) && !(rest_time(s, body) >= s.context.sleep.time && rest_time(s, body) > 0))
      is_awake[at(islands_.find(body))] = 1;
  auto sleeping = static_cast<int>(held_.all().size());
  Vec3d lost{};
  for (int body = 0; body < count(); ++body) {
    if (!is_free(body) || is_awake[at(islands_.find(body))] != 0) continue;
    const BodyPlace& place = bodies_->places()[at(body)];
    rest_time(s, body) = asleep;
    lost += convert<double>(xyz(s.state.velocities[at(place.particle)])) *
            (1 / double(s.state.positions[at(place.particle)].w));
    s.state.remainders[at(place.particle)] = s.state.velocities[at(place.particle)] = {};
    s.state.frames.angular_velocities[at(place.frame)] = {};
    ++sleeping;
  }
  s.report.lost_momentum.sleep += length(lost);
  return sleeping;
}

void BodySleep::add_kept_contacts(std::vector<BodyContact>& contacts) {
  if (kept_.empty()) return;
  if (contacts.empty()) return contacts.swap(kept_);
  merged_.clear();
  std::merge(contacts.begin(), contacts.end(), kept_.begin(), kept_.end(), std::back_inserter(merged_), in_order);
  contacts.swap(merged_);
}

}  // namespace pliant
