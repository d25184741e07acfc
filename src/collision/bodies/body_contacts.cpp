#include "collision/bodies/body_contacts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <tuple>
#include <utility>

#include "collision/bodies/body_contacts_task.h"
#include "collision/bodies/contact_points.h"
#include "collision/bodies/pair_touch.h"
#include "core/at.h"
#include "parallel/ranges.h"

namespace pliant {

namespace {

constexpr int narrow_pairs_a_task = 64;
/// What stops a body may in turn stop what follows it, in one frame so many times at most.
constexpr int most_stops = 4;
/// A contact stays while its bodies have moved less against each other since it began than this share of the smaller
/// part's size, and turned by less than 1.6 degrees (cosine of half the angle).
constexpr double still_share = 0.04, still_cosine = 0.9999;

bool hardly_moved(const Posed& now, const BodyContact& contact, double size) {
  return length(now.position - convert<double>(contact.position)) < still_share * size &&
         std::fabs(dot(now.rotation, convert<double>(contact.rotation))) > still_cosine;
}

/// Normal and arms are those of the world, so a contact does not stay where both bodies turn together.
bool hardly_turned(const Quatd& now, const BodyContact& contact) {
  return std::fabs(dot(now, convert<double>(contact.turned))) > still_cosine;
}

}  // namespace

void BodyContacts::Task::run(int first, int last, Found& found) const {
  found.clear();
  ContactsBefore contacts(before);
  for (int i = first; i < last; ++i) {
    const std::size_t pieces = found.pieces.size(), made = found.made.size();
    const std::size_t touches = found.first.size(), starts = found.starts.size();
    found.any_stopped = false;
    find(i, contacts, found);
    if (found.made.size() > made || (found.pieces.size() == pieces && may_open(i)))
      found.marks.push_back({i, pieces, found.pieces.size(), made, found.made.size(), found.any_stopped,
                             found.first.size() > touches ? found.first.back().time : 1,
                             found.starts.size() > starts ? static_cast<int>(starts) : -1});
  }
}

void BodyContacts::Task::find(int pair, ContactsBefore& contacts, Found& found) const {
  const Pair& parts = of.pairs_.pairs()[at(pair)];
  find(pair, contacts.find(of.parts_[at(parts.first)].id, of.parts_[at(parts.second)].id), found);
}

bool BodyContacts::Task::is_found_again(const Found& found, const Mark& mark) const {
  if (mark.is_open()) {
    const Pair& parts = of.pairs_.pairs()[at(mark.pair)];
    return paths->first_turn(of.parts_[at(parts.first)].body, of.parts_[at(parts.second)].body, mark.pair) < 1;
  }
  const Piece& piece = found.pieces[mark.pieces];
  return paths->first_turn(piece.a, piece.b, mark.pair) < mark.time &&
         (mark.is_stopped || stops(found.made[mark.made], piece, mark.pair));
}

/// Finds one again, and appends what there is of it to `next`. Of a pair that was apart the first touch counts as well.
void BodyContacts::Task::find_again(const Found& found, const Mark& mark, ContactsBefore& contacts, Found& next) const {
  const std::size_t touches = next.first.size();
  next.is_opened = mark.is_open();
  next.start = mark.start >= 0 && !mark.is_open() ? &found.starts[at(mark.start)] : nullptr;
  find(mark.pair, contacts, next);
  if (!mark.is_open()) next.first.resize(touches);
}

void BodyContacts::Task::run_on_paths(Found& found, bool only_open) const {
  const auto is_due = [&](const Mark& mark) { return (mark.is_open() || !only_open) && is_found_again(found, mark); };
  if (std::none_of(found.marks.begin(), found.marks.end(), is_due)) return;
  ContactsBefore contacts(before);
  thread_local Found next;  // to allocate nothing
  next.clear();
  next.deepest = found.deepest;
  next.first = found.first;
  Mark to;
  const auto copy_until = [&](std::size_t piece, std::size_t made) {
    next.pieces.insert(next.pieces.end(), found.pieces.begin() + offset(to.pieces_end),
                       found.pieces.begin() + offset(piece));
    next.made.insert(next.made.end(), found.made.begin() + offset(to.made_end), found.made.begin() + offset(made));
  };
  for (const Mark& mark : found.marks) {
    const bool due = is_due(mark);
    if (!due && !mark.is_open()) continue;
    copy_until(mark.pieces, mark.made);
    const std::size_t pieces = next.pieces.size(), made = next.made.size();
    if (due) find_again(found, mark, contacts, next);
    if (next.made.size() == made) next.marks.push_back({mark.pair, pieces, pieces, made, made});
    to = mark;
  }
  copy_until(found.pieces.size(), found.made.size());
  next.count = 0;
  for (const Piece& piece : next.pieces) next.count += piece.stays.empty() ? 1 : piece.stays.size();
  std::swap(found, next);
}

bool BodyContacts::Task::stops(const BodyContact& contact, const Piece& parties, int pair) const {
  const float gap = *std::min_element(contact.gap.begin(), contact.gap.begin() + contact.count);
  return paths->between(parties.a, parties.b, pair, {}).least_along(convert<double>(contact.normal)) +
             static_cast<double>(gap) <
         0;
}

void BodyContacts::Task::place(const Found& found, const std::vector<BodyState>& bodies, BodyContact* to,
                               std::pair<int, int>* of) {
  auto made = found.made.begin();
  for (const Piece& piece : found.pieces) {
    if (piece.stays.empty()) {
      *to++ = *made++;
      *of++ = {piece.a, piece.b};
    }
    for (const BodyContact& contact : piece.stays) {
      if (to != &contact) *to = contact;
      renew_gaps(bodies[at(piece.a)].pose, bodies[at(piece.b)].pose, *to++);
      *of++ = {piece.a, piece.b};
    }
  }
}

float BodyContacts::Task::turning_of(int part, const BodyState& body) const {
  return max(of.pairs_.turning(part) - (body.is_fixed ? 0 : faster), 0.f);
}

double BodyContacts::Task::size_of(const Pair& pair) const {
  return static_cast<double>(std::min(of.pairs_.size(pair.first), of.pairs_.size(pair.second)));
}

double BodyContacts::Task::reach_of(const Pair& pair, float approach) const {
  const float fast = approach + of.pairs_.turning(pair.first) + of.pairs_.turning(pair.second);
  return static_cast<double>(BodyPairs::margin_share) * size_of(pair) + static_cast<double>(dt * fast);
}

float BodyContacts::Task::speed_of(int pair, bool is_opened) const {
  const Pair& parts = of.pairs_.pairs()[at(pair)];
  const int a = of.parts_[at(parts.first)].body, b = of.parts_[at(parts.second)].body;
  float most = length(bodies[at(a)].velocity - bodies[at(b)].velocity);
  if (!is_opened) return most;
  const ContactPath path = paths->between(a, b, pair, {});
  for (std::size_t leg = 0; leg < path.count(); ++leg)
    most = std::max(most, static_cast<float>(length(path.leg(leg).speed)) / dt);
  if (paths->turns(a, pair)) most = std::max(most, length(bodies[at(b)].velocity));
  if (paths->turns(b, pair)) most = std::max(most, length(bodies[at(a)].velocity));
  return most;
}

bool BodyContacts::Task::may_open(int pair) const {
  if (paths != nullptr) return false;
  const Pair& parts = of.pairs_.pairs()[at(pair)];
  const BodyPart &one = of.parts_[at(parts.first)], &other = of.parts_[at(parts.second)];
  const BodyState &a = bodies[at(one.body)], &b = bodies[at(other.body)];
  if (!one.is_convex() || !other.is_convex() || !may_begin(one.body) || !may_begin(other.body)) return false;
  const float most = (is_held(a) ? 0 : length(a.velocity)) + (is_held(b) ? 0 : length(b.velocity));
  const float speed = length(a.velocity - b.velocity) + most;
  return static_cast<double>(dt * most) > fast_share * size_of(parts) && !is_out_of_reach(parts, one, other, speed);
}

bool BodyContacts::Task::are_surely_apart(const Pair& pair, const BodyPart& one, const BodyPart& other,
                                          const Posed& relative, float speed) const {
  if (!one.is_convex() || !other.is_convex()) return false;
  const PartBall &of_one = of.balls_[at(pair.first)], &of_other = of.balls_[at(pair.second)];
  const double reach = reach_of(pair, speed);
  return is_beyond(one, to_world(relative, of_other.centre), of_other.radius, reach) ||
         is_beyond(other, to_local(relative, of_one.centre), of_one.radius, reach);
}

bool BodyContacts::Task::is_out_of_reach(const Pair& pair, const BodyPart& one, const BodyPart& other,
                                         float speed) const {
  constexpr float more_than_rounding = 1.01f;
  const auto is_polyhedron = [](const BodyPart& part) { return part.shape.kind == ConvexShape::Kind::polyhedron; };
  if (!one.is_convex() || !other.is_convex() || (is_polyhedron(one) && is_polyhedron(other))) return false;
  if (!may_begin(one.body) || !may_begin(other.body)) return false;  // whose boxes are those of the frame's start
  return of.pairs_.are_apart(pair.first, pair.second, more_than_rounding * static_cast<float>(reach_of(pair, speed)));
}

bool BodyContacts::Task::may_meet_more(const Pair& pair, const BodyState& a, const BodyState& b, double size) const {
  const BodyPart& one = of.parts_[at(pair.first)];
  const double way = static_cast<double>(dt * length(a.velocity - b.velocity));
  return !one.is_half_space && way > (one.mesh != nullptr ? still_share : fast_share) * size;
}

bool BodyContacts::Task::comes_near(const Pair& pair, const BodyState& a, const BodyState& b,
                                    const BodyContact& contact) const {
  if (of.parts_[at(pair.first)].is_half_space || !one_is_held(a, b)) return false;
  const Vec3f way = (b.velocity - a.velocity) * dt;
  return static_cast<double>(dot(contact.normal, way)) < -least_approach(static_cast<double>(length(way)));
}

bool BodyContacts::Task::is_renewed(const Pair& pair, std::span<const BodyContact> old) const {
  const int one = of.parts_[at(pair.first)].body, other = of.parts_[at(pair.second)].body;
  if (may_begin(one) || may_begin(other)) return true;
  if ((*renewed)[at(one)] == Again::none && (*renewed)[at(other)] == Again::none) return false;
  const float size = static_cast<float>(size_of(pair));
  return std::any_of(old.begin(), old.end(), [&](const BodyContact& contact) { return is_close(contact, size); });
}

bool BodyContacts::Task::stay(const Pair& pair, std::span<const BodyContact> old, const BodyState& a,
                              const BodyState& b, const Posed& relative) const {
  if (is_renewed(pair, old)) {
    const double size = size_of(pair);
    if (may_meet_more(pair, a, b, size)) return false;
    const auto hardly_changed = [&](const BodyContact& contact) {
      return contact.b.piece == of_solids && !comes_near(pair, a, b, contact) &&
             hardly_moved(relative, contact, size) && hardly_turned(a.pose.rotation, contact);
    };
    // Contacts of what turns by itself turn with it, so that friction acts along its surface of this frame.
    return !old.empty() && !a.deforms && !a.is_driven_round && !b.is_driven_round &&
           std::all_of(old.begin(), old.end(), hardly_changed);
  }
  const double far_away = static_cast<double>(far) * size_of(pair);
  if (!of.parts_[at(pair.first)].is_convex())
    return true;  // how far bodies move along planes and meshes does not matter
  return std::all_of(old.begin(), old.end(), [&](const BodyContact& contact) {
    return !(length(relative.position - convert<double>(contact.position)) > far_away);
  });
}

bool in_order(const BodyContact& a, const BodyContact& b) {
  return std::tuple{solids_of(a), a.a.piece, a.b.piece} < std::tuple{solids_of(b), b.a.piece, b.b.piece};
}

BodyContacts::BodyContacts(std::vector<BodyPart> parts) : parts_(std::move(parts)), pairs_(parts_) {
  balls_.resize(parts_.size());
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (parts_[i].is_convex()) balls_[i] = ball_around(parts_[i]);
    const std::size_t body = at(parts_[i].body);
    if (size_.size() <= body) size_.resize(body + 1, 1e30f);
    size_[body] = std::min(size_[body], pairs_.size(static_cast<int>(i)));
  }
}

/// Finds in tasks which contacts stay and which begin.
void BodyContacts::find(Executor& executor, const Task& task_of_pair) {
  const int count = static_cast<int>(pairs_.pairs().size());
  found_.resize(at(ranges_of(count, narrow_pairs_a_task)));
  for_ranges(executor, "bodies: contacts", count, narrow_pairs_a_task,
             [&](int first, int last) { task_of_pair.run(first, last, found_[at(first / narrow_pairs_a_task)]); });
  find_on_paths(executor, task_of_pair);
  first_.assign(1, 0);
  for (const Found& found : found_) first_.push_back(first_.back() + found.count);
}

/// Contacts in the direction of a path that ends at something else are found once more, and those of pairs that only
/// meet because something stops one of them.
void BodyContacts::find_on_paths(Executor& executor, Task task) {
  std::size_t known = 0;
  for (int stop = 0; stop < most_stops; ++stop) {
    touches_.clear();
    for (const Found& found : found_) touches_.insert(touches_.end(), found.first.begin(), found.first.end());
    if (touches_.size() == known) return;
    known = touches_.size();
    paths_.begin(task.bodies, task.dt, touches_);
    task.paths = &paths_;
    executor.parallel_for("bodies: contacts", static_cast<int>(found_.size()),
                          [&](int i) { task.run_on_paths(found_[at(i)], stop > 0); });
  }
}

BodyOverlap BodyContacts::deepest() const {
  BodyOverlap deepest;
  for (const Found& found : found_)
    if (found.deepest.share > deepest.share) deepest = found.deepest;
  return deepest;
}

/// True if the contacts of this frame are those of the frame before.
bool BodyContacts::all_stay(const std::vector<BodyContact>& before) const {
  if (first_.back() != before.size()) return false;
  const BodyContact* next = before.data();
  for (const Found& found : found_)
    for (const Piece& piece : found.pieces) {
      if (piece.stays.data() != next || piece.stays.empty()) return false;
      next += piece.stays.size();
    }
  return true;
}

/// Replaces the contacts of the frame before by those that tasks have found.
void BodyContacts::replace(Executor& executor, const Task& found, std::vector<BodyContact>& now) {
  const bool stay = &found.before == &now && all_stay(found.before);
  bodies_.resize(first_.back());
  if (!stay) next_.resize(first_.back());
  BodyContact* const to = stay ? now.data() : next_.data();  // in place where all stay, because a copy takes many bytes
  executor.parallel_for("bodies: contacts", static_cast<int>(found_.size()), [&](int task) {
    Task::place(found_[at(task)], found.bodies, to + first_[at(task)], bodies_.data() + first_[at(task)]);
  });
  if (!stay) now.swap(next_);
}

void BodyContacts::update(Executor& executor, const std::vector<BodyState>& bodies, float dt, float faster,
                          FunctionRef<bool(int, int)> meet, const std::vector<BodyContact>& before,
                          std::vector<BodyContact>& now) {
  pairs_.update(executor, parts_, bodies, dt, faster, meet);
  const Task task{*this, bodies, before, dt, faster, nullptr};
  find(executor, task);
  replace(executor, task, now);
}

void BodyContacts::renew(Executor& executor, const std::vector<BodyState>& bodies, float dt, float faster,
                         FunctionRef<bool(int, int)> meet, const std::vector<Again>& of, float far,
                         std::vector<BodyContact>& now) {
  renewed_.resize(of.size());
  std::transform(of.begin(), of.end(), renewed_.begin(), [](Again again) { return again == Again::all ? 1 : 0; });
  if (std::any_of(renewed_.begin(), renewed_.end(), [](char all) { return all != 0; }))
    pairs_.renew(executor, parts_, bodies, dt, faster, meet, renewed_);
  const Task task{*this, bodies, now, dt, faster, nullptr, &of, far};
  find(executor, task);
  replace(executor, task, now);
}

}  // namespace pliant
