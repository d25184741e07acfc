// One object's part of the multigrid correction: its hierarchy linearised, and the steps of conjugate gradients on it, in parts
// so that objects that contacts join can make them together (multigrid_group.cpp).
#pragma once

#include <algorithm>
#include <vector>

#include "solver/substep.h"
#include "solver/sweeps/multigrid.h"

namespace pliant {

/// Batches of a task: of rows that one thread's cache holds.
inline constexpr int batches_per_task = 128;

/// A view of one object's hierarchy and numbers in one substep.
class MultigridSolve {
 public:
  MultigridSolve(Substep& s, int object)
      : s_(s),
        object_(object),
        model_(s.model.objects[object].multigrid),
        work_(multigrid_of(s).objects[object]),
        kernels_(s.kernels.multigrid) {}

  /// The matrices of all levels and the right-hand side, about where `a` has the particles.
  void linearise(const SweepArguments& a);
  /// The preconditioned residual, whose product with the residual is returned.
  double precondition();
  /// The next direction, from that and beta times the last one.
  void turn(float beta);
  /// The direction's image; returns their product.
  double apply();
  /// The step along the direction; the right-hand side loses what it has met.
  void advance(float alpha);
  /// The direction that moves all that can move by `by`.
  void turn_to(const Vec3f& by);
  /// The direction that moves every piece as a whole so that no force on the whole of it is left over: what nothing holds then
  /// keeps its momentum, however few the cycles. `springs` are contacts, of which those of a piece with itself hold it nowhere.
  void turn_to_shifts(const std::vector<const PairSpring*>& springs);
  void clear_change() { std::fill(work_.change.begin(), work_.change.end(), Record{}); }
  void clear_direction() { std::fill(work_.direction.begin(), work_.direction.end(), Record{}); }
  /// Adds what holds all pieces, and what force they are owed.
  void add_pieces(MultigridObject::Piece& sum);

 private:
  int levels() const { return static_cast<int>(model_.levels.size()); }
  const MultigridLevel& level(int l) const { return model_.levels[l]; }
  MultigridValues& values(int l) { return work_.levels[l]; }
  template <class Body>
  void for_batches(int l, Body body);
  template <class Body>
  double sum(int l, Body body);
  void release(const PairSpring& s);
  bool sum_pieces();
  void precondition(int l);
  void smooth(int l);
  void cycle(int l);

  Substep& s_;
  int object_;
  const Multigrid& model_;
  MultigridObject& work_;
  const MultigridKernels& kernels_;
};

/// Where the forces owed to a piece move it against what holds it; nowhere where nothing says how far.
Record shift_of(const MultigridObject::Piece& piece);

}  // namespace pliant
