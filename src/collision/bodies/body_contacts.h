// Contact between rigid bodies: pairs of parts that may touch within a frame, and their manifolds, kept over frames.
//
// A manifold stays as it was born, with its normal and its arms, while its bodies hardly move against each other, and only its gaps
// are renewed: fresh arms let tall stacks of soft contacts buckle (Catto, box2d 3, recycles manifolds for the same reason).
#pragma once

#include <vector>

#include "collision/bodies/manifold.h"
#include "collision/broad/tree.h"
#include "geometry/convex_shape.h"

namespace pliant {

/// A convex part of a body.
struct BodyPart {
  int body = 0;
  ConvexShape shape;
  Posed pose{};  ///< of the shape in the body's frame
  float friction = 0.5f, restitution = 0;
};

/// Where a body is and how it moves at a frame's start.
struct BodyState {
  Posed pose{};              ///< from the body's frame to the world
  Vec3f velocity{}, spin{};  ///< [m/s], [rad/s], in world axes
  bool is_fixed = false;     ///< two fixed bodies do not touch
};

class BodyContacts {
 public:
  /// The polyhedra of parts must stay where they are.
  explicit BodyContacts(std::vector<BodyPart> parts);

  /// Finds all manifolds of a frame of `dt` seconds. Bodies touch if they may come within reach in it, or are within `margin` [m].
  void update(const std::vector<BodyState>& bodies, float dt, float margin);

  std::size_t parts() const { return parts_.size(); }

  /// Sorted by parts.
  std::vector<KeptManifold>& manifolds() { return manifolds_; }
  const std::vector<KeptManifold>& manifolds() const { return manifolds_; }

 private:
  void find_pairs(const std::vector<BodyState>& bodies, float dt, float margin);
  const KeptManifold* before(int part_a, int part_b) const;

  std::vector<BodyPart> parts_;
  std::vector<std::pair<int, int>> pairs_;  ///< of parts whose boxes overlap, sorted
  std::vector<KeptManifold> manifolds_, next_;
  std::vector<BoxBounds> boxes_;
  Tree<BoxBounds> tree_;
};

}  // namespace pliant
