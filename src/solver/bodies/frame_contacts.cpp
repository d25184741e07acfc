#include "solver/bodies/frame_contacts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "solver/bodies/body_math.h"
#include "solver/substep.h"

namespace pliant {

namespace {

/// Contacts are found again in a frame if a body has turned by more than this since they were found [rad].
constexpr float far_turned = 0.2f;
/// Bodies that have turned by this share of it are found again with those that have turned so far.
constexpr float soon = 0.5f;
/// The same if two bodies, of which some bounce, have moved against each other by more than this share of half of the
/// smaller one's thickness: the direction of an impact is that of the place where they meet.
constexpr float far_moved = 0.1f;
/// The same if a body leaves the path by which pairs were found by more than this share of half of its thickness, as
/// one that another one hits: nothing else would hold it on its new path.
constexpr float far_strayed = 0.5f;

/// The same if the place at which a tilted disc stands on its rim may have left the ground by more than this share of
/// half of its thickness. More often than at each `least_turned` contacts are not found again.
constexpr float risen = 0.01f, least_turned = 0.02f;
/// Sines of the tilts between which a disc stands on its rim: less, it lies, and more, it rolls on its side.
constexpr float least_tilt = 0.02f, most_tilt = 0.9f;

}  // namespace

FrameContacts::FrameContacts(ContactBodies& bodies) : bodies_(&bodies) {
  std::vector<BodyPart> parts = bodies.take_parts();
  has_rim_.assign(bodies.places().size(), 0);
  for (const BodyPart& part : parts)
    if (part.mesh == nullptr && part.shape.kind == ConvexShape::Kind::cylinder) has_rim_[at(part.body)] = 1;
  finder_ = BodyContacts(std::move(parts));
}

void FrameContacts::read_states(const Substep& s) {
  left_ = static_cast<float>(time_left(s));
  faster_ = left_ * length(s.model.gravity);
  states_.clear();
  is_fixed_.clear();
  for (int place = 0; place < static_cast<int>(bodies_->places().size()); ++place) {
    states_.push_back(bodies_->state_at_start(s, place));
    BodyState& state = states_.back();
    state.yields = !state.is_fixed;
    state.is_driven_round = state.is_fixed && length_squared(state.spin) > 0;
    is_fixed_.push_back(state.is_fixed ? 1 : 0);
  }
}

void FrameContacts::update(Substep& s, const std::vector<BodyContact>& before) {
  finder_.update(
      s.context.executor, states_, left_, faster_, [&](int a, int b) { return bodies_->meet(s, a, b); }, before,
      contacts_);
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
  turned_.assign(at(bodies_->dynamic()), 0);
  rolled_ = turned_;
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
  limit_rolling();
  paths_.resize(states_.size());
  for (int body = 0; body < bodies_->dynamic(); ++body) begin_path(body);
  warn(s);
}

/// Where a disc of radius r, whose axis has the sine s to the normal, turns by an angle, its lowest place runs round the
/// rim by the angle over s. What was lowest has then risen by r angle^2 / 2 s.
void FrameContacts::limit_rolling() {
  most_rolled_.assign(at(bodies_->dynamic()), 1e30f);
  const auto may_roll = [&](int body) { return body < bodies_->dynamic() && has_rim_[at(body)] != 0; };
  for (int i = 0; i < static_cast<int>(contacts_.size()); ++i) {
    const auto& [a, b] = finder_.bodies()[at(i)];
    const BodyContact& contact = contacts_[at(i)];
    if ((!may_roll(a) && !may_roll(b)) || !BodyContacts::is_close(contact, size(i))) continue;
    for (const auto& [body, arm] : {std::pair{a, contact.arm_a}, std::pair{b, contact.arm_b}}) {
      const Vec3f round = may_roll(body) ? bodies_->round_axes(body) : Vec3f{};
      if (round.x + round.y + round.z != 1) continue;
      const Vec3f axis = rotate(convert<float>(states_[at(body)].pose.rotation), round);
      const float tilt = length(cross(axis, contact.normal)), radius = length(cross(axis, arm));
      if (tilt < least_tilt || tilt > most_tilt || !(radius > 0)) continue;
      const float limit = std::sqrt(2 * risen * size(i) * tilt / radius);
      most_rolled_[at(body)] = std::min(most_rolled_[at(body)], std::max(limit, least_turned));
    }
  }
}

void FrameContacts::warn(Substep& s) {
  if (finder_.left_out() > 0)
    s.report.warnings.push_back(std::to_string(finder_.left_out()) +
                                " pairs of bodies that overlap are left to later frames, because each body has " +
                                std::to_string(BodyPairs::most_of_crowded) + " others in its place");
}

void FrameContacts::count_overlaps(std::vector<int>& counts) const {
  counts.assign(states_.size(), 0);
  for (int i = 0; i < static_cast<int>(contacts_.size()); ++i) {
    const auto& [a, b] = finder_.bodies()[at(i)];
    const BodyContact& contact = contacts_[at(i)];
    const float gap = *std::min_element(contact.gap.begin(), contact.gap.begin() + contact.count);
    if (is_fixed_[at(a)] != 0 || is_fixed_[at(b)] != 0 || !(gap < -far_moved * size(i))) continue;
    ++counts[at(a)];
    ++counts[at(b)];
  }
}

float FrameContacts::size(int contact) const {
  const auto& [a, b] = finder_.bodies()[at(contact)];
  return std::min(finder_.size_of_body(a), finder_.size_of_body(b));
}

void FrameContacts::warn_of_overlaps(Substep& s, const std::vector<char>& is_separating) {
  StartOverlaps begun;
  BodyOverlap deepest = finder_.deepest();
  for (int i = 0; i < static_cast<int>(contacts_.size()); ++i) {
    if (is_separating[at(i)] == 0) continue;
    const auto& [a, b] = finder_.bodies()[at(i)];
    if (a == deepest.a && b == deepest.b) deepest.share = 0;
    const BodyContact& contact = contacts_[at(i)];
    const float gap = *std::min_element(contact.gap.begin(), contact.gap.begin() + contact.count);
    if (contact.substep == 0) begun.add({a, b, -gap, -gap / size(i)});
  }
  begun.warn(s, *bodies_);
  overlaps_.note(s, *bodies_, deepest);
}

/// Calls visit(a, b) for the bodies of contacts that have moved far against each other, until it returns true. Returns
/// true if it has. How far bodies move along planes and meshes, whose size has no end, does not matter.
template <class Visit>
bool FrameContacts::any_moved_far(const BodyMotions& motions, const Visit& visit) const {
  const std::vector<BodyMotion>& all = motions.all();
  for (const auto& [a, b] : finder_.bodies()) {
    if (std::max(finder_.size_of_body(a), finder_.size_of_body(b)) > 1e29f) continue;
    const float far = far_moved * std::min(finder_.size_of_body(a), finder_.size_of_body(b));
    if (length_squared(all[at(b)].displacement - all[at(a)].displacement) > far * far && visit(a, b)) return true;
  }
  return false;
}

void FrameContacts::begin_path(int body) {
  paths_[at(body)] = {states_[at(body)].velocity * left_, {}, left_ * faster_};
}

/// The first test excludes bodies that have hardly moved.
bool FrameContacts::has_strayed(const BodyMotions& motions, int body) const {
  const auto& [way, before, slack] = paths_[at(body)];
  const float far = far_strayed * finder_.size_of_body(body);
  const Vec3f moved = before + motions.all()[at(body)].displacement, none{};
  if (!(length_squared(moved) > far * far)) return false;
  return largest(max(max(moved - max(way, none), min(way, none) - moved), none)) > far + slack;
}

bool FrameContacts::has_turned_far(const BodyMotions& motions, int body, float share) const {
  return turned_[at(body)] + motions.turned(body) > share * far_turned;
}

bool FrameContacts::has_rolled_far(const BodyMotions& motions, int body, float share) const {
  return rolled_[at(body)] + motions.turned(body) > share * most_rolled_[at(body)];
}

BodyContacts::Again FrameContacts::outdated(const BodyMotions& motions, bool some_bounce) const {
  using Again = BodyContacts::Again;
  const int dynamic = bodies_->dynamic();
  bool any_turned = false, any_rolled = false;  // bodies first: they are fewer than contacts
  for (int body = 0; body < dynamic; ++body) {
    if (has_strayed(motions, body)) return Again::all;
    any_turned = any_turned || has_turned_far(motions, body, 1);
    any_rolled = any_rolled || has_rolled_far(motions, body, 1);
  }
  const auto touches = [&](const auto& is_far) {
    const auto& pairs = finder_.bodies();
    return std::any_of(pairs.begin(), pairs.end(), [&](const auto& pair) {
      return (pair.first < dynamic && is_far(pair.first)) || (pair.second < dynamic && is_far(pair.second));
    });
  };
  if (any_turned && touches([&](int body) { return has_turned_far(motions, body, 1); })) return Again::all;
  if (some_bounce && any_moved_far(motions, [](int, int) { return true; })) return Again::all;
  const bool rolled = any_rolled && touches([&](int body) { return has_rolled_far(motions, body, 1); });
  return rolled ? Again::touching : Again::none;
}

/// Bodies that will soon have turned far are among them, so that contacts are found again less often.
void FrameContacts::find_outdated(const BodyMotions& motions, bool some_bounce, BodyContacts::Again most) {
  using Again = BodyContacts::Again;
  outdated_.assign(states_.size(), Again::none);
  for (int body = 0; body < bodies_->dynamic(); ++body) {
    if (has_rolled_far(motions, body, soon)) outdated_[at(body)] = Again::touching;
    if (most == Again::all && (has_strayed(motions, body) || has_turned_far(motions, body, soon)))
      outdated_[at(body)] = Again::all;
  }
  if (some_bounce && most == Again::all)
    any_moved_far(motions, [&](int a, int b) {
      outdated_[at(a)] = outdated_[at(b)] = Again::all;
      return false;
    });
  for (int body = 0; body < bodies_->dynamic(); ++body) {
    const Again again = outdated_[at(body)];
    turned_[at(body)] = again == Again::all ? 0 : turned_[at(body)] + motions.turned(body);
    rolled_[at(body)] = again != Again::none ? 0 : rolled_[at(body)] + motions.turned(body);
    paths_[at(body)].moved += motions.all()[at(body)].displacement;
  }
}

void FrameContacts::renew(Substep& s, const BodyMotions& motions, bool some_bounce, BodyContacts::Again most) {
  find_outdated(motions, some_bounce, most);
  bodies_->begin_frame(s);
  read_states(s);
  for (std::size_t place = 0; place < states_.size(); ++place)  // the contacts of what is driven round turn with it
    if (states_[place].is_driven_round) outdated_[place] = most;
  for (int body = 0; body < bodies_->dynamic(); ++body)
    if (outdated_[at(body)] == BodyContacts::Again::all) begin_path(body);
  finder_.renew(
      s.context.executor, states_, left_, faster_, [&](int a, int b) { return bodies_->meet(s, a, b); }, outdated_,
      some_bounce ? far_moved : 1e30f, contacts_);
  limit_rolling();
}

}  // namespace pliant
