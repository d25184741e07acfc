// The search for the contacts of pairs of parts: which stay, and which are found again (BodyContacts).
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "collision/bodies/body_contacts.h"
#include "collision/bodies/contacts_before.h"
#include "collision/bodies/kept_side.h"
#include "core/at.h"
#include "geometry/contact_path.h"

namespace pliant {

/// What the search for the contact of one pair needs.
struct BodyContacts::Task {
  static constexpr float unlimited = 1e30f;  ///< [m]
  /// Where two free solids move against each other by less than this share of the smaller part's size in a frame,
  /// directions hardly change.
  static constexpr double fast_share = 0.15;
  /// Where points may move in a frame by more than this multiple of the smaller part's size, a substep may turn it far.
  static constexpr double tumbling_sizes = 2;

  const BodyContacts& of;
  const std::vector<BodyState>& bodies;
  const std::vector<BodyContact>& before;
  float dt, faster;
  const BodyPaths* paths = nullptr;             ///< null: straight ones
  const std::vector<Again>* renewed = nullptr;  ///< [body] null: the contacts of all are found again
  float far = unlimited;  ///< contacts of others stay unless bodies have moved farther (BodyContacts::renew)

  /// Finds the contacts of pairs [first, last).
  void run(int first, int last, Found& found) const;

  void find(int pair, ContactsBefore& contacts, Found& found) const;

  /// True if the contacts of a pair are found again, because one of its bodies touches a third one first.
  bool is_found_again(const Found& found, const Mark& mark) const;
  void find_again(const Found& found, const Mark& mark, ContactsBefore& contacts, Found& next) const;
  /// Finds the contacts of those pairs again, or only of pairs that have none yet.
  void run_on_paths(Found& found, bool only_open) const;
  /// True if a contact that was found at the start of the frame stops bodies on paths that turn.
  bool stops(const BodyContact& contact, const Piece& parties, int pair) const;
  static std::ptrdiff_t offset(std::size_t i) { return static_cast<std::ptrdiff_t>(i); }

  /// Copies the contacts that run has found to their places, and renews the gaps of those that stay.
  static void place(const Found& found, const std::vector<BodyState>& bodies, BodyContact* to, std::pair<int, int>* of);

  /// How fast a part's points move as its body spins, at most [m/s].
  float turning_of(int part, const BodyState& body) const;

  double size_of(const Pair& pair) const;

  double reach_of(const Pair& pair, float approach) const;

  /// The speed of one body against the other; of a pair that is opened, the greatest on paths that turn [m/s].
  float speed_of(int pair, bool is_opened) const;

  /// True for a pair without contacts that may come to touch where something else stops one of its bodies.
  bool may_open(int pair) const;

  /// True if touch would find nothing. `relative`: of the body of the second part in the frame of that of the first.
  bool are_surely_apart(const Pair& pair, const BodyPart& one, const BodyPart& other, const Posed& relative,
                        float speed) const;

  /// True if the contacts `old` of a pair are found again.
  bool is_renewed(const Pair& pair, std::span<const BodyContact> old) const;
  /// True if contacts of a body are looked for where it has none.
  bool may_begin(int body) const { return renewed == nullptr || (*renewed)[at(body)] == Again::all; }

  /// True if boxes show that touch would find nothing. Between polyhedra it may find points that are farther apart.
  bool is_out_of_reach(const Pair& pair, const BodyPart& one, const BodyPart& other, float speed) const;

  /// True if a body moves so far within the frame that it may meet triangles of a mesh other than those that it
  /// touches, or a convex part elsewhere.
  bool may_meet_more(const Pair& pair, const BodyState& a, const BodyState& b, double size) const;

  /// True if bodies may touch in a frame at a contact that was found on another path.
  bool comes_near(const Pair& pair, const BodyState& a, const BodyState& b, const BodyContact& contact) const;

  /// True if the contacts of a pair stay, or, where there are none, if no new ones are looked for.
  bool stay(const Pair& pair, std::span<const BodyContact> old, const BodyState& a, const BodyState& b,
            const Posed& relative) const;

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

  static void note_depth(const BodyContact& contact, const Piece& parties, double size, Found& found);

  void find(int number, std::span<const BodyContact> old, Found& found) const;

  Meeting meeting_of(int number, std::span<const BodyContact> old, const Posed& relative, float speed) const;

  /// Adds a contact that b touches when it has moved by so much in the frame of a [m].
  static void add(const Meeting& m, const Touch& touching, const Vec3d& moved, int piece, Found& found,
                  int of = of_solids);

  /// Two convex parts, or a half-space and one.
  void meet(const Meeting& m, Found& found) const;

  static MeshSideKept side_kept_of(const Meeting& m);
  void meet_mesh(const Meeting& m, Found& found) const;

  /// The contacts of the balls inside of bodies that may turn far in a substep.
  void meet_balls(const Meeting& m, Found& found) const;
  void meet_ball(const Meeting& m, const BodyPart& one, const BodyPart& other, int which, Found& found) const;
  void meet_mesh_ball(const Meeting& m, const BodyPart& ball, Found& found) const;

  /// The path of b against a in the frame of a.
  ContactPath path_of(int a, int b, int pair) const;
  /// Twice what gravity may add to a path in the frame [m].
  double fall() const { return static_cast<double>(dt * faster); }

  /// Solids that slide along free ones meet them as often as these meet one another, in piles, where a search costs
  /// more than it gains.
  static bool one_is_held(const BodyState& a, const BodyState& b) { return is_held(a) || is_held(b); }
  /// Colliders that move are not fixed while bodies sleep, but yield to nothing.
  static bool is_held(const BodyState& body) { return body.is_fixed || !body.yields; }
  /// What moves by `way` and comes nearer by less in the frame is hardly thrown [m].
  double least_approach(double way) const;

  static void note_first(const PathContact& first, const Meeting& m, Found& found);
};

}  // namespace pliant
