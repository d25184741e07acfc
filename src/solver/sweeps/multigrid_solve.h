// One object's part of the multigrid correction: its linearised hierarchy, and conjugate gradients in separate steps, so
// that objects connected by contacts can be solved together (multigrid_group.cpp).
#pragma once

#include <algorithm>
#include <vector>

#include "solver/substep.h"
#include "solver/sweeps/multigrid.h"

namespace pliant {

/// Batches per task: rows that fit one core's cache.
inline constexpr int batches_per_task = 128;

/// A view of one object's hierarchy and values in one substep.
class MultigridSolve {
 public:
  MultigridSolve(Substep& s, int object)
      : s_(s),
        object_(object),
        model_(s.model.objects[object].multigrid),
        work_(multigrid_of(s).objects[object]),
        kernels_(s.kernels.multigrid) {}

  /// Assembles the matrices of all levels and the right-hand side at the particles of `a`.
  void linearise(const SweepArguments& a);
  /// Preconditions the residual; returns the product of both.
  double precondition();
  /// Sets the next search direction: preconditioned residual + beta times the last direction.
  void turn(float beta);
  /// Computes the direction's image A p; returns their product.
  double apply();
  /// Steps along the direction; updates the right-hand side to the residual.
  void advance(float alpha);
  /// Sets the direction to a uniform displacement of all dynamic particles.
  void turn_to(const Vec3f& by);
  /// Sets the direction that moves every piece rigidly so that its total force vanishes: free pieces then conserve momentum
  /// for any number of cycles. `springs` are contacts; those of a piece with itself do not hold it.
  void turn_to_shifts(const std::vector<const PairSpring*>& springs);
  void clear_change() { std::fill(work_.change.begin(), work_.change.end(), Record{}); }
  void clear_direction() { std::fill(work_.direction.begin(), work_.direction.end(), Record{}); }
  /// Adds the stiffness and the remaining force of all pieces.
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

/// The displacement of a piece by its remaining force over its stiffness; zero if the stiffness is singular.
Record shift_of(const MultigridObject::Piece& piece);

}  // namespace pliant
