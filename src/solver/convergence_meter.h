// Estimates at the end of a frame how far its solve is from converged (docs/internals/convergence.md).
//
// At rest multipliers lambda carry the load, whatever the method. So by virtual work the load moves too far by the sum
// of -lambda (C + alpha~ lambda), where the sum of alpha~ lambda^2 is right. Both are estimated from a few constraints,
// other ones in each frame.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pliant/report.h"
#include "solver/overstretch_meter.h"

namespace pliant {

/// Sums over the sampled constraints of one kind of an object, of which an older frame counts less.
struct ConvergenceSums {
  double work = 0;      ///< of -lambda (C + alpha~ lambda)
  double elastic = 0;   ///< of alpha~ lambda^2
  double deformed = 0;  ///< of C^2 / alpha~
  double force = 0;     ///< of |lambda|
  double squares = 0;   ///< of squared errors: C + alpha~ lambda, or of a joint its gap over the size of its bodies
  double sampled = 0;   ///< constraints

  /// Adds a sample, of which each constraint stands for `weight` of them in sums of energy and force.
  void add(const ConvergenceSums& sample, double weight);
};

/// The frame that ConvergenceMeter estimates.
struct EstimatedFrame {
  MeasuredFrame measured;
  double dt = 0;       ///< length of the frame [s]
  int iterations = 1;  ///< of a substep
};

class ConvergenceMeter {
 public:
  /// Adds a frame. Allocates nothing if objects and constraint types are those of the frame before.
  void add(const EstimatedFrame& frame);
  /// Forgets the frames before.
  void restart() { objects_.clear(); }

  /// Of bending, shear, volume, joints and the stretch of triangles: the object where each is farthest from converged,
  /// by its number in the model.
  ConvergenceEstimates estimates() const;

 private:
  struct TypeKind {
    int kind = -1;             ///< its Resistance; -1: none
    bool gives_shape = false;  ///< of an elastic solid
  };
  struct ObjectSums {
    std::array<ConvergenceSums, resistance_count> of;
    bool is_solid = false;
    int substeps = 0;
  };
  void list_kinds();
  void list_pools(const EstimatedFrame& frame, int object);
  void add(const EstimatedFrame& frame, int object);
  static ConvergenceEstimate estimate(const ObjectSums& sums, Resistance kind);

  std::vector<TypeKind> kinds_;  ///< of each constraint type
  std::vector<int> pools_;       ///< of each pool of an object its Resistance; -1: none
  std::vector<ObjectSums> objects_;
};

/// True if the first of two estimates of a kind is farther from converged: what need not be told is nearer.
bool is_farther(Resistance kind, const ConvergenceEstimate& first, const ConvergenceEstimate& second);

}  // namespace pliant
