#include "model/control.h"

#include <algorithm>

namespace pliant {

Posed PoseDrive::at(double time) const {
  if (!moves() || time >= end) return to;
  const double share = (time - start) / (end - start);
  return {from.position + (to.position - from.position) * share, slerp(from.rotation, to.rotation, share)};
}

bool Control::has_forces() const {
  return std::any_of(objects.begin(), objects.end(), [](const auto& one) { return !one.second.forces.empty(); });
}

}  // namespace pliant
