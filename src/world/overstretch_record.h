// The worst overstretch of the frames of a World. It is no part of the State: restoring a State clears it.
#pragma once

#include "solver/overstretch_meter.h"

namespace pliant {

class OverstretchRecord {
 public:
  OverstretchMeter& meter() { return meter_; }
  const WorstOverstretch& worst() const { return worst_; }

  /// Adds what was measured of a frame.
  void add(const Overstretch& measured, std::int64_t frame);
  /// Forgets that the worst is of the object in a slot, because its particles change. The figures stay.
  void forget_object(int slot);
  void restart() { worst_ = {}; }

 private:
  OverstretchMeter meter_;
  WorstOverstretch worst_;
};

}  // namespace pliant
