#include "model/control.h"

#include <algorithm>

namespace pliant {

namespace {

/// Finds the element with that number in an ascending list; null if there is none.
template <class T>
const T* find_number(const std::vector<T>& ascending, int T::*number, int wanted) {
  const auto at = std::lower_bound(ascending.begin(), ascending.end(), wanted,
                                   [&](const T& one, int other) { return one.*number < other; });
  return at == ascending.end() || (*at).*number != wanted ? nullptr : &*at;
}

}  // namespace

Posed PoseDrive::at(double time) const {
  if (!moves() || time >= end) return to;
  const double share = (time - start) / (end - start);
  return {from.position + (to.position - from.position) * share, slerp(from.rotation, to.rotation, share)};
}

const Target* ObjectControl::target(int particle) const { return find_number(targets, &Target::particle, particle); }
const TurnTarget* ObjectControl::turn(int frame) const { return find_number(turns, &TurnTarget::frame, frame); }

bool Control::has_forces() const {
  return std::any_of(objects.begin(), objects.end(),
                     [](const auto& one) { return !one.second.forces.empty() || !one.second.pulls.empty(); });
}

}  // namespace pliant
