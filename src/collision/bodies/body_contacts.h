// Contact between rigid bodies, and of bodies with colliders: pairs of parts that may touch within a frame, and their points.
//
// A contact stays as it was born, with its normal and its arms, while its bodies hardly move against each other, and only its gaps
// are renewed: fresh arms let tall stacks of soft contacts buckle (Catto, box2d 3, recycles manifolds for the same reason).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "collision/bodies/body_mesh.h"
#include "collision/broad/tree.h"
#include "geometry/convex_shape.h"
#include "parallel/executor.h"
#include "pliant/state.h"

namespace pliant {

/// The order of contacts: by owners and solids of both sides, then by pieces.
bool in_order(const BodyContact& a, const BodyContact& b);

/// A convex part of a body, a half-space or a mesh.
struct BodyPart {
  ContactPart id;
  int body = 0;
  ConvexShape shape;
  bool is_half_space = false;      ///< y <= 0 of its frame, instead of the shape
  Posed pose{};                    ///< of the shape in the body's frame
  const BodyMesh* mesh = nullptr;  ///< instead of the shape

  bool is_convex() const { return !is_half_space && mesh == nullptr; }
};

/// Where a body is and how it moves at a frame's start.
struct BodyState {
  Posed pose{};              ///< from the body's frame to the world
  Vec3f velocity{}, spin{};  ///< [m/s], [rad/s], in world axes
  bool is_fixed = false;     ///< two fixed bodies do not touch
  bool deforms = false;      ///< a mesh that moves by its vertices, so that no contact with it stays
};

class BodyContacts {
 public:
  BodyContacts() = default;
  /// Convex parts are in ascending order of their ids; polyhedra and meshes of parts must stay where they are. Half-spaces and meshes
  /// belong to fixed bodies.
  explicit BodyContacts(std::vector<BodyPart> parts);

  /// Finds all contacts of a frame of `dt` seconds, in ascending order of parts. Parts may touch if `meet` is true for their bodies,
  /// and they may come within reach in the frame, in which speeds may increase by `faster` [m/s]. `before` are the contacts of the
  /// frame before, in the same order.
  void update(Executor& executor, const std::vector<BodyState>& bodies, float dt, float faster,
              FunctionRef<bool(int, int)> meet, const std::vector<BodyContact>& before, std::vector<BodyContact>& now);

  const std::vector<BodyPart>& parts() const { return parts_; }

  /// Where parts overlap more than this many others on average, as thousands of bodies in one place do, each meets at most so many.
  static constexpr std::size_t most_of_crowded = 48;
  /// The number of pairs that the last update left out for that.
  std::ptrdiff_t left_out() const { return left_out_; }

 private:
  /// Two parts that may touch, by index.
  using Pair = std::pair<int, int>;
  struct Task;
  /// Contacts of the frame before that stay, of bodies a and b; or one that a task has made, if there are none.
  struct Piece {
    std::span<const BodyContact> stays;
    int a = 0, b = 0;
  };
  /// What a task has found, in the order of pairs.
  struct Found {
    std::vector<Piece> pieces;
    std::vector<BodyContact> made;
    std::size_t count = 0;  ///< of contacts

    void clear() {
      pieces.clear();
      made.clear();
      count = 0;
    }
  };

  void find_boxes(Executor& executor, const std::vector<BodyState>& bodies, float dt, float faster);
  void find_pairs(const std::vector<BodyState>& bodies, float dt, FunctionRef<bool(int, int)> meet);
  void thin_crowd(const std::vector<BodyState>& bodies);

  std::vector<BodyPart> parts_;
  std::vector<int> convex_, others_;  ///< parts: convex ones; half-spaces and meshes; ascending
  std::vector<float> size_;           ///< of each part: half of its smallest extent [m]
  std::vector<Pair> pairs_;           ///< of parts whose boxes overlap, sorted
  std::vector<BoxBounds> boxes_;      ///< of convex parts
  std::vector<float> turning_;  ///< [part] an upper bound of the speed of its points against the centre of its body [m/s]
  std::ptrdiff_t left_out_ = 0;
  std::vector<Found> found_;  ///< [task]
  Tree<BoxBounds> tree_;
};

}  // namespace pliant
