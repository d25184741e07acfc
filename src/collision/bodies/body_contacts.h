// Contact between rigid bodies, and of bodies with colliders: pairs of parts that may touch within a frame, and their
// points.
//
// A contact stays as it was born, with its normal and its arms, while its bodies hardly move against each other, and
// only its gaps are renewed: fresh arms let tall stacks of soft contacts buckle (Catto, box2d 3, recycles manifolds for
// the same reason).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "collision/bodies/body_pairs.h"
#include "collision/bodies/body_paths.h"
#include "collision/bodies/part_gap.h"
#include "geometry/touch.h"
#include "parallel/executor.h"
#include "pliant/state.h"

namespace pliant {

/// The order of contacts: by owners and solids of both sides, then by pieces.
bool in_order(const BodyContact& a, const BodyContact& b);

/// How deep two bodies overlap.
struct BodyOverlap {
  int a = -1, b = -1;  ///< bodies
  float depth = 0;     ///< [m]
  float share = 0;     ///< of the smaller part's size (BodyPairs::size)
};

class BodyContacts {
 public:
  BodyContacts() = default;
  /// Convex parts are in ascending order of their ids; polyhedra and meshes of parts must stay where they are.
  /// Half-spaces and meshes belong to fixed bodies.
  explicit BodyContacts(std::vector<BodyPart> parts);

  /// Finds all contacts of a frame of `dt` seconds, in ascending order of parts. Parts may touch if `meet` is true for
  /// their bodies, always with the same answer, and they may come within reach in the frame, in which speeds may
  /// increase by `faster` [m/s]. `before` are the contacts of the frame before, in the same order; it may be the same
  /// list as `now`.
  void update(Executor& executor, const std::vector<BodyState>& bodies, float dt, float faster,
              FunctionRef<bool(int, int)> meet, const std::vector<BodyContact>& before, std::vector<BodyContact>& now);

  /// Which contacts of a body are found again within a frame.
  enum class Again : char { none, touching, all };

  /// True if a contact of parts of this size touches or nearly does [m].
  static bool is_close(const BodyContact& contact, float size) {
    return *std::min_element(contact.gap.begin(), contact.gap.begin() + contact.count) <=
           BodyPairs::margin_share * size;
  }

  /// Finds the contacts of some bodies again, for what is left of a frame: for each body those that touch, or all; of a
  /// plane or mesh, only with bodies that it may have met already. Of the others, contacts stay, with the gaps of now,
  /// unless both have moved against each other by more than the share `far` of the smaller part's size since these
  /// began.
  void renew(Executor& executor, const std::vector<BodyState>& bodies, float dt, float faster,
             FunctionRef<bool(int, int)> meet, const std::vector<Again>& of, float far, std::vector<BodyContact>& now);

  /// The bodies of each contact of the last update.
  const std::vector<std::pair<int, int>>& bodies() const { return bodies_; }
  const std::vector<BodyPart>& parts() const { return parts_; }
  /// Half of the smallest extent of the parts of a body [m]; without end for planes, meshes and bodies without parts.
  float size_of_body(int body) const {
    const auto place = static_cast<std::size_t>(body);
    return place < size_.size() ? size_[place] : 1e30f;
  }

  /// The deepest contact of a frame, relative to the size of its bodies: of those that stay, when the frame before
  /// began.
  BodyOverlap deepest() const;
  /// The number of pairs that the last update left out (BodyPairs::most_of_crowded).
  std::ptrdiff_t left_out() const { return pairs_.left_out(); }

 private:
  using Pair = BodyPairs::Pair;
  struct Task;
  /// Contacts of bodies a and b of the frame before that stay; or one that a task has made, if there are none.
  struct Piece {
    std::span<const BodyContact> stays;
    int a = 0, b = 0;
  };
  /// Which of the pieces and contacts of a task are those of a pair, where it has made some or may do so.
  struct Mark {
    int pair = 0;
    std::size_t pieces = 0, pieces_end = 0, made = 0, made_end = 0;
    bool is_stopped = false;  ///< PairTouch::is_stopped; true of all with meshes
    double time = 1;          ///< of the first touch on the path
    int start = -1;           ///< number of its touch at the start of the frame (Found::starts); -1: not kept

    /// True of a pair that is apart, and may not stay so where something stops one of its bodies.
    bool is_open() const { return pieces == pieces_end; }
  };
  /// What a task has found, in the order of pairs.
  struct Found {
    std::vector<Piece> pieces;
    std::vector<BodyContact> made;
    std::vector<Mark> marks;
    std::vector<FirstTouch> first;
    std::vector<Touch> starts;     ///< touches at the start of the frame, of pairs that may be searched again
    const Touch* start = nullptr;  ///< that of the pair searched again; null: it is not kept
    bool is_opened = false;        ///< the pair searched again touched nowhere on straight paths
    std::size_t count = 0;         ///< of contacts
    bool any_stopped = false;      ///< of the last pair (Mark::is_stopped)
    bool is_apart = false;         ///< the solids of the last pair touch nowhere, and did not
    BodyOverlap deepest{};

    void clear() {
      pieces.clear();
      made.clear();
      marks.clear();
      first.clear();
      starts.clear();
      start = nullptr;
      is_opened = false;
      count = 0;
      deepest = {};
    }
  };

  void find(Executor& executor, const Task& task);
  void find_on_paths(Executor& executor, Task task);
  void replace(Executor& executor, const Task& found, std::vector<BodyContact>& now);
  bool all_stay(const std::vector<BodyContact>& before) const;

  std::vector<BodyPart> parts_;
  std::vector<float> size_;      ///< [body]
  std::vector<PartBall> balls_;  ///< [part] of convex ones
  BodyPairs pairs_;
  std::vector<Found> found_;         ///< [task]
  std::vector<FirstTouch> touches_;  ///< in the order of pairs
  BodyPaths paths_;
  std::vector<std::size_t> first_;  ///< [task] its first contact
  std::vector<BodyContact> next_;
  std::vector<char> renewed_;  ///< [body] nonzero: all its contacts are found again
  std::vector<std::pair<int, int>> bodies_;
};

}  // namespace pliant
