#include "collision/bodies/body_contacts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <tuple>
#include <utility>

#include "collision/bodies/contact_points.h"
#include "collision/bodies/inner_ball.h"
#include "collision/bodies/kept_side.h"
#include "collision/bodies/mesh_contacts.h"
#include "collision/bodies/pair_touch.h"
#include "core/at.h"
#include "parallel/ranges.h"

namespace pliant {

namespace {

constexpr int narrow_pairs_a_task = 64;
/// Where two free solids move against each other by less than this share of the smaller part's size in a frame,
/// directions hardly change.
constexpr double fast_share = 0.15;
/// Solids that would go into each other by less than this share of the smaller part's size and this share of the path
/// that gravity adds in a frame pass each other: what lies on one of two flush solids is pressed in by less.
constexpr double slop_share = 0.005, slop_of_fall = 0.1;
/// What comes nearer in a frame by less than this share of the path that gravity adds is at rest; of what moves by less
/// than half of that path it may be more, since piles come to rest so.
constexpr double approach_of_fall = 0.003, slow_approach_of_fall = 0.03, slow_way_of_fall = 0.5;
constexpr float unlimited = 1e30f;  ///< [m]
/// A contact stays while its bodies have moved less against each other since it began than this share of the smaller part's size, and
/// turned by less than 1.6 degrees (cosine of half the angle).
constexpr double still_share = 0.04, still_cosine = 0.9999;
/// Where points may move in a frame by more than this multiple of the smaller part's size, a substep may turn it far.
constexpr double tumbling_sizes = 2;
/// ContactPart::piece of b: contact is that of a solid, of the ball inside of that of b, or of the ball inside of that
/// of a.
constexpr int of_solids = 0, of_ball_b = 1, of_ball_a = 2;

/// Where two bodies are in one place, no direction separates them. They count as a little apart, each pair in a direction of its own.
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

bool hardly_moved(const Posed& now, const BodyContact& contact, double size) {
  return length(now.position - convert<double>(contact.position)) < still_share * size &&
         std::fabs(dot(now.rotation, convert<double>(contact.rotation))) > still_cosine;
}

/// Normal and arms are those of the world, so a contact does not stay where both bodies turn together.
bool hardly_turned(const Quatd& now, const BodyContact& contact) {
  return std::fabs(dot(now, convert<double>(contact.turned))) > still_cosine;
}

auto solids_of(const BodyContact& c) { return std::tuple{c.a.owner, c.a.solid, c.b.owner, c.b.solid}; }

/// Finds the contacts of two parts in the frame before. Pairs are mostly asked for in ascending order, so the search begins where
/// the last one ended.
class ContactsBefore {
 public:
  explicit ContactsBefore(const std::vector<BodyContact>& before) : all_(before) {}

  std::span<const BodyContact> find(const ContactPart& a, const ContactPart& b) {
    const std::tuple wanted{a.owner, a.solid, b.owner, b.solid};
    const auto is_before = [&](const BodyContact& c) { return solids_of(c) < wanted; };
    std::size_t first = next_, steps = 0;
    while (first < all_.size() && steps < most_steps && is_before(all_[first])) ++first, ++steps;
    const bool is_found = steps < most_steps && first > 0 && is_before(all_[first - 1]);
    if (!is_found)
      first = static_cast<std::size_t>(std::partition_point(all_.begin(), all_.end(), is_before) - all_.begin());
    std::size_t last = first;
    while (last < all_.size() && solids_of(all_[last]) == wanted) ++last;
    next_ = last;
    return std::span(all_).subspan(first, last - first);
  }

 private:
  static constexpr std::size_t most_steps = 8;  ///< beyond, a binary search is faster

  const std::vector<BodyContact>& all_;
  std::size_t next_ = 0;
};

/// The contacts of the solids themselves, of those of two convex parts.
std::span<const BodyContact> of_solids_in(std::span<const BodyContact> contacts) {
  const auto end =
      std::find_if(contacts.begin(), contacts.end(), [](const BodyContact& c) { return c.b.piece != of_solids; });
  return contacts.first(static_cast<std::size_t>(end - contacts.begin()));
}

/// The contact of the frame before with the same piece, or else the one whose normal agrees best; null if none is similar.
const BodyContact* like(const BodyContact& c, std::span<const BodyContact> before) {
  const BodyContact* best = nullptr;
  float closest = 0.9f;
  for (const BodyContact& old : before) {
    if (old.b.piece != c.b.piece) continue;
    const float agreement = old.a.piece == c.a.piece ? 2 : dot(old.normal, c.normal);
    if (!(agreement > closest)) continue;
    closest = agreement;
    best = &old;
  }
  return best;
}

}  // namespace

/// What the search for the contact of one pair needs.
struct BodyContacts::Task {
  const BodyContacts& of;
  const std::vector<BodyState>& bodies;
  const std::vector<BodyContact>& before;
  float dt, faster;
  const BodyPaths* paths = nullptr;            ///< null: straight ones
  const std::vector<char>* renewed = nullptr;  ///< [body] nonzero: its contacts are found again; null: those of all are
  float far = unlimited;  ///< contacts of others stay unless bodies have moved farther (BodyContacts::renew)

  /// Finds the contacts of pairs [first, last).
  void run(int first, int last, Found& found) const {
    found.clear();
    ContactsBefore contacts(before);
    for (int i = first; i < last; ++i) {
      const std::size_t pieces = found.pieces.size(), made = found.made.size();
      const std::size_t touches = found.first.size(), starts = found.starts.size();
      found.any_stopped = false;
      find(i, contacts, found);
      if (found.made.size() > made)
        found.marks.push_back({i, pieces, found.pieces.size(), made, found.made.size(), found.any_stopped,
                               found.first.size() > touches ? found.first.back().time : 1,
                               found.starts.size() > starts ? static_cast<int>(starts) : -1});
    }
  }

  void find(int pair, ContactsBefore& contacts, Found& found) const {
    const Pair& parts = of.pairs_.pairs()[at(pair)];
    find(pair, contacts.find(of.parts_[at(parts.first)].id, of.parts_[at(parts.second)].id), found);
  }

  /// Finds the contacts of those pairs again of which a body touches a third one first.
  void run_on_paths(Found& found) const {
    ContactsBefore contacts(before);
    Found next;
    next.clear();
    next.deepest = found.deepest;
    Mark to;
    const auto copy_until = [&](std::size_t piece, std::size_t made) {
      next.pieces.insert(next.pieces.end(), found.pieces.begin() + offset(to.pieces_end),
                         found.pieces.begin() + offset(piece));
      next.made.insert(next.made.end(), found.made.begin() + offset(to.made_end), found.made.begin() + offset(made));
    };
    for (const Mark& mark : found.marks) {
      const Piece& piece = found.pieces[mark.pieces];
      if (!(paths->first_turn(piece.a, piece.b, mark.pair) < mark.time)) continue;
      if (!mark.is_stopped && !stops(found.made[mark.made], piece, mark.pair)) continue;
      copy_until(mark.pieces, mark.made);
      next.start = mark.start >= 0 ? &found.starts[at(mark.start)] : nullptr;
      find(mark.pair, contacts, next);
      to = mark;
    }
    copy_until(found.pieces.size(), found.made.size());
    next.count = 0;
    for (const Piece& piece : next.pieces) next.count += piece.stays.empty() ? 1 : piece.stays.size();
    found = std::move(next);
  }
  /// True if a contact that was found at the start of the frame stops bodies on paths that turn.
  bool stops(const BodyContact& contact, const Piece& parties, int pair) const {
    const float gap = *std::min_element(contact.gap.begin(), contact.gap.begin() + contact.count);
    return paths->between(parties.a, parties.b, pair, {}).least_along(convert<double>(contact.normal)) +
               static_cast<double>(gap) <
           0;
  }
  static std::ptrdiff_t offset(std::size_t i) { return static_cast<std::ptrdiff_t>(i); }

  /// Copies the contacts that run has found to their places, and renews the gaps of those that stay.
  static void place(const Found& found, const std::vector<BodyState>& bodies, BodyContact* to, std::pair<int, int>* of) {
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

  /// How fast a part's points move as its body spins, at most [m/s].
  float turning_of(int part, const BodyState& body) const {
    return max(of.pairs_.turning(part) - (body.is_fixed ? 0 : faster), 0.f);
  }

  double size_of(const Pair& pair) const {
    return static_cast<double>(std::min(of.pairs_.size(pair.first), of.pairs_.size(pair.second)));
  }

  double reach_of(const Pair& pair, float approach) const {
    const float fast = approach + of.pairs_.turning(pair.first) + of.pairs_.turning(pair.second);
    return static_cast<double>(BodyPairs::margin_share) * size_of(pair) + static_cast<double>(dt * fast);
  }

  bool is_renewed(int body) const { return renewed == nullptr || (*renewed)[at(body)] != 0; }

  /// True if boxes show that touch would find nothing. Between polyhedra it may find points that are farther apart.
  bool is_out_of_reach(const Pair& pair, const BodyPart& one, const BodyPart& other) const {
    constexpr float more_than_rounding = 1.01f;
    const auto is_polyhedron = [](const BodyPart& part) { return part.shape.kind == ConvexShape::Kind::polyhedron; };
    if (!one.is_convex() || !other.is_convex() || (is_polyhedron(one) && is_polyhedron(other))) return false;
    if (!is_renewed(one.body) || !is_renewed(other.body)) return false;  // whose boxes are those of the frame's start
    const float approach = length(bodies[at(one.body)].velocity - bodies[at(other.body)].velocity);
    return of.pairs_.are_apart(pair.first, pair.second, more_than_rounding * static_cast<float>(reach_of(pair, approach)));
  }

  /// True if a body moves so far within the frame that it may meet triangles of a mesh other than those that it
  /// touches, or a convex part elsewhere.
  bool may_meet_more(const Pair& pair, const BodyState& a, const BodyState& b, double size) const {
    const BodyPart& one = of.parts_[at(pair.first)];
    const double way = static_cast<double>(dt * length(a.velocity - b.velocity));
    return !one.is_half_space && way > (one.mesh != nullptr ? still_share : fast_share) * size;
  }

  /// True if bodies may touch in a frame at a contact that was found on another path.
  bool comes_near(const Pair& pair, const BodyState& a, const BodyState& b, const BodyContact& contact) const {
    if (of.parts_[at(pair.first)].is_half_space || !one_is_held(a, b)) return false;
    const Vec3f way = (b.velocity - a.velocity) * dt;
    return static_cast<double>(dot(contact.normal, way)) < -least_approach(static_cast<double>(length(way)));
  }

  /// True if the contacts of a pair stay, or, where there are none, if no new ones are looked for.
  bool stay(const Pair& pair, std::span<const BodyContact> old, const BodyState& a, const BodyState& b,
            const Posed& relative) const {
    const auto [one, other] = std::pair{of.parts_[at(pair.first)].body, of.parts_[at(pair.second)].body};
    if (is_renewed(one) || is_renewed(other)) {
      const double size = size_of(pair);
      if (may_meet_more(pair, a, b, size)) return false;
      const auto hardly_changed = [&](const BodyContact& contact) {
        return contact.b.piece == of_solids && !comes_near(pair, a, b, contact) && hardly_moved(relative, contact, size) &&
               hardly_turned(a.pose.rotation, contact);
      };
      // Contacts of what turns by itself turn with it, so that friction acts along its surface of this frame.
      return !old.empty() && !a.deforms && !a.is_driven_round && !b.is_driven_round &&
             std::all_of(old.begin(), old.end(), hardly_changed);
    }
    const double far_away = static_cast<double>(far) * size_of(pair);
    if (!of.parts_[at(pair.first)].is_convex()) return true;  // how far bodies move along planes and meshes does not matter
    return std::all_of(old.begin(), old.end(), [&](const BodyContact& contact) {
      return !(length(relative.position - convert<double>(contact.position)) > far_away);
    });
  }

  /// A pair whose contacts are searched for again.
  struct Meeting {
    int number;  ///< of the pair
    const BodyPart &one, &other;
    const BodyState &a, &b;
    std::span<const BodyContact> old;
    Posed relative;  ///< of b in the frame of a
    double size, reach, turning;
    SolidPath on;
    bool is_fast;
    bool starts_fast;  ///< before its path turns

    /// True if a body may turn far in a substep of the frame.
    bool may_tumble() const { return starts_fast && turning > 2 * tumbling_sizes * size; }
  };

  static void note_depth(const BodyContact& contact, const Piece& parties, double size, Found& found) {
    const float gap = *std::min_element(contact.gap.begin(), contact.gap.begin() + contact.count);
    const float share = -gap / static_cast<float>(size);
    if (share > found.deepest.share) found.deepest = {parties.a, parties.b, -gap, share};
  }

  void find(int number, std::span<const BodyContact> old, Found& found) const {
    const Pair& pair = of.pairs_.pairs()[at(number)];
    const BodyPart &one = of.parts_[at(pair.first)], &other = of.parts_[at(pair.second)];
    if (old.empty() && ((!is_renewed(one.body) && !is_renewed(other.body)) || is_out_of_reach(pair, one, other))) return;
    const BodyState &a = bodies[at(one.body)], &b = bodies[at(other.body)];
    const bool stays_anyway = !is_renewed(one.body) && !is_renewed(other.body) && (far >= unlimited || !one.is_convex());
    Posed relative = stays_anyway ? Posed{} : relative_to(a.pose, b.pose);
    if (stays_anyway || stay(pair, old, a, b, relative)) {
      found.pieces.push_back({old, one.body, other.body});
      found.count += old.size();
      for (const BodyContact& contact : old) note_depth(contact, found.pieces.back(), size_of(pair), found);
      return;
    }
    relative.rotation = normalise(relative.rotation);
    const Meeting meeting = meeting_of(number, old, relative);
    const std::size_t first = found.made.size();
    one.mesh != nullptr ? meet_mesh(meeting, found) : meet(meeting, found);
    if (!meeting.may_tumble()) return;
    meet_balls(meeting, found);
    std::sort(found.made.begin() + offset(first), found.made.end(), in_order);
  }

  Meeting meeting_of(int number, std::span<const BodyContact> old, const Posed& relative) const {
    const Pair& pair = of.pairs_.pairs()[at(number)];
    const BodyPart &one = of.parts_[at(pair.first)], &other = of.parts_[at(pair.second)];
    const BodyState &a = bodies[at(one.body)], &b = bodies[at(other.body)];
    const double size = size_of(pair);
    const Vec3f velocity = a.velocity - b.velocity;
    const auto is_close = [&](const BodyContact& contact) {
      const float gap = *std::min_element(contact.gap.begin(), contact.gap.begin() + contact.count);
      return gap <= BodyPairs::margin_share * static_cast<float>(size);
    };
    // What rolls or slides along a plane does not meet it with that speed.
    const float approach =
        one.is_half_space && std::any_of(old.begin(), old.end(), is_close)
            ? std::fabs(dot(velocity, rotate(convert<float>(compose(a.pose, one.pose)).rotation, Vec3f{0, 1, 0})))
            : length(velocity);
    // An impact may turn the whole approach into spin. Of two opposite points one may rise as the other sinks.
    const double turning =
        static_cast<double>(2 * dt * (approach + turning_of(pair.first, a) + turning_of(pair.second, b)));
    const double way = static_cast<double>(dt * length(velocity)), least = least_approach(way);
    const SolidPath on{path_of(one.body, other.body, number), slop_share * size + slop_of_fall * fall(), 0.5 * fall(),
                       least};
    const double least_fast = one_is_held(a, b) ? least : fast_share * size;
    const bool is_fast = length(on.path.end()) > least_fast, starts_fast = way > least_fast;
    return {number, one, other, a, b, old, relative, size, reach_of(pair, approach), turning, on, is_fast, starts_fast};
  }

  /// Adds a contact that b touches when it has moved by so much in the frame of a [m].
  static void add(const Meeting& m, const Touch& touching, const Vec3d& moved, int piece, Found& found,
                  int of = of_solids) {
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

  /// Two convex parts, or a half-space and one.
  void meet(const Meeting& m, Found& found) const {
    const Reach within{m.reach, m.turning, rocking_of(m.a, m.b, dt, faster)};
    const Posed placed = apart(m.relative, m.one.body, m.other.body, m.size);
    const Touch now = found.start != nullptr ? *found.start : touch_of(m.one, m.other, placed, within);
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

  static MeshSideKept side_kept_of(const Meeting& m) {
    return m.a.deforms ? MeshSideKept{} : side_kept(*m.one.mesh, m.other, m.relative, 2 * m.reach, m.old);
  }
  void meet_mesh(const Meeting& m, Found& found) const {
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

  /// The contacts of the balls inside of bodies that may turn far in a substep.
  void meet_balls(const Meeting& m, Found& found) const {
    const float of_a = is_held(m.a) ? 0 : inner_radius(m.one), of_b = is_held(m.b) ? 0 : inner_radius(m.other);
    if (of_b > 0 && m.one.mesh != nullptr) meet_mesh_ball(m, inner_ball(m.other, of_b), found);
    if (of_b > 0 && m.one.mesh == nullptr) meet_ball(m, m.one, inner_ball(m.other, of_b), of_ball_b, found);
    if (of_a > 0) meet_ball(m, inner_ball(m.one, of_a), m.other, of_ball_a, found);
  }
  void meet_ball(const Meeting& m, const BodyPart& one, const BodyPart& other, int which, Found& found) const {
    const Reach within{m.reach, m.turning, {}};
    const Posed placed = apart(m.relative, one.body, other.body, m.size);
    const Touch now = touch_of(one, other, placed, within);
    if (one.is_half_space) return add(m, now, {}, 0, found, which);
    const PairTouch touching = touch_on_path(one, other, placed, within, now, m.on);
    add(m, touching.touch, touching.moved, 0, found, which);
  }
  void meet_mesh_ball(const Meeting& m, const BodyPart& ball, Found& found) const {
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

  /// The path of b against a in the frame of a.
  ContactPath path_of(int a, int b, int pair) const {
    const BodyState &one = bodies[at(a)], &other = bodies[at(b)];
    return paths == nullptr ? BodyPaths::straight(one, other, dt, one.pose.rotation)
                            : paths->between(a, b, pair, one.pose.rotation);
  }
  /// Twice what gravity may add to a path in the frame [m].
  double fall() const { return static_cast<double>(dt * faster); }

  /// Solids that slide along free ones meet them as often as these meet one another, in piles, where a search costs
  /// more than it gains.
  static bool one_is_held(const BodyState& a, const BodyState& b) { return is_held(a) || is_held(b); }
  /// Colliders that move are not fixed while bodies sleep, but yield to nothing.
  static bool is_held(const BodyState& body) { return body.is_fixed || !body.yields; }
  /// What moves by `way` and comes nearer by less in the frame is hardly thrown [m].
  double least_approach(double way) const {
    return (way > slow_way_of_fall * fall() ? approach_of_fall : slow_approach_of_fall) * fall() + 1e-7;
  }

  static void note_first(const PathContact& first, const Meeting& m, Found& found) {
    if (first.touches && length(m.on.path.end()) > fast_share * m.size)
      found.first.push_back({m.one.body, m.other.body, m.number, first.time, rotate(m.a.pose.rotation, first.normal)});
  }
};

bool in_order(const BodyContact& a, const BodyContact& b) {
  return std::tuple{solids_of(a), a.a.piece, a.b.piece} < std::tuple{solids_of(b), b.a.piece, b.b.piece};
}

BodyContacts::BodyContacts(std::vector<BodyPart> parts) : parts_(std::move(parts)), pairs_(parts_) {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
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

/// Contacts in the direction of a path that ends at something else are found once more.
void BodyContacts::find_on_paths(Executor& executor, Task task) {
  touches_.clear();
  for (const Found& found : found_) touches_.insert(touches_.end(), found.first.begin(), found.first.end());
  if (touches_.empty()) return;
  paths_.begin(task.bodies, task.dt, touches_);
  task.paths = &paths_;
  executor.parallel_for("bodies: contacts", static_cast<int>(found_.size()),
                        [&](int i) { task.run_on_paths(found_[at(i)]); });
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
                         FunctionRef<bool(int, int)> meet, const std::vector<char>& of, float far,
                         std::vector<BodyContact>& now) {
  pairs_.renew(executor, parts_, bodies, dt, faster, meet, of);
  const Task task{*this, bodies, now, dt, faster, nullptr, &of, far};
  find(executor, task);
  replace(executor, task, now);
}

}  // namespace pliant
