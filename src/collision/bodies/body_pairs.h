// Pairs of parts of bodies that may touch within a frame, by their boxes.
//
// A tree of boxes a little larger than needed yields pairs that serve for many frames, as long as no box leaves its
// larger one. Which of them overlap in a frame does not depend on when the tree was built.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "collision/bodies/body_crowds.h"
#include "collision/bodies/body_part.h"
#include "parallel/executor.h"

namespace pliant {

class BodyPairs {
 public:
  /// Two parts that may touch, by index, the smaller one first.
  using Pair = std::pair<int, int>;

  BodyPairs() = default;
  /// `parts` are in the order of BodyContacts.
  explicit BodyPairs(const std::vector<BodyPart>& parts);

  /// Finds the pairs of a frame (BodyContacts::update). `meet` must not change as long as this object lives.
  void update(Executor& executor, const std::vector<BodyPart>& parts, const std::vector<BodyState>& bodies, float dt,
              float faster, FunctionRef<bool(int, int)> meet);
  /// Finds those of some bodies again within a frame, for what is left of it: those for which `of` is not zero [body].
  void renew(Executor& executor, const std::vector<BodyPart>& parts, const std::vector<BodyState>& bodies, float dt,
             float faster, FunctionRef<bool(int, int)> meet, const std::vector<char>& of);

  /// The pairs whose boxes overlap, in the order of their contacts (BodyPart::id).
  const std::vector<Pair>& pairs() const { return pairs_; }
  /// True if the bodies of two convex parts are apart by more than `reach` [m], as their boxes show. False says
  /// nothing.
  bool are_apart(int a, int b, float reach) const;
  /// Half of the smallest extent of a part [m].
  float size(int part) const { return size_[static_cast<std::size_t>(part)]; }
  /// An upper bound of the speed of a part's points against the centre of its body [m/s].
  float turning(int part) const { return turning_[static_cast<std::size_t>(part)]; }

  /// Parts nearer than this share of the smaller one's size have a contact.
  static constexpr float margin_share = 0.04f;
  /// Where parts overlap more than this many others on average, as thousands of bodies in one place do, each meets at
  /// most so many.
  static constexpr std::size_t most_of_crowded = 48;
  /// The number of pairs that the last update left out for that.
  std::ptrdiff_t left_out() const { return left_out_; }

 private:
  /// What a search needs of a frame.
  struct Frame {
    const std::vector<BodyPart>& parts;
    const std::vector<BodyState>& bodies;
    float dt;
    FunctionRef<bool(int, int)> meet;
  };

  void find_boxes(Executor& executor, const Frame& frame, float faster, const std::vector<char>* of);
  void find_box(const Frame& frame, float faster, int i);
  bool fits() const;
  void find_near(Executor& executor, const Frame& frame);
  void find_near(const Frame& frame, int task, std::vector<Pair>& found);
  void find_overlapping(Executor& executor, const Frame& frame, const std::vector<char>* of);
  void find_pairs_of_others(const Frame& frame, const std::vector<int>* some);
  bool find_by_tree(Executor& executor, const Frame& frame);
  void take_found(int tasks);
  void replace(const Frame& frame, const std::vector<char>& of);
  bool in_order(const Pair& a, const Pair& b) const;
  void thin_crowd(const Frame& frame);

  std::vector<int> convex_, others_;  ///< parts: convex ones; half-spaces and meshes; ascending
  std::vector<float> size_, turning_;
  float most_through_ = 0;         ///< how far a mesh's box is grown for the largest part [m]
  std::vector<int> rank_;          ///< [part] its place in the order of contacts
  std::vector<BoxBounds> still_;   ///< [part] of convex parts, without what they may move in a frame
  std::vector<BoxBounds> boxes_;   ///< of convex parts in this frame
  std::vector<BoxBounds> larger_;  ///< of convex parts when the tree was built
  BodyCrowds crowds_;              ///< trees of larger_
  std::vector<Pair> near_;         ///< indices in convex_ whose larger boxes overlap, ascending
  std::vector<int> first_near_;    ///< of each part in convex_: its first pair in near_ as the smaller one
  std::vector<Pair> pairs_, of_others_, found_;
  std::vector<int> renewed_;  ///< indices in convex_ of the parts of bodies that are renewed
  std::vector<std::vector<Pair>> of_task_;
  std::ptrdiff_t left_out_ = 0;
};

}  // namespace pliant
