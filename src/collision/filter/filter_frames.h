// The frames of reference in which the filter truncates steps.
//
// Bodies on which nothing fixed acts, and that touch one another, share a frame that moves with the mean displacement
// of what is truncated. There the filter's planes do not depend on a velocity that the bodies have in common, and their
// centre of mass stays where the solver put it. All others have the frame of the world.
#pragma once

#include <cstddef>
#include <vector>

#include "collision/proxies/pair_model.h"
#include "collision/proxies/pair_stencil.h"
#include "core/islands.h"

namespace pliant {

/// What acts on a body of a PairModel in a substep.
struct FreeBody {
  int group = -1;  ///< bodies of the same number, which is that of one of them, touch; -1: something fixed acts on it
  /// How far its particles may leave their paths, so that they meet nothing that the filter does not know [m].
  float room = 0;
};
/// [body] Empty: something fixed acts on all.
using FreeBodies = std::vector<FreeBody>;

/// A displacement rounded to multiples of what the largest coordinates of an extent [m] are rounded to, so that
/// positions keep their differences where it is added to them: else particles that go with a frame at a small gap pass
/// one another.
Vec3f rounded_as_positions(const Vec3f& displacement, float extent);

class FilterFrames {
 public:
  explicit FilterFrames(const PairModel& model) : model_(model) {}

  /// Starts a substep, in which all frames are that of the world until more is known.
  void begin();
  void know(const FreeBodies& bodies);
  /// True if any body is free.
  bool any() const { return !root_.empty(); }

  /// Steps of a body that are cut: the sum of displacements by their weights [kg m], that of these [kg], and the
  /// largest coordinate where they start [m].
  struct Cut {
    Vec3d moved{};
    double weight = 0;
    float extent = 0;
  };
  /// Lets frames move with what is cut, by bodies. The frame of a group of which nothing is cut moves on as it did, and
  /// one that would move farther than there is room stays. Displacements are such that positions are not rounded by
  /// them.
  void move(const std::vector<Cut>& cuts);
  /// Unites the bodies of these pairs, in any order: all are free if all were, and none if one was not. Returns false
  /// if there are none.
  bool unite(const std::vector<PairStencil>& pairs);
  /// From now on all frames are that of the world.
  void stop();

  /// The first body of the group of a vertex; -1 if something fixed acts on it.
  int root_of(int vertex) const {
    return root_.empty() ? -1 : root_of_body(model_.shared->vertex_body[static_cast<std::size_t>(vertex)]);
  }
  /// The first body of the group of a body; -1 if something fixed acts on it. `otherwise` where groups are not known.
  int group_of_body(int body, int otherwise) const { return root_.empty() ? otherwise : root_of_body(body); }
  /// True if the two bodies of a pair have one frame.
  bool share_one(const PairStencil& pair) const { return root_of(pair.vertex[0]) == root_of(pair.vertex[3]); }
  bool is_free(int vertex) const { return root_of(vertex) >= 0; }
  /// The displacement of the frame of a vertex or of a body [m]; zero where something fixed acts.
  const Vec3f& of(int vertex) const { return of_root(root_of(vertex)); }
  const Vec3f& of_body(int body) const { return of_root(root_of_body(body)); }

 private:
  int root_of_body(int body) const { return root_.empty() || body < 0 ? -1 : root_[static_cast<std::size_t>(body)]; }
  const Vec3f& of_root(int root) const { return root < 0 ? at_rest_ : displacement_[static_cast<std::size_t>(root)]; }
  void find_roots();

  const PairModel& model_;
  FreeBodies bodies_;
  Islands islands_;                  ///< of bodies
  std::vector<int> root_;            ///< [body] the first body of its group; -1: held. Empty: all are held
  std::vector<Cut> cuts_;            ///< [body]
  std::vector<Vec3f> displacement_;  ///< [root]
  bool are_stopped_ = false;
  Vec3f at_rest_{};
};

}  // namespace pliant
