// Meets pairs of parts: finds the contacts of a pair whose contacts do not stay.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "collision/bodies/body_contacts_task.h"
#include "collision/bodies/contact_points.h"
#include "collision/bodies/inner_ball.h"
#include "collision/bodies/kept_side.h"
#include "collision/bodies/mesh_contacts.h"
#include "collision/bodies/pair_touch.h"
#include "core/at.h"

namespace pliant {

namespace {

/// Solids that would go into each other by less than this share of the smaller part's size and this share of the path
/// that gravity adds in a frame pass each other: what lies on one of two flush solids is pressed in by less.
constexpr double slop_share = 0.005, slop_of_fall = 0.1;
/// What comes nearer in a frame by less than this share of the path that gravity adds is at rest; of what moves by less
/// than half of that path it may be more, since piles come to rest so.
constexpr double approach_of_fall = 0.003, slow_approach_of_fall = 0.03, slow_way_of_fall = 0.5;
/// Two free solids without a contact force are searched for directions on paths longer than this share of the smaller
/// part's size: they may pass each other. In piles such pairs are few.
constexpr double passing_share = 0.04;

bool is_pressed(std::span<const BodyContact> contacts) {
  return std::any_of(contacts.begin(), contacts.end(), [](const BodyContact& contact) {
    return *std::max_element(contact.impulse.begin(), contact.impulse.end()) > 0;
  });
}

/// Where two bodies are in one place, no direction separates them. They count as a little apart, each pair in a
/// direction of its own.
Posed apart(Posed relative, int a, int b, double size) {
  if (!(length(relative.position) < 1e-4 * size)) return relative;
  std::uint32_t mixed = static_cast<std::uint32_t>(a) * 2654435761u ^ static_cast<std::uint32_t>(b) * 2246822519u;
  const auto next = [&] {
    mixed ^= mixed << 13, mixed ^= mixed >> 17, mixed ^= mixed << 5;
    return static_cast<double>(mixed) / 2147483648.0 - 1;
  };
  const double x = next(), y = next(), z = next();
  relative.position += unit_or(Vec3d{x, y, z}, Vec3d{0, 1, 0}) * (1e-3 * size);
  return relative;
}

}  // namespace

void BodyContacts::Task::note_depth(const BodyContact& contact, const Piece& parties, double size, Found& found) {
  const float gap = *std::min_element(contact.gap.begin(), contact.gap.begin() + contact.count);
  const float share = -gap / static_cast<float>(size);
  if (share > found.deepest.share) found.deepest = {parties.a, parties.b, -gap, share};
}

void BodyContacts::Task::find(int number, std::span<const BodyContact> old, Found& found) const {
  const Pair& pair = of.pairs_.pairs()[at(number)];
  const BodyPart &one = of.parts_[at(pair.first)], &other = of.parts_[at(pair.second)];
  if (old.empty() && !may_begin(one.body) && !may_begin(other.body)) return;
  const float speed = speed_of(number, found.is_opened);
  if (old.empty() && is_out_of_reach(pair, one, other, speed)) return;
  const BodyState &a = bodies[at(one.body)], &b = bodies[at(other.body)];
  const bool stays_anyway = !is_renewed(pair, old) && (far >= unlimited || !one.is_convex());
  Posed relative = stays_anyway ? Posed{} : relative_to(a.pose, b.pose);
  if (old.empty() && are_surely_apart(pair, one, other, relative, speed)) return;
  if (stays_anyway || stay(pair, old, a, b, relative)) {
    found.pieces.push_back({old, one.body, other.body});
    found.count += old.size();
    for (const BodyContact& contact : old) note_depth(contact, found.pieces.back(), size_of(pair), found);
    return;
  }
  relative.rotation = normalise(relative.rotation);
  const Meeting meeting = meeting_of(number, old, relative, speed);
  const std::size_t first = found.made.size();
  found.is_apart = false;
  one.mesh != nullptr ? meet_mesh(meeting, found) : meet(meeting, found);
  if (!meeting.may_tumble() || found.is_apart) return;
  meet_balls(meeting, found);
  std::sort(found.made.begin() + offset(first), found.made.end(), in_order);
}

BodyContacts::Task::Meeting BodyContacts::Task::meeting_of(int number, std::span<const BodyContact> old,
                                                           const Posed& relative, float speed) const {
  const Pair& pair = of.pairs_.pairs()[at(number)];
  const BodyPart &one = of.parts_[at(pair.first)], &other = of.parts_[at(pair.second)];
  const BodyState &a = bodies[at(one.body)], &b = bodies[at(other.body)];
  const double size = size_of(pair);
  const Vec3f velocity = a.velocity - b.velocity;
  // What rolls or slides along a plane does not meet it with that speed.
  const float approach =
      one.is_half_space && std::any_of(old.begin(), old.end(),
                                       [&](const BodyContact& c) { return is_close(c, static_cast<float>(size)); })
          ? std::fabs(dot(velocity, rotate(convert<float>(compose(a.pose, one.pose)).rotation, Vec3f{0, 1, 0})))
          : speed;
  // An impact may turn the whole approach into spin. Of two opposite points one may rise as the other sinks.
  const double turning =
      static_cast<double>(2 * dt * (approach + turning_of(pair.first, a) + turning_of(pair.second, b)));
  const double way = static_cast<double>(dt * length(velocity)), least = least_approach(way);
  const SolidPath on{path_of(one.body, other.body, number), slop_share * size + slop_of_fall * fall(), 0.5 * fall(),
                     least};
  const double least_fast = one_is_held(a, b) ? least : fast_share * size;
  const double least_searched = one_is_held(a, b) || is_pressed(old) ? least_fast : passing_share * size;
  const bool is_fast = length(on.path.end()) > least_searched, starts_fast = way > least_fast;
  return {number, one, other, a, b, old, relative, size, reach_of(pair, approach), turning, on, is_fast, starts_fast};
}

void BodyContacts::Task::add(const Meeting& m, const Touch& touching, const Vec3d& moved, int piece, Found& found,
                             int of) {
  if (touching.count == 0) return;
  BodyContact contact;
  contact.a = m.one.id;
  contact.a.piece = piece;
  contact.b = m.other.id;
  contact.b.piece = of;
  contact.position = convert<float>(m.relative.position);
  contact.rotation = convert<float>(m.relative.rotation);
  contact.turned = convert<float>(m.a.pose.rotation);
  set_points(touching, moved, m.a.pose, m.b.pose, contact);
  if (const BodyContact* alike = like(contact, m.old)) take_impulses(*alike, contact);
  found.pieces.push_back({{}, m.one.body, m.other.body});
  note_depth(contact, found.pieces.back(), m.size, found);
  found.made.push_back(contact);
  ++found.count;
}

void BodyContacts::Task::meet(const Meeting& m, Found& found) const {
  const Reach within{m.reach, m.turning, rocking_of(m.a, m.b, dt, faster)};
  const Posed placed = apart(m.relative, m.one.body, m.other.body, m.size);
  const Touch now = found.start != nullptr ? *found.start : touch_of(m.one, m.other, placed, within);
  found.is_apart = now.count == 0 && m.old.empty();
  if (found.is_apart) return;
  if (m.one.is_half_space) {
    if (m.is_fast) note_first(first_on_plane(now, m.on), m, found);
    return add(m, now, {}, 0, found);
  }
  const std::span<const BodyContact> earlier = of_solids_in(m.old);
  if (has_changed_sides(now, m.a.pose, earlier)) {
    const Vec3d kept = rotate(conjugate(m.a.pose.rotation), convert<double>(earlier.front().normal));
    return add(m, touch_along(m.one, m.other, m.relative, kept, 0, m.turning), {}, 0, found);
  }
  if (!m.is_fast) return add(m, now, {}, 0, found);
  const PairTouch touching = touch_on_path(m.one, m.other, placed, within, now, m.on);
  if (paths == nullptr) found.starts.push_back(now);
  found.any_stopped = touching.is_stopped;
  note_first(touching.first, m, found);
  add(m, touching.touch, touching.moved, 0, found);
}

MeshSideKept BodyContacts::Task::side_kept_of(const Meeting& m) {
  return m.a.deforms ? MeshSideKept{} : side_kept(*m.one.mesh, m.other, m.relative, 2 * m.reach, m.old);
}

void BodyContacts::Task::meet_mesh(const Meeting& m, Found& found) const {
  const BodyMesh& mesh = *m.one.mesh;
  const Posed pose = compose(m.relative, m.other.pose);
  const MeshSideKept kept = side_kept_of(m);
  if (kept.triangle >= 0) {
    const MeshTouch touching = touch_side(m.other.shape, pose, mesh, kept, m.reach, m.turning);
    return add(m, touching.touch, {}, touching.piece, found);
  }
  std::vector<MeshTouch> touches;
  found.any_stopped = true;
  note_first(touch_mesh(m.other.shape, pose, mesh, m.reach, touches, m.turning, m.is_fast ? &m.on : nullptr), m, found);
  for (const MeshTouch& touching : touches) add(m, touching.touch, touching.moved, touching.piece, found);
}

void BodyContacts::Task::meet_balls(const Meeting& m, Found& found) const {
  const float of_a = is_held(m.a) ? 0 : inner_radius(m.one), of_b = is_held(m.b) ? 0 : inner_radius(m.other);
  if (of_b > 0 && m.one.mesh != nullptr) meet_mesh_ball(m, inner_ball(m.other, of_b), found);
  if (of_b > 0 && m.one.mesh == nullptr) meet_ball(m, m.one, inner_ball(m.other, of_b), of_ball_b, found);
  if (of_a > 0) meet_ball(m, inner_ball(m.one, of_a), m.other, of_ball_a, found);
}

void BodyContacts::Task::meet_ball(const Meeting& m, const BodyPart& one, const BodyPart& other, int which,
                                   Found& found) const {
  const Reach within{m.reach, m.turning, {}};
  const Posed placed = apart(m.relative, one.body, other.body, m.size);
  const Touch now = touch_of(one, other, placed, within);
  if (one.is_half_space) return add(m, now, {}, 0, found, which);
  const PairTouch touching = touch_on_path(one, other, placed, within, now, m.on);
  add(m, touching.touch, touching.moved, 0, found, which);
}

void BodyContacts::Task::meet_mesh_ball(const Meeting& m, const BodyPart& ball, Found& found) const {
  const BodyMesh& mesh = *m.one.mesh;
  const Posed pose = compose(m.relative, ball.pose);
  std::vector<MeshTouch> touches;
  const MeshSideKept kept = side_kept_of(m);
  if (kept.triangle >= 0)
    touches.push_back(touch_side(ball.shape, pose, mesh, kept, m.reach, m.turning));
  else
    touch_mesh(ball.shape, pose, mesh, m.reach, touches, m.turning, &m.on);
  for (const MeshTouch& touching : touches) add(m, touching.touch, touching.moved, touching.piece, found, of_ball_b);
}

ContactPath BodyContacts::Task::path_of(int a, int b, int pair) const {
  const BodyState &one = bodies[at(a)], &other = bodies[at(b)];
  return paths == nullptr ? BodyPaths::straight(one, other, dt, one.pose.rotation)
                          : paths->between(a, b, pair, one.pose.rotation);
}

double BodyContacts::Task::least_approach(double way) const {
  return (way > slow_way_of_fall * fall() ? approach_of_fall : slow_approach_of_fall) * fall() + 1e-7;
}

void BodyContacts::Task::note_first(const PathContact& first, const Meeting& m, Found& found) {
  if (first.touches && length(m.on.path.end()) > fast_share * m.size)
    found.first.push_back({m.one.body, m.other.body, m.number, first.time, rotate(m.a.pose.rotation, first.normal)});
}

}  // namespace pliant
