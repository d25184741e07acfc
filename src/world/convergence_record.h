// The convergence estimates of the frames of a World, and the worst. They are no part of the State: restoring a State
// clears them.
#pragma once

#include "parallel/executor.h"
#include "solver/convergence_meter.h"
#include "world/id_table.h"

namespace pliant {

class ConvergenceRecord {
 public:
  ConvergenceMeter& meter() { return meter_; }
  const WorstEstimates& worst() const { return worst_; }

  /// The estimates after a complete frame. What lasts of them is added to the worst. `ids`: of objects by their number
  /// in the model; `substeps_of`: substeps of the frame of an object of this number.
  ConvergenceEstimates add(const Report& report, const IdTable<Object>& ids, FunctionRef<int(int)> substeps_of);
  /// Forgets the worst estimates of an object that is removed or whose particles change, and the frames before of all.
  void forget_object(ObjectId object);
  void restart();

 private:
  ConvergenceMeter meter_;
  ConvergenceEstimates lasting_;  ///< which follow those of the frames down at once and up slowly
  WorstEstimates worst_;
};

}  // namespace pliant
