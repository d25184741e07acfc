#include "solver/bodies/frame_contacts.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "solver/bodies/body_math.h"
#include "solver/substep.h"

namespace pliant {

namespace {

using namespace bodies;

/// Contacts are found again in a frame if a body has turned by more than this since they were found [rad].
constexpr float far_turned = 0.2f;
/// The same if two bodies, of which some bounce, have moved against each other by more than this share of half of the smaller one's
/// thickness: the direction of an impact is that of the place where they meet.
constexpr float far_moved = 0.1f;

}  // namespace

FrameContacts::FrameContacts(ContactBodies& bodies) : bodies_(&bodies), finder_(bodies.take_parts()) {}

void FrameContacts::read_states(const Substep& s) {
  states_.clear();
  is_fixed_.clear();
  for (int place = 0; place < static_cast<int>(bodies_->places().size()); ++place) {
    states_.push_back(bodies_->state_at_start(s, place));
    BodyState& state = states_.back();
    state.is_driven_round = state.is_fixed && length_squared(state.spin) > 0;
    is_fixed_.push_back(state.is_fixed ? 1 : 0);
  }
}

void FrameContacts::update(Substep& s, const std::vector<BodyContact>& before) {
  const double left = time_left(s);
  const float gravity = static_cast<float>(left) * length(s.model.gravity);
  finder_.update(
      s.context.executor, states_, static_cast<float>(left), gravity,
      [&](int a, int b) { return bodies_->meet(s.model, a, b); }, before, contacts_);
}

/// Contacts with a body that sleeps wake it, and are found once more with those of its island.
void FrameContacts::find_beside_sleepers(Substep& s, BodySleep& sleep) {
  for (bool goes_on = true; goes_on;) {
    for (std::size_t place = at(bodies_->dynamic()); place < states_.size() && sleep.any(); ++place)
      if (moves(states_[place])) states_[place].is_fixed = false;  // so that pairs with bodies that sleep are found
    update(s, before_);
    goes_on = sleep.wake_touched(s, finder_.bodies(), before_);
    if (goes_on) read_states(s);
  }
  sleep.keep_contacts(s.part == nullptr, before_);
}

void FrameContacts::find(Substep& s, BodySleep& sleep) {
  read_states(s);
  const bool is_alone = s.part == nullptr;  // else other groups read the State's contacts at the same time
  if (sleep.any()) {
    if (is_alone) {
      before_.swap(s.state.body_contacts);
      s.state.body_contacts.clear();
    } else {
      before_ = s.state.body_contacts;
    }
    find_beside_sleepers(s, sleep);
  } else {
    if (is_alone) {
      contacts_.swap(s.state.body_contacts);
      s.state.body_contacts.clear();
    }
    update(s, is_alone ? contacts_ : s.state.body_contacts);
  }
  warn(s);
}

void FrameContacts::warn(Substep& s) {
  if (finder_.left_out() > 0)
    s.report.warnings.push_back(std::to_string(finder_.left_out()) +
                                " pairs of bodies that overlap are left to later frames, because each body has " +
                                std::to_string(BodyPairs::most_of_crowded) + " others in its place");
  overlaps_.note(s, *bodies_, finder_.deepest());
}

/// How far bodies move along planes and meshes, whose size has no end, does not matter.
bool FrameContacts::are_outdated(const BodyMotions& motions, bool some_bounce) const {
  const auto turned = [&](int body) { return body < bodies_->dynamic() && motions.turned(body) > far_turned; };
  const std::vector<BodyMotion>& all = motions.all();
  for (const auto& [a, b] : finder_.bodies()) {
    if (turned(a) || turned(b)) return true;
    if (!some_bounce || std::max(finder_.size_of_body(a), finder_.size_of_body(b)) > 1e29f) continue;
    const float far = far_moved * std::min(finder_.size_of_body(a), finder_.size_of_body(b));
    if (length_squared(all[at(b)].displacement - all[at(a)].displacement) > far * far) return true;
  }
  return false;
}

void FrameContacts::renew(Substep& s) {
  bodies_->begin_frame(s);
  read_states(s);
  update(s, contacts_);
}

}  // namespace pliant
