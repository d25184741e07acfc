// One object's part of the multigrid correction: its linearised levels, and the steps of conjugate gradients as
// separate functions, so that objects that contacts connect can be solved together (multigrid_group.cpp).
#pragma once

#include <algorithm>
#include <vector>

#include "solver/substep.h"
#include "solver/sweeps/multigrid.h"

namespace pliant {

/// Batches per task; their rows fit one core's cache.
inline constexpr int batches_per_task = 128;

/// A view of one object's levels and vectors in one substep.
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
  /// Applies the preconditioner to the residual; returns the dot product of both.
  double precondition();
  /// Sets the next search direction p: preconditioned residual + beta times the last p.
  void turn(float beta);
  /// Computes A p; returns p . A p.
  double apply();
  /// Computes A p where p is the same within each piece: only pieces' borders feel springs.
  void apply_to_shifts();
  /// Adds alpha p to the solution, and updates the residual in the right-hand side.
  void advance(float alpha);
  /// Sets p to the displacement `by` for all dynamic particles.
  void turn_to(const Vec3f& by);
  /// Sets p to a displacement of each piece that makes the total force on it zero: free pieces then conserve momentum
  /// for any number of cycles. `springs` are contacts; those within one piece do not resist its displacement.
  void turn_to_shifts(const std::vector<const PairSpring*>& springs);
  /// Sets p to the displacement since the substep's start, correction included, less its mean over each piece weighted
  /// by mass. `displacements`: before the correction.
  void turn_to_motion(const Record* displacements);
  /// Returns the dot product of the residual and p.
  double residual_along();
  void clear_change() { std::fill(work_.change.begin(), work_.change.end(), Record{}); }
  void clear_direction() { std::fill(work_.direction.begin(), work_.direction.end(), Record{}); }
  /// Adds the stiffness and the remaining force of all pieces to `sum`.
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

/// The displacement of a piece: its remaining force divided by its stiffness; zero if the stiffness is singular.
Record shift_of(const MultigridObject::Piece& piece);

}  // namespace pliant
