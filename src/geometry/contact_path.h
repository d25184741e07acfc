// Where a convex solid that moves without turning first touches another one, or passes nearest to it.
//
// The separation of two convex solids is a convex function of their displacement, so Newton's steps along a straight
// leg never pass the first touch; where there is none, a sign of the slope tells on which side the nearest place is.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "math/vector.h"

namespace pliant {

/// The displacement of a solid over a frame, from time 0 to 1, in straight legs [m].
class ContactPath {
 public:
  static constexpr std::size_t most_legs = 4;
  struct Leg {
    double start = 0, duration = 0;
    Vec3d from{};   ///< the displacement at its start
    Vec3d speed{};  ///< the displacement that the whole frame would bring at this speed
  };

  /// One leg by which a solid moves `along` in the whole frame.
  explicit ContactPath(const Vec3d& along) { legs_[0] = {0, 1, {}, along}; }

  std::size_t count() const { return count_; }
  const Leg& leg(std::size_t i) const { return legs_[i]; }
  Vec3d at(const Leg& leg, double share) const { return leg.from + leg.speed * (leg.duration * share); }
  Vec3d end() const { return at(legs_[count_ - 1], 1); }

  /// The least displacement along a direction at the ends of legs.
  double least_along(const Vec3d& direction) const {
    double least = 0;
    for (std::size_t i = 0; i < count_; ++i) least = std::fmin(least, dot(direction, at(legs_[i], 1)));
    return least;
  }

  /// The speed at a time.
  Vec3d speed_at(double time) const {
    std::size_t i = count_ - 1;
    while (i > 0 && legs_[i].start > time) --i;
    return legs_[i].speed;
  }

  /// Adds `change` to the speed from `time` on. Paths of more legs than there may be stay as they are.
  void turn(double time, const Vec3d& change) {
    if (count_ == most_legs || !(time < 1)) return;
    std::size_t i = count_ - 1;
    while (i > 0 && legs_[i].start > time) --i;
    for (std::size_t k = count_; k > i; --k) legs_[k] = legs_[k - 1];
    ++count_;
    legs_[i].duration = time - legs_[i].start;
    legs_[i + 1].start = time;
    legs_[i + 1].duration -= legs_[i].duration;
    for (std::size_t k = i + 1; k < count_; ++k) {
      legs_[k].from = at(legs_[k - 1], 1);
      legs_[k].speed += change;
    }
  }

 private:
  std::array<Leg, most_legs> legs_{};
  std::size_t count_ = 1;
};

/// The path of a solid against another one, and what counts as touching on it.
struct SolidPath {
  ContactPath path;
  double slop = 0;   ///< solids that go in by no more slide past each other [m]
  double sag = 0;    ///< what gravity may add to the path [m]
  double least = 0;  ///< what comes nearer by less in the frame is not stopped [m]

  /// True if a contact in a direction, with a gap now [m], stops the solid on its path.
  bool is_stopped(const Vec3d& normal, double gap) const {
    const double along = path.least_along(normal);
    return along < -least && gap + along < sag;
  }
};

/// What a search along a path measures: the separation of two solids [m], and the unit vector to the one that moves.
struct PathGap {
  double separation = 0;
  Vec3d normal{};
};

/// The first touch on a path, or the place nearest to one.
struct PathContact {
  bool touches = false;  ///< and would go in by more than was allowed
  double time = 0;       ///< in the frame, from 0 to 1
  Vec3d displacement{};  ///< of the solid that moves [m]
  Vec3d normal{};        ///< there
};

/// Finds where solids whose separation is `gap_at(displacement)` first touch, if they go in by more than `slop` [m]
/// then; else where they pass nearest. A pair that approaches by less than `slow` [m] in a frame passes.
template <class GapAt>
class PathSearch {
 public:
  PathSearch(const ContactPath& path, double slop, const GapAt& gap_at, double slow = 0)
      : path_(path), slop_(slop), slow_(slow), gap_at_(gap_at) {}

  /// `now`, a plane that separates the solids at the start by so much, saves steps.
  PathContact find(const PathGap& now = {}) {
    for (std::size_t i = 0; i < path_.count(); ++i)
      if (along(path_.leg(i), i == 0 ? now : PathGap{})) return first_;
    if (least_ == 1e300) stay();
    return comes_at_end_ ? pass_beyond() : nearest_;
  }

 private:
  static constexpr int most_steps = 32;
  static constexpr double accuracy = 0.1;  ///< share of the slop
  /// Of motion whose share along the normal is less solids neither come nearer nor part.
  static constexpr double sideways = 1e-4;
  static constexpr double narrow = 1e-4;     ///< share of a leg
  static constexpr double frames_ahead = 4;  ///< in which is seen whether solids pass each other

  /// What does not move is nearest where it is.
  void stay() {
    const PathGap gap = gap_at_({});
    note({false, 0, {}, gap.normal}, gap.separation);
  }

  /// What would go past in the frames that follow is not held by the direction along which it comes at the end of this
  /// one.
  PathContact pass_beyond() {
    const PathContact at_end = nearest_;
    ContactPath::Leg leg = path_.leg(path_.count() - 1);
    leg.from = path_.at(leg, 1), leg.start = 1, leg.duration = frames_ahead;
    least_ = 1e300;
    return along(leg, {}) || comes_at_end_ ? at_end : nearest_;
  }

  /// Returns true if solids touch on a leg, and go in. `now` may be a plane that separates them at its start.
  bool along(const ContactPath::Leg& leg, const PathGap& now) {
    const Vec3d motion = leg.speed * leg.duration;
    comes_at_end_ = false;
    const double slow = leg.start < 1 ? 0 : slow_ * leg.duration;
    const double level = std::fmax(sideways * length(motion), slow), slope_now = dot(now.normal, motion);
    const bool is_plane = slope_now < -level && now.separation > -slop_;
    bool touched = is_plane && now.separation <= accuracy * slop_;
    if (touched) first_ = {true, leg.start, leg.from, now.normal};
    double share = is_plane ? std::fmin((now.separation + (touched ? slop_ : 0)) / -slope_now, 1.) : 0;
    double before = 0, after = 2;  // the nearest place is between these shares of the leg
    PathGap coming, parting;       // at these
    for (int step = 0; step < most_steps && level > 0; ++step) {
      const PathGap gap = gap_at_(path_.at(leg, share));
      const double slope = dot(gap.normal, motion);
      const PathContact here{true, leg.start + leg.duration * share, path_.at(leg, share), gap.normal};
      note(here, gap.separation);
      if (!touched && gap.separation <= accuracy * slop_) touched = true, first_ = here;
      if (slope < 0 && gap.separation <= (accuracy - 1) * slop_) return true;
      if (std::fabs(slope) <= level) note_least(here, gap.separation);
      comes_at_end_ = slope < -level && share >= 1 && gap.separation < slop_;
      if (std::fabs(slope) <= level || (slope < 0 && share >= 1)) return false;
      (slope < 0 ? before : after) = share;
      (slope < 0 ? coming : parting) = gap;
      if (after - before < narrow) {
        if (length_squared(coming.normal) > 0) slide(coming.normal, parting.normal, motion);
        return false;
      }
      const double target = touched ? -slop_ : 0, ahead = share - (gap.separation - target) / slope;
      // Where a step went past the nearest place, solids do not touch, or not as deep: only that place is looked for.
      share = after <= 1 ? 0.5 * (before + after) : std::fmin(ahead, 1.);
    }
    return false;
  }

  void note(const PathContact& here, double separation) {
    if (separation >= least_) return;
    least_ = separation;
    nearest_ = here;
    nearest_.touches = false;
  }

  /// Where solids neither come nearer nor part they are nearest, as the separation is convex: of two that slide along
  /// one another, and not at the edge at which that begins.
  void note_least(const PathContact& here, double separation) {
    if (!(separation < least_ + slop_)) return;
    least_ = std::fmin(separation, least_);
    nearest_ = here;
    nearest_.touches = false;
  }

  /// Where the direction turns at once from one that solids come along to one along which they part, both pass along
  /// any between: the one across the motion stops nothing.
  void slide(const Vec3d& coming, const Vec3d& parting, const Vec3d& motion) {
    nearest_.normal = unit_or(coming * dot(parting, motion) - parting * dot(coming, motion), nearest_.normal);
  }

  const ContactPath& path_;
  double slop_, slow_;
  const GapAt& gap_at_;
  double least_ = 1e300;
  bool comes_at_end_ = false;
  PathContact first_, nearest_;
};

}  // namespace pliant
